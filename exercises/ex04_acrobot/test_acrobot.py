"""Grader of exercise 4; run it with `make test-ex4`.

Nothing here is a matter of luck: runs are the same to the last bit whenever they have the same
experiment and seed, so each answer is compared with what the grader computes itself. The
experiments are short ones of its own, with seeds that nobody knows before, and the saved robots of
task 4.6 are made up for it.
"""

import secrets
import tempfile
import warnings
from functools import lru_cache
from pathlib import Path

import gymnasium
import numpy as np

from botschool import config
from botschool.course import SavedRobot
from botschool.evolution.run import Run, evolve
from botschool.grading import (
    Exercise,
    Mismatch,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    show,
)

exercise = Exercise(4, "The tool", file="acrobot.py")
COLUMNS = (
    "steps",
    "best fitness",
    "best post-evaluated",
    "best of generation",
    "average",
    "average parameter",
)


def rng_of(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def answers(module, name, questions):
    """The student's answer to each of many questions."""
    return [getattr(module, name)(question) for question in questions]


def asked(student: Student, name: str, questions: list) -> list:
    """The answers, in two calls: a known mistake must explain more than one."""
    given, half = [], len(questions) // 2
    for part in (questions[:half], questions[half:]):
        found = student.run(answers, name, part, said=f"{name}(...)")
        expect(isinstance(found, list) and len(found) == len(part), f"{name} gave no answers.")
        given += found
    return given


def number(said: str, value: object) -> float:
    """A plain, finite number."""
    expect(
        isinstance(value, (int, float)), f"{said}: a single number is needed, not {show(value)}."
    )
    return float(expect_array(said, value, ()))


@exercise.cached
def moves(index: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """States before and observations and rewards after steps of Gymnasium's Acrobot."""
    rng = rng_of(index)
    env = gymnasium.make("Acrobot-v1").unwrapped
    env.reset(seed=1)
    states, observations, rewards = [], [], []
    while len(states) < 200:
        env.state = rng.uniform(-1, 1, 4) * (np.pi, np.pi, 4, 8)
        observation, reward, _, _, _ = env.step(int(rng.integers(3)))
        inexact = np.abs(np.sin(env.state[:2])).min() < 3e-3  # for the arc cosine of a float32
        if abs(height_of(env.state) - 1) > 1e-3 and not inexact:
            states.append(np.array(env.state))
            observations.append(observation.astype(np.float64))
            rewards.append(reward)
    return np.array(states), np.array(observations), np.array(rewards)


def height_of(state: np.ndarray) -> float:
    return float(-np.cos(state[0]) - np.cos(state[0] + state[1]))


def shown(observation: np.ndarray) -> list[float]:
    return np.round(observation, 3).tolist()


def expect_near(
    said: list[str], values: list, wanted: np.ndarray, mistakes: dict | None = None
) -> None:
    """Answers computed from float32 observations; the worst one is reported."""
    values = [number(*each) for each in zip(said, values, strict=True)]
    wrong = np.abs(np.subtract(values, wanted))
    worst = int(wrong.argmax())
    if wrong[worst] >= 1e-4:
        sentence = (
            f"{said[worst]} should be {wanted[worst]:.4f}, but is {values[worst]:.4f} (the "
            "observation is shown with rounded numbers)."
        )
        raise Mismatch(sentence, np.round(values, 3), np.round(wanted, 3), mistakes)


# ------------------------------------------------------------------- 4.1
observation_task = exercise.task("4.1", "What Acrobot observes")


def expect_decoded(student: Student, index: int, keys: tuple[str, str], columns: slice) -> None:
    states, observations, _ = moves(index)
    given = [
        expect_fields(f"decode({shown(observation)})", answer, *keys)
        for observation, answer in zip(
            observations, asked(student, "decode", list(observations)), strict=True
        )
    ]
    for position, key in enumerate(keys):
        said = [f"decode({shown(observation)}): {key}" for observation in observations]
        other = f"This is {keys[1 - position]}, but {key} is asked for."
        wanted = states[:, columns][:, position]
        mistakes = {other: np.round(states[:, columns][:, 1 - position], 3)}
        if "angle" in key:
            turned = "The angles go from 0 to 2 pi, but they should go from -pi to pi."
            mistakes |= {
                turned: np.round(wanted % (2 * np.pi), 3),
                "These are degrees, but radians are asked for.": np.round(np.degrees(wanted), 3),
                "The sign is lost, as with the arc cosine, but it should be kept.": np.round(
                    np.abs(wanted), 3
                ),
                "These are only angles from -pi/2 to pi/2, as arctan(sine / cosine) gives them, "
                "but they should go from -pi to pi.": np.round(np.arctan(np.tan(wanted)), 3),
                "These are only angles from -pi/2 to pi/2, as the arc sine gives them, but they "
                "should go from -pi to pi.": np.round(np.arcsin(np.sin(wanted)), 3),
            }
        if key == "angle2":
            both = states[:, :2].sum(axis=1)
            mistakes |= {
                "This is counted from straight down, but it should be counted from the first "
                "link.": np.round(both, 3),
                "This is counted from straight down (between -pi and pi), but it should be counted "
                "from the first link.": np.round((both + np.pi) % (2 * np.pi) - np.pi, 3),
            }
        values = [values[position] for values in given]
        expect_near(said, values, wanted, mistakes)


@observation_task.check(9)
def angles(student: Student):
    expect_decoded(student, 1, ("angle1", "angle2"), slice(0, 2))


@observation_task.check(4)
def speeds(student: Student):
    expect_decoded(student, 2, ("speed1", "speed2"), slice(2, 4))


# ------------------------------------------------------------------- 4.2
rules = exercise.task("4.2", "What Acrobot does, and what for", needs=("4.1",))


TORQUES = "The actions 0, 1 and 2 should put a torque of -1, 0 and +1 on the joint."


@rules.check(4)
def torque(student: Student):
    for action in (2, 0, 1, 2):
        value = number(f"torque({action})", student.call("torque", action))
        wanted = (-1.0, 0.0, 1.0)[action]
        expect_close(f"torque({action})", value, wanted, why=lambda: TORQUES)


@rules.check(7)
def height(student: Student):
    states, observations, _ = moves(3)
    given = asked(student, "height", list(observations))
    said = [
        f"height({shown(observation)}), with the angles {state[0]:.2f} and {state[1]:.2f},"
        for state, observation in zip(states, observations, strict=True)
    ]
    wanted = np.array([height_of(state) for state in states])
    mistakes = {
        "The second link's part is computed from angle2 alone, but its angle with straight down is "
        "angle1 + angle2, because angle2 is counted from the first link.": np.round(
            -np.cos(states[:, 0]) - np.cos(states[:, 1]), 3
        ),
        "This is the height of the first link's end, but the height of the free end is asked "
        "for.": np.round(-np.cos(states[:, 0]), 3),
        "This is the height above the lowest point, but the height above the nail is asked "
        "for.": np.round(wanted + 2, 3),
        "The height of the second link is subtracted, but it should be added.": np.round(
            -np.cos(states[:, 0]) + np.cos(states[:, :2].sum(axis=1)), 3
        ),
        "The second angle is subtracted from the first, but it should be added.": np.round(
            -np.cos(states[:, 0]) - np.cos(states[:, 0] - states[:, 1]), 3
        ),
        "This is measured downwards, but a hanging arm should have the height -2.": np.round(
            -wanted, 3
        ),
        "Sines are used here, but cosines are asked for.": np.round(
            -np.sin(states[:, 0]) - np.sin(states[:, :2].sum(axis=1)), 3
        ),
    }
    expect_near(said, given, wanted, mistakes)


@rules.check(6)
def reward(student: Student):
    states, observations, rewards = moves(4)
    given = asked(student, "reward", list(observations))
    for state, observation, value, wanted in zip(states, observations, given, rewards, strict=True):
        said = f"reward({shown(observation)})"
        expect(
            number(said, value) == wanted,
            f"{said} returned {value:g}, but Gymnasium gives {wanted:g}: the height of the "
            f"free end is {height_of(state):.2f}, that of the line is 1.",
        )
    for side in (1.0, -1.0):
        value = student.call("reward", np.array([0, side, 0, side, 0, 0], dtype=np.float32))
        expect(
            number(student.said, value) == -1,
            f"{student.said} returned {value:g}, but the free end is exactly on the line, not "
            "above it, so the reward should be -1.",
        )


# ------------------------------------------------------------------- 4.3
replications = exercise.task("4.3", "Replications with the tool", seconds=40)

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
maxmsteps = 1
samplesize = 8
"""
PENDULUM = """\
[EXP]
environment = Pendulum-v1
algo = SSS
[POLICY]
pepisodes = 2
nhiddens = 4
[ALGO]
maxmsteps = 0.02
popsize = 6
"""


def replicate(module, text, seeds, folder, steps):
    """Writes the experiment file, then runs the student's function; also lists what it writes."""
    import pathlib
    import time

    pathlib.Path("trial.ini").write_text(text)
    given, start = list(seeds), time.time() - 0.01
    fitness = module.run_replications("trial.ini", given, folder, steps)
    pairs = list(map(list, fitness.items())) if isinstance(fitness, dict) else fitness
    files = pathlib.Path().rglob("stat*.npy")
    return [pairs, given, sorted(str(each) for each in files if each.stat().st_mtime >= start)[:1]]


@lru_cache
def files_of(text: str, seed: int, steps: int | None) -> dict[str, object]:
    """The files of a run, as the tool writes them, and its best post-evaluated fitness."""
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "trial.ini"
        file.write_text(text)
        run = Run(config.load(file), seed)
        evolve(run, Path(place), steps)
        names = [f"{kind}S{seed}.npy" for kind in ("stat", "best", "bestg")]
        arrays = {name: np.load(Path(place) / name) for name in names}
        fit = (Path(place) / f"S{seed}.fit").read_bytes()
    return {**arrays, "fit": fit, "fitness": run.record.bestg_fitness}


class Trial:
    """An experiment that the student has run, with seeds that are new in every grading.

    So no files that were made beforehand can pass; what is right does not depend on the seeds.
    """

    def __init__(
        self,
        student: Student,
        text: str,
        folder: str,
        steps: int | None,
        seeds: list[int] | None = None,
    ):
        self.student, self.text, self.folder, self.steps = student, text, folder, steps
        low, high = sorted(secrets.randbelow(999_000) + 1 for _ in range(2))
        self.seeds = seeds or [high + 2, low]
        report = student.run(
            replicate, text, self.seeds, folder, steps,
            said=f"run_replications('trial.ini', {self.seeds}, '{folder}', {steps})",
        )  # fmt: skip
        self.said = student.said
        expect(isinstance(report, list) and len(report) == 3, f"{self.said} gave no answer.")
        self.answer, after, made = report
        self.missing = "was not written"
        self.missing += f", but {made[0]} was." if made else "."
        expect(after == self.seeds, f"{self.said} changed the list of seeds: it is {after} now.")

    def expect_files(self, *kinds: str) -> None:
        """The files are those which the tool makes for this experiment and seed."""
        for seed in self.seeds:
            wanted = files_of(self.text, seed, self.steps)
            for name in (f"{kind}S{seed}.npy" for kind in kinds):
                array = load_array(self.student, f"{self.folder}/{name}", self.said, self.missing)
                self._expect_same(f"{self.said}: {self.folder}/{name}", array, wanted[name])
            fit = self.student.scratch(f"{self.folder}/S{seed}.fit").read_bytes()
            expect(
                fit == wanted["fit"],
                f"{self.said}: {self.folder}/S{seed}.fit is not what the tool writes for the "
                "experiment, seed and number of steps of this run.",
            )

    def _expect_same(self, said: str, array: np.ndarray, wanted: np.ndarray) -> None:
        if array.shape != wanted.shape and array.ndim == 1 and "/stat" in said:
            short = array.size < wanted.size
            raise Wrong(
                f"{said} holds another number of generations ({array.size // 6}) than the run that "
                f"was asked for ({wanted.size // 6})."
                + (" It ends too early: each run should do all of its steps." if short else "")
            )
        expect_array(said, array, wanted.shape)
        expect(
            np.array_equal(array, wanted),
            f"{said} is not what the tool writes for the experiment, seed and number of steps of "
            "this run.",
        )


def load_array(student: Student, name: str, said: str, missing: str) -> np.ndarray:
    """An array that the submission has saved; nothing but numbers is read."""
    try:
        path = student.scratch(name)
    except Wrong:
        raise Wrong(f"{said}: the file {name} {missing}") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return np.load(path, allow_pickle=False)
    except Exception:
        raise Wrong(f"{said}: {name} is not a NumPy file of numbers.") from None


@replications.check(8)
def curves_are_saved(student: Student):
    Trial(student, ACROBOT, "runs", 60_000).expect_files("stat")


@replications.check(6)
def robots_are_saved(student: Student):
    Trial(student, ACROBOT, "robots", 50_000).expect_files("best", "bestg")


@replications.check(6)
def any_experiment_in_any_folder(student: Student):
    trial = Trial(student, PENDULUM, "results/pendulum", None)
    trial.expect_files("stat", "best", "bestg")


def other_fitness(values: dict[int, object]) -> str:
    """What the values of all runs are, if the runs' files hold them at another place."""
    lasts = [files_of(ACROBOT, s, 40_000)[f"statS{s}.npy"].reshape(-1, 6)[-1] for s in values]
    given = [expect_array(f"the fitness of run {s}", value, ()) for s, value in values.items()]
    others = {
        1: "the best fitness",
        3: "the best fitness of the last generation",
        4: "the average fitness of the last generation",
        0: "the number of steps",
    }
    best = [files_of(ACROBOT, s, 40_000)["fitness"] for s in values]
    if np.allclose(given, np.maximum.accumulate(best), rtol=1e-5):
        return (
            "\n  This is the best of this run and those before it, but that of this run is needed."
        )
    for column, text in others.items():
        if np.allclose(given, [last[column] for last in lasts], rtol=1e-5):
            return f"\n  This is {text}, but the best post-evaluated fitness is asked for."
    return ""


@replications.check(4)
def tells_the_fitness_of_each_run(student: Student):
    """In a folder that exists and holds the files of other runs, which stay."""
    before = Trial(student, PENDULUM, "fitness", 8_000)
    before.expect_files("stat")
    low, high = sorted(secrets.randbelow(999_000) + 1 for _ in range(2))
    falling = sorted([high + 2, low], key=lambda seed: -files_of(ACROBOT, seed, 40_000)["fitness"])
    trial = Trial(student, ACROBOT, "fitness", 40_000, falling)
    before.said, before.missing = trial.said, "of an earlier run is gone: such files should stay."
    before.expect_files("stat", "best", "bestg")
    trial.expect_files("stat")
    pairs = trial.answer
    expect(
        isinstance(pairs, list) and all(isinstance(p, list) and len(p) == 2 for p in pairs),
        f"{trial.said} returned {show(pairs)}, but a dict is needed.",
    )
    keys = [key for key, _ in pairs]
    expect(
        all(type(key) is int for key in keys) and sorted(keys) == sorted(trial.seeds),
        f"{trial.said} returned a dict with the keys {show(keys)}, but its keys should be the "
        "seeds, as integers.",
    )
    for seed, value in pairs:
        said = f"{trial.said}: the fitness of run {seed}"
        wanted = files_of(ACROBOT, seed, 40_000)["fitness"]
        got = float(expect_array(said, value, ()))
        if abs(got - wanted) > 1e-6 * (1 + abs(wanted)):
            raise Wrong(
                f"{said} is {got:.6g}, but {wanted:.6g} was expected.{other_fitness(dict(pairs))}"
            )
    again = Trial(student, PENDULUM, "fitness", 4_000, before.seeds)
    again.said += ", whose seeds have files in the folder already (they should be replaced)"
    again.expect_files("stat")


# ------------------------------------------------------------------- 4.4
reading = exercise.task("4.4", "The stat file")


def read_saved(module, path, numbers):
    """Saves numbers as the tool does, and has them read."""
    import pathlib

    import numpy

    pathlib.Path(path).parent.mkdir(exist_ok=True)
    numpy.save(path, numbers)
    return module.read_stat(path)


def expect_columns(student: Student, generations: int, columns: tuple[str, ...]) -> None:
    rng = rng_of(20 + generations)
    table = rng.normal(size=(generations, 6)).round(3)
    table[:, COLUMNS.index("steps")] = np.cumsum(rng.integers(100, 900, generations))
    path = f"runs{generations}/statS{exercise.seed(20 + generations) % 1000}.npy"
    said = f"read_stat({path!r}), a file of {generations} generation{'s' * (generations > 1)}"
    stat = student.run(read_saved, path, table.ravel(), said=said)
    for name, values in zip(columns, expect_fields(said, stat, *columns), strict=True):
        column = COLUMNS.index(name)
        mistakes = {
            "The file is read as one column after another, but it holds one generation after "
            "another: six numbers for each.": table.ravel().reshape(6, -1)[column],
            "These are the numbers of all columns, but those of one column are asked "
            "for.": table.T.ravel(),
            "These are all numbers of the file, but those of one column are asked "
            "for.": table.ravel(),
        }
        expect_close(f"{said}: {name}", values, table[:, column], mistakes=mistakes)


@reading.check(8)
def columns_are_told_apart(student: Student):
    for generations in (4, 25):
        expect_columns(student, generations, COLUMNS)


@reading.check(3)
def any_number_of_generations(student: Student):
    for generations in (2, 6, 611):
        expect_columns(student, generations, ("steps", "average parameter"))


@reading.check(2)
def a_single_generation(student: Student):
    expect_columns(student, 1, COLUMNS)


# ------------------------------------------------------------------- 4.5
spread = exercise.task("4.5", "Mean and spread at equal steps")


def made_up_stats(index: int, runs: int) -> list[dict[str, np.ndarray]]:
    """Curves of runs with generations of different number and length."""
    rng = rng_of(index)
    stats = []
    for _ in range(runs):
        generations = int(rng.integers(20, 60))
        table = rng.normal(size=(generations, 6)).cumsum(axis=0)
        table[:, 0] = rng.integers(500, 2000, generations).cumsum()
        stats.append({name: table[:, column] for column, name in enumerate(COLUMNS)})
    return stats


def wanted_curves(stats: list[dict], column: str, budgets: np.ndarray):
    values = [
        [stat[column][np.flatnonzero(stat["steps"] <= budget)[-1]] for budget in budgets]
        for stat in stats
    ]
    return np.mean(values, axis=0), np.std(values, axis=0, ddof=1)


def expect_curves(student: Student, stats, column: str, budgets, key: str) -> None:
    answer = student.call("curves", stats, column, budgets)
    order = "in rising order" if np.all(np.diff(budgets) >= 0) else "in any order"
    said = (
        f"curves(stats of {len(stats)} runs, '{column}', {len(budgets)} "
        f"budget{'s' * (len(budgets) > 1)}, {order})"
    )
    (values,) = expect_fields(said, answer, key)
    wanted = dict(zip(("mean", "deviation"), wanted_curves(stats, column, budgets), strict=True))
    expect_close(
        f"{said}: {key}", values, wanted[key], mistakes=mistaken(stats, column, budgets, key)
    )


def mistaken(stats: list[dict], column: str, budgets: np.ndarray, key: str) -> dict:
    """What mistakes make of the mean or deviation."""

    def made(of_run) -> np.ndarray:
        values = np.array([of_run(stat["steps"], stat[column]) for stat in stats])
        return values.mean(axis=0) if key == "mean" else values.std(axis=0, ddof=1)

    def before(steps, values):
        return [values[max(0, np.searchsorted(steps, budget) - 1)] for budget in budgets]

    def following(steps, values):
        places = np.searchsorted(steps, budgets).clip(0, len(steps) - 1)
        return values[places]

    def highest(steps, values):
        places = np.searchsorted(steps, budgets, side="right") - 1
        return np.maximum.accumulate(values)[places]

    def equal(steps, values):
        return [values[min(i, len(values) - 1)] for i in range(len(budgets))]

    return {
        "A generation whose steps equal the budget is left out, but it should count.": made(before),
        "The runs are compared at equal generations, but equal steps are asked for.": made(equal),
        "This interpolates between two generations, but the value of the last one that is complete "
        "at the budget is asked for.": made(
            lambda steps, values: np.interp(budgets, steps, values)
        ),
        "The first generation that ends at or after the budget is taken, but the last one that is "
        "complete by then is asked for.": made(following),
        "The highest value up to the budget is taken, but that of the last complete generation is "
        "asked for.": made(highest),
    }


@spread.check(6)
def mean_at_equal_steps(student: Student):
    for index, column in ((30, "best post-evaluated"), (31, "average")):
        stats = made_up_stats(index, 5)
        budgets = np.linspace(2100, max(stat["steps"][-1] for stat in stats) + 500, 40)
        expect_curves(student, stats, column, budgets, "mean")
    stats = made_up_stats(35, 3)
    budgets = rng_of(36).permutation(np.linspace(2100, 40_000, 12)).round()
    expect_curves(student, stats, "average", budgets, "mean")
    expect_curves(student, stats, "best fitness", budgets[3:8], "mean")
    expect_curves(student, stats, "average", budgets[:1], "mean")


@spread.check(5)
def deviation_at_equal_steps(student: Student):
    for index, runs in ((32, 4), (33, 2)):
        stats = made_up_stats(index, runs)
        budgets = np.linspace(2100, min(stat["steps"][-1] for stat in stats), 30)
        expect_curves(student, stats, "best fitness", budgets, "deviation")


@spread.check(4)
def a_budget_met_exactly(student: Student):
    stats = made_up_stats(34, 3)
    budgets = np.sort([steps for stat in stats for steps in stat["steps"][2:12]])
    expect_curves(student, stats, "best of generation", budgets[budgets > 2000], "mean")


# ------------------------------------------------------------------- 4.6
worth = exercise.task("4.6", "What the robots are worth", seconds=30, needs=("4.4",))


def compare_saved(module, text, files, folder, seeds, episodes, test_seed):
    """Writes an experiment file and the files of runs, then runs the student's function."""
    import pathlib

    import numpy

    pathlib.Path("trial.ini").write_text(text)
    pathlib.Path(folder).mkdir(exist_ok=True)
    for name, numbers in files.items():
        numpy.save(pathlib.Path(folder) / name, numbers)
    return module.compare("trial.ini", folder, seeds, episodes, test_seed)


@exercise.cached
def made_up_runs(text: str, index: int):
    """Seeds and files of three runs; the robots are evolved ones with some noise."""
    rng = rng_of(index)
    low, high, middle = (int(seed) for seed in np.sort(rng.permutation(900)[:3]) + 1)
    seeds = [middle, high, low]
    files = {}
    for seed in seeds:
        done = files_of(text, seed, 60_000)
        for kind in ("best", "bestg"):
            genotype = done[f"{kind}S{seed}.npy"]
            files[f"{kind}S{seed}.npy"] = genotype + 0.03 * rng.normal(size=genotype.shape)
        table = done[f"statS{seed}.npy"].reshape(-1, 6)
        table = table + rng.normal(size=table.shape).round(3)
        table[:, 1:3] = np.maximum.accumulate(table[:, 1:3])  # the best so far, which never falls
        files[f"statS{seed}.npy"] = table.ravel()
    for name, numbers in list(files.items()):  # of another run, whose seed begins in the same way
        files[name.replace(".npy", "7.npy")] = numbers + 0.1
    return seeds, files


def expect_worth(student: Student, text: str, index: int, keys: tuple[str, ...]) -> None:
    seeds, files = made_up_runs(text, index)
    episodes, test_seed = 20 + secrets.randbelow(40), secrets.randbelow(2**31)
    folder = f"saved{index}"
    said = f"compare('trial.ini', {folder!r}, {seeds}, {episodes}, {test_seed})"
    rows = student.run(compare_saved, text, files, folder, seeds, episodes, test_seed, said=said)
    expect(
        isinstance(rows, list) and len(rows) == len(seeds),
        f"{said} returned {show(rows)}, but a list of {len(seeds)} dicts is needed.",
    )
    for seed, row in zip(seeds, rows, strict=True):
        values = expect_fields(said, row, "seed", *keys)
        expect(
            values[0] == seed,
            f"{said}: a row has the seed {show(values[0])}, but {seed} was expected there.",
        )
        for key, value in zip(keys, values[1:], strict=True):
            worth = worth_of(text, files, key, seed, episodes, test_seed)
            mistakes = {
                "This is the return of the best episode, but the mean is asked for.": worth.max()
            }
            if key == "promised":
                first = files[f"statS{seed}.npy"][2]
                mistakes = {
                    "This is the value of the first generation, but that of the last is asked "
                    "for.": first
                }
            said_of = f"{said}: {key} of seed {seed}"
            expect_close(said_of, value, worth.mean(), mistakes=mistakes)


def worth_of(text, files, key: str, seed: int, episodes: int, test_seed: int) -> np.ndarray:
    """Returns, whose mean is asked for."""
    if key == "promised":
        return files[f"statS{seed}.npy"].reshape(-1, 6)[-1, 2:3]
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "trial.ini"
        file.write_text(text)
        robot = SavedRobot(file, files[f"{key}S{seed}.npy"])
    return robot.evaluate(test_seed, episodes)


@worth.check(4)
def promised(student: Student):
    expect_worth(student, ACROBOT, 40, ("promised",))


@worth.check(8)
def both_robots_in_new_episodes(student: Student):
    expect_worth(student, ACROBOT, 41, ("best", "bestg"))


@worth.check(6)
def another_experiment(student: Student):
    expect_worth(student, PENDULUM, 42, ("best", "bestg"))
