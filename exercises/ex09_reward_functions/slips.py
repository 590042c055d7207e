"""Compute what slips make of answers, and why right answers are right; for the grader."""

from functools import cache, reduce

import numpy as np

from botschool.grading import slips

ROBOTS = {"Hopper": 3, "HalfCheetah": 6, "Ant": 8, "Walker2D": 6, "Humanoid": 17}

PLANAR = {
    "PlanarHopper": (0.008, 3, 1),
    "PlanarWalker2D": (0.008, 6, 2),
    "PlanarHalfCheetah": (0.05, 6, 2),
}
"""Seconds of a step, joints, feet."""


# What is right, computed apart from any submission, step by step.


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


def mistaken_progress(distance: np.ndarray, duration: float) -> dict:
    """What slips make of the progress: sentence -> array."""
    nearer = distance[:-1] - distance[1:]
    two = -np.gradient(distance) if len(nearer) > 1 else np.append(nearer, nearer)
    return slips(
        lambda way, time: way / time,
        way={
            "": nearer,
            "The sign is wrong: it is reversed, but coming nearer should be positive.": -nearer,
            "Going away counts as 0, but it should be negative.": np.maximum(nearer, 0.0),
            "Going away counts as much as coming nearer, but it should be negative.":
            np.abs(nearer),
            "The way of each step is measured from the start of the episode, but should be "
            "measured from the distance just before the step.":
            distance[0] - distance[1:],
            "The way of each step is measured to the end of the episode, but should be measured "
            "to the distance just after the step.":
            distance[:-1] - distance[-1],
            "Each step has the mean way of all steps, but should have its own.":
            np.full(len(nearer), nearer.mean()),
            "The way of a step is the mean of two steps, as np.gradient makes it, but the "
            "difference of two neighbours is asked for.": two[1:],
            "The way of a step is the mean of two steps, as np.gradient makes it, but the "
            "difference of the two neighbours is asked for.": two[:-1],
            "Each step has the progress of the step after it, and the last one has 0.":
            np.append(nearer[1:], 0.0),
            "Each step has the progress of the step before it, and the first one has 0.":
            np.append(0.0, nearer[:-1]),
            "The progress is added up from step to step, but each step should have its own.":
            np.cumsum(nearer),
            "The distance after each step is taken, but the difference of two distances is asked "
            "for.":
            distance[1:],
            "The first step is missing, and the last one goes from the end back to the start, as "
            "np.roll makes it.":
            np.append(nearer[1:], distance[-1] - distance[0]),
            "The first step is missing, but T + 1 distances make T steps.": nearer[1:],
            "The last step is missing, but T + 1 distances make T steps.": nearer[:-1],
            "There is a 0 for the start, but T + 1 distances make only T steps.":
            np.append(0.0, nearer),
        },
        time={
            "": duration,
            "The division by the duration of a step is left out.": 1.0,
            "The way is multiplied by the duration, but should be divided by it.": 1 / duration,
            "A step of 0.0165 s is used, but `duration` is asked for.": 0.0165,
            "The way is divided by the time since the start, but should be divided by the "
            "duration of a step.":
            duration * np.arange(1, len(nearer) + 1),
            "The way is divided by the duration of the episode, but should be divided by that of "
            "a step.":
            duration * len(nearer),
            "The way is divided by the square of the duration, but should be divided by the "
            "duration.": duration**2,
            "The way is divided by the distance, too, but should be divided by the duration "
            "alone.": duration * distance[:-1],
            "This is in kilometres per hour, but metres per second are asked for.": duration / 3.6,
        },
    )  # fmt: skip


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
        down = "1" if one["touching"][t] else "0"
        facts.append((down == "0", f"touching is {down}", "(1 means on shin or thigh)", ""))
    fallen = [fact for fact in facts if not fact[0]]
    told = [
        f"{what} is {'' if holds else 'not '}{side} {limit}" if side else f"{what} {limit}"
        for holds, what, limit, side in fallen or facts
    ]
    only = "; nothing else matters for this robot" if robot in ("Ant", "Humanoid") else ""
    if one["touching"][t] and robot in ("Hopper", "Walker2D"):
        only = "; `touching` matters for a HalfCheetah only"
    verdict = "has fallen" if fallen else "has not fallen"
    exact = [limit for _, what, limit, _ in fallen if what.split()[-1] == limit]
    edge = f" Exactly {exact[0]} counts as fallen: compare with `>` or `<`." if exact else ""
    return f"In step {t} the {robot} {verdict}: {' and '.join(told)}{only}.{edge}"


