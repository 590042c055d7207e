"""Right solutions of exercise 4 in other styles; building.py describes how a case is written."""

# %% complex_numbers
# Directions as complex numbers; NumPy's scalars as they come; broadcasting in place of a search.
from collections import OrderedDict


def decode(observation):
    one, two = observation[[0, 2]] + 1j * observation[[1, 3]]
    return dict(
        angle1=np.angle(one), angle2=np.angle(two), speed1=observation[4], speed2=observation[5]
    )


def torque(action):
    return np.float32(action) - np.float32(1)


def height(observation):
    first = complex(observation[0], observation[1])
    second = first * complex(observation[2], observation[3])
    return -(first + second).real


def reward(observation):
    return np.where(height(observation) > 1, 0.0, -1.0).item()


def run_replications(experiment_file, seeds, folder, steps=None):
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    done = OrderedDict()
    for seed in np.array(seeds):
        run = Run(config.load(experiment_file), int(seed))
        evolve(run, place, steps=steps)
        done[int(seed)] = np.float64(run.record.bestg_fitness)
    return done


def read_stat(path):
    return dict(zip(COLUMNS, np.load(path).reshape((6, -1), order="F")))


def curves(stats, column, budgets):
    table = np.empty((len(stats), len(budgets)))
    for row, stat in zip(table, stats):
        complete = np.asarray(stat["steps"])[None, :] <= np.asarray(budgets)[:, None]
        row[:] = np.asarray(stat[column])[complete.sum(axis=1) - 1]
    centre = table.sum(axis=0) / len(table)
    spread = np.sqrt(((table - centre) ** 2).sum(axis=0) / (len(table) - 1))
    return {"deviation": spread, "mean": centre}


def compare(experiment_file, folder, seeds, episodes, test_seed):
    rows = []
    for seed in seeds:
        row = {"seed": np.int64(seed)}
        row["promised"] = np.load(f"{folder}/statS{seed}.npy")[-4]
        for kind in ("best", "bestg"):
            robot = SavedRobot(Path(experiment_file), np.load(f"{folder}/{kind}S{seed}.npy"))
            row[kind] = np.average(robot.evaluate(seed=test_seed, episodes=episodes))
        rows.append(row)
    return tuple(rows)


# %% plain_python
# The modules `math`, `os` and `statistics`; loops and tuples; the seeds in another order.
import math
import os
import statistics


def decode(observation):
    def angle(cosine, sine):
        size = math.acos(max(-1, min(1, cosine)))
        return size if sine >= 0 else -size

    c1, s1, c2, s2, v1, v2 = observation
    return {"speed2": v2, "speed1": v1, "angle2": angle(c2, s2), "angle1": angle(c1, s1)}


def torque(action):
    return {0: -1, 1: 0, 2: 1}[action]


def height(observation):
    c1, s1, c2, s2 = map(float, observation[:4])
    return -c1 - (c1 * c2 - s1 * s2)


def reward(observation):
    return -int(height(observation) <= 1)


def run_replications(experiment_file, seeds, folder, steps=None):
    os.makedirs(folder, exist_ok=True)
    best = {}
    for seed in sorted(seeds):
        run = Run(config.load(experiment_file), seed)
        evolve(run, Path(folder), steps)
        best.setdefault(seed, run.record.bestg_fitness)
    return best


def read_stat(path):
    columns = {name: [] for name in COLUMNS}
    for place, value in enumerate(np.load(path)):
        columns[COLUMNS[place % 6]].append(float(value))
    return columns


def curves(stats, column, budgets):
    mean, deviation = [], []
    for budget in budgets:
        values = []
        for stat in stats:
            last = None
            for steps, value in zip(stat["steps"], stat[column]):
                if steps <= budget:
                    last = value
            values.append(float(last))
        mean.append(statistics.fmean(values))
        deviation.append(statistics.stdev(values))
    return {"mean": mean, "deviation": deviation}


def compare(experiment_file, folder, seeds, episodes, test_seed):
    def worth(name):
        genotype = np.load(os.path.join(folder, name))
        returns = SavedRobot(experiment_file, genotype).evaluate(test_seed, episodes)
        return sum(returns) / len(returns)

    return [
        {
            "seed": seed,
            "best": worth(f"bestS{seed}.npy"),
            "bestg": worth(f"bestgS{seed}.npy"),
            "promised": read_stat(os.path.join(folder, f"statS{seed}.npy"))[COLUMNS[2]][-1],
        }
        for seed in seeds
    ]


