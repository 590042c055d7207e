"""Grader of exercise 9; run it with `make test-ex9`.

Nothing here is left to chance: an evolution depends on environment, steps and seed alone, so task
9.6 is checked by doing it again. What PyBullet pays is looked up in recorded episodes where it is
not installed.
"""

from collections.abc import Callable
from functools import cache, partial
from itertools import combinations

import numpy as np
from slips import (
    PLANAR,
    ROBOTS,
    expected_gait,
    expected_planar,
    expected_v0,
    expected_v5,
    mistaken_bonus,
    mistaken_components,
    mistaken_electricity,
    mistaken_falls,
    mistaken_gait,
    mistaken_limits,
    mistaken_means,
    mistaken_progress,
    mistaken_v5,
    why_at_limit,
    why_electricity,
    why_gait,
    why_paid,
    why_standing,
    why_v5,
)

from botschool.grading import (
    Exercise,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    slips,
)

exercise = Exercise(
    9,
    "Reward functions",
    file="reward_functions.py",
    imports=("botschool.course.locomotion", "botschool.evolution.run"),
)


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
    if steps > 12:  # and near them
        one["height"][-9:-5] = 0.79, 0.27, 0.25, 0.81
        one["pitch"][-9:-5] = 0.1, -0.1, 0.9, -0.9
        one["touching"][-9:-5] = 0.0
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


def compare_fields(
    said: str,
    answer,
    wanted: dict,
    tolerance: float = 1e-9,
    mistakes: dict | Callable[[], dict] | None = None,
    why: dict[str, Callable[[int], str]] | None = None,
) -> None:
    """mistakes: what they make of the fields, each a dict, by sentence; why: see expect_close."""

    @cache
    def made(key: str) -> dict:
        all_of_them = mistakes() if callable(mistakes) else mistakes or {}
        return {text: each[key] for text, each in all_of_them.items() if key in each}

    values = expect_fields(said, answer, *wanted)
    for (key, value), got in zip(wanted.items(), values, strict=True):
        of_key = partial(made, key)
        expect_close(f"{said}: {key}", got, value, tolerance, of_key, (why or {}).get(key))


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
        wanted = (distance[:-1] - distance[1:]) / duration
        mistakes = partial(mistaken_progress, distance, duration)

        def why(t: int, one=distance, lasts=duration) -> str:
            return f"In step {t} it should be ({one[t]:.7g} - {one[t + 1]:.7g}) / {lasts:g}."

        expect_close(student.said, answer, wanted, 1e-7, mistakes, why)


@first.check(8)
def tells_the_fallen(student: Student):
    for i, robot in enumerate((*ROBOTS, "HalfCheetah")):
        one = made_up(robot, 3 + i)
        seen = [one[key] for key in ("height", "pitch", "touching")]
        answer = student.call("alive_bonus", robot, *seen)
        wanted = expected_v0(one)["alive"]
        mistakes = partial(mistaken_bonus, one)
        expect_close(
            student.said, answer, wanted, mistakes=mistakes, why=partial(why_standing, one)
        )


# ------------------------------------------------------------------- 9.2


costs = exercise.task("9.2", "What effort costs")


@costs.check(7)
def charges_for_electricity(student: Student):
    for i, robot in enumerate(("Hopper", "HalfCheetah", "Ant", "Walker2D", "Ant")):
        one = made_up(robot, 10 + i)
        answer = student.call("electricity", robot, one["actions"], one["speeds"])
        wanted, mistakes = expected_v0(one)["electricity"], partial(mistaken_electricity, one)
        why = partial(why_electricity, one)
        expect_close(student.said, answer, wanted, mistakes=mistakes, why=why)


@costs.check(3)
def charges_humanoids_more(student: Student):
    for index, steps in ((14, 40), (17, 7)):
        one = made_up("Humanoid", index, steps)
        answer = student.call("electricity", "Humanoid", one["actions"], one["speeds"])
        wanted, mistakes = expected_v0(one)["electricity"], partial(mistaken_electricity, one)
        why = partial(why_electricity, one)
        expect_close(student.said, answer, wanted, mistakes=mistakes, why=why)


@costs.check(8)
def counts_joints_at_their_limits(student: Student):
    for i, robot in enumerate(("Hopper", "Ant")):
        one = made_up(robot, 15 + i)
        answer = student.call("joints_at_limit", one["positions"])
        wanted = expected_v0(one)["joints_at_limit"]
        mistakes, why = partial(mistaken_limits, one["positions"]), partial(why_at_limit, one)
        expect_close(student.said, answer, wanted, 1e-6, mistakes, why)


# ------------------------------------------------------------------- 9.3
standard = exercise.task("9.3", "Version 0", needs=("9.1", "9.2"))