def mistaken_bonus(one: dict) -> dict:
    """What slips make of the alive bonus: sentence -> array."""
    robot, steps = one["robot"], len(one["height"])
    wanted = expected_v0(one)["alive"]
    upright, off = np.abs(one["pitch"]) < 1, one["touching"] == 0
    low = {"Ant": 0.26, "Humanoid": 0.78, "HalfCheetah": -1.0}.get(robot, 0.8)
    high, leans = one["height"] > low, robot not in ("Ant", "Humanoid")
    cheetah = robot == "HalfCheetah"
    stands = {
        "A pitch of -1 or less counts as upright, but abs(pitch) should be below 1.":
        high & ((one["pitch"] < 1) | (not leans)) & (off | (not cheetah)),
        "A pitch of 1 or more counts as upright, but abs(pitch) should be below 1.":
        high & ((one["pitch"] > -1) | (not leans)) & (off | (not cheetah)),
        "A robot that has fallen once counts as fallen in all later steps, but each step should "
        "be judged by itself.":
        np.logical_and.accumulate(wanted > 0),
        f"The pitch is left out, but the {robot} with |pitch| of 1 or more has fallen.":
        high & (off | (not cheetah)),
        f"The {'touching' if cheetah else 'height'} is left out, but the {robot} "
        f"{'on shin or thigh' if cheetah else f'at {low} or below'} has fallen.":
        upright | (not leans),
        f"The {'touching' if cheetah else 'pitch'} "
        f"{'is left out, but should be 0' if cheetah else 'counts, but should not matter'} "
        f"for the {robot}.":
        upright & high,
        f"The {robot} counts as fallen only if both conditions are broken, but one is enough.":
        (high | upright) if leans and not cheetah else (upright | off),
        f"The pitch counts, but should not matter for the {robot}.": high & upright,
        f"The touching counts, but should not matter for the {robot}.":
        (wanted > 0) & off,
        "`touching` counts the wrong way round: 1 should mean that shin or thigh was on the "
        "floor.":
        upright & ~off,
        "Only a pitch near 0 counts as upright, as with a limit of 1 degree, but 1 radian is "
        "asked for.":
        high & ((np.abs(np.degrees(one["pitch"])) < 1) | (not leans)) & (off | (not cheetah)),
        "Height and pitch are exchanged.":
        (one["pitch"] > low) & ((np.abs(one["height"]) < 1) | (not leans)),
        "A limit itself counts as standing, but `>` and `<` are asked for, not `>=` and `<=`.":
        (one["height"] >= low) & ((np.abs(one["pitch"]) <= 1) | (not leans))
        & (off | (not cheetah)),
        "A height exactly at its limit counts as standing, but `>` is asked for, not `>=`.":
        (one["height"] >= low) & (upright | (not leans)) & (off | (not cheetah)),
        "A pitch of exactly 1 or -1 counts as upright, but `<` is asked for, not `<=`.":
        high & ((np.abs(one["pitch"]) <= 1) | (not leans)) & (off | (not cheetah)),
        "All steps count as fallen, but each step should be judged by itself.":
        np.full(steps, bool((wanted > 0).all())),
        "All steps count as standing, but each step should be judged by itself.":
        np.full(steps, True),
        "The comparison is the wrong way round: the fallen count as standing, and the standing as "
        "fallen.": wanted < 0,
    } | {
        f"The height is compared with the limit of {other}, but the table has {low} for {robot}.":
        (one["height"] > limit) & (upright | (not leans))
        for other, limit in (("the Ant", 0.26), ("the Humanoid", 0.78), ("the Hopper", 0.8))
        if limit != low and not cheetah
    }  # fmt: skip
    bonus = wanted.max()
    return slips(
        lambda stands, paid: np.where(stands, *paid),
        stands={"": wanted > 0, **stands},
        paid={
            "": (bonus, -1.0),
            "The fallen get 0, but -1 is asked for.": (bonus, 0.0),
            "The fallen get minus the bonus of their robot, but all of them should get -1.": (
                bonus,
                -bonus,
            ),
            f"The bonus of the {robot} is {3 - bonus:g}, but {bonus:g} is asked for.": (
                3 - bonus,
                -1.0,
            ),
            "Those who stand get 1 and the fallen 0, but the bonus of the table and -1 are asked "
            "for.": (1.0, 0.0),
        },
    )


def why_electricity(one: dict, t: int) -> str:
    action, speed, n = one["actions"][t], one["speeds"][t], one["actions"].shape[1]
    work, effort = np.abs(action * speed).mean(), (action**2).mean()
    price = f"-2 * {work:.5g} - 0.1 * {effort:.5g}"
    price = f"4.25 * ({price})" if one["robot"] == "Humanoid" else price
    return (
        f"In step {t}, the mean |action * speed| of the {n} joints is {work:.5g} and their mean "
        f"squared action {effort:.5g}, so it should be {price}."
    )


