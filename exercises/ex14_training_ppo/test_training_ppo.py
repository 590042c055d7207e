"""Grader of exercise 14; run it with `make test-ex14`.

Nothing here is left to chance. Most logs are prepared: drawn from the grading seed, so that the
answers are known. The few short trainings depend on their settings and seed alone, and are done
again by the grader for comparison.
"""

import functools
import io
import itertools
import os
import tempfile
import zipfile
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading import (
    Exercise,
    Student,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    show,
    slips,
)

exercise = Exercise(
    14,
    "Training with PPO",
    file="training_ppo.py",
    imports=(
        "torch",
        "torch._dynamo",
        "torch.utils.tensorboard",
        "stable_baselines3",
        "botschool.rl.callbacks",
        "tensorboard.backend.event_processing.event_accumulator",
    ),
    extras=("rl",),
)
CLOSE = 1e-6
SHORT = {"n_steps": 16, "batch_size": 64, "n_epochs": 2, "normalize": False}
"""Hyperparameters of trainings that take a fraction of a second."""
STEPS, EVALUATIONS, EPISODES = 384, 2, 3
LARGEST = 100_000
"""Bytes of a file that such a training leaves behind."""


def generator(index: int) -> np.random.Generator:
    return np.random.default_rng(exercise.seed(index))


def with_files(module, name, files, *arguments):
    """Calls a function of the student's after writing files; files: path -> bytes as uint8."""
    from pathlib import Path

    for path, content in files.items():
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_bytes(content.tobytes())
    return getattr(module, name)(*arguments)


def as_bytes(content: bytes) -> np.ndarray:
    return np.frombuffer(content, dtype=np.uint8)


@functools.cache
def folder() -> tempfile.TemporaryDirectory:
    """Where the grader's own trainings lie; removed at the end."""
    return tempfile.TemporaryDirectory(prefix="botschool-")


@exercise.cached
def training(environment: str, index: int, rate: float):
    """A short training by the grader: its RunFolder."""
    from botschool.rl.training import train

    return train(
        "ppo", environment, Path(folder().name), params={**SHORT, "learning_rate": rate},
        steps=STEPS, seed=seed_of(index), evaluations=EVALUATIONS, episodes=EPISODES,
    )  # fmt: skip


def seed_of(index: int) -> int:
    return exercise.seed(index) % 10_000


def rate_of(index: int) -> float:
    return round(float(generator(index).uniform(0.002, 0.02)), 5)


# ------------------------------------------------------------------- 14.1
varying = exercise.task("14.1", "Variations", seconds=60)


def evidence(student: Student, record: dict, variant: str):
    """The RunFolder that a record names, copied to where the student cannot change it."""
    from botschool.rl.folder import RunFolder

    (place,) = expect_fields(student.said, record, "folder")
    expect(isinstance(place, str), f"{student.said}: folder is {show(place)}, but text is needed.")
    place = os.path.normpath(place)
    if os.path.isabs(place):  # the same folder: the submission's own one is another each time
        place = place[place.rfind(os.sep + "trainings" + os.sep) + 1 :]
    expect(
        place != os.path.join("trainings", variant),
        f"{student.said}: the folder of a training of {variant!r} is {show(place)}, the folder of "
        "the whole variation, but that of the training itself is asked for: `str(run.path)`.",
    )
    expect(
        place.startswith(os.path.join("trainings", variant) + os.sep),
        f"{student.said}: the folder of a training of {variant!r} is {show(place)}, but should lie "
        f"in trainings/{variant}.",
    )
    for name in ("evaluations.npz", "config.yaml"):
        try:
            found = student.scratch(os.path.join(place, name))
        except Wrong:
            raise Wrong(
                f"{student.said}: the folder of a training of {variant!r} is {show(place)}, but "
                f"there is no {name} in it. `run.path` is the folder that a training has made."
            ) from None
        expect(size_of(found) < LARGEST, f"{student.said}: {name} in {show(place)} is too large.")
    return RunFolder(found.parent)


def size_of(file: Path) -> int:
    """Bytes of what a file holds, unpacked."""
    if not zipfile.is_zipfile(file):
        return file.stat().st_size
    with zipfile.ZipFile(file) as archive:
        return sum(member.file_size for member in archive.infolist())


def settings_of(rate: float | None) -> dict:
    """A variation's own settings; None for one that leaves the learning rate as it is."""
    return dict(SHORT) if rate is None else {**SHORT, "learning_rate": rate}


def expect_training(student: Student, record: dict, environment: str, variant: str, rate, index):
    """A record tells of a training with these settings, and of what it has reached."""
    run = evidence(student, record, variant)
    said = f"{student.said}: the training in {record['folder']}"
    try:
        settings, found = run.settings(), run.evaluations()
    except BotschoolError as error:
        raise Wrong(f"{said} cannot be read ({error}).") from None
    wanted = {
        "algo": "ppo", "env": environment, "seed": seed_of(index), "steps": STEPS,
        "episodes": EPISODES, "evaluations": EVALUATIONS, "params": settings_of(rate),
    }  # fmt: skip
    got = {key: settings.given if key == "params" else getattr(settings, key) for key in wanted}
    wrong = " and ".join(
        f"{key} {show(got[key], 200)} instead of {show(value, 200)}"
        for key, value in wanted.items()
        if got[key] != value
    )
    why = ""
    if isinstance(got["params"], dict) and wanted["params"].items() < got["params"].items():
        more = ", ".join(sorted(set(got["params"]) - set(wanted["params"])))
        why = f" This variation does not set {more}: only its own settings should be used."
    for key in ("episodes", "evaluations"):
        if got[key] != wanted[key]:
            why += f" `train` must be given {key}={key}."
    expect(not wrong, f"{said} has {wrong}.{why}")
    return found, said


def varied(student: Student, environment: str, rates: dict, seeds: list[int]) -> list:
    variations = {name: settings_of(rate) for name, rate in rates.items()}
    answer = student.call(
        "train_variations", environment, variations, [seed_of(index) for index in seeds], STEPS,
        "trainings", EVALUATIONS, EPISODES,
    )  # fmt: skip
    student.said = f"train_variations({environment!r}, ...)"
    count = len(rates) * len(seeds)
    expect(
        isinstance(answer, list) and len(answer) == count,
        f"{student.said} with {len(rates)} variation{'s' * (len(rates) > 1)} and "
        f"{len(seeds)} seed{'s' * (len(seeds) > 1)} should return a list of "
        f"{count} dict{'s' * (count > 1)}, not {show(answer)}.",
    )
    for record in answer:
        expect_fields(student.said, record, "variant", "seed", "return", "folder")
    return answer