def call_v0(student: Student, one: dict) -> dict:
    answer = student.call("components_v0", one)
    student.said = f"components_v0(a trajectory of the robot {one['robot']})"
    return answer


@standard.check(6)
def rebuilds_version_0(student: Student):
    for i, robot in enumerate(ROBOTS):
        one = made_up(robot, 20 + i)
        answer, wanted = call_v0(student, one), expected_v0(one)
        why = {"alive": partial(why_standing, one), "joints_at_limit": partial(why_at_limit, one)}
        compare_fields(student.said, answer, wanted, 1e-7, partial(mistaken_components, one), why)
        expect_no_other(student.said, answer, wanted)

    one = made_up("Ant", 26)  # as many steps as before, but other ones
    compare_fields(
        "components_v0(a second trajectory of the robot Ant)",
        call_v0(student, one),
        expected_v0(one),
        1e-7,
    )

    one = made_up("Ant", 25, 6) | {"duration": 0.03}
    said = "components_v0(a trajectory of the robot Ant, 'duration': 0.03)"
    answer = student.call("components_v0", one)
    student.said = said
    why = {"alive": partial(why_standing, one), "joints_at_limit": partial(why_at_limit, one)}
    compare_fields(said, answer, expected_v0(one), 1e-7, partial(mistaken_components, one), why)


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
    lasting = f", 'duration': {one['duration']:.4g}" if one["duration"] != 0.0165 else ""
    said = student.said = f"reward_v5(a trajectory of the robot {one['robot']}{lasting})"
    why = partial(why_v5, one) if tolerance < 1e-5 else None
    expect_close(said, answer, wanted, tolerance, partial(mistaken_v5, one), why)


@evolved.check(4)
def rewards_progress_alone(student: Student):
    for i, robot in enumerate(("Hopper", "Walker2D")):
        one = made_up(robot, 40 + i) | {"duration": 0.0165 + 0.01 * i}
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
            "The effort is the mean over the joints, but their sum is asked for.": {
                "effort": -price * means
            },
            "Steps without a bonus get -1, but 0 is asked for.": {"alive": 2 * wanted["alive"] - 1},
            "The sign is wrong: the effort should be a negative number.": {
                "effort": -wanted["effort"]
            },
            "|action| is added up for the effort, but action^2 is asked for.": {
                "effort": -price * np.abs(one["actions"]).sum(axis=1)
            },
            f"The factor of a {robot}'s effort should be {price}, not that of another robot.": {
                "effort": wanted["effort"] * (100 if price < 0.1 else 0.01)
            },
            f"The factor {price} of the effort is left out.": {"effort": wanted["effort"] / price},
            "A step of 0.0165 s is used, but the trajectory's 'duration' is asked for.": {
                "progress": wanted["progress"] * one["duration"] / 0.0165
            },
        }
        for text, alive in mistaken_falls(one).items():
            mistakes[text] = {"alive": alive}
        answer = call_planar(student, one)
        why = {
            "alive": partial(why_paid, one),
            "effort": lambda t, one=one, price=price: (
                f"In step {t} the squares of the actions {np.round(one['actions'][t], 4).tolist()} "
                f"should be added up, and their sum multiplied by -{price}."
            ),
        }
        compare_fields(student.said, answer, wanted, 1e-7, mistakes, why)
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
        expect_close(f"the sum of the components of {student.said}", sum(parts), paid, 1e-4)


def random_robots(runner, count: int, index: int) -> np.ndarray:
    inputs = runner.policy.spec.inputs
    robots = 0.3 * generator(index).normal(size=(count, runner.size))
    robots[:, -2 * inputs :] = np.repeat([0.0, 1.0], inputs)
    return robots


def compare_gait(student: Student, one: dict) -> None:
    answer = student.call("gait", one)
    wanted = expected_gait(one)
    mistakes = {
        text: {key: value} for key, pairs in mistaken_gait(one).items() for text, value in pairs
    }
    said = f"gait(a trajectory of a {one['robot']})"
    why = {key: partial(why_gait, one, wanted, key) for key in wanted}
    compare_fields(said, answer, wanted, 1e-7, mistakes, why)


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
    # other feet, of which another one is down most: a wrong share that fits both is no chance
    feet, before = made_up_planar(robot, 68)["feet"], one["feet"].sum(axis=0)
    if (feet[:, 0].sum() > feet[:, -1].sum()) == (before[0] > before[-1]):
        feet = feet[:, ::-1]
    compare_gait(student, {**one, "height": np.full(40, 0.3), "feet": feet})


# ------------------------------------------------------------------- 9.6
both = exercise.task("9.6", "Evolve both, and compare", seconds=60, needs=("9.5",))
STEPS = 100_000


