"""Compute what slips make of answers, and say what is wrong about worlds and controllers."""

from itertools import combinations

import numpy as np

from botschool.grading import slips


def mistaken_centre(masses, parents, offsets, centres) -> dict:
    """What slips make of the centre of mass: sentence -> [x, y, z].

    For each link in the order of the file: its mass, the number of its parent (None for the first
    link), the origin of the joint between them, and the centre of mass in its frame.
    """

    def frames(sign: int) -> np.ndarray:
        found: list[np.ndarray] = []
        for parent, offset in zip(parents, offsets, strict=True):
            found.append(np.zeros(3) if parent is None else found[parent] + sign * offset)
        return np.array(found)

    masses, many = np.array(masses), len(masses)
    offsets, centres = np.array(offsets), np.array(centres)
    return slips(
        lambda place, inside, weight, divisor: weight @ (place + inside) / divisor,
        place={
            "": frames(1),
            "The frame of the parent is left out: add the origin of the joint to it.": offsets,
            "The origins of the joints are left out.": 0 * offsets,
            "The origin of a joint is subtracted: add it to the frame of the parent.": frames(-1),
        },
        inside={
            "": centres,
            "The inertial origins are left out.": 0 * centres,
            "The inertial origin is subtracted: add it to the frame of the link.": -centres,
            "The origin in visual is taken, not the one in inertial.": 0 * centres + 9,
        },
        weight={"": masses, "The links are not weighted by their masses.": np.ones(many)},
        divisor={
            "": masses.sum(),
            "The sum is not divided by the mass of the robot.": 1.0,
            "The sum is divided by the number of links: divide by the mass of the robot.": many,
            "The sum is divided by the number of joints: divide by the mass of the robot.": many
            - 1,
            "The sum is divided by the mass of the first link: divide by that of the robot.":
            masses[0],
        },
    )  # fmt: skip


def mistaken_mass(masses) -> dict:
    """What slips make of the mass of the robot: sentence -> number."""
    total = sum(masses)
    return {
        "The first link is left out: all links count.": total - masses[0],
        "The last link is left out: all links count.": total - masses[-1],
        "It is the mass of the first link alone.": masses[0],
        "It is the mass of the last link alone.": masses[-1],
        "It is the mean of the masses: their sum is asked for.": total / len(masses),
        "It is rounded: return it as it is.": round(total, 1),
    }


def mistaken_inclination(angle: float, quaternion) -> dict:
    """What slips make of the inclination: sentence -> angle."""
    x, w = quaternion[0], quaternion[3]
    whole = 2 * np.arccos(np.clip(abs(w), 0, 1))
    with np.errstate(all="ignore"):
        return {
            "The inclination is the first number of the quaternion, which is no angle: see "
            "getEulerFromQuaternion.": x,
            "The inclination is twice the first number of the quaternion, which is no angle: see "
            "getEulerFromQuaternion.": 2 * x,
            "The inclination is half as large as it is: a quaternion holds sine and cosine of half "
            "the angle.": np.arcsin(x),
            "Twice the arc tangent of x by w is the inclination only if the robot turns around x "
            "alone: see getEulerFromQuaternion.": 2 * np.arctan2(x, w),
            "The inclination is half of what it is.": angle / 2,
            "The inclination is twice as large as it is.": 2 * angle,
            "The inclination is the angle by which the body is turned in all, not that around x.":
            whole,
            "The inclination has the wrong sign.": -angle,
            "The inclination is never negative here, but the body leans both ways.": abs(angle),
            "The inclination is in degrees, not in radians.": np.degrees(angle),
            "The inclination is the sine of the angle.": np.sin(angle),
            "The inclination is the tangent of the angle.": np.tan(angle),
            "The inclination is measured from the horizontal, not from the upright.":
            np.pi / 2 - angle,
        }  # fmt: skip


