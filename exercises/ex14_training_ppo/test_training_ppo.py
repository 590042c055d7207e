"""Grader of exercise 14; run it with `botschool grade 14`.

All tasks compare with our solution. Nothing is left to chance: trainings depend on their settings
and seed alone, and logs are drawn from the grading seed.
"""

from functools import partial

import numpy as np

from botschool.evolution.events import VERSION, event, record
from botschool.grading import Exercise, same

exercise = Exercise(
    14,
    "Training with PPO",
    file="training_ppo.py",
    imports=("botschool.rl.training", "tensorboard.backend.event_processing.event_accumulator"),
)
close = partial(same, tolerance=1e-6)
SHORT = {"n_steps": 16, "batch_size": 64, "n_epochs": 2, "normalize": False}  # a short training


def with_files(module, name, place, files):
    """{0}('{1}')"""
    from pathlib import Path

    import numpy as np

    for path, content in files.items():
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        if path.endswith(".npz"):
            np.savez(path, **content)
        else:
            np.save(path, content) if path.endswith(".npy") else content.tofile(path)
    return getattr(module, name)(place)


varying = exercise.task("14.1", "Variations", seconds=60)


def trained(module, environment, variations, seeds, steps, options):
    """train_variations('{0}', {1}, {2}, {3}, 'trainings', **{4})"""
    import os
    from pathlib import Path

    from botschool.rl.folder import RunFolder

    records = module.train_variations(environment, variations, seeds, steps, "trainings", **options)
    places = [Path(os.path.relpath(each["folder"])) for each in records]
    found = {"the number of dicts": len(records), "the number of folders": len({*places})}
    for one, place in zip(records, places, strict=True):
        own = {"that its folder is a training's": (place / "evaluations.npz").is_file()}
        if all(own.values()):
            run = RunFolder(place).evaluations()
            own |= {"steps": run.steps, "returns": run.returns, "lengths": run.lengths}
        own |= {"the folder above ppo": str(place.parent.parent), "return": one["return"]}
        found[f"variant {one['variant']!r}, seed {one['seed']}"] = own
    return found


def variations(rng, *names):
    return {name: {**SHORT, "learning_rate": round(rng.uniform(0.002, 0.02), 5)} for name in names}


@same(varying, 6, trained, 1e-4)
def one_variation(rng):
    """In some of these trainings the last post-evaluation is not the best."""
    seeds = rng.choice(10_000, 6, replace=False).tolist()
    yield "Pendulum-v1", variations(rng, "only"), seeds, 512, {"evaluations": 4, "episodes": 3}
    yield "Pendulum-v1", variations(rng, "only"), seeds[:1], 384, {"evaluations": 2, "episodes": 2}


@same(varying, 10, trained, 1e-4, off={"changes": "each costs four trainings"})
def every_variation_with_every_seed(rng):
    seeds = rng.choice(10_000, 2, replace=False).tolist()
    for names in (("varied",), ("a", "b")):
        own = variations(rng, *names) | {"default": {**SHORT}}
        yield "CartPole-v1", own, seeds, 384, {"evaluations": 3, "episodes": 2}


reading = exercise.task("14.2", "What was logged")
LOG = "loss value_loss policy_gradient_loss entropy_loss approx_kl clip_fraction explained_variance"
NAMES = "rollout/ep_rew_mean", "rollout/ep_len_mean", *(f"train/{name}" for name in LOG.split())


def log_of(entries, more=()):
    """Arguments of with_files: a log of (name, step, value) in this order, and more events."""
    events = [event(0.0, version=VERSION)]
    events += [event(1.0 + i, step, [(name, x)]) for i, (name, step, x) in enumerate(entries)]
    content = np.frombuffer(b"".join(map(record, [*events, *more])), dtype=np.uint8)
    return "read_indicators", "training", {"training/events.out.tfevents.1.x": content}


def entries(rng, names, most=30):
    """(name, step, value) of indicators of random lengths, by their steps."""
    found = []
    for name in names:
        steps = np.cumsum(rng.integers(1, 500, rng.integers(2, most)))
        steps[1] = steps[0]  # a step may be logged twice
        found += [(name, step, rng.normal()) for step in steps.tolist()]
    return sorted(found, key=lambda entry: entry[1])


def all_of(indicators, *_):
    return {"the names": sorted(indicators), **indicators}


