"""Grader of exercise 2; run it with `make test-ex2`.

Task 2.7 is timed: 20000 networks, three times the best of, against a Python loop that the grader
measures on the same machine just before; less than half of the loop's time is asked for. The
solution needs 1/12 of it or less (20 measurements, two busy processes beside it); a loop in the
submission needs all of it. Everything else is recomputed or replayed; tolerances are far above what
the order of sums and single precision can do.
"""

import time
from collections.abc import Sequence
from functools import partial

import gymnasium
import numpy as np

from botschool.grading import (
    Exercise,
    Mismatch,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    show,
)

exercise = Exercise(2, "A neural controller", file="neural_controller.py")
PROBLEMS = ("CartPole-v1", "Pendulum-v1", "Acrobot-v1", "MountainCarContinuous-v0")


def shapes(ninputs: int, nhiddens: int, noutputs: int) -> dict[str, tuple[int, ...]]:
    return {
        "W1": (nhiddens, ninputs),
        "b1": (nhiddens,),
        "W2": (noutputs, nhiddens),
        "b2": (noutputs,),
    }


def expect_network(said: str, network: object, *layers: int) -> dict[str, np.ndarray]:
    """A dict of the four arrays, in their shapes."""
    values = expect_fields(said, network, *shapes(*layers))
    return {
        key: expect_array(f"{said}: {key}", value, shape)
        for value, (key, shape) in zip(values, shapes(*layers).items(), strict=True)
    }


def drawn(rng: np.random.Generator, *layers: int, many: tuple[int, ...] = ()) -> dict:
    """A network of the grader's, with biases that matter."""
    return {key: 0.6 * rng.normal(size=many + shape) for key, shape in shapes(*layers).items()}


def outputs_of(network: dict, values: np.ndarray) -> np.ndarray:
    for layer in "12":
        values = np.tanh(network["b" + layer] + network["W" + layer].dot(values))
    return values


def layers_of(env: gymnasium.Env, nhiddens: int) -> tuple[int, int, int]:
    actions = env.action_space
    discrete = isinstance(actions, gymnasium.spaces.Discrete)
    return (
        len(env.observation_space.low),
        nhiddens,
        int(actions.n) if discrete else len(actions.low),
    )


PRECISIONS = (np.float32, np.float64)
"""Either may hand an action on; a pendulum that nearly stands makes much of the difference."""


def action_of(
    outputs: np.ndarray, space: gymnasium.Space, precision: type = np.float32
) -> int | np.ndarray:
    if isinstance(space, gymnasium.spaces.Discrete):
        return int(space.start + outputs.argmax())
    return (space.low + (outputs + 1) / 2 * (space.high - space.low)).astype(precision)


def return_of(
    env: gymnasium.Env, network: dict, seed: int, maxsteps: int, precision: type = np.float32
) -> float:
    """Return of an episode with the grader's own network."""
    observation, _ = env.reset(seed=seed)
    total = 0.0
    for _ in range(maxsteps):
        action = action_of(outputs_of(network, observation), env.action_space, precision)
        observation, reward, terminated, truncated, _ = env.step(action)
        total += float(reward)
        if terminated or truncated:
            break
    return total


# ------------------------------------------------------------------- 2.1
drawing = exercise.task("2.1", "The parameters")


DEVIATIONS = {
    0.1**0.5: "0.316 is the root of 0.1: the standard deviation should be 0.1, not the variance.",
    0.01: "0.01 is 0.1 squared, but 0.1 should be the standard deviation itself.",
    1.0: "These numbers should be multiplied by 0.1.",
    150**-0.5: "1 over the root of 150 is 0.082, but 0.1 is asked for, whatever the sizes are.",
    130**-0.5: "1 over the root of 130 is 0.088, but 0.1 is asked for, whatever the sizes are.",
}
"""The standard deviation of a typical mistake -> what is wrong."""


def evenly_distributed(weights: np.ndarray) -> bool:
    """Whether many numbers reach as far as evenly distributed ones do, and lie on all sizes."""
    away = np.abs(weights - weights.mean())
    return bool(away.max() < 1.8 * weights.std() and 0.4 < (away < away.max() / 2).mean() < 0.6)


def parameters_of(student: Student, layers: tuple[int, int, int], index: int) -> dict:
    network = student.call("parameters", *layers, seed=exercise.seed(index))
    return expect_network(student.said, network, *layers)


@drawing.check(4)
def have_the_right_shapes(student: Student):
    for layers in ((4, 5, 2), (3, 10, 1), (7, 1, 4)):
        parameters_of(student, layers, 1)


@drawing.check(3)
def biases_are_zero(student: Student):
    network = parameters_of(student, (6, 8, 3), 2)
    for key in ("b1", "b2"):
        expect(bool(np.all(network[key] == 0)), f"{student.said}: {key} should be all zeros.")
    for key in ("W1", "W2"):
        expect(
            bool(np.all(network[key] != 0)),
            f"{student.said}: {key} has weights that are 0, but each should be drawn at random.",
        )


