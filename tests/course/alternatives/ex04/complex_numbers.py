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
