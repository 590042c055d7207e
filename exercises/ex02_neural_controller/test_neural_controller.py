"""Grader of exercise 2; run it with `botschool grade 2`.

All tasks compare with our solution; of networks that a submission draws (2.1, 2.8), a view. They
may have single or double precision, actions too: in 300 episodes of Pendulum this changed no return
by more than 5e-6 of it, and 1e-3 is allowed. Task 2.7 is timed: 20000 networks, the best of three,
against a loop over our `forward`; less than half of its processor time is asked for.
"""

import numpy as np

from botschool.grading import Exercise, Student, expect, expect_array, expect_fields, same, seed_of

CLASSIC = "gymnasium.envs.classic_control"
exercise = Exercise(2, "A neural controller", file="neural_controller.py", imports=(CLASSIC,))
CONTINUOUS = {"MountainCarContinuous-v0": (2, 5, 1), "Pendulum-v1": (3, 5, 1)}
LAYERS = {"CartPole-v1": (4, 5, 2), "Acrobot-v1": (6, 5, 3)} | CONTINUOUS
"""Inputs, hidden neurons and outputs in each environment."""


def network_of(rng, ninputs, nhiddens, noutputs, many=(), biases=0.6, weights=0.6):
    """A network with biases that matter, or a stack of them."""
    return {
        "W1": weights * rng.normal(size=(*many, nhiddens, ninputs)),
        "b1": biases * rng.normal(size=(*many, nhiddens)),
        "W2": weights * rng.normal(size=(*many, noutputs, nhiddens)),
        "b2": biases * rng.normal(size=(*many, noutputs)),
    }


drawing = exercise.task("2.1", "The parameters")


def arrays_of(answer, *_):
    found = {}
    for key in ("W1", "b1", "W2", "b2"):
        found[f"the shape of {key}"] = list(np.shape(answer[key]))
        found[f"how many numbers of {key} are 0"] = int(np.equal(answer[key], 0).sum())
    return found


@same(drawing, 7, "parameters", view=arrays_of)
def shapes_and_zeros(rng):
    for layers in ((4, 5, 3), (3, 6, 4), (3, 10, 1), (7, 1, 4)):
        yield *layers, seed_of(rng)


def distribution_of(answer, *_):
    found = {}
    for key in ("W1", "W2"):
        weights = np.array(answer[key], dtype=float) / 0.1
        mean, deviation = weights.mean(), weights.std()
        found[f"the standard deviation of {key}, divided by 0.1,"] = deviation
        found[f"the mean of {key}, divided by 0.25,"] = 0.4 * mean
        found[f"the share of {key} that is farther than 0.2 from 0"] = np.mean(np.abs(weights) > 2)
        found[f"whether {key} is fitted to them"] = bool(min(abs(mean), abs(deviation - 1)) < 1e-7)
    return found


@same(drawing, 4, "parameters", 0.02, view=distribution_of)
def weights_are_gaussian(rng):
    yield 130, 150, 140, seed_of(rng)  # no 1 / sqrt(size) is 0.1
    yield 140, 130, 150, seed_of(rng)


def repeated(module, layers, seed):
    """parameters(*{0}, seed), for seeds {1}, 0 and others"""
    import numpy

    found = []
    for each in (seed, seed, 0, 0, seed + 1):
        network = module.parameters(*layers, each)
        found.append(numpy.concatenate([numpy.ravel(network[key]) for key in ("W1", "W2")]))
        for array in network.values():  # what one network becomes must not change the next
            if isinstance(array, numpy.ndarray) and array.flags.writeable:
                array += 1
    return found


def in_common(answer, layers, seed):
    one, again, zero, zero_again, other = (np.array(each, dtype=float) for each in answer)
    return {
        "the number of weights that equal others": one.size - np.unique(one).size,
        "whether the same seed gives the same again": np.array_equal(one, again),
        "whether it gives what was changed in the meantime": np.allclose(one + 1, again),
        "whether seed 0 gives the same again": np.array_equal(zero, zero_again),
        "the number of weights that the next seed has, too": np.intersect1d(one, other).size,
    }


