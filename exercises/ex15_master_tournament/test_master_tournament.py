"""Grader of exercise 15; run it with `botschool grade 15`.

All tasks compare with our solution. The arena knows no chance. Robots are made by hand, so that
some predators catch some prey soon, some late, and some never; no evolved run is needed. Tables and
matrices are random, or made up: steady progress, circles, none.
"""

from functools import partial

import numpy as np

from botschool.course.coevolution import play
from botschool.grading import Exercise, same

exercise = Exercise(15, "The master tournament", file="master_tournament.py")
PARAMETERS, UNITS, INPUTS = 4977, 25, 24


# ------------------------------------------------------------------- robots made by hand
def made(rng, speed, towards):
    """A robot that turns towards the other one (below 0: away from it), and wavers a little."""
    genotype = 0.03 * rng.normal(size=PARAMETERS)
    gates = genotype[27 : 27 + UNITS * 4 * (INPUTS + UNITS)].reshape(UNITS, 4, INPUTS + UNITS)
    gates[0, :3, 23] = -6, 6, 6  # the constant input: forget all, let all in, show all
    gates[0, 3, 8:12], gates[0, 3, 12:16] = towards, -towards  # the camera, left and right
    genotype[-2 * UNITS], genotype[-UNITS] = -0.8, 0.8
    genotype[25:27] = speed + rng.normal(0, 0.05, 2)
    return genotype


def predators_of(rng, count):
    return np.array([made(rng, rng.uniform(0.3, 1), rng.uniform(-0.2, 1.5)) for _ in range(count)])


def prey_of(rng, count):
    return np.array([made(rng, rng.uniform(0, 0.9), rng.uniform(-1.5, 0.3)) for _ in range(count)])


def fitness_of(pair, maxsteps):
    predator, prey = pair
    return play(predator[None], prey[None], np.array([[0, 0]]), maxsteps)[0]


def some_pair(rng, caught, maxsteps):
    """A predator and a prey, whose chase has the end that is wanted."""
    while True:
        pair = predators_of(rng, 1)[0], prey_of(rng, 1)[0]
        if (fitness_of(pair, maxsteps) > 0) == caught:
            return pair


chasing = exercise.task("15.1", "A chase, recorded")


@same(chasing, 11, "chase", 1e-6)
def until_it_is_caught(rng):
    for maxsteps in (90, 120):
        pair = some_pair(rng, True, maxsteps)
        yield *pair, maxsteps
        # in the very last step: caught, and the fitness is 0
        yield *pair, round((1 - fitness_of(pair, maxsteps)) * maxsteps)
    yield some_pair(rng, True, 2000)


@same(chasing, 7, "chase", 1e-6)
def until_time_is_up(rng):
    for maxsteps in (1, 15, 60):
        yield *some_pair(rng, False, maxsteps), maxsteps


meeting = exercise.task("15.2", "Everybody meets everybody")


def groups(rng, generations, individuals, maxsteps):
    (g, h), (n, m) = generations, individuals
    return [predators_of(rng, n) for _ in range(g)], [prey_of(rng, m) for _ in range(h)], maxsteps


@same(meeting, 8, "tournament", 1e-6)
def as_many_of_both(rng):
    yield groups(rng, (1, 1), (2, 2), 80)
    yield groups(rng, (3, 3), (2, 2), 60)


@same(meeting, 6, "tournament", 1e-6)
def of_different_sizes(rng):
    yield groups(rng, (2, 3), (3, 1), 70)
    yield groups(rng, (3, 2), (2, 4), 70)


averaging = exercise.task("15.3", "The master matrix")


def random_table(rng, *shape):
    """Fitness as in a tournament: many 0, all others spread."""
    return np.where(rng.random(shape) < 0.3, 0.0, np.round(rng.random(shape) ** 0.5, 2))


