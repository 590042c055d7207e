"""Grader of exercise 1; run it with `make test-ex1`.

Stochastic check (task 1.5): a mean of at least 195 steps over 20 unseen episodes of at most 200
(grading seed 40). The solution reaches 200.0 in each of 20 such sets of 20 episodes, so its margin
is 5 steps. A rule that looks at the angle's speed alone reaches 172 to 190, at the angle alone 40
to 46, random actions 22. Everything else is recomputed exactly.
"""

import warnings

import gymnasium
import numpy as np

from botschool.errors import listed
from botschool.grading import (
    Exercise,
    Mismatch,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_ends,
    expect_fields,
    show,
    went_on,
)

exercise = Exercise(1, "Gymnasium", file="gymnasium_basics.py")
CLASSIC = "gymnasium.envs.classic_control"


# ------------------------------------------------------------------- 1.1
description = exercise.task("1.1", "What an agent sees and does")


def probe(module, observed, acted, maxsteps):
    """Describes an environment that no student has met: spaces as drawn by the grader."""
    import gymnasium
    import numpy

    def space_of(plain):
        if "choices" in plain:
            return gymnasium.spaces.Discrete(plain["choices"], start=plain["first"])
        low, high = (numpy.array(plain[side], dtype=numpy.float32) for side in ("low", "high"))
        return gymnasium.spaces.Box(low, high)

    class Probe(gymnasium.Env):
        observation_space, action_space = space_of(observed), space_of(acted)

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            return self.observation_space.sample(), {}

        def step(self, action):
            return self.observation_space.sample(), 0.0, False, False, {}

    name = f"Probe{len(gymnasium.registry)}-v0"
    gymnasium.register(
        name, entry_point=Probe, max_episode_steps=maxsteps, disable_env_checker=True
    )
    return module.describe(name)


def why_limits(got: np.ndarray, wanted: np.ndarray, high: np.ndarray) -> str:
    """What is wrong with limits; high: those of the other side."""
    if np.allclose(got, -high):
        return "\n  These are minus the other limits, but each number has two limits of its own."
    exact = wanted.astype(np.float64)
    if any(np.array_equal(got, np.round(exact, places)) for places in range(5)):
        return "\n  These are rounded limits, but they should be given as they are."
    return ""


def expect_space(said: str, got: object, space: gymnasium.Space) -> None:
    if isinstance(space, gymnasium.spaces.Discrete):
        kind, choices, first = expect_fields(said, got, "kind", "choices", "first")
        expect(kind == "Discrete", f"{said}: kind is {show(kind)}, but should be 'Discrete'.")
        mistakes = {
            "The first choice is subtracted from the number of choices, but space.n is asked "
            "for.": space.n - space.start,
            "This is the number of the last choice, but how many choices there are is asked "
            "for.": space.n + space.start - 1,
        }
        expect_close(f'{said}: "choices" of {space}', choices, space.n, mistakes=mistakes)
        expect_close(f'{said}: "first" of {space}', first, space.start)
        return
    kind, size, low, high = expect_fields(said, got, "kind", "size", "low", "high")
    expect(kind == "Box", f"{said}: kind is {show(kind)}, but should be 'Box'.")
    expect_close(f"{said}: size", size, space.low.size)
    for name, bounds, wanted in (("low", low, space.low), ("high", high, space.high)):
        expect(
            isinstance(bounds, list) and len(bounds) == wanted.size,
            f"{said}: {name} is {show(bounds)}, but should be a flat list of {wanted.size} "
            f"number{'s' * (wanted.size > 1)}.",
        )
        fit = all(type(bound) in (int, float) for bound in bounds)
        if not fit or not np.allclose(bounds, wanted.ravel(), rtol=1e-6, atol=0):
            opposite = (space.high if name == "low" else space.low).ravel()
            why = why_limits(np.array(bounds), wanted.ravel(), opposite) if fit else ""
            raise Wrong(
                f"{said}: {name} is {show(bounds)}, but {show(wanted.ravel().tolist())} was "
                f"expected.{why}"
            )


def probed(student: Student, index: int):
    """The student's description of random spaces, these spaces, and their time limit."""
    rng = np.random.default_rng(exercise.seed(index))
    size, choices, first = (int(rng.integers(2, 9)) for _ in range(3))
    low, high = rng.normal(size=size) - 5, rng.normal(size=size) + 5
    low[0], high[1] = -np.inf, np.inf
    box = {"low": low.tolist(), "high": high.tolist()}
    discrete = {"choices": choices, "first": first}
    maxsteps = int(rng.integers(50, 5000)) if index % 2 else None
    observed, acted = (box, discrete) if index % 2 else (discrete, box)
    said = "describe(environment_id) of an environment that the grader made up"
    answer = student.run(probe, observed, acted, maxsteps, said=said)
    spaces = [
        gymnasium.spaces.Box(low.astype(np.float32), high.astype(np.float32)),
        gymnasium.spaces.Discrete(choices, start=first),
    ]
    return answer, spaces if index % 2 else spaces[::-1], maxsteps


