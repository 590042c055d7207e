"""Grader of exercise 3; run it with `make test-ex3`.

Stochastic checks (task 3.7), each with two seeds (a third one if just one of them is good enough)
and 20 unseen episodes a controller, on robots whose parameters count with gains drawn in secret
(botschool.grading.run.rewiring). Margins are those of 20 seeds, each with gains of its own:

- CartPole-v0 needs a mean of at least 195. The solution reaches 200.0 with each (margin 5 steps).
  Of random controllers 3 % reach it too, so this part can also be had by luck.
- Pendulum-v1 needs a mean of at least -600. The solution reaches -201 to -117 (margin 399), but
  -633 with one of some hundreds of other seeds. Random controllers reach -1160 +- 90 with the
  weights of task 3.1 and -1500 +- 150 with weights of deviation 1; the best of 6000 of the latter,
  chosen with 5 and the best 20 again with 20 episodes, -990 to -750.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from botschool.course import Robot
from botschool.grading import (
    Exercise,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    show,
)

exercise = Exercise(3, "Evolution strategy", file="evolution_strategy.py")
TOOL = ("botschool.evolution.algorithms.sss:SSS.tell",)

# ------------------------------------------------------------------- 3.1
initial = exercise.task("3.1", "The initial population")


@initial.check(3)
def has_one_row_per_individual(student: Student):
    population = student.call("initial_population", 20, 7, 65, seed=exercise.seed(1))
    expect_array(student.said, population, (20, 72))
    population = student.call("initial_population", 6, 2, 9, seed=exercise.seed(1))
    expect_array(student.said, population, (6, 11))
    population = student.call("initial_population", 1, 2, 9, seed=exercise.seed(1))
    expect_array(student.said, population, (1, 11))


@initial.check(3)
def biases_are_zero(student: Student):
    answer = student.call("initial_population", 12, 5, 30, seed=3)
    population = expect_array(student.said, answer, (12, 35))
    expect(
        not isinstance(answer, np.ndarray) or answer.dtype.kind == "f",
        f"{student.said} returned an array that is not made of floats and cannot hold the "
        "fractions of the weights: make an array of floats.",
    )
    wrong = np.any(population[:, :5] != 0, axis=1) | np.any(population[:, 5:] == 0, axis=1)
    row, empty = int(wrong.argmax()), np.flatnonzero(~population.any(axis=1))
    why = ""
    if len(empty):
        why = (
            f"\n  Rows that hold nothing but zeros: {empty.tolist()}. A row should be an "
            "individual, and the biases should be the first columns."
        )
    expect(
        not wrong.any(),
        f"{student.said}: the first 5 values of each row are the biases and should be 0, and the "
        f"30 weights after them should not be 0; row {row} is {show(population[row])}.{why}",
    )


@initial.check(2)
def individuals_differ(student: Student):
    population = student.call("initial_population", 12, 2, 30, seed=5)
    population = expect_array(student.said, population, (12, 32))
    expect(
        len(np.unique(population[:, 2:])) == 12 * 30,
        f"{student.said}: some weights are equal, but each weight of each individual should be "
        "a random number of its own.",
    )


DEVIATIONS = {
    0.1**0.5: "Your value is about the root of 0.1, but 0.1 should be the standard deviation, "
    "not the variance.",
    0.01: "Your value is about 0.1 squared, but 0.1 itself should be the standard deviation.",
    200**-0.5: "Your value is about 1 / the root of the 200 weights, but it should be 0.1 for any "
    "number of weights.",
}


def slip_of(value: float, slips: dict[float, str]) -> str:
    """A sentence on the slip that leads to a measured value, or ""."""
    return next((f" {said}" for each, said in slips.items() if abs(value / each - 1) < 0.04), "")


def drawn_again(module, *arguments):
    """Whether a second population is as the first was before it was changed."""
    import numpy

    one = module.initial_population(*arguments)
    before = numpy.array(one)
    if isinstance(one, numpy.ndarray) and one.flags.writeable:
        one += 1
    return bool(numpy.array_equal(module.initial_population(*arguments), before))


@initial.check(4)
def weights_are_gaussian(student: Student):
    weights = student.call("initial_population", 100, 0, 200, seed=exercise.seed(2))
    weights = expect_array(student.said, weights, (100, 200))
    expect(bool(np.any(weights)), f"{student.said}: all weights are 0, but they should be random.")
    expect(
        bool(weights.min() < 0 < weights.max()),
        f"{student.said}: all weights that are not 0 have the same sign, but about half of the "
        "weights should be negative.",
    )
    expect(
        abs(weights.std() - 0.1) < 0.004,
        f"{student.said}: the weights have standard deviation {weights.std():.3f}, but it should "
        f"be 0.1.{slip_of(weights.std(), DEVIATIONS)}",
    )
    expect(
        abs(weights.mean()) < 0.005,
        f"{student.said}: the weights have mean {weights.mean():.3f}, but it should be near 0.",
    )
    beyond = float(np.mean(np.abs(weights) > 0.2))
    expect(
        0.03 < beyond < 0.06,
        f"{student.said}: {100 * beyond:.1f} % of the weights are below -0.2 or above 0.2, but of "
        "Gaussian numbers with standard deviation 0.1 it should be about 4.6 %.",
    )


@initial.check(3)
def seed_decides(student: Student):
    one = student.call("initial_population", 4, 2, 9, seed=exercise.seed(3))
    expect_array(student.said, one, (4, 11))
    again = student.call("initial_population", 4, 2, 9, seed=exercise.seed(3))
    expect(
        np.array_equal(one, again),
        f"{student.said} gives other numbers when called again, but the same seed should give the "
        "same population.",
    )
    zero, again = (student.call("initial_population", 4, 2, 9, seed=0) for _ in range(2))
    expect(
        np.array_equal(zero, again),
        f"{student.said} gives other numbers when called again, but 0 is a seed like any other.",
    )
    other = student.call("initial_population", 4, 2, 9, seed=exercise.seed(3) + 1)
    other = expect_array(student.said, other, (4, 11))
    expect(
        not np.array_equal(one, other),
        f"{student.said} gave the same numbers as another seed, but each seed should give numbers "
        "of its own.",
    )
    one = student.call("initial_population", 40, 2, 9, seed=exercise.seed(3))
    one = expect_array(student.said, one, (40, 11))
    one = one[one.any(axis=1)]  # rows of zeros are all alike, whatever the seed
    for later in (1, 2, 10):
        other = student.call("initial_population", 40, 2, 9, seed=exercise.seed(3) + later)
        expect(
            not same_rows(expect_array(student.said, other, (40, 11)), one).any(),
            f"{student.said} holds at least one individual of the population of "
            f"seed={exercise.seed(3)}, but two seeds should have no individual in common.",
        )
    said = "initial_population(4, 2, 9, seed=1), after the array of an earlier call was changed,"
    expect(
        student.run(drawn_again, 4, 2, 9, 1, said=said) is True,
        f"{said} gives another population, but it should give the same one: make a new array in "
        "every call.",
    )


# ------------------------------------------------------------------- 3.2
ranking = exercise.task("3.2", "Ranking")


def mistaken_ranking(fitness, order) -> dict:
    """What mistakes make of the order of individuals; order: the student's."""
    fitness = np.asarray(fitness)
    rising, stable = np.argsort(fitness), np.argsort(fitness, kind="stable")
    falling = np.argsort(-fitness, kind="stable")
    order = np.asarray(order)
    complete = np.array_equal(np.sort(order, axis=None), np.arange(len(fitness)))
    only_equals = complete and np.array_equal(fitness[order.astype(int)], fitness[falling])
    return {
        "The worst comes first, but the best should come first.": (
            rising if np.array_equal(rising, order) else stable
        ),
        "Of equals, the one with the higher number comes first, but the one with the lower number "
        "should.":
        stable[::-1],
        "These are the places of the individuals in the ranking, but their numbers, the best "
        "first, are asked for.":
        np.argsort(np.argsort(-fitness, kind="stable"), kind="stable"),
        "Equals do not always stay in their order: np.argsort keeps it only with kind='stable'.":
        np.argsort(-fitness),
        "Equals do not stay in the order in which they stand, but the one with the lower number "
        "should come first.":
        order if only_equals else falling,
    }  # fmt: skip