def one_trained(student: Student, environment: str, variant: str, rate, index: int) -> tuple:
    """(record, post-evaluations, said) of a single training by the student."""
    (record,) = varied(student, environment, {variant: rate}, [index])
    return record, *expect_training(student, record, environment, variant, rate, index)


def expect_same_numbers(said: str, found, reference) -> None:
    """The post-evaluations are those of the grader's own training."""
    for name in ("steps", "returns", "lengths"):
        got, wanted = getattr(found, name), getattr(reference, name)
        same = got.shape == wanted.shape and np.allclose(got, wanted, rtol=1e-4, atol=1e-4)
        expect(
            same,
            f"{said} is not what PPO gives with these settings and this seed: the {name} of its "
            f"post-evaluations are {show(got, 120)}, but should be {show(wanted, 120)}.",
        )


def mistaken_return(returns: np.ndarray) -> dict:
    """What else a student may take for the mean return of the last post-evaluation."""
    means = returns.mean(axis=1)
    best = int(means.argmax())
    which = "the first and best" if best == 0 else "the best"
    mistakes = {
        f"This is the mean of {which} post-evaluation, but the last one is asked for.": means.max()
    }
    if best:
        mistakes[
            "This is the mean of the first post-evaluation, but the last one is asked for."
        ] = means[0]
    return mistakes | {
        "This is the mean of all post-evaluations, but the last one is asked for.": means.mean(),
        "This is the return of the last episode, but the mean of the last post-evaluation is asked "
        "for.": returns[-1, -1],
        "This is the return of the best episode, but the mean of the last post-evaluation is asked "
        "for.": returns.max(),
    }


@varying.check(6)
def one_training(student: Student):
    rate = rate_of(1)
    for index in itertools.count(200):  # until the last post-evaluation is not the best
        reference = training("Pendulum-v1", index, rate).evaluations()
        if reference.last < reference.returns.mean(axis=1).max():
            break
    record, found, said = one_trained(student, "Pendulum-v1", "only", rate, index)
    expect_same_numbers(said, found, reference)
    got, mistakes = record["return"], mistaken_return(reference.returns)
    expect_close(f"{student.said}: return", got, reference.last, CLOSE, mistakes)


@varying.check(10)
def every_variation_with_every_seed(student: Student):
    rates, seeds = {"varied": rate_of(3), "default": None}, [4, 5]
    reference = training("CartPole-v1", 5, rates["varied"]).evaluations()
    answer = varied(student, "CartPole-v1", rates, seeds)
    records = {(record["variant"], record["seed"]): record for record in answer}
    places = {record["folder"] for record in answer}
    expect(
        len(places) == len(answer),
        f"{student.said}: at least two dicts name the same folder, but each should have its own.",
    )
    for variant, index in itertools.product(rates, seeds):
        key = variant, seed_of(index)
        expect(
            key in records,
            f"{student.said}: a training of {key[0]!r} with seed {key[1]} is missing. The dicts "
            f"name the variants and seeds {show(list(records), 300)}.",
        )
        found, said = expect_training(
            student, records[key], "CartPole-v1", variant, rates[variant], index
        )
        if (variant, index) == ("varied", 5):
            expect_same_numbers(said, found, reference)
        got, mistakes = records[key]["return"], mistaken_return(found.returns)
        expect_close(f"{student.said}: return", got, found.last, CLOSE, mistakes)
    rate = rates["varied"]  # a later call finds the trainings of earlier ones there
    (record,) = varied(student, "CartPole-v1", {"varied": rate}, [6])
    expect_training(student, record, "CartPole-v1", "varied", rate, 6)


# ------------------------------------------------------------------- 14.2
reading = exercise.task("14.2", "What was logged")
NAMES = (
    "rollout/ep_rew_mean", "rollout/ep_len_mean", "train/loss", "train/value_loss",
    "train/policy_gradient_loss", "train/entropy_loss", "train/approx_kl", "train/clip_fraction",
    "train/explained_variance",
)  # fmt: skip


def event_file(entries: list[tuple[str, int, float]], histograms: bool = False) -> bytes:
    """A file as TensorBoard's, with (name, step, value) in this order."""
    from tensorboard.compat.proto.event_pb2 import Event
    from tensorboard.compat.proto.histogram_pb2 import HistogramProto
    from tensorboard.compat.proto.summary_pb2 import Summary
    from tensorboard.summary.writer.record_writer import RecordWriter

    content = io.BytesIO()
    writer = RecordWriter(content)
    writer.write(Event(wall_time=1.0, file_version="brain.Event:2").SerializeToString())
    values = [(step, Summary.Value(tag=name, simple_value=v)) for name, step, v in entries]
    if histograms:
        histogram = HistogramProto(
            min=0, max=2, num=3, sum=3, sum_squares=5, bucket_limit=[0, 1, 2], bucket=[1, 1, 1]
        )
        values += [(step, Summary.Value(tag="actions/chosen", histo=histogram)) for step in (5, 9)]
    for number, (step, value) in enumerate(values):
        event = Event(wall_time=2.0 + number, step=step, summary=Summary(value=[value]))
        writer.write(event.SerializeToString())
    return content.getvalue()


def drawn_log(index: int, names: tuple[str, ...], most: int = 30) -> dict[str, tuple]:
    """Indicators of random lengths, rounded as the files hold them: name -> (steps, values)."""
    rng, log = generator(index), {}
    for name in names:
        steps = np.cumsum(rng.integers(1, 500, rng.integers(2, most)))
        steps[1] = steps[0]  # a step may be logged twice
        log[name] = steps, rng.normal(size=len(steps)).astype(np.float32).astype(np.float64)
    return log


def read(student: Student, content: bytes) -> dict:
    files = {"training/events.out.tfevents.1.grader": as_bytes(content)}
    said = "read_indicators('training')"
    answer = student.run(with_files, "read_indicators", files, "training", said=said)
    expect(isinstance(answer, dict), f"{said} should return a dict, not {show(answer)}.")
    return answer


def compare_log(said: str, answer: dict, wanted: dict[str, tuple]) -> None:
    missing, more = sorted(set(wanted) - set(answer)), sorted(set(answer) - set(wanted))
    expect(
        not missing,
        f"{said} leaves out {missing}, but all indicators that are single numbers are asked for.",
    )
    expect(
        not more,
        f"{said} has {more}, but only the indicators that are single numbers are asked for.",
    )
    for name, columns in wanted.items():
        got = expect_fields(f"{said}: {name!r}", answer[name], "steps", "values")
        for key, value, right in zip(("steps", "values"), got, columns, strict=True):
            expect_close(f"{said}[{name!r}]: {key}", value, right, CLOSE)


