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
