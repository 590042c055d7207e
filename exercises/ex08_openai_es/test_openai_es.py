"""Grader of exercise 8; run it with `botschool grade 8`.

Tasks 8.1 to 8.7 compare with our solution. Task 8.8 is evolved with secret signs of the parameters,
so that none can be written down.

Stochastic checks (task 8.8; the mean over 100 episodes that the submission has not seen, with one
of three seeds of the grader's): CartPole-v0 at least 195, Pendulum-v1 at least -400. Over 20 seeds
the solution reaches 200 of 200 with every one, and -215 to -145.
"""

from functools import partial

import numpy as np

from botschool.course import Robot
from botschool.grading import Exercise, Student, expect, expect_array, same
from botschool.grading.declare.libraries import OPENAI_ES
from botschool.grading.run.rewiring import found_in

exercise = Exercise(8, "OpenAI-ES", file="openai_es.py")
SIZES = ((1, 1), (3, 2), (20, 37))
"""Of samples and parameters."""

sampling = exercise.task("8.1", "Symmetric sampling", refused=OPENAI_ES)


@same(sampling, 8, "candidates_around")
def candidates_on_both_sides(rng):
    for samplesize, n in SIZES:
        noise = round(float(rng.uniform(0.01, 0.5)), 3)
        yield rng.normal(size=n), rng.normal(size=(samplesize, n)), noise


@same(sampling, 2, "candidates_around")
def few_candidates(rng):
    yield rng.normal(size=5), rng.normal(size=(4, 5)), 0.1


ranks = exercise.task("8.2", "Utilities", refused=OPENAI_ES)


@same(ranks, 8, "utilities")
def centred_ranks(rng):
    for size in (2, 5, 40):
        yield np.round(rng.normal(size=size) * 100, 2)
    yield np.array([10, 40, 20, 30, 0])
    yield rng.permutation(7) - 3
    # hardly apart, and far apart
    yield rng.permutation([-1e-4, 2e-4, 0.3, 0.4])
    yield -rng.permutation([1.0, 1e3, 1e6, 1e9])
    yield rng.permutation(np.linspace(-0.003, 0.004, 5))


@same(ranks, 4, "utilities")
def equals_in_their_order(rng):
    yield np.array([1.0, 2.0, 2.0, 1.0])
    yield np.full(6, 9.0)
    yield np.full(3, -2.0)
    yield rng.integers(0, 4, 40).astype(float)


direction = exercise.task("8.3", "The gradient", refused=OPENAI_ES)


@same(direction, 8, "gradient")
def weighted_samples(rng):
    for samplesize, n in SIZES:
        utilities = rng.permutation(np.linspace(-0.5, 0.5, 2 * samplesize))
        yield rng.normal(size=(samplesize, n)), utilities


@same(direction, 4, "gradient")
def many_samples(rng):
    yield rng.normal(size=(3000, 6)), rng.permutation(np.linspace(-0.5, 0.5, 6000))


decay = exercise.task("8.4", "Weight decay", refused=OPENAI_ES)