@drawing.check(4)
def weights_are_gaussian(student: Student):
    network = parameters_of(student, (130, 150, 140), 3)  # no 1 / sqrt(size) is 0.1
    for key in ("W1", "W2"):
        weights = network[key]
        near = (each for each in DEVIATIONS if abs(weights.std() / each - 1) < 0.02)
        centred = abs(weights.mean()) < 0.03 * weights.std()
        why = DEVIATIONS.get(next(near, 0.0), "") if centred else ""
        if abs(weights.mean() - 0.1) < 0.03 * weights.std():
            why = "0.1 should be the standard deviation, not the mean."
        if evenly_distributed(weights):
            why = "These numbers are evenly distributed (uniform), but Gaussian ones are asked for."
        farthest = np.abs(weights).max()
        if bool(np.all(weights >= 0)):
            why = "None of them is negative, but about half should be."
        elif (share := float(np.mean(np.abs(weights) == farthest))) > 0.005:
            why = f"{100 * share:.0f} % of them are exactly {farthest:.3g} away from 0: Gaussian "
            why += "numbers have no limits."
        expect(
            abs(weights.mean()) < 0.005 and abs(weights.std() - 0.1) < 0.004,
            f"{student.said}: {key} has mean {weights.mean():.3f} and standard deviation "
            f"{weights.std():.3f}, but 0 and 0.1 are asked for. {why}".rstrip(),
        )
        moment = "sum up to 0" if abs(weights.mean(dtype=float)) < 1e-8 else ""
        if abs(weights.std(dtype=float) - 0.1) < 1e-8:
            moment = "have the standard deviation 0.1"
        expect(
            not moment,
            f"{student.said}: the weights in {key} {moment} to the last place, which random "
            "numbers never do: each should be drawn on its own, and not be fitted to the others.",
        )
        beyond = float(np.mean(np.abs(weights) > 0.2))
        expect(
            0.03 < beyond < 0.06,
            f"{student.said}: {100 * beyond:.1f} % of {key} are farther than 0.2 from 0, but 4.6 % "
            "should be, as for Gaussian numbers with standard deviation 0.1.",
        )


def drawn_again(module, *arguments):
    """Whether a second network is as the first was before its arrays were changed."""
    import numpy

    one = module.parameters(*arguments)
    before = {key: numpy.array(array) for key, array in one.items()}
    for array in one.values():
        if isinstance(array, numpy.ndarray) and array.flags.writeable:
            array += 1
        elif isinstance(array, list):
            array.clear()
    again = module.parameters(*arguments)
    return all(bool(numpy.array_equal(again[key], before[key])) for key in before)


@drawing.check(3)
def every_weight_is_drawn_and_the_seed_decides(student: Student):
    one = parameters_of(student, (5, 6, 5), 4)
    weights = np.concatenate([one["W1"].ravel(), one["W2"].ravel()])
    few = "but each should be drawn on its own."
    if np.array_equal(weights, weights.round(4)):
        few = "and none has more than four decimals: each should be drawn on its own, unrounded."
    expect(
        len(np.unique(weights)) == len(weights),
        f"{student.said}: some weights are equal to others, {few}",
    )
    again = parameters_of(student, (5, 6, 5), 4)
    seed = exercise.seed(4) + 1
    said = f"parameters(5, 6, 5, seed={seed})"
    other = expect_network(said, student.call("parameters", 5, 6, 5, seed=seed), 5, 6, 5)
    shared = np.intersect1d(
        *(np.concatenate([e["W1"].ravel(), e["W2"].ravel()]) for e in (one, other))
    )
    expect(
        len(shared) == 0,
        f"{said}: {len(shared)} of its 60 weights are also in the network of seed={seed - 1}. Two "
        "seeds should have no weight in common: make one generator from the seed, and draw both W1 "
        "and W2 from it.",
    )
    zero, same = (
        expect_network(said, student.call("parameters", 5, 6, 5, seed=0), 5, 6, 5) for _ in range(2)
    )
    for first, second, which in ((one, again, exercise.seed(4)), (zero, same, 0)):
        expect(
            all(np.array_equal(first[key], second[key]) for key in ("W1", "W2")),
            f"parameters(5, 6, 5, seed={which}) gives other numbers when it is called again with "
            "the same seed.",
        )
    said = "parameters(5, 6, 5, seed=1), after the arrays of an earlier call were changed,"
    kept = student.run(drawn_again, 5, 6, 5, 1, said=said)
    expect(
        kept is True,
        f"{said} gives the changed arrays, so that training one network changes the others: make "
        "new arrays in every call.",
    )


# ------------------------------------------------------------------- 2.2
passing = exercise.task("2.2", "From observation to outputs")


def forwarded(student: Student, network: dict, observation: np.ndarray, size: str) -> np.ndarray:
    outputs = student.run(
        forward_of, network, observation, said=f"forward(network, observation) for {size}"
    )
    return expect_array(student.said, outputs, network["b2"].shape)


def forward_of(module, network, observation):
    return module.forward(network, observation)


def changed_by(module, network, observation):
    """What is no longer as it was after a call: names of arrays."""
    import numpy

    given = {**network, "observation": observation}
    before = {name: array.copy() for name, array in given.items()}
    module.forward(network, observation)
    after = {**network, "observation": observation}
    return [
        name
        for name, array in before.items()
        if after.get(name) is not given[name] or not numpy.array_equal(array, given[name])
    ]


