"""Grader of exercise 10; run it with `botschool grade 10`.

Tasks 10.1 to 10.8 compare with our solution. Each method of the environment is called in a world
that the grader has set up, beside another simulation, so that a forgotten physicsClientId shows.
Where PyBullet is not installed, botschool.course.stand_in answers the calls of both sides.

Stochastic checks (tasks 10.9 and 10.10): with one of three seeds, a controller balances the robot
for 500 steps in 20 of 20 unseen episodes. It learns on the robot's native twin, whose gyroscope or
wheels are turned round, so that no weights can be written down. With each of 20 seeds (1000 to
1019), the solution's `evolve` balances both robots in 20 of 20; so did the few trainings tried.
"""

from fnmatch import fnmatch
from functools import partial

import numpy as np

from botschool.course.robots import imported, random_robot, registered
from botschool.envs.native import NativeEnv
from botschool.grading import Exercise, Student, Wrong, expect, expect_array, same, seed_of, show
from botschool.grading.run.worlds import Record, Turned

LOADED = ("pybullet", "pybullet_data", "botschool.course")
exercise = Exercise(
    10,
    "A new environment",
    file="balancing_robot.py",
    imports=LOADED,
    extras=("pybullet", "rl"),
    packages=(),
)
once_more = partial(same, off=dict.fromkeys(("draw", "changes"), "the check before tries it"))


def between(rng, low, high, size=None):
    return (np.round(rng.uniform(low, high, size), 2) + 0.0).tolist()


# ------------------------------------------------------------------ 10.1


reading = exercise.task("10.1", "Read the robot")


def robots(rng):
    for origin in ("", '<origin xyz="0.1 -0.2 0.3"/>'):
        inside = f'{origin}<mass value="{between(rng, 0.5, 4)}"/>'
        yield f'<robot><link name="a"><inertial>{inside}</inertial></link></robot>'
    yield from (random_robot(rng, nlinks, nlinks % 2 == 0) for nlinks in (3, 4, 5, 6, 8, 7))


def described(answer, urdf):
    """The answer, and the names in it: there are no others."""
    return answer | {"the names of links": ", ".join(sorted(map(str, answer["links"])))}


@same(reading, 4, "describe", parts=("links", "the names of links", "mass"), view=described)
def links_and_their_masses(rng):
    yield from robots(rng)


same(reading, 4, "describe", parts=("joints",), name="joints_and_what_they_join")(robots)
same(reading, 4, "describe", 1e-6, parts=("centre",), name="centre_of_mass")(robots)

spaces = exercise.task("10.2", "The spaces")


GIVEN = "the text gives the spaces"


def space_of(module, name, mode):
    """{0} of BalanceBotEnv(render_mode={1})"""
    space = getattr(module.BalanceBotEnv(render_mode=mode), name)
    kind = f"{type(space).__name__} of {space.dtype}"
    return {"kind": kind, "low": space.low, "high": space.high}


@same(spaces, 4, space_of, 1e-6, fixed=GIVEN)
def what_it_observes(rng):
    yield from (("observation_space", mode) for mode in (None, "rgb_array"))


@same(spaces, 4, space_of, 1e-6, fixed=GIVEN)
def what_it_does(rng):
    yield from (("action_space", mode) for mode in (None, "rgb_array"))