def mistaken_electricity(one: dict) -> dict:
    """What slips make of the cost: sentence -> array."""
    actions, speeds, joints = one["actions"], one["speeds"], one["actions"].shape[1]
    product, squares, zero = actions * speeds, actions**2, 0 * actions[:, 0]
    humanoid, six = one["robot"] == "Humanoid", "by 6, however many joints there are, but their"
    work = {
        "": np.abs(product).mean(axis=1),
        "Braking is paid for: action * speed keeps its sign, but |action * speed| of each joint "
        "is asked for.": product.mean(axis=1),
        "The absolute value is taken of the mean over the joints, but |action * speed| of each "
        "joint should come first.": np.abs(product.mean(axis=1)),
        "The work is added up over the joints, but their mean is asked for.": np.abs(product).sum(
            axis=1
        ),
        f"The sum of the work is divided {six} mean is asked for.": np.abs(product).sum(axis=1) / 6,
        "The work of the joint that does most is taken, but the mean over the joints is asked "
        "for.": np.abs(product).max(axis=1),
        "The median of the work is taken, but the mean over the joints is asked for.": np.median(
            np.abs(product), axis=1
        ),
        "The actions are left out of the work, but |action * speed| is asked for.": np.abs(
            speeds
        ).mean(axis=1),
        "The speeds are left out of the work, but |action * speed| is asked for.": np.abs(
            actions
        ).mean(axis=1),
        "The work is squared, but |action * speed| itself is asked for.": (product**2).mean(axis=1),
        "The work is the root of the mean square, but the mean of |action * speed| is asked "
        "for.": np.sqrt((product**2).mean(axis=1)),
        "The mean |action| is multiplied by the mean |speed|, but action and speed should be "
        "multiplied joint by joint.": np.abs(actions).mean(axis=1) * np.abs(speeds).mean(axis=1),
        "The mean of the work goes over all steps, too, but should go over the joints of each "
        "step only (axis=1).": np.full(len(actions), np.abs(product).mean()),
        "The work is left out, but 2 times the mean of |action * speed| is asked for.": np.zeros(
            len(actions)
        ),
        "Negative work counts as 0, but |action * speed| should count.": np.maximum(
            product, 0
        ).mean(axis=1),
    }
    effort = {
        "": squares.mean(axis=1),
        "The mean squared action is left out, but 0.1 times it is asked for.": zero,
        "The square of the mean action is taken, but the mean of the squared actions is asked "
        "for.": actions.mean(axis=1) ** 2,
        "The mean |action| is taken for the second part, but the mean squared action is asked "
        "for.": np.abs(actions).mean(axis=1),
        "The squared actions are added up over joints, but their mean is asked for.": squares.sum(
            axis=1
        ),
        f"The sum of the squared actions is divided {six} mean is asked for.": squares.sum(axis=1)
        / 6,
        "The root of the mean squared action is taken, but the mean squared action itself is "
        "asked for.": np.sqrt(squares.mean(axis=1)),
        "The speeds are squared, but the mean squared action is asked for.": (speeds**2).mean(
            axis=1
        ),
        "The second mean is that of |action * speed| again, but the mean squared action is asked "
        "for.": np.abs(product).mean(axis=1),
        "The mean squared action goes over all steps, too, but should go over the joints of each "
        "step only.": squares.mean() + zero,
        "The mean action is not squared, but the mean squared action is asked for.": actions.mean(
            axis=1
        ),
    }
    found = slips(
        lambda work, effort, prices, factors: -(
            factors[0] * prices[0] * work + factors[1] * prices[1] * effort
        ),
        work=work,
        effort=effort,
        prices={
            "": (2.0, 0.1),
            "The factor of the work is 20, but 2 is asked for: the speeds should stay in units of "
            "10 rad/s.":
            (20.0, 0.1),
            "The factor 2 of the work is left out.": (1.0, 0.1),
            "The factor 0.1 of the mean squared action is left out.": (2.0, 1.0),
            "The mean squared action is multiplied by 0.2 instead of 0.1.": (2.0, 0.2),
            "The factors 2 and 0.1 are exchanged: 2 should be that of the work.": (0.1, 2.0),
            "The mean squared action makes the cost smaller, but should add to it.": (2.0, -0.1),
            "The work is multiplied by 0.2 instead of 2.": (0.2, 0.1),
        },
        factors={
            "": (4.25, 4.25) if humanoid else (1.0, 1.0),
            "The sign is wrong: the cost should be a negative number.":
            (-4.25, -4.25) if humanoid else (-1.0, -1.0),
            **({
                "The Humanoid pays as much as other robots, but should pay 4.25 times as much.":
                (1.0, 1.0),
                "Only the Humanoid's work is multiplied by 4.25, but its mean squared action "
                "should be, too.": (4.25, 1.0),
                "Only the Humanoid's mean squared action is multiplied by 4.25, but its work "
                "should be, too.": (1.0, 4.25),
                "The Humanoid's electricity is divided by 4.25, but should be multiplied by it.":
                (1 / 4.25, 1 / 4.25),
                "The Humanoid's electricity is multiplied by 4.25 twice, but once is asked for.":
                (4.25**2, 4.25**2),
            } if humanoid else {
                "The cost is multiplied by 4.25, but only a Humanoid should pay so much.":
                (4.25, 4.25),
            }),
        },
    )  # fmt: skip
    cost = found["The sign is wrong: the cost should be a negative number."]
    return {
        "The sums are divided by 6, however many joints there are, but means are asked for.":
        -cost * joints / 6,
        "Sums over the joints are taken, but means are asked for.": -cost * joints,
        "The means go over all steps, too, but should go over the joints of each step only.":
        np.full(len(cost), -cost.mean()),
    } | found  # fmt: skip


def why_at_limit(one: dict, t: int) -> str:
    row = one["positions"][t]
    count = int((np.abs(row) > 0.99).sum())
    return (
        f"In step {t}, the number of joints above 0.99 or below -0.99 is {count} of {len(row)}, at "
        f"{[round(float(p), 4) for p in row]}, so it should be {-0.1 * count:.1f}."
    )