@ranking.check(6)
def best_comes_first(student: Student):
    rng = np.random.default_rng(exercise.seed(5))
    for size in (3, 10, 21):
        small, large = rng.normal(size=size), rng.permutation(size) - 4
        for fitness in (small, 7 + 1e-4 * small, 1e9 * large, -3e9 - 1e8 * (large + 4), small[:2]):
            order = student.call("rank", fitness)
            mistakes = partial(mistaken_ranking, fitness, order)
            expect_close(student.said, order, np.argsort(-fitness), mistakes=mistakes)


@ranking.check(4)
def equals_keep_their_order(student: Student):
    for fitness, expected in (([1.0, 2.0, 2.0, 1.0], [1, 2, 0, 3]), ([-5.0] * 6, list(range(6)))):
        order = student.call("rank", np.array(fitness))
        mistakes = partial(mistaken_ranking, fitness, order)
        expect_close(f"rank({fitness})", order, expected, mistakes=mistakes)
    fitness = np.random.default_rng(exercise.seed(18)).integers(-2, 3, size=60).astype(float)
    order = student.call("rank", fitness)
    expect(
        np.array_equal(np.sort(expect_array(student.said, order, (60,))), np.arange(60)),
        f"{student.said} should hold each of the numbers 0 to 59 exactly once, but does not.",
    )
    expect_close(
        f"{student.said}: the order of 60 values, of which many are equal,",
        order, np.argsort(-fitness, kind="stable"),
        mistakes=partial(mistaken_ranking, fitness, order),
    )  # fmt: skip


# ------------------------------------------------------------------- 3.3
following = exercise.task("3.3", "The next population", needs=("3.2",), refused=TOOL)


def steps(module, population, fitness, mutrate, seed):
    """Two calls with one generator, one call with the same generator anew."""
    import numpy

    rng, before, same = numpy.random.default_rng(seed), population.copy(), fitness.copy()
    after = [module.next_population(population, fitness, mutrate, rng)]
    unchanged = [bool((population == before).all()), bool((fitness == same).all())]
    fitness = same
    after.append(module.next_population(before.copy(), fitness, mutrate, rng))
    rng = numpy.random.default_rng(seed)
    after.append(module.next_population(before.copy(), fitness, mutrate, rng))
    return [after, unchanged]


ZEROS = 8
"""Parameters that are 0 in the whole population, as all biases are at first."""


