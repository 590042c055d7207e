"""Grader of exercise 5; run it with `make test-ex5`.

Nothing here is a matter of luck: bodies are decoded by the grader itself, and runs and episodes are
the same to the last bit whenever they have the same experiment, genotype and seed. The bodies,
experiments and seeds are drawn from the grading seed; the walkers of task 5.7 are the pre-evolved
ones of data/genotypes and variations of them that nobody knows before.
"""

import secrets
import tempfile
from collections.abc import Callable, Iterator
from functools import cache, lru_cache, partial
from pathlib import Path
from weakref import WeakKeyDictionary

import numpy as np
from slips import (
    MISTAKES,
    angles,
    changed,
    changed_losses,
    corners,
    lengths,
    limits,
    masses,
    measured,
    origin_of,
    other_places,
    other_seed,
    own_loss,
    own_returns,
    reason,
    thicknesses,
    wrong_corners,
    wrong_losses,
    wrong_matrices,
    wrong_parts,
    wrong_transplants,
)

from botschool import config
from botschool.course import genotype_file
from botschool.evolution.run import Run, evolve
from botschool.grading import (
    Exercise,
    Student,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    spoiled,
)

exercise = Exercise(
    5,
    "Body and brain",
    file="body_and_brain.py",
    imports=("botschool.envs.bodybrain",),
    extras=("box2d",),
)
BODY, OBSERVATIONS = 64, 35
TOOL = ("botschool.envs.morphology:decode",)
TOLERANCE = 1e-5
"""Of what is computed: single precision is enough."""