@same(drawing, 3, repeated, view=in_common)
def every_weight_is_drawn_and_the_seed_decides(rng):
    yield from ((layers, seed_of(rng)) for layers in ([5, 12, 5], [6, 6, 6]))


passing = exercise.task("2.2", "From observation to outputs")


def passed(rng, **options):
    for layers in ((4, 5, 2), (3, 10, 1), (1, 1, 3), (6, 20, 6)):
        yield network_of(rng, *layers, **options), rng.normal(size=layers[0]).astype(np.float32)


same(passing, 7, "forward", 1e-5, name="weights_and_tanh")(passed, biases=0)
same(passing, 5, "forward", 1e-5, name="biases_count")(passed)


@same(passing, 4, "forward", 1e-5)
def large_sums_saturate(rng):
    yield from passed(rng, weights=5)
    yield from passed(rng, weights=3000)  # e to the power of some is infinite


counting = exercise.task("2.3", "As many neurons as the environment needs")


def made_up(module, call, ninputs, noutputs, start, arguments, rewards):
    """{0}(name, *{4}), {1} observed numbers, {2} choices from {3} on (-1: a Box), rewards {5}"""
    import gymnasium
    import numpy
    from gymnasium import spaces

    class MadeUp(gymnasium.Env):
        observation_space = spaces.Box(-1, 1, (ninputs,))
        action_space = spaces.Box(-1, 1, (noutputs,))
        if start >= 0:
            action_space = spaces.Discrete(noutputs, start=start)
        seen = numpy.full(ninputs, 0.5, dtype=numpy.float32)

        def reset(self, *, seed=None, options=None):
            return self.seen, {}

        def step(self, action):
            return self.seen, rewards[action], True, False, {}

    name = f"MadeUp{len(gymnasium.registry)}-v0"
    gymnasium.register(name, entry_point=MadeUp, disable_env_checker=True)
    return getattr(module, call)(name, *arguments)


def sized(rng, *starts):
    for count, start in enumerate(starts):
        ninputs, noutputs = rng.integers(3, 30, 2).tolist()
        yield "sizes", ninputs, noutputs if count else 2, start, [], []


same(counting, 4, made_up, name="counts_choices_that_start_anywhere")(sized, 0, 7, 5)
same(counting, 4, made_up, name="counts_numbers_of_an_action")(sized, -1, -1, -1)

acting = exercise.task("2.4", "From outputs to an action")
TOGETHER = {"changes": "the numbers of outputs, limits and choices belong together"}


def acted(module, outputs, space):
    """[act(y, space) for y in {0}], with the space {1},"""
    import numpy
    from gymnasium import spaces

    if "n" in space:
        made = spaces.Discrete(**space)
    else:
        made = spaces.Box(*(numpy.float32(space[side]) for side in ("low", "high")))
    return [[module.act(y, made) for y in outputs], outputs]


def actions_of(answer, outputs, space):
    actions, after = answer
    return {
        "the list of actions": np.array(actions, dtype=float),
        "whether all are ints": "n" not in space or all(type(each) is int for each in actions),
        "the outputs, afterwards,": after,
    }


@same(acting, 5, acted, view=actions_of, off=TOGETHER)
def most_active_output_decides(rng):
    for n in (4, 2, 6):
        equal, close = rng.choice([-0.5, 0.25], (5, n)), 0.5 + 1e-4 * np.arange(n)[None]
        below_zero, random = np.sort(-rng.random((2, n))), rng.uniform(-1, 1, (20, n))
        for outputs in (random, equal, np.full((1, n), 0.2), below_zero, close):
            yield outputs, {"n": n, "start": 0}


@same(acting, 2, acted, view=actions_of, off=TOGETHER)
def choices_may_start_elsewhere(rng):
    for start in (5, -2, 10):
        yield rng.uniform(-1, 1, (10, 4)), {"n": 4, "start": start}


