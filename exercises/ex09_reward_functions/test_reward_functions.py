"""Grader of exercise 9; run it with `make test-ex9`.

Nothing here is left to chance: an evolution depends on environment, steps and seed alone, so task
9.6 is checked by doing it again. What PyBullet pays is looked up in recorded episodes where it is
not installed.
"""

import numpy as np

from botschool.grading import (
    Exercise,
    Student,
    expect,
    expect_array,
    expect_close,
    expect_fields,
)

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


def of_row(answer, wanted: np.ndarray, sentence) -> dict:
    """The mistake of the first wrong number, in the words of sentence(its index, its value)."""
    try:
        got = np.asarray(answer, dtype=float)
        apart = np.flatnonzero(~np.isclose(got, wanted, 1e-7, 1e-7))
        text = sentence(int(apart[0]), got[apart[0]])
    except (TypeError, ValueError, IndexError):  # of another kind or shape, or all are right
        return {}
    return {text: got}


# ------------------------------------------------------------------- 9.1
first = exercise.task("9.1", "Progress, and being alive")


@first.check(6)
def measures_progress(student: Student):
    for index, steps in ((1, 1), (2, 50), (3, 12)):
        distance, duration = made_up("Hopper", index, steps)["distance"], 0.004 * index
        answer = student.call("progress", distance, duration)
        change = distance[:-1] - distance[1:]
        wanted, pair = change / duration, -np.gradient(distance) / duration if steps > 1 else 0
        mistakes = {
            "The duration of a step is left out.": change,
            "The duration multiplies; it divides.": change * duration,
            "Going away counts as 0, but it is negative progress.": np.maximum(wanted, 0.0),
            "The progress of a step is taken over two steps, as np.gradient does: take the "
            "difference of neighbours.": np.resize(pair, steps + 1)[1:],
            "The progress of a step is taken over two steps, as np.gradient does: take the "
            "difference of the neighbours.": np.resize(pair, steps + 1)[:-1],
            "Each step has the progress of the next one.": np.append(wanted[1:], 0.0),
            "Each step has the progress of the one before.": np.append(0.0, wanted[:-1]),
            "The speeds are added up over the steps.": np.cumsum(wanted),
        }
        expect_close(student.said, answer, wanted, 1e-7, mistakes)


