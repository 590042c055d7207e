"""Grader of exercise 10; run it with `make test-ex10`.

Everything up to task 10.8 is compared with the grader's own simulation, on states, actions and
seeds that it draws. Each method of the environment is judged in a world that the grader has set
up, beside a second simulation, so that a forgotten physicsClientId shows. Where PyBullet is not
installed, botschool.course.stand_in answers the calls of both sides.

Stochastic checks (tasks 10.9 and 10.10): a controller must balance for 500 steps in 20 of 20 unseen
episodes (grading seeds 71, 73 and 81) in the grader's simulation. So that none can be written down
by heart, it is learnt for a robot whose gyroscope is mounted the other way round and for one whose
wheels turn the other way; evolution must begin with candidates that fall, other seeds must give
other runs, and all layers of task 10.10 must be those that PPO has made. With each of 20 seeds (1
to 20) the solution's `evolve` balances in 20 of 20 episodes, so its margin is whole; returns are
462 to 492. On the two other robots it did so in 39 of 40 runs (seeds 1000 to 1019; 0 of 20 episodes
with seed 1005 and the turned gyroscope). So where the first seed fails, a second one decides. PPO,
of which fewer runs were made (seed 1 and the grading seed), balanced in 20 of 20 episodes, too.
"""

import tempfile
from fnmatch import fnmatch
from functools import partial

import numpy as np
from gymnasium.utils import seeding
from slips import (
    mistaken_centre,
    mistaken_inclination,
    mistaken_mass,
    mistaken_reward,
    mistaken_speed,
    why_fallen,
    why_motors,
    why_untrained,
    why_world,
)

from botschool.course.robots import robot_file
from botschool.grading import (
    Exercise,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_ends,
    expect_fields,
    show,
)

exercise = Exercise(
    10,
    "A new environment",
    file="balancing_robot.py",
    imports=("pybullet", "pybullet_data"),
    extras=("pybullet", "rl"),
)
NAME = "BalanceBotBulletEnv-v0"
LIMIT = 24.6
BULLET = ("pybullet",)