class Step:
    """A random population, its fitness, and what the student makes of it."""

    def __init__(
        self, student: Student, popsize: int, mutrate: float, index: int, scale: float = 1.0
    ) -> None:
        """scale: the standard deviation of the population's parameters."""
        rng = np.random.default_rng(exercise.seed(index))
        population, fitness = rng.normal(size=(popsize, 40)), rng.permutation(popsize) - 3.5
        population *= scale
        population[:, :ZEROS] = 0
        after, self.unchanged = student.run(
            steps, population, fitness, mutrate, exercise.seed(index + 50),
            said=f"next_population(population of {popsize}, fitness, {mutrate}, rng)",
        )  # fmt: skip
        self.said = student.said
        expect(isinstance(after, list) and len(after) == 3, f"{self.said} gave no answers.")
        self.after, self.later, self.again = (
            expect_array(self.said, each, population.shape) for each in after
        )
        self.places = np.flatnonzero(fitness > np.median(fitness))
        self.better = population[self.places]
        self.worse = np.delete(population, self.places, axis=0)

    def sorted_out(self, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The rows that hold the better half, in whatever order they are, and the other rows."""
        alike = same_rows(after, self.better)
        kept = np.array([row.argmax() for row in alike.T])
        if not alike.any(axis=0).all() or len(set(kept)) < len(kept):
            away = np.abs(after[:, None] - self.better[None]).mean(axis=2)
            nearest = away.argmin(axis=0)
            in_place = len(set(away[self.places].argmin(axis=1))) == len(kept)
            kept = self.places if in_place or len(set(nearest)) < len(kept) else nearest
        return after[kept], np.delete(after, kept, axis=0)

    def parents(self, after: np.ndarray) -> np.ndarray:
        """For each row that is new, the number of the individual it resembles most."""
        offspring = self.sorted_out(after)[1]
        return np.abs(offspring[:, None] - self.better[None]).mean(axis=2).argmin(axis=1)

    def noise(self, after: np.ndarray) -> np.ndarray:
        """What was added to the copies."""
        return self.sorted_out(after)[1] - self.better[self.parents(after)]


def same_rows(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Whether row i of some is row j of others, but for single precision; shape (some, others)."""
    return np.all(np.abs(some[:, None] - others[None]) < 1e-6, axis=2)


def expect_overwritten(step: Step) -> None:
    stayed = int(same_rows(step.after, step.worse).any(axis=0).sum())
    expect(
        not stayed,
        f"{step.said}: the new population still holds at least one individual of the worse half as "
        f"it was ({stayed} of {len(step.worse)}), but all of them should be replaced.",
    )


def expect_unlimited(step: Step) -> None:
    """Copies without noise have one largest number, limited ones have it in several columns."""
    sizes = np.abs(step.after)
    largest, at_limit = sizes.max(), sizes == sizes.max()
    expect(
        at_limit.any(axis=0).sum() < 3 or not largest,
        f"{step.said}: no parameter of the new population is larger in size than {largest:.4g}, "
        f"and {at_limit.sum()} are exactly this large, but nothing should limit the parameters.",
    )


@following.check(4)
def better_half_stays(student: Student):
    for popsize, scale in ((10, 1), (6, 1), (2, 1), (10, 100)):
        step = Step(student, popsize, 0.02, 6, scale)
        better = step.sorted_out(step.after)[0]
        moved = float(np.std(better - step.better))
        alike = same_rows(step.after, step.better)
        stayed, many = int(alike.any(axis=0).sum()), len(step.better)
        expect(
            stayed > 0 or not 0.5 < moved / 0.02 < 2,
            f"{step.said}: none of the better half stayed as it was; the rows most like it differ "
            f"by {moved:.3f} (standard deviation). The better half should stay; only its copies "
            "should get noise.",
        )
        elsewhere = int(alike[np.setdiff1d(np.arange(popsize), step.places)].any(axis=0).sum())
        expect(
            stayed == many or not elsewhere,
            f"{step.said}: only {stayed} of the {many} individuals of the better half are in the "
            "new population as they were, but all of them should stay.",
        )
        expect_close(f"{step.said}: the better half, afterwards,", better, step.better, 1e-6)
        expect_overwritten(step)


@following.check(3)
def equal_fitness(student: Student):
    """Whoever of equals stays, half of the population does, and nobody worse than a loser."""
    for values in ([200.0], [-1.0, -2.0], [0.0, 7.0, 200.0]):
        rng = np.random.default_rng(exercise.seed(19))
        population, fitness = rng.normal(size=(12, 40)), rng.choice(values, size=12)
        after, _ = student.run(
            steps, population, fitness, 0.1, exercise.seed(69),
            said=f"next_population(population of 12, fitness={show(fitness.tolist(), 90)}, 0.1, "
            "rng)",
        )  # fmt: skip
        expect(isinstance(after, list) and len(after) == 3, f"{student.said} gave no answers.")
        kept = same_rows(expect_array(student.said, after[0], population.shape), population)
        stay = np.flatnonzero(kept.any(axis=0))
        expect(
            len(stay) == 6 and kept.sum() == 6,
            f"{student.said}: {len(stay)} of the 12 individuals stay as they were, in {kept.sum()} "
            "rows, but it should be 6 individuals in 6 rows, even if some are equally good.",
        )
        expect_close(
            f"{student.said}: the sum of the fitness of the 6 that stay",
            fitness[stay].sum(), np.sort(fitness)[6:].sum(),
        )  # fmt: skip


@following.check(4)
def worse_half_becomes_mutated_copies(student: Student):
    for scale in (1, 100):
        step = Step(student, 20, 0.02, 7, scale)
        expect_overwritten(step)
        expect_unlimited(step)
        away = np.abs(step.noise(step.after)).mean(axis=1)
        expect(
            bool(np.all(away < 0.05)),
            f"{step.said}: a new row differs from each individual of the better half by "
            f"{away.max():.3f} or more on average over its parameters, but a copy with noise of "
            "standard deviation 0.02 should differ by about 0.016.",
        )
        copies = np.bincount(step.parents(step.after), minlength=10).tolist()
        expect(
            copies == [1] * 10,
            f"{step.said}: each individual of the better half should be copied exactly once, but "
            f"the numbers of their copies are {copies}.",
        )


def noises(mutrate: float) -> dict[float, str]:
    """The standard deviation of a typical mistake -> what is wrong."""
    return {
        mutrate**0.5: "Your value is about the root of mutrate, but mutrate should be the standard "
        "deviation, not the variance.",
        mutrate**2: "Your value is about the square of mutrate, but mutrate itself should be the "
        "standard deviation.",
        1.0: "Your value is about 1, that of noise that is not multiplied by mutrate.",
    }


def slip_of_noise(noise: np.ndarray, mutrate: float) -> str:
    """A sentence on what is wrong with numbers that should have standard deviation mutrate."""
    away = np.abs(noise - noise.mean())
    if noise.min() >= 0 or noise.max() <= 0:
        return " All noise that is not 0 has the same sign."
    if away.max() < 1.8 * noise.std() and 0.4 < (away < away.max() / 2).mean() < 0.6:
        return " The noise looks uniformly distributed, but it should be Gaussian."
    return slip_of(float(noise.std()), noises(mutrate))


@following.check(3)
def noise_is_gaussian(student: Student):
    for mutrate in (0.02, 0.3, 1.5):
        step = Step(student, 200, mutrate, 8, max(1, 20 * mutrate))
        expect_overwritten(step)
        expect_unlimited(step)
        noise = step.noise(step.after) / mutrate
        none = float(np.mean(noise[:, ZEROS:] == 0))
        share = ""
        if abs(1 - none - mutrate) < 0.2 * mutrate:
            share = ": mutrate should be its standard deviation, not the share of changes"
        expect(
            none < 0.02,
            f"{step.said}: {100 * none:.0f} % of the parameters of the copies got no noise, but "
            f"every parameter should get noise{share}.",
        )
        expect(
            bool(np.any(noise[:, :ZEROS])),
            f"{step.said}: the first {ZEROS} parameters, which are 0 in all individuals, got no "
            "noise, but they should: biases begin at 0 and should mutate, too.",
        )
        amounts = mutrate * noise
        rounded = np.any(amounts) and np.allclose(amounts, amounts.round(3), rtol=0, atol=1e-9)
        many = len(np.unique((np.abs(noise) / max(noise.std(), 1e-12)).round(6)))
        expect(
            many > 0.95 * noise.size or not rounded or many < 3,
            f"{step.said}: all noise has at most three decimal places, but it should not be "
            f"rounded; three numbers of the first copy got {show(amounts[0, ZEROS : ZEROS + 3])}.",
        )
        expect(
            many > 0.95 * noise.size,
            f"{step.said}: the same noise (apart from its sign) was added to several parameters or "
            f"several copies: the first copy got {show(noise[0, ZEROS : ZEROS + 3] * mutrate)}..., "
            f"the second {show(noise[1, ZEROS : ZEROS + 3] * mutrate)}.... Each parameter of each "
            "copy should get a random number of its own.",
        )
        expect(
            0.93 < noise.std() < 1.07 and abs(noise.mean()) < 0.1,
            f"{step.said}: the noise of the copies (the difference from their parents) has mean "
            f"{mutrate * noise.mean():.2g} and standard deviation {mutrate * noise.std():.3g}, "
            f"but should have mean 0 and standard deviation {mutrate:g}."
            f"{slip_of_noise(amounts, mutrate)}",
        )
        beyond = float(np.mean(np.abs(noise) > 2))
        expect(
            0.025 < beyond < 0.07,
            f"{step.said}: {100 * beyond:.1f} % of the noise is more than 2 * mutrate away from 0, "
            "but of Gaussian numbers it should be about 4.6 %.",
        )


@following.check(1)
def noise_comes_from_rng(student: Student):
    step = Step(student, 10, 0.1, 9)
    expect_overwritten(step)
    expect(
        np.array_equal(step.after, step.again),
        f"{step.said}: two generators with the same seed gave different populations, but all "
        "random numbers should come from rng, and nothing should be kept from an earlier call.",
    )
    first, second = step.noise(step.after), step.noise(step.later)
    what = "added noise of the first call again, but should use new random numbers from rng."
    if not first.any(axis=1).all() or not second.any(axis=1).all():
        what = "or the first one left at least one copy without any noise."
    expect(
        not same_rows(first, second).any(),
        f"{step.said}: a second call with the same rng {what}",
    )


@following.check(2)
def argument_is_not_changed(student: Student):
    step = Step(student, 10, 0.1, 10)
    expect_overwritten(step)
    for name, same in zip(("population", "fitness"), step.unchanged, strict=True):
        expect(same is True, f"{step.said} changed the {name} that it was given: work on a copy.")


# ------------------------------------------------------------------- 3.4
loop = exercise.task("3.4", "The loop", needs=("3.2", "3.3"), refused=TOOL)


def evolved(module, name, population, target, generations, mutrate, seed, least):
    """Runs the student's loop on a fitness that the grader can compute again."""
    import numpy

    calls, before = [], population.copy()

    def evaluate(population, seed):
        population = numpy.array(population)
        calls.append([population, seed])
        return -((population - target) ** 2).mean(axis=1) + seed * 37 % 11 + least

    run = getattr(module, name)(evaluate, population, generations, mutrate, seed)
    return [run, calls, bool(numpy.array_equal(population, before))]


MANY = 1000
"""Random numbers that are enough to see how large the noise is at first and at last."""


class Evolved:
    """What the student's loop reported, what it evaluated, and its fitness computed again.

    Fitness is minus the distance to a target, plus the luck of a generation, 37 seed mod 11: for
    all individuals the same, and greatest in generations 4, 15, 26, ... and not in the last one.
    least: is added to every fitness; -100 makes all of them negative.
    """

    def __init__(
        self,
        student: Student,
        name: str,
        start: np.ndarray,
        generations: int,
        index: int = 0,
        mutrate: float = 0.1,
        least: float = 0.0,
        later: int = 0,
        zero: bool = False,
        next: int = 0,
    ) -> None:
        """zero: whether the seed is 0; else the usual one, plus 11 times later, plus next."""
        seed = 0 if zero else 11 * (exercise.seed(index) % 100 + later) + 4 + next
        target = np.linspace(-1, 1, start.shape[-1])
        run, calls, self.unchanged = student.run(
            evolved, name, start, target, generations, mutrate, seed, least,
            said=f"{name}(evaluate, ..., generations={generations}, mutrate={mutrate:g}, "
            f"seed={seed})",
        )  # fmt: skip
        self.said, self.mutrate = student.said, mutrate
        expect(
            len(calls) == generations,
            f"{self.said}: the number of calls of evaluate is {len(calls)}, but should be "
            f"{generations}, one for each generation.",
        )
        seeds = [each[1] for each in calls]
        asked = list(range(seed, seed + generations))
        other = ([g for g in range(generations) if seeds[g] != asked[g]] or [None])[0]
        expect(
            other is None,
            f"{self.said} should call evaluate with seed, seed + 1, seed + 2, ..., but used "
            f"{show(seeds[:4])}"
            + ("..." if other is None or other < 4 else f"..., and {show(seeds[other])} in "
               f"generation {other}."),
        )  # fmt: skip
        rows = 2 if start.ndim == 1 else len(start)
        given = f"{self.said}: what evaluate was given"
        self.populations = [expect_array(given, each[0], (rows, len(target))) for each in calls]
        self.distance = [((each - target) ** 2).mean(axis=1) for each in self.populations]
        self.fitness = [
            (seed + g) * 37 % 11 + least - distance for g, distance in enumerate(self.distance)
        ]
        expect_fields(self.said, run, "best", "fitness", "history", "population")
        self.run = run

    def expect_report(self) -> None:
        """best, fitness and history are those of the populations that were evaluated."""
        table = np.array(self.fitness)
        highest = table.max(axis=1)
        expect_close(
            f"{self.said}: history", self.run["history"], highest, 1e-6,
            mistakes={
                "This is the mean fitness of each generation, but the highest is asked for.":
                    table.mean(axis=1),
                "This is the lowest fitness of each generation, but the highest is asked for.":
                    table.min(axis=1),
                "This is the highest fitness so far, but the highest of each generation is asked "
                "for.":
                    np.maximum.accumulate(highest),
                "This is the fitness of individual 0, but the highest is asked for.": table[:, 0],
            },
        )  # fmt: skip
        expect_close(
            f"{self.said}: fitness", self.run["fitness"], highest.max(), 1e-6,
            mistakes={
                "This is the highest fitness of the first generation, but that of all generations "
                "is asked for.": highest[0],
                "This is the highest fitness of the last generation, but that of all generations "
                "is asked for.": highest[-1],
                "This is the lowest fitness that was met, but the highest is asked for.":
                    table.min(),
                "This is the lowest of the generations' highest fitness, but the highest of them "
                "is asked for.": highest.min(),
            },
        )  # fmt: skip
        best = int(np.argmax(highest))
        # single precision cannot tell apart those that are nearly as good
        limit = highest.max() - 2 * np.spacing(np.float32(abs(highest.max())))
        good = np.flatnonzero(table[best] >= limit)
        tried = self.populations[best][good]
        told = expect_array(f"{self.said}: best", self.run["best"], tried[0].shape)
        nearest = int(np.abs(tried - told).sum(axis=1).argmin())
        place, winner = int(good[nearest]), tried[nearest]
        last = expect_array(f"{self.said}: population", self.run["population"],
                            self.populations[0].shape)  # fmt: skip
        mistakes = {
            "This is what stands in the best individual's row after the last generation, but that "
            "individual is asked for: when it is found, keep a copy of it (.copy()).": last[place],
            "This is the best of the last generation, but the best of all is asked for.":
                self.populations[-1][table[-1].argmax()],
            "This is row 0 of the population returned, but the best of all generations is asked "
            "for.": last[0],
        }  # fmt: skip
        for g, i in enumerate(table.argmax(axis=1)):
            if g != best:
                said = (
                    f"This is the best of generation {g}, but generation {best} has a better one."
                )
                mistakes.setdefault(said, self.populations[g][i])
        expect_close(
            f"{self.said}: best (the highest fitness was met in generation {best})",
            self.run["best"], winner, 1e-6, mistakes,
            lambda *_: self._origin(told, best, place, last),
        )  # fmt: skip

    def _origin(self, told: np.ndarray, best: int, place: int, last: np.ndarray) -> str:
        """Where an individual occurs that is not the best: row `place` of generation `best`."""
        for g in (best, *range(len(self.populations))):
            rows = np.flatnonzero(np.isclose(self.populations[g], told, rtol=1e-5).all(axis=1))
            if len(rows) and g == best:
                return (
                    f"This is row {rows[0]} of generation {g}, but row {place} is the best of it."
                )
            if len(rows):
                return f"This is row {rows[0]} of generation {g}."
        if np.isclose(last, told, rtol=1e-5).all(axis=1).any():
            return "This is a row of the population returned, which has not been evaluated."
        return "No individual that was evaluated has these parameters."

    def expect_lineage(self) -> None:
        """From each population to the next: the better half kept, the others variations of it."""
        last = expect_array(f"{self.said}: population", self.run["population"],
                            self.populations[0].shape)  # fmt: skip
        expect(
            not np.array_equal(last, self.populations[-1]),
            f"{self.said}: population is the one that was evaluated in the last generation, but "
            "selection and mutation should follow every evaluation, also the last one.",
        )
        before, all_noise = None, []
        for g, after in enumerate([*self.populations[1:], last]):
            order = np.argsort(self.distance[g])
            half = len(order) // 2
            better = self.populations[g][order[:half]]
            same = same_rows(after, better)
            which = "the population returned" if g + 1 == len(self.populations) else (
                f"the population of generation {g + 1}"
            )  # fmt: skip
            expect(
                bool(same.any(axis=0).all()),
                f"{self.said}: {which} should hold the whole better half of generation {g}, but "
                "does not.",
            )
            others = after[~same.any(axis=1)]
            older = np.concatenate(self.populations[: g + 1])
            expect(
                not same_rows(others, older).any(),
                f"{self.said}: {which} holds an individual of an earlier population that is not in "
                f"the better half of generation {g}: besides this half it should hold only mutated "
                "copies of it.",
            )
            again = (after[same.any(axis=1)][:, None] - better[None]).reshape(-1, after.shape[1])
            expect(
                len(others) == half or before is None or not same_rows(again, before).any(),
                f"{self.said}: {which} holds an individual twice, but every copy should get random "
                "numbers of its own, other ones than in the generation before.",
            )
            expect(
                len(others) == half,
                f"{self.said}: the number of mutated copies in {which} should be {half}, but is "
                f"{len(others)}; its other rows ({len(after) - len(others)}) are individuals of "
                f"the better half of generation {g}, unchanged.",
            )
            apart = others[:, None] - better[None]
            far = float(np.abs(apart).max(axis=2).min(axis=1).max())
            expect(
                far < 7 * self.mutrate,
                f"{self.said}: {which} holds a row that differs by up to {far:.3g} from the "
                f"nearest one of the better half of generation {g}, but a copy with "
                f"mutrate={self.mutrate:g} should differ by less than {7 * self.mutrate:.3g}.",
            )
            noise = apart[np.arange(half), np.abs(apart).mean(axis=2).argmin(axis=1)]
            expect(
                before is None or not same_rows(noise, before).any(),
                f"{self.said}: the same noise was added to copies in two generations, but each "
                "generation should get new random numbers.",
            )
            before = noise
            all_noise.append(noise)
        self.noise = np.concatenate(all_noise)
        deviation = float(np.std(all_noise))
        expect(
            0.6 < deviation / self.mutrate < 1.6,
            f"{self.said}: the noise of all generations has standard deviation {deviation:.3f}, "
            f"but it should be mutrate={self.mutrate:g}."
            f"{slip_of_noise(self.noise, self.mutrate)}",
        )
        if np.size(all_noise) > MANY and len(self.populations[0]) == 2:  # so the parent is known
            third = len(all_noise) // 3
            first, last = (float(np.std(part)) for part in (all_noise[:third], all_noise[-third:]))
            expect(
                0.8 < last / first < 1.25,
                f"{self.said}: the noise has standard deviation {first:.3f} in the first "
                f"generations and {last:.3f} in the last ones, but it should stay the same.",
            )

    def expect_seeded(self, again: Evolved, other: Evolved) -> None:
        """The same seed gives the same populations, another seed another noise."""
        expect(
            np.allclose(self.populations, again.populations, rtol=0, atol=1e-6),
            f"{self.said} evaluated other populations when it was called again with the same "
            "arguments: all randomness should come from np.random.default_rng(seed), and nothing "
            "should be kept from an earlier call.",
        )
        first, second = (
            [
                row
                for row in each.populations[1]
                if not same_rows(row[None], each.populations[0]).any()
            ]
            for each in (self, other)
        )
        expect(
            not first or not second or not same_rows(np.array(first), np.array(second)).any(),
            f"{other.said} made at least one of the same mutated copies in generation 1 as with "
            "another seed, but each seed should give random numbers of its own.",
        )


def start_of(index: int, *shape: int) -> np.ndarray:
    return np.random.default_rng(exercise.seed(index)).normal(size=shape)


@loop.check(6)
def evaluates_each_generation_once(student: Student):
    start = start_of(11, 10, 8)
    evolution = Evolved(student, "evolve", start, 12, 11)
    expect_close(f"{student.said}: the first population", evolution.populations[0], start, 1e-6)
    for before, after in zip(evolution.populations[:-1], evolution.populations[1:], strict=True):
        expect(
            not np.array_equal(before, after),
            f"{student.said} evaluated the same population in two generations in a row.",
        )


@loop.check(6)
def reports_best_and_history(student: Student):
    for index, generations, least in (
        (12, 12, 0.0),
        (13, 15, -100.0),
        (12, 1, -100.0),
        (17, 5, -1e5),
        (17, 5, 200.0),
        (17, 5, 1e4),
    ):
        start = start_of(index, 10, 8)
        evolution = Evolved(student, "evolve", start, generations, index, least=least)
        evolution.expect_report()


@loop.check(4)
def seed_decides_the_noise(student: Student):
    start = start_of(14, 10, 8)
    one = Evolved(student, "evolve", start, 4, 14)
    student.stop()
    again = Evolved(student, "evolve", start, 4, 14)
    other = Evolved(student, "evolve", start, 4, 14, later=1)
    one.expect_seeded(again, other)
    zero, again = (Evolved(student, "evolve", start, 4, zero=True) for _ in range(2))
    zero.expect_seeded(again, other)
    expect(
        zero.unchanged is True,
        f"{zero.said} changed the population that it was given, so the next run would begin with "
        "another one: work on a copy.",
    )
    run, following = (Evolved(student, "evolve", start, 6, 14, next=i) for i in range(2))
    run.expect_lineage()
    following.expect_lineage()
    early = same_rows(run.noise[5:10], following.noise[:5]).any()
    why = " It comes one generation earlier: make one generator from the seed, before the loop."
    expect(
        not same_rows(run.noise, following.noise).any(),
        f"{following.said} added noise that {run.said} added, too, but each seed should give noise "
        f"of its own.{why if early else ''}",
    )


@loop.check(4)
def fitness_rises(student: Student):
    Evolved(student, "evolve", start_of(24, 10, 8), 6, 14, mutrate=0.5).expect_lineage()
    evolution = Evolved(student, "evolve", start_of(14, 20, 8), 60, 14)
    evolution.expect_lineage()
    Evolved(student, "evolve", start_of(25, 2, 40), 60, 14).expect_lineage()
    first, last = (evolution.distance[g].min() for g in (0, -1))
    expect(
        last < 0.3 * first,
        f"{student.said}: apart from a number that evaluate adds to the fitness of a whole "
        f"generation, the best fitness went from {-first:.3f} to {-last:.3f} in 60 generations, "
        "but it should come much nearer to 0.",
    )


# ------------------------------------------------------------------- 3.5
climber = exercise.task("3.5", "A hill climber", needs=("3.4",), refused=TOOL)


@climber.check(5)
def never_steps_down(student: Student):
    start = start_of(15, 9)
    climb = Evolved(student, "hill_climb", start, 80, 15)
    first = climb.populations[0]
    expect_close(
        f"{student.said}: the first population (both rows should be start)",
        first, [start] * 2, 1e-6,
    )  # fmt: skip
    climb.expect_lineage()
    distance = np.array([each.min() for each in climb.distance])
    expect(
        bool(np.all(np.diff(distance) <= 1e-12)),
        f"{student.said}: the better of the two individuals got worse in a generation, but it "
        "should be kept.",
    )
    expect(distance[-1] < distance[0] / 2, f"{student.said}: the fitness hardly rose.")
    expect(climb.unchanged is True, f"{student.said} changed start: work on a copy.")


@climber.check(3)
def reports_like_evolve(student: Student):
    climb = Evolved(student, "hill_climb", start_of(16, 5), 15, 16, mutrate=0.3, least=-100.0)
    climb.expect_report()
    climb.expect_lineage()
    expect(
        not np.array_equal(climb.populations[0], climb.populations[-1]),
        f"{student.said} evaluated the same two individuals in the first and the last generation, "
        "but the variation should be a new one in each generation.",
    )
    start = start_of(16, 5)
    student.stop()
    one, again, other = (
        Evolved(student, "hill_climb", start, 4, 16, later=i, mutrate=0.3) for i in (0, 0, 1)
    )
    one.expect_seeded(again, other)
    Evolved(student, "hill_climb", start, 1, 16, mutrate=0.3, least=-100.0).expect_report()


# ------------------------------------------------------------------- 3.6
replications = exercise.task("3.6", "Replications")


def replicated(module, histories, seeds):
    """Runs the student's replicate on prepared curves; what it ran, and the seeds afterwards."""

    asked, before = [], list(seeds)

    def experiment(seed):
        asked.append(int(seed))
        row = before.index(seed) if seed in before else 0
        history = [float(value) for value in histories[row]]
        return {"history": history, "fitness": max(history), "best": None, "population": None}

    return [module.replicate(experiment, seeds), asked, seeds]


def curves_of(student: Student, n: int, seed: int):
    # multiples of 1/1024: single precision loses nothing where two curves are close together
    histories = np.round(1024 * np.random.default_rng(seed).normal(size=(n, 15))) / 1024
    histories -= 100 * (seed % 2)
    seeds = [int(s) for s in np.random.default_rng(seed).permutation(50)[:n]]
    result, asked, after = student.run(
        replicated, histories, seeds, said=f"replicate(experiment, {show(seeds, 30)})"
    )
    others = [seed for seed in asked if seed not in seeds]
    expect(
        not others,
        f"{student.said} ran the experiment with at least one seed that is not in the list (the "
        f"first seeds are {show(asked[:4])}): use the seeds that are given.",
    )
    keep = ", and keep what it returns" if len(asked) > n else ""
    expect(
        sorted(asked) == sorted(seeds),
        f"{student.said} should run the experiment once for each seed, but ran it with the seeds "
        f"{show(asked)}, {len(asked)} in all: run each once{keep}.",
    )
    expect(after == seeds, f"{student.said} changed the list of seeds: it is {show(after)} now.")
    expect_fields(student.said, result, "mean", "deviation", "best")
    return histories, result


SO_FAR = "This is made of the best so far, but the highest fitness of each generation is asked for."


@replications.check(5)
def mean_and_best(student: Student):
    histories, result = curves_of(student, 6, exercise.seed(14))
    order = np.argsort(np.random.default_rng(exercise.seed(14)).permutation(50)[:6])
    expect_close(
        f"{student.said}: mean", result["mean"], histories.mean(axis=0),
        mistakes={
            SO_FAR: np.maximum.accumulate(histories, axis=1).mean(axis=0),
            "This is the median of the replications, but their mean is asked for.":
                np.median(histories, axis=0),
            "This is the highest value of the replications, but their mean is asked for.":
                histories.max(axis=0),
            "This is the sum over the replications, but their mean is asked for.":
                histories.sum(axis=0),
        },
    )  # fmt: skip
    expect_close(
        f"{student.said}: best", result["best"], histories.max(axis=1),
        mistakes={
            "These are the last values of the histories, but each run's \"fitness\" is asked for.":
                histories[:, -1],
            "These are in the order of rising seeds, but that of the seeds given is asked for.":
                histories[order].max(axis=1),
            "These are in rising order, but the order of the seeds is asked for.":
                np.sort(histories.max(axis=1)),
            "These are in falling order, but the order of the seeds is asked for.":
                -np.sort(-histories.max(axis=1)),
            "These are the means of the histories, but each run's \"fitness\" is asked for.":
                histories.mean(axis=1),
        },
    )  # fmt: skip


@replications.check(4)
def deviation(student: Student):
    histories, result = curves_of(student, 5, exercise.seed(15))
    wanted = histories.std(axis=0, ddof=1)
    expect_close(
        f"{student.said}: deviation", result["deviation"], wanted,
        mistakes={
            "This is divided by the number of replications, but should be divided by that number "
            "minus one.":
                histories.std(axis=0),
            SO_FAR: np.maximum.accumulate(histories, axis=1).std(axis=0, ddof=1),
            "This is the variance, but its root, the standard deviation, is asked for.": wanted**2,
            "This is the standard error of the mean: the standard deviation should not be divided "
            "by the root of the number of replications.":
                wanted / np.sqrt(len(histories)),
            "This is divided by the number of generations minus one, but should be divided by the "
            "number of replications minus one.":
                wanted * np.sqrt((len(histories) - 1) / (histories.shape[1] - 1)),
        },
    )  # fmt: skip


@replications.check(1)
def a_single_replication(student: Student):
    for n in (1, 2):
        histories, result = curves_of(student, n, exercise.seed(15 + n))
        wanted = np.zeros(15) if n == 1 else histories.std(axis=0, ddof=1)
        value = result["deviation"]
        expect(
            n > 1 or not isinstance(value, (float, np.ndarray)) or not np.isnan(value).all(),
            f"{student.said}: deviation is NaN, but should be 0 for a single replication, where "
            "the number of replications minus one is 0.",
        )
        expect_close(f"{student.said}: deviation", value, wanted)


# ------------------------------------------------------------------- 3.7
training = exercise.task("3.7", "CartPole and Pendulum", seconds=90, needs=("3.1", "3.2", "3.4"))


def trained(module, ask, environment, seed, size):
    """Trains with a robot of the grader, whose parameters count with gains."""
    from botschool.grading.run.rewiring import asking

    with asking(environment, size, ask):
        return module.train(environment, seed)


class Trained:
    """What train makes of a robot: its mean return over 20 episodes that it never met."""

    def __init__(self, student: Student, environment: str, index: int, gains: np.ndarray) -> None:
        seed, robot = exercise.seed(index) % 100_000, Robot(environment)
        self.said = f"train({environment!r}, seed={seed})"
        size, own = robot.nbiases + robot.nweights, {"environment": environment, "gains": gains}
        answer = student.run(trained, environment, seed, size, said=self.said, robot=own)
        self.parameters = expect_array(self.said, answer, (size,))
        evaluated = student.rewired
        self.many, self.last = len(evaluated), evaluated.last(100)[:500]
        self._robot, self._gains = robot, gains
        nearest = evaluated.nearest(self.parameters)
        self.was_evaluated = nearest is not None and bool(
            np.allclose(nearest, self.parameters, rtol=1e-5, atol=1e-5)
        )
        self._episodes = exercise.seed(index + 10)
        self.mean = float(self._means(self.parameters[None])[0])

    def another_reaches(self, wanted: float) -> bool:
        """Whether another of the last candidates is good enough in the same episodes."""
        return bool((self._means(self.last) >= wanted).any())

    def _means(self, candidates: np.ndarray) -> np.ndarray:
        return self._robot.evaluate(candidates * self._gains, self._episodes, episodes=20)


def gains_of(index: int, size: int) -> np.ndarray:
    """Drawn in secret: either sign, 0.8 to 1.25 times as much."""
    rng = np.random.default_rng(exercise.seed(index + 20))
    return rng.choice([-1.0, 1.0], size=size) * 1.25 ** rng.uniform(-1, 1, size)


THIRD = 4
"""The third seed has the index of the first one plus this."""


def expect_trained(
    student: Student, environment: str, index: int, wanted: float, random: float, told: str
):
    """Two seeds, and a robot whose parameters have other gains, drawn in secret.

    If just one of the two is good enough, a third one decides: a seed in some hundreds is unlucky.
    random: the mean return of random controllers. told: what is said of a mean that is not enough.
    """
    robot = Robot(environment)
    gains = gains_of(index, robot.nbiases + robot.nweights)
    runs = [Trained(student, environment, each, gains) for each in (index, index + 1)]
    if sum(run.mean >= wanted for run in runs) == 1:
        runs.append(Trained(student, environment, index + THIRD, gains))
    for run in runs:
        expect(
            run.many > 0,
            f"{run.said} returned parameters without evaluating anything: it should evolve in "
            "every call, from the seed, and keep nothing from an earlier call, in memory or in a "
            "file.",
        )
        expect(
            run.was_evaluated,
            f"{run.said} returned parameters that it has not evaluated: they are not among the "
            f"rows that robot.evaluate was given ({run.many} in all). Return one of those, and "
            "not, for example, their mean, a changed copy or an individual of a later population.",
        )
    good = [run for run in runs if run.mean >= wanted]
    passed = len(good)
    if passed == 2:
        runs = good
    for number, run in enumerate(runs):
        if run.mean >= wanted:
            continue
        plain = Trained(student, environment, index + number, np.ones(len(gains)))
        if passed or plain.mean < wanted:
            worse = run if passed else plain
            advice = (
                "If it was chosen by one evaluation of a few episodes, it may have been "
                "lucky: evaluate the good candidates again, in more episodes with another seed, "
                "before you choose."
            )
            if worse.mean < random - 0.3 * abs(random) < 0:
                advice = (
                    "That is worse than random controllers with the weights of task 3.1: check "
                    "that the better half is kept, and that a higher fitness counts as better."
                )
            elif worse.mean < (random + wanted) / 2:
                advice = (
                    "That is nearer to random controllers than to the aim: look at the curve of "
                    "such a run, and try another mutation rate, more generations or a larger "
                    "population."
                )
            if worse.another_reaches(wanted):
                advice = (
                    "At least one of the candidates that were evaluated last is good enough, but "
                    "another one was returned: look at how you choose the one that you return."
                )
            raise Wrong(
                f"{worse.said}: {told.format(worse.mean)} With {len(runs)} seeds, {passed} "
                f"{'controller is' if passed == 1 else 'controllers are'} good enough, but 2 are "
                f"needed. {advice}"
            )
        raise Wrong(
            f"{run.said}: the controller reaches {plain.mean:.0f} if it is evolved for the "
            f"ordinary robot, but only {run.mean:.0f} if for a robot whose parameters count with "
            "other signs and sizes. To evolution this is the same task: robot.evaluate alone "
            "should decide what is good, evolution should begin without knowing any parameters, "
            "and many episodes should decide which candidate is the best."
        )
    one, other = (run.parameters for run in runs)
    likeness = float(one @ other / np.sqrt((one @ one) * (other @ other)))
    expect(
        likeness < 0.8,
        f"{runs[1].said} gave nearly the same parameters as another seed (correlation "
        f"{likeness:.2f}), but another seed should give a different controller.",
    )


@training.check(10)
def keeps_the_pole_up(student: Student):
    told = (
        "the controller keeps the pole up for {:.1f} steps on average over 20 new episodes, but at "
        "least 195 are asked for."
    )
    expect_trained(student, "CartPole-v0", 20, 195, 22, told)
    gains = gains_of(20, 72)
    one = Trained(student, "CartPole-v0", 20, gains)
    student.stop()
    again = Trained(student, "CartPole-v0", 20, gains)
    expect(
        np.array_equal(one.parameters, again.parameters),
        f"{again.said} gave other parameters when it was called again: everything that is random "
        "should follow from the seed, and nothing should be kept from an earlier call.",
    )


@training.check(10)
def swings_up(student: Student):
    told = (
        "the controller reaches {:.0f} on average over 20 new episodes; random ones reach about "
        "-1200, and at least -600 is asked for."
    )
    expect_trained(student, "Pendulum-v1", 22, -600, -1200, told)