# %% small_helpers
# Named tuples, generators and helpers; half angles; walks along the curves with `bisect`.
from bisect import bisect_right
from typing import NamedTuple


class State(NamedTuple):
    angle1: float
    angle2: float
    speed1: float
    speed2: float

    @classmethod
    def of(cls, seen):
        pairs = np.asarray(seen[:4], dtype=np.float64).reshape(2, 2)
        angles = 2 * np.arctan2(pairs[:, 1], np.hypot(*pairs.T) + pairs[:, 0])
        return cls(*angles.tolist(), *np.asarray(seen[4:], dtype=np.float64).tolist())

    @property
    def height(self):
        return -sum(np.cos(np.cumsum([self.angle1, self.angle2])))


def decode(observation):
    return State.of(observation)._asdict()


def torque(action):
    return (-1.0, 0.0, 1.0)[action]


def height(observation):
    return State.of(observation).height


def reward(observation):
    return float((height(observation) > 1) - 1)


def run_replications(experiment_file, seeds, folder, steps=None):
    Path(folder).mkdir(exist_ok=True, parents=True)

    def fitness(seed):
        run = Run(config.load(Path(experiment_file)), seed)
        evolve(run, Path(folder), steps)
        return run.record.bestg_fitness

    return {seed: fitness(seed) for seed in reversed(seeds)}


def read_stat(path):
    numbers = np.load(path)
    return {name: numbers[start::6] for start, name in enumerate(COLUMNS)}


def curves(stats, column, budgets):
    def value(stat, budget):
        return stat[column][bisect_right(stat["steps"], budget) - 1]

    table = np.array([[value(stat, budget) for stat in stats] for budget in budgets])
    n = table.shape[1]
    return {"mean": table.mean(axis=1), "deviation": table.std(axis=1) * np.sqrt(n / (n - 1))}


def compare(experiment_file, folder, seeds, episodes, test_seed):
    def rows():
        for seed in seeds:
            files = {kind: Path(folder, f"{kind}S{seed}.npy") for kind in ("best", "bestg")}
            returns = {
                kind: SavedRobot(experiment_file, np.load(file)).evaluate(test_seed, episodes)
                for kind, file in files.items()
            }
            promised = read_stat(Path(folder, f"statS{seed}.npy"))["best post-evaluated"]
            worth = {kind: float(np.mean(each)) for kind, each in returns.items()}
            yield {"seed": seed, "promised": max(promised) * 0 + promised[-1], **worth}

    return list(rows())


# %% highest_promise
# The promise is the highest of its column; single precision; the sum rule of cosines; a dict of arrays.
def decode(observation):
    o = np.asarray(observation, dtype=np.float32)
    names = ("angle1", "angle2", "speed1", "speed2")
    return dict(zip(names, [*np.arctan2(o[1:4:2], o[0:4:2]), *o[4:]]))


def height(observation):
    c1, s1, c2, s2 = np.asarray(observation, dtype=np.float32)[:4]
    return np.float32(-c1 * (1 + c2) + s1 * s2)


def torque(action):
    return (-1.0, 0.0, 1.0)[int(action)]


def reward(observation):
    return (height(observation) > 1) - 1.0


def read_stat(path):
    numbers = np.load(path)
    return {name: numbers[start :: len(COLUMNS)] for start, name in enumerate(COLUMNS)}


def compare(experiment_file, folder, seeds, episodes, test_seed):
    def worth(seed, kind):
        robot = SavedRobot(experiment_file, np.load(Path(folder, f"{kind}S{seed}.npy")))
        return sum(robot.evaluate(test_seed, episodes)) / episodes

    return [
        {
            "seed": seed,
            "promised": max(read_stat(Path(folder, f"statS{seed}.npy"))["best post-evaluated"]),
            **{kind: worth(seed, kind) for kind in ("bestg", "best")},
        }
        for seed in seeds
    ]


# %% files_instead_of_records
# The fitness is read from the stat file; all runs are prepared first; bisect and statistics.
import bisect
import statistics