def mistaken_limits(positions: np.ndarray) -> dict:
    """What slips make of the cost of limits: sentence -> array."""
    size = np.abs(positions)
    found = slips(
        lambda there, over, price: price * over(there),
        there={
            "": size > 0.99,
            "Only joints above 0.99 count, but those below -0.99 are at their limits, too.":
            positions > 0.99,
            "Only joints below -0.99 count, but those above 0.99 are at their limits, too.":
            positions < -0.99,
            "A joint exactly at 0.99 or -0.99 counts, but only those above 0.99 or below -0.99 "
            "should.":
            size >= 0.99,
            "Joints count only if |position| is 1 or more, but all beyond 0.99 should count.":
            size >= 1,
            "Joints count only if |position| is above 1, but all beyond 0.99 should count.":
            size > 1,
            "Joints past their limits, such as 1.2, are left out, but should count, too.":
            (size > 0.99) & (size <= 1),
            "The comparison is the wrong way round: joints that are not at their limits count.":
            size < 0.99,
            "The |position| of each joint at its limit is added up, but these joints should be "
            "counted.":
            size * (size > 0.99),
        },
        over={
            "": lambda there: there.sum(axis=1),
            "The share of joints at their limits (a mean) is taken, but their number is asked "
            "for.":
            lambda there: there.mean(axis=1),
            "It only matters whether any joint is at its limit, but these joints should be "
            "counted.":
            lambda there: there.any(axis=1),
            "It only matters whether all joints are at their limits, but those that are should be "
            "counted.":
            lambda there: there.all(axis=1),
            "The joints of all steps are counted together, but each step should have its own "
            "number (axis=1).":
            lambda there: np.full(len(there), there.sum()),
            "The numbers are added up from step to step, but each step should have its own "
            "number.":
            lambda there: np.cumsum(there.sum(axis=1)),
        },
        price={
            "": -0.1,
            "A joint at its limit gives 0.1, but -0.1 is asked for.": 0.1,
            "The factor 0.1 is left out.": -1.0,
            "A joint at its limit costs 0.01, but 0.1 is asked for.": -0.01,
        },
    )  # fmt: skip
    return {text: value for text, value in found.items() if value.any()}  # 0 tells nothing apart


def mistaken_components(one: dict) -> dict:
    """What mistakes make of the components, in `components_v0` or in the functions of before."""
    found = mistaken_v0(one)
    written_anew = {
        "electricity": mistaken_electricity(one),
        "joints_at_limit": mistaken_limits(one["positions"]),
        "alive": mistaken_bonus(one),
        "progress": mistaken_progress(one["distance"], one["duration"]),
    }
    for key, made in written_anew.items():
        for text, value in made.items():
            found[text] = {key: value, **found.get(text, {})}
    return found


def mistaken_v0(one: dict) -> dict:
    """What mistakes make of the components."""
    wanted = expected_v0(one)
    fallen = wanted["alive"] < 0
    slow = wanted["progress"] * one["duration"]
    mistakes = {
        "A step of 0.0165 s is used, but the trajectory's 'duration' is asked for.": {
            "progress": slow / 0.0165
        },
        "The division by the duration of a step is left out.": {"progress": slow},
        "The fallen get 0, but -1 is asked for.": {"alive": np.maximum(wanted["alive"], 0.0)},
        "A robot that has fallen once counts as fallen in all later steps, but each step should "
        "be judged by itself.": {
            "alive": np.where(np.logical_or.accumulate(fallen), -1.0, wanted["alive"])
        },
        "Steps after the first fall are set to 0, but should count like all others.": {
            key: np.where(np.append(False, np.logical_or.accumulate(fallen)[:-1]), 0.0, values)
            for key, values in wanted.items()
        },
        "The sign is wrong: costs should be negative numbers.": {
            key: -wanted[key] for key in ("electricity", "joints_at_limit")
        },
        "The component is multiplied by the duration of a step, but should not depend on it.": {
            key: wanted[key] * one["duration"]
            for key in ("alive", "electricity", "joints_at_limit")
        },
        "The fallen pay nothing for this, but should pay like all others.": {
            key: np.where(fallen, 0.0, wanted[key]) for key in ("electricity", "joints_at_limit")
        },
        "The component is added up from step to step, but each step should have its own number.": {
            key: np.cumsum(values) for key, values in wanted.items()
        },
        "This is the sum over the steps, but an array of T numbers, one for each step, is asked "
        "for.": {key: values.sum() for key, values in wanted.items()},
        "This is the mean over the steps, but an array of T numbers, one for each step, is asked "
        "for.": {key: values.mean() for key, values in wanted.items()},
        "This is the sum of all four components, but each should stand alone.": dict.fromkeys(
            wanted, sum(wanted.values())
        ),
    }
    for other in ROBOTS:
        if other != one["robot"]:
            made = expected_v0(one | {"robot": other})
            mistakes[
                f"The robot is taken for the {other}, but trajectory['robot'] should decide."
            ] = {key: made[key] for key in made if not np.array_equal(made[key], wanted[key])}
    if one["robot"] == "Humanoid":
        mistakes["The fallen Humanoid gets -2, but -1 is asked for."] = {
            "alive": np.where(fallen, -2.0, wanted["alive"])
        }
    end = int(np.argmax(fallen)) + 1 if fallen.any() else len(fallen)
    for last, word in ((end, "after the first fall"), (end - 1, "from the first fall on")):
        mistakes[f"The steps {word} are left out, but all T steps should count."] = {
            key: values[:last] for key, values in wanted.items()
        }
    mixed = {
        "Height and pitch are exchanged, but alive_bonus takes height first.": {
            "height": one["pitch"],
            "pitch": one["height"],
        },
        "'heading' is taken where 'height' belongs.": {"height": one["heading"]},
        "Actions and speeds are exchanged, but electricity takes actions first.": {
            "actions": one["speeds"],
            "speeds": one["actions"],
        },
        "'heading' is taken where 'pitch' belongs.": {"pitch": one["heading"]},
        "'positions' are taken where 'actions' belong.": {"actions": one["positions"]},
        "'positions' are taken where 'speeds' belong.": {"speeds": one["positions"]},
        "'actions' are taken where 'speeds' belong.": {"speeds": one["actions"]},
        "'actions' are taken where 'positions' belong.": {"positions": one["actions"]},
        "'speeds' are taken where 'positions' belong.": {"positions": one["speeds"]},
        "'touching' is left out, but a HalfCheetah on shin or thigh has fallen.": {
            "touching": np.zeros(len(fallen))
        },
    }
    for text, other in mixed.items():
        made = expected_v0(one | other)
        mistakes[text] = {
            key: made[key] for key in made if not np.array_equal(made[key], wanted[key])
        }
    return mistakes


