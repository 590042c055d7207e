"""Grader of exercise 3; run it with `botschool grade 3`.

Tasks 3.1 and 3.3 to 3.5 draw random numbers as they like, so views of the answers are compared.

Stochastic checks (task 3.7): two seeds, a third one if just one of them is good enough, and 20
unseen episodes a controller, on robots with secret gains. Margins are those of 20 seeds:

- CartPole-v0 needs a mean of 195: the solution reaches 200.0 (margin 5 steps), 3 % of random
  controllers reach 195.
- Pendulum-v1 needs a mean of -600. The solution reaches -201 to -117 (margin 399), but -633 with
  one of some hundreds of other seeds. Random controllers reach -1160 +- 90; the best of 6000,
  chosen with 5 and the best 20 again with 20 episodes, -990 to -750.
"""

from functools import partial
from itertools import pairwise

import numpy as np

from botschool.grading import Exercise, Student, expect, expect_array, same, seed_of
from botschool.grading.declare.rows import in_common, noise_of, same_rows
from botschool.grading.run.rewiring import Disguised

exercise = Exercise(3, "Evolution strategy", file="evolution_strategy.py")
TOOL = ("botschool.evolution.algorithms.sss:SSS.tell",)


initial = exercise.task("3.1", "The initial population")


def parts_of(answer, popsize, nbiases, nweights, seed):
    """What is known of a population of random numbers."""
    population = expect_array("the population", answer, (popsize, nbiases + nweights))
    weights, many = population[:, nbiases:], popsize * nweights > 10_000
    return {
        "the number of biases that are not 0": np.count_nonzero(population[:, :nbiases]),
        "the number of weights that are 0": weights.size - np.count_nonzero(weights),
        "the number of different weights": len(np.unique(weights)),
        "10 times the weights' standard deviation": 10 * weights.std() if many else 1.0,
        "10 times the weights' mean": 10 * weights.mean() if many else 0.0,
        "whether 4.6 % are beyond 0.2": not many or 0.03 < np.mean(abs(weights) > 0.2) < 0.06,
        "whether the numbers are fitted to deviation and mean": many and fitted(weights / 0.1),
    }


def fitted(numbers):
    """Whether all numbers, or those of each row or column, have exactly the deviation 1 or mean 0.

    Single precision computes it to 1e-6; of numbers as they are drawn, 3 of 10,000 are so near.
    """
    found = []
    for axis, near in ((None, 2e-7), (0, 1e-5), (1, 1e-5)):
        spreads = [numbers.std(axis=axis, ddof=ddof) - 1 for ddof in (0, 1)]
        found += [np.abs(each).max() < near for each in (*spreads, numbers.mean(axis=axis))]
    return any(found)


def populations(rng, *sizes):
    for each in sizes:
        yield *each, seed_of(rng)


def shape_of(answer, *_):
    return list(np.shape(answer))


SIZES, FEW, MANY = ((1, 2, 9), (6, 2, 9), (20, 7, 65)), ((12, 5, 30), (12, 2, 30)), (100, 0, 500)
at_first = partial(same, initial, what="initial_population")
at_first(3, view=shape_of, name="has_one_row_per_individual")(populations, *SIZES)
at_first(5, view=parts_of, name="zeros_and_random_weights")(populations, *FEW)
at_first(4, tolerance=0.04, view=parts_of, name="weights_are_gaussian")(populations, MANY)


def drawn(module, popsize, seed):
    """initial_population({0}, 2, 9, seed), for seeds {1}, 0 and others"""
    import numpy

    def make(seed):
        return numpy.array(module.initial_population(popsize, 2, 9, seed), dtype=float)

    first = module.initial_population(popsize, 2, 9, seed)
    before = numpy.array(first, dtype=float)
    if isinstance(first, numpy.ndarray) and first.flags.writeable:
        first += 1
    return [before, *(make(each) for each in (seed, 0, 0, seed + 1, seed + 2, seed + 10))]


def seeds_in_common(answer, popsize, seed):
    one, again, zero, zero_again, *others = answer
    near = in_common(one[one.any(axis=1)], np.concatenate(others))  # rows of zeros are all alike
    return {
        "whether the same seed gives the same again": bool(in_common(one, again) == popsize),
        "whether seed 0 gives the same again": np.array_equal(zero, zero_again),
        "the number of individuals that neighbouring seeds have in common": near,
    }


@same(initial, 3, drawn, view=seeds_in_common)
def seed_decides(rng):
    yield 4, seed_of(rng)
    yield 40, seed_of(rng)


ranking = exercise.task("3.2", "Ranking")


@same(ranking, 6, "rank")
def best_comes_first(rng):
    for size in (3, 10, 21):
        small, large = rng.normal(size=size), rng.permutation(size) - 4
        # the last but one are equal in single precision, and to many digits
        yield from (small, 1e9 * large, -3e9 - 1e8 * (large + 4), 7 + 1e-10 * small, small[:2])


