"""Grader of exercise 4; run it with `botschool grade 4`.

All tasks compare with our solution, and nothing is left to chance: runs are the same to the last
bit whenever experiment and seed are. Experiments are short, and the saved robots are made up.
"""

from functools import partial
from itertools import product

import numpy as np

from botschool.grading import Exercise, same, seed_of

exercise = Exercise(
    4,
    "The tool",
    file="acrobot.py",
    imports=("botschool.course", "botschool.evolution.run"),
)
COLUMNS = (
    "steps", "best fitness", "best post-evaluated", "best of generation", "average",
    "average parameter",
)  # fmt: skip


def seeds_of(rng, count):
    """Seeds in falling order."""
    return sorted((seed_of(rng) for _ in range(count)), reverse=True)


# ------------------------------------------------------------------- observations
DIRECTIONS = np.array([[0.6, 0.8], [0.8, 0.6], [0.28, 0.96], [0.96, 0.28]])
"""Cosines and sines without an error."""


def observations(rng):
    """Observations of links in all quadrants, the first of a hanging arm."""
    yield np.array([1.0, 0, 1, 0, 0, 0])
    for signs in rng.permutation(list(product((-1, 1), repeat=4))):
        speeds = np.round(rng.uniform(-5, 5, 2), 2)
        yield np.append(signs * rng.permutation(DIRECTIONS)[:2].ravel(), speeds)


def turned(rng):
    """Observations at any angles, but not where an arc cosine is inexact."""
    for _ in range(10):
        angles = rng.uniform(0.1, 3, 2) * rng.choice([-1, 1], 2)
        pairs = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        yield np.append(pairs, rng.uniform(-5, 5, 2)).astype(np.float32)


of_observations = partial(same, tolerance=1e-4)

observing = exercise.task("4.1", "What Acrobot observes")


@of_observations(observing, 7, "decode", parts=("angle1", "angle2"))
def angles(rng):
    yield from observations(rng)
    yield from turned(rng)


def upright(answer, *_):
    """The angles of links that stand: pi and -pi are the same place."""
    angles = {name: float(answer[name]) for name in ("angle1", "angle2")}
    return {name: np.pi if abs(angle + np.pi) < 1e-3 else angle for name, angle in angles.items()}


@of_observations(
    observing, 2, "decode", view=upright, off={"changes": "an arm that stands no more"}
)
def links_that_stand(rng):
    """The sine is exactly 0 there, and has no sign."""
    speeds = rng.uniform(-5, 5, (3, 2))
    for directions, of in zip(((-1, 0, 1, 0), (1, 0, -1, 0), (-1, 0, -1, 0)), speeds, strict=True):
        yield np.array([*directions, *of])


of_observations(observing, 4, "decode", parts=("speed1", "speed2"), name="speeds")(observations)

rules = exercise.task("4.2", "What Acrobot does, and what for", needs=("4.1",))


@same(rules, 4, "torque", fixed="there are three actions")
def torque(rng):
    yield from (2, 0, 1)


@of_observations(rules, 7, "height")
def height(rng):
    yield from observations(rng)
    yield from turned(rng)


@same(rules, 6, "reward")
def reward(rng):
    yield from observations(rng)
    # arms that are raised
    yield from (np.abs(each) * (-1, 1, 1, 1, 1, 1) for each in [*observations(rng)][1:8])
    # exactly on the line
    yield from (np.array([0.0, side, 0, side, 0, 0]) for side in (1, -1))
    # a little above and below it
    for angle in np.arccos((-0.502, -0.501, -0.4985)):
        yield np.array([np.cos(angle), np.sin(angle), 1, 0, 0, 0])


replications = exercise.task("4.3", "Replications with the tool")

ACROBOT = """\
[EXP]
environment = Acrobot-v1
[POLICY]
pepisodes = 3
maxsteps = 300
nhiddens = 6
bias = 1
out_type = 3
winit = 1
[ALGO]
maxmsteps = 0.04
samplesize = 8
"""
SMALL = """\
[EXP]
environment = {}
algo = SSS
[POLICY]
pepisodes = 2
nhiddens = 4
[ALGO]
maxmsteps = {}
popsize = 6
"""
PENDULUM, CARTPOLE = SMALL.format("Pendulum-v1", 0.02), SMALL.format("CartPole-v1", 0.01)


