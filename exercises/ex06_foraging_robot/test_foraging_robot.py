"""Grader of exercise 6; run it with `botschool grade 6`.

All tasks compare with our solution. Nothing is a matter of luck: the arena and its noise follow
from a seed. Brains are variations of the pre-evolved robots of data/genotypes, robots that do
always the same, and robots that drive into a wall.
"""

import numpy as np

from botschool.course import genotype_file
from botschool.grading import Exercise, same

exercise = Exercise(6, "A foraging robot", file="foraging_robot.py")
UNITS, INPUTS = 10, 8


# ------------------------------------------------------------------- brains, memories and places
def weights(genotype):
    gates = genotype[12:732].reshape(UNITS, 4, INPUTS + UNITS).swapaxes(0, 1).copy()
    return {"gates": gates, "readout": genotype[732:].reshape(2, UNITS), "bias": genotype[10:12]}


def evolved(rng, which):
    """A variation of a pre-evolved robot."""
    genotype = np.load(genotype_file(f"discrimS{which + 1}.npy"))
    return weights(genotype + 0.01 * rng.normal(size=len(genotype)))


def steady(rng, *speeds):
    """A robot that always drives alike, though it has a memory."""
    return evolved(rng, 0) | {"readout": np.zeros((2, UNITS)), "bias": np.array(speeds)}


def bold(rng):
    """A robot that soon meets a wall: it drives fast, and nearly straight on."""
    genotype = 0.05 * rng.normal(size=752)
    genotype[10:12] = rng.uniform(1.4, 1.6) + 0.05 * rng.normal(size=2)
    return weights(genotype)


def some_memory(rng):
    return np.array([rng.normal(size=UNITS), rng.uniform(-1, 1, UNITS)])


def place(rng):
    """A start and a cylinder."""
    start = rng.uniform((160, 280, 0), (240, 340, 6.28)).round(2)
    return start, rng.uniform((110, 110), (290, 190)).round(2)


def facing(rng):
    """A start and a cylinder before the robot, where its sensors see it."""
    start, _ = place(rng)
    return start, (start[:2] + 55 * np.array([np.cos(start[2]), np.sin(start[2])])).round(2)


def seed_of(rng):
    return int(rng.integers(2, 100_000))


network = exercise.task("6.1", "One step of an LSTM")


@same(network, 10, "think", 1e-5, parts=("action", "new memory"))
def one_step(rng):
    """At first most weights are 0: all, those of the wheels and of all gates but one, the gates."""
    full = evolved(rng, 0)
    empty = {name: np.zeros_like(values) for name, values in full.items()}
    brains = [empty]
    for k in range(4):
        gates = np.zeros_like(full["gates"])
        gates[k] = rng.normal(size=gates[k].shape)
        brains.append({**empty, "gates": gates})
    brains.append({**full, "gates": empty["gates"]})
    brains += [evolved(rng, which) for which in range(3)]
    for brain in brains:
        yield brain, rng.uniform(0, 1, INPUTS), some_memory(rng)


def thought(module, brain, observations, memory):
    """think, {1} steps one after another, from the memory {2} on"""
    actions, memories = [], [memory]
    for observation in observations:
        action, memory = module.think(brain, observation, memories[-1])
        actions.append(action)
        memories.append(memory)
    return {"memories": memories, "actions": actions}


@same(network, 8, thought, 1e-4)
def many_steps(rng):
    brain = {name: values + 0.3 * rng.normal(size=values.shape)
             for name, values in evolved(rng, 0).items()}  # fmt: skip
    for steps in (2, 40):
        yield brain, rng.uniform(0, 1, (steps, INPUTS)), np.zeros((2, UNITS))


recording = exercise.task("6.2", "An episode, recorded", seconds=60, needs=("6.1",))


def recorded(module, brain, start, cylinder, seed, way, maxsteps):
    """episode(brain, {1}, {2}, {3}, {4}, maxsteps={5})"""
    import numpy

    def mixed(step, before, after):
        after, before = numpy.asarray(after), numpy.asarray(before)
        return 0.6 * after + 0.3 * before + 0.01 * numpy.sin(step)

    def forgetful(step, before, after):
        return 0 * numpy.asarray(after)

    remember = {"keep": module.keep, "forgetful": forgetful, "mixed": mixed}[way]
    return module.episode(brain, start, cylinder, seed, remember, maxsteps)


@same(recording, 7, recorded, 1e-3)
def starts_where_it_should(rng):
    for steps in (1, 2):
        yield steady(rng, 0.5, 0.3), *facing(rng), seed_of(rng), "keep", steps
    for steps in (5, 5):
        yield evolved(rng, 0), *facing(rng), seed_of(rng), "keep", steps
    for which in (0, 1):
        yield evolved(rng, which), *place(rng), seed_of(rng), "keep", 25