def entries_of(log: dict[str, tuple]) -> list[tuple[str, int, float]]:
    """All values, one after another as they are logged."""
    entries = [
        (name, int(step), float(value))
        for name, columns in log.items()
        for step, value in zip(*columns, strict=True)
    ]
    return sorted(entries, key=lambda entry: entry[1])


@reading.check(5)
def all_indicators(student: Student):
    for index, count in ((20, 2), (21, len(NAMES))):
        log = drawn_log(index, NAMES[-count:])
        answer = read(student, event_file(entries_of(log), histograms=index == 21))
        compare_log(student.said, answer, log)


@reading.check(3)
def a_long_log(student: Student):
    rng = generator(22)
    values = rng.normal(size=10_400).astype(np.float32).astype(np.float64)
    log = {"train/approx_kl": (8 * np.arange(1, len(values) + 1), values)}
    answer, said = read(student, event_file(entries_of(log))), "read_indicators(<10400 values>)"
    name = "train/approx_kl"
    expect(name in answer, f"{said}: {name!r} is missing.")
    (kept,) = expect_fields(f"{said}: {name!r}", answer[name], "steps")
    expect(
        np.size(kept) != 10_000,
        f"{said} has 10000 of 10400 values, but should have all: see size_guidance.",
    )
    compare_log(said, answer, log)


@reading.check(3)
def without_nan(student: Student):
    for index, place in ((23, 3), (24, 20)):
        compare_without_nan(student, index, place)
    kept_infinite(student, 57)
    stays_empty(student)


def stays_empty(student: Student) -> None:
    """An indicator that holds nothing but NaN keeps its name."""
    name, nan = "train/explained_variance", float("nan")
    answer = read(student, event_file([("train/loss", 5, 0.5), (name, 5, nan), (name, 9, nan)]))
    expect(
        name in answer,
        f"{student.said}: {name!r} is missing. It holds only NaN, but should stay, with two empty "
        "arrays.",
    )
    for key, kept in zip(
        ("steps", "values"),
        expect_fields(student.said, answer[name], "steps", "values"),
        strict=True,
    ):
        expect(
            np.size(kept) == 0,
            f"{student.said}[{name!r}]: {key} is {show(kept)}, but should be empty, since only NaN "
            "was logged.",
        )


def compare_without_nan(student: Student, index: int, place: int) -> None:
    log = drawn_log(index, NAMES)
    entries = entries_of(log)
    entries.insert(place, ("train/explained_variance", entries[place][1], float("nan")))
    entries.append(("train/explained_variance", 20_000, float("nan")))
    entries.append(("train/loss", 20_000, 0.5))  # a number at the same step
    log["train/loss"] = tuple(map(np.append, log["train/loss"], (20_000, 0.5)))
    answer, name = read(student, event_file(entries)), "train/explained_variance"
    expect(
        name in answer, f"{student.said}: {name!r} is missing. Only its two NaN should be left out."
    )
    for key, kept in zip(
        ("steps", "values"),
        expect_fields(f"{student.said}: {name!r}", answer[name], "steps", "values"),
        strict=True,
    ):
        expect(
            np.size(kept) != len(log[name][0]) + 2,
            f"{student.said}[{name!r}]: {key} has {np.size(kept)} entries, but the two whose "
            "value is NaN should be left out, both in steps and in values.",
        )
    for other, (steps, _) in log.items():
        (got,) = expect_fields(f"{student.said}: {other!r}", answer.get(other), "steps")
        expect(
            other == name or not np.array_equal(got, steps[steps != 20_000]) or 20_000 not in steps,
            f"{student.said}[{other!r}]: the entry of step 20000 is missing, but its value is "
            f"a number. NaN at this step is the value of {name!r} only.",
        )
    compare_log(student.said, answer, log)


def kept_infinite(student: Student, index: int) -> None:
    """A loss may become infinite: such values are kept."""
    log = drawn_log(index, NAMES[2:4])
    for (_, values), infinite in zip(log.values(), (float("inf"), -float("inf")), strict=True):
        values[1] = infinite
    answer = read(student, event_file(entries_of(log)))
    for name, (_, values) in log.items():
        (got,) = expect_fields(f"{student.said}: {name!r}", answer.get(name), "values")
        expect(
            np.size(got) == len(values) and np.isinf(np.ravel(got)[1]),
            f"{student.said}[{name!r}]: there should be {len(values)} values, and the second one "
            f"should be {values[1]:g}, since only NaN should be left out.",
        )


@reading.check(3)
def a_training(student: Student):
    run = training("CartPole-v1", 5, rate_of(3))
    (file,) = run.path.glob("events.out.tfevents.*")
    answer = read(student, file.read_bytes())
    log, wanted = run.log(), {}
    for name in NAMES:
        known = np.isfinite(log[name])
        wanted[name] = log["steps"][known], log[name][known]
    compare_log(student.said, {name: answer[name] for name in wanted if name in answer}, wanted)


# ------------------------------------------------------------------- 14.3
success = exercise.task("14.3", "How successful was it?")


def drawn_evaluations(index: int, means: list[float] | None = None) -> tuple:
    """Post-evaluations at uneven steps: steps (n,), returns (n, episodes)."""
    rng = generator(index)
    means = rng.uniform(0, 200, rng.integers(4, 12)) if means is None else np.array(means)
    noise = rng.normal(size=(len(means), 5))
    steps = np.cumsum(rng.integers(200, 3000, len(means))) - 200
    return steps, means[:, None] + 10 * (noise - noise.mean(axis=1, keepdims=True))


def measured(student: Student, steps, returns, goal: float, *keys: str) -> list:
    answer = student.call("success_of", steps, returns, goal)
    if len(steps) <= 6:
        means = returns.mean(axis=1).round(2).tolist()
        student.said = f"success_of({steps.tolist()}, <mean returns {means}>, {goal})"
    return expect_fields(student.said, answer, *keys)


@success.check(3)
def last_and_best(student: Student):
    below = [-1200.0, -300.0, -650.0, -400.0]  # as in Pendulum, where all returns are negative
    rising = [-80.0, 20.0, 10.0, 150.0]
    for index, means in ((30, None), (31, None), (32, None), (37, below), (44, rising)):
        steps, returns = drawn_evaluations(index, means)
        last, best = measured(student, steps, returns, 100.0, "last", "best")
        mistakes = {
            "This is the mean of the last column, but that of the last row is asked for: a row of "
            "returns is a post-evaluation.": np.mean(returns[:, -1]),
            "This is a single return, but the mean of the last row is asked for.": returns[-1, -1],
        }
        expect_close(f"{student.said}: last", last, returns[-1].mean(), CLOSE, mistakes)
        wanted = max(row.mean() for row in returns)
        mistakes = {
            "This is the return of the best episode, but the best mean is asked for.": returns.max()
        }
        expect_close(f"{student.said}: best", best, wanted, CLOSE, mistakes)