def rng_of(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def close(got, wanted, tolerance: float) -> bool:
    try:
        got = np.asarray(got, dtype=float)
    except (TypeError, ValueError):
        return False
    return got.shape == np.shape(wanted) and np.allclose(got, wanted, tolerance, tolerance)


def expect_all(cases: list[tuple], tolerance: float) -> None:
    """All answers are right, (call, answer, right one, mistakes as in expect_close) each.

    If not, a mistake is named that explains all wrong ones and would not change the right ones.
    """
    wrong = [case for case in cases if not close(*case[1:3], tolerance)]
    if wrong:
        said, answer, wanted, mistakes = wrong[0]
        fits = [
            text
            for text in mistakes
            if all(text in made and close(got, made[text], tolerance) for _, got, _, made in cases)
        ]
        expect_close(said, answer, wanted, tolerance, why=lambda *_: "".join(fits[:1]))
        raise Wrong(f"{said} is {show(answer)}, but should be {show(wanted)}.")


def robot_text(turned: bool = False) -> str:
    """The robot's description; turned: its wheels turn the other way."""
    text = robot_file("balance_bot.urdf").read_text(encoding="utf-8")
    if turned:
        left, right = '<axis xyz="-1 0 0"/>', '<axis xyz="1 0 0"/>'
        text = text.replace(left, "<axis/>").replace(right, left).replace("<axis/>", right)
    return text


class World:
    """The grader's own simulation of the robot."""

    def __init__(
        self,
        inclination: float,
        speed: float = 0.0,
        urdf: str | None = None,
        gravity: tuple = (0, 0, -10),
        time_step: float = 0.01,
        flag: bool = True,
        height: float = 0.001,
    ) -> None:
        """The last four are other than here in worlds that slips make."""
        from botschool.course.bullet import pybullet, pybullet_data

        self.speed, self.bullet = speed, pybullet
        self.client = self.bullet.connect(self.bullet.DIRECT)
        self.bullet.setTimeStep(time_step, self.client)
        self.bullet.setGravity(*gravity, self.client)
        plane = pybullet_data.getDataPath() + "/plane.urdf"
        self.bullet.loadURDF(plane, physicsClientId=self.client)
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
            file.write(urdf or robot_text())
            file.flush()
            self.robot = self.bullet.loadURDF(
                file.name, [0, 0, height], self.bullet.getQuaternionFromEuler([inclination, 0, 0]),
                flags=self.bullet.URDF_USE_INERTIA_FROM_FILE if flag else 0,
                physicsClientId=self.client,
            )  # fmt: skip

    def __enter__(self) -> "World":
        return self

    def __exit__(self, *_) -> None:
        self.bullet.disconnect(self.client)

    def seen(self) -> list[float]:
        base = self.bullet.getBasePositionAndOrientation(self.robot, self.client)
        velocity = self.bullet.getBaseVelocity(self.robot, self.client)
        return [self.bullet.getEulerFromQuaternion(base[1])[0], velocity[1][0], self.speed]

    def height(self) -> float:
        return self.bullet.getBasePositionAndOrientation(self.robot, self.client)[0][2]

    def turns(self) -> list[float]:
        return [self.bullet.getJointState(self.robot, i, self.client)[1] for i in (0, 1)]

    def act(
        self, action: float | None, targets: tuple = ((0, 1), (1, -1)), late: bool = False
    ) -> None:
        """A step; with None the motors are left alone.

        targets: which motor gets how many times the speed, or a function that returns which motor
        gets what, of the speed before and of the change. late: after the simulation's step.
        """
        if late:
            self.bullet.stepSimulation(self.client)
        if action is not None:
            before, change = self.speed, min(max(action, -1.0), 1.0)
            self.speed = min(max(before + change, -LIMIT), LIMIT)
            pairs = targets(before, change) if callable(targets) else None
            pairs = pairs or [(motor, times * self.speed) for motor, times in targets or ()]
            if pairs:
                self.bullet.setJointMotorControlArray(
                    self.robot, [motor for motor, _ in pairs], self.bullet.VELOCITY_CONTROL,
                    targetVelocities=[speed for _, speed in pairs],
                    physicsClientId=self.client,
                )  # fmt: skip
        if not late:
            self.bullet.stepSimulation(self.client)


def on_stage(module, urdf, call, scenes):
    """Calls a method in worlds that the grader has set up; beside a decoy with the number 0."""
    import os

    import numpy
    import pybullet
    import pybullet_data

    from botschool.course.robots import use_robot

    def seen():
        base = pybullet.getBasePositionAndOrientation(env.robot, env.client)
        turning = pybullet.getBaseVelocity(env.robot, env.client)[1]
        inclination = pybullet.getEulerFromQuaternion(base[1])[0]
        return numpy.array([inclination, turning[0], env.speed], dtype=numpy.float32)

    def turn(action):
        change = numpy.clip(float(action[0]), -1, 1)
        env.speed = float(numpy.clip(env.speed + change, -24.6, 24.6))
        for i, target in enumerate((env.speed, -env.speed)):
            pybullet.setJointMotorControl2(
                env.robot,
                i,
                pybullet.VELOCITY_CONTROL,
                targetVelocity=target,
                physicsClientId=env.client,
            )

    use_robot(module, urdf)
    plane = os.path.join(pybullet_data.getDataPath(), "plane.urdf")
    decoy = pybullet.connect(pybullet.DIRECT)
    pybullet.loadURDF(plane, physicsClientId=decoy)
    other = pybullet.loadURDF("balance_bot.urdf", [0, 0, 0.5], physicsClientId=decoy)
    pybullet.resetBaseVelocity(other, [0.3, -0.2, 0.1], [1.5, 0.7, -0.6], physicsClientId=decoy)
    env = module.BalanceBotEnv()
    reports = []
    if call == "reset":
        env.observe = seen
        for seed in scenes:
            made = env.reset(seed=seed) if seed != "no seed" else env.reset()
            if not isinstance(made, (tuple, list)) or len(made) != 2:
                kind = "None" if made is None else f"a value of type {type(made).__name__}"
                return f"returned {kind}, but two things are asked for: the observation and {{}}."
            observation, info = made
            kind = str(getattr(observation, "dtype", type(observation).__name__))
            report = [observation, kind, env.speed, len(info) if isinstance(info, dict) else -1]
            bodies = pybullet.getNumBodies(env.client)
            report.append(bodies)
            if isinstance(env.robot, int) and not pybullet.getNumJoints(env.robot, env.client):
                which = "the plane" if 0 <= env.robot < bodies else "not in this simulation"
                return f"sets self.robot to {env.robot}, which is {which}, but should be the robot."
            for _ in range(30):
                pybullet.stepSimulation(env.client)
            there = pybullet.getBasePositionAndOrientation(env.robot, env.client)[0]
            reports.append([*report, seen(), there[2]])
            env.speed = 7.0
        return reports
    for inclination, others, turning, speed, actions in scenes:
        pybullet.resetSimulation(physicsClientId=env.client)
        pybullet.setTimeStep(0.01, env.client)
        pybullet.setGravity(0, 0, -10, env.client)
        pybullet.loadURDF(plane, physicsClientId=env.client)
        env.robot = pybullet.loadURDF(
            "balance_bot.urdf",
            [0, 0, 0.001],
            pybullet.getQuaternionFromEuler([inclination, *others]),
            flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
            physicsClientId=env.client,
        )
        pybullet.resetBaseVelocity(env.robot, [0, 0, 0], turning, physicsClientId=env.client)
        env.speed = speed
        if call == "observe":
            answer = env.observe()
            reports.append([answer, str(getattr(answer, "dtype", type(answer).__name__))])
        elif call == "drive":
            for action in actions:
                given = numpy.array([action], dtype=numpy.float32)
                env.drive(given)
                pybullet.stepSimulation(env.client)
                turns = [pybullet.getJointState(env.robot, i, env.client)[1] for i in (0, 1)]
                reports.append([env.speed, *turns, float(given[0])])
        elif call == "step":
            env.drive, env.observe = turn, seen
            for action in actions:
                answer = env.step(numpy.array([action], dtype=numpy.float32))
                kinds = [type(each).__name__ for each in answer]
                reports.append([list(answer[:4]), answer[-1], kinds])
        elif call == "fallen":
            for height in actions:
                turned = pybullet.getQuaternionFromEuler([inclination, *others])
                place = [0.7, -0.9, height], turned
                pybullet.resetBasePositionAndOrientation(env.robot, *place, env.client)
                there = pybullet.getBasePositionAndOrientation(env.robot, env.client)[0]
                reports.append([there[2], bool(env.fallen())])
        elif call == "draw":
            env.drive, env.observe = turn, seen
            for env.render_mode in (None, "rgb_array", "human"):
                drawn = []
                env.render = lambda drawn=drawn: drawn.append(1)
                for action in actions:
                    env.step(numpy.array([action], dtype=numpy.float32))
                reports.append(len(drawn))
    return reports


def spaces_of(module):
    """Return the spaces of an environment."""
    env = module.BalanceBotEnv()
    reports = []
    for space in (env.observation_space, env.action_space):
        if type(space).__name__ != "Box":
            return type(space).__name__
        reports.append([space.low, space.high, str(space.dtype)])
    return reports


def staged(student: Student, said: str, call: str, scenes: list) -> list:
    answer = student.run(on_stage, robot_text(), call, scenes, said=said)
    expect(not isinstance(answer, str), f"{said} {answer}")
    expect(isinstance(answer, list), f"{said}: {show(answer)} is no answer.")
    return answer


# ------------------------------------------------------------------ 10.1
reading = exercise.task("10.1", "Read the robot", packages=())


def random_robot(index: int, nlinks: int) -> tuple[str, dict]:
    """A description of a robot that nobody has seen, and what there is to say about it.

    From index 2 on, all links come first, and the joints of siblings in another order than these.
    """
    rng = rng_of(index)
    names = [f"part_{letter}" for letter in rng.permutation(list("abcdefgh"))[:nlinks]]
    masses = {name: float(rng.integers(1, 400)) / 100 for name in names}
    lines, joints = [], []
    frames, moment = {names[0]: np.zeros(3)}, np.zeros(3)
    parents, offsets, centres = [None], [np.zeros(3)], []

    def text(values) -> str:
        return " ".join(f"{value:g}" for value in values)

    def link(name: str) -> None:
        centre = rng.integers(-50, 50, 3) / 100 if rng.random() < 0.7 else np.zeros(3)
        origin = f'<origin xyz="{text(centre)}"/>' if centre.any() else ""
        moment[:] += masses[name] * (frames[name] + centre)
        centres.append(centre)
        lines.append(
            f'<link name="{name}"><visual><origin xyz="9 9 9"/></visual><inertial>{origin}'
            f'<mass value="{masses[name]:g}"/></inertial></link>'
        )

    link(names[0])
    for i, name in enumerate(names[1:]):
        parent = names[rng.integers(0, i + 1)]
        offset = rng.integers(-50, 50, 3) / 100 if rng.random() < 0.8 else np.zeros(3)
        frames[name] = frames[parent] + offset
        parents.append(names.index(parent))
        offsets.append(offset)
        axis = np.eye(3)[rng.integers(0, 3)] * rng.choice([-2, -1, 1, 2])
        given = rng.random() < 0.7
        kind, own = str(rng.choice(["continuous", "revolute", "prismatic"])), f"joint_{nlinks - i}"
        origin = f'<origin xyz="{text(offset)}"/>' if offset.any() else ""
        link(name)
        lines.append(
            f'<joint type="{kind}" name="{own}"><parent link="{parent}"/><child link="{name}"/>'
            + origin
            + (f'<axis xyz="{text(axis)}"/></joint>' if given else "</joint>")
        )
        axis = axis.tolist() if given else [1.0, 0.0, 0.0]
        joint = {"name": own, "type": kind, "parent": parent, "child": name, "axis": axis}
        joints.append(joint | {"default": not given})
    if index >= 2:
        depths = [0]
        for parent in parents[1:]:
            depths.append(depths[parent] + 1)
        order = sorted(range(len(joints)), key=lambda i: (depths[i + 1], -i))
        joints = [joints[i] for i in order]
        lines = lines[:1] + lines[1::2] + [lines[2::2][i] for i in order]
    mass = sum(masses.values())
    urdf = f'<?xml version="1.0"?>\n<robot name="random">{"".join(lines)}</robot>'
    parts = list(masses.values()), parents, offsets, centres
    return urdf, {
        "links": masses, "joints": joints, "mass": mass, "centre": moment / mass, "parts": parts
    }  # fmt: skip


def described(student: Student, index: int) -> tuple[str, list, dict]:
    urdf, expected = random_robot(index, 3 + index)
    answer = student.call("describe", urdf)
    said = f"describe(a robot of {3 + index} links)"
    return said, expect_fields(said, answer, "links", "joints", "mass", "centre"), expected


@reading.check(4)
def links_and_their_masses(student: Student):
    for index in range(3):
        said, (links, _, mass, _), expected = described(student, index)
        expect(
            isinstance(links, dict) and list(links) == list(expected["links"]),
            f"{said}: links is {show(links)}, but should be a dict with the names "
            f"{', '.join(expected['links'])}, in this order.",
        )
        for name, value in expected["links"].items():
            mistakes = {"The mass should be that of the file, and not rounded.": round(value, 1),
                        "The mass should not be cut to a whole number.": int(value)}  # fmt: skip
            expect_close(f"{said}: the mass of {name}", links[name], value, mistakes=mistakes)
        mistakes = mistaken_mass(list(expected["links"].values()))
        expect_close(f"{said}: mass", mass, expected["mass"], mistakes=mistakes)


@reading.check(4)
def joints_and_what_they_join(student: Student):
    for index in range(3):
        said, (_, joints, *_), expected = described(student, index)
        expect(
            isinstance(joints, list) and len(joints) == len(expected["joints"]),
            f"{said}: joints is {show(joints)}, but should be a list of {len(expected['joints'])} "
            "dicts.",
        )
        for i, (joint, wanted) in enumerate(zip(joints, expected["joints"], strict=True)):
            keys = ("name", "type", "parent", "child")
            found = expect_fields(f"{said}: joint {i}", joint, *keys, "axis")
            for key, value in zip(keys, found, strict=False):
                expect(
                    value == wanted[key],
                    f"{said}: the {key} of joint {i} is {show(value)}, but should be "
                    f"{wanted[key]!r}.",
                )
            mistakes = {}
            defaults = ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0])
            if wanted["default"] and any(close(found[-1], made, 1e-9) for made in defaults):
                text = "The file gives this joint no axis, so it turns around x, [1, 0, 0]."
                mistakes[text] = found[-1]
            said_of = f"{said}: the axis of joint {i}"
            expect_close(said_of, found[-1], wanted["axis"], mistakes=mistakes)