def expect_spaces(student: Student, which: str) -> None:
    """The student's description of one side, of environments known and unknown."""
    for name in ("CartPole-v1", "Pendulum-v1", "Acrobot-v1", "MountainCarContinuous-v0"):
        answer = student.call("describe", name)
        (got,) = expect_fields(student.said, answer, which)
        with gymnasium.make(name) as env:
            expect_space(f"{student.said}: {which}", got, getattr(env, f"{which}_space"))
    for index in (1, 2):
        answer, spaces, _ = probed(student, index)
        (got,) = expect_fields(student.said, answer, which)
        expect_space(f"{student.said}: {which}", got, spaces[which == "action"])


@description.check(6)
def observations(student: Student):
    expect_spaces(student, "observation")


@description.check(6)
def actions(student: Student):
    expect_spaces(student, "action")


@description.check(3)
def time_limit(student: Student):
    for name in ("CartPole-v1", "Acrobot-v1"):
        answer = student.call("describe", name)
        (maxsteps,) = expect_fields(student.said, answer, "maxsteps")
        expect_close(f"{student.said}: maxsteps", maxsteps, gymnasium.spec(name).max_episode_steps)
    for index in (3, 4):
        answer, _, wanted = probed(student, index)
        (maxsteps,) = expect_fields(student.said, answer, "maxsteps")
        expect(
            type(maxsteps) in (int, type(None)) and maxsteps == wanted,
            f"{student.said}: maxsteps is {show(maxsteps)}, but "
            f"{'the int ' if wanted else ''}{wanted} was expected"
            f"{'.' if wanted else ', as this environment has no time limit.'}",
        )


# ------------------------------------------------------------------- 1.2
episode = exercise.task("1.2", "A random episode")
CASES = (
    ("CartPole-v1", 1000),
    ("Pendulum-v1", 1000),
    ("MountainCarContinuous-v0", 40),
    ("Acrobot-v1", 60),
    ("CartPole-v1", 4),
    ("Pendulum-v1", 200),
    ("CartPole-v1", 1000),
)
"""Environment and maxsteps: ended by itself, its time limit, three times maxsteps, and by both."""
ZERO = 6
"""The case whose seed is 0."""
KEYS = ("observations", "actions", "rewards", "terminated", "truncated")


def lived(name: str, seed: int, maxsteps: int) -> dict:
    """The random episode as task 1.2 defines it."""
    with gymnasium.make(name) as env:
        observation, _ = env.reset(seed=seed)
        env.action_space.seed(seed)
        observations, actions, rewards, ends = [observation], [], [], [False, False]
        while len(actions) < maxsteps and not any(ends):
            actions.append(env.action_space.sample())
            observation, reward, *ends, _ = env.step(actions[-1])
            observations.append(observation)
            rewards.append(float(reward))
    values = np.array(observations), np.array(actions), rewards, *map(bool, ends)
    return dict(zip(KEYS, values, strict=True))


def belongs(action: np.ndarray, space: gymnasium.Space) -> bool:
    """Whether a space has this action; it comes as float64."""
    if isinstance(space, gymnasium.spaces.Discrete):
        return float(action).is_integer() and space.start <= action < space.start + space.n
    return bool(np.all((space.low <= action) & (action <= space.high)))


def seed_of(case: int) -> int:
    return 0 if case == ZERO else exercise.seed(10 + case)


def expect_same_start(said: str, reported: object, start: np.ndarray) -> None:
    """If the first observation is another one, the episode is another one, too."""
    try:
        first = np.asarray(reported, dtype=float)[0]
    except (ValueError, TypeError, IndexError):
        return
    expect(
        first.shape != start.shape or np.allclose(first, start, rtol=1e-4, atol=1e-4),
        f"{said}: the first observation is {show(first)}, but env.reset(seed=seed) gives "
        f"{show(start)}.",
    )


def met_the_end(reported: object, many: int, end: np.ndarray, step: int) -> bool:
    """Whether the report of many actions has the end of the episode after so many steps."""
    try:
        place = step - (len(reported) == many)  # the observation of the reset is missing
        there = np.asarray(reported, dtype=float)[place]
    except (ValueError, TypeError, IndexError):
        return False
    return there.shape == end.shape and np.allclose(there, end, rtol=1e-4, atol=1e-4)