@same(acting, 7, acted, 1e-5, view=actions_of, off=TOGETHER)
def outputs_are_stretched(rng):
    for limit in (2.0, 0.4):
        for outputs in (rng.uniform(-1, 1, (3, 1)), np.array([[-1.0], [0.0], [1.0]])):
            yield outputs, {"low": [-limit], "high": [limit]}
    for size in (2, 3, 5):  # each number has limits of its own
        low, width = np.round([rng.uniform(-3, 3, size), rng.uniform(1, 5, size)], 2)
        limits = {"low": low.tolist(), "high": (low + width).round(2).tolist()}
        yield rng.uniform(-1, 1, (4, size)), limits


episodes = exercise.task("2.5", "An episode", needs=("2.2", "2.4"))


def episode_of(answer, *_):
    actions, total = expect_fields("the answer", answer, "actions", "return")
    actions = np.array(actions, dtype=float)
    return {"the number of actions": len(actions), "actions": actions, "return": total}


def lived(rng, name, *maxsteps, seed=None):
    seed = seed_of(rng) if seed is None else seed
    return name, network_of(rng, *LAYERS[name]), seed, *maxsteps


@same(episodes, 6, "run_episode", 1e-3, view=episode_of, parts=("the number of actions", "actions"))
def discrete_actions(rng):
    for cart, acrobot, seed in ((200, 80, None), (100, 20, 0)):
        yield lived(rng, "CartPole-v1", cart, seed=seed)
        yield lived(rng, "Acrobot-v1", acrobot, seed=seed)


@same(episodes, 5, "run_episode", 1e-3, view=episode_of, parts=("the number of actions", "actions"))
def continuous_actions(rng):
    """Ended by maxsteps, by the environment's time limit, and by the default of maxsteps."""
    yield from (lived(rng, "Pendulum-v1", n, seed=0) for n in (20, 30))
    yield lived(rng, "Pendulum-v1", 300)
    yield from (lived(rng, "MountainCarContinuous-v0", *n) for n in ([50], [15], [], []))


@same(episodes, 5, "run_episode", 1e-3, view=episode_of, parts=("return",))
def sums_the_rewards(rng):
    for name, maxsteps in zip(LAYERS, (200, 80, 50, 300), strict=True):
        yield lived(rng, name, maxsteps)
        yield lived(rng, name, 10)


measuring = exercise.task("2.6", "Fitness", seconds=30, needs=("2.5",))


def seeded(rng, name, count, *maxsteps, twice=False):
    seeds = rng.integers(2**31, size=count).tolist()
    return name, network_of(rng, *LAYERS[name]), seeds + seeds[:twice], *maxsteps


@same(measuring, 5, "fitness", 1e-6)
def mean_of_whole_returns(rng):
    yield seeded(rng, "CartPole-v1", 10)
    yield seeded(rng, "Acrobot-v1", 4, 60)
    for count in (3, 7, 9):
        yield seeded(rng, "CartPole-v1", count, 40)
    yield seeded(rng, "CartPole-v1", 2, 100, twice=True)
    yield seeded(rng, "Acrobot-v1", 1, 30)


@same(measuring, 5, "fitness", 1e-3)
def mean_of_other_returns(rng):
    for name in CONTINUOUS:
        yield seeded(rng, name, 2, 15, twice=True)
        yield seeded(rng, name, 5)
    for count, maxsteps in ((3, 60), (2, 260)):
        yield seeded(rng, "Pendulum-v1", count, maxsteps)


batching = exercise.task("2.7", "Many networks at once")
NO_CUTS = dict.fromkeys(("square", "one"), "networks and observations are of one number")


def stacked(rng, *sizes, **options):
    for n, *layers in sizes:
        yield network_of(rng, *layers, many=(n,), **options), rng.normal(size=(n, layers[0]))


same(batching, 7, "forward_batch", 1e-4, off=NO_CUTS, name="equals_each_network_alone")(
    stacked, (3, 4, 5, 2), (7, 4, 5, 2), (50, 3, 10, 1), (300, 6, 5, 3)
)


def kept(module, networks, observations):
    """forward_batch(networks, observations), before another call,"""
    answer = module.forward_batch(networks, observations)
    module.forward_batch(networks, observations + 1)
    return answer