def mistaken_v5(one: dict) -> dict:
    """What slips make of the reward of version 5: sentence -> array."""
    v0, robot, wanted = expected_v0(one), one["robot"], expected_v5(one)
    progress, limits, alive = v0["progress"], v0["joints_at_limit"], v0["alive"]
    terms = {
        "progress": {
            "": progress,
            "The progress is not divided by the duration of a step.": progress * one["duration"],
            "A step of 0.0165 s is used, but the trajectory's 'duration' is asked for.": progress
            * one["duration"]
            / 0.0165,
            "Progress is left out.": 0.0,
            "Progress is added twice, but once is asked for.": 2 * progress,
            "Progress has the wrong sign.": -progress,
        },
        "alive": {"": 0.0, "The alive bonus of version 0 is added, but version 5 has none.": alive},
        "electricity": {
            "": 0.0,
            "Electricity is charged, but should cost nothing in version 5.": v0["electricity"],
        },
        "limits": {
            "": limits,
            "Joints at limit is left out, but should be added.": 0.0,
            "Joints at limit is subtracted, but it is a negative number already, and should be "
            "added.": -limits,
            "Joints at limit is added twice, but once is asked for.": 2 * limits,
        },
    }
    if robot in ("Hopper", "Walker2D"):
        terms["limits"] = {
            "": 0.0,
            "Joints at limit is added, but should cost this robot nothing in version 5.": limits,
        }
    if robot == "Ant":
        terms |= terms_of_an_ant(one["actions"])
    if robot == "Humanoid":
        terms |= terms_of_a_humanoid(one, alive)
    return slips(lambda **each: sum(each.values()), **terms) | {
        "This is the sum over the steps, but an array of T numbers, one for each step, is asked "
        "for.": wanted.sum(),
        "The reward is added up from step to step, but each step should have its own.":
        np.cumsum(wanted),
    }  # fmt: skip


def terms_of_an_ant(actions: np.ndarray) -> dict:
    squares = (actions**2).mean(axis=1)
    return {
        "given": {
            "": 0.01,
            "The Ant's 0.01 is left out.": 0.0,
            "The Ant gets the 1 of version 0, but 0.01 is asked for.": 1.0,
            **{f"The Ant gets {much}, but 0.01 is asked for.": much for much in (0.1, 0.001)},
        },
        "effort": {
            "": -0.01 * squares,
            "The mean squared action is left out, but 0.01 times it should be subtracted.": 0.0,
            "The mean squared action is added, but should be subtracted.": 0.01 * squares,
            "The Ant pays for the sum of its squared actions, but should pay for their mean.":
            -0.01 * (actions**2).sum(axis=1),
            "The Ant pays for the square of its mean action, but should pay for the mean of the "
            "squared actions.":
            -0.01 * actions.mean(axis=1) ** 2,
            "The Ant pays for the mean |action|, but should pay for the mean squared action.":
            -0.01 * np.abs(actions).mean(axis=1),
            **{
                f"The factor of the mean squared action is {much}, but 0.01 is asked for.":
                -much * squares
                for much in (0.1, 0.001, 1.0)
            },
        },
    }  # fmt: skip