@reading.check(4)
def centre_of_mass(student: Student):
    for index in range(4):
        said, (*_, centre), expected = described(student, index)
        mistakes = mistaken_centre(*expected["parts"])
        expect_close(f"{said}: centre", centre, expected["centre"], 1e-6, mistakes)


# ------------------------------------------------------------------ 10.2
spaces = exercise.task("10.2", "The spaces", packages=())


def expect_space(student: Student, which: int, name: str, high: list[float]) -> None:
    answer = student.run(spaces_of, said="BalanceBotEnv()")
    expect(
        isinstance(answer, list),
        f"BalanceBotEnv(): a space is of type {answer}, but both should be of type Box.",
    )
    got_low, got_high, kind = answer[which]
    for side, got, wanted in (("low", got_low, -np.array(high)), ("high", got_high, high)):
        fits = isinstance(got, np.ndarray) and got.shape == np.shape(wanted)
        exchanged = fits and np.allclose(np.sort(got), np.sort(wanted), rtol=1e-6)
        why = " The limits are right, but in the wrong order." if exchanged else ""
        expect(
            fits and np.allclose(got, wanted, rtol=1e-6),
            f"BalanceBotEnv(): {name}.{side} is {show(got)}, but should be "
            f"{show(np.array(wanted))}.{why}",
        )
    expect(kind == "float32", f"BalanceBotEnv(): {name} is of type {kind}, but should be float32.")


@spaces.check(4)
def what_it_observes(student: Student):
    expect_space(student, 0, "observation_space", [np.pi, np.inf, LIMIT])


@spaces.check(4)
def what_it_does(student: Student):
    expect_space(student, 1, "action_space", [1.0])


# ------------------------------------------------------------------ 10.3
observing = exercise.task("10.3", "What the robot feels", packages=BULLET)


@observing.check(8)
def observes(student: Student):
    rng = rng_of(10)
    scenes = [
        (lean * rng.uniform(0.5, 1), rng.uniform(-0.3, 0.3, 2), rng.uniform(-3, 3, 3),
         rng.uniform(-20, 20), [])
        for lean in (0.6, -0.6, 3.0, 0.3, -0.3, -3.0)
    ]  # fmt: skip
    from botschool.course.bullet import pybullet

    answers = staged(student, "observe()", "observe", scenes[:3])
    answers += staged(student, "observe()", "observe", scenes[3:])
    for (inclination, others, turning, speed, _), (answer, kind) in zip(
        scenes, answers, strict=True
    ):
        said = (
            f"observe(), with inclination {inclination:.3f}, angular velocity {turning[0]:.3f} and "
            f"self.speed {speed:.2f}"
        )
        mistakes = {}
        for axis, angle, change in zip("yz", others, turning[1:], strict=True):
            around = f"is that around {axis}, but should be that around x."
            mistakes[f"The inclination {around}"] = [angle, turning[0], speed]
            mistakes[f"The angular velocity {around}"] = [inclination, change, speed]
        quaternion = pybullet.getQuaternionFromEuler([inclination, *others])
        for text, angle in mistaken_inclination(inclination, quaternion).items():
            mistakes[text] = [angle, turning[0], speed]
        for i, name in enumerate(("inclination", "angular velocity", "speed of the wheels")):
            wrong, answered = [inclination, turning[0], speed], np.ravel(answer)
            if answered.dtype.kind == "f" and len(answered) == 3 and np.isfinite(answered).all():
                wrong[i] = float(answered[i])
                mistakes.setdefault(f"Only the {name} is wrong.", wrong)
        expect_close(said, answer, [inclination, turning[0], speed], 1e-4, mistakes)
        expect(
            kind == "float32",
            f"{said} returned a value of type {kind}, but an array of float32 is asked for.",
        )


# ------------------------------------------------------------------ 10.4
resetting = exercise.task("10.4", "A new world", packages=BULLET)


def after_resets(student: Student, index: int, seeds: list):
    """For each reset its name, the report, and the inclination that it should begin with."""
    reports = staged(student, "reset()", "reset", seeds)
    generator = None
    for seed, report in zip(seeds, reports, strict=True):
        if seed != "no seed":
            generator = seeding.np_random(seed)[0]
        said = "reset()" if seed == "no seed" else f"reset(seed={seed})"
        yield said, report, generator.uniform(-0.3, 0.3)


@resetting.check(4)
def begins_at_random(student: Student):
    seeds = [exercise.seed(20), 0, exercise.seed(21), 0, exercise.seed(20)]
    cases = []
    for said, (observation, kind, *_), inclination in after_resets(student, 20, seeds):
        share = (inclination + 0.3) / 0.6
        others = {
            "The inclination is drawn in degrees, from -17 to 17, but should be drawn in radians, "
            "from -0.3 to 0.3.": 34 * share - 17,
            "The inclination is drawn from -17 to 17 degrees, but should be drawn from -0.3 to 0.3 "
            "radians.": np.radians(34 * share - 17),
            "The inclination is drawn from -1 to 1, but should be drawn from -0.3 to 0.3.":
            2 * share - 1,
            "The inclination is drawn from 0 to 1, but should be drawn from -0.3 to 0.3.": share,
            "The inclination is drawn from 0 to 0.3, but should be drawn from -0.3 to 0.3.":
            0.3 * share,
            "The inclination is drawn from 0 to 0.6, but should be drawn from -0.3 to 0.3.":
            0.6 * share,
            "The inclination has the wrong sign.": -inclination,
            "The first Euler angle is 0, so the body does not lean around x.": 0.0,
        }  # fmt: skip
        mistakes = {
            text: [(angle + np.pi) % (2 * np.pi) - np.pi, 0.0, 0.0]
            for text, angle in others.items()
        }
        wanted = [inclination, 0.0, 0.0]
        cases.append((f"{said}: observation", observation, wanted, mistakes))
        expect(
            kind == "float32", f"{said}: the observation is of type {kind}, but should be float32."
        )
    leans = {float(np.ravel(case[1])[0]) for case in cases if close(case[1], case[1], 0)}
    if len(leans) == 1:
        for case in cases:
            case[3].setdefault("The inclination is the same after each seed.", case[1])
    expect_all(cases, 1e-5)