def tables(rng):
    yield from (random_table(rng, *shape) for shape in ((1, 2, 2, 3), (2, 3, 2, 3)))
    yield from (random_table(rng, *shape) for shape in ((4, 2, 4, 5), (3, 1, 5, 2)))


same(averaging, 5, "master", parts=("predators",), name="of_the_predators")(tables)
same(averaging, 5, "master", parts=("prey",), name="of_the_prey")(tables)


# ------------------------------------------------------------------- matrices
def random_matrix(rng, count):
    return random_table(rng, count, count)


def steady(rng, count):
    """Each generation does better than the one before it, against all competitors."""
    strength = np.cumsum(rng.uniform(0.02, 0.08, (2, count)), axis=1)
    return np.round(0.5 + strength[0][:, None] - strength[1], 3)


def circles(rng, count):
    """Rock, paper and scissors: nothing but when they lived decides who wins."""
    phase = 2 * np.pi * np.arange(count) / 3
    return np.round(0.5 + rng.uniform(0.2, 0.4) * np.sin(phase[:, None] - phase), 6)


def standstill(rng, count):
    """All generations are equally good, all competitors differ."""
    return np.tile(np.round(rng.random(count), 2), (count, 1))


def exact_matrix(rng, count):
    """Eighths, which computers add without an error: differences may be exactly 0."""
    return rng.integers(0, 9, (count, count)) / 8


def draws(rng, count):
    """Nobody wins: each match and its return match end alike."""
    matrix = exact_matrix(rng, count)
    return np.maximum(matrix, matrix.T)


def with_zeros(rng, count):
    """Some generations have no success at all against some competitors."""
    matrix = random_matrix(rng, count)
    matrix[[2, 0, 1], [0, 2, 3]] = 0
    return matrix


def matrices(rng):
    yield from (random_matrix(rng, count) for count in (2, 3, 6))
    yield from (steady(rng, 5), circles(rng, 7), standstill(rng, 4))
    yield from (with_zeros(rng, count) for count in (4, 7))


of_matrices = partial(same, off={"one": "there are at least two generations"})

times = exercise.task("15.4", "Ancient, present and future competitors")
of_matrices(times, 4, "profile", parts=("present",), name="against_the_present")(matrices)
of_matrices(
    times, 8, "profile", parts=("ancient", "future"), name="against_the_past_and_the_future"
)(matrices)

gaining = exercise.task("15.5", "Progress, or running in circles?")
of_matrices(gaining, 7, "progress", parts=("historical", "global"), name="over_the_predecessor")(
    matrices
)


@of_matrices(gaining, 4, "progress", parts=("share",))
def share_of_cases(rng):
    for kind, count in ((random_matrix, 2), (random_matrix, 6), (steady, 5), (standstill, 4)):
        yield kind(rng, count)
    yield from (exact_matrix(rng, count) for count in (3, 7, 9, 11, 13))


@same(gaining, 5, "cycles")
def in_circles(rng):
    for kind, counts in ((circles, (3, 8)), (steady, (2, 5)), (random_matrix, (2, 6)),
                         (exact_matrix, (4, 6, 8, 9, 11)), (draws, (3, 5))):  # fmt: skip
        yield from (kind(rng, count) for count in counts)


hiding = exercise.task("15.6", "What contemporary fitness hides")
of_matrices(hiding, 3, "red_queen", parts=("change",), name="what_is_seen")(matrices)
of_matrices(hiding, 7, "red_queen", parts=("own", "others"), name="what_is_hidden")(matrices)

sure = exercise.task("15.7", "How sure is it?")


def measured(module, table, weights, seed, options):
    """interval({0}, measure, np.random.default_rng({2}), **{3})"""
    import numpy

    shapes = set()

    def measure(resample):
        shapes.add(str(numpy.shape(resample)))
        return float(weights.ravel() @ numpy.resize(resample, weights.size))

    found = module.interval(table, measure, numpy.random.default_rng(seed), **options)
    return {"the shapes of what measure gets": sorted(shapes), "(low, high)": found}