def mistaken_speed(before: float, action: float, limit: float) -> dict:
    """What slips make of the target speed: sentence -> number; before: the speed before."""
    change = float(np.clip(action, -1, 1))
    return slips(
        lambda start, change, cut: cut(start + change),
        start={"": before, "The action is added to the speed; it does not replace it.": 0.0},
        change={
            "": change,
            "The action is not cut to -1 and 1.": action,
            "The action is subtracted: add it to the speed.": -change,
            "The action is multiplied by the time step: it is the change itself.": 0.01 * change,
            "The action is multiplied by FASTEST: it is the change itself.": limit * change,
            "self.speed stays as it was before the call.": 0.0,
            "The action has lost its sign.": abs(change),
            "An action beyond -1 or 1 changes nothing here: it is to be cut to -1 or 1.":
            action if abs(action) <= 1 else 0.0,
            "Only the side of the action counts here, as -1 or 1.": float(np.sign(action)),
            "The action is pressed by tanh: it is to be cut to between -1 and 1.":
            float(np.tanh(action)),
        },
        cut={
            "": lambda speed: float(np.clip(speed, -limit, limit)),
            "The speed is cut to between -1 and 1: its limits are -FASTEST and FASTEST.":
            lambda speed: float(np.clip(speed, -1, 1)),
            "The speed is not cut to between -FASTEST and FASTEST.": lambda speed: speed,
            "The speed is cut to a whole number.":
            lambda speed: float(int(np.clip(speed, -limit, limit))),
            "The speed is cut on the side of FASTEST only.": lambda speed: min(speed, limit),
            "The speed is cut on the side of -FASTEST only.": lambda speed: max(speed, -limit),
            "The speed stays as it was where the sum is beyond -FASTEST or FASTEST: it is to be "
            "cut to that limit.": lambda speed: speed if abs(speed) <= limit else before,
            "The speed becomes 0 where the sum is beyond -FASTEST or FASTEST: it is to be cut to "
            "that limit.": lambda speed: speed if abs(speed) <= limit else 0.0,
        },
    )  # fmt: skip


def mistaken_reward(speed: float, before: float, action: float) -> dict:
    """What slips make of the reward: sentence -> number; before: the speed before the action."""
    return slips(
        lambda one, price, size: one - price * size,
        one={"": 1.0, "The 1 for the step is left out.": 0.0},
        price={
            "": 0.05,
            "A rad/s costs 0.05, not 0.5.": 0.5,
            "A rad/s costs 0.05, not 0.005.": 0.005,
            "A rad/s costs 0.05, not 1.": 1.0,
            "The price is added: subtract it.": -0.05,
            "The price of the speed is left out.": 0.0,
        },
        size={
            "": abs(speed),
            "Speed costs in both directions: see abs().": speed,
            "The price is that of the speed, not of its square.": speed**2,
            "The price is that of the speed before the action: the speed after it counts.":
            abs(before),
            "The price is that of the action: the speed counts.": abs(action),
        },
    )  # fmt: skip


WORLDS = {
    "Gravity is 10 here, not 9.81.": {"gravity": (0, 0, -9.81)},
    "Gravity has the wrong sign: it pulls upwards.": {"gravity": (0, 0, 10)},
    "Gravity pulls along x, but it is to pull along z.": {"gravity": (-10, 0, 0)},
    "Gravity pulls along y, but it is to pull along z.": {"gravity": (0, -10, 0)},
    "There is no gravity: it is to be set in this simulation (physicsClientId), and after "
    "resetSimulation, which ends it.": {"gravity": (0, 0, 0)},
    "The time step is PyBullet's own: see setTimeStep and its physicsClientId.": {
        "time_step": 1 / 240
    },
    "The time step is 0.1, not TIME_STEP.": {"time_step": 0.1},
    "The time step is 0.001, not TIME_STEP.": {"time_step": 0.001},
    "PyBullet computes the inertias anew: the flag is missing.": {"flag": False},
    "The base begins at the height 0, not 0.001.": {"height": 0.0},
    "The base begins at the height 0.01, not 0.001.": {"height": 0.01},
    "The base begins at the height 0.1, not 0.001.": {"height": 0.1},
    "The base begins at the height 0.3, not 0.001.": {"height": 0.3},
    "The base begins at the height 1, not 0.001.": {"height": 1.0},
}
"""What slips make of a world, by sentence."""
LIKELY = ({"gravity": (0, 0, -9.81)}, {"time_step": 1 / 240}, {"flag": False}, {"height": 0.1})
"""Those that are tried two at a time, too."""