def replicated(module, text, seeds, folder, steps, before):
    """run_replications('trial.ini', {1}, '{2}', {3})"""
    import pathlib
    import shutil

    import numpy

    pathlib.Path("trial.ini").write_text(text)
    place = pathlib.Path(folder)
    shutil.rmtree(place.parts[0], ignore_errors=True)
    for seed in before:  # files of another run, or of the same seed
        place.mkdir(parents=True, exist_ok=True)
        numpy.save(place / f"statS{seed}.npy", numpy.arange(12.0))
    given = list(seeds)
    answer = module.run_replications("trial.ini", given, folder, steps)
    if not isinstance(answer, dict):
        return answer
    numbers = [str(seed) for seed in answer if isinstance(seed, (int, numpy.integer))]
    found = {
        "the list of seeds, afterwards,": given,
        "the seeds in its answer": ", ".join(sorted(numbers)),
        "its fitness": [answer.get(seed) for seed in seeds],
    }
    for kind in ("stat", "best", "bestg"):
        for seed in [*seeds, *(before if kind == "stat" else [])]:
            name = f"{kind}S{seed}.npy"
            files = [*place.glob(name), *sorted(pathlib.Path().rglob(name))]
            where = files[0].parent.as_posix() if files else "none"
            array = numpy.load(files[0]) if files else None
            found.setdefault(kind, {})[name] = {"its folder": where, "its numbers": array}
    return found


GIVEN = "the list of seeds, afterwards,"


@same(replications, 8, replicated, parts=("stat", GIVEN))
def curves_are_saved(rng):
    yield PENDULUM, seeds_of(rng, 1), "runs", 6_000, []
    yield PENDULUM, seeds_of(rng, 2), "runs", 8_000, []
    yield ACROBOT, seeds_of(rng, 2), "runs", 10_000, []


@same(replications, 6, replicated, parts=("best", "bestg"))
def robots_are_saved(rng):
    yield PENDULUM, seeds_of(rng, 1), "robots", 8_000, []
    yield ACROBOT, seeds_of(rng, 2), "robots", 10_000, []


@same(replications, 6, replicated, parts=("stat", "best", "bestg"))
def any_experiment_in_any_folder(rng):
    yield PENDULUM, seeds_of(rng, 1), "results/pendulum", None, []
    yield CARTPOLE, [*seeds_of(rng, 1), 0], "results/of/cartpole", None, []


@same(replications, 4, replicated, parts=("the seeds in its answer", "its fitness", "stat"))
def tells_the_fitness_of_each_run(rng):
    """In a folder with files of other runs, which stay, and of the same seeds, which go."""
    for text, steps in ((PENDULUM, 6_000), (PENDULUM, None), (ACROBOT, 10_000)):
        seeds = seeds_of(rng, 3)
        yield text, seeds, "fitness", steps, [seed_of(rng), seeds[1]]


reading = exercise.task("4.4", "The stat file")


def table_of(rng, generations):
    table = rng.normal(size=(generations, 6)).round(3)
    # odd numbers of steps beyond 2 ** 24, as long runs have them: single precision rounds them
    table[:, 0] = 20_000_001 + 2 * np.cumsum(rng.integers(100, 900, generations))
    table[:, 1:3] = np.maximum.accumulate(table[:, 1:3])  # the best so far
    return table


def read_saved(module, path, numbers):
    """read_stat('{0}')"""
    import pathlib

    import numpy

    pathlib.Path(path).parent.mkdir(exist_ok=True)
    numpy.save(path, numbers)
    return module.read_stat(path)


def files(rng, *generations):
    for count in generations:
        yield f"runs{count}/statS{seed_of(rng)}.npy", table_of(rng, count).ravel()


same(reading, 8, read_saved, parts=COLUMNS, name="columns_are_told_apart")(files, 4, 25)