@np.errstate(all="ignore")
def mistaken_outputs(network: dict, observation: np.ndarray) -> dict:
    """What mistakes make of the outputs."""
    W1, b1, W2, b2 = (network[key] for key in ("W1", "b1", "W2", "b2"))
    hidden = np.tanh(W1.dot(observation) + b1)
    return {
        "The biases are left out.": np.tanh(W2.dot(np.tanh(W1.dot(observation)))),
        "The biases of the hidden neurons are left out.": np.tanh(
            W2.dot(np.tanh(W1.dot(observation))) + b2
        ),
        "The biases of the outputs are left out.": np.tanh(W2.dot(hidden)),
        "The biases of the outputs are added after tanh, but they should be added before "
        "it.": np.tanh(W2.dot(hidden)) + b2,
        "tanh is left out at the outputs.": W2.dot(hidden) + b2,
        "tanh is left out in the hidden neurons.": np.tanh(W2.dot(W1.dot(observation) + b1) + b2),
        "The biases are subtracted, but they should be added.": np.tanh(
            W2.dot(np.tanh(W1.dot(observation) - b1)) - b2
        ),
        "The inputs go through tanh, too, but only the sums of the neurons should.": np.tanh(
            W2.dot(np.tanh(W1.dot(np.tanh(observation)) + b1)) + b2
        ),
        "The outputs are shares of 1 (softmax), but each sum should go through tanh.": (
            np.exp(W2.dot(hidden) + b2) / np.exp(W2.dot(hidden) + b2).sum()
        ),
        "A neuron's bias is added once for each of its inputs, but it should be added only "
        "once.": np.tanh(
            W2.dot(np.tanh(W1.dot(observation) + len(observation) * b1)) + len(hidden) * b2
        ),
    }


def compare_outputs(student: Student, index: int, change) -> None:
    """The student's outputs against the formula, for networks altered by change(network)."""
    rng = np.random.default_rng(exercise.seed(index))
    for layers in ((4, 5, 2), (3, 10, 1), (1, 1, 3), (6, 20, 6)):
        network = drawn(rng, *layers)
        change(network)
        observation = rng.normal(size=layers[0]).astype(np.float32)
        got = forwarded(
            student, network, observation, "layers of {}, {} and {} neurons".format(*layers)
        )
        wanted = outputs_of(network, observation)
        expect_close(student.said, got, wanted, 1e-5, mistaken_outputs(network, observation))


@passing.check(6)
def weights_and_tanh(student: Student):
    compare_outputs(
        student, 10, lambda network: network.update(b1=0 * network["b1"], b2=0 * network["b2"])
    )


@passing.check(4)
def biases_count(student: Student):
    compare_outputs(student, 11, lambda network: None)


@passing.check(4)
def large_sums_saturate(student: Student):
    for index, factor in ((12, 8), (14, 5000)):  # e to the power of some of the latter is infinite
        compare_outputs(
            student,
            index,
            lambda network, factor=factor: network.update(
                W1=factor * network["W1"], W2=factor * network["W2"]
            ),
        )


@passing.check(2)
def arrays_stay_as_they_are(student: Student):
    rng = np.random.default_rng(exercise.seed(13))
    network, observation = drawn(rng, 4, 5, 2), rng.normal(size=4).astype(np.float32)
    changed = student.run(changed_by, network, observation, said="forward(network, observation)")
    expect(
        changed == [],
        f"{student.said} changed {' and '.join(map(str, changed))} of what it was given, but this "
        "should stay as it is. (`+=`, for example, changes an array in place.)",
    )


# ------------------------------------------------------------------- 2.3
counting = exercise.task("2.3", "As many neurons as the environment needs")


def probe(module, ninputs, noutputs, discrete, start):
    """Counts in an environment that no student has met."""
    import gymnasium

    class Probe(gymnasium.Env):
        observation_space = gymnasium.spaces.Box(-1, 1, (ninputs,))
        action_space = (
            gymnasium.spaces.Discrete(noutputs, start=start)
            if discrete
            else gymnasium.spaces.Box(-1, 1, (noutputs,))
        )

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            return self.observation_space.sample(), {}

        def step(self, action):
            return self.observation_space.sample(), 0.0, False, False, {}

    name = f"Probe{len(gymnasium.registry)}-v0"
    gymnasium.register(name, entry_point=Probe, disable_env_checker=True)
    return module.sizes(name)


def why_so_many(discrete: bool, wanted: Sequence[int], index: int) -> str:
    """What the task says about the number of inputs (index 0) or outputs."""
    if index == 0:
        return f"Each observed number needs an input ({wanted[0]} in all)."
    kind = "choice of a Discrete space" if discrete else "number of an action in a Box"
    return f"Each {kind} needs an output ({wanted[1]} in all)."


def expect_sizes(student: Student, discrete: bool) -> None:
    rng = np.random.default_rng(exercise.seed(20 + discrete))
    for name in PROBLEMS:
        with gymnasium.make(name) as env:
            if isinstance(env.action_space, gymnasium.spaces.Discrete) != discrete:
                continue
            wanted = layers_of(env, 1)[::2]
        answer = student.call("sizes", name)
        expect_close(student.said, answer, wanted, why=partial(why_so_many, discrete, wanted))
    for start in (0, 7, 5):
        wanted = rng.integers(2, 30, size=2).tolist()
        first = f", start={start}" if start else ""
        kind = f"Discrete({wanted[1]}{first})" if discrete else f"a Box of {wanted[1]} numbers"
        said = f"sizes(...) for {wanted[0]} observed numbers and actions in {kind}"
        mistakes = {}
        if discrete:
            counts = {
                "The start of the space is subtracted": wanted[1] - start,
                "The start of the space is added": wanted[1] + start,
                "This is the number of the last choice": wanted[1] + start - 1,
            }
            mistakes = {
                f"{text}, but how many choices there are is asked for.": (wanted[0], count)
                for text, count in counts.items()
            }
        answer = student.run(probe, *wanted, discrete, start, said=said)
        why = partial(why_so_many, discrete, wanted)
        expect_close(said, answer, wanted, mistakes=mistakes, why=why)


