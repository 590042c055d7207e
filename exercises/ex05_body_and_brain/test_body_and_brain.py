"""Grader of exercise 5; run it with `make test-ex5`.

Nothing here is a matter of luck: bodies are decoded by the grader itself, and runs and episodes are
the same to the last bit whenever they have the same experiment, genotype and seed. The bodies,
experiments and seeds are drawn from the grading seed; the walkers of task 5.7 are the pre-evolved
ones of data/genotypes and variations of them that nobody knows before.
"""

import secrets
import tempfile
from collections.abc import Iterator
from functools import lru_cache
from itertools import permutations
from pathlib import Path

import numpy as np

from botschool import config
from botschool.course import SavedRobot, genotype_file
from botschool.evolution.run import Run, evolve
from botschool.grading import Exercise, Student, expect, expect_array, expect_close, expect_fields

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
    """Parameters of bodies: of the first few are not 0, of the last some are beyond all limits."""
    rng = rng_of(index)
    parameters = spread * rng.normal(size=(count, BODY))
    parameters[-1] *= 5
    one, two, joint, angle, density = rng.integers(1, 10, 5)
    places = [2 * one, 2 * two + 1, 42, 42 + angle, 53 + density]
    parameters[0] = 0
    parameters[0, places] = rng.uniform(0.3, 0.8, 5).round(1) * rng.choice([-1, 1], 5)
    parameters[0, [22 + 2 * joint, 23 + 2 * joint]] = rng.permutation([0.2, 0.7])
    return parameters


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
    """Yield the student's answers; the first question is asked alone, then all others."""
    said, found = f"{name}(parameters of a body)", []
    for part in (questions[:1], questions[1:]):
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


# ------------------------------------------------------------------- the grader's own decoding
def scaled(p: np.ndarray, nominal: float) -> np.ndarray:
    return nominal + 0.9 * nominal * np.tanh(p)


def lengths(p: np.ndarray) -> np.ndarray:
    return scaled(p[0:22:2], 0.8)


def thicknesses(p: np.ndarray) -> np.ndarray:
    return scaled(p[1:22:2], 0.2)


def masses(p: np.ndarray) -> np.ndarray:
    return lengths(p) * thicknesses(p) * (5 + 0.8 * np.tanh(p[53:64]))


def angles(p: np.ndarray) -> np.ndarray:
    return np.minimum(np.maximum(p[42:53], -1), 1) * 135 * np.pi / 180