@success.check(4)
def average_over_the_training(student: Student):
    for index, means in ((33, None), (34, [10.0, 20.0]), (35, None), (36, [42.5]), (38, [7.25])):
        steps, returns = drawn_evaluations(index, means)
        (average,) = measured(student, steps, returns, 100.0, "average")
        m, area = [float(row.mean()) for row in returns], 0.0
        for i in range(1, len(m)):
            area += (m[i - 1] + m[i]) / 2 * (steps[i] - steps[i - 1])
        wanted = area / (steps[-1] - steps[0]) if len(m) > 1 else m[0]
        mistakes = {
            "This is the plain mean, but the post-evaluations are unequally far apart.": np.mean(m)
        }
        expect_close(f"{student.said}: average", average, wanted, CLOSE, mistakes)


def expect_solved(
    student: Student, index: int, means: list[float], position: int | None, at_first: bool = False
) -> None:
    """at_first: whether the first post-evaluation is that before the training, at step 0."""
    steps, returns = drawn_evaluations(index, means)
    steps = steps - steps[0] if at_first else steps
    (solved,) = measured(student, steps, returns, 100.0, "solved")
    wanted = None if position is None else int(steps[position])
    said = f"{student.said}: solved"
    if wanted is None:
        expect(solved is None, f"{said} is {show(solved)}, but None was expected.")
    else:
        expect(solved is not None, f"{said} is None, but {wanted} was expected.")
        expect_close(said, solved, wanted, CLOSE)


@success.check(4)
def solved_for_good(student: Student):
    expect_solved(student, 37, [5.0, 50.0, 110.0, 120.0, 180.0], 2)
    expect_solved(student, 38, [5.0, 130.0, 60.0, 101.0, 150.0], 3)
    expect_solved(student, 39, [120.0, 110.0, 150.0], 0)
    expect_solved(student, 45, [130.0, 140.0], 0)
    expect_solved(student, 46, [130.0, 120.0, 140.0], 0, at_first=True)
    expect_solved(student, 47, [130.0, 140.0], 0, at_first=True)
    expect_solved(student, 40, [5.0, 130.0, 140.0, 99.0], None)
    expect_solved(student, 41, [5.0, 50.0, 60.0, 100.5], 3)
    expect_solved(student, 42, [5.0, 60.0, 98.0, 120.0], 3)
    expect_solved(student, 43, [20.0, 97.0, 130.0], 2)


@success.check(1)
def the_goal_itself_is_enough(student: Student):
    steps = np.array([100, 250, 300, 700])
    returns = np.array([[90.0, 80.0], [100.0, 100.0], [75.0, 125.0], [110.0, 100.0]])
    (solved,) = measured(student, steps, returns, 100.0, "solved")
    expect(solved is not None, f"{student.said}: solved is None, but 250 was expected.")
    mistakes = {"A mean return that equals the goal should count as reaching it, too.": 700}
    expect_close(f"{student.said}: solved", solved, 250, CLOSE, mistakes)


# ------------------------------------------------------------------- 14.4
table = exercise.task("14.4", "The table")


def drawn_runs(index: int, sizes: dict[str, int]) -> list[dict]:
    rng = generator(index)
    runs = [
        {"variant": name, "seed": 10 + seed, "return": round(float(rng.normal(100, 60)), 2)}
        for name, size in sizes.items()
        for seed in range(size)
    ]
    return [runs[i] for i in rng.permutation(len(runs))]


def between(index: int, sizes: dict[str, int]) -> list[dict]:
    """Runs of three variations; the default is neither the best nor the worst of them."""
    for number in itertools.count(100 * index):
        runs = drawn_runs(number, sizes)
        own = {name: [r["return"] for r in runs if r["variant"] == name] for name in sizes}
        if sorted(own, key=lambda name: np.mean(own[name]))[1] == "default":
            return runs
    raise AssertionError


def mistaken_deviation(values: np.ndarray) -> dict:
    """What mistakes make of the deviation of more than one value."""
    sample = values.std(ddof=1)
    return {
        "This deviation divides by n, but it should divide by n - 1 (ddof=1).": values.std(),
        "This is the variance, but its square root is asked for.": sample**2,
        "This variance divides by n, but the root of the one with n - 1 is asked for.": (
            values.var()
        ),
        "This is the standard error of the mean, but the standard deviation is asked for.": (
            sample / np.sqrt(len(values))
        ),
        "This is the highest return minus the lowest, but the deviation is asked for.": np.ptp(
            values
        ),
    }


def mistaken_gain(name: str, means: dict, baseline: str) -> dict:
    """What mistakes make of the gain."""
    every = [float(mean) for mean in means.values()]
    return slips(
        lambda base, apart: apart(float(means[name]), base),
        base={
            "": float(means[baseline]),
            "The gain is over the best variation, but should be over the baseline.": max(every),
            "The gain is over the worst variation, but should be over the baseline.": min(every),
            "The gain is over the first variation, but should be over the baseline.": every[0],
            "The gain is over the mean of all, but should be over the baseline.": np.mean(
                every
            ),
        },
        apart={
            "": lambda mean, base: mean - base,
            "The gain has the wrong sign: that of the baseline should be subtracted from the mean.":
            lambda mean, base: base - mean,
            "The gain is a share, but a difference of means is asked for.":
            lambda mean, base: (mean - base) / base,
            "The gain is a percentage, but a difference of means is asked for.":
            lambda mean, base: 100 * (mean - base) / base,
            "The gain is a quotient of means, but their difference is asked for.":
            lambda mean, base: mean / base,
            "The gain has no sign, but it should be negative if a variation is worse.":
            lambda mean, base: abs(mean - base),
        },
    )  # fmt: skip