def why_standing(one: dict, t: int) -> str:
    """Why a robot has fallen after step t, or has not; by the condition that decides."""
    robot, height, pitch = one["robot"], float(one["height"][t]), abs(float(one["pitch"][t]))
    limits = {"Ant": 0.26, "Humanoid": 0.78, "Hopper": 0.8, "Walker2D": 0.8}
    facts = []
    if robot in limits:
        facts.append((height > limits[robot], f"height {height:.4g}", f"{limits[robot]}", "above"))
    if robot in ("Hopper", "Walker2D", "HalfCheetah"):
        facts.append((pitch < 1, f"|pitch| {pitch:.4g}", "1", "below"))
    if robot == "HalfCheetah":
        down = "on" if one["touching"][t] else "off"
        facts.append((down == "off", f"shin and thigh {down}", "the floor", ""))
    fallen = [fact for fact in facts if not fact[0]]
    told = [
        f"{what} is {'' if holds else 'not '}{side} {limit}" if side else f"{what} {limit}"
        for holds, what, limit, side in fallen or facts
    ]
    only = "; the rest of what is recorded does not matter" if robot in ("Ant", "Humanoid") else ""
    if one["touching"][t] and robot in ("Hopper", "Walker2D"):
        only = "; what touches the floor matters for a HalfCheetah alone"
    verdict = "has fallen" if fallen else "has not fallen"
    exact = [limit for _, what, limit, _ in fallen if what.split()[-1] == limit]
    edge = f" Exactly {exact[0]} is not enough: compare with `>` or `<`." if exact else ""
    return f"In step {t} the {robot} {verdict}: {' and '.join(told)}{only}.{edge}"


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
            "The fallen pay the bonus of their robot; all pay 1.": np.where(
                wanted < 0, -wanted.max(), wanted
            ),
            "A robot that has fallen once counts as fallen ever after: judge each step by itself.":
            np.where(np.logical_or.accumulate(wanted < 0), -1.0, wanted),
            **of_row(answer, wanted, lambda t, got, o=one: why_standing(o, t)),
        }  # fmt: skip
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
        "The 0.1 belongs to the mean of the squares, not to the square of the mean.": -scale
        * (2 * np.abs(actions * speeds).mean(axis=1) + 0.1 * actions.mean(axis=1) ** 2),
        "The 0.1 belongs to the mean squared action, not to the mean |action|.": -scale
        * (2 * np.abs(actions * speeds).mean(axis=1) + 0.1 * np.abs(actions).mean(axis=1)),
        "The work is divided by 6, however many joints there are: take their mean.": -scale
        * (2 * np.abs(actions * speeds).sum(axis=1) / 6 + 0.1 * effort),
        "The sums are divided by 6, however many joints there are: take their mean.": wanted
        * actions.shape[1] / 6,
        "The means are sums over the joints.": wanted * actions.shape[1],
        "The speeds stay in units of 10 radians per second: do not multiply them by 10.": -scale
        * (20 * np.abs(actions * speeds).mean(axis=1) + 0.1 * effort),
        "The factor 2 of the work is left out.": -scale
        * (np.abs(actions * speeds).mean(axis=1) + 0.1 * effort),
        "The cost of the squared action is 0.1 times it, not 1 time.": -scale
        * (2 * np.abs(actions * speeds).mean(axis=1) + effort),
        "The squared action is not multiplied by the 2 of the work.": -scale
        * (2 * np.abs(actions * speeds).mean(axis=1) + 0.2 * effort),
        "The work is |action * speed|; the actions are left out of it.": -scale
        * (2 * np.abs(speeds).mean(axis=1) + 0.1 * effort),
        "The mean of a product is not the product of the means: multiply joint by joint.": -scale
        * (2 * np.abs(actions).mean(axis=1) * np.abs(speeds).mean(axis=1) + 0.1 * effort),
        "The means go over the joints of each step, not over the steps, too.": -scale
        * (2 * np.abs(actions * speeds).mean() + 0.1 * (actions**2).mean()) * np.ones(len(actions)),
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


def why_at_limit(one: dict, t: int, got: float) -> str:
    row = one["positions"][t]
    count = int((np.abs(row) > 0.99).sum())
    return (
        f"In step {t}, {count} of the {len(row)} joints at {[round(float(p), 4) for p in row]} "
        f"are beyond 0.99 or -0.99: that makes {-0.1 * count:.1f}, not {got:.4g}."
    )


@costs.check(8)
def counts_joints_at_their_limits(student: Student):
    for i, robot in enumerate(("Hopper", "Ant")):
        one = made_up(robot, 15 + i)
        answer = student.call("joints_at_limit", one["positions"])
        mistakes = {
            "Joints at their lower limits count, too.": -0.1
            * (one["positions"] > 0.99).sum(axis=1),
            "A joint exactly at 0.99 is not at its limit: compare with `>`, not `>=`.": -0.1
            * (np.abs(one["positions"]) >= 0.99).sum(axis=1),
            "A joint is at its limit beyond 0.99, not only from 1 on.": -0.1
            * (np.abs(one["positions"]) >= 1).sum(axis=1),
            "A joint is at its limit beyond 0.99, not only beyond 1.": -0.1
            * (np.abs(one["positions"]) > 1).sum(axis=1),
        }
        wanted = expected_v0(one)["joints_at_limit"]
        mistakes |= of_row(answer, wanted, lambda t, got, o=one: why_at_limit(o, t, got))
        expect_close(student.said, answer, wanted, 1e-6, mistakes)