@counting.check(4)
def counts_discrete_actions(student: Student):
    expect_sizes(student, True)


@counting.check(4)
def counts_continuous_actions(student: Student):
    expect_sizes(student, False)


# ------------------------------------------------------------------- 2.4
acting = exercise.task("2.4", "From outputs to an action")


def chosen(module, outputs, space):
    """The student's action in a space that the grader describes."""
    import gymnasium
    import numpy

    if "choices" in space:
        made = gymnasium.spaces.Discrete(space["choices"], start=space["first"])
    else:
        low, high = (numpy.array(space[side], dtype=numpy.float32) for side in ("low", "high"))
        made = gymnasium.spaces.Box(low, high)
    return [module.act(each, made) for each in outputs]


def outputs_after(module, outputs, low, high):
    """The outputs, after the student's act has used them."""
    import gymnasium
    import numpy

    low, high = (numpy.array(each, dtype=numpy.float32) for each in (low, high))
    module.act(outputs, gymnasium.spaces.Box(low, high))
    return outputs


OTHER_CHOICES = (
    (
        lambda y: len(y) - 1 - y[::-1].argmax(),
        "Of equal outputs, the first one should decide, not the last.",
    ),
    (lambda y: y.argmin(), "The least active output is taken, but the most active one should be."),
    (
        lambda y: np.abs(y).argmax(),
        "The output farthest from 0 is taken, but the largest one should be.",
    ),
    *(
        (rule, "The first output alone decides here, but the largest output should decide.")
        for rule in (
            lambda y: round((y[0] + 1) / 2 * (len(y) - 1)),
            lambda y: int((y[0] + 1) / 2 * len(y)),
            lambda y: int(y[0] > 0),
            lambda y: int(y[0] < 0),
        )
    ),
)
"""Wrong rules for the number of the output that decides, and what each does."""


def expect_choices(student: Student, outputs: np.ndarray, first: int) -> None:
    choices = outputs.shape[1]
    space = f"Discrete({choices}, start={first})" if first else f"Discrete({choices})"
    said = f"act(outputs, {space})"
    got = student.run(chosen, outputs, {"choices": choices, "first": first}, said=said)
    expect(isinstance(got, list) and len(got) == len(outputs), f"{said} gave no answers.")
    rules = [
        text
        for rule, text in OTHER_CHOICES
        if all(action == first + rule(each) for each, action in zip(outputs, got, strict=True))
    ]
    why = f"\n  {rules[0]}" if rules else ""
    for each, action in zip(outputs, got, strict=True):
        wanted = first + int(each.argmax())
        expect(
            type(action) is int and action == wanted,
            f"act({show(each)}, {space}) returned {show(action)}, but the int {wanted} was "
            f"expected.{why}",
        )


@acting.check(5)
def most_active_output_decides(student: Student):
    rng = np.random.default_rng(exercise.seed(30))
    for choices in (2, 3, 6):
        outputs = rng.uniform(-1, 1, size=(20, choices))
        outputs[[0, 3, 4, 5, 6]] = 0.25  # all equal: the lowest
        outputs[1] = np.sort(-np.abs(outputs[1]))  # all negative, the last is the most active
        outputs[2] = 0.5 + 1e-4 * np.arange(choices)  # close ones, likewise
        expect_choices(student, outputs, 0)


@acting.check(2)
def choices_may_start_elsewhere(student: Student):
    rng = np.random.default_rng(exercise.seed(31))
    for first in (1, -2, 10):
        expect_choices(student, rng.uniform(-1, 1, size=(10, 4)), first)


def expect_stretched(student: Student, outputs: np.ndarray, low: np.ndarray, high: np.ndarray):
    space = f"Box({show(low)}, {show(high)})"
    said = f"act(outputs, {space})"
    bounds = {"low": low.tolist(), "high": high.tolist()}
    got = student.run(chosen, outputs, bounds, said=said)
    expect(isinstance(got, list) and len(got) == len(outputs), f"{said} gave no answers.")
    for each, action in zip(outputs, got, strict=True):
        call = f"act({show(each)}, {space})"
        wanted = low + (each + 1) / 2 * (high - low)
        mistakes = {
            "The outputs are handed on as they are, but should be stretched to the space's "
            "limits.": each,
            "Outputs beyond the limits are cut off, but all should be stretched.": each.clip(
                low, high
            ),
            "The outputs are multiplied by the upper limit, but the lower one should count, "
            "too.": each * high,
            "The limits of the first number are used for all, but each has its own.": low[0]
            + (each + 1) / 2 * (high[0] - low[0]),
            "The outputs are multiplied by the upper limit of the first number, but each should "
            "be stretched to its own two limits.": each * high[0],
            "Outputs below 0 are cut off, but all from -1 to 1 should be stretched.": low
            + each.clip(0, 1) * (high - low),
            "The outputs are multiplied by the upper limit, and the middle of the range is added, "
            "but they should be multiplied by half of its width.": (low + high) / 2 + each * high,
            "The outputs are multiplied by the whole width of the range, but half of it is asked "
            "for.": ((low + high) / 2 + each * (high - low)),
        }
        expect_close(call, action, wanted, 1e-5, mistakes)


@acting.check(4)
def outputs_are_stretched(student: Student):
    rng = np.random.default_rng(exercise.seed(32))
    for limit in (2.0, 0.4):
        outputs = np.vstack([[[-1.0], [0.0], [1.0]], rng.uniform(-1, 1, size=(10, 1))])
        expect_stretched(student, outputs, np.array([-limit]), np.array([limit]))