def run_replications(experiment_file, seeds, folder, steps=None):
    folder = Path(folder).absolute()
    folder.mkdir(parents=True, exist_ok=True)
    for run in [Run(config.load(Path(experiment_file)), seed) for seed in seeds]:
        evolve(run, folder, steps)
    return {seed: float(np.load(folder / f"statS{seed}.npy")[-4]) for seed in seeds}


def curves(stats, column, budgets):
    at = [
        [stat[column][bisect.bisect(list(stat["steps"]), budget) - 1] for stat in stats]
        for budget in budgets
    ]
    return {"mean": [*map(statistics.fmean, at)], "deviation": [*map(statistics.stdev, at)]}


# %% tables_and_masks
# A structured array for the stat file, masks for the budgets, a rotation for the height.
def decode(observation):
    cosine, sine = observation[0:4:2], observation[1:4:2]
    angles = 2 * np.arctan2(sine, 1 + cosine)
    return {
        **{f"angle{i}": angle for i, angle in enumerate(angles, 1)},
        **{f"speed{i}": speed for i, speed in enumerate(observation[4:], 1)},
    }


def height(observation):
    c1, s1, c2, s2, *_ = observation
    end = np.array([[c1, -s1], [s1, c1]]) @ (np.array([1.0, 0.0]) + np.array([c2, s2]))
    return float(-end[0])


def read_stat(path):
    kinds = [(name, float) for name in COLUMNS]
    table = np.load(path).astype(float).view(kinds)
    return {name: table[name] for name in table.dtype.names}


def curves(stats, column, budgets):
    rows = []
    for stat in stats:
        mask = stat["steps"][:, None] <= budgets
        last = len(mask) - 1 - mask[::-1].argmax(axis=0)
        rows.append(stat[column][last])
    rows = np.vstack(rows)
    return {"mean": rows.mean(0), "deviation": np.sqrt(rows.var(0, ddof=1))}


# %% complex_numbers_again
# Complex numbers and loops.
import cmath


def decode(observation):
    c1, s1, c2, s2, v1, v2 = (float(x) for x in observation)
    return dict(
        angle1=cmath.phase(complex(c1, s1)),
        angle2=cmath.phase(complex(c2, s2)),
        speed1=v1,
        speed2=v2,
    )


def torque(action):
    return (-1.0, 0.0, 1.0)[action]


def height(observation):
    c1, s1, c2, s2 = (float(x) for x in observation[:4])
    return -c1 - (c1 * c2 - s1 * s2)


def reward(observation):
    if height(observation) > 1:
        return 0.0
    return -1.0


def run_replications(experiment_file, seeds, folder, steps=None):
    import os

    os.makedirs(folder, exist_ok=True)
    found = {}
    for seed in seeds:
        run = Run(config.load(experiment_file), seed)
        evolve(run, Path(folder), steps=steps)
        found[int(seed)] = run.record.bestg_fitness
    return found


def read_stat(path):
    flat = np.load(path)
    return {name: flat[i::6] for i, name in enumerate(COLUMNS)}


def curves(stats, column, budgets):
    values = np.zeros((len(stats), len(budgets)))
    for r, stat in enumerate(stats):
        for b, budget in enumerate(budgets):
            for when, value in zip(stat["steps"], stat[column]):
                if when > budget:
                    break
                values[r, b] = value
    mean = values.sum(0) / len(stats)
    return {
        "mean": list(mean),
        "deviation": np.sqrt(((values - mean) ** 2).sum(0) / (len(stats) - 1)),
    }


def compare(experiment_file, folder, seeds, episodes, test_seed):
    def worth(name):
        return float(
            np.average(
                SavedRobot(experiment_file, np.load(f"{folder}/{name}.npy")).evaluate(
                    test_seed, episodes
                )
            )
        )

    return [
        {
            "bestg": worth(f"bestgS{s}"),
            "best": worth(f"bestS{s}"),
            "promised": float(np.load(f"{folder}/statS{s}.npy")[-4]),
            "seed": s,
        }
        for s in seeds
    ]


# %% steps_are_integers
# The steps are whole numbers, and the columns cannot be written into.
def read_stat(path):
    table = np.load(path, mmap_mode="r").reshape(-1, len(COLUMNS))
    answer = {name: table[:, i] for i, name in enumerate(COLUMNS)}
    answer["steps"] = answer["steps"].astype(np.int64)
    return answer