GOES_ON = (
    "Without a seed, self.np_random should go on from where it is. The inclination should be the "
    "next number of its uniform(-0.3, 0.3), and nothing else should be drawn from it."
)


@resetting.check(4)
def goes_on_without_seed(student: Student):
    seeds = [exercise.seed(22), "no seed", "no seed", 0, "no seed"]
    for said, report, inclination in after_resets(student, 22, seeds):
        observation, _, speed, info = report[:4]
        expect_close(
            f"{said}{'' if said == f'reset(seed={seeds[0]})' else ' after another episode'}: "
            "inclination",
            observation[0],
            inclination,
            1e-5,
            why=lambda text="" if said != "reset()" else GOES_ON: text,
        )
        expect(
            speed == 0,
            f"{said}{'' if said == f'reset(seed={seeds[0]})' else ' after another episode'}: "
            f"self.speed is {show(speed)}, but should be 0.",
        )
        expect(info == 0, f"{said}: the info should be an empty dict.")


@resetting.check(4)
def makes_the_world(student: Student):
    seeds = [exercise.seed(24), "no seed", exercise.seed(26)]
    for said, report, inclination in after_resets(student, 24, seeds):
        expect(
            report[4] == 2,
            f"{said}: the number of bodies in the simulation is {report[4]}, but should be 2: the "
            "plane and the robot.",
        )
        with World(inclination) as world:
            for _ in range(30):
                world.act(None)
            expected = world.seen()
        answer = expect_array(f"{said}: the observation 30 steps later", report[5], (3,))
        if np.allclose(answer[:2], expected[:2], atol=1e-4):
            continue

        begins = float(np.ravel(report[0])[0])

        def seen(begins=begins, **changes) -> list[float]:
            with World(begins, **changes) as world:
                for _ in range(30):
                    world.act(None)
                return [*world.seen()[:2], world.height()]

        found = [*answer[:2], report[6]]
        cause = why_world(seen, found)
        if abs(begins - inclination) > 1e-4 and np.allclose(found, seen(), atol=2e-3):
            cause = (
                "This follows from the inclination at the start, which is wrong: mend that first."
            )
        raise Wrong(
            f"{said}{'' if said == f'reset(seed={seeds[0]})' else ' after another episode'}: "
            "30 steps later, without a call of drive, inclination and angular velocity are "
            f"{show(answer[:2])}, but should be {show(np.array(expected[:2]))}. "
            + (
                cause
                or "The world should be as the text of reset says, and made anew in each reset, so "
                "that nothing stays from an episode before (such as turning wheels)."
            )
        )


# ------------------------------------------------------------------ 10.5
driving = exercise.task("10.5", "The motors", packages=BULLET)


def compare_drives(student: Student, courses: list[tuple[float, list[float]]]) -> None:
    """The speeds of all courses, (speed at first, actions), and then what the wheels do."""
    cases, found = [], []
    for speed, actions in courses:
        scene = (0.1, [0.0, 0.0], [0.0, 0.0, 0.0], speed, actions)
        found.append(staged(student, "drive(action)", "drive", [scene]))
        right, own = speed, speed
        for i, (action, answer) in enumerate(zip(actions, found[-1], strict=True), 1):
            right = min(max(right + min(max(action, -1.0), 1.0), -LIMIT), LIMIT)
            mistakes = mistaken_speed(float(own), action, LIMIT)
            cases.append(
                (f"{call_of(i, action, speed)}: the target speed", answer[0], right, mistakes)
            )
            own = answer[0]
    expect_all(cases, 1e-5)
    for (speed, actions), answers in zip(courses, found, strict=True):
        compare_wheels(speed, actions, answers)


def call_of(i: int, action: float, speed: float) -> str:
    return f"drive([{action:.3f}]), call {i} since self.speed was {speed:.2f}"


def compare_wheels(speed: float, actions: list[float], answers: list) -> None:
    with World(0.1, speed) as world:
        for i, (action, answer) in enumerate(zip(actions, answers, strict=True), 1):
            said = call_of(i, action, speed)
            world.act(float(np.float32(action)))
            expect(
                answer[3] == np.float32(action),
                f"{said} changed the caller's array to [{answer[3]:.3f}], but should leave the "
                "action as it is.",
            )
            turns, wanted = np.array(answer[1:3]), np.array(world.turns())
            if np.allclose(turns, wanted, atol=1e-3):
                continue

            def turned(targets: tuple, until=i) -> list[float]:
                with World(0.1, speed) as other:
                    for each in actions[:until]:
                        other.act(float(np.float32(each)), targets)
                    return other.turns()

            raise Wrong(
                f"{said}: a step later the wheels turn at {show(turns)} rad/s, but should "
                f"turn at {show(wanted)}. {why_motors(turned, turns, wanted)}".rstrip()
            )


@driving.check(5)
def speeds_up_and_slows_down(student: Student):
    rng = rng_of(30)
    courses = [(speed, [0.0, *rng.uniform(-1, 1, 5).tolist()]) for speed in (0.0, 3.0, -5.0)]
    compare_drives(student, courses)


@driving.check(5)
def stays_within_limits(student: Student):
    rng = rng_of(31)
    courses = []
    for speed in (0.0, 5.0):
        beyond = (rng.choice([-1, 1], 4) * rng.uniform(2, 30, 4)).tolist()
        courses.append((speed, [*beyond[:2], 0.6, *beyond[2:]]))
    for side in (-1, 1):
        courses += [
            (side * 23.5, [side * 0.9, side * 0.8, side * 0.4, -side * 0.7]),
            (side * 24.0, [side * 0.7, side * 0.5, side * 1.5, -side * 0.9]),
        ]
    compare_drives(student, courses)


# ------------------------------------------------------------------ 10.6
stepping = exercise.task("10.6", "Reward, end and step", packages=BULLET)


def steps_of(student: Student, index: int):
    """For each of many steps: what the student returned, what the grader has, and before it.

    The last of these is a dict: "action", what is seen and the "height" before the step, and what
    is seen if the motors get the new speed only "late".
    """
    rng = rng_of(index)
    scenes = [
        (rng.uniform(0.1, 0.3) * side, [0.0, 0.0], [0.0, 0.0, 0.0], speed,
         rng.uniform(-1, 1, n).tolist())
        for side, speed, n in ((1, 0.0, 110), (-1, 3.0, 12), (1, -3.0, 12), (-1, 23.0, 6))
    ]  # fmt: skip
    answers = iter(staged(student, "step(action)", "step", scenes))
    for inclination, _, _, speed, actions in scenes:
        with World(inclination, speed) as world, World(inclination, speed) as other:
            for i, action in enumerate(actions, 1):
                before = {"action": action, "seen": world.seen(), "height": world.height()}
                world.act(float(np.float32(action)))
                other.act(float(np.float32(action)), late=True)
                before["late"] = other.seen()
                said = f"step {i} of an episode that begins with self.speed = {speed:g}"
                yield said, next(answers), world, before
                if world.height() < 0.1:
                    break
            for _ in actions[i:]:
                next(answers)


