# Tables of thresholds and weights in place of cases; each episode recorded once for all robots.
LOWEST = {"Hopper": 0.8, "Walker2D": 0.8, "Ant": 0.26, "Humanoid": 0.78, "HalfCheetah": -np.inf}
STEEPEST = {"Ant": np.inf, "Humanoid": np.inf}


def progress(distance, duration):
    return np.convolve(distance, [-1, 1], mode="valid") / duration


def alive_bonus(robot, height, pitch, touching):
    fallen = (height <= LOWEST[robot]) | (np.abs(pitch) >= STEEPEST.get(robot, 1))
    if robot == "HalfCheetah":
        fallen = np.logical_or(fallen, touching > 0)
    reward = np.full(len(height), 1.0 + (robot == "Humanoid"))
    reward[fallen] = -1
    return reward


def electricity(robot, actions, speeds):
    weights = np.array([2.0, 0.1]) * {"Humanoid": 4.25}.get(robot, 1.0)
    parts = np.stack([np.abs(actions * speeds).mean(1), np.square(actions).mean(1)])
    return -weights @ parts


def joints_at_limit(positions):
    return -np.count_nonzero(np.abs(positions) > 0.99, axis=1) / 10


def components_v0(trajectory):
    keys = {
        "progress": (progress, ["distance", "duration"]),
        "alive": (alive_bonus, ["robot", "height", "pitch", "touching"]),
        "electricity": (electricity, ["robot", "actions", "speeds"]),
        "joints_at_limit": (joints_at_limit, ["positions"]),
    }
    return {name: f(*(trajectory[key] for key in given)) for name, (f, given) in keys.items()}


def reward_v5(trajectory):
    robot = trajectory["robot"]
    position = np.abs(trajectory["positions"])
    beyond = np.where(position > 1, position - 1, 0).sum(1)
    terms = [progress(trajectory["distance"], trajectory["duration"])]
    terms += [joints_at_limit(position)] if robot in ("HalfCheetah", "Ant", "Humanoid") else []
    terms += [0.01 - 0.01 * (trajectory["actions"] ** 2).mean(1)] if robot == "Ant" else []
    terms += [1 - 10 * beyond - trajectory["heading"] ** 2 / 10] if robot == "Humanoid" else []
    return np.sum(terms, axis=0)


# lowest, highest, steepest, bonus, price of effort
RUNNERS = {
    "PlanarHopper": (0.7, np.inf, 0.2, 1.0, 1e-3),
    "PlanarWalker2D": (0.8, 2.0, 1.0, 1.0, 1e-3),
    "PlanarHalfCheetah": (-np.inf, np.inf, np.inf, 0.0, 1e-1),
}


def planar_v0(trajectory):
    low, high, steep, bonus, price = RUNNERS[trajectory["robot"]]
    height = trajectory["height"]
    fallen = (height <= low) | (height >= high) | (np.abs(trajectory["pitch"]) >= steep)
    return {
        "progress": progress(trajectory["distance"], trajectory["duration"]),
        "alive": bonus * ~fallen,
        "effort": -price * np.einsum("tj,tj->t", trajectory["actions"], trajectory["actions"]),
    }


def gait(trajectory):
    v0 = planar_v0(trajectory)
    income = np.array([v0["alive"].clip(0).sum(), v0["progress"].clip(0).sum()])
    distance, duration = trajectory["distance"], trajectory["duration"]
    steps = len(distance) - 1
    return {
        "metres": float(distance[0] - distance[steps]),
        "seconds": steps * duration,
        "speed": (distance[0] - distance[steps]) / steps / duration,
        "standing": income[0] / income.sum() if income.any() else 0,
        "grounded": np.count_nonzero(trajectory["feet"].sum(1)) / steps,
    }


def compare(robot, genotypes, seed, episodes):
    runner = Runner(f"{robot}-v5")
    names = ["metres", "seconds", "speed", "standing", "grounded"]
    sums = {key: np.zeros((5, len(rows))) for key, rows in genotypes.items()}
    for i in range(episodes):
        for key, rows in genotypes.items():
            for column, genotype in enumerate(rows):
                one = gait(runner.record(genotype, seed + i))
                sums[key][:, column] += [one[name] for name in names]
    return {key: dict(zip(names, total / episodes)) for key, total in sums.items()}