def told(student: Student, case: int) -> tuple[dict, np.ndarray, dict]:
    """What the student reports, the actions in it, and the same actions in a fresh environment."""
    name, maxsteps = CASES[case]
    seed = seed_of(case)
    report = student.call("random_episode", name, seed=seed, maxsteps=maxsteps)
    reported, actions, *_ = expect_fields(student.said, report, *KEYS)
    fit = isinstance(actions, (list, np.ndarray))
    many = f"{len(actions)} actions" if fit and len(actions) > maxsteps else show(actions)
    expect(
        fit and 0 < len(actions) <= maxsteps,
        f"{student.said}: actions should be a list of 1 to {maxsteps} actions, not {many}.",
    )
    with gymnasium.make(name) as env:
        observations, rewards, ends = [env.reset(seed=seed)[0]], [], [False, False]
        actions = np.array(
            [
                expect_array(f"{student.said}: actions: [{index}]", action, env.action_space.shape)
                for index, action in enumerate(actions)
            ]
        )
        for step, action in enumerate(actions):
            if any(ends):
                many = len(actions)
                if isinstance(reported, (list, np.ndarray)) and len(reported) == many + 1:
                    expect_same_start(student.said, reported, observations[0])
                went = met_the_end(reported, many, observations[-1], step)
                raise Wrong(
                    f"{student.said} reports {many} actions, but with these actions the episode "
                    f"of this seed is over after {step} steps.\n  "
                    f"{went_on(*ends) if went else ''}".rstrip()
                )
            expect(
                belongs(action, env.action_space),
                f"{student.said}: {show(action)} is not an action of {name}.",
            )
            fitting = env.action_space.dtype.type(action)
            observation, reward, *ends, _ = env.step(fitting)
            observations.append(observation)
            rewards.append(float(reward))
    values = np.array(observations), actions, rewards, *map(bool, ends)
    return report, actions, dict(zip(KEYS, values, strict=True))


@episode.check(8)
def observations_and_rewards_follow_from_the_actions(student: Student):
    for case in (0, 1, 2, ZERO):
        report, actions, replay = told(student, case)
        expect(
            len(actions) > 3,
            f"{student.said} has only {len(actions)} action{'s' * (len(actions) > 1)}, but the "
            "episode is longer.",
        )
        before = replay["observations"][[0, *range(len(actions))]]
        for key, mistakes in (
            (
                "observations",
                {
                    "The observation from before each step is kept, but the one after it is asked "
                    "for.": before
                },
            ),
            ("rewards", {}),
        ):
            expect_close(
                f"{student.said}: {key} (compared with a replay of its actions)",
                report[key], replay[key], 1e-6, mistakes,
            )  # fmt: skip


@episode.check(6)
def every_action_is_drawn_from_the_seeded_space(student: Student):
    for case in (1, 3, 2, ZERO):
        name, maxsteps = CASES[case]
        _, actions, _ = told(student, case)
        wanted = lived(name, seed_of(case), maxsteps)["actions"]
        together = min(len(actions), len(wanted), 30)
        expect(
            together > 3,
            f"{student.said} has only {len(actions)} action{'s' * (len(actions) > 1)}, but the "
            "episode is longer.",
        )
        expect(
            np.array_equal(actions[:together], wanted[:together]),
            f"{student.said}: the actions are not those that env.action_space.sample() gives "
            "step by step after a single env.action_space.seed(seed)."
            f"{' 0 is a seed like any other.' * (case == ZERO)}",
        )


@episode.check(4)
def goes_on_to_the_end(student: Student):
    for case in range(len(CASES)):
        ends_of(student, case)


def ended_twice(module, steps, seed):
    """The student's report of an episode whose task and time are over in the same step."""
    import gymnasium
    import numpy

    class Short(gymnasium.Env):
        observation_space = gymnasium.spaces.Box(-1, 1, (1,))
        action_space = gymnasium.spaces.Discrete(2)

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.left = steps
            return numpy.zeros(1, dtype=numpy.float32), {}

        def step(self, action):
            self.left -= 1
            return numpy.zeros(1, dtype=numpy.float32), 0.5, self.left <= 0, False, {}

    name = f"Short{len(gymnasium.registry)}-v0"
    gymnasium.register(name, entry_point=Short, max_episode_steps=steps, disable_env_checker=True)
    return module.random_episode(name, seed, 1000)


def ends_of(student: Student, case: int) -> tuple[tuple, tuple, int]:
    """The two ends that the student reports, those of a fresh environment, and the steps."""
    report, actions, replay = told(student, case)
    name, maxsteps = CASES[case]
    expect(
        replay["terminated"] or replay["truncated"] or len(actions) == maxsteps,
        f"{student.said} stops after {len(actions)} step{'s' * (len(actions) > 1)}, but {name}, "
        "reset with this seed, is not over after these actions.",
    )
    got, ends = ((each["terminated"], each["truncated"]) for each in (report, replay))
    return got, ends, len(actions)