@same(ranking, 4, "rank")
def equals_keep_their_order(rng):
    yield np.array([1.0, 2.0, 2.0, 1.0])
    yield np.full(6, -5.0)
    yield rng.integers(-2, 3, size=60).astype(float)
    yield rng.integers(0, 3, size=90).astype(float)


following = exercise.task("3.3", "The next population", needs=("3.2",), refused=TOOL)
ZEROS = 8  # parameters that are 0 in the whole population, as all biases are at first


def steps(module, population, fitness, mutrate, seed):
    """next_population({0}, {1}, {2}, rng)"""
    import numpy

    rng, before, same = numpy.random.default_rng(seed), population.copy(), fitness.copy()
    after = [module.next_population(population, fitness, mutrate, rng)]
    unchanged = [bool((population == before).all()), bool((fitness == same).all())]
    for each in (rng, numpy.random.default_rng(seed)):
        after.append(module.next_population(before.copy(), same.copy(), mutrate, each))
    return [numpy.array(each, dtype=float) for each in after], unchanged


def changes_of(answer, population, fitness, mutrate, seed):
    (after, later, again), unchanged = answer
    after = expect_array("the new population", after, population.shape)
    top = fitness > np.median(fitness)
    better, worse = population[top], population[~top]
    noise, parents = noise_of(after, better)
    again_added = in_common(noise, noise_of(later, better)[0])
    sizes = np.abs(after)
    limited = (sizes == sizes.max()).any(axis=0).sum() > 2 and sizes.max() > 0
    found = {
        "the number of individuals of the better half that stay": in_common(better, after),
        "the number of individuals of the worse half that stay": in_common(worse, after),
        "the numbers of copies": np.bincount(parents, minlength=len(better)),
        "whether nothing limits the parameters": not limited,
        "whether an equal generator gives the same": np.allclose(after, again),
        "the rows of noise that the next call adds again": again_added,
        "whether population and fitness stay as they were": list(unchanged),
    }
    if noise.size > 1000:
        noise = noise / mutrate
        few = len(np.unique(np.abs(noise).round(6))) < 0.95 * noise.size
        beyond = np.mean(np.abs(noise) > 2)
        found |= {
            "the deviation of the copies' noise, divided by mutrate,": noise.std(),
            "its mean, divided by mutrate,": noise.mean(),
            "the share of parameters without noise": np.mean(noise == 0),
            "whether the first parameters, which are 0, get noise": noise[:, :ZEROS].any(),
            "whether each parameter of each copy gets a number of its own": not few,
            "whether 4.6 % of the noise is beyond 2 * mutrate": bool(0.025 < beyond < 0.07),
        }
    return found


def steps_of(rng, *of):
    for popsize, mutrate, scale, many in of:
        population = scale * rng.normal(size=(popsize, many))
        population[:, :ZEROS] = 0
        yield population, rng.permutation(popsize) - 3.5, mutrate, seed_of(rng)


CHOSEN = (2, 0.02, 1, 40), (6, 0.02, 1, 40), (10, 0.02, 100, 40), (10, 0.02, 1, 40)
same(following, 8, steps, view=changes_of, name="better_half_stays_and_is_copied")(
    steps_of, *CHOSEN
)


def who_stays(answer, population, fitness, mutrate, seed):
    after = expect_array("the new population", answer[0][0], population.shape)
    stay = same_rows(after, population).any(axis=0)
    return {
        "the number of individuals that stay": int(stay.sum()),
        "the number of rows that hold them": in_common(after, population),
        "the sum of their fitness": float(fitness[stay].sum()),
    }


@same(following, 3, steps, view=who_stays)
def equal_fitness(rng):
    """Whoever of equals stays, half of the population does, and nobody worse than a loser."""
    for values in ([200.0], [-1.0, -2.0], [0.0, 7.0, 200.0]):
        yield rng.normal(size=(12, 40)), rng.choice(values, size=12), 0.1, seed_of(rng)


WIDE = (60, 0.02, 1, 600), (60, 0.3, 6, 600), (60, 1.5, 30, 600)
same(following, 6, steps, 0.05, view=changes_of, name="noise_is_gaussian")(steps_of, *WIDE)

loop = exercise.task("3.4", "The loop", needs=("3.2", "3.3"), refused=TOOL)


def evolved(module, name, population, generations, mutrate, seed, least):
    """{0}(evaluate, population, generations={2}, mutrate={3}, seed={4})"""
    import numpy

    calls, before = [], population.copy()
    target = numpy.linspace(-1, 1, population.shape[-1])

    def evaluate(population, seed):
        population = numpy.array(population, dtype=float)
        calls.append([population, seed])
        return -((population - target) ** 2).mean(axis=1) + seed * 37 % 11 + least

    run = getattr(module, name)(evaluate, population, generations, mutrate, seed)
    return [run, calls, bool(numpy.array_equal(population, before))]


