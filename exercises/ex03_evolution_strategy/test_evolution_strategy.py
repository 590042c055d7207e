"""Grader of exercise 3; run it with `make test-ex3`.

Stochastic checks (task 3.7), each with two seeds and 20 unseen episodes a controller, on robots
whose parameters count with signs drawn in secret (botschool.course.rewiring):

- CartPole-v0 needs a mean of at least 195. The solution reaches 199.9 to 200 for 100 seeds and
  robots (margin 4.9 steps). Of random controllers 3 % reach it too, so this part can also be had by
  luck.
- Pendulum-v1 needs a mean of at least -600. Over 20 seeds and robots the solution reaches -201 to
  -112 (margin 399). Random controllers reach -1160 +- 90 with the weights of task 3.1 and
  -1500 +- 150 with weights of deviation 1; the best of 6000 of the latter, chosen with 5 and the
  best 20 again with 20 episodes, -990 to -750.
"""

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


@initial.check(3)
def biases_are_zero(student: Student):
    population = student.call("initial_population", 12, 5, 30, seed=3)
    population = expect_array(student.said, population, (12, 35))
    expect(
        bool(np.all(population[:, :5] == 0)) and bool(np.all(population[:, 5:] != 0)),
        f"{student.said}: the first 5 values of each row are the biases and must be 0, "
        "the 30 weights after them must not.",
    )


@initial.check(2)
def individuals_differ(student: Student):
    population = student.call("initial_population", 12, 2, 30, seed=5)
    population = expect_array(student.said, population, (12, 32))
    expect(
        len(np.unique(population[:, 2:])) == 12 * 30,
        f"{student.said}: some weights are equal, but each one of each individual is a random "
        "number of its own.",
    )


@initial.check(4)
def weights_are_gaussian(student: Student):
    weights = student.call("initial_population", 100, 0, 200, seed=exercise.seed(2))
    weights = expect_array(student.said, weights, (100, 200))
    expect(
        abs(weights.mean()) < 0.005,
        f"{student.said}: the weights have mean {weights.mean():.3f}, but it should be near 0.",
    )
    expect(
        abs(weights.std() - 0.1) < 0.004,
        f"{student.said}: the weights have standard deviation {weights.std():.3f}, but 0.1 is "
        "asked for.",
    )
    beyond = float(np.mean(np.abs(weights) > 0.2))
    expect(
        0.03 < beyond < 0.06,
        f"{student.said}: {100 * beyond:.1f} % of the weights are beyond 0.2, but of Gaussian "
        "numbers with deviation 0.1 it is 4.6 %.",
    )


@initial.check(3)
def seed_decides(student: Student):
    one = student.call("initial_population", 4, 2, 9, seed=exercise.seed(3))
    expect_array(student.said, one, (4, 11))
    again = student.call("initial_population", 4, 2, 9, seed=exercise.seed(3))
    expect(np.array_equal(one, again), f"{student.said} gives other numbers when called again.")
    other = student.call("initial_population", 4, 2, 9, seed=exercise.seed(4))
    expect(not np.array_equal(one, other), f"{student.said}: another seed gave the same numbers.")


# ------------------------------------------------------------------- 3.2
ranking = exercise.task("3.2", "Ranking")


@ranking.check(6)
def best_comes_first(student: Student):
    rng = np.random.default_rng(exercise.seed(5))
    for size in (3, 10, 21):
        fitness = rng.normal(size=size)
        order = student.call("rank", fitness)
        expect_close(student.said, order, np.argsort(-fitness))


@ranking.check(4)
def equals_keep_their_order(student: Student):
    for fitness, expected in (([1.0, 2.0, 2.0, 1.0], [1, 2, 0, 3]), ([5.0] * 6, list(range(6)))):
        order = student.call("rank", np.array(fitness))
        expect_close(f"rank({fitness})", order, expected)


# ------------------------------------------------------------------- 3.3
following = exercise.task("3.3", "The next population", needs=("3.2",), refused=TOOL)


def steps(module, population, fitness, mutrate, seed):
    """Two calls with one generator, one call with the same generator anew."""
    import numpy

    rng, before = numpy.random.default_rng(seed), population.copy()
    after = [module.next_population(population, fitness, mutrate, rng)]
    unchanged = bool((population == before).all())
    after.append(module.next_population(before.copy(), fitness, mutrate, rng))
    rng = numpy.random.default_rng(seed)
    after.append(module.next_population(before.copy(), fitness, mutrate, rng))
    return [after, unchanged]


