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
            "Progress is positive when the robot goes away: take the distance before the step "
            "minus the distance after it.": -nearer,
            "Going away counts as 0, but it is negative progress.": np.maximum(nearer, 0.0),
            "Going away counts as much as coming nearer, but it is negative progress.":
            np.abs(nearer),
            "The way is measured from the start: take the distance before each step.":
            distance[0] - distance[1:],
            "The way is measured to the end: take the distance after each step.":
            distance[:-1] - distance[-1],
            "The mean way of all steps is taken: each step has its own.":
            np.full(len(nearer), nearer.mean()),
            "The progress of a step is taken over two steps, as np.gradient does: take the "
            "difference of neighbours.": two[1:],
            "The progress of a step is taken over two steps, as np.gradient does: take the "
            "difference of the neighbours.": two[:-1],
            "Each step has the progress of the next one.": np.append(nearer[1:], 0.0),
            "Each step has the progress of the one before.": np.append(0.0, nearer[:-1]),
            "The speeds are added up over the steps.": np.cumsum(nearer),
            "The distance itself is divided; the difference of two distances is asked for.":
            distance[1:],
            "The first step is missing, and the last goes back to the start (np.roll).":
            np.append(nearer[1:], distance[-1] - distance[0]),
            "The first step is missing: T + 1 distances make T steps.": nearer[1:],
            "The last step is missing: T + 1 distances make T steps.": nearer[:-1],
            "The start is no step: T + 1 distances make T steps.": np.append(0.0, nearer),
        },
        time={
            "": duration,
            "The duration of a step is left out.": 1.0,
            "The duration multiplies; it divides.": 1 / duration,
            "Use `duration`, not the 0.0165 s of PyBullet.": 0.0165,
            "Divide by the duration of a step, not by the time since the start.":
            duration * np.arange(1, len(nearer) + 1),
            "Divide by the duration of a step, not by that of the episode.":
            duration * len(nearer),
            "The duration is squared: divide by it once.": duration**2,
            "Divide by the duration alone, not by the distance, too.": duration * distance[:-1],
            "Metres per second are asked for, not kilometres per hour.": duration / 3.6,
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


def mistaken_bonus(one: dict) -> dict:
    """What slips make of the alive bonus: sentence -> array."""
    robot, steps = one["robot"], len(one["height"])
    wanted = expected_v0(one)["alive"]
    upright, off = np.abs(one["pitch"]) < 1, one["touching"] == 0
    low = {"Ant": 0.26, "Humanoid": 0.78, "HalfCheetah": -1.0}.get(robot, 0.8)
    high, leans = one["height"] > low, robot not in ("Ant", "Humanoid")
    cheetah = robot == "HalfCheetah"
    stands = {
        "A robot that leans back does not count: the pitch may be negative, take abs(pitch).":
        high & ((one["pitch"] < 1) | (not leans)) & (off | (not cheetah)),
        "A robot that leans forward is forgotten: take abs(pitch).":
        high & ((one["pitch"] > -1) | (not leans)) & (off | (not cheetah)),
        "A robot that has fallen once counts as fallen ever after: judge each step by itself.":
        np.logical_and.accumulate(wanted > 0),
        f"The pitch is left out: a {robot} with |pitch| of 1 or more has fallen.":
        high & (off | (not cheetah)),
        f"The height is left out: a {robot} at {low} or below has fallen.": upright | (not leans),
        "The touching is left out: a HalfCheetah with shin or thigh on the floor has fallen.":
        upright & high,
        f"One of the conditions is enough to fall; your {robot} falls only if both hold.":
        (high | upright) if leans and not cheetah else (upright | off),
        f"The pitch does not matter for a {robot}.": high & upright,
        f"What touches the floor does not matter for a {robot}.":
        (wanted > 0) & off,
        "touching is the wrong way round: 1 means that shin or thigh was on the floor.":
        upright & ~off,
        "The pitch is in radians, as its limit is: do not convert it to degrees.":
        high & ((np.abs(np.degrees(one["pitch"])) < 1) | (not leans)) & (off | (not cheetah)),
        "Height and pitch are exchanged.":
        (one["pitch"] > low) & ((np.abs(one["height"]) < 1) | (not leans)),
        "The limit itself counts as standing: compare with `>` and `<`, not with `>=` and `<=`.":
        (one["height"] >= low) & ((np.abs(one["pitch"]) <= 1) | (not leans))
        & (off | (not cheetah)),
        "The limit of the height counts as standing: compare with `>`, not `>=`.":
        (one["height"] >= low) & (upright | (not leans)) & (off | (not cheetah)),
        "A pitch of exactly 1 counts as upright: compare with `<`, not `<=`.":
        high & ((np.abs(one["pitch"]) <= 1) | (not leans)) & (off | (not cheetah)),
        "One fall makes all steps count as fallen: judge each step by itself.":
        np.full(steps, bool((wanted > 0).all())),
        "All steps are judged alike here: each stands for itself.": np.full(steps, True),
        "The comparison is the wrong way round: the fallen stand, and those who stand have "
        "fallen.": wanted < 0,
    } | {
        f"This is the limit of {other}: the table has {low} for {robot}.":
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
            "The fallen get 0, but they pay 1.": (bonus, 0.0),
            "The fallen pay the bonus of their robot; all pay 1.": (bonus, -bonus),
            f"The bonus of a {robot} is {bonus:g}, not {3 - bonus:g}.": (3 - bonus, -1.0),
            "Neither the bonus nor the price of a fall is as in the table.": (1.0, 0.0),
        },
    )