def run_of(answer, population, least):
    """The run's report, all populations, and fitness: minus distances, plus a generation's luck."""
    run, calls, _ = answer
    shape = (2, len(population)) if population.ndim == 1 else population.shape
    given = [expect_array("a population", each, shape) for each, _ in calls]
    target, seeds = np.linspace(-1, 1, shape[1]), [seed for _, seed in calls]
    distance = np.reshape(((np.array(given) - target) ** 2).mean(axis=-1), (len(given), shape[0]))
    fitness = np.reshape([seed * 37 % 11 + least for seed in seeds], (-1, 1)) - distance
    return run, [*given, expect_array("population", run["population"], shape)], fitness


def report(answer, name, population, generations, mutrate, seed, least):
    seeds = [each for _, each in answer[1]]
    if seeds != list(range(seed, seed + generations)):
        return {"the seeds of evaluate": seeds}
    run, populations, fitness = run_of(answer, population, least)
    scale = 1 + np.abs(highest := fitness.max(axis=1)).max()
    good = np.argwhere(fitness >= highest.max() - 1e-6 * scale)
    best = expect_array("best", run["best"], populations[0].shape[1:])
    history = expect_array("history", run["history"], (generations,))
    apart = min(np.abs(populations[g][i] - best).max() for g, i in good)
    return {
        "the seeds of evaluate": seeds,
        "the first population": populations[0],
        "history, minus the highest fitness of each generation,": (history - highest) / scale,
        "fitness, minus the highest of all,": (float(run["fitness"]) - highest.max()) / scale,
        "the difference of best from the individual with the highest fitness": apart,
        "whether the first population stays as it was": answer[2],
    }