@close(reading, 5, with_files, view=all_of)
def all_indicators(rng):
    from tensorboard.compat.proto.event_pb2 import Event

    yield log_of(entries(rng, NAMES[-2:], 4))
    histogram = Event(wall_time=2.0, step=5)
    histogram.summary.value.add(tag="actions/chosen").histo.num = 2.0
    yield log_of(entries(rng, NAMES), [histogram.SerializeToString()])


@close(reading, 3, with_files, view=all_of, off=dict.fromkeys(("draw", "changes"), "it is long"))
def a_long_log(rng):
    yield log_of([("train/approx_kl", 8 * i, rng.normal()) for i in range(1, 10_100)])


@close(reading, 3, with_files, view=all_of)
def without_nan(rng):
    for place in (3, 20):
        found = entries(rng, NAMES)
        found.insert(place, (NAMES[-1], found[place][1], np.nan))
        yield log_of([*found, (NAMES[-1], 20_000, np.nan), ("train/loss", 20_000, 0.5)])
    for name, other in ((NAMES[-1], np.inf), (NAMES[0], -np.inf)):
        yield log_of([("train/loss", 5, other), (name, 5, np.nan), (name, 9, np.nan)])


def read_training(module, seed, steps, names):
    """read_indicators(str(run.path)) of a training of {1} steps with seed {0}"""
    from botschool.rl.training import train

    run = train("ppo", "CartPole-v1", "trained", steps=steps, seed=seed, evaluations=1, episodes=1)
    found = module.read_indicators(str(run.path))
    return {name: found.get(name) for name in names}


@close(reading, 3, read_training, off={"changes": "each is a training"})
def a_training(rng):
    for steps in (1000, 1500):
        yield int(rng.integers(10_000)), steps, [*NAMES]


success = exercise.task("14.3", "How successful was it?")


def evaluated(rng, means, at_first=False):
    """Arguments of success_of; at_first: the first post-evaluation comes before the training."""
    n = len(means)
    steps = np.cumsum(rng.integers(200, 3000, n))
    noise = rng.permuted(np.tile([-9.0, -3.0, 1.0, 3.0, 8.0], (n, 1)), axis=1)
    return steps - steps[0] * at_first, np.reshape(means, (n, 1)) + noise, 100.0


@close(success, 3, "success_of", parts=("last", "best"))
def last_and_best(rng):
    some = (rng.integers(0, 200, n) for n in (4, 7, 11))
    for means in ([-1200, -300, -650, -400], [-80, 20, 10, 150], *some):
        yield evaluated(rng, means)


@close(success, 4, "success_of", parts=("average",))
def average_over_the_training(rng):
    for means in ([10, 20], [42], [7], rng.integers(0, 200, 6), rng.integers(-900, 0, 9)):
        yield evaluated(rng, means)


@close(success, 4, "success_of", parts=("solved",))
def solved_for_good(rng):
    for means in (
        [5, 55, 110, 120, 180], [5, 130, 60, 101, 150], [120, 110, 150], [130, 140],
        [5, 130, 140, 99], [5, 55, 60, 101], [5, 60, 98, 120], [20, 97, 130],
    ):  # fmt: skip
        yield evaluated(rng, means)
    for means in ([130, 120, 140], [130, 140]):
        yield evaluated(rng, means, at_first=True)


@close(success, 1, "success_of", parts=("solved",))
def the_goal_itself_is_enough(rng):
    for means in ([85, 100, 103, 105], [20, 30, 100]):
        yield evaluated(rng, means)


table = exercise.task("14.4", "The table")


def columns(*names):
    """A view of the rows in their order."""

    def view(rows, runs, baseline):
        own = {f"row {row['variant']!r}": {name: row[name] for name in names} for row in rows}
        return {"the order of the rows": [row["variant"] for row in rows], **own}

    return view


def runs_of(rng, **sizes):
    """Results of so many seeds of each variation, in any order."""
    runs = [
        {"variant": name, "seed": 10 + seed, "return": round(float(rng.normal(100, 60)), 2)}
        for name, size in sizes.items()
        for seed in range(size)
    ]
    return [runs[i] for i in rng.permutation(len(runs))]


@close(table, 5, "table_of", view=columns("runs", "mean"))
def means_in_order(rng):
    yield runs_of(rng, default=2, fast=2), "default"
    yield runs_of(rng, default=4, fast=4), "default"
    yield runs_of(rng, a=3, b=5, c=2, d=7), "a"
    yield [{**run, "return": 500.0} for run in runs_of(rng, a=3)], "a"