# ------------------------------------------------------------------- 9.3
standard = exercise.task("9.3", "Version 0", needs=("9.1", "9.2"))


def call_v0(student: Student, one: dict) -> dict:
    answer = student.call("components_v0", one)
    student.said = f"components_v0(a trajectory of a {one['robot']})"
    return answer


def mistaken_v0(one: dict) -> dict:
    """What mistakes make of the components."""
    wanted = expected_v0(one)
    fallen = wanted["alive"] < 0
    slow = wanted["progress"] * one["duration"]
    mistakes = {
        "Use the trajectory's 'duration', not a number.": {"progress": slow / 0.0165},
        "The duration of a step is left out.": {"progress": slow},
        "The fallen get 0, but they pay.": {"alive": np.maximum(wanted["alive"], 0.0)},
        "A robot that has fallen counts as fallen ever after: judge each step by itself.": {
            "alive": np.where(np.logical_or.accumulate(fallen), -1.0, wanted["alive"])
        },
        "Steps after a fall are counted like all others here; do not set them to 0.": {
            key: np.where(np.append(False, np.logical_or.accumulate(fallen)[:-1]), 0.0, values)
            for key, values in wanted.items()
        },
        "The costs are negative numbers: the sign is wrong.": {
            key: -wanted[key] for key in ("electricity", "joints_at_limit")
        },
        "The fallen pay for this, too.": {
            key: np.where(fallen, 0.0, wanted[key]) for key in ("electricity", "joints_at_limit")
        },
        "The components are for each step; these are summed up to each step.": {
            key: np.cumsum(values) for key, values in wanted.items()
        },
    }
    mixed = {
        "'heading' is taken where 'pitch' belongs.": {"pitch": one["heading"]},
        "'positions' are taken where 'actions' belong.": {"actions": one["positions"]},
        "'positions' are taken where 'speeds' belong.": {"speeds": one["positions"]},
        "'actions' are taken where 'speeds' belong.": {"speeds": one["actions"]},
        "'actions' are taken where 'positions' belong.": {"positions": one["actions"]},
        "'speeds' are taken where 'positions' belong.": {"positions": one["speeds"]},
        "'touching' is left out: a HalfCheetah has fallen on shin or thigh.": {
            "touching": np.zeros(len(fallen))
        },
    }
    for text, other in mixed.items():
        made = expected_v0(one | other)
        mistakes[text] = {
            key: made[key] for key in made if not np.array_equal(made[key], wanted[key])
        }
    return mistakes