def compare_table(student: Student, runs: list[dict], baseline: str, *keys: str) -> None:
    """Compares the rows in their order; what counts is the first run of a variant and seed."""
    results: dict[str, dict] = {}
    for run in runs:
        if run["seed"] not in results.setdefault(run["variant"], {}):
            results[run["variant"]][run["seed"]] = Fraction(run["return"])
    means = {name: sum(found.values()) / len(found) for name, found in results.items()}
    all_runs = Counter(run["variant"] for run in runs)
    order = sorted(means, key=lambda name: -means[name])
    answer = student.call("table_of", runs, baseline)
    student.said = f"table_of(<{len(runs)} runs>, {baseline!r})"
    expect(isinstance(answer, list), f"{student.said} should return a list, not {show(answer)}.")
    got = [expect_fields(student.said, row, "variant")[0] for row in answer]
    expect(got == order, f"{student.said} has the rows {show(got, 150)}, but should have {order}.")
    for row, name in zip(answer, order, strict=True):
        values = np.array([float(value) for value in results[name].values()])
        wanted = {
            "runs": len(values),
            "mean": float(means[name]),
            "deviation": np.std(values) * np.sqrt(len(values) / max(1, len(values) - 1)),
            "gain": float(means[name] - means[baseline]),
        }
        said = f"{student.said}: row {name!r}"
        for key, value in zip(keys, expect_fields(said, row, *keys), strict=True):
            if key == "deviation" and len(values) == 1:
                sentence = f"{said}: deviation of a single run is {show(value)} instead of None."
                expect(value is None, sentence)
            else:
                mistakes = {
                    "Several runs with the same variant and seed should count as one.": all_runs[
                        name
                    ]
                }
                if key == "deviation":
                    mistakes = mistaken_deviation(values)
                if key == "gain":
                    mistakes = mistaken_gain(name, means, baseline)
                expect_close(f"{said}: {key}", value, wanted[key], CLOSE, mistakes)


@table.check(5)
def means_in_order(student: Student):
    for index, sizes in ((50, {"default": 4, "fast": 4}), (51, {"a": 3, "b": 5, "c": 2, "d": 7})):
        compare_table(student, drawn_runs(index, sizes), next(iter(sizes)), "runs", "mean")


@table.check(4)
def deviations_and_gains(student: Student):
    runs = drawn_runs(52, {"fast": 4, "default": 5})
    compare_table(student, runs, "default", "deviation", "gain")
    runs = between(53, {"b": 2, "default": 3, "a": 6})
    compare_table(student, runs, "default", "deviation", "gain")
    for index, sizes in ((54, {"b": 3, "default": 1}), (58, {"b": 1, "default": 4})):
        compare_table(student, drawn_runs(index, sizes), "default", "deviation", "gain")
    for size, result in ((3, 500.0), (4, -25.0)):
        alike = [{**run, "return": result} for run in drawn_runs(56, {"default": size})]
        compare_table(student, alike, "default", "deviation", "gain")


@table.check(3)
def a_seed_counts_once(student: Student):
    for index, sizes in ((55, {"default": 4, "slow": 3}), (57, {"default": 2, "slow": 3})):
        runs = drawn_runs(index, sizes)
        again = [
            {**run, "return": run["return"] + (50, -70)[number % 2]}
            for number, run in enumerate(runs[1:5])
        ]
        compare_table(student, runs + again, "default", "runs", "mean", "deviation", "gain")


# ------------------------------------------------------------------- 14.5
luck = exercise.task("14.5", "Is it more than luck?")


def compare_chance(student: Student, first: list[float], second: list[float]) -> None:
    """Exact, with fractions, so that equal differences are equal."""
    numbers = [Fraction(str(value)) for value in (*first, *second)]
    n, m, total = len(first), len(second), sum(numbers)
    observed = abs(sum(numbers[:n]) / n - sum(numbers[n:]) / m)
    ways = [sum(chosen) for chosen in itertools.combinations(numbers, n)]
    apart = [part / n - (total - part) / m for part in ways]
    hits = sum(abs(each) >= observed for each in apart)
    mistakes = {
        "Ways whose difference equals the real one should count, too.": sum(
            abs(each) > observed for each in apart
        ) / len(ways),
        "Only differences in one direction are counted, but both should count.": sum(
            each >= observed for each in apart
        ) / len(ways),
        "Differences in one direction only are counted, but both should count.": sum(
            -each >= observed for each in apart
        ) / len(ways),
        "The way in which it really was should count, too.": (hits - 1) / len(ways),
    }  # fmt: skip
    answer = student.call("chance_of", first, second)
    student.said = f"chance_of({first}, {second})"
    share = expect_array(student.said, answer, ())
    right = bool(np.isclose(share, hits / len(ways), CLOSE, CLOSE))
    whole = share * len(ways)
    expect(
        right or bool(np.abs(whole - np.round(whole)) < 1e-6),
        f"{student.said} returned {show(answer)}, but {hits} / {len(ways)} was expected. There are "
        f"{len(ways)} ways, and each should count once, so the answer should be a multiple of "
        f"1 / {len(ways)}.",
    )
    expect_close(student.said, answer, hits / len(ways), CLOSE, mistakes)


@luck.check(4)
def equally_many(student: Student):
    for index, n in ((60, 2), (61, 3), (62, 5)):
        rng = generator(index)
        compare_chance(student, rng.normal(90, 9, n).round(2).tolist(),
                       rng.normal(100, 9, n).round(2).tolist())  # fmt: skip


@luck.check(3)
def more_of_one(student: Student):
    for index, n, m in ((63, 2, 6), (64, 5, 3), (65, 1, 4), (67, 4, 2), (68, 5, 2), (69, 6, 4)):
        rng = generator(index)
        compare_chance(student, rng.normal(110, 20, n).round(2).tolist(),
                       rng.normal(100, 9, m).round(2).tolist())  # fmt: skip


@luck.check(3)
def with_equal_results(student: Student):
    compare_chance(student, [500.0, 500.0, 500.0], [500.0, 500.0, 500.0])
    compare_chance(student, [0.1, 0.2, 0.3], [0.3, 0.6, 0.2])
    rng = generator(66)
    compare_chance(student, (rng.integers(0, 4, 4) / 10).tolist(),
                   (rng.integers(1, 6, 4) / 10).tolist())  # fmt: skip


# ------------------------------------------------------------------- 14.6
signs = exercise.task("14.6", "Warning signs")


def compare_phases(student: Student, steps, values, total: int, parts: int) -> None:

    def inside(part: int) -> list[int]:
        low, high = Fraction(part * total, parts), Fraction((part + 1) * total, parts)
        return [i for i, s in enumerate(steps.tolist()) if low < s <= high or s == part == 0]

    wanted = []
    for part in range(parts):
        these = [float(value) for value in values[inside(part)] if not np.isnan(value)]
        wanted.append(sum(these) / len(these) if these else None)
    answer = student.call("phase_means", steps, values, total, parts)
    if len(steps) <= 6:
        shown = f"{steps.tolist()}, {values.round(3).tolist()}, {total}, {parts}"
        student.said = f"phase_means({shown})"
    count = isinstance(answer, (list, np.ndarray)) and len(answer) == parts
    expect(count, f"{student.said} should return a list of {parts} means, not {show(answer)}.")
    for part, (got, right) in enumerate(zip(answer, wanted, strict=True)):
        said = f"{student.said}: part {part}"
        if right is None:
            only = "nothing but NaN" if np.isnan(values[inside(part)]).any() else "nothing"
            expect(got is None, f"{said} holds {only}, so it should be None, but is {show(got)}.")
        else:
            expect_close(said, got, right, CLOSE)