@acting.check(3)
def each_number_has_its_own_limits(student: Student):
    rng = np.random.default_rng(exercise.seed(33))
    for size in (2, 5):
        low, width = rng.uniform(-3, 3, size=size).round(2), rng.uniform(1, 5, size=size).round(2)
        expect_stretched(student, rng.uniform(-1, 1, size=(10, size)), low, low + width)
    outputs, low, high = rng.uniform(-1, 1, size=3), [-1.0, 0.0, 2.0], [1.0, 3.0, 3.0]
    said = f"act({show(outputs)}, Box({low}, {high}))"
    expect_close(
        f"{said}: the array that it was given (it should stay as it is)",
        student.run(outputs_after, outputs, low, high, said=said), outputs,
    )  # fmt: skip


# ------------------------------------------------------------------- 2.5
episodes = exercise.task("2.5", "An episode", needs=("2.2", "2.4"))


def lived(module, name, network, seed, maxsteps):
    if maxsteps is None:
        return module.run_episode(name, network, seed)
    return module.run_episode(name, network, seed, maxsteps)


def replay(
    student: Student, name: str, index: int, maxsteps: int | None, seed: int | None = None
) -> tuple[float, float]:
    """Follows the student's actions in a fresh environment: (return reported, return found).

    Every action must be the one of the network at that moment, and there must be as many as the
    episode is long. maxsteps: None asks for the default, 200.
    """
    seed = exercise.seed(index) if seed is None else seed
    limit = "" if maxsteps is None else f", maxsteps={maxsteps}"
    with gymnasium.make(name) as env:
        network = drawn(np.random.default_rng(seed), *layers_of(env, 5))
        said = f"run_episode({name!r}, network, seed={seed}{limit})"
        answer = student.run(lived, name, network, seed, maxsteps, said=said)
        maxsteps = 200 if maxsteps is None else maxsteps
        actions, total = expect_fields(said, answer, "actions", "return")
        fit = isinstance(actions, (list, np.ndarray))
        many = f"{len(actions)} actions" if fit and len(actions) > maxsteps else show(actions)
        expect(
            fit and 0 < len(actions) <= maxsteps,
            f"{said}: actions should be a list of 1 to {maxsteps} actions, not {many}.",
        )
        shape = len(actions), *env.action_space.shape
        actions = expect_array(f"{said}: actions", actions, shape)
        problems = []
        for precision in PRECISIONS:
            try:
                rewards = followed(said, env, network, seed, actions, maxsteps, precision)
            except Wrong as problem:
                problems.append(problem)
            else:
                return float(expect_array(f"{said}: return", total, ())), rewards
        raise problems[0]


def followed(said, env, network, seed, actions, maxsteps, precision) -> float:
    """The return of an episode with these actions, which the network must have chosen."""
    observation, _ = env.reset(seed=seed)
    rewards, over, space = 0.0, False, env.action_space
    for step, action in enumerate(actions):
        expect(
            not over,
            f"{said} reports {len(actions)} actions, but with these actions the episode of this "
            f"seed is over after {step} steps.",
        )
        outputs = outputs_of(network, observation)
        wanted = action_of(outputs, space)
        expect(
            _draw(outputs, space) or np.allclose(action, wanted, rtol=1e-4, atol=1e-4),
            f"{said}: actions[{step}] is {show(action)}, but the network chooses {show(wanted)} "
            + (
                "for the observation of the reset."
                if step == 0
                else "for the observation before it."
            ),
        )
        fitting = int(action) if space.shape == () else action.astype(precision)
        observation, reward, terminated, truncated, _ = env.step(fitting)
        rewards += float(reward)
        over = terminated or truncated
    if not over and len(actions) < maxsteps:
        _, _, *ends, _ = env.step(action_of(outputs_of(network, observation), space))
        why = "the episode of this seed goes on after that."
        if any(ends):
            why = f"one more step, number {len(actions) + 1}, ends the episode of this seed."
        raise Wrong(f"{said} reports {len(actions)} action{'s' * (len(actions) > 1)}, but {why}")
    return rewards


def _draw(outputs: np.ndarray, space: gymnasium.Space) -> bool:
    """Whether rounding may decide between two choices."""
    return space.shape == () and bool(np.diff(np.sort(outputs))[-1] < 1e-5)


CASES = (
    ("CartPole-v1", 200),
    ("Pendulum-v1", 300),
    ("Acrobot-v1", 80),
    ("MountainCarContinuous-v0", 50),
)
"""Environment and maxsteps: ended by itself, by its time limit, by maxsteps."""


@episodes.check(6)
def discrete_actions(student: Student):
    for case in (0, 2):
        replay(student, CASES[case][0], 40 + case, CASES[case][1])


@episodes.check(5)
def continuous_actions(student: Student):
    replay(student, "Pendulum-v1", 44, 20, seed=0)  # no two starts are alike
    for case in (1, 3):
        replay(student, CASES[case][0], 40 + case, CASES[case][1])
    replay(student, "MountainCarContinuous-v0", 45, None)


@episodes.check(5)
def sums_the_rewards(student: Student):
    for case, (name, maxsteps) in enumerate(CASES):
        reported, found = replay(student, name, 50 + case, maxsteps)
        if abs(reported - found) > 1e-3 * abs(found) + 1e-6:
            raise Mismatch(
                f"{student.said}: return is {reported:.4f}, but the rewards of these actions sum "
                f"up to {found:.4f}.", np.array(reported), np.array(found),
            )  # fmt: skip