def slopes(rng, wdecay):
    for n in (6, 1, 60):
        gradient, centre = 0.02 * rng.normal(size=n), rng.normal(size=n)
        centre[n // 2] = 0.0
        if n == 6:  # all pairs of signs
            gradient = np.abs(gradient) * (1, -1, 1, -1, 1, -1)
            centre = np.abs(centre) * (1, 1, -1, 1, -1, -1)
        yield gradient, centre, wdecay


same(decay, 2, "descent", name="no_decay")(slopes, 0)
same(decay, 4, "descent", name="decay_in_proportion")(slopes, 1)
same(decay, 4, "descent", name="decay_by_sign")(slopes, 2)

optimiser = exercise.task("8.5", "Adam", refused=OPENAI_ES)
adam = partial(same, tolerance=1e-7, parts=("the new centre", "the new m", "the new v"))


def step(rng, n, t):
    d = rng.uniform(0.05, 2, n) * rng.choice([-1, 1], n)
    m, v = (np.zeros(n), np.zeros(n)) if t == 1 else (rng.normal(size=n), rng.uniform(0.1, 2, n))
    return rng.normal(size=n), d, m, v, t, round(float(rng.uniform(0.01, 0.2)), 3)


@adam(optimiser, 6, "adam")
def first_step(rng):
    yield step(rng, 1, 1)
    yield step(rng, 30, 1)


@adam(optimiser, 7, "adam")
def later_steps(rng):
    for n, t in ((3, 2), (30, 10), (8, 500)):
        yield step(rng, n, t)


@adam(optimiser, 1, "adam")
def late_steps(rng):
    yield step(rng, 12, 50_000)


@adam(optimiser, 2, "adam")
def where_hardly_anything_slopes(rng):
    """The 1e-8 counts: once from nothing, once with a past."""
    d = np.array([0.0, 1e-8, -3e-8, 2e-7, 0.0])
    yield rng.normal(size=5), d, 0 * d, 0 * d, 2, 0.1
    yield rng.normal(size=5), d, 0.5 * d, d**2, 40, 0.1


whole = exercise.task(
    "8.6", "The whole algorithm", needs=("8.1", "8.2", "8.3", "8.4", "8.5"), refused=OPENAI_ES
)


def evolved(module, centre, target, generations, seed, options, decimals):
    """evolve(evaluate, centre, {2}, seed={3}, **{4})"""
    import numpy

    seeds, seen = [], {}

    def evaluate(candidates, seed):
        seen[f"the candidates of generation {len(seeds)}"] = numpy.array(candidates, dtype=float)
        seeds.append(seed)
        goal = target + 0.3 * numpy.sin(seed + numpy.arange(len(target)))
        return numpy.round(-numpy.abs(candidates - goal).sum(axis=1), decimals)

    module.evolve(evaluate, centre + 1, 2, seed + 5)  # what it leaves behind must not count
    seeds.clear()
    seen.clear()
    answer = module.evolve(evaluate, centre, generations, seed, **options)
    found = {"the seeds of evaluate": seeds, **seen, "the first centre, afterwards,": centre}
    return found | {key: answer[key] for key in ("history", "centre")}


def run(rng, n, generations, decimals=15, **options):
    seed = int(rng.integers(100_000))
    return rng.normal(size=n), rng.normal(size=n), generations, seed, options, decimals


@same(whole, 6, evolved, 1e-5)
def one_generation(rng):
    yield run(rng, 6, 1, samplesize=5, noiseStdDev=0.1, stepsize=0.05)
    yield run(rng, 4, 0)


@same(whole, 7, evolved, 1e-5)
def many_generations(rng):
    yield run(rng, 3, 8, 1, samplesize=20, noiseStdDev=0.1, stepsize=0.02)  # many are equal
    yield run(rng, 5, 25, samplesize=9, noiseStdDev=0.2, stepsize=0.1, wdecay=2)
    yield run(rng, 8, 40, samplesize=6, noiseStdDev=0.1, stepsize=0.05, wdecay=1)


@same(whole, 2, evolved, 1e-5)
def hyperparameters_have_defaults(rng):
    yield run(rng, 10, 12)


curves = exercise.task("8.7", "How stable is it?")


@same(curves, 4, "smooth")
def smooths(rng):
    for length, width in ((8, 2), (60, 7), (12, 1), (9, 9)):
        yield np.round(rng.normal(size=length), 2), width
    yield np.array([1, 2, 6, 1]), 2
    yield rng.integers(-300, 300, 15), 4


def with_fall(rng, fall, recovers):
    """A rising curve, from any height to any other, that falls once by a share of its range."""
    low, height = rng.uniform(-2000, 100), rng.uniform(5, 1500)
    up, down = np.sort(rng.uniform(0, 0.8, 15)), np.linspace(0.8, 0.8 - fall, 6)
    up[0] = 0.0
    after = np.sort(rng.uniform(0.82, 1, 9)) if recovers else np.full(9, 0.8 - fall)
    return low + height * np.concatenate([up, down, after])


@same(curves, 4, "stability", parts=("drop",))
def drops(rng):
    yield from (with_fall(rng, fall, fall != 0.5) for fall in (0.2, 0.5, 0.07))
    yield np.round(rng.normal(size=50), 3)
    yield from map(np.array, ([0.0, 8, 6, 10], [5.0, 1], [3.0], [2, 10, 4, 9]))
    yield from (
        np.arange(5.0),
        np.full(6, 9.0),
        1e-6 * np.array([1.0, 5, 3, 6]),
        1e-5 * np.array([1.0, 4, 2, 3]),
    )


@same(curves, 3, "stability", parts=("peak", "bottom"))
def places_of_the_fall(rng):
    yield from (with_fall(rng, fall, fall != 0.5) for fall in (0.2, 0.5))
    yield np.round(rng.normal(size=50), 3)
    yield from map(np.array, ([1.0, 4, 4, 2, 3, 2, 9], [0.0, 5, 3, 6, 1], [-5.0, -1, -3, 2, 0]))
    yield from map(np.array, ([3.0, 3, 0, 4], [-9.0, -4, -9, -2, -7], np.arange(4.0)))
    yield np.full(3, -7.0)


@same(curves, 4, "stability", parts=("verdict",))
def verdicts(rng):
    yield from (np.arange(12.0), np.full(4, -500.0), np.array([5.0, 1]))
    # at the limits, which belong to the milder verdict
    yield from map(
        np.array, ([0.0, 10, 9, 10], [0.0, 1, 0, 10], [0.0, 3, 0, 10], [0.0, 30, 0, 100])
    )
    # none is 0.3 of the range: there rounding would decide
    falls = (0.0, 0.05, 0.09, 0.11, 0.2, 0.29, 0.31, 0.6, 0.8, 0.34, 0.16, 0.23, 0.45, 0.38)
    yield from (with_fall(rng, fall, i % 2 == 0) for i, fall in enumerate(falls))


training = exercise.task(
    "8.8", "CartPole and Pendulum", seconds=50, needs=("8.6",), refused=OPENAI_ES
)


FIRST = 40
"""Of the candidates: by them two trainings are compared."""


def expect_evolved(student: Student, environment: str, index: int, goal: float) -> None:
    """With one of three seeds the centre reaches the goal; the seed decides about the evolution.

    The grader evaluates the robot, whose parameters have secret signs.
    """
    robot, rng, means = Robot(environment), np.random.default_rng(exercise.seed(index)), []
    size = robot.nbiases + robot.nweights
    signs = rng.choice([-1.0, 1.0], size)

    def train(seed: int, enough: int = 0) -> tuple:
        """What it returns, and the first candidates; broken off when enough were evaluated."""
        said = f"train({environment!r}, seed={seed})"
        own = {"environment": environment, "gains": signs, "enough": enough}
        given = "train", environment, size, [environment, seed]
        answer = student.run(found_in, *given, said=said, robot=own)
        return answer, student.rewired.first(FIRST)

    while len(means) < 3 and max(means, default=-np.inf) < goal:
        answer, begun = train(seed := int(rng.integers(100_000)))
        said = student.said
        centre = expect_array(said, answer, (size,))
        rows = (signs * centre)[None]
        means.append(float(robot.evaluate(rows, exercise.seed(index + 1), episodes=100)[0]))
    expect(
        means[-1] >= goal,
        f"{said}: over 100 new episodes, the mean should be {goal:g}, but for three seeds it is "
        f"{np.round(means, 1).tolist()}.",
    )
    expect(len(begun), f"{said} evaluates no candidate.")
    for other in (seed, seed + 1):
        rows = train(other, 2 * FIRST)[1][None]
        near = np.abs(begun[:FIRST, None] - rows).max(axis=2, initial=0) < 1e-6
        same_ones = near.any(axis=1).mean() >= 0.5
        how = "the same seed should give the same" if other == seed else "another seed: other"
        expect(same_ones == (other == seed), f"{said}: {how} candidates.")


@training.check(5)
def keeps_the_pole_up(student: Student):
    expect_evolved(student, "CartPole-v0", 50, 195)


@training.check(5)
def swings_the_pendulum_up(student: Student):
    expect_evolved(student, "Pendulum-v1", 52, -400)