@signs.check(3)
def parts_of_a_training(student: Student):
    for index, parts in ((70, 3), (71, 3), (72, 4)):
        rng, total = generator(index), 6000
        steps = np.sort(rng.choice(np.arange(1, total), 60, replace=False))
        compare_phases(student, steps, rng.normal(size=60), total, parts)
    rng = generator(73)  # logged more often in the end
    steps = np.concatenate([np.arange(100, 6000, 700), np.arange(6000, 9001, 50)])
    compare_phases(student, steps, rng.normal(size=len(steps)), 9000, 3)


@signs.check(3)
def borders_gaps_and_nan(student: Student):
    rng = generator(74)
    compare_phases(student, np.array([0, 100, 200, 300]), rng.normal(size=4), 300, 3)
    compare_phases(student, np.array([0, 40, 50, 100]), generator(65).normal(size=4), 100, 2)
    compare_phases(student, np.array([80, 290]), rng.normal(size=2), 300, 3)
    compare_phases(student, np.array([142, 143, 285, 286, 999, 1000]), rng.normal(size=6), 1000, 7)
    compare_phases(student, np.array([33, 34, 66, 67, 100]), generator(64).normal(size=5), 100, 3)
    values = rng.normal(size=12)
    values[[0, 5]] = np.nan
    compare_phases(student, np.arange(50, 650, 50), values, 600, 4)
    values[3:6] = np.nan
    compare_phases(student, np.arange(50, 650, 50), values, 600, 4)


def expect_signs(student: Student, index: int, names: tuple[str, ...], missing: int = 0) -> None:
    """Logs whose first third, and whose mean, say other things; limits on both sides of the end."""
    rng, total = generator(index), 3000
    indicators, chosen, wanted = {}, {}, []
    for number, name in enumerate(names):
        late = round(float(rng.normal()), 3)
        steps = np.arange(100, total + 1, 100)
        first, second = ((30, -60), (-90, 30))[number % 2]  # the mean is like one of them
        early = np.where(steps > 1000, second, first) * np.sign(rng.normal())
        values = np.where(steps > 2000, late, early)
        values = values + np.where(steps % 200 == 0, 0.25, -0.25)
        values += rng.normal(0, 1, len(steps)) * (steps <= 2000)
        indicators[name] = {"steps": steps, "values": values}
        side, shift = ("above", "below")[rng.integers(2)], (0.2, -0.2)[rng.integers(2)]
        sign = f"sign {(5 * number + 3) % 11}"  # in another order than that of the names
        chosen[sign] = (name, side, round(late + shift, 3))
        if (side == "above") == (shift < 0) and number >= missing:
            wanted.append(sign)
    for number, name in enumerate(names[:missing]):
        if number % 2:
            del indicators[name]
        else:
            early = indicators[name]["steps"] <= 2000
            indicators[name] = {key: array[early] for key, array in indicators[name].items()}
    answer = student.call("warning_signs", indicators, total, chosen)
    student.said = f"warning_signs(<{len(names)} indicators>, {total}, {chosen})"
    expect(answer == wanted, f"{student.said} returned {show(answer, 200)} instead of {wanted}.")


@signs.check(1)
def limits_give_no_sign(student: Student):
    """Means that equal the limit, and entries at the very border of the last third."""
    for level in (int(generator(79).integers(-8, 9)) / 4, 0.0):
        expect_no_sign_at_limits(student, level)


def expect_no_sign_at_limits(student: Student, level: float) -> None:
    steps = np.arange(100, 3001, 100)
    flat = {"steps": steps, "values": np.full(30, level)}
    early = {"steps": steps[:20], "values": np.full(20, level)}
    moving = {"steps": steps, "values": level + np.where(np.arange(30) % 2, 0.25, -0.25)}
    indicators = {"train/flat": flat, "train/early": early, "train/moving": moving}
    chosen = {
        f"{name} {side} {limit}": (f"train/{name}", side, limit)
        for name in ("flat", "early", "moving")
        for side in ("above", "below")
        for limit in (level - 0.5, level, level + 0.5)
    }
    wanted = [
        name
        for name, (indicator, side, limit) in chosen.items()
        if indicator != "train/early" and (limit < level if side == "above" else limit > level)
    ]
    answer = student.call("warning_signs", indicators, 3000, chosen)
    student.said = f"warning_signs(<indicators that are {level} on average>, 3000, <18 signs>)"
    expect(isinstance(answer, list), f"{student.said} should return a list, not {show(answer)}.")
    for name, (_, side, limit) in chosen.items():
        why = "."
        if name.startswith("early"):
            why = (
                ", although its indicator was not logged in the last third: step 2000 of 3000 is "
                "in the second."
            )
        elif limit == level:
            why = ", although the mean of the last third equals the limit."
        elif level == 0:
            why = ". The mean of the last third is 0, a number like any other."
        elif name not in answer:
            others = [other for other in answer if other.split()[0] == name.split()[0]]
            why = (
                f", but names another one of the same indicator: {others[0]!r}." if others else "."
            )
        expect(
            (name in answer) == (name in wanted),
            f"{student.said} {'names' if name in answer else 'leaves out'} a sign {side} {limit}"
            f"{why}",
        )
    once = len(answer) == len(wanted)
    expect(
        once, f"{student.said} has {len(answer)} entries, but {len(wanted)} signs were expected."
    )
    expect(answer == wanted, f"{student.said} should give the signs in the order of `signs`.")


@signs.check(3)
def signs_of_the_last_third(student: Student):
    for index in (75, 76):
        expect_signs(student, index, NAMES)


@signs.check(2)
def nothing_logged_no_sign(student: Student):
    for index in (77, 78):
        expect_signs(student, index, NAMES, missing=4)


# ------------------------------------------------------------------- 14.7
relating = exercise.task("14.7", "Which indicators go with success?")


def ranks(numbers: np.ndarray) -> np.ndarray:
    order = np.sort(numbers)
    return np.array([np.flatnonzero(order == number).mean() for number in numbers])


EQUAL = "Equal numbers should share the mean of their ranks, but here they have other ranks."