@same(batching, 2, kept, 1e-4)
def few_and_square(rng):
    yield from stacked(rng, (1, 4, 5, 2), (4, 4, 4, 4), (5, 1, 1, 1), (6, 3, 4, 1))
    yield from stacked(rng, (3, 4, 5, 2), weights=3000)


def timed(module, n, seed, looped):
    """Outputs of many networks, which are drawn here because they would be too many to send."""
    import numpy

    rng = numpy.random.default_rng(seed)
    shapes = {"W1": (n, 5, 4), "b1": (n, 5), "W2": (n, 2, 5), "b2": (n, 2)}
    networks = {key: rng.random(shape, dtype=numpy.float32) for key, shape in shapes.items()}
    observations = rng.random((n, 4), dtype=numpy.float32)
    if not looped:
        return module.forward_batch(networks, observations)
    each = ({key: stack[i] for key, stack in networks.items()} for i in range(n))
    return numpy.array([module.forward(e, o) for e, o in zip(each, observations, strict=True)])


@batching.check(3)
def is_quicker_than_a_loop(student: Student):
    n, loop, batch = 20_000, np.inf, np.inf
    said = f"forward_batch(...) for {n} networks"
    for repeat in range(3):
        seed = exercise.seed(82 + repeat)
        ours = exercise.ours.answer(timed, (n, seed, True))
        before = student.seconds_left
        got = expect_array(said, student.run(timed, n, seed, False, said=said), (n, 2))
        loop, batch = min(loop, ours.seconds), min(batch, before - student.seconds_left)
        expect(np.allclose(got, ours.value, rtol=0, atol=1e-4), f"{said}: some outputs are wrong.")
    said = f"{said} takes {batch:.2f} s, a loop over the networks {loop:.2f} s; less than half is"
    expect(batch < loop / 2, f"{said} asked for. A list comprehension is a loop, too.")


searching = exercise.task("2.8", "The luckiest network", seconds=40, needs=("2.1", "2.3", "2.6"))


def searched(module, name, nnetworks, seed, layers):
    """random_search({0}, {1}, nhiddens=5, seed={2})"""
    own = [module.parameters(*layers, each) for each in range(seed, seed + nnetworks)]
    return [module.random_search(name, nnetworks, 5, seed), own]


def report_of(answer, name, nnetworks, seed, layers):
    """The report, without what is due to the random numbers of the submission."""
    report, own = answer
    networks, values = expect_fields("the answer", report, "networks", "fitness")
    seeds = list(range(seed, seed + 10))
    ours = [exercise.ours.answer("fitness", (name, each, seeds)).value for each in own]
    equal = [all(np.array_equal(a[k], b[k]) for k in b) for a, b in zip(networks, own, strict=True)]
    return {
        "the number of networks that have the parameters of seed + i": sum(equal),
        "fitness, divided by that of parameters(..., seed + i),": np.divide(values, ours),
    }


def search(rng, name, nnetworks):
    return name, nnetworks, seed_of(rng), list(LAYERS[name])


@same(searching, 6, searched, 1e-4, view=report_of)
def measures_every_network_in_every_problem(rng):
    for count, name in zip((3, 1, 1, 1), LAYERS, strict=True):
        yield search(rng, name, count)
    yield search(rng, "CartPole-v1", 3)  # with another seed


def best_of(answer, *_):
    values, best = expect_fields("the answer", answer, "fitness", "best")
    return {
        "the number of values of fitness": len(values),
        "whether best is an int": type(best) is int,
        "best, minus the number of the highest fitness,": best - np.argmax(values),
    }


@same(searching, 1, made_up, view=best_of, off={"changes": "two choices have two rewards"})
def of_equals_the_lowest(rng):
    """Each choice has a reward of its own, so many returns are equal."""
    for rewards in ([-4e7, -3e7], [300.0, 400.0], [-400.0, -300.0]) * 3:
        yield "random_search", 2, 2, 0, [12, 4, seed_of(rng)], rewards


@same(searching, 3, searched, view=lambda answer, *_: best_of(answer[0]))
def finds_the_best(rng):
    yield search(rng, "CartPole-v1", 6)
    yield search(rng, "MountainCarContinuous-v0", 2)