# ----------------------------------------------------------------- stage
def on_stage(module, call, lean, others, speed, given, mode=None):
    """{0} {4}, inclination {1}, self.speed {3}"""
    from unittest import mock

    import numpy

    from botschool.course.bullet import pybullet, pybullet_data
    from botschool.course.robots import robot_file

    def world(client, angles):
        own = {"physicsClientId": client}
        pybullet.resetSimulation(**own)
        pybullet.setTimeStep(0.01, **own)
        pybullet.setGravity(0, 0, -10, **own)
        pybullet.loadURDF(f"{pybullet_data.getDataPath()}/plane.urdf", **own)
        file, turned = str(robot_file("balance_bot.urdf")), pybullet.getQuaternionFromEuler(angles)
        own["flags"] = pybullet.URDF_USE_INERTIA_FROM_FILE
        return pybullet.loadURDF(file, [0, 0, 0.001], turned, **own)

    def place():
        return pybullet.getBasePositionAndOrientation(env.robot, env.client)

    def seen():
        turning = pybullet.getBaseVelocity(env.robot, env.client)[1][0]
        return numpy.float32([pybullet.getEulerFromQuaternion(place()[1])[0], turning, env.speed])

    def turn(action):
        env.speed += float(numpy.clip(action[0], -1, 1))
        env.speed = min(max(env.speed, -24.6), 24.6)
        own = {"targetVelocities": [env.speed, -env.speed], "physicsClientId": env.client}
        pybullet.setJointMotorControlArray(env.robot, [0, 1], pybullet.VELOCITY_CONTROL, **own)

    def pass_time(steps):
        for _ in range(steps):
            pybullet.stepSimulation(env.client)

    def observe():
        first, env.speed = env.observe(), speed
        pybullet.resetBaseVelocity(env.robot, [0.3, -0.2, 0.4], given, physicsClientId=env.client)
        return {"the observation": env.observe(), "the one before": first}

    def reset():
        for seed in given:
            turn([1.0])
            pass_time(30)
            pybullet.setTimeStep(1 / 240, physicsClientId=env.client)
            pybullet.setGravity(0, 0, 0, physicsClientId=env.client)
            observation, info = env.reset(seed=seed)
        found = {"the observation": observation, "self.speed": env.speed, "the info": str(info)}
        found["the number of bodies"] = pybullet.getNumBodies(env.client)
        found["self.robot"] = env.robot
        pass_time(30)
        return found | {"30 steps later, the robot": numpy.array([*seen()[:2], *place()[0]])}

    def drive():
        speeds, wheels, actions = [], [], numpy.array(given, dtype=numpy.float32)[:, None]
        for action in actions:
            env.drive(action)
            pass_time(1)
            speeds.append(env.speed)
            wheels += [pybullet.getJointState(env.robot, i, env.client)[1] for i in (0, 1)]
        found = {"self.speed": speeds, "how fast the wheels turn": numpy.array(wheels)}
        return found | {"the actions, afterwards": actions}

    def step():
        env.render, rows = mock.Mock(), []
        for action in given:
            one = numpy.array([action], dtype=numpy.float32)
            observation, reward, terminated, truncated, info = env.step(one)
            rows.append([observation, reward, terminated, truncated, str(info)])
        names = "the observation", "the reward", "terminated", "truncated", "the info"
        found = dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))
        found["the reward is an array"] = [isinstance(each[1], numpy.ndarray) for each in rows]
        return found | {"calls of self.render": env.render.call_count}

    def fallen():
        at = [0.7, -0.9, given], place()[1]
        pybullet.resetBasePositionAndOrientation(env.robot, *at, env.client)
        return {"the answer": bool(env.fallen())}

    if not hasattr(pybullet, "clients"):  # the first needs no physicsClientId
        pybullet.clients = [pybullet.connect(pybullet.DIRECT) for _ in range(2)]
    beside, own = pybullet.clients
    other = world(beside, [0.2, -0.1, 0.3])
    pybullet.resetBaseVelocity(other, [0.3, -0.2, 0.1], [1.5, 0.7, -0.6], beside)
    with mock.patch.object(module, "connect", lambda mode: own, create=True):
        env = module.BalanceBotEnv()
    env.robot, env.speed, env.render_mode = world(env.client, [lean, *others]), speed, mode
    method = call.partition("(")[0]
    if method not in ("observe", "drive"):
        env.drive, env.observe = turn, seen
    found = {e.__name__: e for e in (observe, reset, drive, step, fallen)}[method]()
    return found | {"its type": str(numpy.asarray(found.get("the observation")).dtype)}


observing = exercise.task("10.3", "What the robot feels")


@same(observing, 8, on_stage, 1e-4)
def observes(rng):
    for lean in (0.6, -0.6, 3.0, 0.3, -0.3, -3.0):
        state = lean * between(rng, 0.5, 1), between(rng, -0.3, 0.3, 2), between(rng, -20, 20)
        yield "observe(), angular velocity", *state, between(rng, -3, 3, 3)


resetting = exercise.task("10.4", "A new world")


def resets(rng, *courses):
    for seeds in courses:
        yield "reset(), seeds", between(rng, -0.2, 0.2), [0.0, 0.0], 7.0, [*seeds]


@same(resetting, 4, on_stage, 1e-5, parts=("the observation", "its type"))
def begins_at_random(rng):
    one, two = seed_of(rng), seed_of(rng)
    yield from resets(rng, [0], [one], [two], [one, 0], [two, one, two])


@once_more(resetting, 4, on_stage, 1e-5, parts=("the observation", "self.speed", "the info"))
def goes_on_without_seed(rng):
    one, two = seed_of(rng), seed_of(rng)
    yield from resets(rng, [one, None], [0, None], [one, None, None], [two, 0, None])


WORLD = ("the number of bodies", "self.robot", "30 steps later, the robot")