def unshared(first: np.ndarray, second: np.ndarray, answer: object) -> float:
    """The correlation by another rule for the ranks of equal numbers: the one that fits, if any."""

    def highest(numbers: np.ndarray) -> np.ndarray:
        return (numbers[:, None] >= numbers).sum(axis=1)

    rules = [
        lambda numbers: np.argsort(np.argsort(numbers, kind="stable")),
        lambda numbers: np.argsort(np.argsort(numbers)),
        lambda numbers: -np.argsort(np.argsort(-numbers, kind="stable")),
        lambda numbers: -np.argsort(np.argsort(-numbers)),
        lambda numbers: -highest(-numbers),  # the lowest of their ranks
        highest,
        lambda numbers: np.unique(numbers, return_inverse=True)[1],  # no gap after equal ones
    ]
    made = [np.corrcoef(rule(first), rule(second))[0, 1] for rule in rules]
    near = np.isclose(made, answer) if isinstance(answer, float) else np.zeros(len(made), bool)
    return made[int(near.argmax())]


def compare_ranks(student: Student, first: np.ndarray, second: np.ndarray) -> None:
    alike = len(set(first.tolist())) == 1 or len(set(second.tolist())) == 1
    wanted = 0.0 if alike else np.corrcoef(ranks(first), ranks(second))[0, 1]
    answer = student.call("rank_correlation", first, second)
    if len(first) <= 8:
        student.said = f"rank_correlation({first.tolist()}, {second.tolist()})"
    mistakes = {}
    if not alike:
        orders = [np.argsort(each, kind="stable") for each in (first, second)]
        mistakes = {
            "The numbers themselves are correlated, but their ranks should be.": np.corrcoef(
                first, second
            )[0, 1],
            EQUAL: unshared(first, second, answer),
            "Positions of the sorted numbers (np.argsort) are correlated, but ranks should be.": (
                np.corrcoef(*orders)[0, 1]
            ),
        }
    expect_close(student.said, answer, wanted, CLOSE, mistakes)


@relating.check(4)
def correlates_the_ranks(student: Student):
    for index, n in ((80, 5), (81, 12), (82, 40)):
        rng = generator(index)
        first = rng.normal(size=n).round(3)
        compare_ranks(student, first, np.exp(3 * (first + rng.normal(size=n))).round(6))


@relating.check(4)
def equal_numbers(student: Student):
    rng = generator(83)
    compare_ranks(student, np.array([5.0, 7.0, 7.0, 9.0]), rng.normal(size=4).round(2))
    for n in (8, 25):
        compare_ranks(student, rng.integers(0, 4, n) / 2, rng.integers(0, 3, n) + 0.5)
    compare_ranks(student, np.full(6, 500.0), rng.normal(size=6).round(2))
    compare_ranks(student, rng.normal(size=6).round(2), np.full(6, -0.7))


def mistaken_within(numbers: np.ndarray, which: np.ndarray) -> dict:
    """What mistakes make of the numbers minus the means of their variants; which: their kinds."""
    kinds = np.unique(which)
    right = {kind: numbers[which == kind].mean() for kind in kinds}
    own, many = np.array([right[kind] for kind in which]), len(numbers)
    spread = {kind: np.ptp(numbers[which == kind]) > 1e-9 for kind in kinds}

    def over(size) -> np.ndarray:
        by = [size(numbers[which == k]) if spread[k] else 1.0 for k in which]
        return (numbers - own) / np.array(by)

    return {
        "The mean of all trainings is subtracted, but that of the variant should be.": numbers
        - numbers.mean(),
        "The numbers are also divided by the standard deviation of the variant, but only its mean "
        "should be subtracted.": over(np.std),
        "The numbers are also divided by the standard deviation (n - 1) of the variant, but only "
        "its mean should be subtracted.": over(lambda own: np.std(own, ddof=1)),
        "The numbers are also divided by the range of the variant, but only its mean should be "
        "subtracted.": over(np.ptp),
        "The numbers are divided by the mean of the variant, but it should be subtracted.": numbers
        / own,
        "The difference is divided by the mean of the variant, but should stay as it is.": numbers
        / own
        - 1,
        "The median of the variant is subtracted, but its mean should be.": numbers
        - np.array([np.median(numbers[which == kind]) for kind in which]),
        "The sign is wrong: the mean should be subtracted from each number.": own - numbers,
        "The mean of all numbers is added, but nothing should be added.": numbers
        - own
        + numbers.mean(),
        "The sum over the variant is divided by the number of all trainings, but should be "
        "divided by the number of its own.": numbers
        - np.array([numbers[which == kind].sum() / many for kind in which]),
        "The mean of the means of all variants is subtracted, but that of the own variant should "
        "be.": numbers - np.mean(list(right.values())),
    }


@relating.check(4)
def inside_variants(student: Student):
    for index, kinds in ((84, 2), (85, 4)):
        rng = generator(index)
        which = rng.permutation(np.repeat(np.arange(kinds), rng.integers(2, 6, kinds)))
        numbers = rng.normal(size=len(which)) + 100 * which
        numbers[which == 0] = 0.1 + 0.7  # equal ones stay equal
        wanted = numbers.copy()
        for kind in range(kinds):
            wanted[which == kind] -= numbers[which == kind].mean()
        names = [f"variant {kind}" for kind in which]
        answer = student.call("within_variants", numbers, names)
        got = expect_array(student.said, answer, numbers.shape)
        mistakes = partial(mistaken_within, numbers, which)
        expect_close(student.said, got, wanted, CLOSE, mistakes)
        expect(
            len(set(got[which == 0].tolist())) == 1 and np.array_equal(got, np.round(got, 9)),
            f"{student.said} should be rounded to 9 decimals, so that equal numbers stay equal.",
        )


# ------------------------------------------------------------------- 14.8
equal = exercise.task("14.8", "Evolution and PPO at equal steps")


def saved(*arrays: np.ndarray, **named: np.ndarray) -> np.ndarray:
    """The bytes of a .npy file, or of an .npz file with names."""
    content = io.BytesIO()
    np.savez(content, **named) if named else np.save(content, *arrays)
    return as_bytes(content.getvalue())


def expect_curve(student: Student, files: dict, place: str, wanted: dict) -> None:
    said = f"curve_of({place!r})"
    answer = student.run(with_files, "curve_of", files, place, said=said)
    for key, got in zip(wanted, expect_fields(said, answer, *wanted), strict=True):
        expect_close(f"{said}: {key}", got, wanted[key], CLOSE)


@equal.check(3)
def curve_of_evolution(student: Student):
    rng = generator(90)
    for number in (3, 14):
        n = int(rng.integers(5, 30))
        stat = rng.normal(size=(n, 6))
        stat[:, 0] = np.cumsum(rng.integers(100, 900, n))
        stat[:, 1], stat[:, 2] = np.sort(rng.normal(size=n)) + 5, np.sort(rng.normal(size=n))
        place = f"evolved/statS{number}.npy"
        wanted = {"steps": stat[:, 0], "best": stat[:, 2]}
        expect_curve(student, {place: saved(stat.ravel())}, place, wanted)