# ------------------------------------------------------------------- 2.6
measuring = exercise.task("2.6", "Fitness", seconds=30, needs=("2.5",))


def measured(module, name, network, seeds, maxsteps):
    """The fitness, and the seeds after it was measured."""
    limit = [] if maxsteps is None else [maxsteps]
    return [module.fitness(name, network, seeds, *limit), seeds]


def expect_fitness(said: str, value: object, name: str, network: dict, seeds, maxsteps: int):
    """The mean return as the grader finds it, for any network."""
    got = float(expect_array(said, value, ()))
    with gymnasium.make(name) as env:
        for precision in PRECISIONS:
            returns = [return_of(env, network, seed, maxsteps, precision) for seed in seeds]
            wanted = float(np.mean(returns))
            rounding = 1e-6 if all(each.is_integer() for each in returns) else 1e-3
            if abs(got - wanted) <= rounding * abs(wanted) + 1e-6:
                break
    if abs(got - wanted) > rounding * abs(wanted) + 1e-6:
        mistakes = {
            "It is the sum of the returns, but their mean is asked for.": np.sum(returns),
            "It is the return of the first episode, but the mean is asked for.": returns[0],
            "It is the return of the best episode, but the mean is asked for.": max(returns),
            "It is the return of the last episode, but the mean is asked for.": returns[-1],
        }
        raise Mismatch(
            f"{said} is {got:.4f}, but should be {wanted:.4f}, the mean return over {len(seeds)} "
            f"episode{'s' * (len(seeds) > 1)}.",
            got, wanted, mistakes,
        )  # fmt: skip


def whole_mean(env, network: dict, seeds: list[int], maxsteps: int) -> bool:
    return sum(return_of(env, network, seed, maxsteps) for seed in seeds) % len(seeds) == 0


def check_fitness(
    student: Student,
    name: str,
    index: int,
    episodes: int,
    maxsteps: int | None,
    twice: bool = False,
    uneven: bool = False,
):
    """twice: whether the first seed comes a second time, at the end.

    uneven: whether the mean of the returns must not be a whole number.
    """
    rng = np.random.default_rng(exercise.seed(index))
    seeds = [int(seed) for seed in rng.integers(2**31, size=episodes)]
    seeds += seeds[:twice]
    with gymnasium.make(name) as env:
        network = drawn(rng, *layers_of(env, 6))
        while uneven and whole_mean(env, network, seeds, maxsteps):
            network = drawn(rng, *layers_of(env, 6))
    limit = "" if maxsteps is None else f", maxsteps={maxsteps}"
    which = f"seeds={seeds}" if twice else f"{episodes} seed{'s' * (episodes > 1)}"
    said = f"fitness({name!r}, network, {which}{limit})"
    value, after = student.run(measured, name, network, seeds, maxsteps, said=said)
    expect(
        after == seeds,
        f"{said} changed the list of seeds that it was given to {show(after)}, but it should stay "
        "as it is.",
    )
    expect_fitness(said, value, name, network, seeds, 200 if maxsteps is None else maxsteps)


@measuring.check(6)
def mean_over_ten_episodes(student: Student):
    for case, name in enumerate(PROBLEMS):
        check_fitness(student, name, 60 + case, 10, None)


@measuring.check(4)
def any_seeds_and_steps(student: Student):
    check_fitness(student, "Pendulum-v1", 70, 3, 60)
    check_fitness(student, "Pendulum-v1", 73, 2, 260)
    check_fitness(student, "CartPole-v1", 71, 7, 20, uneven=True)
    check_fitness(student, "Acrobot-v1", 72, 1, 30)
    check_fitness(student, "Pendulum-v1", 74, 2, 20, twice=True)
    check_fitness(student, "MountainCarContinuous-v0", 75, 2, 15, twice=True)


# ------------------------------------------------------------------- 2.7
batching = exercise.task("2.7", "Many networks at once")


def batched(module, networks, observations):
    return module.forward_batch(networks, observations)


def kept_after_another_batch(module, networks, observations):
    """Whether an answer is as it was after a later call for other observations."""
    import numpy

    first = module.forward_batch(networks, observations)
    before = numpy.array(first)
    module.forward_batch(networks, observations + 1)
    return bool(numpy.array_equal(first, before))


def changed_by_batch(module, networks, observations):
    """Names of arrays that are no longer as they were after a call."""
    import numpy

    given = {**networks, "observations": observations}
    before = {name: array.copy() for name, array in given.items()}
    module.forward_batch(networks, observations)
    after = {**networks, "observations": observations}
    return [name for name in given if not numpy.array_equal(after.get(name), before[name])]


def timed(module, n, seed):
    """Many networks, drawn here because they would be too many to send."""
    import numpy

    rng = numpy.random.default_rng(seed)
    shapes = {"W1": (n, 5, 4), "b1": (n, 5), "W2": (n, 2, 5), "b2": (n, 2)}
    networks = {key: rng.random(shape, dtype=numpy.float32) for key, shape in shapes.items()}
    observations = rng.random((n, 4), dtype=numpy.float32)
    return module.forward_batch(networks, observations)


def upon(network: dict, hidden: np.ndarray) -> np.ndarray:
    """The outputs for these hidden neurons."""
    return np.tanh(network["b2"] + network["W2"].dot(hidden))