class Step:
    """A random population, its fitness, and what the student makes of it."""

    def __init__(self, student: Student, popsize: int, mutrate: float, index: int) -> None:
        rng = np.random.default_rng(exercise.seed(index))
        population, fitness = rng.normal(size=(popsize, 40)), rng.permutation(popsize) - 3.5
        after, self.unchanged = student.run(
            steps, population, fitness, mutrate, exercise.seed(index),
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
        found = alike.any(axis=0).all() and len(set(kept)) == len(kept)
        kept = kept if found else self.places
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
    expect(
        not same_rows(step.after, step.worse).any(),
        f"{step.said}: rows of the worse half were left as they are.",
    )


@following.check(4)
def better_half_stays(student: Student):
    step = Step(student, 10, 0.02, 6)
    expect_close(f"{step.said}: the better half", step.sorted_out(step.after)[0], step.better, 1e-6)
    expect_overwritten(step)


@following.check(5)
def worse_half_becomes_mutated_copies(student: Student):
    step = Step(student, 20, 0.02, 7)
    expect_overwritten(step)
    expect(
        bool(np.all(np.abs(step.noise(step.after)).mean(axis=1) < 0.05)),
        f"{step.said}: a row of the worse half is no mutated copy of one of the better half.",
    )
    expect(
        len(set(step.parents(step.after))) == 10,
        f"{step.said}: each of the better half must be copied exactly once.",
    )


@following.check(4)
def noise_is_gaussian(student: Student):
    for mutrate in (0.02, 0.3):
        step = Step(student, 200, mutrate, 8)
        noise = step.noise(step.after) / mutrate
        expect(
            len(np.unique(noise.round(6))) > 0.95 * noise.size,
            f"{step.said}: the same noise was added to several parameters or several copies, but "
            "each parameter of each copy needs a random number of its own.",
        )
        expect(
            0.93 < noise.std() < 1.07 and abs(noise.mean()) < 0.1,
            f"{step.said}: the noise has mean {mutrate * noise.mean():.3f} and standard deviation "
            f"{mutrate * noise.std():.3f}.",
        )
        beyond = float(np.mean(np.abs(noise) > 2))
        expect(
            0.025 < beyond < 0.07,
            f"{step.said}: {100 * beyond:.1f} % of the noise is beyond two standard deviations, "
            "but of Gaussian numbers it is 4.6 %.",
        )


@following.check(2)
def noise_comes_from_rng(student: Student):
    step = Step(student, 10, 0.1, 9)
    expect_overwritten(step)
    expect(
        np.array_equal(step.after, step.again),
        f"{step.said}: two generators with the same seed gave different populations, so not all "
        "random numbers come from rng.",
    )
    expect(
        not same_rows(step.noise(step.after), step.noise(step.later)).any(),
        f"{step.said}: a second call with the same rng added the same noise, so the random "
        "numbers do not come from rng.",
    )


@following.check(2)
def argument_is_not_changed(student: Student):
    step = Step(student, 10, 0.1, 10)
    expect_overwritten(step)
    expect(
        step.unchanged is True,
        f"{step.said} changed the population that it was given: work on a copy.",
    )


# ------------------------------------------------------------------- 3.4
loop = exercise.task("3.4", "The loop", needs=("3.2", "3.3"), refused=TOOL)


def evolved(module, name, population, target, generations, mutrate, seed):
    """Runs the student's loop on a fitness that the grader can compute again."""
    import numpy

    calls = []

    def evaluate(population, seed):
        population = numpy.array(population)
        calls.append([population, seed])
        return -((population - target) ** 2).mean(axis=1) + seed * 37 % 11

    run = getattr(module, name)(evaluate, population, generations, mutrate, seed)
    return [run, calls]


class Evolved:
    """What the student's loop reported, what it evaluated, and its fitness computed again.

    Fitness is minus the distance to a target, plus the luck of a generation, 37 seed mod 11: for
    all individuals the same, and greatest in generations 4, 15, 26, ... and not in the last one.
    """

    def __init__(self, student: Student, name: str, start: np.ndarray, generations: int, index=0):
        seed = 11 * (exercise.seed(index) % 100) + 4
        target = np.linspace(-1, 1, start.shape[-1])
        run, calls = student.run(
            evolved, name, start, target, generations, 0.1, seed,
            said=f"{name}(evaluate, ..., generations={generations}, mutrate=0.1, seed={seed})",
        )  # fmt: skip
        self.said = student.said
        expect(
            len(calls) == generations,
            f"{self.said} called evaluate {len(calls)} times for {generations} generations.",
        )
        seeds = [each[1] for each in calls]
        expect(
            seeds == list(range(seed, seed + generations)),
            f"{self.said} must call evaluate with seed, seed + 1, seed + 2, ... but used "
            f"{show(seeds[:4])}...",
        )
        rows = 2 if start.ndim == 1 else len(start)
        self.populations = [expect_array(self.said, each[0], (rows, len(target))) for each in calls]
        self.distance = [((each - target) ** 2).mean(axis=1) for each in self.populations]
        self.fitness = [(seed + g) * 37 % 11 - distance for g, distance in enumerate(self.distance)]
        expect_fields(self.said, run, "best", "fitness", "history", "population")
        self.run = run

    def expect_report(self) -> None:
        """best, fitness and history are those of the populations that were evaluated."""
        highest = [each.max() for each in self.fitness]
        expect_close(f"{self.said}: history", self.run["history"], highest, 1e-6)
        expect_close(f"{self.said}: fitness", self.run["fitness"], max(highest), 1e-6)
        best = int(np.argmax(highest))
        winner = self.populations[best][self.fitness[best].argmax()]
        expect_close(
            f"{self.said}: best (the highest fitness was met in generation {best})",
            self.run["best"], winner, 1e-6,
        )  # fmt: skip

    def expect_lineage(self) -> None:
        """From each population to the next: the better half kept, the others variations of it."""
        last = expect_array(f"{self.said}: population", self.run["population"],
                            self.populations[0].shape)  # fmt: skip
        before = None
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
                f"{self.said}: {which} does not hold the better half of generation {g}.",
            )
            others = after[~same.any(axis=1)]
            expect(
                len(others) == half,
                f"{self.said}: {which} should hold {half} mutated copies, but has {len(others)} "
                f"rows that were not in the better half of generation {g} (is the same noise added "
                "again and again?).",
            )
            noise = others[:, None] - better[None]
            noise = noise[np.arange(half), np.abs(noise).mean(axis=2).argmin(axis=1)]
            expect(
                bool(np.all(np.abs(noise) < 0.7)),
                f"{self.said}: {which} holds a row that is no mutated copy of one of the better "
                f"half of generation {g}.",
            )
            expect(
                before is None or not same_rows(noise, before).any(),
                f"{self.said}: the same noise was added in two generations. Make the random "
                "generator once, before the loop.",
            )
            before = noise


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
            f"{student.said} evaluated the same population in two generations.",
        )