def rng_of(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def bodies(index: int, count: int = 4, spread: float = 0.6) -> np.ndarray:
    """Parameters of bodies: of the first few are not 0, of the last all are beyond -1 and 1.

    Every fifth of the last is so large that its exponential is infinite.
    """
    rng = rng_of(index)
    parameters = spread * rng.normal(size=(count, BODY))
    parameters[-1] *= 5
    one, two, joint, angle, density = rng.integers(1, 10, 5)
    places = [2 * one, 2 * two + 1, 42, 42 + angle, 53 + density]
    parameters[0] = 0
    parameters[0, places] = rng.uniform(0.3, 0.8, 5).round(1) * rng.choice([-1, 1], 5)
    parameters[0, [22 + 2 * joint, 23 + 2 * joint]] = rng.permutation([0.2, 0.7])
    beyond = rng.choice([-1, 1], BODY) * rng.uniform(1.1, 2.5, BODY)
    beyond[::5] *= 1000
    return np.vstack([parameters, beyond])


def said_of(name: str, parameters: np.ndarray) -> str:
    """The call, with the parameters if few of them are not 0."""
    some = np.flatnonzero(parameters)
    if len(some) > 10:
        return f"{name}(64 parameters of a body)"
    return f"{name}(zeros, but {', '.join(f'p[{i}] = {parameters[i]:g}' for i in some)})"


def answers(module, name, questions):
    """The student's answer to each of many questions, and the questions after that."""
    return [[getattr(module, name)(question) for question in questions], questions]


def asked(student: Student, name: str, questions: np.ndarray) -> Iterator:
    """Yield the student's answers; the first two questions are asked alone, then all others."""
    said, found = f"{name}(parameters of a body)", []
    for part in (questions[:1], questions[1:2], questions[2:]):
        call = (name, part[0]) if found else None
        given, after = student.run(answers, name, part, said=said, call=call)
        expect(isinstance(given, list) and len(given) == len(part), f"{said} gave no answers.")
        expect(
            np.array_equal(after, part),
            f"{said} changed the parameters that it was given: work on a copy.",
        )
        found += given
        expect(
            len(found) == 1 or len(set(map(repr, found))) > 1,
            f"{said} gave the same answer for {len(found)} different bodies: does it look at the "
            "parameters, or does it keep its first answer?",
        )
        yield from given


def all_mistakes(key: str, own: Callable, p: np.ndarray) -> dict:
    return spoiled(MISTAKES[key](p), own(p), changed(own, p))


def expect_decoded(student: Student, name: str, index: int, wanted: dict) -> None:
    """wanted: key -> the grader's function of the parameters."""
    questions = bodies(index)
    for p, answer in zip(questions, asked(student, name, questions), strict=True):
        said = said_of(name, p)
        values = expect_fields(said, answer, *wanted)
        for (key, own), value in zip(wanted.items(), values, strict=True):
            mistakes = partial(all_mistakes, key, own, p)
            why = partial(origin_of, p, key)
            expect_close(f"{said}: {key}", value, own(p), TOLERANCE, mistakes, why)


# ------------------------------------------------------------------- 5.1
size = exercise.task("5.1", "Sizes", refused=TOOL)


@size.check(6)
def length_of_each_segment(student: Student):
    expect_decoded(student, "sizes", 1, {"lengths": lengths})


@size.check(4)
def thickness_of_each_segment(student: Student):
    expect_decoded(student, "sizes", 2, {"thicknesses": thicknesses})


@size.check(4)
def mass_of_each_segment(student: Student):
    expect_decoded(student, "sizes", 3, {"masses": masses})


# ------------------------------------------------------------------- 5.2
turning = exercise.task("5.2", "Angles", refused=TOOL)


@turning.check(6)
def default_angles(student: Student):
    expect_decoded(student, "joints", 4, {"angles": angles})


@turning.check(7)
def limits_of_joints(student: Student):
    wanted = {"lower": lambda p: limits(p)[0], "upper": lambda p: limits(p)[1]}
    expect_decoded(student, "joints", 5, wanted)


# ------------------------------------------------------------------- 5.3
shape = exercise.task("5.3", "The shape at rest", needs=("5.1", "5.2"), refused=TOOL)


AXES = {
    (11, 2, 4): "The shape should be segments, corners, and x and y last, but the corners come "
    "last here (axis=1 of np.stack puts them in the middle).",
    (4, 11, 2): "The shape should be segments, corners, x and y, but the corners come first here "
    "(axis=1 of np.stack puts them in the middle).",
    (2, 11, 4): "x and y stand on the first axis, but they should stand on the last one.",
    (2, 4, 11): "The axes are in the opposite order: they should be segments, corners, x and y.",
    (4, 2, 11): "The segments stand on the last axis, but they should stand on the first one.",
    (44, 2): "All 44 corners are in one list, but the four of each segment should be in a list of "
    "their own.",
    (11, 8): "The eight numbers of each segment are in one row, but each corner should have a row "
    "of its own.",
    (11, 5, 2): "These are five places for each segment, but its four corners are asked for.",
    (11, 2, 2): "These are two places for each segment, but its four corners are asked for.",
    (11, 2): "This is one place for each segment, but its four corners are asked for.",
    (12, 2): "These are 12 places, but the four corners of each of the 11 segments are asked for.",
}
"""What is wrong with some shapes of an outline."""


def spoiled_corners(p: np.ndarray) -> dict:
    return spoiled(wrong_corners(p), corners(p), changed(corners, p))


def expect_outline(student: Student, questions: np.ndarray) -> None:
    for p, answer in zip(questions, asked(student, "outline", questions), strict=True):
        said = said_of("outline", p)
        shape = np.shape(answer) if isinstance(answer, np.ndarray) else ()
        if shape in AXES:
            arranged = AXES[shape]
            if shape == (11, 5, 2) and np.allclose(answer[:, 0], answer[:, -1]):
                arranged = (
                    "The first corner of each segment is there twice, but each of its four "
                    "corners should be there once."
                )
            expect_close(said, answer, corners(p), mistakes={arranged: answer})
            continue
        answer = expect_array(said, answer, (11, 4, 2))
        why = partial(measured, answer, p)
        made = partial(spoiled_corners, p)
        expect_close(said, answer, corners(p), TOLERANCE, made, why)


@shape.check(5)
def straight_bodies(student: Student):
    questions = bodies(6)
    questions[:, 42:53] = 0
    expect_outline(student, questions)


@shape.check(5)
def straight_bodies_that_lean(student: Student):
    questions = bodies(7)
    questions[:, 43:53] = 0
    expect_outline(student, questions)


@shape.check(9)
def bent_bodies(student: Student):
    expect_outline(student, bodies(8))
    expect_outline(student, bodies(12, spread=1.5))


# ------------------------------------------------------------------- 5.4
numbers = exercise.task("5.4", "A body in five numbers", needs=("5.1", "5.2", "5.3"), refused=TOOL)


@numbers.check(4)
def length_and_mass(student: Student):
    wanted = {"length": lambda p: lengths(p).sum(), "mass": lambda p: masses(p).sum()}
    expect_decoded(student, "describe", 9, wanted)


@numbers.check(4)
def width_and_height(student: Student):
    wanted = {
        "width": lambda p: np.ptp(corners(p)[:, :, 0]),
        "height": lambda p: np.ptp(corners(p)[:, :, 1]),
    }
    expect_decoded(student, "describe", 10, wanted)


@numbers.check(2)
def freedom_of_the_joints(student: Student):
    wanted = {"freedom": lambda p: np.mean(limits(p)[1] - limits(p)[0])}
    expect_decoded(student, "describe", 11, wanted)


# ------------------------------------------------------------------- 5.5
EXPERIMENT = """
[EXP]
environment = envBodybrainCustom
algo = {algo}

[POLICY]
episodes = {episodes}
pepisodes = 2
maxsteps = 12
nhiddens = {hidden}
bias = 1
out_type = 3
winit = 1
action_noise = 1
action_noise_range = {noise}
normalize = 1
clip = 1

[ALGO]
maxmsteps = 0.0004
{more}
saveeach = 60
"""
running = exercise.task("5.5", "Evolve walkers", seconds=120)


def experiment_text(index: int) -> str:
    """A very small experiment of the grader's.

    In one episode luck decides, so that the best fitness and the best post-evaluated one are often
    those of different genotypes: telling_seeds finds such a run soon.
    """
    rng = rng_of(index)
    algorithms = (
        ("SSS", "popsize = 4\nmutrate = 1"),
        ("OpenAI-ES", "samplesize = 2\nnoiseStdDev = 0.5\nstepsize = 0.5"),
    )
    algo, more = algorithms[index % 2]
    episodes, hidden = 1 + index % 2, int(rng.integers(3, 9))
    return EXPERIMENT.format(algo=algo, more=more, episodes=episodes, hidden=hidden, noise=2)


def try_runs(module, text, seeds, folder, steps):
    """Writes an experiment file, runs the student's function, and reads what the runs have left."""
    import pathlib

    import numpy

    pathlib.Path("trial.ini").write_text(text)
    given = list(seeds)
    walkers = module.evolve_walkers("trial.ini", given, folder, steps)
    saved = {}
    for seed in seeds:
        file = pathlib.Path(folder) / f"bestgS{seed}.npy"
        saved[seed] = numpy.load(file) if file.exists() else None
    places = {}
    for seed in seeds:
        found = sorted(pathlib.Path(".").rglob(f"bestgS{seed}.npy"))
        places[seed] = found[0].parent.as_posix() if found else ""
    return [walkers, saved, given, places]


@lru_cache
def own_run(text: str, seed: int, steps: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The genotypes with the best post-evaluated and the best fitness of the grader's own run."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "trial.ini"
        file.write_text(text)
        run = Run(config.load(file), seed)
        evolve(run, Path(folder), steps)
        return run.record.bestg, run.record.best


def telling_seeds(text: str, index: int) -> list[int]:
    """Two falling seeds; in the run of the second post-evaluation decides for another genotype."""
    more, *others = (int(seed) for seed in rng_of(index).permutation(500) + 1)
    telling = next(seed for seed in others if not np.array_equal(*own_run(text, seed)))
    return [telling + more, telling]


LIMIT = 200
"""Steps of a run that is ended early; these are half of its steps."""


def limited_seed(text: str, index: int) -> int:
    """A seed whose run finds another walker with half of LIMIT, and with no limit."""
    for seed in (int(each) for each in rng_of(index).permutation(500) + 1):
        walker = own_run(text, seed, LIMIT)[0]
        others = (own_run(text, seed, each)[0] for each in (LIMIT // 2, None))
        if not any(np.array_equal(walker, other) for other in others):
            return seed
    raise AssertionError("No run depends on the number of its steps.")


class Trial:
    """The student's runs of a very small experiment, and the grader's own."""

    def __init__(
        self, student: Student, text: str, seeds: list[int], steps: int | None = None
    ) -> None:
        self.text = text
        self.said = f"evolve_walkers('trial.ini', {seeds}, 'some/runs', {steps})"
        self.walkers, saved, after, self.places = student.run(
            try_runs, text, seeds, "some/runs", steps, said=self.said
        )
        expect(after == seeds, f"{self.said} changed the list of seeds, which is {after} now.")
        self.saved = [saved.get(str(seed)) for seed in seeds]
        self.wanted = np.array([own_run(text, seed, steps)[0] for seed in seeds])
        self.seeds, self.steps = seeds, steps

    def compare(self) -> None:
        """Expect the walkers that the grader finds."""
        shape = np.shape(self.walkers) if isinstance(self.walkers, np.ndarray) else ()
        whole = self.wanted.shape[1]
        columns = {
            64: "Such rows are as long as a body alone",
            whole - 70: "Such rows are too short by 70, the number of means and deviations",
            whole - 134: "Such rows are as long as the network alone",
            6: "Such rows have as many numbers as those of a stat file",
        }
        what = columns.get(shape[-1] if len(shape) == 2 else -1)
        if len(shape) == 1 and shape[0] in (2, 2 * whole, whole):
            what = {
                2: "These are two numbers",
                whole: "This is as long as one genotype",
            }.get(shape[0], "This is as long as all genotypes one after another")
        expect(
            not what,
            f"{self.said} returned an array of shape {shape}, but {self.wanted.shape} was "
            f"expected.\n  {what}. The whole genotype of each run in a row of its own is needed.",
        )
        expect(
            len(shape) != 2 or shape[0] <= len(self.seeds),
            f"{self.said} returned {shape[0] if shape else 0} rows for {len(self.seeds)} seeds: "
            "there should be one row for each seed that is given, whatever else is in the folder "
            "or was run before.",
        )
        right = self.walkers is not None and np.array_equal(self.walkers, self.wanted)
        expect_close(self.said, self.walkers, self.wanted, mistakes={} if right else self.made())

    def made(self) -> dict[str, np.ndarray]:
        """What mistakes make of the walkers."""

        def runs(seeds: list[int], steps: int | None, kind: int = 0) -> np.ndarray:
            return np.array([own_run(self.text, seed, steps)[kind] for seed in seeds])

        seeds, steps = self.seeds, self.steps
        each_ran = all(self.places.get(str(seed)) for seed in seeds)
        rows = "All rows hold the genotype of the {} run, but each should be in its own row."
        begun = "All rows belong to the {} seed, but each seed should have its own run."
        first, last = ((rows if each_ran else begun).format(which) for which in ("first", "last"))
        return {
            "These genotypes have the best fitness, but those with the best post-evaluated fitness "
            "are asked for (bestg).": runs(seeds, steps, 1),
            "The walkers are in another order than the seeds.": self.wanted[::-1],
            "These runs are as long as the experiment file says instead of `steps`: they end too "
            "late, or come from files that were there before.": runs(seeds, None),
            "The seeds that are given are not used: these runs have the seeds 0 and 1.": runs(
                [0, 1], steps
            ),
            "The seeds that are given are not used: these runs have the seeds 1 and 2.": runs(
                [1, 2], steps
            ),
            **(
                {
                    "The steps are shared among the runs, but each should have all of them.": runs(
                        seeds, steps // len(seeds)
                    )
                }
                if steps
                else {}
            ),
            "The seed 1 is used in place of 0, but 0 is a seed like any other.": runs(
                [seed or 1 for seed in seeds], steps
            ),
            first: runs([seeds[0]] * 2, steps),
            last: runs([seeds[1]] * 2, steps),
            "The place in the list is added to each seed, but the seeds should be used as they "
            "are.": runs([seeds[0], seeds[1] + 1], steps),
            "One is added to each seed, but the seeds should be used as they are.": runs(
                [seed + 1 for seed in seeds], steps
            ),
            "The seeds count on from the first one, but each should come from the list.": runs(
                [seeds[0], seeds[0] + 1], steps
            ),
            "The genotypes of all runs are averaged, but each should be in its own row.": np.repeat(
                self.wanted.mean(axis=0)[None], 2, axis=0
            ),
            "Only the first row is filled, but the genotype of each run is asked for.": self.wanted
            * [[1.0], [0.0]],
            "Only the last row is filled, but the genotype of each run is asked for.": self.wanted
            * [[0.0], [1.0]],
        }


TRIALS: WeakKeyDictionary[Student, Trial] = WeakKeyDictionary()
"""Each student's runs of the first experiment, at which two checks look."""


@running.check(6)
def best_walker_of_each_run(student: Student):
    first_trial(student).compare()
    seeds = [int(each) + 1 for each in rng_of(21).permutation(500)[:2]]
    Trial(student, experiment_text(21), seeds).compare()


def first_trial(student: Student) -> Trial:
    if student not in TRIALS:
        text = experiment_text(20)
        TRIALS[student] = Trial(student, text, telling_seeds(text, 20))
    student.said = TRIALS[student].said
    return TRIALS[student]


@running.check(3)
def leaves_the_files(student: Student):
    trial = first_trial(student)
    for seed, file, wanted in zip(trial.seeds, trial.saved, trial.wanted, strict=True):
        where = trial.places.get(str(seed))
        expect(
            file is not None,
            f"{trial.said} left no file bestgS{seed}.npy in some/runs"
            + (f": it is in {'the working folder' if where == '.' else where}." if where else "."),
        )
        expect_close(f"{trial.said}: bestgS{seed}.npy", file, wanted)


@running.check(3)
def stops_after_the_steps(student: Student):
    text = experiment_text(20)
    seed = limited_seed(text, 20)
    said = f"evolve_walkers('trial.ini', [{seed}], 'some/runs', None)"
    student.run(try_runs, text, [seed], "some/runs", None, said=said)  # leaves longer runs
    Trial(student, text, [seed, 0], LIMIT).compare()


# ------------------------------------------------------------------- 5.6
surgery = exercise.task("5.6", "Give a brain another body")


def genotypes(index: int, count: int = 2) -> np.ndarray:
    """Made-up genotypes, as long as those of some experiment."""
    rng = rng_of(index)
    hidden = int(rng.integers(3, 60))
    return rng.normal(size=(count, 46 * hidden + 10 + BODY + 2 * OBSERVATIONS))


def operate(module, brain, body):
    """A transplantation, and whether what was given is still as it was."""
    before = [brain.copy(), body.copy()]
    result = module.transplant(brain, body)
    return [result, bool((before[0] == brain).all() and (before[1] == body).all())]


PARTS = {
    "the part with the parameters of the network": slice(0, -134),
    "the part with the parameters of the body": slice(-134, -70),
    "the part with the means and deviations": slice(-70, None),
}


@surgery.check(3)
def body_is_cut_out(student: Student):
    for index in (30, 31):
        for genotype in genotypes(index):
            body = student.call("body_of", genotype)
            expect_close(student.said, body, genotype[-134:-70], 0, partial(other_places, genotype))


@surgery.check(5)
def brain_in_another_body(student: Student):
    for index in (32, 33):
        brain, body = genotypes(index)
        answer = student.run(operate, brain, body, said="transplant(brain, body)")
        wanted = np.concatenate([brain[:-134], body[-134:-70], brain[-70:]])
        if np.shape(answer[0]) != wanted.shape:
            made = partial(wrong_transplants, brain, body)
            expect_close(student.said, answer[0], wanted, 0, made)
        got = expect_array(student.said, answer[0], brain.shape)
        for name, part in PARTS.items():
            made = partial(wrong_parts, brain, body, part)
            expect_close(f"{student.said}: {name}", got[part], wanted[part], 0, made)


@surgery.check(2)
def patients_stay_as_they_are(student: Student):
    brain, body = genotypes(34)
    answer = student.run(operate, brain, body, said="transplant(brain, body)")
    expect_array(student.said, answer[0], brain.shape)
    expect(
        answer[1] is True,
        f"{student.said} changed a genotype that it was given: work on a copy.",
    )


# ------------------------------------------------------------------- 5.7
WALKING = EXPERIMENT.replace("maxsteps = 12", "maxsteps = {maxsteps}")
crossing = exercise.task("5.7", "The co-adaptation matrix", seconds=120, needs=("5.6",))


def cross(module, text, walkers, seed, episodes):
    """Writes an experiment file and runs the student's function."""
    import pathlib

    pathlib.Path("trial.ini").write_text(text)
    before = walkers.copy()
    matrix = module.cross_evaluate("trial.ini", walkers, seed, episodes)
    return [matrix, bool((before == walkers).all())]


def walking(hidden: int, maxsteps: int) -> str:
    return WALKING.format(
        algo="SSS", more="popsize = 4", episodes=1, hidden=hidden, noise=0.01, maxsteps=maxsteps
    )


@exercise.cached
def walkers_of(index: int) -> np.ndarray:
    """The pre-evolved walkers, each with brain and body varied a little."""
    evolved = np.array([np.load(genotype_file(f"bodybrainS{seed}.npy")) for seed in (1, 2, 3)])
    evolved[:, :-70] += 0.02 * rng_of(index).normal(size=evolved[:, :-70].shape)
    return evolved


def expect_matrix(
    student: Student, text: str, walkers: np.ndarray, seed: int, episodes: int
) -> None:
    said = f"cross_evaluate('trial.ini', {len(walkers)} walkers, {seed}, {episodes})"
    matrix, unchanged = student.run(cross, text, walkers, seed, episodes, said=said)
    expect(unchanged is True, f"{said} changed the walkers that it was given: work on copies.")
    returns = own_returns(text, walkers, seed, episodes)
    made = cache(partial(wrong_matrices, returns, text, walkers, seed, episodes))

    def why(i: int, j: int) -> str:
        each = returns[i, j].round(3).tolist()
        known = f"Brain {i} in body {j} has these returns: {each}. [{i}, {j}] should be their mean."
        if any(np.allclose(matrix, other, 1e-4) for other in made().values()):
            return known  # a mistake explains the whole matrix
        return known + other_seed(np.asarray(matrix)[i, j], text, walkers, seed, episodes, i, j)

    expect_close(said, matrix, returns.mean(axis=2), TOLERANCE, made, why)


@crossing.check(6)
def pre_evolved_walkers(student: Student):
    expect_matrix(student, walking(50, 60), walkers_of(40), secrets.randbelow(2**31), 1)


@crossing.check(3)
def another_experiment(student: Student):
    walkers = rng_of(41).normal(size=(4, 46 * 5 + 10 + BODY + 2 * OBSERVATIONS))
    walkers[:, -OBSERVATIONS:] = 1
    expect_matrix(student, walking(5, 20), walkers[:2], 41, 2)
    expect_matrix(student, walking(5, 20), walkers, 0, 3)


# ------------------------------------------------------------------- 5.8
losing = exercise.task("5.8", "What is lost")


def made_up_matrices(index: int) -> list[np.ndarray]:
    """Matrices, the small ones with whole numbers."""
    rng = rng_of(index)
    made = [30 * rng.normal(size=(n, n)) + 25 * np.eye(n) * rng.random() for n in (2, 3, 5, 8)]
    return [*(matrix.round() + 0.0 for matrix in made[:2]), *made[2:]]


TIES = [[4.0, 4.0, 1.0], [2.0, -1.0, -1.0], [4.0, 0.0, 3.0]]
"""Returns that are the same as the own one in a row, or in a column."""


def spoiled_losses(matrix: np.ndarray, key: str) -> dict:
    return spoiled(wrong_losses(matrix, key), own_loss(matrix, key), changed_losses(matrix, key))


def expect_loss(student: Student, index: int, *keys: str) -> None:
    more = [] if "at home" in keys else [np.array(TIES)]
    for matrix in [*made_up_matrices(index), *more]:
        answer = student.call("loss", matrix)
        values = expect_fields(student.said, answer, *keys)
        for key, value in zip(keys, values, strict=True):
            wrong = partial(spoiled_losses, matrix, key)
            said, why = f"{student.said}: {key}", partial(reason, matrix, key)
            expect_close(said, value, own_loss(matrix, key), TOLERANCE, wrong, why)


def matrix_after(module, matrix):
    """The matrix, after the student's loss has used it; infinite numbers as 1e300."""
    import numpy

    module.loss(matrix)
    return numpy.nan_to_num(matrix, posinf=1e300, neginf=-1e300)


@losing.check(4)
def own_and_foreign(student: Student):
    expect_loss(student, 50, "own", "foreign")


@losing.check(3)
def loss_of_brains(student: Student):
    expect_loss(student, 51, "brains")


@losing.check(3)
def loss_of_bodies(student: Student):
    expect_loss(student, 52, "bodies")


@losing.check(2)
def at_home(student: Student):
    expect_loss(student, 53, "at home")


@losing.check(1)
def as_good_elsewhere_is_not_at_home(student: Student):
    """Equal returns, and all of them below 0."""
    matrices = (
        [[4.0, 4.0], [1.0, 2.0]],
        [[-3.0, -3.0, -5.0], [-7.0, -2.0, -4.0], [-6.0, -1.0, -1.0]],
        [[-2.0] * 4] * 4,
    )
    for rows in matrices:
        answer = student.call("loss", np.array(rows))
        (value,) = expect_fields(f"loss({rows})", answer, "at home")
        matrix = np.array(rows)
        said, why = f"loss({rows}): at home", partial(reason, matrix, "at home")
        wrong = wrong_losses(matrix, "at home")
        expect_close(said, value, own_loss(matrix, "at home"), mistakes=wrong, why=why)
    rows = np.array(matrices[1])
    after = student.run(matrix_after, rows, said="loss(matrix)")
    expect(
        np.array_equal(expect_array("loss(matrix): the matrix after it", after, (3, 3)), rows),
        "loss(matrix) changed the matrix that it was given: work on a copy.",
    )