def mixed_up_always(student: Student, case: int) -> bool:
    """Whether the ends of all episodes are exchanged, or are one, if they are in this one."""
    got, ends, _ = ends_of(student, case)
    for rule in (lambda two: two[::-1], lambda two: (any(two),) * 2):
        if got == rule(ends):
            found = [ends_of(student, each)[:2] for each in range(len(CASES))]
            ends_of(student, case)  # so that this is the last call again
            return all(one == rule(right) for one, right in found)
    return True


@episode.check(7)
def tells_the_two_ends_apart(student: Student):
    for case, (name, _) in enumerate(CASES):
        got, ends, many = ends_of(student, case)
        why = f"in the last of its {many} steps {name} said"
        if got == ends or mixed_up_always(student, case):
            expect_ends(student.said, got, ends, why)
        for key, value, right in zip(("terminated", "truncated"), got, ends, strict=True):
            expect(value is right, f"{student.said}: {key} is {show(value)}, but {why} {right}.")

    said = "random_episode(an environment whose task and time limit both end in step 7, ...)"
    report = student.run(ended_twice, 7, seed_of(0), said=said)
    _, actions, _, *told_ends = expect_fields(said, report, *KEYS)
    expect_close(f"{said}: the number of actions", len(actions), 7)
    expect_ends(said, tuple(told_ends), (True, True), "in its last step the environment said")


# ------------------------------------------------------------------- 1.3
cartpole = exercise.task(
    "1.3",
    "The reward of CartPole",
    refused=tuple(f"{CLASSIC}.cartpole:CartPole{kind}Env.step" for kind in ("", "Vector")),
)


def answers(module, name, observations, actions):
    """The student's answer to each of many observations (and actions)."""
    function = getattr(module, name)
    if actions is None:
        return [function(observation) for observation in observations]
    return [function(*pair) for pair in zip(observations, actions, strict=True)]


def single_numbers(said: str, values: object, count: int) -> np.ndarray:
    """One plain number for each question."""
    expect(isinstance(values, list) and len(values) == count, f"{said} gave no answers.")
    for value in values:
        if not isinstance(value, (bool, int, float)):
            raise Wrong(f"{said} returned {show(value)}, but a single number is needed.")
    return expect_array(said, values, (count,))


def truth_values(said: str, values: object, count: int) -> np.ndarray:
    """True or False, or 1 or 0, for each question."""
    for value in single_numbers(said, values, count):
        expect(value in (0, 1), f"{said} returned {value:g}, but True or False is needed.")
    return np.array(values, dtype=bool)