@loop.check(7)
def reports_best_and_history(student: Student):
    for index, generations in ((12, 12), (13, 15)):
        evolution = Evolved(student, "evolve", start_of(index, 10, 8), generations, index)
        evolution.expect_report()


@loop.check(7)
def fitness_rises(student: Student):
    evolution = Evolved(student, "evolve", start_of(14, 20, 8), 60, 14)
    evolution.expect_lineage()
    first, last = (evolution.distance[g].min() for g in (0, -1))
    expect(
        last < 0.3 * first,
        f"{student.said}: the fitness to reach is 0; without luck the best went from {-first:.3f} "
        f"to {-last:.3f} in 60 generations, but it should come much nearer.",
    )


# ------------------------------------------------------------------- 3.5
climber = exercise.task("3.5", "A hill climber", needs=("3.4",), refused=TOOL)


@climber.check(5)
def never_steps_down(student: Student):
    start = start_of(15, 9)
    climb = Evolved(student, "hill_climb", start, 80, 15)
    first = climb.populations[0]
    expect_close(f"{student.said}: both individuals at first", first, [start] * 2, 1e-6)
    climb.expect_lineage()
    distance = np.array([each.min() for each in climb.distance])
    expect(
        bool(np.all(np.diff(distance) <= 1e-12)),
        f"{student.said}: the solution that was kept got worse in a generation.",
    )
    expect(distance[-1] < distance[0] / 2, f"{student.said}: there was hardly any progress.")


@climber.check(3)
def reports_like_evolve(student: Student):
    climb = Evolved(student, "hill_climb", start_of(16, 5), 15, 16)
    climb.expect_report()
    expect(
        not np.array_equal(climb.populations[0], climb.populations[-1]),
        f"{student.said} evaluated the same two individuals in all generations.",
    )