@equal.check(4)
def curve_of_a_training(student: Student):
    rng = generator(91)
    for number in (1, 2):
        n, episodes = int(rng.integers(4, 15)), int(rng.integers(2, 8))
        steps = np.cumsum(rng.integers(100, 900, n))
        returns, lengths = rng.normal(size=(n, episodes)), rng.integers(5, 90, (n, episodes))
        returns -= 9 * (number == 2)  # all returns may be negative
        place = f"trained/CartPole-v1_{number}"
        content = saved(timesteps=steps, results=returns, ep_lengths=lengths)
        best = [max(row.mean() for row in returns[: i + 1]) for i in range(n)]
        spent = [steps[i] + lengths[: i + 1].sum() for i in range(n)]
        wanted = {"steps": np.array(spent), "best": np.array(best)}
        expect_curve(student, {f"{place}/evaluations.npz": content}, place, wanted)


def mistaken_steps(curves: list[dict], points: int) -> dict:
    """What mistakes make of the steps at which curves are compared."""
    first, last = (np.array([curve["steps"][i] for curve in curves]) for i in (0, -1))
    return slips(
        lambda start, end, spaced: spaced(start, end),
        start={
            "": first.max(),
            "The steps begin at the smallest first step of a run, but should begin at the largest.":
            first.min(),
            "The steps begin at 0, but should begin at the largest first step of a run.":
            0.0,
            "The steps begin at the mean of the runs' first steps, but should at the largest.":
            first.mean(),
            "The steps begin with the list's first run, but should with the one that begins last.":
            first[0],
        },
        end={
            "": last.min(),
            "The steps end at the largest last step of a run, but should end at the smallest.":
            last.max(),
            "The steps end at the mean of the runs' last steps, but should at the smallest.":
            last.mean(),
            "The steps end with the list's first run, but should with the one that ends first.":
            last[0],
            "The steps end with the list's last run, but should with the one that ends first.":
            last[-1],
        },
        spaced={
            "": lambda start, end: np.linspace(start, end, points),
            "The end itself is left out, but should be the last step.":
            lambda start, end: np.linspace(start, end, points, endpoint=False),
            "The beginning itself is left out, but should be the first step.":
            lambda start, end: np.linspace(start, end, points + 1)[1:],
            "The logarithms of the steps are evenly spaced, but the steps themselves should be.":
            lambda start, end: np.geomspace(max(start, 1e-9), end, points),
            "The steps are rounded to whole numbers, but should keep their fractions.":
            lambda start, end: np.round(np.linspace(start, end, points)),
            "The steps are cut to whole numbers, but should keep their fractions.":
            lambda start, end: np.floor(np.linspace(start, end, points)),
        },
    )  # fmt: skip


def mistaken_values(group: list[dict], marks: np.ndarray) -> dict:
    """What mistakes make of the values of a group's runs at these steps."""
    read = {
        "Straight lines are drawn from value to value, but the last one at or before each step is "
        "asked for.": lambda steps, best, _: np.interp(marks, steps, best),
        "The next value after each step is taken, but the last one at or before it is asked "
        "for.": lambda steps, best, at: best[np.minimum(at + 1, len(best) - 1)],
        "The value before the last one is taken, but the last one at or before each step is asked "
        "for.": lambda steps, best, at: best[np.maximum(at - 1, 0)],
        "The value nearest to each step is taken, but the last one at or before it is asked "
        "for.": lambda steps, best, _: best[np.abs(marks[:, None] - steps).argmin(axis=1)],
        "The last value of the run is taken everywhere, but the last one at or before each step is "
        "asked for.": lambda steps, best, at: best[0 * at - 1],
    }
    found = {}
    for text, value in read.items():
        rows = []
        for curve in group:
            steps, best = np.asarray(curve["steps"]), np.asarray(curve["best"])
            rows.append(value(steps, best, (marks[:, None] >= steps - 1e-9).sum(axis=1) - 1))
        found[text] = np.array(rows)
    found["The mean over the runs is taken, but each run should have a row of its own."] = np.mean(
        [
            np.asarray(c["best"])[(marks[:, None] >= c["steps"] - 1e-9).sum(axis=1) - 1]
            for c in group
        ],
        axis=0,
    )
    return found


def drawn_groups(rng: np.random.Generator, sizes: dict[str, int]) -> dict[str, list[dict]]:
    groups: dict[str, list[dict]] = {}
    for name, size in sizes.items():
        groups[name] = []
        for _ in range(size):
            n = int(rng.integers(10, 30))
            steps = np.cumsum(rng.uniform(1, 60, n))
            groups[name].append({"steps": steps, "best": np.cumsum(rng.uniform(0, 9, n))})
    return groups


def deciding(groups: dict[str, list[dict]]) -> tuple[str, str]:
    """The group of the run that begins last, and the group of the one that ends first."""
    runs = [(curve["steps"], name) for name, group in groups.items() for curve in group]
    _, begins_last = max((steps[0], name) for steps, name in runs)
    _, ends_first = min((steps[-1], name) for steps, name in runs)
    return begins_last, ends_first


@equal.check(5)
def at_the_same_steps(student: Student):
    rng = generator(92)
    for sizes, points in (({"PPO": 1, "ES": 1}, 4), ({"a": 3, "b": 2, "c": 4}, 25)):
        groups = drawn_groups(rng, sizes)
        while len(sizes) > 2 and len(set(deciding(groups))) < 2:  # no group decides alone
            groups = drawn_groups(rng, sizes)
        curves = [curve for group in groups.values() for curve in group]
        start = max(curve["steps"][0] for curve in curves)
        end = min(curve["steps"][-1] for curve in curves)
        marks = start + (end - start) * np.arange(points) / (points - 1)
        answer = student.call("at_equal_steps", groups, points)
        student.said = f"at_equal_steps({sizes} runs, {points})"
        got = expect_fields(student.said, answer, "steps", *groups)
        mistakes = partial(mistaken_steps, curves, points)
        expect_close(f"{student.said}: steps", got[0], marks, CLOSE, mistakes)
        if np.shape(got[0]) != marks.shape or not np.allclose(got[0], marks, CLOSE, CLOSE):
            continue  # the values at other steps are others
        for (name, group), values in zip(groups.items(), got[1:], strict=True):
            wanted = [
                [curve["best"][curve["steps"] <= mark + 1e-9][-1] for mark in marks]
                for curve in group
            ]
            mistakes = partial(mistaken_values, group, marks)
            expect_close(f"{student.said}: {name}", values, np.array(wanted), CLOSE, mistakes)