@stepping.check(4)
def moves_one_step(student: Student):
    for said, ((observation, *_), info, kinds), world, before in steps_of(student, 40):
        expect(
            len(kinds) == 5,
            f"{said}: the number of returned values is {len(kinds)}, but should be 5.",
        )
        expect(info == {}, f"{said}: info is {show(info)}, but should be an empty dict.")
        if world.height() > 0.2:
            mistakes = {
                "It is the observation before the simulation's step: observe after it.":
                [*before["seen"][:2], world.speed],
                "It is the observation before the action and the step: observe after them.":
                before["seen"],
                "The motors get the new speed only after the simulation's step: drive first.":
                before["late"],
            }  # fmt: skip
            expect_close(f"{said}: observation", observation, world.seen(), 2e-3, mistakes)


@stepping.check(3)
def rewards(student: Student):
    cases = []
    for said, ((_, reward, *_), _, kinds), world, before in steps_of(student, 41):
        wanted = 1 - 0.05 * abs(world.speed)
        mistakes = mistaken_reward(world.speed, before["seen"][2], before["action"])
        said_of = f"{said}, after which it should be {world.speed:.3f}: reward"
        cases.append((said_of, reward, wanted, mistakes))
        expect(kinds[1] != "ndarray", f"{said}: the reward is an array, but should be a float.")
    expect_all(cases, 1e-5)


def of_fallen(student: Student) -> str:
    """What the method fallen says of bodies that stand and lean, where step is wrong about an end.

    A body that leans, and one that has turned over, is as high as one that is upright.
    """
    heights = [0.02, 0.05, 0.08, 0.11, 0.14, 0.16, 0.2, 0.25, 0.3, 0.4]
    said = []
    for lean in (0.0, 0.7, -0.7, 1.7, -3.0):
        scene = (lean, [0.0, 0.0], [0.0, 0.0, 0.0], 5.0, heights)
        said.append([fell for _, fell in staged(student, "fallen()", "fallen", [scene])])
    if any(each != said[0] for each in said):
        return (
            "\n  At the same height, fallen() is not the same for bodies that lean differently, "
            "but the height alone should decide."
        )
    low = said[0].count(True)
    if low not in (0, 5, 10) and said[0] == [True] * low + [False] * (10 - low):
        return (
            f"\n  fallen() is True at {heights[low - 1]} m and False at {heights[low]} m, but "
            "should change at LOWEST, 0.15 m."
        )
    if low in (0, 10):
        return (
            f"\n  fallen() is {low == 10} at each height from 0.02 m to 0.4 m (of a body that was "
            "put there, before any step of the simulation)."
        )
    if said[0] == [False] * 5 + [True] * 5:
        return (
            "\n  fallen() is False below LOWEST and True above, but should be the other way round."
        )
    if said[0] == [True] * 5 + [False] * 5:
        return (
            "\n  fallen() itself is right up to 0.14 m and from 0.16 m on. It should change at "
            "0.15 m, and step should return what it says after the simulation's step."
        )
    return ""


@stepping.check(3)
def ends_when_fallen(student: Student):
    wrong, early, missed = None, True, False
    for said, (answer, _, kinds), world, before in steps_of(student, 42):
        expect(
            len(kinds) == 5,
            f"{said}: the number of returned values is {len(kinds)}, but should be 5.",
        )
        (terminated, truncated), height = answer[2:4], world.height()
        fell = terminated if abs(height - 0.15) <= 1e-3 else height < 0.15
        fallen_before = before["height"] < 0.15 - 1e-3
        missed |= terminated != fell
        early &= terminated == fallen_before or abs(before["height"] - 0.15) <= 1e-3
        expect(
            fell or terminated or truncated is not True,
            f"{said}: truncated is True, but step should always return False there: "
            "Gymnasium watches the time limit.",
        )
        why = f"with the centre of the body {height:.3f} m high it should be"
        try:
            expect_ends(said, (terminated, truncated), (fell, False), why)
        except Wrong as error:
            wrong = wrong or error
    if wrong and early and missed:
        raise Wrong(
            f"{wrong}\n  terminated fits the height before the step, but should fit that after it."
        )
    if wrong:
        raise Wrong(f"{wrong}{of_fallen(student)}" if missed else str(wrong))
    for heights in ([0.15, 0.3], [0.05, 0.1499, 0.1501, 0.15]):
        scene = (0.0, [0.0, 0.0], [0.0, 0.0, 0.0], 0.0, heights)
        for height, fell in staged(student, "fallen()", "fallen", [scene]):
            said = f"fallen(), with the centre of the body at a height of {height:.6g}"
            expect(fell == (height < 0.15), f"{said}, is {fell}, but should be {not fell}.")


@stepping.check(2)
def draws_in_a_window_only(student: Student):
    scene = (0.1, [0.0, 0.0], [0.0, 0.0, 0.0], 0.0, [0.5] * 4)
    counts = staged(student, "step(action)", "draw", [scene])
    for mode, drawn in zip((None, "rgb_array", "human"), counts, strict=True):
        wanted = 4 if mode == "human" else 0
        expect(
            drawn == wanted,
            f"with self.render_mode = {mode!r}, in four calls of step([0.5]), the number of calls "
            f"of self.render() is {drawn}, but should be {wanted}.",
        )


@stepping.check(2)
def leaves_the_time_limit_to_gymnasium(student: Student):
    scene = (0.1, [0.0, 0.0], [0.0, 0.0, 0.0], 0.0, [0.0] * 510)
    answers = staged(student, "step(action)", "step", [scene])
    for i, ((_, _, _, truncated), *_) in enumerate(answers, 1):
        expect(
            not truncated,
            f"step([0.0]), call {i}: truncated is {show(truncated)}, but should be False. The "
            "environment itself should never cut an episode: max_episode_steps of task 10.7 does.",
        )


# ------------------------------------------------------------------ 10.7
registering = exercise.task("10.7", "A name for the environment", seconds=40, packages=BULLET)


def registered(module, urdf, seed, gains=None):
    """Plays an episode with a controller that the grader can compute again.

    Without a controller: lets Gymnasium check the environment, and begins an episode after it.
    """
    import functools
    import importlib
    import os
    import warnings

    import gymnasium
    import numpy
    from gymnasium.utils.env_checker import check_env

    from botschool.course.robots import use_robot

    name = "BalanceBotBulletEnv-v0"
    use_robot(module, urdf)
    gymnasium.registry.pop(name, None)
    module.register_robot()
    if name not in gymnasium.registry:
        near = [each for each in gymnasium.registry if each.lower().startswith("bal")]
        return f"register_robot did not register {name!r}{f', but {near[0]!r}' if near else ''}."
    made = gymnasium.registry[name].entry_point
    if not callable(made) and ":" not in str(made):
        return f"entry_point is {made!r:.60}, but should be the class itself."
    if isinstance(made, str):
        place, _, inside = made.partition(":")
        try:
            functools.reduce(getattr, inside.split("."), importlib.import_module(place))
        except Exception:
            return f"entry_point is {made!r:.60}, which cannot be imported here: take the class."
    most = gymnasium.registry[name].max_episode_steps
    warnings.simplefilter("ignore")
    if gains is None:
        module.register_robot()  # once more, as in a notebook
        env, other = (gymnasium.make(name).unwrapped for _ in range(2))
        if env is other:
            return "it gives the same object twice, but each call should make a new environment."
        other.close()
        check_env(env, skip_render_check=True)
        return env.reset(seed=seed)[0]
    env = gymnasium.make(name, render_mode="rgb_array")
    if env.unwrapped.render_mode != "rgb_array":
        return f"its render_mode is {env.unwrapped.render_mode!r}, but should be 'rgb_array'."
    observation, ends = env.reset(seed=seed)[0], [False, False]
    seen = [observation]
    while len(seen) <= 600 and not any(ends):
        action = numpy.clip([numpy.dot(gains, observation)], -1, 1).astype(numpy.float32)
        observation, _, *ends, _ = env.step(action)
        seen.append(observation)
    return [numpy.array(seen), *map(bool, ends), most]