@standard.check(6)
def rebuilds_version_0(student: Student):
    for i, robot in enumerate(ROBOTS):
        one = made_up(robot, 20 + i)
        answer, wanted = call_v0(student, one), expected_v0(one)
        compare_fields(student.said, answer, wanted, 1e-7, mistaken_v0(one))
        expect_no_other(student.said, answer, wanted)

    one = made_up("Ant", 25, 6) | {"duration": 0.03}
    said = "components_v0(a trajectory of an Ant, 'duration': 0.03)"
    answer = student.call("components_v0", one)
    student.said = said
    compare_fields(said, answer, expected_v0(one), 1e-7, mistaken_v0(one))


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
    v0, squares = expected_v0(one), one["actions"] ** 2
    limits, changes = v0["joints_at_limit"], {}
    if one["robot"] in ("Hopper", "Walker2D"):
        changes["Joints at their limits cost this robot nothing in version 5."] = limits
    else:
        changes["What joints at their limits cost is left out."] = -limits
        changes["Joints at limit is a negative number: add it, do not subtract it."] = -2 * limits
    changes |= {
        "Version 5 has no alive bonus for staying up.": v0["alive"],
        "Version 5 charges nothing for electricity.": v0["electricity"],
        "The duration of a step is left out of the progress.": v0["progress"]
        * (one["duration"] - 1),
        "Use the trajectory's 'duration', not a number.": v0["progress"]
        * (one["duration"] / 0.0165 - 1),
    }
    if one["robot"] == "Ant":
        changes |= {
            "The 0.01 of an Ant is left out.": -0.01,
            "The 0.01 times the mean squared action is left out.": 0.01 * squares.mean(axis=1),
            "The mean squared action is subtracted, not added.": 0.02 * squares.mean(axis=1),
            "An Ant pays for the mean of the squares, not for their sum.": 0.01
            * (squares.mean(axis=1) - squares.sum(axis=1)),
            "An Ant pays for the mean of the squares, not for the square of the mean.": 0.01
            * (squares.mean(axis=1) - one["actions"].mean(axis=1) ** 2),
            "An Ant pays for the squares of its actions, not for their absolute values.": 0.01
            * (squares - np.abs(one["actions"])).mean(axis=1),
            "An Ant gets 0.01, not the 1 of version 0.": 0.99,
        }
    if one["robot"] == "Humanoid":
        past, heading = np.maximum(np.abs(one["positions"]) - 1, 0), one["heading"]
        late = np.maximum(np.abs(one["positions"]) - 0.99, 0)
        beyond = past.sum(axis=1)
        changes |= {
            "The 1 of a Humanoid is left out.": -1.0,
            "A Humanoid gets 1 in version 5, not 2.": 1.0,
            "A Humanoid gets its 1 in every step, fallen or not.": (v0["alive"] > 0) - 1.0,
            "Beyond is left out.": 10 * beyond,
            "Beyond is the sum over the joints, not the largest.": 10 * (beyond - past.max(axis=1)),
            "Beyond is the sum over the joints, not their mean.": 10 * (beyond - past.mean(axis=1)),
            "Beyond begins at 1, not at 0.99.": 10 * (beyond - late.sum(axis=1)),
            "Beyond is how far joints are past their limits, not how many are.": 10
            * (beyond - (past > 0).sum(axis=1)),
            "Beyond counts at the lower limits, too: |position| - 1.": 10
            * (beyond - np.maximum(one["positions"] - 1, 0).sum(axis=1)),
            "Beyond costs 10 times as much.": 9 * beyond,
            "The heading is left out.": 0.1 * heading**2,
            "The heading is to be squared, not |heading|.": 0.1 * (heading**2 - np.abs(heading)),
            "The heading is to be squared.": 0.1 * (heading**2 - heading),
            "The square of the heading costs 0.1 times it.": -0.9 * heading**2,
            "The pitch is taken for the heading.": 0.1 * (heading**2 - one["pitch"] ** 2),
        }
    mistakes = {text: wanted + change for text, change in changes.items()}
    lasting = f", 'duration': {one['duration']:.4g}" if one["duration"] != 0.0165 else ""
    said = student.said = f"reward_v5(a trajectory of a {one['robot']}{lasting})"
    expect_close(said, answer, wanted, tolerance, mistakes)


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


def why_paid(one: dict, t: int) -> str:
    """Why a planar runner gets its bonus after step t, or not."""
    robot, height, pitch = one["robot"], float(one["height"][t]), abs(float(one["pitch"][t]))
    if robot == "PlanarHalfCheetah":
        return "The bonus of a PlanarHalfCheetah is 0, however it stands or lies."
    low, high, lean = (0.7, np.inf, 0.2) if robot == "PlanarHopper" else (0.8, 2, 1)
    wrong = [
        f"{what} {value:.4g} is not {side} {limit}"
        for what, value, side, limit, holds in (
            ("height", height, "above", low, height > low),
            ("height", height, "below", high, height < high),
            ("|pitch|", pitch, "below", lean, pitch < lean),
        )
        if not holds
    ]
    ends = "height and pitch are inside the limits, and there are no others"
    return f"In step {t} the {robot} gets {0 if wrong else 1}: {' and '.join(wrong) or ends}."