def case(rng, shape, weights, **options):
    return random_table(rng, *shape), weights, int(rng.integers(1 << 31)), options


@same(sure, 6, measured, 1e-8)
def of_a_mean(rng):
    for shape, options in (((2, 3, 2, 3), {"resamples": 40}), ((3, 4, 3, 4), {})):
        yield case(rng, shape, np.full(shape, 1 / np.prod(shape)), **options)


@same(sure, 4, measured, 1e-8)
def of_any_measure(rng):
    for shape, resamples in (((2, 4, 3, 2), 25), ((3, 1, 2, 5), 60)):
        yield case(rng, shape, rng.normal(size=shape), resamples=resamples)


behaviour = exercise.task("15.8", "How do they behave?")
NO_POSES = "poses have the shape (T + 1, 2, 3)"
of_poses = partial(same, tolerance=1e-7, off={"square": NO_POSES, "one": NO_POSES})


def wandering(rng, steps, least=0.0):
    """Made-up poses of two robots that drive to and fro, turn over and over, and meet walls."""
    heading = rng.uniform(0, 6.28, 2) + np.cumsum(rng.normal(0, 0.9, (steps + 1, 2)), axis=0)
    stride = rng.normal(10, 30, (steps + 1, 2))
    ways = []
    for start, direction in zip(rng.uniform(100, 2900, (2, 2)), (np.cos, np.sin), strict=True):
        way = start + np.cumsum(stride * direction(heading), axis=0)
        ways.append(85 + np.abs((way - 85 + 2830) % 5660 - 2830))  # reflected by the walls
    return np.stack([*ways, (heading - least) % (2 * np.pi) + least], axis=-1)


def walks(rng):
    yield from (wandering(rng, steps) for steps in (1, 30, 150))
    yield wandering(rng, 60, -np.pi)


def along_the_walls(rng):
    """Poses at all four walls, near them and not quite near, whatever the seed.

    Both robots begin at a wall and end far from it, so a step's beginning is not its end.
    """
    ways = []
    for middle in (1500.0, 1400.0):
        places = [
            (distance if low else 3000 - distance, middle)[:: 1 if across else -1]
            for distance in (150.0, 299.0, 301.0, 1500.0)
            for low in (True, False)
            for across in (True, False)
        ]
        inner = [places[i] for i in rng.permutation(np.arange(1, len(places)))]
        ways.append(
            [places[0], *inner[: int(rng.integers(9, 13))], *[(middle, middle + 50)] * 9][:14]
        )
    heading = rng.uniform(-3.14, 6.28, (14, 2, 1))  # whoever writes into the poses shows
    return np.concatenate([np.array(ways).swapaxes(0, 1), heading], axis=2)


of_poses(behaviour, 5, "describe", parts=("speed", "turning", "backwards"), name="how_they_move")(
    walks
)


@of_poses(behaviour, 4, "describe", parts=("facing", "wall", "distance"))
def where_they_are(rng):
    yield from walks(rng)
    yield along_the_walls(rng)


EXACT = "numbers that no formula rounds"


@of_poses(behaviour, 1, "describe", parts=("backwards", "facing", "wall"), fixed=EXACT)
def at_limits_and_at_rest(rng):
    """Exactly 300 mm from each wall; at rest, or moved straight to the side; just about 45 degrees.

    Numbers that no formula rounds: headings are 0, and angles a degree off the limit.
    """
    angles = np.radians([44, -44, 46, -46, 134, 0, 180])
    predator = [(300, 1500), (1500, 300), (2700, 1500), (1500, 2700), (1500, 1500), (1500, 1600)]
    predator = np.array([*predator, (1500, 1600)], dtype=float)
    poses = np.zeros((8, 2, 3))
    poses[:7, 0, :2] = predator
    poses[:7, 1, :2] = predator + 500 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    poses[7] = poses[6]
    yield poses
    yield poses[:, ::-1].copy()
