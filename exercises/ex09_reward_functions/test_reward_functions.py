"""Grader of exercise 9; run it with `make test-ex9`.

Nothing here is left to chance: an evolution depends on environment, steps and seed alone, so task
9.6 is checked by doing it again. What PyBullet pays is looked up in recorded episodes where it is
not installed.
"""

import numpy as np

from botschool.grading import Exercise, Student, expect, expect_array, expect_close, expect_fields

exercise = Exercise(
    9,
    "Reward functions",
    file="reward_functions.py",
    imports=("botschool.course.locomotion", "botschool.evolution.run"),
)
ROBOTS = {"Hopper": 3, "HalfCheetah": 6, "Ant": 8, "Walker2D": 6, "Humanoid": 17}
PLANAR = {
    "PlanarHopper": (0.008, 3, 1),
    "PlanarWalker2D": (0.008, 6, 2),
    "PlanarHalfCheetah": (0.05, 6, 2),
}
"""Seconds of a step, joints, feet."""


def generator(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def made_up(robot: str, index: int, steps: int = 40) -> dict:
    """A trajectory of random numbers, in which everything happens."""
    rng, joints = generator(index), ROBOTS[robot]
    one = {
        "robot": robot,
        "duration": 0.0165,
        "distance": 1000 - np.cumsum(rng.normal(0.02, 0.05, steps + 1)),
        "height": rng.uniform(0.1, 2.2, steps),
        "pitch": rng.uniform(-1.8, 1.8, steps),
        "heading": rng.uniform(-2, 2, steps),
        "touching": rng.integers(0, 2, steps).astype(float),
        "actions": rng.uniform(-1, 1, (steps, joints)),
        "speeds": rng.normal(0, 1, (steps, joints)),
        "positions": rng.choice([0.4, 1.0, 1.2, 0.97, 0.99, 0.995], (steps, joints))
        * rng.choice([-1, 1], (steps, joints)),
    }
    if steps > 5:  # at first it stands; at the end it is exactly at the limits
        one["height"][:2], one["pitch"][:2], one["touching"][:2] = 1.5, 0.1, 0.0
        one["height"][-5:] = 0.8, 0.26, 0.78, 1.2, 1.2
        one["pitch"][-5:] = 0.0, 0.0, 0.0, 1.0, -1.0
        one["touching"][-5:] = 0.0
    return one


def made_up_planar(robot: str, index: int, steps: int = 40) -> dict:
    """A trajectory of a planar runner, likewise."""
    rng, (duration, joints, feet) = generator(index), PLANAR[robot]
    one = {
        "robot": robot,
        "duration": duration,
        "distance": 1000 - np.cumsum(rng.normal(0.01, 0.02, steps + 1)),
        "height": rng.uniform(0.5, 2.3, steps),
        "pitch": rng.choice([0.1, 1.0], steps) * rng.uniform(-1.8, 1.8, steps),
        "actions": rng.uniform(-1, 1, (steps, joints)),
        "feet": rng.integers(0, 2, (steps, feet)).astype(float),
    }
    one["height"][:7] = 0.7, 0.8, 2.0, 1.0, 1.0, 1.0, 1.0  # exactly at the limits
    one["pitch"][:7] = 0.1, 0.1, 0.1, 0.2, -0.2, 1.0, -1.0
    return one


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
        rows["progress"].append((one["distance"][t] - one["distance"][t + 1]) / one["duration"])
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


def expected_planar(one: dict) -> dict:
    rows = {"progress": [], "alive": [], "effort": []}
    cheetah, walker = (one["robot"] == f"Planar{name}" for name in ("HalfCheetah", "Walker2D"))
    for t, (height, pitch) in enumerate(zip(one["height"], one["pitch"], strict=True)):
        rows["progress"].append((one["distance"][t] - one["distance"][t + 1]) / one["duration"])
        up = 0.8 < height < 2 and abs(pitch) < 1 if walker else height > 0.7 and abs(pitch) < 0.2
        rows["alive"].append(1.0 if up and not cheetah else 0.0)
        rows["effort"].append(-(0.1 if cheetah else 0.001) * sum(a * a for a in one["actions"][t]))
    return {key: np.array(values) for key, values in rows.items()}


def expected_gait(one: dict) -> dict:
    v0, steps = expected_planar(one), len(one["height"])
    metres, seconds = one["distance"][0] - one["distance"][-1], one["duration"] * steps
    alive = v0["alive"].sum()
    income = alive + v0["progress"][v0["progress"] > 0].sum()
    return {
        "metres": metres,
        "seconds": seconds,
        "speed": metres / seconds,
        "standing": alive / income if income > 0 else 0.0,
        "grounded": np.mean([max(feet) for feet in one["feet"]]),
    }


def compare_fields(
    said: str, answer, wanted: dict, tolerance: float = 1e-9, mistakes: dict | None = None
) -> None:
    """mistakes: what they make of the fields, each a dict, by sentence."""
    values = expect_fields(said, answer, *wanted)
    for (key, value), got in zip(wanted.items(), values, strict=True):
        made = {text: each[key] for text, each in (mistakes or {}).items() if key in each}
        expect_close(f"{said}: {key}", got, value, tolerance, made)


def expect_no_other(said: str, answer: dict, wanted: dict) -> None:
    more = sorted(map(str, set(answer) - set(wanted)))
    expect(not more, f"{said} returned components that version 0 does not have: {more}.")


# ------------------------------------------------------------------- 9.1
first = exercise.task("9.1", "Progress, and being alive")


@first.check(6)
def measures_progress(student: Student):
    for index, steps in ((1, 1), (2, 50), (3, 12)):
        distance, duration = made_up("Hopper", index, steps)["distance"], 0.004 * index
        answer = student.call("progress", distance, duration)
        mistakes = {"The duration of a step is left out.": distance[:-1] - distance[1:]}
        wanted = (distance[:-1] - distance[1:]) / duration
        expect_close(student.said, answer, wanted, 1e-7, mistakes)


@first.check(8)
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


@costs.check(7)
def charges_for_electricity(student: Student):
    for i, robot in enumerate(("Hopper", "HalfCheetah", "Ant", "Walker2D")):
        one = made_up(robot, 10 + i)
        answer = student.call("electricity", robot, one["actions"], one["speeds"])
        wanted, mistakes = expected_v0(one)["electricity"], mistaken_electricity(one)
        expect_close(student.said, answer, wanted, mistakes=mistakes)


@costs.check(3)
def charges_humanoids_more(student: Student):
    for index, steps in ((14, 40), (17, 7)):
        one = made_up("Humanoid", index, steps)
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
        expect_close(student.said, answer, wanted, 1e-6, mistakes)


# ------------------------------------------------------------------- 9.3
standard = exercise.task("9.3", "Version 0", needs=("9.1", "9.2"))


def call_v0(student: Student, one: dict) -> dict:
    answer = student.call("components_v0", one)
    student.said = f"components_v0(a trajectory of a {one['robot']})"
    return answer


@standard.check(6)
def rebuilds_version_0(student: Student):
    for i, robot in enumerate(ROBOTS):
        one = made_up(robot, 20 + i)
        answer, wanted = call_v0(student, one), expected_v0(one)
        compare_fields(student.said, answer, wanted, 1e-7)
        expect_no_other(student.said, answer, wanted)


@standard.check(5)
def agrees_with_the_environment(student: Student):
    from botschool.course.recordings import paid_episode

    for i, robot in enumerate(("Hopper", "HalfCheetah", "Humanoid")):
        paid = paid_episode(robot, exercise.seed(30 + i))
        answer = call_v0(student, paid.trajectory)
        compare_fields(student.said, answer, paid.v0, 1e-4)


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
        compare_v5(student, one, expected_v5(one), 1e-6)


@evolved.check(3)
def rewards_half_cheetahs(student: Student):
    for index, steps in ((42, 40), (47, 7)):
        one = made_up("HalfCheetah", index, steps)
        compare_v5(student, one, expected_v5(one), 1e-6)


@evolved.check(3)
def rewards_ants(student: Student):
    for index, steps in ((43, 40), (48, 7)):
        one = made_up("Ant", index, steps)
        compare_v5(student, one, expected_v5(one), 1e-6)


@evolved.check(4)
def rewards_humanoids(student: Student):
    for index, steps in ((44, 40), (49, 7)):
        one = made_up("Humanoid", index, steps)
        compare_v5(student, one, expected_v5(one), 1e-6)


@evolved.check(3)
def is_what_the_environment_pays(student: Student):
    from botschool.course.recordings import paid_episode

    for i, robot in enumerate(("Walker2D", "Ant")):
        paid = paid_episode(robot, exercise.seed(46 + i))
        compare_v5(student, paid.trajectory, paid.v5, 1e-4)


# ------------------------------------------------------------------- 9.5
described = exercise.task("9.5", "Planar runners, and a gait in five numbers", needs=("9.1",))


def call_planar(student: Student, one: dict) -> dict:
    answer = student.call("planar_v0", one)
    student.said = f"planar_v0(a trajectory of a {one['robot']})"
    return answer


@described.check(8)
def rebuilds_version_0_of_planar_runners(student: Student):
    for i, robot in enumerate(PLANAR):
        one = made_up_planar(robot, 50 + i)
        wanted, means = expected_planar(one), (one["actions"] ** 2).mean(axis=1)
        price = 0.1 if robot == "PlanarHalfCheetah" else 0.001
        mistakes = {
            "The effort is the sum over the joints, not their mean.": {"effort": -price * means},
            "The fallen get 0 here, not -1.": {"alive": 2 * wanted["alive"] - 1},
        }
        answer = call_planar(student, one)
        compare_fields(student.said, answer, wanted, 1e-7, mistakes)
        expect_no_other(student.said, answer, wanted)


@described.check(3)
def adds_up_to_what_the_planar_environment_pays(student: Student):
    from botschool.course.locomotion import Runner

    for i, robot in enumerate(PLANAR):
        runner, seed = Runner(f"{robot}-v0"), exercise.seed(54 + i) % 100_000
        (genotype,) = random_robots(runner, 1, 57 + i)
        paid = np.array([step.reward for step in runner.play(genotype, seed, 100)])
        answer = call_planar(student, runner.record(genotype, seed, 100))
        parts = expect_fields(student.said, answer, "progress", "alive", "effort")
        parts = [expect_array(student.said, part, paid.shape) for part in parts]
        expect_close(f"the sum of {student.said}", sum(parts), paid, 1e-4)


def random_robots(runner, count: int, index: int) -> np.ndarray:
    inputs = runner.policy.spec.inputs
    robots = 0.3 * generator(index).normal(size=(count, runner.size))
    robots[:, -2 * inputs :] = np.repeat([0.0, 1.0], inputs)
    return robots


def compare_gait(student: Student, one: dict) -> None:
    answer = student.call("gait", one)
    wanted, all_feet = expected_gait(one), one["feet"].min(axis=1).mean()
    mistakes = {
        "A step lasts as long as the trajectory's duration says.": {
            "seconds": 0.0165 * len(one["height"])
        },
        "One foot on the ground is enough.": {"grounded": all_feet},
        "The feet are counted, but only whether any of them is down matters.": {
            "grounded": one["feet"].mean()
        },
    }
    said = f"gait(a trajectory of a {one['robot']})"
    compare_fields(said, answer, wanted, 1e-7, mistakes)


@described.check(7)
def describes_gaits(student: Student):
    for i, robot in enumerate(PLANAR):
        compare_gait(student, made_up_planar(robot, 60 + i))


@described.check(2)
def describes_those_who_earn_nothing(student: Student):
    for robot in ("PlanarHopper", "PlanarWalker2D"):
        earns_nothing(student, robot)


def earns_nothing(student: Student, robot: str) -> None:
    one = made_up_planar(robot, 63)
    one["distance"] = 1000 + np.cumsum(np.full(41, 0.01))
    compare_gait(student, one)
    compare_gait(student, {**one, "height": np.full(40, 0.3)})


# ------------------------------------------------------------------- 9.6
both = exercise.task("9.6", "Evolve both, and compare", seconds=60, needs=("9.5",))
STEPS = 100_000


def mean_gaits(runner, genotypes: np.ndarray, seed: int, episodes: int) -> dict:
    rows = []
    for genotype in genotypes:
        gaits = [expected_gait(runner.record(genotype, seed + i)) for i in range(episodes)]
        rows.append({name: np.mean([each[name] for each in gaits]) for name in gaits[0]})
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


@both.check(9)
def compares_gaits(student: Student):
    from botschool.course.locomotion import Runner

    # a HalfCheetah that has fallen goes on in version 0 and ends in version 5, so its episodes tell
    # the versions apart; a Hopper's would not
    runner = Runner("PlanarHalfCheetah-v5")
    robots = random_robots(runner, 5, 65)
    compares_one(student, runner, {"v0": robots[:3], "v5": robots[3:]}, 64, 4)
    compares_one(student, runner, {"lamed": robots[1:3]}, 66, 2)


def compares_one(student: Student, runner, genotypes: dict, index: int, episodes: int) -> None:
    from botschool.course.locomotion import Runner

    seed = exercise.seed(index) % 100_000
    answer = student.call("compare", "PlanarHalfCheetah", genotypes, seed, episodes)
    robots = " and ".join(f"{len(rows)} of {key}" for key, rows in genotypes.items())
    said = f"compare('PlanarHalfCheetah', genotypes of robots, {robots}, "
    said = student.said = f"{said}seed={seed}, episodes={episodes})"
    in_v0, alone = Runner("PlanarHalfCheetah-v0"), (seed, 1)
    for key, found in zip(genotypes, expect_fields(said, answer, *genotypes), strict=True):
        wanted = mean_gaits(runner, genotypes[key], seed, episodes)
        mistakes = {
            "All are to be recorded in version 5.": mean_gaits(in_v0, genotypes[key], seed, 4),
            "Only the first episode counts.": mean_gaits(runner, genotypes[key], *alone),
        }
        compare_fields(f"{said}: {key}", found, wanted, 1e-5, mistakes)


@both.check(11)
def evolves_both(student: Student):
    seeds = [exercise.seed(70 + i) % 100_000 for i in range(3)]
    evolves_one(student, "PlanarHopper", seeds, STEPS)
    evolves_one(student, "PlanarHalfCheetah", seeds[:1], STEPS // 10)


def evolves_one(student: Student, robot: str, seeds: list[int], steps: int) -> None:
    from botschool.course.locomotion import Runner

    answer = student.call("evolve_both", robot, steps, seeds)
    said, pair = student.said, expect_fields(student.said, answer, "v0", "v5")
    for version, genotypes in zip(("v0", "v5"), pair, strict=True):
        runner = Runner(f"{robot}-{version}")
        genotypes = expect_array(f"{said}: {version}", genotypes, (len(seeds), runner.size))
        for seed, genotype in zip(seeds, genotypes, strict=True):
            expect(
                bool(np.array_equal(genotype, runner.evolve(steps, seed))),
                f"{said}: {version} holds a robot that is not the one that {steps} steps of "
                f"evolution with the seed {seed} in {runner.environment} lead to.",
            )