@described.check(8)
def rebuilds_version_0_of_planar_runners(student: Student):
    for i, robot in enumerate(PLANAR):
        one = made_up_planar(robot, 50 + i)
        wanted, means = expected_planar(one), (one["actions"] ** 2).mean(axis=1)
        price = 0.1 if robot == "PlanarHalfCheetah" else 0.001
        mistakes = {
            "The effort is the sum over the joints, not their mean.": {"effort": -price * means},
            "The fallen get 0 here, not -1.": {"alive": 2 * wanted["alive"] - 1},
            "The effort is a negative number.": {"effort": -wanted["effort"]},
            "The effort takes the squares of the actions, not |action|.": {
                "effort": -price * np.abs(one["actions"]).sum(axis=1)
            },
            f"The factor of a {robot}'s effort is {price}.": {
                "effort": wanted["effort"] * (100 if price < 0.1 else 0.01)
            },
            f"Squares of actions cost {price} times them: the factor is left out.": {
                "effort": wanted["effort"] / price
            },
            "Use the trajectory's 'duration', not the 0.0165 s of PyBullet.": {
                "progress": wanted["progress"] * one["duration"] / 0.0165
            },
        }
        answer = call_planar(student, one)
        if isinstance(answer, dict):
            told = of_row(
                answer.get("alive"), wanted["alive"], lambda t, got, o=one: why_paid(o, t)
            )
            mistakes |= {text: {"alive": made} for text, made in told.items()}
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


def mistaken_gait(one: dict) -> dict:
    """What mistakes make of each number: pairs of a sentence and a value."""
    v0, wanted, feet = expected_planar(one), expected_gait(one), one["feet"]
    steps, distance = len(one["height"]), one["distance"]
    progress, alive, effort = v0["progress"], v0["alive"].sum(), v0["effort"].sum()
    moved, metres = progress[progress > 0].sum(), wanted["metres"]

    def share(part, whole):
        return part / whole if whole else 0.0

    return {
        "metres": [
            ("Going away is negative.", abs(metres)),
            ("The way begins at the start, not after the first step.", distance[1] - distance[-1]),
            ("The way goes to the end, not to the nearest point.", distance[0] - min(distance)),
            ("The way goes to the end, not to the last step but one.", distance[0] - distance[-2]),
            ("Steps backwards count, too.", moved * one["duration"]),
            ("This is the path, back and forth; the metres are from start to end.",
             np.abs(np.diff(distance)).sum()),
            ("This is the sum of speeds: a speed times the duration is a way.", progress.sum()),
        ],
        "seconds": [
            ("A step lasts as long as the trajectory's duration says.", 0.0165 * steps),
            ("The start is no step: T steps have T + 1 distances.", one["duration"] * (steps + 1)),
            ("All T steps count, the first and the last, too.", one["duration"] * (steps - 1)),
            ("This is the number of steps, not their time.", steps),
        ],
        "speed": [
            ("Steps backwards count with a minus sign.", np.abs(progress).mean()),
            ("Steps backwards count with a minus sign, not as 0.", np.maximum(progress, 0).mean()),
            ("The mean goes over all steps, not over those forward only.",
             progress[progress > 0].mean() if moved else 0.0),
            ("Going away is a negative speed.", abs(wanted["speed"])),
            ("This is metres a step, not a second.", metres / steps),
            ("This is the median of the steps' speeds, not their mean.", np.median(progress)),
            ("This is the speed of the last step.", progress[-1]),
            ("This is the highest speed.", progress.max()),
        ],
        "standing": [
            ("Effort is no income: leave it out.", share(alive, alive + moved + effort)),
            ("The effort is no income, and its sign does not matter.",
             share(alive, alive + moved - effort)),
            ("Steps backwards are left out one by one, not subtracted from the sum.",
             share(alive, alive + max(progress.sum(), 0))),
            ("Steps backwards are left out; here they are subtracted.",
             share(alive, alive + progress.sum())),
            ("Steps backwards are left out; here their size is added.",
             share(alive, alive + np.abs(progress).sum())),
            ("Speeds are added up, not metres.", share(alive, alive + moved * one["duration"])),
            ("This is the share of progress, not of standing.", share(moved, alive + moved)),
            ("This is alive by progress, not alive by all of the income.", share(alive, moved)),
            ("This is the share of steps in which it stands, not of its income.", alive / steps),
            ("A robot that earns nothing has the share 0.0.", 0.0 if alive + moved else 1.0),
        ],
        "grounded": [
            ("One foot on the ground is enough.", feet.min(axis=1).mean()),
            ("Only the first foot counts.", feet[:, 0].mean()),
            ("Only the last foot counts.", feet[:, -1].mean()),
            ("The feet are counted, but only whether any of them is down matters.", feet.mean()),
            ("Steps with two feet down count once, not twice.", feet.sum() / steps),
            ("This is the share of steps in the air.", 1 - wanted["grounded"]),
            ("This is the number of steps, not their share.", wanted["grounded"] * steps),
        ],
    }  # fmt: skip