# ------------------------------------------------------------------- 3.6
replications = exercise.task("3.6", "Replications")


def replicated(module, histories, seeds):
    """Runs the student's replicate on prepared curves."""

    def experiment(seed):
        history = [float(value) for value in histories[seeds.index(seed)]]
        return {"history": history, "fitness": max(history), "best": None, "population": None}

    return module.replicate(experiment, seeds)


def curves_of(student: Student, n: int, seed: int):
    histories = np.random.default_rng(seed).normal(size=(n, 15))
    seeds = [int(s) for s in np.random.default_rng(seed).permutation(50)[:n]]
    result = student.run(
        replicated, histories, seeds, said=f"replicate(experiment, {show(seeds, 30)})"
    )
    expect_fields(student.said, result, "mean", "deviation", "best")
    return histories, result


@replications.check(5)
def mean_and_best(student: Student):
    histories, result = curves_of(student, 6, exercise.seed(14))
    expect_close(f"{student.said}: mean", result["mean"], histories.mean(axis=0))
    expect_close(f"{student.said}: best", result["best"], histories.max(axis=1))


@replications.check(4)
def deviation(student: Student):
    histories, result = curves_of(student, 5, exercise.seed(15))
    expect_close(f"{student.said}: deviation", result["deviation"], histories.std(axis=0, ddof=1))


@replications.check(1)
def a_single_replication(student: Student):
    for n in (1, 2):
        histories, result = curves_of(student, n, exercise.seed(15 + n))
        wanted = np.zeros(15) if n == 1 else histories.std(axis=0, ddof=1)
        expect_close(f"{student.said}: deviation", result["deviation"], wanted)


# ------------------------------------------------------------------- 3.7
training = exercise.task("3.7", "CartPole and Pendulum", seconds=90, needs=("3.1", "3.2", "3.4"))


def trained(module, environment, seed, signs):
    """Trains where each parameter of the robot may count with the other sign."""
    from botschool.course.rewiring import rewired

    with rewired(signs):
        return module.train(environment, seed)


class Trained:
    """What train makes of a robot: its mean return over 20 episodes that it never met."""

    def __init__(self, student: Student, environment: str, index: int, signs: np.ndarray) -> None:
        seed, robot = exercise.seed(index) % 100_000, Robot(environment)
        self.said = f"train({environment!r}, seed={seed})"
        answer = student.run(trained, environment, seed, signs, said=self.said)
        self.parameters = expect_array(self.said, answer, (robot.nbiases + robot.nweights,))
        meant = (self.parameters * signs)[None]
        self.mean = float(robot.evaluate(meant, exercise.seed(index + 10), episodes=20)[0])


def expect_trained(student: Student, environment: str, index: int, wanted: float, told: str):
    """Two seeds, and a robot whose parameters have other signs, drawn in secret.

    told: what is said of a mean that is not enough.
    """
    robot = Robot(environment)
    size = robot.nbiases + robot.nweights
    signs = np.random.default_rng(exercise.seed(index + 20)).choice([-1.0, 1.0], size=size)
    runs = [Trained(student, environment, each, signs) for each in (index, index + 1)]
    for number, run in enumerate(runs):
        if run.mean >= wanted:
            continue
        plain = Trained(student, environment, index + number, np.ones(size))
        expect(plain.mean >= wanted, f"{plain.said}: {told.format(plain.mean)}")
        raise Wrong(
            f"{run.said}: the controller of the ordinary robot reaches {plain.mean:.0f}, but that "
            f"of a robot on which some parameters count with the other sign only {run.mean:.0f}. "
            "To evolution this is the same task: let robot.evaluate alone decide what is good, and "
            "begin without knowing any parameters."
        )
    expect(
        not np.array_equal(runs[0].parameters, runs[1].parameters),
        f"{runs[1].said} gave the very same parameters as another seed: evolve them.",
    )


@training.check(10)
def keeps_the_pole_up(student: Student):
    told = (
        "the controller keeps the pole up for {:.1f} steps on average over 20 new episodes, but "
        "195 are asked for."
    )
    expect_trained(student, "CartPole-v0", 20, 195, told)


@training.check(10)
def swings_up(student: Student):
    told = (
        "the controller reaches {:.0f} on average over 20 new episodes; random ones reach about "
        "-1200, and -600 is asked for."
    )
    expect_trained(student, "Pendulum-v1", 22, -600, told)