def why_electricity(one: dict, t: int) -> str:
    action, speed, n = one["actions"][t], one["speeds"][t], one["actions"].shape[1]
    work, effort = np.abs(action * speed).mean(), (action**2).mean()
    price = f"-2 * {work:.5g} - 0.1 * {effort:.5g}"
    price = f"4.25 * ({price})" if one["robot"] == "Humanoid" else price
    return (
        f"In step {t}, the mean |action * speed| of the {n} joints is {work:.5g} and their mean "
        f"squared action {effort:.5g}: that makes {price}."
    )


def mistaken_electricity(one: dict) -> dict:
    """What slips make of the cost: sentence -> array."""
    actions, speeds, joints = one["actions"], one["speeds"], one["actions"].shape[1]
    product, squares, zero = actions * speeds, actions**2, 0 * actions[:, 0]
    humanoid, six = one["robot"] == "Humanoid", "by 6, however many joints there are: take their"
    work = {
        "": np.abs(product).mean(axis=1),
        "Braking is paid for: the absolute value of the work counts, joint by joint.": product.mean(
            axis=1
        ),
        "Take |action * speed| of each joint first, then the mean.": np.abs(product.mean(axis=1)),
        "The work is added up over the joints: take their mean.": np.abs(product).sum(axis=1),
        f"The work is divided {six} mean.": np.abs(product).sum(axis=1) / 6,
        "The work of the joint that does most is taken: take the mean over the joints.": np.abs(
            product
        ).max(axis=1),
        "The median of the work is taken: take the mean over the joints.": np.median(
            np.abs(product), axis=1
        ),
        "The work is |action * speed|; the actions are left out of it.": np.abs(speeds).mean(
            axis=1
        ),
        "The work is |action * speed|; the speeds are left out of it.": np.abs(actions).mean(
            axis=1
        ),
        "The work is |action * speed|, not its square.": (product**2).mean(axis=1),
        "The work is the root of the mean square; the mean |action * speed| is asked for.": np.sqrt(
            (product**2).mean(axis=1)
        ),
        "The mean of a product is not the product of the means: multiply joint by joint.": np.abs(
            actions
        ).mean(axis=1)
        * np.abs(speeds).mean(axis=1),
        "The mean goes over the joints of each step, not over the steps, too (axis=1).": np.full(
            len(actions), np.abs(product).mean()
        ),
        "The work is left out: 2 times the mean |action * speed|.": np.zeros(len(actions)),
        "Work against the motion is left out: |action * speed| counts.": np.maximum(
            product, 0
        ).mean(axis=1),
    }
    effort = {
        "": squares.mean(axis=1),
        "The cost of standing still with force, 0.1 times the action's square, is left out.": zero,
        "The 0.1 belongs to the mean of the squares, not to the square of the mean.": actions.mean(
            axis=1
        )
        ** 2,
        "The 0.1 belongs to the mean squared action, not to the mean |action|.": np.abs(
            actions
        ).mean(axis=1),
        "The squared actions are added up over the joints: take their mean.": squares.sum(axis=1),
        f"The squared actions are divided {six} mean.": squares.sum(axis=1) / 6,
        "The mean squared action is asked for, not its root.": np.sqrt(squares.mean(axis=1)),
        "The actions are squared, not the speeds.": (speeds**2).mean(axis=1),
        "The second mean is that of the squared actions, not of |action * speed| again.": np.abs(
            product
        ).mean(axis=1),
        "The mean squared action goes over the joints of a step only.": squares.mean() + zero,
        "The actions are not squared.": actions.mean(axis=1),
    }
    found = slips(
        lambda work, effort, prices, factors: -(
            factors[0] * prices[0] * work + factors[1] * prices[1] * effort
        ),
        work=work,
        effort=effort,
        prices={
            "": (2.0, 0.1),
            "The speeds stay in units of 10 radians per second: do not multiply them by 10.":
            (20.0, 0.1),
            "The factor 2 of the work is left out.": (1.0, 0.1),
            "The cost of the squared action is 0.1 times it, not 1 time.": (2.0, 1.0),
            "The squared action is not multiplied by the 2 of the work.": (2.0, 0.2),
            "The factors 2 and 0.1 are exchanged: 2 belongs to the work.": (0.1, 2.0),
            "The squared action is subtracted from the cost: both parts are costs.": (2.0, -0.1),
            "The work is a tenth of what it is: 0.1 belongs to the squared action alone, and the "
            "speeds stay in their units.": (0.2, 0.1),
        },
        factors={
            "": (4.25, 4.25) if humanoid else (1.0, 1.0),
            "The cost is a negative number: the sign is wrong.":
            (-4.25, -4.25) if humanoid else (-1.0, -1.0),
            **({
                "The electricity of a Humanoid costs more than that of others.": (1.0, 1.0),
                "A Humanoid pays 4.25 times the squared action, too.": (4.25, 1.0),
                "A Humanoid pays 4.25 times the work, too.": (1.0, 4.25),
                "A Humanoid's electricity is multiplied by 4.25, not divided.":
                (1 / 4.25, 1 / 4.25),
                "The 4.25 of a Humanoid multiplies twice.": (4.25**2, 4.25**2),
            } if humanoid else {
                "Only a Humanoid pays 4.25 times as much.": (4.25, 4.25),
            }),
        },
    )  # fmt: skip
    cost = found["The cost is a negative number: the sign is wrong."]
    return {
        "The sums are divided by 6, however many joints there are: take their mean.":
        -cost * joints / 6,
        "The means are sums over the joints.": -cost * joints,
        "The means go over the joints of each step, not over the steps, too.":
        np.full(len(cost), -cost.mean()),
    } | found  # fmt: skip