def lineage(answer, name, population, generations, mutrate, seed, least):
    """How each population follows from the one before."""
    _, populations, fitness = run_of(answer, population, least)
    lost, far, again, noises = 0, 0, 0, []
    for g, (before, after) in enumerate(pairwise(populations)):
        better = before[np.argsort(-fitness[g])[: len(before) // 2]]
        noise, _ = noise_of(after, better)
        lost += len(better) - in_common(better, after)
        far += int((np.abs(noise) > 7 * mutrate).any(axis=1).sum())
        again += in_common(noise, noises[-1]) if noises else 0
        noises.append(noise)
    found = {
        "the individuals of a better half that are lost": lost,
        "the numbers of new individuals": [len(noise) for noise in noises],
        "the new individuals that are no mutated copies of the better half": far,
        "the rows of noise that come again in the next generation": again,
    }
    if len(populations[0]) == 2 and sum(map(np.size, noises)) > 5000:  # so the parent is known
        for when, some in (("first", noises[: len(noises) // 3]), ("the end", noises[-20:])):
            deviation = np.std(np.concatenate(some)) / mutrate
            found[f"the deviation of the noise at {when}, divided by mutrate,"] = deviation
    return found


def runs(rng, name, *of):
    for shape, generations, mutrate, least in of:
        yield name, rng.normal(size=shape), generations, mutrate, seed_of(rng), least


LEAST = ((5, -1e5), (5, -3e4), (5, 200.0), (5, 1e4), (12, 0.0), (15, -100.0))  # by generations
REPORTED = [((10, 8), generations, 0.1, least) for generations, least in ((1, -100.0), *LEAST)]
same(loop, 12, evolved, 1e-6, view=report, name="evaluates_and_reports")(runs, "evolve", *REPORTED)


def seeded(module, name, population, seed):
    """{0}(evaluate, population, generations=3, mutrate=0.1, seed), for seeds {2}, 0 and others"""
    import numpy

    def populations(seed):
        seen = []

        def evaluate(population, seed):
            seen.append(numpy.array(population, dtype=float))
            return -(numpy.array(population) ** 2).sum(axis=1)

        getattr(module, name)(evaluate, population.copy(), 3, 0.1, seed)
        return seen

    return [populations(each) for each in (seed, seed, 0, 0, seed + 1, seed + 11)]


def noise_in_common(answer, name, population, seed):
    runs = np.array([run[:3] for run in answer])
    one, after, other = (
        [noise_of(b, a[np.argsort((a**2).sum(axis=1))[: len(a) // 2]])[0] for a, b in pairwise(run)]
        for run in (runs[0], runs[4], runs[5])
    )
    of_another, earlier = np.concatenate([after[0], other[0]]), in_common(one[1], after[0])
    return {
        "whether the same seed gives the same again": np.allclose(runs[0], runs[1], 0, 1e-6),
        "whether seed 0 gives the same again": np.allclose(runs[2], runs[3], 0, 1e-6),
        "the copies of generation 1 that another seed gives, too": in_common(one[0], of_another),
        "the copies' noise that the next seed has one generation earlier": earlier,
    }


def start(rng, name, shape):
    yield name, rng.normal(size=shape), seed_of(rng)


PAIRS = ((2, 200), 60, 0.02, 0.0), ((2, 250), 60, 0.4, 0.0)
FOLLOWED = ((10, 8), 6, 0.1, 0.0), ((6, 12), 20, 0.3, 0.0), *PAIRS
same(loop, 4, seeded, view=noise_in_common, name="seed_decides_the_noise")(start, "evolve", (10, 8))
same(loop, 4, evolved, 0.05, view=lineage, name="selects_and_varies")(runs, "evolve", *FOLLOWED)

climber = exercise.task("3.5", "A hill climber", needs=("3.4",), refused=TOOL)
CLIMB, SHORT, LONG = "hill_climb", (5, 1, 0.3, -100.0), (5, 15, 0.3, -100.0)
CLIMBS = LONG, (200, 60, 0.1, 0.0), (250, 60, 0.02, 0.0)
same(climber, 5, evolved, 0.05, view=lineage, name="never_steps_down")(runs, CLIMB, *CLIMBS)
same(climber, 2, evolved, 1e-6, view=report, name="reports_like_evolve")(runs, CLIMB, SHORT, LONG)
same(climber, 1, seeded, view=noise_in_common, name="seed_decides_the_climb")(start, CLIMB, 5)


replications = exercise.task("3.6", "Replications")


def replicated(module, histories, seeds):
    """replicate(experiment, {1})"""
    asked, before = [], list(seeds)

    def experiment(seed):
        asked.append(int(seed))
        row = before.index(seed) if seed in before else 0
        history = [float(value) for value in histories[row]]
        return {"history": history, "fitness": max(history), "best": None, "population": None}

    result = module.replicate(experiment, seeds)
    found = {"the seeds of experiment, in rising order,": sorted(asked)}
    return found | {"the list of seeds, afterwards,": seeds} | result


def curves(rng, n, least):
    # multiples of 1/1024: single precision loses nothing where two curves are close together
    histories = np.round(1024 * rng.normal(size=(n, 15))) / 1024 + least
    return histories, [int(seed) for seed in rng.permutation(50)[:n]]


def several(rng, *of):
    for n, least in of:
        yield curves(rng, n, least)


ASKED = ("the seeds of experiment, in rising order,", "the list of seeds, afterwards,")
DEVIATION = (*ASKED, "deviation")
MEANS = (*ASKED, "mean", "best")
same(replications, 5, replicated, parts=MEANS, name="mean_and_best")(several, (6, 0), (6, -100))
same(replications, 4, replicated, parts=DEVIATION, name="deviation")(several, (5, 0), (5, -100))
ONE = "a_single_replication"
same(replications, 1, replicated, parts=DEVIATION[2:], name=ONE)(several, (1, 0), (2, 0))


training = exercise.task("3.7", "CartPole and Pendulum", seconds=90, needs=("3.1", "3.2", "3.4"))


def expect_trained(student: Student, environment: str, index: int, wanted: float) -> None:
    """Two of two or three seeds, on a robot whose parameters have gains of either sign."""
    robot, found, means = Disguised(environment, exercise.seed(index)), [], []
    seeds = [seed_of(robot.rng) for _ in range(3)]

    def train(seed):
        said = f"train({environment!r}, seed={seed})"
        return robot.trained(student, "train", environment, seed, said=said)

    for seed in seeds:
        if len(means) < 2 or sum(mean >= wanted for mean in means) == 1:
            found.append(train(seed))
            means += robot.means(found[-1:], seed_of(robot.rng), 20).tolist()
    said, (one, other, *_) = student.said, found
    expect(
        sum(mean >= wanted for mean in means) > 1,
        f"{said} should return a controller that reaches {wanted} on average over 20 new episodes, "
        f"for two seeds; its means are {np.round(means, 1).tolist()}, on a robot whose parameters "
        "count with other signs and sizes.",
    )
    likeness = float(one @ other / np.sqrt((one @ one) * (other @ other)))
    expect(likeness < 0.8, f"{said}: another seed gives nearly the same parameters.")
    if environment == "CartPole-v0":
        student.stop()
        equal = np.array_equal(train(seeds[0]), one)
        expect(equal, f"{student.said}, called again, gives other parameters.")


@training.check(10)
def keeps_the_pole_up(student: Student):
    expect_trained(student, "CartPole-v0", 20, 195)


@training.check(10)
def swings_up(student: Student):
    expect_trained(student, "Pendulum-v1", 22, -600)