def episode_of(inclination: float, gains: np.ndarray) -> tuple[np.ndarray, bool]:
    """The grader's own episode: its observations, and whether the robot fell."""
    observations = []
    with World(inclination) as world:
        observations.append(world.seen())
        while len(observations) <= 500 and world.height() >= 0.15:
            observed = np.array(observations[-1], dtype=np.float32)
            world.act(float(np.clip(np.float32(gains @ observed), -1, 1)))
            observations.append(world.seen())
        return np.array(observations), world.height() < 0.15


def compare_episode(student: Student, index: int, gains: np.ndarray) -> None:
    """The student's episode is the grader's, as far as rounding does not decide about it.

    A quaternion that is written out may differ in its last digits from PyBullet's, and what falls
    makes small differences large. So the grader's episode is played from neighbouring starts, too.
    """
    seed = exercise.seed(index)
    made = f'gymnasium.make("{NAME}", render_mode="rgb_array")'
    said = f"an episode of {made} with seed {seed}"
    answer = student.run(registered, robot_text(), seed, gains, said=said)
    expect(not isinstance(answer, str), f"{made}: {answer}")
    expect(isinstance(answer, list) and len(answer) == 4, f"{said}: no answer came back.")
    seen, terminated, truncated, most = answer
    start = seeding.np_random(seed)[0].uniform(-0.3, 0.3)
    ways = [episode_of(start + change, gains) for change in (0.0, 1e-7, -1e-7, 1e-6, -1e-6)]
    (observations, fell), lengths = ways[0], {len(each) for each, _ in ways}
    steps = len(observations) - 1
    expect(
        isinstance(seen, np.ndarray) and seen.ndim == 2 and seen.shape[1] == 3,
        f"{said}: no observations of three numbers came back.",
    )
    endless = "" if most == 500 else f" max_episode_steps is {show(most)}, but should be 500."
    expect(
        min(lengths) <= len(seen) <= max(lengths),
        f"{said}: the number of steps played is {len(seen) - 1}, but should be {steps}.{endless}",
    )
    expect_ends(
        said, (terminated, truncated), (fell, not fell), f"after {steps} steps it should be"
    )
    length = min(len(seen), *lengths)
    seen, observations = seen[:length], observations[:length]
    apart = np.max([np.abs(each[:length] - observations) for each, _ in ways], axis=0)
    spread = np.maximum.accumulate(apart)  # once they have parted, they meet by chance only
    off = (np.abs(seen - observations) > 0.02 + 3 * spread).any(axis=1)
    if off.any():
        i = int(off.argmax())
        raise Wrong(
            f"{said}: observation {i} is {show(seen[i])}, but should be {show(observations[i])}."
        )


@registering.check(5)
def ends_after_500_steps(student: Student):
    compare_episode(student, 50, rng_of(50).uniform(0.9, 1.1, 3) * [-10, -1, 0.0])


@registering.check(3)
def ends_when_it_falls(student: Student):
    for index in (51, 52):
        compare_episode(student, index, rng_of(index).uniform(0.1, 0.3, 3) * [1, 1, 0])


@registering.check(4)
def passes_gymnasiums_checker(student: Student):
    seed = exercise.seed(53)
    said = f"Gymnasium's check_env, or reset(seed={seed}) after it,"
    begins = student.run(registered, robot_text(), seed, said=said)
    expect(not isinstance(begins, str), f"gymnasium.make: {begins}")
    with World(seeding.np_random(seed)[0].uniform(-0.3, 0.3)) as world:
        expect_close(said, begins, np.array(world.seen()), tolerance=0.02)


# ------------------------------------------------------------------ 10.8
packaging = exercise.task("10.8", "A package of its own", packages=())


def imported(module, init, numbers):
    """Installs __init__.py beside a class of the grader's, and lets Gymnasium make it by name."""
    import importlib.util
    import os
    import sys

    import gymnasium

    os.makedirs("site/balance_bot")
    with open("site/balance_bot/__init__.py", "w") as file:
        file.write(init)
    with open("site/balance_bot/env.py", "w") as file:
        file.write(
            "import gymnasium\nimport numpy\n\nclass BalanceBotEnv(gymnasium.Env):\n"
            "    observation_space = gymnasium.spaces.Box(-9, 9, (1,))\n"
            "    action_space = gymnasium.spaces.Box(-1, 1, (1,))\n"
            f"    numbers = {list(numbers)!r}\n"
            "    def reset(self, *, seed=None, options=None):\n"
            "        self.at = 0\n        return self.observe(), {}\n"
            "    def observe(self):\n"
            "        return numpy.array([self.numbers[self.at % 7]], dtype=numpy.float32)\n"
            "    def step(self, action):\n"
            "        self.at += 1\n        return self.observe(), 0.0, False, False, {}\n"
        )
    sys.path.insert(0, os.path.abspath("site"))
    gymnasium.registry.pop("BalanceBotBulletEnv-v0", None)
    import balance_bot

    early = "balance_bot.env" in sys.modules
    spec = gymnasium.registry.get("BalanceBotBulletEnv-v0")
    if spec is not None and isinstance(spec.entry_point, str):
        module, colon, _ = spec.entry_point.partition(":")
        try:
            found = module.startswith("balance_bot") and importlib.util.find_spec(module)
        except ModuleNotFoundError:
            found = None
        if not colon or not found:
            return spec.entry_point
    env = gymnasium.make("BalanceBotBulletEnv-v0", disable_env_checker=True)
    seen = [env.reset()[0][0]]
    for step in range(1, 1001):
        observation, _, _, truncated, _ = env.step(env.action_space.sample())
        seen.append(observation[0])
        if truncated:
            return [step, seen, early]
    return [0, seen, early]