def terms_of_a_humanoid(one: dict, alive: np.ndarray) -> dict:
    positions, heading = np.abs(one["positions"]), one["heading"]
    past = np.maximum(positions - 1, 0)
    beyond = past.sum(axis=1)
    return {
        "given": {
            "": 1.0,
            "The Humanoid's 1 is left out.": 0.0,
            "The Humanoid gets 2, but 1 is asked for.": 2.0,
            "The Humanoid gets its 1 only while it stands, but 1 in every step is asked for.":
            1.0 * (alive > 0),
            "The Humanoid gets the alive bonus of version 0 (2 or -1), but 1 in every step is "
            "asked for.":
            alive,
            "The Humanoid gets 1 or -1, but 1 in every step is asked for.": np.sign(alive),
        },
        "beyond": {
            "": -10 * beyond,
            "Beyond is added, but should be subtracted.": 10 * beyond,
            "The max is left out of beyond, but max(0, |position| - 1) is asked for.":
            -10 * (positions - 1).sum(axis=1),
            "The whole |position| of a joint past its limit is taken for beyond, but |position| - "
            "1 is asked for.":
            -10 * (positions * (past > 0)).sum(axis=1),
            "Each |position| - 1 is squared for beyond, but should be taken as it is.":
            -10 * (past**2).sum(axis=1),
            "The factor of beyond is 0.1, but 10 is asked for.": -0.1 * beyond,
            "Beyond is left out.": 0.0,
            "Only the joint farthest past its limit is taken for beyond, but the sum over all "
            "joints is asked for.": -10 * past.max(axis=1),
            "The mean over the joints is taken for beyond, but their sum is asked for.":
            -10 * past.mean(axis=1),
            "Beyond begins at 0.99, but should begin at 1.":
            -10 * np.maximum(positions - 0.99, 0).sum(axis=1),
            "Beyond is the number of joints past their limits, but how far they are past is asked "
            "for.":
            -10 * (past > 0).sum(axis=1),
            "Only joints above 1 count for beyond, but those below -1 should, too.":
            -10 * np.maximum(one["positions"] - 1, 0).sum(axis=1),
            "The factor 10 of beyond is left out.": -beyond,
        },
        "heading": {
            "": -0.1 * heading**2,
            "The heading's part is added, but should be subtracted.": 0.1 * heading**2,
            "The heading is left out.": 0.0,
            "|heading| is taken, but heading^2 is asked for.": -0.1 * np.abs(heading),
            "The heading is taken as it is, but heading^2 is asked for.": -0.1 * heading,
            "The factor 0.1 of heading^2 is left out.": -(heading**2),
            "The pitch is taken instead of the heading.": -0.1 * one["pitch"] ** 2,
        },
    }  # fmt: skip


def why_v5(one: dict, t: int) -> str:
    """The terms of the reward of step t."""
    v0, positions = expected_v0(one), np.abs(one["positions"][t])
    terms = [f"progress {v0['progress'][t]:.5g}"]
    if one["robot"] == "Ant":
        terms.append(f"0.01 - 0.01 * (mean squared action {np.mean(one['actions'][t] ** 2):.5g})")
    if one["robot"] == "Humanoid":
        beyond = np.maximum(positions - 1, 0).sum()
        terms.append(f"1 - 10 * (beyond {beyond:.5g}) - 0.1 * (heading {one['heading'][t]:.5g})^2")
    if one["robot"] not in ("Hopper", "Walker2D"):
        terms.append(f"joints at limit {v0['joints_at_limit'][t]:.3g}")
    nothing = " alone" if len(terms) == 1 else ""
    return f"The {one['robot']}'s reward of step {t} should be {' + '.join(terms)}{nothing}."


def why_paid(one: dict, t: int) -> str:
    """Why a planar runner gets its bonus after step t, or not."""
    robot, height, pitch = one["robot"], float(one["height"][t]), abs(float(one["pitch"][t]))
    if robot == "PlanarHalfCheetah":
        return "The bonus of a PlanarHalfCheetah should be 0 in every step."
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
    ends = "height and pitch are inside their limits, and nothing else matters"
    return f"In step {t} the {robot} should get {0 if wrong else 1}: {' and '.join(wrong) or ends}."