def why_world(make, answer: np.ndarray) -> str:
    """Return what is wrong about a world, or ""; make: returns what is seen in such a world."""
    likely = [pair for pair in WORLDS.items() if pair[1] in LIKELY]
    pairs = [
        (f"{one[0]} {other[0]}", one[1] | other[1])
        for one, other in combinations(likely, 2)
        if not one[1].keys() & other[1].keys()
    ]
    for text, changes in (*WORLDS.items(), *pairs):
        if np.allclose(answer, make(**changes), atol=1e-4):
            return text
    return ""


MOTORS = {
    "Both turn the wrong way round.": ((0, -1), (1, 1)),
    "Both motors get self.speed, but motor 1 is to get -self.speed.": ((0, 1), (1, 1)),
    "Both motors get -self.speed, but motor 0 is to get self.speed.": ((0, -1), (1, -1)),
    "Motor 1 gets no target velocity.": ((0, 1),),
    "Motor 0 gets no target velocity.": ((1, -1),),
    "The motors get no target velocity, or 0.": (),
    "The motors get the change, not the speed that comes of it.":
    lambda before, change: ((0, change), (1, -change)),
    "The motors get the speed from before the action.":
    lambda before, change: ((0, before), (1, -before)),
}  # fmt: skip
"""Which motor gets how many times the speed, by sentence; or a function as in World.act."""


def why_motors(make, turns: np.ndarray, wanted: np.ndarray) -> str:
    """Return what is wrong about the motors, or ""; make: as in why_world."""
    for text, targets in MOTORS.items():
        if np.allclose(turns, make(targets), atol=1e-3):
            return text
    if np.abs(wanted).min() < 0.3:
        return ""
    share = turns / wanted
    if np.all(np.abs(share) < 0.1):
        return (
            "They hardly turn, as without VELOCITY_CONTROL and a targetVelocity for each motor, or "
            "with much less force than PyBullet's motors have by themselves."
        )
    if np.all((share > 0.1) & (share < 0.97)):
        return (
            "They turn too slowly, as with smaller target velocities, or with less force than "
            "PyBullet's motors have by themselves."
        )
    return ""


def why_fallen(parameters: np.ndarray, steps: list[int], balances) -> str:
    """Return why an evolved controller falls, or "".

    steps: of the episodes in evolution; balances: whether other parameters balance.
    """
    shifts = (np.roll(parameters, 1), np.roll(parameters, -1), parameters[::-1])
    if any(balances(each) for each in shifts):
        return "The same four numbers in another order balance: the order is b, w1, w2, w3."
    if balances(-parameters):
        return "The same numbers with the other sign balance."
    if len(steps) < 4:
        return ""
    first, last = (float(np.mean(part)) for part in np.array_split(steps, 3)[::2])
    course = (
        f"The episodes in your evolution lasted {first:.0f} steps at first and {last:.0f} at last, "
        "on average."
    )
    good, longest = steps.count(500), max(steps)
    if longest < 500 and 3 * steps.count(longest) > len(steps):
        return f"{course} None lasted for more than {longest}: an episode may have 500 steps."
    if last < 0.8 * first or max(steps[-len(steps) // 3 :]) < max(steps) / 2:
        return f"{course} They are to become longer."
    if good == 0:
        return f"{course} No candidate balanced: vary the weights more, or evolve for longer."
    return (
        f"{course} {good} of {len(steps)} lasted to the end. To get parameters that always "
        "balance, you can, for example, return the best, or evolve for longer."
    )


def why_untrained(steps: list[int], updates: int) -> str:
    """Return how a training went that leads to no controller."""
    if not steps:
        return ""
    last = float(np.mean(steps[-10:]))
    told = (
        f"PPO learnt from {sum(steps)} steps, in {updates} updates; its last episodes lasted "
        f"{last:.0f} steps on average."
    )
    return f"{told} For example, learn for longer, or update more often." if last < 400 else told