@once_more(resetting, 4, on_stage, 1e-4, WORLD)
def makes_the_world(rng):
    yield from resets(rng, [seed_of(rng)], [seed_of(rng), None], [seed_of(rng), seed_of(rng)])


driving = exercise.task("10.5", "The motors")


def drives(speed, actions):
    return "drive(), actions", 0.1, [0.0, 0.0], speed, actions


@same(driving, 5, on_stage, 1e-4)
def speeds_up_and_slows_down(rng):
    yield drives(2.0, between(rng, -1, 1, 1))
    for speed in (0.0, 3.0, -5.0):
        yield drives(speed, [0.0, *between(rng, -1, 1, 5)])


@once_more(driving, 5, on_stage, 1e-4)
def stays_within_limits(rng):
    for speed in (0.0, 5.0):
        beyond = (rng.choice([-1, 1], 4) * between(rng, 2, 30, 4)).tolist()
        yield drives(speed, [*beyond[:2], 0.6, *beyond[2:]])
    for side in (-1, 1):
        yield drives(side * 23.5, [side * 0.9, side * 0.8, side * 0.4, -side * 0.7])
        yield drives(side * 24.0, [side * 0.7, side * 0.5, side * 1.5, -side * 0.9])


stepping = exercise.task("10.6", "Reward, end and step")


def steps(rng, *courses):
    """Courses: the side to which the body leans, a speed and a number of steps."""
    for side, speed, n in courses:
        lean = side * between(rng, 0.1, 0.3)
        yield "step(), actions", lean, [0.0, 0.0], speed, between(rng, -1, 1, n)


same(stepping, 4, on_stage, 1e-4, parts=("the observation", "the info"), name="moves_one_step")(
    steps, (1, 0.0, 1), (1, 0.0, 12), (-1, 3.0, 12), (1, -3.0, 12), (-1, 23.0, 6)
)


@once_more(stepping, 3, on_stage, 1e-5, parts=("the reward", "the reward is an array"))
def rewards(rng):
    yield from steps(rng, (1, 0.0, 1), (-1, 3.0, 6), (1, -3.0, 6), (-1, 23.0, 6), (1, 0.0, 110))


once_more(stepping, 2, on_stage, parts=("terminated", "truncated"), name="ends_when_fallen")(
    steps, (1, 0.0, 110), (-1, 3.0, 110), (1, -3.0, 110), (-1, 23.0, 6)
)


@once_more(stepping, 1, on_stage)
def falls_below_a_height(rng):
    for height in (0.15, 0.1499, 0.1501, between(rng, 0.02, 0.1), between(rng, 0.2, 0.4)):
        for lean in (0.0, 0.7, -1.7, -3.0):
            yield "fallen(), height", lean, [0.0, 0.0], 5.0, height


@once_more(stepping, 2, on_stage, parts=("calls of self.render",))
def draws_in_a_window_only(rng):
    for mode in (None, "rgb_array", "human"):
        yield from ((*each, mode) for each in steps(rng, (1, 0.0, 2), (1, 0.0, 4)))


once_more(stepping, 2, on_stage, parts=("truncated",), name="leaves_the_time_limit_to_gymnasium")(
    steps, (1, 0.0, 510)
)

METHODS = ("10.2", "10.3", "10.4", "10.5", "10.6")
registering = exercise.task("10.7", "A name for the environment", seconds=40, needs=METHODS)


@same(registering, 5, registered, 1e-3)
def ends_after_500_steps(rng):
    for _ in range(2):
        yield "an episode", seed_of(rng), rng.uniform(0.9, 1.1, 3) * [-10, -1, 0.0]


@same(registering, 3, registered, 1e-3)
def ends_when_it_falls(rng):
    for _ in range(2):
        yield "an episode", seed_of(rng), rng.uniform(0.1, 0.3, 3) * [1, 1, 0]


@same(registering, 4, registered, 1e-3)
def passes_gymnasiums_checker(rng):
    yield "check_env", seed_of(rng), rng.uniform(0.1, 0.3, 3) * [1, 1, 0]


packaging = exercise.task("10.8", "A package of its own")
NO_INPUTS = "the function has no arguments"