@same(reading, 3, read_saved, parts=("steps", "average parameter"))
def any_number_of_generations(rng):
    yield from files(rng, 2, 6, 611)


same(reading, 2, read_saved, parts=COLUMNS, name="a_single_generation")(files, 1)

spread = exercise.task("4.5", "Mean and spread at equal steps")


def stats_of(rng, *generations):
    """Curves of runs, one for each number of generations, whose lengths differ."""
    found = []
    for count in generations:
        table = rng.normal(size=(count, 6)).cumsum(axis=0).round(2)
        table[:, 0] = rng.integers(500, 2000, count).cumsum()
        found.append({name: table[:, column] for column, name in enumerate(COLUMNS)})
    return found


def cases(rng):
    """Stats, columns and budgets: few, rising ones beyond the end of runs, and others."""
    first = 2100  # every run has a generation by then
    yield stats_of(rng, 3, 4), "average", np.array([4000.0, first, 3000])
    yield stats_of(rng, 30, 50, 40), "best post-evaluated", np.linspace(first, 80_000, 40).round()
    yield stats_of(rng, 45, 25, 60, 30, 20), "average", np.linspace(first, 50_000, 40).round()
    budgets = np.linspace(first, 40_000, 12).round()
    yield stats_of(rng, 30, 20, 35), "best fitness", rng.permutation(budgets)
    yield stats_of(rng, 20, 40), "best of generation", budgets[:1]


same(spread, 6, "curves", parts=("mean",), name="mean_at_equal_steps")(cases)
same(spread, 5, "curves", parts=("deviation",), name="deviation_at_equal_steps")(cases)


@same(spread, 4, "curves", parts=("mean",))
def a_budget_met_exactly(rng):
    for generations in ((4, 5), (20, 12, 30)):
        stats = stats_of(rng, *generations)
        budgets = np.sort([steps for stat in stats for steps in stat["steps"][2:12]])
        yield stats, "best of generation", np.append(budgets[budgets > 2000], 9000.0)


worth = exercise.task("4.6", "What the robots are worth", needs=("4.4",))


def compared(module, text, saved, seeds, episodes, test_seed):
    """compare('trial.ini', 'saved', {2}, {3}, {4})"""
    import pathlib
    import shutil

    import numpy

    pathlib.Path("trial.ini").write_text(text)
    shutil.rmtree("saved", ignore_errors=True)
    pathlib.Path("saved").mkdir()
    for name, numbers in saved.items():
        numpy.save(pathlib.Path("saved") / name, numbers)
    given = list(seeds)
    return [module.compare("trial.ini", "saved", given, episodes, test_seed), given]


def saved_runs(rng, text, size, count):
    """Made-up robots of this size and curves, seeds in no order, and how they are judged."""
    seeds = [int(seed) for seed in rng.permutation(900)[:count] + 1]
    saved = {}
    for name in (str(seed) for seed in (*seeds, *(10 * seed + 7 for seed in seeds))):
        saved |= {f"{kind}S{name}.npy": rng.normal(size=size) for kind in ("best", "bestg")}
        saved[f"statS{name}.npy"] = table_of(rng, 20).ravel()
    return text, saved, seeds, int(rng.integers(20, 60)), int(rng.integers(2**31))


def of(*keys):
    """A view of these keys of each row."""

    def view(answer, *_):
        rows, seeds = answer
        return [{key: row[key] for key in ("seed", *keys)} for row in rows], seeds

    return view


of_rows = partial(same, what=compared, parts=("its answer", "the list of seeds, afterwards,"))


@of_rows(worth, 4, view=of("promised"))
def promised(rng):
    yield from (saved_runs(rng, PENDULUM, 16, count) for count in (2, 3))


@of_rows(worth, 8, view=of("best", "bestg"))
def both_robots_in_new_episodes(rng):
    yield from (saved_runs(rng, PENDULUM, 16, count) for count in (1, 2, 3))


@of_rows(worth, 6, view=of("best", "bestg"))
def another_experiment(rng):
    yield from (saved_runs(rng, CARTPOLE, 24, count) for count in (1, 3))
