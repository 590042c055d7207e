"""Grader of exercise 15; run it with `make test-ex15`.

Nothing here is a matter of luck: the arena knows no chance, and the grader plays every chase
again. Robots are made by hand, with numbers from the grading seed, so that some predators catch
some prey soon, some late, and some never; no evolved run is needed. Tables and matrices are drawn
from the same seed, or made up so that the answer is known: steady progress, circles, none.
"""

import itertools
from collections.abc import Callable
from functools import partial

import numpy as np
from slips import (
    ENDS,
    measures_of,
    mistaken_at_limits,
    mistaken_cycles,
    mistaken_descriptions,
    mistaken_ends,
    mistaken_fitness,
    mistaken_intervals,
    mistaken_means,
    mistaken_parts,
    mistaken_profile,
    mistaken_progress,
    mistaken_tables,
)

from botschool import arena as arenas
from botschool.course.coevolution import play, robot
from botschool.grading import (
    Exercise,
    Student,
    expect,
    expect_array,
    expect_close,
    expect_fields,
)

exercise = Exercise(15, "The master tournament", file="master_tournament.py")
PARAMETERS, UNITS, INPUTS = 4977, 25, 24
EXACT = 1e-9
TOOL = ("botschool.analysis.tournament",)
"""What the tool's own tournament has for tasks 15.3, 15.5 and 15.7."""