def mistaken_falls(one: dict) -> dict:
    """What slips make of a planar runner's bonus: sentence -> array."""
    robot, height, pitch = one["robot"], one["height"], np.abs(one["pitch"])
    steep = {"PlanarHopper": 0.2, "PlanarWalker2D": 1.0}.get(robot, np.inf)
    low, high = {"PlanarHopper": (0.7, np.inf), "PlanarWalker2D": (0.8, 2.0)}.get(robot, (0, 0))
    stands = {
        "A PlanarHalfCheetah gets a bonus of 1 in every step, but 0 is asked for.": np.ones(
            len(height)
        ),
        "A PlanarHalfCheetah gets a bonus where |pitch| is below 1, but 0 in every step is asked "
        "for.": pitch < 1,
        "The limits are those of PyBullet's Hopper and Walker2D, but planar runners should be "
        "judged by their own table.": (height > 0.8) & (pitch < 1),
    }
    if robot != "PlanarHalfCheetah":
        tall, up = (height > low) & (height < high), pitch < steep
        stands = {
            "The limits are those of PyBullet's Hopper and Walker2D, but planar runners should be "
            "judged by their own table.":
            (height > 0.8) & (pitch < 1),
            "The limits of PlanarHopper and PlanarWalker2D are mixed up.":
            (height > 0.8) & (height < 2) & (pitch < 1) if steep < 1
            else (height > 0.7) & (pitch < 0.2),
            "The pitch is left out.": tall,
            "The height is left out.": up,
            "A negative pitch always counts as upright, but abs(pitch) should be below the "
            "limit.": tall & (one["pitch"] < steep),
            f"The highest height of a {robot} is left out, but it should be below {high}.":
            (height > low) & up,
            f"The lowest height of a {robot} is left out, but it should be above {low}.":
            (height < high) & up,
            "The pitch is multiplied by pi / 180, but is in radians already.":
            tall & (np.radians(pitch) < steep),
            "A limit itself counts as standing, but `<` and `>` are asked for, not `<=` and "
            "`>=`.":
            (height >= low) & (height <= high) & (pitch <= steep),
            "A runner counts as fallen only if height and pitch are both outside their limits, "
            "but one is enough.": tall | up,
            "Each step has the bonus of the step before it, but height and pitch after the step "
            "should decide.":
            np.append(True, (tall & up)[:-1]),
            "Each step has the bonus of the step after it.": np.append((tall & up)[1:], True),
            "A runner that has fallen once counts as fallen in all later steps, but each step "
            "should be judged by itself.":
            np.logical_and.accumulate(tall & up),
            "The comparison is the wrong way round: the fallen get the bonus.": ~(tall & up),
        }  # fmt: skip
    right = expected_planar(one)["alive"] > 0
    return slips(
        lambda stands, paid: np.where(stands, *paid),
        stands={"": right, **stands},
        paid={
            "": (1.0, 0.0),
            "Steps without a bonus get -1, but 0 is asked for.": (1.0, -1.0),
            "The bonus is 2, but 1 is asked for.": (2.0, 0.0),
        },
    )


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
            ("The metres of a robot that goes away are positive, but should be negative.",
             abs(metres)),
            ("The way is measured from the distance after the first step, but should be measured "
             "from the start.", distance[1] - distance[-1]),
            ("The way is measured to the nearest point, but should be measured to the end.",
             distance[0] - min(distance)),
            ("The way ends one step too early: it should go to the last distance.",
             distance[0] - distance[-2]),
            ("Steps backwards are left out of the metres, but should be subtracted.",
             moved * one["duration"]),
            ("This is the path, back and forth, but the first distance minus the last one is "
             "asked for.",
             np.abs(np.diff(distance)).sum()),
            ("This is the sum of the steps' speeds, but metres are asked for: speed times "
             "duration.", progress.sum()),
        ],
        "seconds": [
            ("A step of 0.0165 s is used, but the trajectory's 'duration' is asked for.",
             0.0165 * steps),
            ("T + 1 steps are counted, but there are T: the start is not a step.",
             one["duration"] * (steps + 1)),
            ("T - 1 steps are counted, but there are T.", one["duration"] * (steps - 1)),
            ("This is the number of steps, but their time in seconds is asked for.", steps),
        ],
        "speed": [
            ("Steps backwards count as positive speeds, but should count as negative ones.",
             np.abs(progress).mean()),
            ("Steps backwards count as speed 0, but should count as negative speeds.",
             np.maximum(progress, 0).mean()),
            ("The mean goes over the steps forward only, but should go over all steps.",
             progress[progress > 0].mean() if moved else 0.0),
            ("The speed of a robot that goes away is positive, but should be negative.",
             abs(wanted["speed"])),
            ("This is metres per step, but metres per second are asked for.", metres / steps),
            ("This is the median of the steps' speeds, but their mean is asked for.",
             np.median(progress)),
            ("This is the speed of the last step, but the mean of all steps is asked for.",
             progress[-1]),
            ("This is the highest speed of a step, but the mean of all steps is asked for.",
             progress.max()),
        ],
        "standing": [
            ("The effort is subtracted from the income, but should be left out.",
             share(alive, alive + moved + effort)),
            ("The size of the effort is added to the income, but should be left out.",
             share(alive, alive + moved - effort)),
            ("Steps backwards are subtracted from the sum of the progress (down to 0), but "
             "should be left out.",
             share(alive, alive + max(progress.sum(), 0))),
            ("Steps backwards are subtracted from the income, but should be left out.",
             share(alive, alive + progress.sum())),
            ("Steps backwards are subtracted from the income (down to 0), but should be left "
             "out.",
             share(alive, max(alive + progress.sum(), 0))),
            ("The size of steps backwards is added to the income, but they should be left out.",
             share(alive, alive + np.abs(progress).sum())),
            ("Metres are added up for the progress, but speeds in metres per second are asked "
             "for.", share(alive, alive + moved * one["duration"])),
            ("This is the share of progress in the income, but that of standing is asked for.",
             share(moved, alive + moved)),
            ("sum(alive) is divided by sum(progress), but should be divided by the sum of both.",
             share(alive, moved)),
            ("This is the share of the steps in which the robot stands, but that of its income is "
             "asked for.", alive / steps),
            ("The share should be 0.0 if the robot earns nothing, and sum(alive) / (sum(alive) + "
             "sum(progress)) otherwise.", 0.0 if alive + moved else 1.0),
        ],
        "grounded": [
            ("A step counts only if all feet are on the ground, but at least one is enough.",
             feet.min(axis=1).mean()),
            ("Only the first foot counts, but any foot should.", feet[:, 0].mean()),
            ("Only the last foot counts, but any foot should.", feet[:, -1].mean()),
            ("This is the mean over the feet, but the share of steps with at least one foot on "
             "the ground is asked for.", feet.mean()),
            ("Steps with two feet on the ground count twice, but should count once.",
             feet.sum() / steps),
            ("This is the share of steps in the air, but that of steps on the ground is asked "
             "for.", 1 - wanted["grounded"]),
            ("This is the number of steps on the ground, but their share is asked for.",
             wanted["grounded"] * steps),
        ],
    }  # fmt: skip