@packaging.check(4)
def says_what_it_needs(student: Student):
    try:
        import tomllib
    except ModuleNotFoundError:  # Python 3.10
        from pip._vendor import tomli as tomllib

    files = student.call("package_files")
    (text,) = expect_fields(student.said, files, "pyproject.toml")
    said = 'package_files()["pyproject.toml"]'
    expect(isinstance(text, str), f"{said} is {show(text)}, but should be a text.")
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Wrong(f"{said} is not valid TOML: {error}.") from None
    for table in ("build-system", "project", "tool"):
        expect(isinstance(content.get(table), dict), f"{said} has no table [{table}].")
    (backend,) = expect_fields(f"{said}: [build-system]", content.get("build-system"), "requires")
    expect(
        isinstance(backend, list) and any("setuptools" in str(each) for each in backend),
        f"{said}: requires in [build-system] should be a list that names setuptools.",
    )
    backend = content["build-system"].get("build-backend")
    expect(
        isinstance(backend, str) and backend.split(":")[0] == "setuptools.build_meta",
        f"{said}: build-backend is {show(backend)}, but should be 'setuptools.build_meta'.",
    )
    project = content.get("project")
    name, version, needs = expect_fields(
        f"{said}: [project]", project, "name", "version", "dependencies"
    )
    expect(
        str(name).replace("-", "_") == "balance_bot",
        f"{said}: the project's name is {show(name)}, but should be balance_bot.",
    )
    expect(isinstance(version, str) and version != "", f"{said}: the version should be a text.")
    for package in ("gymnasium", "numpy", "pybullet"):
        expect(
            isinstance(needs, list) and any(str(each).startswith(package) for each in needs),
            f"{said}: dependencies should be a list that names {package}.",
        )
    tool = content.get("tool", {}).get("setuptools", {})
    (packages,) = expect_fields(f"{said}: [tool.setuptools]", tool, "packages")
    expect("package-data" in tool, f"{said}: [tool.setuptools] has no 'package-data'.")
    data = tool["package-data"]
    expect(
        packages == ["balance_bot"],
        f"{said}: packages is {show(packages)}, but should be ['balance_bot'].",
    )
    expect(
        isinstance(data, dict) and "balance_bot" in data,
        f"{said}: package-data is {show(data)}, but should be a table with a list of files under "
        "the name of the package, balance_bot.",
    )
    patterns = data["balance_bot"]
    expect(
        not isinstance(patterns, str),
        f"{said}: package-data has the text {show(patterns)} for balance_bot, but should have a "
        "list.",
    )
    expect(
        isinstance(patterns, list) and any(fnmatch("balance_bot.urdf", str(p)) for p in patterns),
        f"{said}: package-data leaves out balance_bot.urdf, so the robot's file would not be "
        "installed. Paths should be those inside the package's folder.",
    )


@packaging.check(4)
def registers_on_import(student: Student):
    files = student.call("package_files")
    (text,) = expect_fields(student.said, files, "balance_bot/__init__.py")
    said = "import balance_bot, with your __init__.py"
    numbers = rng_of(60).uniform(-9, 9, 7)
    answer = student.run(imported, text, numbers.tolist(), said=said)
    expect(
        not isinstance(answer, str),
        f"{said}: the entry point of {NAME} is {show(answer)}, but should be 'module:class', with "
        "the module env of the package balance_bot.",
    )
    expect(isinstance(answer, list) and len(answer) == 3, f"{said}: no answer came back.")
    steps, seen, early = answer
    expect(
        not early,
        f"{said}, loads balance_bot.env at once, but the class should be loaded only when "
        "somebody makes the environment: the entry point should be a text, and nothing should be "
        "imported from env.",
    )
    expect(
        steps == 500,
        f"{said}: episodes are cut after {steps} steps, but should be cut after 500."
        if steps
        else f"{said}: an episode of 1000 steps was not cut, but should be cut after 500.",
    )
    wanted = np.float32(np.resize(numbers, 501))
    expect_close(f"{said}: what a class in the module env observes", seen, wanted, 1e-6)


# ------------------------------------------------------------------ 10.9
evolving = exercise.task("10.9", "Evolve a controller", seconds=240, packages=BULLET)


def learnt(module, urdf, gyro, name, seed, most):
    """Calls evolve or train on the grader's own environment, for a robot of the grader's.

    gyro: a factor of the angular velocity that the robot observes; most: episodes after which
    evolving or training is broken off.

    Returns the answer (None if it was broken off), the first action of each episode, and the
    episodes' steps. For train also how often PPO has updated a policy, whether all layers of the
    answer are those that a policy had after such an update, and by how much the weights of the
    largest one differ on average from those before the first update.
    """
    import gymnasium
    import numpy
    import pybullet
    import pybullet_data

    with open("balance_bot.urdf", "w") as file:
        file.write(urdf)

    class BrokenOff(BaseException):
        pass

    actions, steps, names = [], [], []

    class GradersEnv(gymnasium.Env):
        metadata = {"render_modes": ["rgb_array"], "render_fps": 100}  # noqa: RUF012

        def __init__(self, render_mode=None):
            self.render_mode = render_mode
            self.world = pybullet.connect(pybullet.DIRECT)
            limits = numpy.array([numpy.pi, numpy.inf, 24.6], dtype=numpy.float32)
            self.observation_space = gymnasium.spaces.Box(-limits, limits)
            self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,))

        def look(self):
            place, orientation = pybullet.getBasePositionAndOrientation(self.body, self.world)
            turning = pybullet.getBaseVelocity(self.body, self.world)[1][0]
            seen = [pybullet.getEulerFromQuaternion(orientation)[0], gyro * turning, self.speed]
            return numpy.array(seen, dtype=numpy.float32), place[2]

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            if len(actions) >= most:
                raise BrokenOff
            self.begins = True
            lean = self.np_random.uniform(-0.3, 0.3)
            world = {"physicsClientId": self.world}
            pybullet.resetSimulation(**world)
            pybullet.setTimeStep(0.01, **world)
            pybullet.setGravity(0, 0, -10, **world)
            pybullet.loadURDF(pybullet_data.getDataPath() + "/plane.urdf", **world)
            self.body = pybullet.loadURDF(
                "balance_bot.urdf",
                [0, 0, 0.001],
                pybullet.getQuaternionFromEuler([lean, 0, 0]),
                flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
                **world,
            )
            self.speed = 0.0
            return self.look()[0], {}

        def step(self, action):
            if self.begins:
                actions.append(float(action[0]))
                steps.append(0)
            self.begins = False
            steps[-1] += 1
            self.speed += float(numpy.clip(action[0], -1, 1))
            self.speed = min(max(self.speed, -24.6), 24.6)
            pybullet.setJointMotorControlArray(
                self.body,
                [0, 1],
                pybullet.VELOCITY_CONTROL,
                targetVelocities=[self.speed, -self.speed],
                physicsClientId=self.world,
            )
            pybullet.stepSimulation(self.world)
            seen, height = self.look()
            return seen, 1 - 0.05 * abs(self.speed), height < 0.15, False, {}

    gymnasium.registry.pop("BalanceBotBulletEnv-v0", None)
    gymnasium.register(id="BalanceBotBulletEnv-v0", entry_point=GradersEnv, max_episode_steps=500)
    if name == "evolve":
        try:
            return [module.evolve(seed), actions, steps]
        except BrokenOff:
            return [None, actions, steps]

    from stable_baselines3 import PPO

    updates, before, learnt = PPO.train, [], []

    def tables(model):
        return [each.detach().numpy().copy() for each in model.policy.parameters()]

    def train(self):
        first = tables(self)
        names[:] = [name for name, _ in self.policy.named_parameters()]
        updates(self)
        learnt.append(tables(self))
        before.append(first if len(learnt) == 1 or self.num_timesteps <= self.n_steps else None)

    PPO.train = train
    try:
        answer = module.train(seed)
    except BrokenOff:
        return [None, actions, steps, 0, False, 0.0, [], False]
    finally:
        PPO.train = updates

    def places(part, after):
        same = [table.shape == part.shape and numpy.allclose(table, part, atol=1e-5)
                for table in after]  # fmt: skip
        return numpy.flatnonzero(same)

    layers = list(answer) if isinstance(answer, (list, tuple)) else []
    if not all(isinstance(layer, (list, tuple)) and len(layer) == 2 for layer in layers):
        return [answer, actions, steps, len(learnt), False, 0.0, [], False]
    critics = [
        number
        for number, (weights, _) in enumerate(layers)
        if any((at := places(numpy.array(weights), after)).size
               and all("value_net" in names[i] for i in at) for after in learnt)
    ]  # fmt: skip
    parts = sorted((numpy.array(part) for layer in answer for part in layer), key=numpy.size)
    same, change, start = False, 0.0, None
    begun = any(
        first is not None and all(places(part, first).size for part in parts) for first in before
    )
    for first, after in zip(before, learnt, strict=True):
        start = start if first is None else first
        if all(places(part, after).size for part in parts):
            at = places(parts[-1], after)
            same, change = True, max(change, *(float(abs(after[i] - start[i]).mean()) for i in at))
    return [answer, actions, steps, len(learnt), same, change, critics, begun]


