"""Grader of exercise 9; run it with `make test-ex9`.

Nothing here is left to chance: an evolution depends on environment, steps and seed alone, so task
9.6 is checked by doing it again.
"""

import numpy as np

from botschool.grading import Exercise, Student, expect, expect_array, expect_close, expect_fields

exercise = Exercise(
    9,
    "Reward functions",
    file="reward_functions.py",
    imports=("botschool.course.locomotion", "botschool.evolution.run", "pybullet"),
    extras=("pybullet",),
)
ROBOTS = {"Hopper": 3, "HalfCheetah": 6, "Ant": 8, "Walker2D": 6, "Humanoid": 17}
STEP = 0.0165


def generator(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def made_up(robot: str, index: int, steps: int = 40) -> dict:
    """A trajectory of random numbers, in which everything happens."""
    rng, joints = generator(index), ROBOTS[robot]
    return {
        "robot": robot,
        "distance": 1000 - np.cumsum(rng.normal(0.02, 0.05, steps + 1)),
        "height": rng.uniform(0.1, 1.4, steps),
        "pitch": rng.uniform(-1.8, 1.8, steps),
        "heading": rng.uniform(-2, 2, steps),
        "touching": rng.integers(0, 2, steps).astype(float),
        "actions": rng.uniform(-1, 1, (steps, joints)),
        "speeds": rng.normal(0, 1, (steps, joints)),
        "positions": rng.choice([0.4, 1.0, 1.2, 0.97, 0.995], (steps, joints))
        * rng.choice([-1, 1], (steps, joints)),
    }


# What the grader expects, computed apart from any submission, step by step.


def bonus(robot: str, height: float, pitch: float, touching: float) -> float:
    if robot == "Ant":
        return 1.0 if height > 0.26 else -1.0
    if robot == "Humanoid":
        return 2.0 if height > 0.78 else -1.0
    stands = touching == 0 if robot == "HalfCheetah" else height > 0.8
    return 1.0 if stands and -1 < pitch < 1 else -1.0


def expected_v0(one: dict) -> dict:
    rows = {"progress": [], "alive": [], "electricity": [], "joints_at_limit": []}
    factor = 4.25 if one["robot"] == "Humanoid" else 1.0
    for t in range(len(one["height"])):
        action, speed, n = one["actions"][t], one["speeds"][t], one["actions"].shape[1]
        rows["progress"].append((one["distance"][t] - one["distance"][t + 1]) / STEP)
        seen = (one["height"][t], one["pitch"][t], one["touching"][t])
        rows["alive"].append(bonus(one["robot"], *seen))
        work, effort = sum(abs(action * speed)) / n, sum(action**2) / n
        rows["electricity"].append(-factor * (2 * work + 0.1 * effort))
        rows["joints_at_limit"].append(-0.1 * sum(abs(one["positions"][t]) > 0.99))
    return {key: np.array(values) for key, values in rows.items()}


def expected_v5(one: dict) -> np.ndarray:
    v0, robot = expected_v0(one), one["robot"]
    total = v0["progress"].copy()
    if robot in ("HalfCheetah", "Ant", "Humanoid"):
        total += v0["joints_at_limit"]
    for t in range(len(total)):
        if robot == "Ant":
            total[t] += 0.01 - 0.01 * np.mean(one["actions"][t] ** 2)
        if robot == "Humanoid":
            beyond = sum(max(0.0, abs(p) - 1) for p in one["positions"][t])
            total[t] += 1 - 10 * beyond - 0.1 * one["heading"][t] ** 2
    return total


def expected_gait(one: dict) -> dict:
    v0, steps = expected_v0(one), len(one["height"])
    metres, seconds = one["distance"][0] - one["distance"][-1], STEP * steps
    alive = v0["alive"][v0["alive"] > 0].sum()
    income = alive + v0["progress"][v0["progress"] > 0].sum()
    standing = alive / income if income > 0 else 0.0
    return {"metres": metres, "seconds": seconds, "speed": metres / seconds, "standing": standing}


def compare_fields(said: str, answer, wanted: dict, tolerance: float = 1e-9) -> None:
    values = expect_fields(said, answer, *wanted)
    for (key, value), got in zip(wanted.items(), values, strict=True):
        expect_close(f"{said}: {key}", got, value, tolerance)


def expect_no_other(said: str, answer: dict, wanted: dict) -> None:
    more = sorted(map(str, set(answer) - set(wanted)))
    expect(not more, f"{said} returned components that version 0 does not have: {more}.")


def recorded(robot: str, index: int) -> tuple[dict, list[dict], np.ndarray]:
    """A real episode with random actions, the environment's components and its rewards."""
    from botschool.envs.locomotors import Locomotor

    env, rng = Locomotor(robot, 5), generator(index)
    observation, _ = env.reset(seed=exercise.seed(index + 1))
    rows, infos, rewards = [env.measured()], [], []
    for _ in range(30):
        action = rng.uniform(-1, 1, ROBOTS[robot]).astype(np.float32)
        observation, reward, ended, _, info = env.step(action)
        positions, speeds = observation[8:][: 2 * len(action)].reshape(-1, 2).T
        rows.append({**env.measured(), "actions": action, "positions": positions, "speeds": speeds})
        infos.append(info["v0"])
        rewards.append(reward)
        if ended:
            break
    env.close()
    one = {key: np.array([row[key] for row in rows[1:]], dtype=float) for key in rows[-1]}
    one["distance"] = np.array([row["distance"] for row in rows])
    return {**one, "robot": robot}, infos, np.array(rewards)


# ------------------------------------------------------------------- 9.1
first = exercise.task("9.1", "Progress, and being alive")


@first.check(6)
def measures_progress(student: Student):
    for index, steps in ((1, 1), (2, 50)):
        distance = made_up("Hopper", index, steps)["distance"]
        answer = student.call("progress", distance)
        mistakes = {"The duration of a step is left out.": distance[:-1] - distance[1:]}
        wanted = (distance[:-1] - distance[1:]) / STEP
        expect_close(student.said, answer, wanted, 1e-7, mistakes)


@first.check(9)
def tells_the_fallen(student: Student):
    for i, robot in enumerate(ROBOTS):
        one = made_up(robot, 3 + i)
        seen = [one[key] for key in ("height", "pitch", "touching")]
        answer = student.call("alive_bonus", robot, *seen)
        wanted = expected_v0(one)["alive"]
        level = expected_v0(one | {"pitch": np.maximum(one["pitch"], 0.0)})["alive"]
        mistakes = {
            "The fallen get 0, but they pay.": np.maximum(wanted, 0.0),
            "A robot that leans back is forgotten: the pitch may be negative.": level,
        }
        expect_close(student.said, answer, wanted, mistakes=mistakes)


# ------------------------------------------------------------------- 9.2
def mistaken_electricity(one: dict) -> dict:
    """What mistakes make of the cost."""
    actions, speeds, wanted = one["actions"], one["speeds"], expected_v0(one)["electricity"]
    effort = (actions**2).mean(axis=1)
    scale = wanted / -(2 * np.abs(actions * speeds).mean(axis=1) + 0.1 * effort)
    return {
        "Braking is paid for: the absolute value of the work counts, joint by joint.": -scale
        * (2 * (actions * speeds).mean(axis=1) + 0.1 * effort),
        "The cost of standing still with force, 0.1 times the action's square, is left out.":
        -scale * 2 * np.abs(actions * speeds).mean(axis=1),
        "The electricity of a Humanoid costs more than that of others.": wanted / scale,
    }  # fmt: skip


costs = exercise.task("9.2", "What effort costs")


@costs.check(8)
def charges_for_electricity(student: Student):
    for i, robot in enumerate(("Hopper", "HalfCheetah", "Ant", "Walker2D")):
        one = made_up(robot, 10 + i)
        answer = student.call("electricity", robot, one["actions"], one["speeds"])
        wanted, mistakes = expected_v0(one)["electricity"], mistaken_electricity(one)
        expect_close(student.said, answer, wanted, mistakes=mistakes)


@costs.check(4)
def charges_humanoids_more(student: Student):
    one = made_up("Humanoid", 14)
    answer = student.call("electricity", "Humanoid", one["actions"], one["speeds"])
    wanted, mistakes = expected_v0(one)["electricity"], mistaken_electricity(one)
    expect_close(student.said, answer, wanted, mistakes=mistakes)


@costs.check(8)
def counts_joints_at_their_limits(student: Student):
    for i, robot in enumerate(("Hopper", "Ant")):
        one = made_up(robot, 15 + i)
        answer = student.call("joints_at_limit", one["positions"])
        mistakes = {
            "Joints at their lower limits count, too.": -0.1
            * (one["positions"] > 0.99).sum(axis=1),
        }
        wanted = expected_v0(one)["joints_at_limit"]
        expect_close(student.said, answer, wanted, mistakes=mistakes)


# ------------------------------------------------------------------- 9.3
standard = exercise.task("9.3", "Version 0", needs=("9.1", "9.2"))


def call_v0(student: Student, one: dict) -> dict:
    answer = student.call("components_v0", one)
    student.said = f"components_v0(a trajectory of a {one['robot']})"
    return answer


@standard.check(8)
def rebuilds_version_0(student: Student):
    for i, robot in enumerate(ROBOTS):
        one = made_up(robot, 20 + i)
        answer, wanted = call_v0(student, one), expected_v0(one)
        compare_fields(student.said, answer, wanted, 1e-7)
        expect_no_other(student.said, answer, wanted)


@standard.check(7)
def agrees_with_the_environment(student: Student):
    for i, robot in enumerate(("Hopper", "HalfCheetah", "Humanoid")):
        one, infos, _ = recorded(robot, 30 + 2 * i)
        wanted = {key: np.array([info[key] for info in infos]) for key in infos[0]}
        answer = call_v0(student, one)
        compare_fields(student.said, answer, wanted, 1e-4)


# ------------------------------------------------------------------- 9.4
evolved = exercise.task("9.4", "Version 5", needs=("9.1", "9.2"))


def compare_v5(student: Student, one: dict, wanted: np.ndarray, tolerance: float) -> None:
    answer = student.call("reward_v5", one)
    limits = expected_v0(one)["joints_at_limit"]
    mistakes = {
        "Joints at their limits cost this robot nothing in version 5.": wanted + limits,
        "What joints at their limits cost is left out.": wanted - limits,
    }
    said = f"reward_v5(a trajectory of a {one['robot']})"
    expect_close(said, answer, wanted, tolerance, mistakes)


@evolved.check(4)
def rewards_progress_alone(student: Student):
    for i, robot in enumerate(("Hopper", "Walker2D")):
        one = made_up(robot, 40 + i)
        compare_v5(student, one, expected_v5(one), 1e-7)


@evolved.check(4)
def rewards_half_cheetahs(student: Student):
    one = made_up("HalfCheetah", 42)
    compare_v5(student, one, expected_v5(one), 1e-7)


@evolved.check(4)
def rewards_ants(student: Student):
    one = made_up("Ant", 43)
    compare_v5(student, one, expected_v5(one), 1e-7)


@evolved.check(5)
def rewards_humanoids(student: Student):
    one = made_up("Humanoid", 44)
    compare_v5(student, one, expected_v5(one), 1e-7)


@evolved.check(3)
def is_what_the_environment_pays(student: Student):
    for i, robot in enumerate(("Walker2D", "Ant")):
        one, _, rewards = recorded(robot, 46 + 2 * i)
        compare_v5(student, one, rewards, 1e-4)


# ------------------------------------------------------------------- 9.5
described = exercise.task("9.5", "A gait in four numbers", needs=("9.3",))


def compare_gait(student: Student, one: dict) -> None:
    answer = student.call("gait", one)
    compare_fields(f"gait(a trajectory of a {one['robot']})", answer, expected_gait(one), 1e-7)


@described.check(10)
def describes_gaits(student: Student):
    for i, robot in enumerate(ROBOTS):
        compare_gait(student, made_up(robot, 50 + i))


@described.check(5)
def describes_those_who_earn_nothing(student: Student):
    one = made_up("Hopper", 56)
    one["distance"] = 1000 + np.cumsum(np.full(41, 0.01))
    compare_gait(student, one)
    compare_gait(student, {**one, "height": np.full(40, 0.3)})


# ------------------------------------------------------------------- 9.6
both = exercise.task("9.6", "Evolve both, and compare", seconds=240, needs=("9.5",))
STEPS = 6000


def mean_gait(runner, genotype: np.ndarray, seed: int, episodes: int) -> dict:
    gaits = [expected_gait(runner.record(genotype, seed + i)) for i in range(episodes)]
    return {name: float(np.mean([each[name] for each in gaits])) for name in gaits[0]}


def random_robots(runner, count: int) -> list[np.ndarray]:
    inputs = runner.policy.spec.inputs
    robots = 0.3 * generator(63).normal(size=(count, runner.size))
    robots[:, -2 * inputs :] = np.repeat([0.0, 1.0], inputs)
    return list(robots)


@both.check(6)
def compares_gaits(student: Student):
    from botschool.course.locomotion import Runner

    # a Humanoid starts nearer to its rest position in version 5, so its episodes tell the versions
    # apart; a Hopper's would not
    runner, seed = Runner("HumanoidBulletEnv-v5"), exercise.seed(64) % 100_000
    genotypes = dict(zip(("v0", "v5"), random_robots(runner, 2), strict=True))
    answer = student.call("compare", "Humanoid", genotypes, seed, 4)
    said = student.said = f"compare('Humanoid', two genotypes, seed={seed}, episodes=4)"
    for key, found in zip(genotypes, expect_fields(said, answer, *genotypes), strict=True):
        wanted = mean_gait(runner, genotypes[key], seed, 4)
        compare_fields(f"{said}: {key}", found, wanted, 1e-5)


@both.check(9)
def evolves_both(student: Student):
    from botschool.course.locomotion import Runner

    answer = student.call("evolve_both", "Hopper", STEPS, exercise.seed(60) % 100_000)
    said, pair = student.said, expect_fields(student.said, answer, "v0", "v5")
    for version, genotype in zip(("v0", "v5"), pair, strict=True):
        runner = Runner(f"HopperBulletEnv-{version}")
        genotype = expect_array(f"{said}: {version}", genotype, (runner.size,))
        wanted = runner.evolve(STEPS, exercise.seed(60) % 100_000)
        expect(
            bool(np.array_equal(genotype, wanted)),
            f"{said}: {version} is not the robot that {STEPS} steps of evolution with this seed in "
            f"{runner.environment} lead to.",
        )