@same(recording, 6, recorded, 1e-3)
def remembers_as_told(rng):
    for way in ("mixed", "forgetful"):
        yield steady(rng, -0.4, 0.2), *place(rng), seed_of(rng), way, 3
    for which, way in enumerate(("keep", "forgetful", "mixed", "mixed")):
        yield evolved(rng, which % 3), *place(rng), seed_of(rng), way, 60


@same(recording, 4, recorded, 1e-3)
def ends_with_a_collision(rng):
    for _ in range(2):
        yield bold(rng), *place(rng), seed_of(rng), "keep", 200


@same(recording, 1, recorded, 1e-3)
def lasts_longer_than_500_steps(rng):
    for steps in (3, 503):
        yield steady(rng, 0.3, -0.3), *place(rng), seed_of(rng), "keep", steps


starts = exercise.task("6.3", "A grid of starts")


@same(starts, 8, "grid", 1e-6)
def starts_of_a_grid(rng):
    """At first with so many places that they may be two fewer."""
    many = int(rng.integers(5, 9))
    yield from ((5, many), (2, 1), (3, 1), (7, 2))
    yield from map(tuple, rng.integers(2, 8, (4, 2)).tolist())


behaviour = exercise.task("6.4", "A behaviour in six numbers")
EDGES = np.array(
    [
        [(40, 200), (72.4, 200), (360, 190), (327.6, 210), (190, 40), (210, 72.4), (200, 360)],
        [(200, 327.6), (72.5, 200), (327.5, 190), (210, 72.5), (200, 327.5), (150, 90), (180, 300)],
        [(45, 50), (350, 345), (50, 340), (340, 60), (42, 357), (60, 66), (333, 40)],
    ]
).reshape(-1, 2)
"""Places: eight nearer to each of the walls than sensors see, four exactly as near, two farther,
and seven in the corners, near two walls.
"""


def wandering(rng, steps, first, last):
    """Poses, rewards and a cylinder: a made-up walk that is near from step first to last.

    The search begins near a wall and ends far from all; the heading goes beyond the whole turn,
    back, and beyond it again; the robot loses the cylinder once, if there is time.
    """
    heading = 6.6 + np.cumsum(rng.normal(0.3, 0.4, steps + 1))
    heading[:3] = rng.uniform((6, 6.4, 5.5), (6.2, 6.6, 6))
    stride = rng.uniform(-8, 12, steps)
    x, y = rng.uniform(60, 340, (2, 1))
    x = np.append(x, x + np.cumsum(stride * np.cos(heading[:-1])))
    y = np.append(y, y + np.cumsum(stride * np.sin(heading[:-1])))
    x, y = (30 + np.abs((z - 30 + 340) % 680 - 340) for z in (x, y))
    rewards = np.zeros(steps)
    rewards[first:last] = rng.uniform(size=max(last - first, 0)) < 0.7
    if first < last:
        rewards[[first, last - 1]] = 1
        rewards[first + 1 : last - 1][:1] = 0
    poses = np.stack([x, y, heading % (2 * np.pi)], axis=1)
    search = first if first < last else steps
    poses[:search, :2][: len(EDGES)] = rng.permutation(EDGES)[:search]
    poses[:search, :2][:1] = (40, rng.integers(180, 220))
    poses[search, :2] = rng.integers(180, 220, 2)
    return poses.round(2), rewards, rng.integers((110, 110), (290, 190)).tolist()


def searches(rng):
    """Steps of a walk, the first one near the cylinder, and the last."""
    for case in ((4, 0, 0), (6, 3, 6), (30, 20, 28), (60, 41, 60), (40, 0, 0)):
        yield wandering(rng, *case)


same(behaviour, 3, "describe", 1e-4, parts=("search",), name="length_of_the_search")(searches)


@same(behaviour, 7, "describe", 1e-4, parts=("speed", "turning", "wall"))
def of_the_search(rng):
    yield from searches(rng)


@same(behaviour, 7, "describe", 1e-4, parts=("pace", "side"))
def near_the_cylinder(rng):
    for case in ((6, 2, 6), (30, 10, 30), (50, 5, 45), (80, 40, 70)):
        yield wandering(rng, *case)


@same(behaviour, 3, "describe", 1e-4)
def of_nothing(rng):
    for case in ((5, 0, 0), (7, 0, 4), (20, 0, 0), (25, 0, 20)):
        yield wandering(rng, *case)