def project_of(files):
    """What pyproject.toml says."""
    try:
        import tomllib
    except ModuleNotFoundError:  # Python 3.10
        from pip._vendor import tomli as tomllib

    try:
        content = tomllib.loads(files["pyproject.toml"])
    except tomllib.TOMLDecodeError as error:
        raise Wrong(f"pyproject.toml is not valid TOML: {error}.") from None
    system, project, tool = (content[name] for name in ("build-system", "project", "tool"))
    needs, data = project["dependencies"], tool["setuptools"]["package-data"]
    expect(isinstance(data, dict), f"package-data should be a table, not {show(data)}.")
    patterns = data["balance_bot"] if isinstance(data["balance_bot"], list) else []
    found = {
        "setuptools in requires": any("setuptools" in each for each in system["requires"]),
        "build-backend": system["build-backend"],
        "name": str(project["name"]).replace("-", "_"),
        "version is a text": isinstance(project["version"], str) and project["version"] != "",
        "packages": tool["setuptools"]["packages"],
        "*.urdf in package-data": any(fnmatch("balance_bot.urdf", each) for each in patterns),
    }
    for name in ("gymnasium", "numpy", "pybullet"):
        found[f"{name} in dependencies"] = any(each.startswith(name) for each in needs)
    return found


@same(packaging, 4, "package_files", view=project_of, fixed=NO_INPUTS)
def says_what_it_needs(rng):
    yield ()


@same(packaging, 4, imported, fixed=NO_INPUTS)
def registers_on_import(rng):
    yield ()


# ------------------------------------------------------- 10.9 and 10.10

evolving = exercise.task("10.9", "Evolve a controller", seconds=240)

training = exercise.task("10.10", "Train a controller", seconds=300, packages=("rl",))
TWIN = "SpatialBalanceBot-v0"
GYROSCOPE, WHEELS = ([1, -1, 1], 1), ([1, 1, -1], -1)
"""Signs of what is observed, and the side of actions."""


def learnt(module, name, environment, robot, twin, seed, most):
    """Return what evolve or train returns, and each episode's first action."""
    from functools import partial

    from botschool.envs.native import NativeEnv
    from botschool.grading.run.worlds import turned

    answer = None
    with turned(environment, *robot, most, partial(NativeEnv, twin)) as seen:
        answer = getattr(module, name)(seed)
    return [answer, seen.actions]


def lasted(layers: list, robot: tuple, seed: int, episodes: int, most: int) -> list[int]:
    """Return how many steps some episodes last under a network of tanh layers, the last linear."""
    env, found = Turned(NativeEnv(TWIN), *robot, Record()), []
    for episode in range(episodes):
        (signal, _), step, ended = env.reset(seed=seed + episode), 0, False
        while step < most and not ended:
            for number, (weights, biases) in enumerate(layers):
                signal = weights @ (np.tanh(signal) if number else signal) + biases
            signal, _, ended, _, _ = env.step(signal)
            step += not ended
        found.append(step)
    return found


def expect_balance(student: Student, name: str, robot: tuple) -> np.ndarray:
    """With one of three seeds, the robot balances; and the seed decides. Returns the answer."""
    rng, good = np.random.default_rng(exercise.seed(f"{name} {robot[0]}")), []

    def learn(seed, most=10**9):
        given = "BalanceBotBulletEnv-v0", robot, TWIN, seed, most
        return student.run(learnt, name, *given, said=f"{name}(seed={seed})")

    while len(good) < 3 and 20 not in good:
        answer, actions = learn(seed := seed_of(rng))
        layers = answer
        if name == "evolve":
            parameters = expect_array(student.said, answer, (4,))
            layers = [(parameters[None, 1:], parameters[:1])]
        expect(layers is not None, f"{student.said} should return actor_layers(model).")
        good.append(lasted(layers, robot, seed_of(rng), 20, 500).count(500))
    part = "wheels turn" if robot is WHEELS else "gyroscope is mounted"
    said = f"{student.said} should balance a robot whose {part} the other way round in 20 of 20"
    expect(20 in good, f"{said} new episodes. With three seeds it does in {good}: {show(answer)}.")
    for other in (seed, seed + 1):
        alike = learn(other, most=12)[1] == actions[:12]
        how = "again, should act as before" if other == seed else "should act in another way"
        expect(alike == (other == seed), f"{student.said} after {name}(seed={seed}) {how}.")
    return answer


@evolving.check(8)
def balances_whichever_way_the_wheels_turn(student: Student):
    one, two = (expect_balance(student, "evolve", robot) for robot in (GYROSCOPE, WHEELS))
    said = f"evolve found {show(one)} for one robot, and {show(two)} for another one: the same but"
    alike = np.allclose(np.abs(one), np.abs(two), rtol=0.03, atol=0.05)
    expect(not alike, f"{said} for their signs. It should begin with weights that know no robot.")


@training.check(8)
def balances_after_training(student: Student):
    expect_balance(student, "train", WHEELS)