def cartpole_steps(index: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Observations before steps, actions, rewards and the state's end, beyond the fall too."""
    rng = np.random.default_rng(exercise.seed(index))
    env = gymnasium.make("CartPole-v1").unwrapped
    steps = []
    for side in (0, -1, 1, 0, -1, 1):
        env.reset(seed=int(rng.integers(2**31)))
        env.state = (
            env.state + np.array([2.3, 1.0, 0.0, 0.0]) * side
        )  # leaves by the side, or falls
        observation = env.state.astype(np.float32)
        over, beyond, right = False, 0, rng.uniform(0.1, 0.9)
        while beyond < 8:
            action = int(rng.random() < right)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of steps beyond the end, which are wanted here
                following, reward, terminated, _, _ = env.step(action)
            if over and not terminated:
                break  # back again: Gymnasium pays for this step, and not for a second fall
            steps.append((observation, action, reward, over))
            observation, over = following, terminated
            beyond += over
    return tuple(map(np.array, zip(*steps, strict=True)))


@cartpole.check(5)
def knows_when_gymnasium_terminates(student: Student):
    observations, _, _, over = cartpole_steps(20)
    got = student.run(answers, "fallen", observations, None, said="fallen(observation)")
    got = truth_values(student.said, got, len(over))
    for observation, value, wanted in zip(observations, got, over, strict=True):
        expect(
            value == wanted,
            f"fallen({show(observation)}) returned {value}, but Gymnasium says {wanted}.",
        )


@cartpole.check(3)
def knows_both_limits(student: Student):
    rng = np.random.default_rng(exercise.seed(21))
    observations = rng.uniform((-2.3, -3, -0.2, -3), (2.3, 3, 0.2, 3), size=(40, 4))
    wanted = np.arange(40) % 2 == 1
    for i, observation in enumerate(observations):
        entry, limit = ((0, 2.4), (2, np.deg2rad(12)))[i // 2 % 2]
        size = limit * rng.uniform(1.005, 1.1) if wanted[i] else limit * rng.uniform(0.97, 0.995)
        observation[entry] = size * (1 if i % 8 < 4 else -1)
    got = student.run(answers, "fallen", observations, None, said="fallen(observation)")
    got = truth_values(student.said, got, len(wanted))
    for observation, value, over in zip(observations, got, wanted, strict=True):
        expect(
            value == over,
            f"fallen({show(observation)}) returned {value}, but {bool(over)} is right: the cart is "
            f"{abs(observation[0]):.3g} metres from the middle (the limit is 2.4), and the pole "
            f"leans {abs(observation[2]):.4g} radians (12 degrees are 0.2094).",
        )

    sides = rng.choice([-1.0, 1.0], size=8)
    observations = np.zeros((8, 4))
    observations[:4, 0] = sides[:4] * 2.4 * [0.9999, 1.0001, 0.99995, 1.00005]
    # Gymnasium's documentation rounds the angle to 0.2095, and others to 0.2094: both may stand
    observations[4:, 2] = sides[4:] * np.deg2rad(12) * [0.9995, 1.0005, 0.9997, 1.0004]
    got = student.run(answers, "fallen", observations, None, said="fallen(observation)")
    got = truth_values(student.said, got, len(observations))
    for i, (observation, value) in enumerate(zip(observations, got, strict=True)):
        over = "above" if i % 2 else "below"
        measure = f"{abs(observation[0]):.5f} metres, just {over} 2.4"
        if i >= 4:
            measure = f"{np.rad2deg(abs(observation[2])):.4f} degrees, just {over} 12"
        expect(
            value == (over == "above"),
            f"fallen({observation.tolist()}) returned {value}, but this is {measure}. The limits "
            "should be exactly 2.4 metres and 12 degrees (0.20944 radians), without rounding.",
        )

    for position, wanted in ((2.4, False), (-2.4, False), (np.nextafter(2.4, 3), True)):
        observation = [float(position), 0.5, 0.0, 0.0]
        got = student.run(answers, "fallen", np.array([observation]), None, said="fallen(...)")
        (value,) = truth_values(f"fallen({observation})", got, 1)
        why = "this is slightly more" if wanted else "exactly 2.4 is still allowed"
        expect(
            value == wanted,
            f"fallen({observation}) returned {value}, but {wanted} is right. It should be True as "
            f"soon as the cart is more than 2.4 metres away: {why}.",
        )
    for angle in (np.pi * 12 / 180, -np.pi * 12 / 180):
        observation = [0.5, 0.5, float(angle), 0.0]
        got = student.run(answers, "fallen", np.array([observation]), None, said="fallen(...)")
        (value,) = truth_values(f"fallen({observation})", got, 1)
        expect(
            not value,
            f"fallen({observation}) returned True, but this is 12 degrees: the pole should count "
            "as fallen only when it leans more than that.",
        )


@cartpole.check(6)
def gives_the_rewards_of_gymnasium(student: Student):
    observations, actions, rewards, over = cartpole_steps(22)
    got = student.run(
        answers, "cartpole_reward", observations, actions, said="cartpole_reward(observation, ...)"
    )
    got = single_numbers(student.said, got, len(rewards))
    falls = np.append(over[1:], False) & ~over
    mistakes = {
        "A step in which the pole falls or the cart leaves gives 0, but what should count is the "
        "state in which a step begins.": np.where(falls, 0.0, rewards),
    }
    for observation, value, wanted in zip(observations, got, rewards, strict=True):
        if abs(value - wanted) >= 1e-6:
            raise Mismatch(
                f"cartpole_reward({show(observation)}, ...) returned {value:g}, but Gymnasium gave "
                f"{wanted:g} for a step that began with this observation.",
                got, rewards, mistakes,
            )  # fmt: skip
    near = [[2.4, 0, 0, 0], [-2.4, 0, 0, 0], [2.4001, 0, 0, 0], [0, 0, -0.20955, 0], [-3, 0, 0, 0]]
    for observation, wanted in zip(near, (1, 1, 0, 0, 0), strict=True):
        said = f"cartpole_reward({observation}, 1)"
        got = student.run(answers, "cartpole_reward", np.array([observation]), [1], said=said)
        (value,) = single_numbers(said, got, 1)
        expect(
            abs(value - wanted) < 1e-6,
            f"{said} returned {value:g}, but {wanted} was expected: the reward should be 1 until "
            "the cart is more than 2.4 metres away or the pole leans more than 12 degrees.",
        )


# ------------------------------------------------------------------- 1.4
pendulum = exercise.task(
    "1.4", "The reward of Pendulum", refused=(f"{CLASSIC}.pendulum:PendulumEnv.step",)
)


def expect_rewards(student: Student, index: int, torque) -> None:
    """Compares with transitions of Gymnasium; torque(rng) is the action of a step."""
    rng = np.random.default_rng(exercise.seed(index))
    env = gymnasium.make("Pendulum-v1").unwrapped
    steps = []
    for _ in range(12):
        env.reset(seed=int(rng.integers(2**31)))
        angle, speed = env.state = rng.uniform((-9, -7), (9, 7))
        observation = np.array([np.cos(angle), np.sin(angle), speed], dtype=np.float32)
        for _ in range(10):
            action = np.array([torque(rng)], dtype=np.float32)
            following, reward, *_ = env.step(action)
            if abs(observation[1]) > 1e-3:  # else the arc cosine of a float32 may be far off
                steps.append((observation, action, float(reward)))
            observation = following
    observations, actions, rewards = map(np.array, zip(*steps, strict=True))
    got = student.run(
        answers, "pendulum_reward", observations, actions, said="pendulum_reward(observation, ...)"
    )
    got = single_numbers(student.said, got, len(rewards))
    cosine, sine, speed = np.asarray(observations, dtype=np.float64).T
    torque = np.asarray(actions, dtype=np.float64).ravel()

    def reward_of(angle, torque=torque, speed=speed):
        return np.round(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2), 4)

    angle, given = np.arctan2(sine, cosine), torque.clip(-2, 2)
    faster = (speed + 0.05 * (15 * sine + 3 * given)).clip(-8, 8)
    # the torque that the student's cost has, if angle and speed are right
    used = np.sqrt(np.maximum(0, -(got + angle**2 + 0.1 * speed**2)) / 0.001)
    limit = used.max()
    mistakes = {
        "The angle is always between -90 and 90 degrees, as arcsin or arctan(sine / cosine) give "
        "it, but the whole circle counts: see np.arctan2.": reward_of(
            np.arctan(sine / cosine), given
        ),
        "The angle counts from 0 to 2 pi, but it should lie between -pi and pi.": reward_of(
            np.arctan2(sine, cosine) % (2 * np.pi), torque.clip(-2, 2)
        ),
        "The torque is not cut to the range from -2 to 2, but it should be.": reward_of(
            np.arctan2(sine, cosine)
        ),
        "These torques cost nothing, but each should be cut and then cost 0.001 times its "
        "square.": reward_of(np.arctan2(sine, cosine), 0.0),
        "The torque is not squared"
        f"{', or its square is cut' * bool(np.abs(torque).max() > 2)}, but it should be cut first "
        "and then squared.": (
            reward_of(np.arctan2(sine, cosine), np.sqrt(np.abs(torque.clip(-2, 2))))
        ),
        "The torque is cut to the range from -1 to 1 and then doubled, but it should only be cut, "
        "to the range from -2 to 2.": (reward_of(angle, 2 * torque.clip(-1, 1))),
        "The speed of the angle is left out, but it should count.": reward_of(
            np.arctan2(sine, cosine), torque.clip(-2, 2), 0.0
        ),
        "The speed is the one at the end of the step, but the speed at its beginning "
        "counts.": reward_of(angle, given, faster),
        "Angle and speed are those at the end of the step, but those at its beginning count.": (
            reward_of((angle + 0.05 * faster + np.pi) % (2 * np.pi) - np.pi, given, faster)
        ),
    }
    small = np.abs(torque) < 1  # without them, a limit and a factor of the torque look alike
    if small.any() and 0.05 < limit < np.abs(torque).max() - 0.05:
        mistakes[
            f"The torque is cut to the range from -{limit:.3g} to {limit:.3g}, but the limits "
            "should be -2 and 2."
        ] = reward_of(angle, torque.clip(-limit, limit))
    if small.any():
        squares = np.stack([angle, speed, given], axis=1) ** 2
        factors = np.linalg.lstsq(squares, -got, rcond=None)[0]
        parts = zip(("angle", "speed", "torque"), factors, (1, 0.1, 0.001), strict=True)
        wrong = [
            f"{factor:.3g} times the square of the {name} (should be {right:g} times)"
            for name, factor, right in parts
            if abs(factor - right) > 1e-3 * right and (name != "torque" or given.any())
        ]
        mistakes[f"Your cost has {' and '.join(wrong)}."] = np.round(-squares @ factors, 4)
    for observation, action, value, wanted in zip(observations, actions, got, rewards, strict=True):
        if abs(value - wanted) >= 1e-4 * (1 + abs(wanted)):
            raise Mismatch(
                f"pendulum_reward({show(observation)}, {show(action)}) returned {value:.5f}, but "
                f"Gymnasium gave {wanted:.5f} for a step with this observation and action.",
                np.round(got, 4), np.round(rewards, 4), mistakes,
            )  # fmt: skip


@pendulum.check(6)
def knows_angle_and_speed(student: Student):
    expect_rewards(student, 30, lambda rng: 0.0)
    observations = np.array([[-1.0, 0.0, 0.5], [0.0, 1.0, -2.0], [0.0, -1.0, 3.0], [1.0, 0.0, 1.0]])
    got = student.run(
        answers, "pendulum_reward", observations, np.zeros((4, 1)), said="pendulum_reward(...)"
    )
    quarters = np.array([2, 1, 1, 0])  # of pi, from upright: hanging, level, level, upright
    wanted = -((quarters * np.pi / 2) ** 2) - 0.1 * observations[:, 2] ** 2
    names = ("hangs straight down", "is level", "is level", "is upright")
    for observation, value, right, name in zip(
        observations, single_numbers(student.said, got, 4), wanted, names, strict=True
    ):
        said = f"pendulum_reward({show(observation)}, [0.]), where the rod {name},"
        expect_close(said, value, right, 1e-6)


@pendulum.check(4)
def knows_the_torque(student: Student):
    expect_rewards(student, 31, lambda rng: rng.uniform(-2, 2))


@pendulum.check(4)
def cuts_the_torque(student: Student):
    expect_rewards(student, 32, lambda rng: rng.choice([-1, 1]) * rng.uniform(5, 40))
    expect_rewards(student, 33, lambda rng: rng.choice([-1, 1]) * rng.uniform(2.1, 3))


# ------------------------------------------------------------------- 1.5
balancing = exercise.task("1.5", "Balance the pole")
EPISODES, STEPS = 20, 200


def actions_for(student: Student, observations: np.ndarray) -> list[int]:
    """The student's action for each observation."""
    got = student.run(answers, "balance", observations, None, said="balance(observation)")
    got = single_numbers(student.said, got, len(observations))
    for value in got:
        expect(value in (0, 1), f"{student.said} returned {value:g}, but 0 or 1 is needed.")
    return [int(value) for value in got]


def mean_steps(student: Student) -> float:
    """Mean length of 20 episodes that the student's process never sees, only its observations."""
    envs = [gymnasium.make("CartPole-v1").unwrapped for _ in range(EPISODES)]
    starts = np.random.default_rng(exercise.seed(40)).integers(2**31, size=EPISODES)
    observations = [env.reset(seed=int(seed))[0] for env, seed in zip(envs, starts, strict=True)]
    steps, up = np.zeros(EPISODES), list(range(EPISODES))
    for _ in range(STEPS):
        actions = actions_for(student, np.array([observations[i] for i in up]))
        standing = []
        for i, action in zip(up, actions, strict=True):
            observations[i], _, terminated, _, _ = envs[i].step(action)
            steps[i] += 1
            if not terminated:
                standing.append(i)
        up = standing
        if not up:
            break
    return float(steps.mean())


def expect_no_memory(student: Student) -> None:
    """The same actions whatever was observed before."""
    rng = np.random.default_rng(exercise.seed(42))
    observations = rng.normal(size=(200, 4)) * (1, 1, 0.05, 0.3)
    forwards = actions_for(student, observations)
    backwards = actions_for(student, observations[::-1])[::-1]
    for observation, one, other in zip(observations, forwards, backwards, strict=True):
        expect(
            one == other,
            f"balance({show(observation)}) returned {one} at first, and {other} when it was called "
            "again: the action must depend on the observation alone, without memory or chance.",
        )


@balancing.check(4)
def pushes_to_where_the_pole_falls(student: Student):
    expect_no_memory(student)
    rng = np.random.default_rng(exercise.seed(41))
    sides = rng.permutation([0, 1] * 10)
    observations = np.zeros((20, 4), dtype=np.float32)
    observations[:, 2:] = rng.uniform(0.1, 0.2, size=(20, 2)) * [1, 5] * (2 * sides - 1)[:, None]
    for observation, action, side in zip(
        observations, actions_for(student, observations), sides, strict=True
    ):
        expect(
            action == side,
            f"balance({show(observation)}) returned {action}, but the pole falls to the "
            f"{('left', 'right')[side]}, so the cart should be pushed there, with action {side}.",
        )


def looked_at(student: Student) -> str:
    """Which numbers of the observation change the student's action."""
    rng = np.random.default_rng(exercise.seed(43))
    observations, others = rng.normal(size=(2, 2000, 4)) * (1, 1, 0.05, 0.3)
    actions, found, shares = actions_for(student, observations), [], []
    names = ("the cart's position", "the cart's speed", "the angle", "the angle's speed")
    for number, name in enumerate(names):
        changed = observations.copy()
        changed[:, number] = others[:, number]
        share = np.mean(np.not_equal(actions_for(student, changed), actions))
        if share:
            found.append(f"{name} ([{number}])")
            shares.append(f"{100 * share:.3g} %")
    if not found and len(set(actions)) == 1:
        return f"Your rule gave the action {actions[0]} for each of 2000 other observations."
    if not found:
        return ""
    return (
        f"Your rule looks at {listed(found)}: another value there changes {listed(shares)} of its "
        "actions."
    )


@balancing.check(6)
def balances_for_half_of_the_time(student: Student):
    expect_no_memory(student)
    mean, said = mean_steps(student), student.said
    if mean < 100:
        raise Wrong(
            f"{said}: the pole stays up for {mean:.1f} steps on average over {EPISODES} episodes; "
            f"at least 100 are asked for here, 195 for all points. {looked_at(student)}".rstrip()
        )


@balancing.check(8)
def balances(student: Student):
    expect_no_memory(student)
    mean, said = mean_steps(student), student.said
    if mean < 195:
        raise Wrong(
            f"{said}: the pole stays up for {mean:.1f} steps on average over {EPISODES} episodes, "
            f"but at least 195 of 200 are asked for. {looked_at(student)}".rstrip()
        )


# ------------------------------------------------------------------- 1.6
comparison = exercise.task("1.6", "Random agents compared", seconds=30, needs=("1.2",))
TABLES = (
    (["Pendulum-v1", "CartPole-v1", "MountainCar-v0"], 4),
    (["CartPole-v1", "MountainCarContinuous-v0"], 3),
    (["CartPole-v1", "Acrobot-v1"], 1),
    (["CartPole-v1", "CartPole-v1"], 2),
)


def expect_column(student: Student, column: str, wanted_of) -> None:
    """Compares a column of the student's tables with random episodes of the grader's own."""
    for index, (names, episodes) in enumerate(TABLES):
        seed = exercise.seed(50 + index)
        table = student.call("compare", names, episodes=episodes, seed=seed)
        expect(
            isinstance(table, list) and len(table) == len(names),
            f"{student.said} returned {show(table)}, but a list of {len(names)} rows is needed.",
        )
        for name, row in zip(names, table, strict=True):
            environment, value = expect_fields(f"{student.said}: a row", row, "environment", column)
            expect(
                environment == name,
                f"{student.said}: the environment of a row is {show(environment)}, but should be "
                f"{name!r} (the rows should be in the order given).",
            )
            nan = isinstance(value, float) and np.isnan(value)
            expect(
                column != "deviation" or episodes > 1 or not nan,
                f"{student.said}: deviation of {name} is NaN, but should be 0 for a single "
                "episode, where the number of episodes minus one is 0.",
            )
            runs = [lived(name, seed + i, 10_000) for i in range(episodes)]
            expect_close(f"{student.said}: {column} of {name}", value, wanted_of(runs), 1e-6)


def returns_of(runs: list[dict]) -> list[float]:
    return [sum(run["rewards"]) for run in runs]


@comparison.check(6)
def mean_return(student: Student):
    expect_column(student, "mean", lambda runs: np.mean(returns_of(runs)))


@comparison.check(4)
def deviation_of_returns(student: Student):
    expect_column(
        student,
        "deviation",
        lambda runs: np.std(returns_of(runs), ddof=1) if len(runs) > 1 else 0.0,
    )


def compared(module, steps, episodes, seed):
    """The length in each row of a table of an environment that has no time limit.

    Its episodes last so many steps and as many more as the seed of their reset.
    """
    import gymnasium
    import numpy

    class Long(gymnasium.Env):
        observation_space = gymnasium.spaces.Box(-1, 1, (1,))
        action_space = gymnasium.spaces.Discrete(2)

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.left = steps + (seed or 0)
            return numpy.zeros(1, dtype=numpy.float32), {}

        def step(self, action):
            self.left -= 1
            return numpy.zeros(1, dtype=numpy.float32), 0.5, self.left <= 0, False, {}

    name = f"Long{len(gymnasium.registry)}-v0"
    gymnasium.register(name, entry_point=Long, disable_env_checker=True)
    return [row["length"] for row in module.compare([name], episodes, seed)]


@comparison.check(4)
def mean_length(student: Student):
    expect_column(student, "length", lambda runs: np.mean([len(run["rewards"]) for run in runs]))
    for steps, seed in ((1500 + exercise.seed(60) % 500, 1), (1200 + exercise.seed(61) % 99, 4)):
        said = (
            "compare([an environment without a time limit whose episodes end after "
            f"{steps + seed} and {steps + seed + 1} steps], episodes=2, seed={seed})"
        )
        lengths = student.run(compared, steps, 2, seed, said=said)
        wanted = steps + seed + 0.5
        expect_close(f"{said}: the length in each row", lengths, [wanted], 1e-6)