def why_at_limit(one: dict, t: int) -> str:
    row = one["positions"][t]
    count = int((np.abs(row) > 0.99).sum())
    return (
        f"In step {t}, {count} of the {len(row)} joints at {[round(float(p), 4) for p in row]} "
        f"are beyond 0.99 or -0.99: that makes {-0.1 * count:.1f}."
    )


def mistaken_limits(positions: np.ndarray) -> dict:
    """What slips make of the cost of limits: sentence -> array."""
    size = np.abs(positions)
    found = slips(
        lambda there, over, price: price * over(there),
        there={
            "": size > 0.99,
            "Joints at their lower limits count, too.": positions > 0.99,
            "Joints at their upper limits count, too.": positions < -0.99,
            "A joint exactly at 0.99 is not at its limit: compare with `>`, not `>=`.":
            size >= 0.99,
            "A joint is at its limit beyond 0.99, not only from 1 on.": size >= 1,
            "A joint is at its limit beyond 0.99, not only beyond 1.": size > 1,
            "A joint that is past its limit, beyond 1, counts, too.": (size > 0.99) & (size <= 1),
            "The comparison is the wrong way round: these joints are not at their limits.":
            size < 0.99,
            "Each joint at its limit costs 0.1, however far it is: count them.":
            size * (size > 0.99),
        },
        over={
            "": lambda there: there.sum(axis=1),
            "Each joint at its limit costs 0.1: their share (a mean) is taken.":
            lambda there: there.mean(axis=1),
            "Each joint at its limit costs 0.1: count them, do not ask whether there is any.":
            lambda there: there.any(axis=1),
            "Each joint at its limit costs 0.1: count them, do not ask whether all are.":
            lambda there: there.all(axis=1),
            "Count the joints of each step, not of all steps (axis=1).":
            lambda there: np.full(len(there), there.sum()),
            "The joints are counted up over the steps: each step has its own number.":
            lambda there: np.cumsum(there.sum(axis=1)),
        },
        price={
            "": -0.1,
            "It is a cost: a negative number.": 0.1,
            "The factor 0.1 is left out.": -1.0,
            "A joint at its limit costs 0.1, not 0.01.": -0.01,
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
        "The component is multiplied by the duration of a step: it is a number for each step, "
        "however long that lasts.": {
            key: wanted[key] * one["duration"]
            for key in ("alive", "electricity", "joints_at_limit")
        },
        "The fallen pay for this, too.": {
            key: np.where(fallen, 0.0, wanted[key]) for key in ("electricity", "joints_at_limit")
        },
        "The components are for each step; these are summed up to each step.": {
            key: np.cumsum(values) for key, values in wanted.items()
        },
        "The components are for each step, arrays of T numbers; this is their sum.": {
            key: values.sum() for key, values in wanted.items()
        },
        "The components are for each step, arrays of T numbers; this is their mean.": {
            key: values.mean() for key, values in wanted.items()
        },
        "The components are apart: this is the sum of all four.": dict.fromkeys(
            wanted, sum(wanted.values())
        ),
    }
    for other in ROBOTS:
        if other != one["robot"]:
            made = expected_v0(one | {"robot": other})
            mistakes[f"The robot is taken for a {other}: hand on trajectory['robot']."] = {
                key: made[key] for key in made if not np.array_equal(made[key], wanted[key])
            }
    if one["robot"] == "Humanoid":
        mistakes["The fallen pay 1, a Humanoid, too, not its bonus of 2."] = {
            "alive": np.where(fallen, -2.0, wanted["alive"])
        }
    end = int(np.argmax(fallen)) + 1 if fallen.any() else len(fallen)
    for last, word in ((end, "after"), (end - 1, "from")):
        mistakes[f"The steps {word} the first fall on are left out: all T steps count."] = {
            key: values[:last] for key, values in wanted.items()
        }
    mixed = {
        "Height and pitch are exchanged: alive_bonus takes height first.": {
            "height": one["pitch"],
            "pitch": one["height"],
        },
        "'heading' is taken where 'height' belongs.": {"height": one["heading"]},
        "Actions and speeds are exchanged: electricity takes actions first.": {
            "actions": one["speeds"],
            "speeds": one["actions"],
        },
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


def mistaken_v5(one: dict) -> dict:
    """What slips make of the reward of version 5: sentence -> array."""
    v0, robot, wanted = expected_v0(one), one["robot"], expected_v5(one)
    progress, limits, alive = v0["progress"], v0["joints_at_limit"], v0["alive"]
    terms = {
        "progress": {
            "": progress,
            "The duration of a step is left out of the progress.": progress * one["duration"],
            "Use the trajectory's 'duration', not a number.": progress * one["duration"] / 0.0165,
            "Progress is left out.": 0.0,
            "Progress counts twice.": 2 * progress,
            "Progress has the wrong sign.": -progress,
        },
        "alive": {"": 0.0, "Version 5 has no alive bonus for staying up.": alive},
        "electricity": {"": 0.0, "Version 5 charges nothing for electricity.": v0["electricity"]},
        "limits": {
            "": limits,
            "What joints at their limits cost is left out.": 0.0,
            "Joints at limit is a negative number: add it, do not subtract it.": -limits,
            "Joints at their limits count twice.": 2 * limits,
        },
    }
    if robot in ("Hopper", "Walker2D"):
        terms["limits"] = {
            "": 0.0,
            "Joints at their limits cost this robot nothing in version 5.": limits,
        }
    if robot == "Ant":
        terms |= terms_of_an_ant(one["actions"])
    if robot == "Humanoid":
        terms |= terms_of_a_humanoid(one, alive)
    return slips(lambda **each: sum(each.values()), **terms) | {
        "The reward is for each step, an array of T numbers; this is the sum.": wanted.sum(),
        "The reward is for each step; these are sums up to each step.": np.cumsum(wanted),
    }  # fmt: skip


def terms_of_an_ant(actions: np.ndarray) -> dict:
    squares = (actions**2).mean(axis=1)
    return {
        "given": {
            "": 0.01,
            "The 0.01 of an Ant is left out.": 0.0,
            "An Ant gets 0.01, not the 1 of version 0.": 1.0,
            **{f"The 0.01 of an Ant is {much} here.": much for much in (0.1, 0.001)},
        },
        "effort": {
            "": -0.01 * squares,
            "The 0.01 times the mean squared action is left out.": 0.0,
            "The mean squared action is subtracted, not added.": 0.01 * squares,
            "An Ant pays for the mean of the squares, not for their sum.":
            -0.01 * (actions**2).sum(axis=1),
            "An Ant pays for the mean of the squares, not for the square of the mean.":
            -0.01 * actions.mean(axis=1) ** 2,
            "An Ant pays for the squares of its actions, not for their absolute values.":
            -0.01 * np.abs(actions).mean(axis=1),
            **{
                f"The factor 0.01 of the mean squared action is {much} here.": -much * squares
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
            "The 1 of a Humanoid is left out.": 0.0,
            "A Humanoid gets 1 in version 5, not 2.": 2.0,
            "A Humanoid gets its 1 in every step, fallen or not.": 1.0 * (alive > 0),
            "A Humanoid gets 1 in every step here, not the alive bonus of version 0 (2 or -1).":
            alive,
            "A Humanoid gets 1 in every step here, not 1 or -1.": np.sign(alive),
        },
        "beyond": {
            "": -10 * beyond,
            "Beyond is a cost: subtract it.": 10 * beyond,
            "Beyond is max(0, |position| - 1): the max is left out.":
            -10 * (positions - 1).sum(axis=1),
            "Beyond is |position| - 1, how far past the limit, not the whole position.":
            -10 * (positions * (past > 0)).sum(axis=1),
            "Beyond is squared: take it as it is.": -10 * (past**2).sum(axis=1),
            "The factor of beyond is 10, not 0.1.": -0.1 * beyond,
            "Beyond is left out.": 0.0,
            "Beyond is the sum over the joints, not the largest.": -10 * past.max(axis=1),
            "Beyond is the sum over the joints, not their mean.": -10 * past.mean(axis=1),
            "Beyond begins at 1, not at 0.99.":
            -10 * np.maximum(positions - 0.99, 0).sum(axis=1),
            "Beyond is how far joints are past their limits, not how many are.":
            -10 * (past > 0).sum(axis=1),
            "Beyond counts at the lower limits, too: |position| - 1.":
            -10 * np.maximum(one["positions"] - 1, 0).sum(axis=1),
            "Beyond costs 10 times as much.": -beyond,
        },
        "heading": {
            "": -0.1 * heading**2,
            "The heading is a cost: subtract it.": 0.1 * heading**2,
            "The heading is left out.": 0.0,
            "The heading is to be squared, not |heading|.": -0.1 * np.abs(heading),
            "The heading is to be squared.": -0.1 * heading,
            "The square of the heading costs 0.1 times it.": -(heading**2),
            "The pitch is taken for the heading.": -0.1 * one["pitch"] ** 2,
        },
    }  # fmt: skip


def why_v5(one: dict, t: int) -> str:
    """The terms of the reward of step t."""
    v0, positions = expected_v0(one), np.abs(one["positions"][t])
    terms = [f"progress {v0['progress'][t]:.5g}"]
    if one["robot"] == "Ant":
        terms.append(f"0.01 - 0.01 * mean squared action {np.mean(one['actions'][t] ** 2):.5g}")
    if one["robot"] == "Humanoid":
        beyond = np.maximum(positions - 1, 0).sum()
        terms.append(f"1 - 10 * beyond {beyond:.5g} - 0.1 * heading {one['heading'][t]:.5g}^2")
    if one["robot"] not in ("Hopper", "Walker2D"):
        terms.append(f"joints at limit {v0['joints_at_limit'][t]:.3g}")
    nothing = " alone" if len(terms) == 1 else ""
    return f"The {one['robot']}'s reward of step {t} is {' + '.join(terms)}{nothing}."


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


def mistaken_falls(one: dict) -> dict:
    """What slips make of a planar runner's bonus: sentence -> array."""
    robot, height, pitch = one["robot"], one["height"], np.abs(one["pitch"])
    steep = {"PlanarHopper": 0.2, "PlanarWalker2D": 1.0}.get(robot, np.inf)
    low, high = {"PlanarHopper": (0.7, np.inf), "PlanarWalker2D": (0.8, 2.0)}.get(robot, (0, 0))
    stands = {
        "A PlanarHalfCheetah gets no bonus: 0 in each step.": np.ones(len(height)),
        "A PlanarHalfCheetah gets no bonus, and its pitch does not matter.": pitch < 1,
        "The limits of PyBullet's robots are used: planar runners have limits of their own.": (
            height > 0.8
        )
        & (pitch < 1),
    }
    if robot != "PlanarHalfCheetah":
        tall, up = (height > low) & (height < high), pitch < steep
        stands = {
            "The limits of PyBullet's robots are used: planar runners have limits of their own.":
            (height > 0.8) & (pitch < 1),
            "The limits of PlanarHopper and PlanarWalker2D are exchanged.":
            (height > 0.8) & (height < 2) & (pitch < 1) if steep < 1
            else (height > 0.7) & (pitch < 0.2),
            "The pitch is left out.": tall,
            "The height is left out.": up,
            "A runner that leans back is forgotten: abs(pitch).": tall & (one["pitch"] < steep),
            f"A {robot} has a highest height, too: below {high}.": (height > low) & up,
            f"The lowest height of a {robot} is left out: above {low}.": (height < high) & up,
            "The pitch is in radians: no conversion is needed.": tall & (np.radians(pitch) < steep),
            "The limits belong to the fallen: compare with `<` and `>`, not `<=` and `>=`.":
            (height >= low) & (height <= high) & (pitch <= steep),
            "One condition is enough to fall: join them by and, not by or.": tall | up,
            "Each step has the bonus of the step before: judge by the heights after the step.":
            np.append(True, (tall & up)[:-1]),
            "Each step has the bonus of the step after.": np.append((tall & up)[1:], True),
            "A runner that has fallen once counts as fallen ever after: judge each step by itself.":
            np.logical_and.accumulate(tall & up),
            "The comparison is the wrong way round: the fallen get the bonus.": ~(tall & up),
        }  # fmt: skip
    right = expected_planar(one)["alive"] > 0
    return slips(
        lambda stands, paid: np.where(stands, *paid),
        stands={"": right, **stands},
        paid={
            "": (1.0, 0.0),
            "The fallen get 0 here, not -1.": (1.0, -1.0),
            "The bonus is 1, not 2.": (2.0, 0.0),
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
            ("Steps backwards are left out; here they are subtracted, so that the income may be "
             "below 0.",
             share(alive, max(alive + progress.sum(), 0))),
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


def why_gait(one: dict, wanted: dict, key: str) -> str:
    """How a number of the gait is made."""
    distance, v0, steps = one["distance"], expected_planar(one), len(one["height"])
    moved = v0["progress"][v0["progress"] > 0].sum()
    return {
        "metres": f"The target is {distance[0]:.7g} m away at first, {distance[-1]:.7g} at last.",
        "seconds": f"There are {steps} steps of {one['duration']:g} s.",
        "speed": f"These are {wanted['metres']:.5g} m in {wanted['seconds']:.5g} s.",
        "standing": f"The bonuses add up to {v0['alive'].sum():g}, the progress of the steps "
        f"forward to {moved:.5g}.",
        "grounded": f"In {int(one['feet'].max(axis=1).sum())} of {steps} steps a foot touches "
        "the ground.",
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
        "All are to be recorded in version 5.": table(usual, version="v0"),
        "Only the first episode counts: episode i is to have seed + i.": apart[0],
        "Only the last episode counts.": apart[-1],
        "The first episode has the seed itself, not the next one.": table(
            lambda _: range(seed + 1, seed + episodes + 1)
        ),
        "There is one episode too many.": table(lambda _: range(seed, seed + episodes + 1)),
        "There is one episode too few.": table(lambda _: range(seed, seed + max(1, episodes - 1))),
        "Episode i has the seed seed + i, not seed * i.": table(
            lambda _: [seed * i for i in range(episodes)]
        ),
        "Episode i has the seed seed + i, not i.": table(lambda _: range(episodes)),
        "Each row begins anew with the same seed: yours runs on from row to row.": table(
            lambda i: range(seed + i * episodes, seed + (i + 1) * episodes)
        ),
        "Each row begins anew with the same seed: yours adds the number of the row.": table(
            lambda i: range(seed + i, seed + i + episodes)
        ),
        **{
            f"This is the {word} over the episodes, not their mean.": table(usual, function)
            for word, function in (("median", np.median), ("highest", np.max), ("lowest", np.min),
                                   ("last", lambda found: found[-1]), ("deviation", np.std))
        },
        "The last episode counts half, the one before it a quarter: all are to count alike.":
        table(usual, lambda found: reduce(lambda mean, new: (mean + new) / 2, found)),
        "Each row has a number of its own, the mean over its episodes: this is the mean over "
        "all rows.": {name: np.full(len(rows), np.mean(wanted[name])) for name in wanted},
        "Each row is another robot: these are the numbers of the first one again.": {
            name: np.full(len(rows), wanted[name][0]) for name in wanted
        },
        "Each row is another robot: these are the numbers of the last one again.": {
            name: np.full(len(rows), wanted[name][-1]) for name in wanted
        },
        "Each row has a number of its own: this is one number, the mean over all rows.": {
            name: np.mean(wanted[name]) for name in wanted
        },
        "Each row has a number of its own, the mean over its episodes: this has one for each "
        "episode, the mean over the rows.": {
            name: np.array([np.mean(each[name]) for each in apart]) for name in wanted
        },
        "The mean over the episodes is missing: each row has a number for each episode.": {
            name: np.array([each[name] for each in apart]).T for name in wanted
        },
        "These are the sums over the episodes, not their means.": {
            name: episodes * wanted[name] for name in wanted
        },
    }  # fmt: skip