groups = exercise.task("6.5", "Families")


def table_of(rng, robots, columns, equal=None):
    """Descriptors of robots; equal: the number in all rows of the last column."""
    size = rng.uniform(-50, 50, columns), rng.uniform(0.1, 90, columns)
    table = rng.normal(*size, (robots, columns))
    if equal is not None:
        table[:, -1] = equal
    return table


@same(groups, 4, "standardise", 1e-5)
def one_scale(rng):
    yield from (table_of(rng, *size) for size in ((3, 2), (7, 6)))
    yield from (table_of(rng, robots, 3, 3.5) for robots in (4, 7))


@same(groups, 1, "standardise", 1e-5, off={"single": "rounding errors are no longer tiny there"})
def equal_but_for_rounding(rng):
    """NumPy's standard deviation of these columns is not exactly 0."""
    yield from (table_of(rng, 7, 3, number) for number in (3.7, -0.7))


@same(groups, 5, "families")
def clear_families(rng):
    """Two rows exactly as far apart as a threshold; three clouds, whatever the linkage."""
    for low, high, many in ((3.0, 7.0, 1), (-6.0, 6.0, 1), (1.0, 5.0, 2), (-2.0, 4.0, 3)):
        for threshold in (1.9, 2.0, 2.1):
            yield np.repeat([[low], [high]], many, axis=0), threshold
    kinds = np.append([0, 1, 2], rng.integers(0, 3, 5))
    rng.shuffle(kinds)
    centres = np.array([[0, 0, 0], [0, 6, 6], [6, 0, 6]])
    table = (centres[kinds] + 0.2 * rng.normal(size=(8, 3))) * (1000, 1, 0.01)
    yield from ((table, threshold) for threshold in (1.2, 100.0, 1e-6))


@same(groups, 6, "families")
def by_mean_distance(rng):
    for robots, columns in ((4, 2), (5, 2), (6, 2), (6, 4), (10, 4), *[(14, 4)] * 4):
        table = rng.normal(size=(robots, columns)) * (1, 20, 300, 0.1)[:columns]
        lowest, highest = (0.8, 2.5) if columns == 2 else (2.0, 3.0)
        for threshold in rng.uniform(lowest, highest, 2):
            yield table.round(3), float(threshold.round(2))


without = exercise.task("6.6", "Without memory", seconds=90, needs=("6.2",))
A_START = "a start has three numbers"


def remembering(module, since, first, afters):
    """freeze({0}) and forget, step by step, in two episodes; freeze({0} + 1), too"""
    import numpy

    def memories(way, afters):
        memory, kept = first.copy(), []
        for step, after in enumerate(afters):
            memory = way(step, memory, after.copy())
            if memory is None:
                raise TypeError("None came back, but the memory should be returned")
            kept.append(numpy.array(memory))
        return kept

    ways = {
        "freeze(since)": module.freeze(since),
        "freeze(since + 1)": module.freeze(since + 1),
        "forget": module.forget,
    }
    return {
        f"episode {episode}: {name}": memories(way, -episode * afters)
        for episode in (1, 2)
        for name, way in ways.items()
    }


@same(without, 5, remembering, 1e-6)
def ways_to_remember(rng):
    """Memories that are easy to recognise, and no multiples of others."""
    numbers = np.arange(1.0, 10)
    afters = np.stack([numbers, 0.5 + numbers / 100], axis=1)[:, :, None] + np.zeros(UNITS)
    for since in (0, 1, int(rng.integers(2, 7))):
        yield since, np.repeat([[0.5], [0.505]], UNITS, axis=1), afters


@same(without, 9, "memory_test", 1e-9, off={"square": A_START, "one": A_START})
def what_memory_is_worth(rng):
    cases = (1, 6, 16), (1, 9, 20), (3, 20, 70), (3, 25, 80)
    for which, (many, since, maxsteps) in zip((0, 1, 2, 2), cases, strict=True):
        cylinder = rng.uniform((180, 170), (220, 190)).round()
        starts = [(x, 282, 4.2 + rng.uniform(0, 1)) for x in (175, 200, 225)[:many]]
        brain = evolved(rng, which)
        yield brain, np.array(starts).round(2), cylinder, seed_of(rng), since, maxsteps


reacting = exercise.task("6.7", "The same sight, another mind", needs=("6.1",))


@same(reacting, 6, "reactions", 1e-5)
def reactions_to_one_sight(rng):
    for which, many in enumerate((1, 5, 60)):
        memories = np.array([some_memory(rng) for _ in range(many)])
        yield evolved(rng, which), rng.uniform(0, 1, INPUTS), memories