@close(table, 4, "table_of", view=columns("deviation", "gain"))
def deviations_and_gains(rng):
    for b, default, a in ((2, 3, 6), (2, 3, 6), (2, 3, 6), (3, 1, 0), (1, 4, 0)):
        runs = runs_of(rng, b=b, default=default, a=a)
        yield from ((runs, baseline) for baseline in ("default", "b"))
    for size, result in ((3, 500.0), (4, -25.0)):
        yield [{**run, "return": result} for run in runs_of(rng, default=size)], "default"


@close(table, 3, "table_of", view=columns("runs", "mean", "deviation", "gain"))
def a_seed_counts_once(rng):
    for sizes in ({"default": 2, "slow": 3}, {"default": 4, "slow": 3}):
        runs = runs_of(rng, **sizes)
        higher = [{**run, "return": run["return"] + 50} for run in runs[1::2]]
        lower = [{**run, "return": run["return"] - 70} for run in runs[::2]]
        yield [*runs, *higher, *lower], "default"


luck = exercise.task("14.5", "Is it more than luck?")


def results(rng, n, mean=100, deviation=9):
    return rng.normal(mean, deviation, n).round(2).tolist()


@close(luck, 7, "chance_of")
def of_drawn_results(rng):
    for n, m in ((2, 2), (3, 3), (5, 5), (2, 6), (5, 3), (1, 4), (4, 2), (5, 2), (6, 4)):
        yield results(rng, n, 110, 20), results(rng, m)


@close(luck, 3, "chance_of")
def with_equal_results(rng):
    yield [500.0] * 3, [500.0] * 3
    yield [0.1, 0.2, 0.3], [0.3, 0.6, 0.2]
    for _ in range(2):
        yield (rng.integers(0, 4, 4) / 10).tolist(), (rng.integers(1, 6, 4) / 10).tolist()


signs = exercise.task("14.6", "Warning signs")
within = partial(close, off={"changes": "no step may exceed `total`"})


@within(signs, 3, "phase_means")
def parts_of_a_training(rng):
    for n, parts in ((5, 3), (60, 3), (60, 4)):
        steps = np.sort(rng.choice(np.arange(1, 6000), n, replace=False))
        values, others = rng.normal(size=(2, n)).round(3)
        yield from ((steps, each, 6000, parts) for each in (values, others))
        yield from ((steps, values, *other) for other in ((6000, parts + 2), (8000, parts)))
        yield np.sort(6000 - steps), values, 6000, parts


@within(signs, 3, "phase_means")
def borders_gaps_and_nan(rng):
    for steps, total, parts in (
        ([0, 100, 200, 300], 300, 3), ([0, 40, 50, 100], 100, 2), ([80, 290], 300, 3),
        ([142, 143, 285, 286, 999, 1000], 1000, 7), ([33, 34, 66, 67, 100], 100, 3),
    ):  # fmt: skip
        yield np.array(steps), rng.normal(size=len(steps)).round(3), total, parts
    for missing in ([0, 5], [0, 5, 3, 4], [2, 9, 10, 11]):
        values = rng.normal(size=12)
        values[missing] = np.nan
        yield np.arange(50, 650, 50), values, 600, 4


def told(found, indicators, total, chosen):
    return {repr(sign): sign in found for sign in chosen} | {"the signs in their order": found}


@within(signs, 1, "warning_signs", view=told)
def limits_give_no_sign(rng):
    """Means that equal the limit, and entries at the very border of the last third."""
    steps = np.arange(100, 3001, 100)
    levels = [0.0, 0.0, *(rng.integers(1, 9, 2) / (4, -4)).tolist()]
    for level, size in zip(levels, (0.25, 0.5, 0.25, 0.5), strict=True):
        values = {"flat": np.full(30, level), "moving": level + size * (-1.0) ** np.arange(30)}
        indicators = {name: {"steps": steps, "values": each} for name, each in values.items()}
        indicators["early"] = {"steps": steps[:20], "values": np.full(20, level)}
        chosen = {
            f"{name} {side} {limit}": (name, side, limit)
            for limit in (level - 0.5, level, level + 0.5)
            for side in ("above", "below")
            for name in indicators  # so that names do not stand together
        }
        yield indicators, 3000, chosen


