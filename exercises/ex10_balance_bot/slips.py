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
            "The frame of a link is taken to be the origin of its joint alone, but the frame of "
            "its parent should be added.": offsets,
            "The origins of the joints are left out, but should be added to the frames of the "
            "parents.": 0 * offsets,
            "The origin of a joint is subtracted from its parent's frame, but should be added.":
            frames(-1),
        },
        inside={
            "": centres,
            "The inertial origins are left out, but should be added to the frames of the links.":
            0 * centres,
            "The inertial origin is subtracted from the frame of the link, but should be added.":
            -centres,
            "The origin in visual is taken instead of the one in inertial.": 0 * centres + 9,
        },
        weight={
            "": masses,
            "The links are not weighted by their masses, but should be.": np.ones(many),
        },
        divisor={
            "": masses.sum(),
            "The sum is not divided, but should be divided by the mass of the robot.": 1.0,
            "The sum is divided by the number of links instead of by the mass of the robot.": many,
            "The sum is divided by the number of joints instead of by the mass of the robot.":
            many - 1,
            "The sum is divided by the mass of the first link instead of by that of the robot.":
            masses[0],
        },
    )  # fmt: skip


def mistaken_mass(masses) -> dict:
    """What slips make of the mass of the robot: sentence -> number."""
    total = sum(masses)
    return {
        "The first link is left out, but all links should count.": total - masses[0],
        "The last link is left out, but all links should count.": total - masses[-1],
        "The mass is that of the first link alone, but should be that of all links.": masses[0],
        "The mass is that of the last link alone, but should be that of all links.": masses[-1],
        "The mass is the mean of those of the links, but should be their sum.": total / len(masses),
        "The mass is rounded, but should be returned as it is.": round(total, 1),
    }


def mistaken_inclination(angle: float, quaternion) -> dict:
    """What slips make of the inclination: sentence -> angle."""
    x, w = quaternion[0], quaternion[3]
    whole = 2 * np.arccos(np.clip(abs(w), 0, 1))
    with np.errstate(all="ignore"):
        return {
            "The inclination is the first number of the quaternion instead of the first Euler "
            "angle (see getEulerFromQuaternion).": x,
            "The inclination is twice the first number of the quaternion instead of the first "
            "Euler angle (see getEulerFromQuaternion).": 2 * x,
            "The inclination is the arcsine of the first number of the quaternion instead of the "
            "first Euler angle (see getEulerFromQuaternion).": np.arcsin(x),
            "The inclination is twice the arctangent of x by w, but this is right only if the "
            "robot is turned around x alone (see getEulerFromQuaternion).": 2 * np.arctan2(x, w),
            "The inclination is half as large as it should be.": angle / 2,
            "The inclination is twice as large as it should be.": 2 * angle,
            "The inclination is the angle by which the body is turned in all instead of that "
            "around x.":
            whole,
            "The inclination has the wrong sign.": -angle,
            "The inclination has lost its sign, but should be negative if the body leans one way.":
            abs(angle),
            "The inclination is in degrees instead of radians.": np.degrees(angle),
            "The inclination is the sine of the angle instead of the angle.": np.sin(angle),
            "The inclination is the tangent of the angle instead of the angle.": np.tan(angle),
            "The inclination is measured from the horizontal instead of from the vertical.":
            np.pi / 2 - angle,
        }  # fmt: skip


def mistaken_speed(before: float, action: float, limit: float) -> dict:
    """What slips make of the target speed: sentence -> number; before: the speed before."""
    change = float(np.clip(action, -1, 1))
    return slips(
        lambda start, change, cut: cut(start + change),
        start={"": before, "The action replaces the speed, but should be added to it.": 0.0},
        change={
            "": change,
            "The action is not cut to between -1 and 1, but should be.": action,
            "The action is subtracted from the speed, but should be added.": -change,
            "The action is multiplied by the time step, but should be the change itself.":
            0.01 * change,
            "The action is multiplied by FASTEST, but should be the change itself.": limit * change,
            "self.speed stays as it was before the call, but the action should be added.": 0.0,
            "The action has lost its sign, but a negative one should reduce self.speed.":
            abs(change),
            "An action beyond -1 or 1 changes nothing, but should be cut to -1 or 1.":
            action if abs(action) <= 1 else 0.0,
            "The action is replaced by its sign, but should only be cut to between -1 and 1.":
            float(np.sign(action)),
            "The tanh of the action is added, but the action should be cut to between -1 and 1.":
            float(np.tanh(action)),
        },
        cut={
            "": lambda speed: float(np.clip(speed, -limit, limit)),
            "self.speed is cut to between -1 and 1 instead of between -FASTEST and FASTEST.":
            lambda speed: float(np.clip(speed, -1, 1)),
            "self.speed is not cut to between -FASTEST and FASTEST, but should be.":
            lambda speed: speed,
            "self.speed is cut to a whole number, but its fraction should stay.":
            lambda speed: float(int(np.clip(speed, -limit, limit))),
            "self.speed is cut at FASTEST, but should be cut at -FASTEST, too.":
            lambda speed: min(speed, limit),
            "self.speed is cut at -FASTEST, but should be cut at FASTEST, too.":
            lambda speed: max(speed, -limit),
            "self.speed stays as it was if the sum is beyond -FASTEST or FASTEST, but should be "
            "cut to that limit.": lambda speed: speed if abs(speed) <= limit else before,
            "self.speed becomes 0 if the sum is beyond -FASTEST or FASTEST, but should be cut to "
            "that limit.": lambda speed: speed if abs(speed) <= limit else 0.0,
        },
    )  # fmt: skip