def mean_gaits(runner, genotypes: np.ndarray, seed: int, episodes: int, mean=np.mean) -> dict:
    rows = []
    for genotype in genotypes:
        gaits = [expected_gait(runner.record(genotype, seed + i)) for i in range(episodes)]
        rows.append({name: mean([each[name] for each in gaits]) for name in gaits[0]})
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
    compares_one(student, runner, {"v5": robots[:1], "v0": robots[2:4]}, 67, 1)


def same(found, name: str, wanted: np.ndarray) -> bool:
    """Whether a dict has the wanted numbers under a name."""
    try:
        return bool(np.allclose(found[name], wanted, 1e-5, 1e-5))
    except (TypeError, ValueError, LookupError):
        return False


def compares_one(student: Student, runner, genotypes: dict, index: int, episodes: int) -> None:
    seed = exercise.seed(index) % 100_000
    try:
        answer = student.call("compare", "PlanarHalfCheetah", genotypes, seed, episodes)
    except Wrong as error:
        if "genotype has shape" not in str(error):
            raise
        raise Wrong(
            f"{error}\n  The genotypes are those of the `robot` that is given: its own Runner "
            "should record them, a whole row at a time."
        ) from error
    robots = " and ".join(f"{len(rows)} for {key}" for key, rows in genotypes.items())
    said = f"compare('PlanarHalfCheetah', genotypes ({robots}), "
    said = student.said = f"{said}seed={seed}, episodes={episodes})"
    for key, found in zip(genotypes, expect_fields(said, answer, *genotypes), strict=True):
        wanted = mean_gaits(runner, genotypes[key], seed, episodes)
        mistakes = {}
        if not all(same(found, name, value) for name, value in wanted.items()):  # they take time
            mistakes = mistaken_means(runner, genotypes[key], seed, episodes)
        compare_fields(f"{said}: {key}", found, wanted, 1e-5, mistakes)


@both.check(11)
def evolves_both(student: Student):
    seeds = [exercise.seed(70 + i) % 100_000 for i in range(3)]
    evolves_one(student, "PlanarHopper", seeds, STEPS)
    evolves_one(student, "PlanarHalfCheetah", seeds[:1], STEPS // 10)
    # the robot of before, with fewer steps and seeds in no order, one of them twice
    evolves_one(student, "PlanarHalfCheetah", [seeds[1], seeds[0], seeds[1]], STEPS // 20)


def evolves_one(student: Student, robot: str, seeds: list[int], steps: int) -> None:
    from botschool.course.locomotion import Runner

    answer = student.call("evolve_both", robot, steps, seeds)
    said, pair = student.said, expect_fields(student.said, answer, "v0", "v5")
    for version, genotypes in zip(("v0", "v5"), pair, strict=True):
        runner = Runner(f"{robot}-{version}")
        expect(
            np.shape(genotypes)[1:] != (Runner(f"PlanarHopper-{version}").size,)
            or "Hopper" in robot,
            f"{said}: {version} holds genotypes of the size of a PlanarHopper's, but the robot "
            "that is given should be evolved.",
        )
        genotypes = expect_array(f"{said}: {version}", genotypes, (len(seeds), runner.size))
        for i, (seed, genotype) in enumerate(zip(seeds, genotypes, strict=True)):
            same = bool(np.array_equal(genotype, runner.evolve(steps, seed)))
            expect(
                same,
                f"{said}: row {i} of {version} is not the robot to which {steps} steps of "
                f"evolution with the seed {seed} in {runner.environment} lead."
                + ("" if same else whose(genotype, robot, version, steps, seeds, i)),
            )


def whose(genotype: np.ndarray, robot: str, version: str, steps: int, seeds: list, i: int) -> str:
    """A sentence about the arguments that lead to a genotype; "" if none of the usual ones do."""
    from botschool.course.locomotion import Runner

    other = "v5" if version == "v0" else "v0"
    tried = [(other, steps, seeds[i])]
    tried += [(version, steps // n, seeds[i]) for n in (len(seeds), 2 * len(seeds), 2, 10)]
    near = [i, i + 1, *seeds, *(seed + k for seed in seeds for k in (i, 1, -1, len(seeds)))]
    tried += [(version, steps, seed) for seed in dict.fromkeys(near) if seed >= 0]
    for name, many, seed in tried:
        runner = Runner(f"{robot}-{name}")
        if np.array_equal(genotype, runner.evolve(many, seed)):
            same = "" if many == steps else f"{many} steps instead of {steps}"
            same = same or ("" if name == version else f"{runner.environment}")
            same = same or f"the seed {seed} instead of {seeds[i]}"
            return f"\n  It is the robot of {same}."
    return ""