def expect_batch(student: Student, index: int, sizes: tuple, factor: float = 1) -> None:
    """factor: of all parameters."""
    rng = np.random.default_rng(exercise.seed(index))
    for n, *layers in sizes:
        networks = {k: factor * each for k, each in drawn(rng, *layers, many=(n,)).items()}
        observations = rng.normal(size=(n, layers[0]))
        said = f"forward_batch(...) for n = {n} and layers of {layers} neurons"
        got = student.run(batched, networks, observations, said=said)
        got = expect_array(said, got, (n, layers[2]))
        for i in range(n):
            network = {key: stack[i] for key, stack in networks.items()}
            wanted = outputs_of(network, observations[i])
            if not np.allclose(got[i], wanted, rtol=0, atol=1e-4):
                first = {key: stack[0] for key, stack in networks.items()}
                mixed = {key: network[key].reshape(network[key].T.shape).T for key in ("W1", "W2")}
                mistakes = mistaken_outputs(network, observations[i]) | {
                    "It gets all parameters of network 0, but it has its own.": outputs_of(
                        first, observations[i]
                    ),
                    "It gets W1 and W2 of network 0 with its own biases, but it has its own W1 and "
                    "W2.": outputs_of(
                        network | {"W1": first["W1"], "W2": first["W2"]}, observations[i]
                    ),
                    "It gets W2 and b2 of network 0, but it has its own.": outputs_of(
                        network | {"W2": first["W2"], "b2": first["b2"]}, observations[i]
                    ),
                    "The weights are reshaped. This does not exchange rows and columns, but puts "
                    "each weight into another place.": outputs_of(network | mixed, observations[i]),
                    "The weights of the first layer are reshaped. This does not exchange rows and "
                    "columns, but puts each weight into another place.": (
                        outputs_of(network | {"W1": mixed["W1"]}, observations[i])
                    ),
                    "It gets the observation of network 0, but it has its own.": outputs_of(
                        network, observations[0]
                    ),
                    "It gets the sum of all observations, but it has its own.": (
                        outputs_of(network, observations.sum(axis=0))
                    ),
                    "It gets the hidden neurons of network 0, but it has its own.": (
                        upon(network, np.tanh(first["b1"] + first["W1"].dot(observations[0])))
                    ),
                    "It gets W1 and b1 of network 0, but it has its own.": upon(
                        network, np.tanh(first["b1"] + first["W1"].dot(observations[i]))
                    ),
                }
                raise Mismatch(
                    f"{said}: network {i} gives {show(got[i])}, but should give {show(wanted)}, as "
                    "it does alone.", got[i], wanted, mistakes,
                )  # fmt: skip


@batching.check(7)
def equals_each_network_alone(student: Student):
    expect_batch(student, 80, ((7, 4, 5, 2), (50, 3, 10, 1), (300, 6, 5, 3)))


@batching.check(2)
def few_and_square(student: Student):
    expect_batch(student, 81, ((1, 4, 5, 2), (4, 4, 4, 4), (5, 1, 1, 1)))
    expect_batch(student, 86, ((3, 4, 5, 2),), factor=5000)
    rng = np.random.default_rng(exercise.seed(85))
    networks, said = drawn(rng, 4, 5, 2, many=(3,)), "forward_batch(networks, observations)"
    changed = student.run(changed_by_batch, networks, rng.normal(size=(3, 4)), said=said)
    expect(
        changed == [],
        f"{said} changed {' and '.join(map(str, changed))} of what it was given, but this should "
        "stay as it is. (`+=`, for example, changes an array in place.)",
    )
    kept = student.run(kept_after_another_batch, networks, rng.normal(size=(3, 4)), said=said)
    expect(kept is True, f"{said} changes what an earlier call returned: make a new array.")


@batching.check(3)
def is_quicker_than_a_loop(student: Student):
    n = 20000
    said = f"forward_batch(...) for {n} networks"
    loop = batch = np.inf
    for repeat in range(3):
        seed = exercise.seed(82 + repeat)
        rng = np.random.default_rng(seed)
        stacks = {
            key: rng.random((n, *shape), dtype=np.float32) for key, shape in shapes(4, 5, 2).items()
        }
        observations = rng.random((n, 4), dtype=np.float32)
        begun = time.perf_counter()
        wanted = [
            outputs_of({key: stack[i] for key, stack in stacks.items()}, observations[i])
            for i in range(n)
        ]
        loop = min(loop, time.perf_counter() - begun)
        begun = time.perf_counter()
        got = student.run(timed, n, seed, said=said)
        batch = min(batch, time.perf_counter() - begun)
        got = expect_array(said, got, (n, 2))
        expect(np.allclose(got, wanted, rtol=0, atol=1e-4), f"{said}: some outputs are wrong.")
    expect(
        batch < loop / 2,
        f"{said} took {batch:.2f} s. A Python loop that computes one network after the other takes "
        f"{loop:.2f} s; less than half of that is asked for. Compute all networks with the same "
        "few NumPy operations, without a loop over them: a list comprehension is one, too.",
    )


# ------------------------------------------------------------------- 2.8
searching = exercise.task("2.8", "The luckiest network", seconds=40, needs=("2.1", "2.3", "2.6"))