def watched(rng, missing):
    """Indicators of which each third says something else, and limits near the last one's mean."""
    indicators, chosen, steps = {}, {}, np.arange(100, 3001, 100)
    for number, name in enumerate(NAMES):
        late, values = round(rng.normal(), 3), rng.normal(0, 60, 30)
        values[20:] = late + 0.5 * (np.arange(10) - 4.5)
        kept = slice(20 if number < missing else None)  # not logged in the last third
        if number >= missing or number % 2 == 0:
            indicators[name] = {"steps": steps[kept], "values": values[kept]}
        side, limit = ("above", "below")[rng.integers(2)], late + rng.choice([-0.2, 0.2])
        sign = f"sign {(5 * number + 3) % 11}"  # in another order than that of the names
        chosen[sign] = name, side, round(float(limit), 3)
    return indicators, 3000, chosen


@within(signs, 5, "warning_signs", view=told)
def signs_of_the_last_third(rng):
    for missing in (0, 0, 0, 4, 4, 4):
        indicators, total, chosen = watched(rng, missing)
        yield from ((indicators, steps, chosen) for steps in (total, 3300))
        sides = {"above": "below", "below": "above"}
        turned = {sign: (name, sides[side], at) for sign, (name, side, at) in chosen.items()}
        yield indicators, total, turned
        low = {name: each | {"values": each["values"] - 9} for name, each in indicators.items()}
        yield low, total, chosen


relating = exercise.task("14.7", "Which indicators go with success?")


@close(relating, 4, "rank_correlation")
def correlates_the_ranks(rng):
    for n in (5, 12, 40):
        first = rng.normal(size=n)
        yield first, np.exp(3 * (first + rng.normal(size=n)))


@close(relating, 4, "rank_correlation")
def equal_numbers(rng):
    yield np.array([5.0, 7.0, 7.0, 9.0]), rng.normal(size=4).round(2)
    for n in (8, 25):
        yield rng.integers(0, 4, n) / 2, rng.integers(0, 3, n) + 0.5
    yield np.full(6, 500.0), rng.normal(size=6).round(2)
    yield rng.normal(size=6).round(2), np.full(6, -0.7)


def rounded(numbers, *_):
    exact = np.array_equal(numbers, np.round(numbers, 9))
    return {"its numbers": numbers, "that they are rounded to 9 decimals": exact}


@close(relating, 4, "within_variants", view=rounded, off={"single": "it has few decimals"})
def inside_variants(rng):
    for kinds in (2, 3, 4):
        which = rng.permutation(np.repeat(np.arange(kinds), rng.integers(2, 6, kinds)))
        numbers = rng.normal(size=len(which)) + 100 * which
        numbers[which == 0] = 0.1 + 0.7  # equal ones stay equal
        names = [f"variant {kind}" for kind in which]
        yield from ((numbers, each) for each in (names, names[::-1]))
        yield np.sin(numbers), names


equal = exercise.task("14.8", "Evolution and PPO at equal steps")


@close(equal, 3, with_files)
def curve_of_evolution(rng):
    for place in ("evolved/statS3.npy", "evolved/statS14.npy"):
        stat = rng.normal(size=(int(rng.integers(5, 30)), 6))
        stat[:, 0] = np.cumsum(rng.integers(100, 900, len(stat)))
        stat[:, 1], stat[:, 2] = np.sort(stat[:, 1]) + 5, np.sort(stat[:, 2])
        yield "curve_of", place, {place: stat.ravel()}


@close(equal, 4, with_files)
def curve_of_a_training(rng):
    for place, below in (("trained/CartPole-v1_1", 0), ("trained/Pendulum-v1_2", 9)):
        n, episodes = int(rng.integers(4, 15)), int(rng.integers(2, 8))
        found = {"timesteps": np.cumsum(rng.integers(100, 900, n))}
        found["results"] = rng.normal(size=(n, episodes)) - below  # all may be negative
        found["ep_lengths"] = rng.integers(5, 90, (n, episodes))
        yield "curve_of", place, {f"{place}/evaluations.npz": found}


@close(equal, 5, "at_equal_steps")
def at_the_same_steps(rng):
    def run():
        steps, best = np.cumsum(rng.uniform(1, 60, (2, int(rng.integers(10, 30)))), axis=1)
        return {"steps": steps, "best": best}

    for sizes, points in (((1, 1), 4), ((3, 2, 4), 25), ((3, 2, 4), 10), ((2, 1, 2), 3)):
        named = zip(("PPO", "ES", "other"), sizes, strict=False)
        yield {name: [run() for _ in range(size)] for name, size in named}, points
