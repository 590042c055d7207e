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