def searched(student: Student, name: str, index: int, nnetworks: int, nhiddens: int):
    """What the student reports: networks, their fitness, the best, and the seeds to check with."""
    seed = exercise.seed(index)
    report = student.call("random_search", name, nnetworks, nhiddens, seed=seed)
    networks, values, best = expect_fields(student.said, report, "networks", "fitness", "best")
    expect(
        isinstance(networks, list) and len(networks) == nnetworks,
        f"{student.said}: networks should be a list of {nnetworks} networks, not {show(networks)}.",
    )
    with gymnasium.make(name) as env:
        layers = layers_of(env, nhiddens)
    networks = [expect_network(f"{student.said}: a network", each, *layers) for each in networks]
    weights = np.array([network["W1"].ravel()[0] for network in networks])
    expect(
        len(np.unique(weights)) == nnetworks,
        f"{student.said}: W1[0, 0] is the same in some networks, but network i should have the "
        "parameters of seed + i.",
    )
    said = student.said
    for i in sorted({0, 1, nnetworks - 1}):
        of_its_own = student.call("parameters", *layers, seed=seed + i)
        own = expect_network(student.said, of_its_own, *layers)
        expect(
            all(np.array_equal(networks[i][key], own[key]) for key in own),
            f"{said}: network {i} is not the one that {student.said} returns, but network i should "
            "have the parameters of seed + i.",
        )
    values = expect_array(f"{said}: fitness", values, (nnetworks,))
    student.said = said
    return networks, values, best, range(seed, seed + 10)


def in_other_episodes(student: Student) -> str:
    """The seeds of the student's episodes, if they follow from a usual mistake.

    Pendulum tells them: no two of its returns are alike.
    """
    name = "Pendulum-v1"
    networks, values, _, seeds = searched(student, name, 91, 3, 5)
    seed = seeds[0]
    others = {
        "the seeds 0 to 9, whatever the seed is": lambda i: range(10),
        "the seeds 1 to 10, whatever the seed is": lambda i: range(1, 11),
        "the seeds from seed + 1 to seed + 10": lambda i: range(seed + 1, seed + 11),
        "seed alone": lambda i: [seed],
        "seed + i alone for network i": lambda i: [seed + i],
        "the seeds from seed + i on for network i": lambda i: range(seed + i, seed + i + 10),
        "the seeds from seed + 10 * i on for network i": lambda i: range(
            seed + 10 * i, seed + 10 * i + 10
        ),
    }
    with gymnasium.make(name) as env:
        for text, seeds_of in others.items():
            pairs = zip(networks, values, map(seeds_of, range(3)), strict=True)
            if all(
                np.isclose(np.mean([return_of(env, network, each, 200) for each in own]), value)
                for network, value, own in pairs
            ):
                return (
                    f"\n  It is the mean return with {text}, but all networks should have the "
                    "seeds from seed to seed + 9."
                )
    return ""


@searching.check(6)
def measures_every_network_in_every_problem(student: Student):
    for case, name in enumerate(PROBLEMS):
        networks, values, _, seeds = searched(student, name, 90 + case, 3, 4 + case)
        for i, network in enumerate(networks):
            said = f"{student.said}: fitness of network {i}"
            try:
                expect_fitness(said, float(values[i]), name, network, seeds, 200)
            except Mismatch as error:
                raise Wrong(f"{error}{in_other_episodes(student)}") from error


def equal_luck(module, nnetworks, seed, worst, best):
    """Random search where a network gets one of two returns in each episode: many are equal."""
    import gymnasium
    import numpy

    class Coin(gymnasium.Env):
        observation_space = gymnasium.spaces.Box(-1, 1, (2,))
        action_space = gymnasium.spaces.Discrete(2)

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            return numpy.full(2, 0.5, dtype=numpy.float32), {}

        def step(self, action):
            reward = best if action == 1 else worst
            return numpy.full(2, 0.5, dtype=numpy.float32), reward, True, False, {}

    name = f"Coin{len(gymnasium.registry)}-v0"
    gymnasium.register(name, entry_point=Coin, disable_env_checker=True)
    report = module.random_search(name, nnetworks, 4, seed)
    return {"fitness": report["fitness"], "best": report["best"]}


def expect_best(said: str, best: object, values: np.ndarray, otherwise: str) -> None:
    """The number of the best network; otherwise: what is said if it is not."""
    right = type(best) is int and best == int(values.argmax())
    if not right and isinstance(best, (int, float)) and best == values.max():
        otherwise += "\n  It is the fitness of the best network, but its number is asked for."
    expect(right, f"{said}{otherwise}")


@searching.check(1)
def of_equals_the_lowest(student: Student):
    for index in (98, 99, *range(100, 106)):
        worst, best = ((-4e7, -3e7), (300.0, 400.0), (-400.0, -300.0))[index % 3]
        said = f"random_search(...) of 12 networks, where all returns are {worst:.0f} or {best:.0f}"
        report = student.run(equal_luck, 12, exercise.seed(index), worst, best, said=said)
        values, best = expect_fields(said, report, "fitness", "best")
        values = expect_array(f"{said}: fitness", values, (12,))
        expect_best(
            said, best, values,
            f": fitness is {show(values.tolist())}, so best should be the int {values.argmax()}, "
            f"the lowest of equals, but is {show(best)}.",
        )  # fmt: skip


@searching.check(3)
def finds_the_best(student: Student):
    for case, (name, nnetworks) in enumerate((("CartPole-v1", 25), ("Pendulum-v1", 4))):
        networks, values, best, seeds = searched(student, name, 95 + case, nnetworks, 5)
        for i in {0, int(values.argmax())}:
            said = f"{student.said}: fitness of network {i}"
            expect_fitness(said, float(values[i]), name, networks[i], seeds, 200)
        expect_best(
            student.said, best, values,
            f": best is {show(best)}, but should be the int {int(values.argmax())}, the number of "
            "the network with the highest fitness.",
        )  # fmt: skip
    for index in (97, 98):  # the same search with another seed has other networks
        searched(student, "CartPole-v1", index, 2, 5)