def compare_gait(student: Student, one: dict) -> None:
    answer = student.call("gait", one)
    wanted = expected_gait(one)
    mistakes = {
        text: {key: value} for key, pairs in mistaken_gait(one).items() for text, value in pairs
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


def mistaken_means(runner, rows: np.ndarray, seed: int, episodes: int) -> dict:
    """What mistakes make of the mean gaits."""
    from botschool.course.locomotion import Runner

    in_v0 = Runner("PlanarHalfCheetah-v0")
    wanted = mean_gaits(runner, rows, seed, episodes)
    first, last = (mean_gaits(runner, rows, seed + i, 1) for i in (0, episodes - 1))
    run_on = [
        mean_gaits(runner, rows[i : i + 1], seed + i * episodes, episodes) for i in range(len(rows))
    ]
    return {
        "All are to be recorded in version 5.": mean_gaits(in_v0, rows, seed, episodes),
        "Only the first episode counts.": first,
        "Only the last episode counts.": last,
        "The first episode has the seed itself, not the next one.": mean_gaits(
            runner, rows, seed + 1, episodes
        ),
        "There is one episode too many.": mean_gaits(runner, rows, seed, episodes + 1),
        "Each row begins anew with the same seed: yours runs on from row to row.": {
            name: np.concatenate([each[name] for each in run_on]) for name in wanted
        },
        "Each row has a number of its own, the mean over its episodes: this is the mean over "
        "all rows.": {name: np.full(len(rows), np.mean(wanted[name])) for name in wanted},
        "This is the median over the episodes, not their mean.": mean_gaits(
            runner, rows, seed, episodes, np.median
        ),
        "These are the sums over the episodes, not their means.": {
            name: episodes * wanted[name] for name in wanted
        },
    }


def same(found, name: str, wanted: np.ndarray) -> bool:
    """Whether a dict has the wanted numbers under a name."""
    try:
        return bool(np.allclose(found[name], wanted, 1e-5, 1e-5))
    except (TypeError, ValueError, LookupError):
        return False


def compares_one(student: Student, runner, genotypes: dict, index: int, episodes: int) -> None:
    seed = exercise.seed(index) % 100_000
    answer = student.call("compare", "PlanarHalfCheetah", genotypes, seed, episodes)
    robots = " and ".join(f"{len(rows)} of {key}" for key, rows in genotypes.items())
    said = f"compare('PlanarHalfCheetah', genotypes of robots, {robots}, "
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
        genotypes = expect_array(f"{said}: {version}", genotypes, (len(seeds), runner.size))
        for i, (seed, genotype) in enumerate(zip(seeds, genotypes, strict=True)):
            same = bool(np.array_equal(genotype, runner.evolve(steps, seed)))
            expect(
                same,
                f"{said}: {version} holds in row {i} a robot that is not the one that {steps} "
                f"steps of evolution with the seed {seed} in {runner.environment} lead to."
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