def limits(p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    one, other = (np.minimum(np.maximum(p[first:42:2], -1), 1) * np.pi / 2 for first in (22, 23))
    return np.minimum(one, other), np.maximum(one, other)


def corners(p: np.ndarray, wide: float = 1.0, turns: float = 1.0) -> np.ndarray:
    """Segment by segment, in complex numbers; wide and turns: 1, but for mistakes."""
    place, heading, found = 0j, 0.0, []
    for length, thickness, angle in zip(lengths(p), wide * thicknesses(p), angles(p), strict=True):
        heading = turns * heading + angle
        along = length * np.exp(1j * heading)
        side = thickness / 2 * np.exp(1j * (heading + np.pi / 2))
        found.append([place - side, place + along - side, place + along + side, place + side])
        place += along
    return np.stack([np.real(found), np.imag(found)], axis=2)


def cut(p: np.ndarray) -> np.ndarray:
    return p.clip(-1, 1)


def of_sizes(first: int, nominal: float) -> dict:
    """Mistakes with lengths (first: 0) or thicknesses (1)."""
    own, other = slice(first, 22, 2), slice(1 - first, 22, 2)
    block = slice(11 * first, 11 * first + 11)
    return {
        "The parameters are cut off at -1 and 1, but sizes use tanh.":
        lambda p: nominal * (1 + 0.9 * cut(p[own])),
        "Lengths and thicknesses take turns among the parameters.":
        lambda p: scaled(p[block], nominal),
        "Lengths and thicknesses are exchanged: of each two parameters the length comes first.":
        lambda p: scaled(p[other], nominal),
        "0.9 is a factor of tanh p, not of p: it stands before the tanh.":
        lambda p: nominal * (1 + np.tanh(0.9 * p[own])),
        "The factor 0.9 is left out.": lambda p: nominal * (1 + np.tanh(p[own])),
        "The 1 that is added to 0.9 tanh p is left out.": lambda p: nominal * 0.9 * np.tanh(p[own]),
        f"{nominal} is a factor of the whole bracket, also of 0.9 tanh p.":
        lambda p: nominal + 0.9 * np.tanh(p[own]),
        "tanh is left out: the parameters themselves are used.":
        lambda p: nominal * (1 + 0.9 * p[own]),
        "tanh stands around the whole bracket, but belongs to p alone.":
        lambda p: nominal * np.tanh(1 + 0.9 * p[own]),
    }  # fmt: skip


def of_angles(own: slice, scale: float) -> dict:
    """Mistakes with angles, before the smaller one of two is sought."""
    return {
        "The parameters of angles are to be cut off at -1 and 1.": lambda p: scale * p[own],
        "The parameters of angles are cut off, not put through tanh.":
        lambda p: scale * np.tanh(p[own]),
        "The angles are cut off at -1 and 1 after they are scaled: cut off the parameters.":
        lambda p: cut(scale * p[own]),
        "The parameters are cut off at 0 and 1 instead of -1 and 1.":
        lambda p: scale * p[own].clip(0, 1),
    }  # fmt: skip


def of_limits(end, name: str) -> dict:
    """Mistakes with lower limits (end: np.minimum) or upper ones (np.maximum)."""

    def ends(limits) -> np.ndarray:
        return end(limits[0::2], limits[1::2])

    one, other = slice(22, 42, 2), slice(23, 42, 2)
    mistakes = of_angles(slice(22, 42), np.pi / 2).items()
    sign = -1 if name == "lower" else 1
    half = np.pi / 2
    return {
        **{text: lambda p, made=made: ends(made(p)) for text, made in mistakes},
        f"The {name} limit is the {'smaller' if sign < 0 else 'larger'} one of the two.":
        lambda p: half * cut(p[one if sign < 0 else other]),
        "A limit is taken without its sign: both can lie on one side of the default angle.":
        lambda p: half * sign * np.abs(cut(p[one if sign < 0 else other])),
        "The two limits of a joint stand side by side among the parameters.":
        lambda p: half * cut(end(p[22:32], p[32:42])),
        "The default angle is added: limits count from the default angle.":
        lambda p: half * cut(end(p[one], p[other])) + angles(p)[1:],
        "The limits are scaled by 3 pi / 4, as the default angles are.":
        lambda p: 1.5 * half * cut(end(p[one], p[other])),
    }  # fmt: skip


MISTAKES = {
    "lengths": of_sizes(0, 0.8),
    "thicknesses": of_sizes(1, 0.2),
    "masses": {
        "The density is 5 and varies by 0.8, not by 80 % or 90 % of it.":
        lambda p: lengths(p) * thicknesses(p) * (5 + 4 * np.tanh(p[53:64])),
        "The density varies by 0.8, not like the sizes.":
        lambda p: lengths(p) * thicknesses(p) * scaled(p[53:64], 5),
        "The parameters of the densities are cut off, but must go through tanh.":
        lambda p: lengths(p) * thicknesses(p) * (5 + 0.8 * cut(p[53:64])),
        "The density is left out.": lambda p: lengths(p) * thicknesses(p),
        "These are the densities: length and thickness are left out.":
        lambda p: 5 + 0.8 * np.tanh(p[53:64]),
        "The densities begin at place 53.":
        lambda p: lengths(p) * thicknesses(p) * (5 + 0.8 * np.tanh(p[52:63])),
    },
    "angles": {
        **of_angles(slice(42, 53), 0.75 * np.pi),
        "The default angles are scaled by pi / 2, as the limits are.":
        lambda p: np.pi / 2 * cut(p[42:53]),
    },
    "lower": of_limits(np.minimum, "lower"),
    "upper": of_limits(np.maximum, "upper"),
    "length": {
        "This is the mean of the lengths, not their sum.": lambda p: lengths(p).mean(),
        "The torso is left out.": lambda p: lengths(p)[1:].sum(),
        "The last segment is left out.": lambda p: lengths(p)[:-1].sum(),
    },
    "mass": {
        "This is the mean of the masses, not their sum.": lambda p: masses(p).mean(),
        "The torso is left out.": lambda p: masses(p)[1:].sum(),
        "The last segment is left out.": lambda p: masses(p)[:-1].sum(),
    },
    **{
        name: {
            "Only the largest coordinate is taken: subtract the smallest.":
            lambda p, axis=axis: corners(p)[:, :, axis].max(),
            "The thickness is left out: it counts where the corners are, not the middle line.":
            lambda p, axis=axis: np.ptp(corners(p, wide=0)[:, :, axis]),
            "This is the way from the first place to the last: the corners in between count, too.":
            lambda p, axis=axis: abs(corners(p, wide=0)[-1, 1, axis]),
            "Width and height are exchanged.":
            lambda p, axis=axis: np.ptp(corners(p)[:, :, 1 - axis]),
        }
        for axis, name in enumerate(("width", "height"))
    },
    "freedom": {
        "This is the sum over the joints, not the mean.":
        lambda p: np.sum(limits(p)[1] - limits(p)[0]),
        "The sum is divided by the 11 segments, but there are 10 joints.":
        lambda p: np.sum(limits(p)[1] - limits(p)[0]) / 11,
        "The largest limit and the smallest one belong to different joints: take the difference "
        "of each joint first.": lambda p: limits(p)[1].max() - limits(p)[0].min(),
        "Only the upper limits count here: subtract the lower ones.": lambda p: limits(p)[1].mean(),
    },
}  # fmt: skip
"""What mistakes make of an answer's parts: sentences -> functions of the parameters."""


def expect_decoded(student: Student, name: str, index: int, wanted: dict) -> None:
    """wanted: key -> the grader's function of the parameters."""
    questions = bodies(index)
    for p, answer in zip(questions, asked(student, name, questions), strict=True):
        said = said_of(name, p)
        values = expect_fields(said, answer, *wanted)
        for (key, own), value in zip(wanted.items(), values, strict=True):
            mistakes = {text: made(p) for text, made in MISTAKES.get(key, {}).items()}
            expect_close(f"{said}: {key}", value, own(p), TOLERANCE, mistakes=mistakes)


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


CORNERS = ("beginning right", "end right", "end left", "beginning left")


def expect_outline(student: Student, questions: np.ndarray) -> None:
    for p, answer in zip(questions, asked(student, "outline", questions), strict=True):
        own = corners(p)
        mistakes = {
            "A segment reaches half of its thickness to each side.": corners(p, wide=2),
            "The thickness is left out: these are places on the middle line.": corners(p, wide=0),
            "An angle is that to the segment before, not that to the ground.": corners(p, turns=0),
            "The torso leans by its own default angle: it is left out.": corners(
                np.where(np.arange(BODY) == 42, 0, p)
            ),
            **{
                "The corners of a segment come in another order: "
                f"{', '.join(CORNERS[k] for k in order)}.": own[:, order]
                for order in permutations(range(4)) if order != (0, 1, 2, 3)
            },
        }  # fmt: skip
        said = said_of("outline", p)
        answer = expect_array(said, answer, (11, 4, 2))
        expect_close(said, answer, own, TOLERANCE, mistakes=mistakes)


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
    """A very small experiment of the grader's."""
    rng = rng_of(index)
    algorithms = (
        ("SSS", "popsize = 4\nmutrate = 1"),
        ("OpenAI-ES", "samplesize = 2\nnoiseStdDev = 0.5\nstepsize = 0.5"),
    )
    algo, more = algorithms[index % 2]
    episodes, hidden = int(rng.integers(1, 3)), int(rng.integers(3, 9))
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
    return [walkers, saved, given]


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


class Trial:
    """The student's runs of a very small experiment, and the grader's own."""

    def __init__(self, student: Student, index: int, steps: int | None, zero: bool = False) -> None:
        text = self.text = experiment_text(index)
        seeds = telling_seeds(text, index)
        seeds = [seeds[0], 0] if zero else seeds
        self.said = f"evolve_walkers('trial.ini', {seeds}, 'some/runs', {steps})"
        self.walkers, saved, after = student.run(
            try_runs, text, seeds, "some/runs", steps, said=self.said
        )
        expect(after == seeds, f"{self.said} changed the list of seeds: it is {after} now.")
        self.saved = [saved.get(str(seed)) for seed in seeds]
        self.wanted = np.array([own_run(text, seed, steps)[0] for seed in seeds])
        self.seeds, self.steps = seeds, steps

    def compare(self) -> None:
        """Expect the walkers that the grader finds."""
        right = self.walkers is not None and np.array_equal(self.walkers, self.wanted)
        expect_close(self.said, self.walkers, self.wanted, mistakes={} if right else self.made())

    def made(self) -> dict[str, np.ndarray]:
        """What mistakes make of the walkers."""

        def runs(seeds: list[int], steps: int | None, kind: int = 0) -> np.ndarray:
            return np.array([own_run(self.text, seed, steps)[kind] for seed in seeds])

        seeds, steps = self.seeds, self.steps
        return {
            "These genotypes have the best fitness, not the best post-evaluated fitness.": runs(
                seeds, steps, 1
            ),
            "The walkers are in another order than the seeds.": self.wanted[::-1],
            "The runs do not end after the steps that are asked for.": runs(seeds, None),
            "The seeds that are given are not used: these runs have the seeds 0 and 1.": runs(
                [0, 1], steps
            ),
            "The seeds that are given are not used: these runs have the seeds 1 and 2.": runs(
                [1, 2], steps
            ),
            "The seed 0 is a seed like any other: another one is used in its place.": runs(
                [seed or 1 for seed in seeds], steps
            ),
            "Each run begins with the seed of the first one.": runs([seeds[0]] * 2, steps),
        }


@running.check(6)
def best_walker_of_each_run(student: Student):
    for index in (20, 21):
        Trial(student, index, None).compare()


@running.check(3)
def leaves_the_files(student: Student):
    trial = Trial(student, 20, None)
    for seed, file, wanted in zip(trial.seeds, trial.saved, trial.wanted, strict=True):
        expect(file is not None, f"{trial.said} left no file bestgS{seed}.npy in some/runs.")
        expect_close(f"{trial.said}: bestgS{seed}.npy", file, wanted)


@running.check(3)
def stops_after_the_steps(student: Student):
    Trial(student, 20, 100, zero=True).compare()


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


@surgery.check(3)
def body_is_cut_out(student: Student):
    for index in (30, 31):
        for genotype in genotypes(index):
            body = student.call("body_of", genotype)
            expect_close(student.said, body, genotype[-134:-70], 0)


@surgery.check(5)
def brain_in_another_body(student: Student):
    for index in (32, 33):
        brain, body = genotypes(index)
        answer = student.run(operate, brain, body, said="transplant(brain, body)")
        got = expect_array(student.said, answer[0], brain.shape)
        expect_close(f"{student.said}: parameters of the network", got[:-134], brain[:-134], 0)
        expect_close(f"{student.said}: parameters of the body", got[-134:-70], body[-134:-70], 0)
        expect_close(f"{student.said}: means and deviations", got[-70:], brain[-70:], 0)


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


@lru_cache
def walkers_of(index: int) -> np.ndarray:
    """The pre-evolved walkers, each with brain and body varied a little."""
    evolved = np.array([np.load(genotype_file(f"bodybrainS{seed}.npy")) for seed in (1, 2, 3)])
    evolved[:, :-70] += 0.02 * rng_of(index).normal(size=evolved[:, :-70].shape)
    return evolved


def own_returns(text: str, walkers: np.ndarray, seed: int, episodes: int) -> np.ndarray:
    """The return of each brain in each body in each episode."""
    n = len(walkers)
    returns = np.zeros((n, n, episodes))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "trial.ini"
        file.write_text(text)
        for i, j in np.ndindex(n, n):
            parts = walkers[i, :-134], walkers[j, -134:-70], walkers[i, -70:]
            robot = SavedRobot(file, np.concatenate(parts))
            returns[i, j] = robot.evaluate(seed, episodes)
    return returns


def expect_matrix(
    student: Student, text: str, walkers: np.ndarray, seed: int, episodes: int
) -> None:
    said = f"cross_evaluate('trial.ini', {len(walkers)} walkers, {seed}, {episodes})"
    matrix, unchanged = student.run(cross, text, walkers, seed, episodes, said=said)
    expect(unchanged is True, f"{said} changed the walkers that it was given: work on copies.")
    returns = own_returns(text, walkers, seed, episodes)
    wanted, n = returns.mean(axis=2), len(walkers)
    own = np.repeat(np.diagonal(wanted)[None], n, axis=0)
    mistakes = {
        "Only the first episode counts, not the mean.": returns[:, :, 0],
        "Only the last episode counts, not the mean.": returns[:, :, -1],
        "The best episode is taken, not the mean.": returns.max(axis=2),
        "The median of the episodes is taken, not the mean.": np.median(returns, axis=2),
        "The episodes are added up, not averaged.": returns.sum(axis=2),
        "A row holds one number again and again: each brain stays in its own body.": own.T,
        "A column holds one number again and again: each body keeps its own brain.": own,
        "A pair gets the number of the pair with the roles exchanged: the half below the "
        "diagonal mirrors the one above.": np.triu(wanted) + np.triu(wanted, 1).T,
        "A pair gets the number of the pair with the roles exchanged: the half above the "
        "diagonal mirrors the one below.": np.tril(wanted) + np.tril(wanted, -1).T,
    }
    expect_close(said, matrix, wanted, TOLERANCE, mistakes=mistakes)


@crossing.check(6)
def pre_evolved_walkers(student: Student):
    expect_matrix(student, walking(50, 60), walkers_of(40), secrets.randbelow(2**31), 1)


@crossing.check(3)
def another_experiment(student: Student):
    walkers = rng_of(41).normal(size=(4, 46 * 5 + 10 + BODY + 2 * OBSERVATIONS))
    walkers[:, -OBSERVATIONS:] = 1
    expect_matrix(student, walking(5, 20), walkers, 0, 3)


# ------------------------------------------------------------------- 5.8
losing = exercise.task("5.8", "What is lost")


def made_up_matrices(index: int) -> list[np.ndarray]:
    """Matrices, the small ones with whole numbers."""
    rng = rng_of(index)
    made = [30 * rng.normal(size=(n, n)) + 25 * np.eye(n) * rng.random() for n in (2, 3, 5, 8)]
    return [*(matrix.round() + 0.0 for matrix in made[:2]), *made[2:]]


def wrong_losses(matrix: np.ndarray, key: str) -> dict:
    """What mistakes make of a part of the answer."""
    n, own, others = len(matrix), np.diagonal(matrix), matrix[~np.eye(len(matrix), dtype=bool)]
    if key == "own":
        return {
            "This is the other diagonal.": np.diagonal(matrix[:, ::-1]).mean(),
            "The diagonal is added up, not averaged.": own.sum(),
            "This is the mean of the whole matrix.": matrix.mean(),
        }
    if key == "foreign":
        return {
            "The diagonal is counted among the foreign places.": matrix.mean(),
            "The foreign returns are divided by the number of all places: there are n (n - 1) "
            "foreign ones.": others.sum() / n**2,
            "The foreign returns are divided by n: there are n (n - 1) foreign places.":
            others.sum() / n,
            "The foreign returns are divided by n - 1: there are n (n - 1) foreign places.":
            others.sum() / (n - 1),
            "Only the places above the diagonal are counted.": matrix[np.triu_indices(n, 1)].mean(),
            "Only the places below the diagonal are counted.":
            matrix[np.tril_indices(n, -1)].mean(),
        }  # fmt: skip
    table = matrix.T if key == "bodies" else matrix
    rest = table[~np.eye(n, dtype=bool)].reshape(n, n - 1)
    if key == "at home":
        return {
            "This is the share of the brains, not their number.": np.mean(own > rest.max(axis=1)),
            "Brains are rows: this counts columns.":
            np.sum([own[i] > max(np.delete(matrix[:, i], i)) for i in range(n)]),
            "A brain must beat each other place of its row, not their mean.":
            np.sum(own > rest.mean(axis=1)),
            "A brain must beat all other places of its row, not just one.":
            np.sum(own > rest.min(axis=1)),
        }  # fmt: skip
    return {
        "The own place is counted among the others.": own - table.mean(axis=1),
        "The others are added up and divided by n: there are n - 1 others.":
        own - rest.sum(axis=1) / n,
        "The others are added up, not averaged.": own - rest.sum(axis=1),
        "The mean of all foreign places is subtracted, not that of the row or column.":
        own - others.mean(),
        "The best of the others is subtracted, not their mean.": own - rest.max(axis=1),
        "The loss is divided by the own return.":
        1 - rest.mean(axis=1) / np.where(own, own, np.nan),
        "This is the mean of the others: subtract it from the own return.": rest.mean(axis=1),
        "Rows are brains and columns bodies: the two are exchanged.":
        own - (table.sum(axis=0) - own) / (n - 1),
    }  # fmt: skip


def expect_loss(student: Student, index: int, *keys: str) -> None:
    for matrix in made_up_matrices(index):
        answer = student.call("loss", matrix)
        values = expect_fields(student.said, answer, *keys)
        for key, value in zip(keys, values, strict=True):
            wrong = wrong_losses(matrix, key)
            expect_close(f"{student.said}: {key}", value, own_loss(matrix, key), TOLERANCE, wrong)


def own_loss(matrix: np.ndarray, key: str):
    n = len(matrix)
    others = [[matrix[i, j] for j in range(n) if j != i] for i in range(n)]
    if key == "own":
        return np.mean([matrix[i, i] for i in range(n)])
    if key == "foreign":
        return np.mean(others)
    if key == "brains":
        return [matrix[i, i] - np.mean(others[i]) for i in range(n)]
    if key == "bodies":
        return [
            matrix[i, i] - np.mean([matrix[j, i] for j in range(n) if j != i]) for i in range(n)
        ]
    return sum(matrix[i, i] > max(others[i]) for i in range(n))


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
        expect_close(f"loss({rows}): at home", value, own_loss(np.array(rows), "at home"))
    rows = np.array(matrices[1])
    after = student.run(matrix_after, rows, said="loss(matrix)")
    expect(
        np.array_equal(expect_array("loss(matrix): the matrix after it", after, (3, 3)), rows),
        "loss(matrix) changed the matrix that it was given: work on a copy.",
    )