def why_gait(one: dict, wanted: dict, key: str) -> str:
    """How a number of the gait is made."""
    distance, v0, steps = one["distance"], expected_planar(one), len(one["height"])
    moved = v0["progress"][v0["progress"] > 0].sum()
    return {
        "metres": f"The target is {distance[0]:.7g} m away at the start and {distance[-1]:.7g} m "
        "at the end.",
        "seconds": f"There are {steps} steps of {one['duration']:g} s.",
        "speed": f"It should be {wanted['metres']:.5g} m divided by {wanted['seconds']:.5g} s.",
        "standing": f"The bonuses should add up to {v0['alive'].sum():g}, and the progress of the "
        f"steps forward to {moved:.5g}.",
        "grounded": f"In {int(one['feet'].max(axis=1).sum())} of {steps} steps at least one foot "
        "touches the ground.",
    }[key]


def mistaken_means(runner, rows: np.ndarray, seed: int, episodes: int) -> dict:
    """What mistakes make of the mean gaits."""
    from botschool.course.locomotion import Runner

    runners = {"v5": runner, "v0": Runner("PlanarHalfCheetah-v0")}

    @cache
    def one(i: int, at: int, version: str = "v5") -> dict:
        return expected_gait(runners[version].record(rows[i], at))

    def table(seeds, mean=np.mean, version="v5") -> dict:
        """The means over the seeds(number of the row)."""
        found = [[one(i, at, version) for at in seeds(i)] for i in range(len(rows))]
        return {
            name: np.array([mean([each[name] for each in gaits]) for gaits in found])
            for name in found[0][0]
        }

    def usual(_) -> range:
        return range(seed, seed + episodes)

    wanted, apart = table(usual), [table(lambda _, at=at: [at]) for at in usual(0)]
    return {
        "The robots are recorded in version 0, but should be recorded in version 5.":
        table(usual, version="v0"),
        "Only the episode with the seed itself counts, but the mean over the seeds seed, seed + "
        "1, ... is asked for.": apart[0],
        "Only the last episode counts, but the mean over all episodes is asked for.": apart[-1],
        "The seeds are seed + 1, seed + 2, ..., but the first episode should have the seed "
        "itself.": table(
            lambda _: range(seed + 1, seed + episodes + 1)
        ),
        "There is one episode too many.": table(lambda _: range(seed, seed + episodes + 1)),
        "There is one episode too few.": table(lambda _: range(seed, seed + max(1, episodes - 1))),
        "Episode i has the seed seed * i, but should have seed + i.": table(
            lambda _: [seed * i for i in range(episodes)]
        ),
        "Episode i has the seed i, but should have seed + i.": table(lambda _: range(episodes)),
        "The seed runs on from row to row, but each row should begin with the given seed.": table(
            lambda i: range(seed + i * episodes, seed + (i + 1) * episodes)
        ),
        "The number of the row is added to the seed, but each row should begin with the given "
        "seed.": table(
            lambda i: range(seed + i, seed + i + episodes)
        ),
        **{
            f"This is the {word} over the episodes, but the mean is asked for.":
            table(usual, function)
            for word, function in (("median", np.median), ("highest value", np.max),
                                   ("lowest value", np.min),
                                   ("last value", lambda found: found[-1]),
                                   ("standard deviation", np.std))
        },
        "The last episode counts half and the one before it a quarter, but all should count "
        "alike.":
        table(usual, lambda found: reduce(lambda mean, new: (mean + new) / 2, found)),
        "All rows have the mean over all rows, but each should have the mean over its own "
        "episodes.": {name: np.full(len(rows), np.mean(wanted[name])) for name in wanted},
        "All rows have the numbers of the first row, but each row is another robot.": {
            name: np.full(len(rows), wanted[name][0]) for name in wanted
        },
        "All rows have the numbers of the last row, but each row is another robot.": {
            name: np.full(len(rows), wanted[name][-1]) for name in wanted
        },
        "This is one number, the mean over all rows, but a number for each row is asked for.": {
            name: np.mean(wanted[name]) for name in wanted
        },
        "There is a number for each episode, the mean over the rows, but one for each row, the "
        "mean over its episodes, is asked for.": {
            name: np.array([np.mean(each[name]) for each in apart]) for name in wanted
        },
        "Each row has a number for each episode, but their mean is asked for.": {
            name: np.array([each[name] for each in apart]).T for name in wanted
        },
        "These are the sums over the episodes, but the means are asked for.": {
            name: episodes * wanted[name] for name in wanted
        },
    }  # fmt: skip