def mistaken_reward(speed: float, before: float, action: float) -> dict:
    """What slips make of the reward: sentence -> number; before: the speed before the action."""
    return slips(
        lambda one, price, size: one - price * size,
        one={"": 1.0, "The 1 for the step is left out, but should be added.": 0.0},
        price={
            "": 0.05,
            "A rad/s costs 0.5, but should cost 0.05.": 0.5,
            "A rad/s costs 0.005, but should cost 0.05.": 0.005,
            "A rad/s costs 1, but should cost 0.05.": 1.0,
            "The price of the speed is added, but should be subtracted.": -0.05,
            "The price of the speed is left out, but should be subtracted.": 0.0,
        },
        size={
            "": abs(speed),
            "The speed counts with its sign, but should cost in both directions: see abs().": speed,
            "The price is that of the square of the speed, but should be that of the speed.":
            speed**2,
            "The price is that of the speed before the action instead of the speed after it.":
            abs(before),
            "The price is that of the action instead of the speed.": abs(action),
        },
    )  # fmt: skip


WORLDS = {
    "Gravity along z is -9.81, but should be -10.": {"gravity": (0, 0, -9.81)},
    "Gravity has the wrong sign, so that it pulls upwards.": {"gravity": (0, 0, 10)},
    "Gravity pulls along x, but should pull along z.": {"gravity": (-10, 0, 0)},
    "Gravity pulls along y, but should pull along z.": {"gravity": (0, -10, 0)},
    "There is no gravity in this simulation: it should be set with physicsClientId, and after "
    "resetSimulation.": {"gravity": (0, 0, 0)},
    "The time step is PyBullet's own, 1/240 s, instead of TIME_STEP (see setTimeStep and its "
    "physicsClientId).": {"time_step": 1 / 240},
    "The time step is 0.1 instead of TIME_STEP.": {"time_step": 0.1},
    "The time step is 0.001 instead of TIME_STEP.": {"time_step": 0.001},
    "The inertias are PyBullet's own, but should be those of the file (see the flag "
    "URDF_USE_INERTIA_FROM_FILE).": {"flag": False},
    "The base begins at the height 0, but should begin at 0.001.": {"height": 0.0},
    "The base begins at the height 0.01, but should begin at 0.001.": {"height": 0.01},
    "The base begins at the height 0.1, but should begin at 0.001.": {"height": 0.1},
    "The base begins at the height 0.3, but should begin at 0.001.": {"height": 0.3},
    "The base begins at the height 1, but should begin at 0.001.": {"height": 1.0},
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
    "Both wheels turn the wrong way.": ((0, -1), (1, 1)),
    "Both motors get self.speed, but motor 1 should get -self.speed.": ((0, 1), (1, 1)),
    "Both motors get -self.speed, but motor 0 should get self.speed.": ((0, -1), (1, -1)),
    "Motor 1 gets no target velocity, or 0, but should get -self.speed.": ((0, 1),),
    "Motor 0 gets no target velocity, or 0, but should get self.speed.": ((1, -1),),
    "The motors get no target velocity, or 0, but should get self.speed and -self.speed.": (),
    "The motors get the change of the speed, but should get the new speed.":
    lambda before, change: ((0, change), (1, -change)),
    "The motors get the speed from before the action, but should get the new speed.":
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
            "They hardly turn. Each motor should have VELOCITY_CONTROL, a targetVelocity, and the "
            "force that PyBullet's motors have by themselves (leave out the argument force)."
        )
    if np.all((share > 0.1) & (share < 0.97)):
        return (
            "They turn too slowly. The target velocities should be self.speed and -self.speed, and "
            "the force that of PyBullet's motors by themselves (leave out the argument force)."
        )
    return ""


def why_fallen(parameters: np.ndarray, steps: list[int], balances) -> str:
    """Return why an evolved controller falls, or "".

    steps: of the episodes in evolution; balances: whether other parameters balance.
    """
    shifts = (np.roll(parameters, 1), np.roll(parameters, -1), parameters[::-1])
    if any(balances(each) for each in shifts):
        return "The same four numbers in another order balance: the order should be b, w1, w2, w3."
    if balances(-parameters):
        return "The same numbers with the opposite signs balance."
    if len(steps) < 4:
        return ""
    first, last = (float(np.mean(part)) for part in np.array_split(steps, 3)[::2])
    course = (
        f"In your evolution, the first third of the episodes lasted {first:.0f} steps on average, "
        f"and the last third {last:.0f}."
    )
    good, longest = steps.count(500), max(steps)
    if longest < 500 and 3 * steps.count(longest) > len(steps):
        return f"{course} None lasted for more than {longest} steps, but 500 should be possible."
    if last < 0.8 * first or max(steps[-len(steps) // 3 :]) < max(steps) / 2:
        return f"{course} They should become longer. Are the best candidates the parents?"
    if good == 0:
        return (
            f"{course} No candidate balanced. You can vary the weights more, or evolve for longer."
        )
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
        f"PPO learnt from {sum(steps)} steps (number of updates: {updates}); its last episodes "
        f"lasted {last:.0f} steps on average."
    )
    return (
        f"{told} You can, for example, learn for longer or update more often."
        if last < 400
        else told
    )