def balanced(layers: list, robot: tuple[bool, int], index: int) -> list[int]:
    """Steps of 20 episodes of a network in the grader's simulation, until it falls."""
    steps = []
    turned, gyro = robot
    for inclination in rng_of(index).uniform(-0.3, 0.3, 20):
        with World(inclination, urdf=robot_text(turned)) as world:
            step = 0
            while step < 500 and world.height() >= 0.15:
                signal = np.array(world.seen()) * [1, gyro, 1]
                for weights, biases in layers[:-1]:
                    signal = np.tanh(weights @ signal + biases)
                world.act(float((layers[-1][0] @ signal + layers[-1][1])[0]))
                step += 1
            steps.append(step if world.height() >= 0.15 else step - 1)
    return steps


def expect_balance(said: str, layers: list, robot: tuple[bool, int], index: int, why) -> None:
    """Raise Wrong unless the robot balances; why: returns why it may not, or ""."""
    steps = balanced(layers, robot, index)
    good = sum(count == 500 for count in steps)
    if good < 20:
        raise Wrong(
            f"{said}, called for {NAMES[robot]}: the robot balances for 500 steps in {good} of 20 "
            f"new episodes (on average for {np.mean(steps):.0f} steps), but 20 of 20 are asked "
            f"for. {why()}".rstrip()
        )


NAMES = {
    (False, -1): "a robot whose gyroscope is mounted the other way round",
    (True, 1): "a robot whose wheels turn the other way",
}
FIRST = 12
"""So many episodes are looked at to tell whether a seed decides about a run."""


def learns(student: Student, name: str, seed: int, robot: tuple[bool, int], most: float) -> tuple:
    """What `learnt` reports of a robot: (wheels turn the other way, sign of its gyro)."""
    said, limit = f"{name}(seed={seed})", min(most, 1e9)
    report = student.run(learnt, robot_text(robot[0]), robot[1], name, seed, int(limit), said=said)
    expect(isinstance(report, list) and len(report) >= 3, f"{said}: no answer came back.")
    return said, report


def expect_seeded(student: Student, name: str, seed: int, robot: tuple, actions: list) -> None:
    """The same seed begins in the same way, another seed in another way."""
    for other in (seed, seed + 1):
        said, (_, again, *_) = learns(student, name, other, robot, FIRST)
        same = np.array_equal(again[:FIRST], actions[:FIRST])
        expect(
            same or other != seed,
            f"{said}, called twice, takes different first actions in the first {FIRST} episodes: "
            "either something random does not come from the seed, or something stays from call to "
            "call (a variable of the module, or an array that is changed in place).",
        )
        expect(
            not same or other == seed,
            f"{said} takes the same first actions as {name}(seed={seed}) in the first {FIRST} "
            "episodes, but another seed should give another controller.",
        )


def all_balanced(robot: tuple[bool, int], index: int, parameters: np.ndarray) -> bool:
    return min(balanced([(parameters[None, 1:], parameters[:1])], robot, index)) == 500


def evolves(student: Student, index: int, robot: tuple[bool, int]) -> np.ndarray:
    """The weights that were found. One seed in some dozens is unlucky: then another one decides."""
    for place in (index, index + 20):
        seed = exercise.seed(place) % 100_000
        said, (answer, actions, steps) = learns(student, "evolve", seed, robot, np.inf)
        parameters = expect_array(said, answer, (4,))
        layers, good = [(parameters[None, 1:], parameters[:1])], steps[:10].count(500)
        if good <= 6 and all(count == 500 for count in balanced(layers, robot, place + 1)):
            break
    else:
        balances = partial(all_balanced, robot, place + 1)
        why = partial(why_fallen, parameters, steps, balances)
        expect_balance(f"{said} (the last seed that was tried)", layers, robot, place + 1, why)
    expect(
        len(steps) >= 20 and good <= 6,
        f"{said}: the number of episodes is {len(steps)}, and in {good} of the first ten the robot "
        "balanced to the end. Evolution should begin with weights that know nothing of a robot, "
        "and find better ones: it should play at least 20 episodes, and in at most 6 of the first "
        "ten the robot should balance to the end.",
    )
    expect_seeded(student, "evolve", seed, robot, actions)
    return parameters


@evolving.check(8)
def balances_whichever_way_the_wheels_turn(student: Student):
    one, other = evolves(student, 70, (False, -1)), evolves(student, 72, (True, 1))
    expect(
        not np.allclose(abs(one), abs(other), rtol=0.03, atol=0.05),
        f"evolve found {show(one)} for one robot, and {show(other)} with another seed for another "
        "robot. These are nearly the same weights but for their signs, but evolution should begin "
        "with weights that know nothing of a robot.",
    )


# ----------------------------------------------------------------- 10.10
training = exercise.task("10.10", "Train a controller", seconds=300)


@training.check(8)
def balances_after_training(student: Student):
    """A training of one seed in some dozens is unlucky: then others decide."""
    robot = True, 1
    for index in (80, 83, 86):
        seed = exercise.seed(index) % 100_000
        said, layers, actions, why = trained(student, seed, robot)
        if all(count == 500 for count in balanced(layers, robot, index + 1)):
            break
    else:
        expect_balance(f"{said} (the last seed that was tried)", layers, robot, index + 1, why)
    expect_seeded(student, "train", seed, robot, actions)


def trained(student: Student, seed: int, robot: tuple[bool, int]) -> tuple:
    """The call in words, the layers that PPO has trained, the actions of the first episodes, and
    how the training went, in words.
    """
    said, report = learns(student, "train", seed, robot, np.inf)
    answer, actions, steps, updates, same, change, critics, begun = report
    expect(
        isinstance(answer, list) and 0 < len(answer) < 10,
        f"{said} returned {show(answer)}, but a list of 1 to 9 layers is needed.",
    )
    layers, inputs = [], 3
    for i, layer in enumerate(answer):
        expect(
            isinstance(layer, list) and len(layer) == 2 and np.ndim(layer[0]) == 2,
            f"{said}: layer {i} should be a list of weights (two dimensions) and biases.",
        )
        neurons = len(layer[0]) if i + 1 < len(answer) else 1
        weights = expect_array(
            f"{said}: the weight matrix of layer {i}", layer[0], (neurons, inputs)
        )
        layers.append(
            (weights, expect_array(f"{said}: the bias vector of layer {i}", layer[1], (neurons,)))
        )
        inputs = neurons
    expect(
        same is True or begun is False,
        f"{said}: the layers are those of the policy before PPO's first update, but should be "
        "those after the training.",
    )
    expect(
        same is True,
        f"{said}: the layers are not all those of a policy after one of PPO's updates (number of "
        f"updates: {show(updates)}), but the network that PPO has trained is asked for.",
    )
    expect(
        change > 1e-3,
        f"{said}: PPO changed the weights of the largest layer by {change:.2g} on average (number "
        f"of updates: {show(updates)}). That is too little to learn from: the training should "
        "find the controller.",
    )
    expect(
        not critics,
        f"{said}: layer {show(critics[:1])[1:-1]} is the critic's (value_net), but the network "
        "from observations to actions is asked for, as actor_layers takes it out.",
    )
    return said, layers, actions, partial(why_untrained, steps, int(updates))