def rng_of(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


# ------------------------------------------------------------------- robots made by hand
def made(rng: np.random.Generator, speed: float, towards: float) -> np.ndarray:
    """A robot that turns towards the other one (below 0: away from it), and wavers a little."""
    genotype = 0.03 * rng.normal(size=PARAMETERS)
    gates = genotype[27 : 27 + UNITS * 4 * (INPUTS + UNITS)].reshape(UNITS, 4, INPUTS + UNITS)
    gates[0, :3, 23] = -6, 6, 6  # the constant input: forget all, let all in, show all
    gates[0, 3, 8:12], gates[0, 3, 12:16] = (
        towards,
        -towards,
    )  # the left and the right of the camera
    genotype[-2 * UNITS], genotype[-UNITS] = -0.8, 0.8
    genotype[25:27] = speed + rng.normal(0, 0.05, 2)
    return genotype


def predators_of(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.array([made(rng, rng.uniform(0.3, 1), rng.uniform(-0.2, 1.5)) for _ in range(count)])


def prey_of(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.array([made(rng, rng.uniform(0, 0.9), rng.uniform(-1.5, 0.3)) for _ in range(count)])


def played(predator: np.ndarray, prey: np.ndarray, maxsteps: int) -> dict:
    arena = arenas.make("predprey", max_steps=maxsteps)
    arena.reset(seed=1)
    networks = [robot(predator), robot(prey)]
    poses, total = [arena.robots.copy()], 0.0
    while not arena.done:
        for k, network in enumerate(networks):
            network.observation = arena.observation[24 * k : 24 * k + 24]
            network.step()
        arena.action[:2], arena.action[2:] = networks[0].action, networks[1].action
        total += arena.step()
        poses.append(arena.robots.copy())
    return {"poses": np.array(poses), "caught": arena.terminated, "fitness": total}


def some_chase(rng: np.random.Generator, caught: bool, maxsteps: int) -> tuple:
    """A predator, a prey and their chase, with the end that is wanted."""
    while True:
        pair = predators_of(rng, 1)[0], prey_of(rng, 1)[0]
        found = played(*pair, maxsteps)
        if found["caught"] == caught:
            return *pair, found


# ------------------------------------------------------------------- 15.1
chasing = exercise.task("15.1", "A chase, recorded")


def say_where_it_begins(said: str, poses, expected: np.ndarray) -> None:
    """Name the first pose that is wrong, and what else has it, if the robots move otherwise."""
    if np.ndim(poses) != 3 or np.shape(poses)[1:] != (2, 3):
        return
    both = min(len(poses), len(expected))
    wrong = ~np.isclose(poses[:both], expected[:both], rtol=1e-6, atol=1e-6).all(axis=2)
    if not wrong.any() or alike_but_for_an_end(np.asarray(poses), expected):
        return
    step = int(wrong.any(axis=1).argmax())
    who = " and ".join(np.array(["predator", "prey"])[wrong[step]])
    one = int(wrong[step].argmax())
    got, right = (np.round(each[step][one], 3).tolist() for each in (poses, expected))
    cause = ""
    rest = [np.allclose(poses[step][k], poses[step - 1][k], atol=1e-6) for k in range(2)]
    still = step > 0 and all(rest[k] for k in np.flatnonzero(wrong[step]))
    if np.allclose(poses[:both], expected[:both, ::-1], atol=1e-6):
        cause = " The prey stands first in the poses, but the predator should."
    elif step == 1 and len(poses) == len(expected) > 2 and np.allclose(poses[1:], expected[:-1]):
        cause = (
            " Each pose stands one place too late: the start is there twice, and the pose after "
            "the last step is missing."
        )
    elif twice_after_the_start(np.asarray(poses), expected):
        cause = " Each pose after the start is there twice, but should be there once."
    elif still:
        cause = (
            f" In your poses the {who} {'have' if wrong[step].all() else 'has'} not moved since "
            f"poses[{step - 1}]. The wheels of both robots should be set before each arena.step(), "
            "and the poses kept after it."
        )
    elif step == 1 and wrong[1].all():
        cause = (
            " Both robots' poses are wrong already after the first step. Check, for example, that "
            "the networks are new and each makes one step, that each gets its own robot's "
            "observation (24 numbers, the predator's come first), and that the action holds the "
            "left and the right wheel of the predator, then those of the prey."
        )
    elif step > 1:
        cause = (
            " All poses before it are right. Check, for example, that each network is made once "
            "for the whole chase, that it gets its own robot's observation anew in each step, and "
            "that the arena is made with max_steps=maxsteps (robots sense the time)."
        )
    expect(
        False,
        f"{said}: poses[{step}] is wrong for the {who}. The {who.split()[0]}'s pose "
        f"(x, y, heading) is {got}, but {right} was expected.{cause}",
    )


def twice_after_the_start(poses: np.ndarray, expected: np.ndarray) -> bool:
    """Whether each right pose after the start is there twice."""
    once = poses[1::2]
    return (
        len(poses) % 2 == 1
        and len(poses) > 4
        and np.allclose(once, poses[2::2])
        and len(once) < len(expected)
        and np.allclose(once, expected[1 : len(once) + 1], atol=1e-6)
    )


def alike_but_for_an_end(poses: np.ndarray, expected: np.ndarray) -> bool:
    """Whether poses are right, but one is missing or too many."""
    for one, other in ((poses, expected), (expected, poses)):
        if len(one) == len(other) + 1:
            return any(np.allclose(part, other, atol=1e-6) for part in (one[1:], one[:-1]))
    return False


def compare_chase(student: Student, predator, prey, expected: dict, maxsteps: int) -> None:
    answer = student.call("chase", predator, prey, maxsteps)
    said = f"chase(predator, prey, maxsteps={maxsteps})"
    found = expect_fields(said, answer, *expected)
    say_where_it_begins(said, found[0], expected["poses"])
    for name, value in zip(expected, found, strict=True):
        mistakes = mistaken_fitness(expected, maxsteps) if name == "fitness" else None
        expect_close(f"{said}: {name}", value, expected[name], 1e-6, mistakes)


@chasing.check(8)
def until_it_is_caught(student: Student):
    rng = rng_of(1)
    for maxsteps in (120, 90):
        predator, prey, expected = some_chase(rng, True, maxsteps)
        compare_chase(student, predator, prey, expected, maxsteps)
        last = len(expected["poses"]) - 1  # in the very last step: caught, and the fitness is 0
        compare_chase(student, predator, prey, played(predator, prey, last), last)


@chasing.check(5)
def until_time_is_up(student: Student):
    rng = rng_of(2)
    for maxsteps in (1, 15, 60):
        compare_chase(student, *some_chase(rng, False, maxsteps), maxsteps)


@chasing.check(5)
def one_after_another(student: Student):
    """A chase does not depend on the one before it."""
    rng = rng_of(3)
    predator, prey, expected = some_chase(rng, True, 100)
    for _ in range(2):
        compare_chase(student, predator, prey, expected, 100)
    compare_chase(student, *some_chase(rng, False, 40), 40)


# ------------------------------------------------------------------- 15.2
meeting = exercise.task("15.2", "Everybody meets everybody")


def all_chases(predators: list, prey: list, maxsteps: int) -> np.ndarray:
    hunters, hunted = np.concatenate(predators), np.concatenate(prey)
    rows, columns = np.indices((len(hunters), len(hunted)))
    fitness = play(hunters, hunted, np.stack([rows.ravel(), columns.ravel()], axis=1), maxsteps)
    return fitness.reshape(len(predators), -1, len(prey), len(prey[0]))


def groups(rng: np.random.Generator, generations: tuple, individuals: tuple) -> tuple:
    (g, h), (n, m) = generations, individuals
    return [predators_of(rng, n) for _ in range(g)], [prey_of(rng, m) for _ in range(h)]


def compare_tables(student: Student, answer, expected: np.ndarray) -> None:
    expect_close(student.said, answer, expected, 1e-6, lambda: mistaken_tables(expected))


@meeting.check(8)
def as_many_of_both(student: Student):
    rng = rng_of(4)
    for count, individuals, maxsteps in ((1, 2, 80), (3, 2, 60)):
        both = groups(rng, (count, count), (individuals, individuals))
        answer = student.call("tournament", *both, maxsteps)
        compare_tables(student, answer, all_chases(*both, maxsteps))


@meeting.check(6)
def of_different_sizes(student: Student):
    rng = rng_of(5)
    for generations, individuals in (((2, 3), (3, 1)), ((3, 2), (2, 4))):
        both = groups(rng, generations, individuals)
        answer = student.call("tournament", *both, 70)
        compare_tables(student, answer, all_chases(*both, 70))


# ------------------------------------------------------------------- 15.3
averaging = exercise.task("15.3", "The master matrix", refused=TOOL)


def random_table(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """Fitness as in a tournament: many 0, all others spread."""
    return np.where(rng.random(shape) < 0.3, 0.0, rng.random(shape) ** 0.5)


def means_of(table: np.ndarray) -> np.ndarray:
    return np.einsum("gihj->gh", table) / (table.shape[1] * table.shape[3])


TABLES = ((2, 3, 2, 3), (4, 2, 4, 5), (3, 1, 5, 2))


def compare_means(student: Student, index: int, side: str, turned) -> None:
    rng = rng_of(index)
    for shape in TABLES:
        table = random_table(rng, *shape)
        said = f"master(<table {shape}>)"
        answer = student.call("master", table)
        (value,) = expect_fields(said, answer, side)
        wrong = mistaken_means(table)
        mistakes = {text: turned(each) for text, each in wrong.items() if each.ndim == 2}
        mean = means_of(table)
        expect_close(f"{said}: {side}", value, turned(mean), EXACT, mistakes)


@averaging.check(5)
def of_the_predators(student: Student):
    compare_means(student, 6, "predators", lambda mean: mean)


@averaging.check(5)
def of_the_prey(student: Student):
    compare_means(student, 7, "prey", lambda mean: 1 - mean.T)


# ------------------------------------------------------------------- matrices
def random_matrix(rng: np.random.Generator, count: int) -> np.ndarray:
    return means_of(random_table(rng, count, 2, count, 3))


def with_zeros(rng: np.random.Generator, count: int) -> np.ndarray:
    """Some generations have no success at all against some competitors."""
    matrix = random_matrix(rng, count)
    matrix[[2, 0, 1], [0, 2, 3]] = 0
    return matrix


def steady(rng: np.random.Generator, count: int) -> np.ndarray:
    """Each generation does better than the one before it, against all competitors."""
    strength = np.cumsum(rng.uniform(0.02, 0.08, (2, count)), axis=1)
    return 0.5 + strength[0][:, None] - strength[1]


def circles(rng: np.random.Generator, count: int) -> np.ndarray:
    """Rock, paper and scissors: nothing but when they lived decides who wins."""
    phase = 2 * np.pi * np.arange(count) / 3
    return np.round(0.5 + rng.uniform(0.2, 0.4) * np.sin(phase[:, None] - phase), 6)


def standstill(rng: np.random.Generator, count: int) -> np.ndarray:
    """All generations are equally good, all competitors differ."""
    return np.tile(rng.random(count), (count, 1))


MATRICES = ((random_matrix, 2), (random_matrix, 6), (steady, 5), (circles, 7), (standstill, 4))


def of_part(mistaken: Callable, argument: np.ndarray, part: str) -> dict:
    """What mistakes make of a part of an answer."""
    return mistaken(argument)[part]


def compare_parts(
    student: Student,
    name: str,
    solve: Callable,
    index: int,
    parts: tuple,
    mistaken: Callable,
    kinds: tuple = MATRICES,
) -> None:
    """The parts of the dict that a function gives for matrices of all kinds.

    mistaken(matrix): part -> what mistakes make of it.
    """
    rng = rng_of(index)
    for kind, count in kinds:
        matrix = kind(rng, count)
        said = f"{name}(<{kind.__name__.replace('_', ' ')}, {count} generations>)"
        if kind is random_matrix:
            said = f"{name}(<matrix {matrix.shape}>)"
        answer, expected = student.call(name, matrix), solve(matrix)
        for part, value in zip(parts, expect_fields(said, answer, *parts), strict=True):
            made = partial(of_part, mistaken, matrix, part)
            expect_close(f"{said}: {part}", value, expected[part], EXACT, made)


# ------------------------------------------------------------------- 15.4
times = exercise.task("15.4", "Ancient, present and future competitors")


def profile_of(matrix: np.ndarray) -> dict:
    count = len(matrix)
    return {
        "ancient": [sum(matrix[g, k] for k in range(g)) / g for g in range(1, count)],
        "present": [matrix[g, g] for g in range(count)],
        "future": [
            sum(matrix[g, k] for k in range(g + 1, count)) / (count - 1 - g)
            for g in range(count - 1)
        ],
    }


@times.check(4)
def against_the_present(student: Student):
    compare_parts(student, "profile", profile_of, 8, ("present",), mistaken_profile)


@times.check(8)
def against_the_past_and_the_future(student: Student):
    given = student, "profile", profile_of, 9, ("ancient", "future"), mistaken_profile
    compare_parts(*given)
    compare_parts(*given, kinds=((with_zeros, 4), (with_zeros, 7)))


# ------------------------------------------------------------------- 15.5
gaining = exercise.task("15.5", "Progress, or running in circles?", refused=TOOL)


def progress_of(matrix: np.ndarray) -> dict:
    count = len(matrix)
    better = {g: [matrix[g, k] - matrix[g - 1, k] for k in range(count)] for g in range(1, count)}
    cases = [better[g][k] for g in better for k in range(g)]
    points = [1.0 if case > 0 else 0.5 if case == 0 else 0.0 for case in cases]
    return {
        "historical": [np.mean(better[g][:g]) for g in better],
        "global": [np.mean(better[g]) for g in better],
        "share": np.mean(points),
    }


def exact_matrix(rng: np.random.Generator, count: int) -> np.ndarray:
    """Eighths, which computers add without an error: differences may be exactly 0."""
    return rng.integers(0, 9, (count, count)) / 8


def draws(rng: np.random.Generator, count: int) -> np.ndarray:
    """Nobody wins: each match and its return match end alike."""
    matrix = exact_matrix(rng, count)
    return np.maximum(matrix, matrix.T)


@gaining.check(7)
def over_the_predecessor(student: Student):
    compare_parts(student, "progress", progress_of, 10, ("historical", "global"), mistaken_progress)


@gaining.check(4)
def share_of_cases(student: Student):
    rng = rng_of(11)
    for kind, count in ((random_matrix, 2), (random_matrix, 6), (steady, 5), (standstill, 4),
                        *[(exact_matrix, more) for more in (7, 9, 11, 13)]):  # fmt: skip
        matrix = kind(rng, count)
        said = f"progress(<matrix {matrix.shape}>)"
        (value,) = expect_fields(said, student.call("progress", matrix), "share")
        made = partial(of_part, mistaken_progress, matrix, "share")
        expect_close(f"{said}: share", value, progress_of(matrix)["share"], EXACT, made)


def cycles_of(matrix: np.ndarray) -> float:
    count, found, all_of_them = len(matrix), 0, 0
    for a in range(count):
        for b in range(a + 1, count):
            for c in range(b + 1, count):
                won = [matrix[i, j] > matrix[j, i] for i, j in ((a, b), (b, c), (c, a))]
                lost = [matrix[i, j] < matrix[j, i] for i, j in ((a, b), (b, c), (c, a))]
                found += all(won) or all(lost)
                all_of_them += 1
    return found / all_of_them if all_of_them else 0.0


@gaining.check(5)
def in_circles(student: Student):
    rng = rng_of(12)
    for kind, count in ((circles, 3), (steady, 5), (random_matrix, 2), (random_matrix, 6),
                        (exact_matrix, 6), (exact_matrix, 8), (circles, 8),
                        (exact_matrix, 9), (exact_matrix, 11), (draws, 3), (draws, 5)):  # fmt: skip
        matrix = kind(rng, count)
        answer = student.call("cycles", matrix)
        said, made = f"cycles(<matrix {matrix.shape}>)", partial(mistaken_cycles, matrix)
        expect_close(said, answer, cycles_of(matrix), EXACT, made)


# ------------------------------------------------------------------- 15.6
hiding = exercise.task("15.6", "What contemporary fitness hides")


def parts_of(matrix: np.ndarray) -> dict:
    later = range(1, len(matrix))
    return {
        "change": [matrix[g, g] - matrix[0, 0] for g in later],
        "own": [matrix[g].mean() - matrix[0].mean() for g in later],
        "others": [matrix[:, g].mean() - matrix[:, 0].mean() for g in later],
    }


@hiding.check(3)
def what_is_seen(student: Student):
    compare_parts(student, "red_queen", parts_of, 13, ("change",), mistaken_parts)


@hiding.check(7)
def what_is_hidden(student: Student):
    compare_parts(student, "red_queen", parts_of, 14, ("own", "others"), mistaken_parts)


# ------------------------------------------------------------------- 15.7
sure = exercise.task("15.7", "How sure is it?", refused=TOOL)


def measured(module, table, weights, seed, resamples):
    """The interval of a measure in which every entry of the table has a weight of its own."""
    import numpy

    def measure(resample):
        if numpy.shape(resample) != weights.shape:
            raise ValueError(
                f"measure was given a table of shape {numpy.shape(resample)}, but the shape should "
                f"be {weights.shape}"
            )
        return float((weights * resample).sum())

    options = {} if resamples is None else {"resamples": resamples}
    return module.interval(table, measure, numpy.random.default_rng(seed), **options)


def compare_intervals(student: Student, index: int, cases: tuple, weigh) -> None:
    rng = rng_of(index)
    for shape, resamples in cases:
        table = random_table(rng, *shape)
        weights, seed = weigh(rng, shape), int(rng.integers(1 << 31))
        more = "" if resamples is None else f", resamples={resamples}"
        said = f"interval(<table {shape}>, measure, np.random.default_rng({seed}){more})"
        answer = student.run(measured, table, weights, seed, resamples, said=said)
        draws = table, weights, seed, resamples or 300
        values = measures_of(*draws)
        expected = np.quantile(values, ENDS)
        got, mistakes = expect_array(said, answer, (2,)), {}
        if np.abs(got - expected).max() > 1e-6:
            mistakes = mistaken_ends(values, got)
            mistakes |= mistaken_intervals(*draws)
            other = student.run(measured, table, weights, seed + 1, resamples, said=said)
            if np.array_equal(other, got) and got[0] != got[1]:
                mistakes[
                    "The interval is the same for another rng, but the given one should decide."
                ] = got
        expect_close(said, answer, expected, 1e-8, mistakes)


@sure.check(6)
def of_a_mean(student: Student):
    def mean(rng, shape):
        return np.full(shape, 1 / np.prod(shape))

    compare_intervals(student, 15, (((2, 3, 2, 3), 40), ((3, 4, 3, 4), None)), mean)


@sure.check(4)
def of_any_measure(student: Student):
    def uneven(rng, shape):
        return rng.normal(size=shape)

    compare_intervals(student, 16, (((2, 4, 3, 2), 25), ((3, 1, 2, 5), 60)), uneven)


# ------------------------------------------------------------------- 15.8
behaviour = exercise.task("15.8", "How do they behave?")


def wandering(rng: np.random.Generator, steps: int) -> np.ndarray:
    """Made-up poses of two robots that drive to and fro, turn over and over, and meet walls."""
    heading = rng.uniform(0, 6.28, 2) + np.cumsum(rng.normal(0, 0.9, (steps + 1, 2)), axis=0)
    stride = rng.normal(10, 30, (steps + 1, 2))
    ways = []
    for start, direction in zip(rng.uniform(100, 2900, (2, 2)), (np.cos, np.sin), strict=True):
        way = start + np.cumsum(stride * direction(heading), axis=0)
        ways.append(85 + np.abs((way - 85 + 2830) % 5660 - 2830))  # reflected by the walls
    return np.stack([*ways, heading % (2 * np.pi)], axis=-1)


def described(poses: np.ndarray) -> dict:
    told: dict[str, list] = {"distance": []}
    for now, then in itertools.pairwise(poses):
        told["distance"].append(np.hypot(*(now[0] - now[1])[:2]))
        for k in range(2):
            (x, y, heading), (x2, y2, heading2) = now[k], then[k]
            turned = heading2 - heading
            dx, dy = (now[1 - k] - now[k])[:2]
            bearing = np.arctan2(dy, dx) - heading
            values = {
                "speed": 10 * np.hypot(x2 - x, y2 - y),
                "turning": 10 * abs(np.arctan2(np.sin(turned), np.cos(turned))),
                "backwards": (x2 - x) * np.cos(heading) + (y2 - y) * np.sin(heading) < 0,
                "facing": abs(np.arctan2(np.sin(bearing), np.cos(bearing))) < np.pi / 4,
                "wall": min(x, y, 3000 - x, 3000 - y) < 300,
            }
            for name, value in values.items():
                told.setdefault(name, []).append(value)
    means = {name: np.reshape(values, (-1, 2)).mean(axis=0) for name, values in told.items()
             if name != "distance"}  # fmt: skip
    return {**means, "distance": np.mean(told["distance"])}


NEAR, FAR = (150.0, 299.0), (301.0, 1500.0)
"""Distances from a wall."""


def along_the_walls(rng: np.random.Generator) -> np.ndarray:
    """Poses at all four walls, near them and not quite near, whatever the seed.

    Both robots begin at a wall and end far from it, so a step's beginning is not its end.
    """
    ways = []
    for _ in range(2):
        places = [
            (distance if low else 3000 - distance, 1500.0)[:: 1 if across else -1]
            for distance in (*NEAR, *FAR)
            for low in (True, False)
            for across in (True, False)
        ]
        inner = [places[i] for i in rng.permutation(np.arange(1, len(places)))]
        ways.append([places[0], *inner[: int(rng.integers(9, 13))], *[(1500.0, 1400.0)] * 9][:14])
    heading = rng.uniform(-3.14, 6.28, (14, 2, 1))  # whoever writes into the poses shows
    return np.concatenate([np.array(ways).swapaxes(0, 1), heading], axis=2)


def at_the_limits() -> np.ndarray:
    """Exactly 300 mm from each wall; at rest, or moved straight to the side; just about 45 degrees.

    Numbers that no formula rounds: headings are 0, and angles a degree off the limit.
    """
    angles = np.radians([44, -44, 46, -46, 134, 0, 180])
    predator = [(300, 1500), (1500, 300), (2700, 1500), (1500, 2700), (1500, 1500), (1500, 1600)]
    predator = np.array([*predator, (1500, 1600)], dtype=float)
    prey = predator + 500 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    poses = np.zeros((8, 2, 3))
    poses[:7, 0, :2], poses[:7, 1, :2] = predator, prey
    poses[7] = poses[6]
    return poses


def compare_described(
    student: Student, walks: list[np.ndarray], names: tuple, mistaken: Callable
) -> None:
    for poses in walks:
        answer, expected = student.call("describe", poses), described(poses)
        for name, value in zip(names, expect_fields(student.said, answer, *names), strict=True):
            made = partial(of_part, mistaken, poses, name)
            expect_close(f"{student.said}: {name}", value, expected[name], 1e-7, made)


def walks_of(index: int) -> list[np.ndarray]:
    rng = rng_of(index)
    walks = [wandering(rng, steps) for steps in (1, 30, 150)]
    return [*walks, some_chase(rng, True, 100)[2]["poses"]]


@behaviour.check(5)
def how_they_move(student: Student):
    names = ("speed", "turning", "backwards")
    compare_described(student, walks_of(17), names, mistaken_descriptions)


@behaviour.check(4)
def where_they_are(student: Student):
    names = ("facing", "wall", "distance")
    compare_described(student, walks_of(18), names, mistaken_descriptions)
    compare_described(student, [along_the_walls(rng_of(19))], ("wall",), mistaken_descriptions)


@behaviour.check(1)
def at_limits_and_at_rest(student: Student):
    walk = at_the_limits()
    names = ("backwards", "facing", "wall")
    compare_described(student, [walk, walk[:, ::-1]], names, mistaken_at_limits)
