"""Right solutions of exercise 9 in other styles; building.py describes how a case is written."""


# %% other_functions
# Differences, einsum, selections and sums of booleans.
def progress(distance, duration):
    return -np.diff(np.asarray(distance, dtype=np.float64)) / duration


def alive_bonus(robot, height, pitch, touching):
    upright = (pitch > -1) & (pitch < 1)
    standing = {
        "Ant": height > 0.26,
        "Humanoid": height > 0.78,
        "HalfCheetah": upright & np.logical_not(touching),
    }.get(robot, upright & (height > 0.8))
    return np.select([~standing, robot == "Humanoid"], [-1.0, 2.0], 1.0)


def electricity(robot, actions, speeds):
    joints = actions.shape[1]
    power = np.einsum("tj,tj->t", np.abs(actions), np.abs(speeds)) * 2 / joints
    effort = np.einsum("tj,tj->t", actions, actions) / (10 * joints)
    factor = 4.25 if robot == "Humanoid" else 1
    return factor * -(power + effort)


def joints_at_limit(positions):
    inside = np.logical_and(positions >= -0.99, positions <= 0.99)
    return (inside.sum(axis=1) - positions.shape[1]) / 10


def components_v0(trajectory):
    one = dict(trajectory)
    robot = one.pop("robot")
    return {
        "progress": progress(one["distance"], one["duration"]),
        "alive": alive_bonus(robot, one["height"], one["pitch"], one["touching"]),
        "electricity": electricity(robot, one["actions"], one["speeds"]),
        "joints_at_limit": joints_at_limit(one["positions"]),
    }


def reward_v5(trajectory):
    robot, parts = trajectory["robot"], components_v0(trajectory)
    reward = parts["progress"]
    if robot not in {"Hopper", "Walker2D"}:
        reward += parts["joints_at_limit"]
    if robot == "Ant":
        reward += 0.01 * (1 - np.square(trajectory["actions"]).mean(axis=-1))
    elif robot == "Humanoid":
        positions = trajectory["positions"]
        beyond = np.abs(positions - positions.clip(-1, 1)).sum(axis=-1)
        reward += 1 - 10 * beyond - 0.1 * np.square(trajectory["heading"])
    return reward


def planar_v0(trajectory):
    robot, height, pitch = trajectory["robot"], trajectory["height"], trajectory["pitch"]
    low, high, lean = {"PlanarHopper": (0.7, np.inf, 0.2)}.get(robot, (0.8, 2, 1))
    upright = (low < height) & (height < high) & (-lean < pitch) & (pitch < lean)
    cheetah = robot == "PlanarHalfCheetah"
    return {
        "progress": progress(trajectory["distance"], trajectory["duration"]),
        "alive": np.zeros_like(height) if cheetah else upright,
        "effort": (0.1 if cheetah else 0.001)
        * -(np.linalg.norm(trajectory["actions"], axis=1) ** 2),
    }


def gait(trajectory):
    parts, duration = planar_v0(trajectory), trajectory["duration"]
    alive, moved = (parts[key][parts[key] > 0].sum() for key in ("alive", "progress"))
    seconds = duration * trajectory["height"].size
    metres = duration * parts["progress"].sum()
    return {
        "metres": metres,
        "seconds": seconds,
        "speed": metres / seconds,
        "standing": alive / (alive + moved) if alive or moved else 0.0,
        "grounded": np.any(trajectory["feet"], axis=1).mean(),
    }


def evolve_both(robot, steps, seeds):
    versions = ["v0", "v5"]
    runners = [Runner(f"{robot}-{version}") for version in versions]
    return {v: [r.evolve(steps, s) for s in seeds] for v, r in zip(versions, runners)}


def compare(robot, genotypes, seed, episodes):
    runner = Runner(f"{robot}-v5")

    def mean_gait(genotype):
        gaits = [gait(runner.record(genotype, s)) for s in range(seed, seed + episodes)]
        return np.mean([list(each.values()) for each in gaits], axis=0)

    names = ["metres", "seconds", "speed", "standing", "grounded"]
    return {
        key: dict(zip(names, np.stack([mean_gait(row) for row in rows], axis=1)))
        for key, rows in genotypes.items()
    }


# %% step_by_step
# Loops over steps and joints, lists instead of arrays.
import itertools


def progress(distance, duration):
    return [(before - after) / duration for before, after in itertools.pairwise(distance)]


def alive_bonus(robot, height, pitch, touching):
    bonuses = []
    for h, p, t in zip(height, pitch, touching, strict=False):
        if robot == "Ant":
            standing = h > 0.26
        elif robot == "Humanoid":
            standing = h > 0.78
        elif robot == "HalfCheetah":
            standing = -1 < p < 1 and not t
        else:
            standing = h > 0.8 and -1 < p < 1
        bonuses.append(-1 if not standing else 2 if robot == "Humanoid" else 1)
    return bonuses


def electricity(robot, actions, speeds):
    costs = []
    for action, speed in zip(actions, speeds, strict=False):
        joints, cost = len(action), 0.0
        for a, s in zip(action, speed, strict=False):
            cost -= 2 * abs(a * s) / joints + 0.1 * a * a / joints
        costs.append(4.25 * cost if robot == "Humanoid" else cost)
    return costs


def joints_at_limit(positions):
    return [-0.1 * sum(1 for p in row if p > 0.99 or p < -0.99) for row in positions]


def components_v0(trajectory):
    robot = trajectory["robot"]
    names = ("height", "pitch", "touching")
    return {
        "electricity": electricity(robot, trajectory["actions"], trajectory["speeds"]),
        "alive": alive_bonus(robot, *(trajectory[name] for name in names)),
        "joints_at_limit": joints_at_limit(trajectory["positions"]),
        "progress": progress(trajectory["distance"], trajectory["duration"]),
    }


def reward_v5(trajectory):
    rewards = progress(trajectory["distance"], trajectory["duration"])
    limits = joints_at_limit(trajectory["positions"])
    for t in range(len(rewards)):
        if trajectory["robot"] == "HalfCheetah":
            rewards[t] += limits[t]
        if trajectory["robot"] == "Ant":
            squares = [a**2 for a in trajectory["actions"][t]]
            rewards[t] += 0.01 - 0.01 * sum(squares) / len(squares) + limits[t]
        if trajectory["robot"] == "Humanoid":
            beyond = sum(max(abs(p) - 1, 0) for p in trajectory["positions"][t])
            rewards[t] += 1 + limits[t] - 10 * beyond - 0.1 * trajectory["heading"][t] ** 2
    return rewards


def planar_v0(trajectory):
    alive, effort = [], []
    for h, p, action in zip(trajectory["height"], trajectory["pitch"], trajectory["actions"]):
        squares = sum(a**2 for a in action)
        if trajectory["robot"] == "PlanarHopper":
            alive.append(1 if h > 0.7 and -0.2 < p < 0.2 else 0)
            effort.append(-0.001 * squares)
        if trajectory["robot"] == "PlanarWalker2D":
            alive.append(1 if 0.8 < h < 2 and -1 < p < 1 else 0)
            effort.append(-0.001 * squares)
        if trajectory["robot"] == "PlanarHalfCheetah":
            alive.append(0)
            effort.append(-0.1 * squares)
    moved = progress(trajectory["distance"], trajectory["duration"])
    return {"effort": effort, "alive": alive, "progress": moved}


def gait(trajectory):
    parts = planar_v0(trajectory)
    alive = sum(each for each in parts["alive"] if each > 0)
    moved = sum(each for each in parts["progress"] if each > 0)
    steps = len(parts["alive"])
    seconds = steps * trajectory["duration"]
    metres = trajectory["distance"][0] - trajectory["distance"][-1]
    standing = 0.0
    if alive + moved:
        standing = alive / (alive + moved)
    grounded = sum(1 for feet in trajectory["feet"] if sum(feet) > 0) / steps
    return {
        "standing": standing,
        "grounded": grounded,
        "metres": metres,
        "seconds": seconds,
        "speed": metres / seconds,
    }


def evolve_both(robot, steps, seeds):
    found = {}
    for environment in (f"{robot}-v5", f"{robot}-v0"):
        rows = []
        for seed in seeds:
            rows.append(Runner(environment).evolve(steps=steps, seed=seed))
        found[environment[-2:]] = np.stack(rows)
    return found


def compare(robot, genotypes, seed, episodes):
    table = {}
    for name in genotypes:
        runner = Runner(robot + "-v5")
        table[name] = {"metres": [], "seconds": [], "speed": [], "standing": [], "grounded": []}
        for genotype in genotypes[name]:
            sums = dict.fromkeys(table[name], 0.0)
            for episode in range(episodes):
                for key, value in gait(runner.record(genotype, seed + episode)).items():
                    sums[key] += value / episodes
            for key, value in sums.items():
                table[name][key].append(value)
    return table


# %% tables
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


# %% single_precision_throughout
# Single precision from the first array on.
def progress(distance, duration):
    return -np.diff(np.asarray(distance, dtype=np.float64)).astype(np.float32) / duration


def electricity(robot, actions, speeds):
    actions, speeds = np.float32(actions), np.float32(speeds)
    cost = 2 * np.mean(np.abs(actions) * np.abs(speeds), axis=-1) + np.mean(actions**2, -1) / 10
    return (-4.25 if robot == "Humanoid" else -1) * cost


def joints_at_limit(positions):
    return np.float32(-0.1) * np.count_nonzero((positions < -0.99) | (positions > 0.99), axis=1)


# %% tables_of_dicts
# A table of lambdas for the bonus, sums with math.fsum, arrays from generators.
import math


def alive_bonus(robot, height, pitch, touching):
    stands = {
        "Ant": lambda h, p, t: h > 0.26,
        "Humanoid": lambda h, p, t: h > 0.78,
        "HalfCheetah": lambda h, p, t: -1 < p < 1 and not t,
    }.get(robot, lambda h, p, t: h > 0.8 and -1 < p < 1)
    pay = 2.0 if robot == "Humanoid" else 1.0
    rows = zip(height, pitch, touching, strict=True)
    return np.fromiter((pay if stands(*row) else -1.0 for row in rows), float)


def gait(trajectory):
    parts = planar_v0(trajectory)
    way = trajectory["distance"]
    length = np.shape(trajectory["actions"])[0]
    alive = math.fsum(x for x in parts["alive"] if x > 0)
    moved = math.fsum(x for x in parts["progress"] if x > 0)
    metres = float(-np.sum(np.diff(way)))
    seconds = float(length * trajectory["duration"])
    return {
        "grounded": np.count_nonzero(np.any(trajectory["feet"] > 0, axis=1)) / length,
        "standing": alive / (alive + moved) if alive or moved else 0,
        "speed": metres / seconds,
        "seconds": seconds,
        "metres": metres,
    }


# %% rewards_by_weights
# The reward of version 5 as a sum of terms, each with the robots that have it.
def reward_v5(trajectory):
    robot = trajectory["robot"]
    terms = [progress(trajectory["distance"], trajectory["duration"])]
    if robot not in {"Hopper", "Walker2D"}:
        terms.append(joints_at_limit(trajectory["positions"]))
    if robot == "Ant":
        terms.append(0.01 * (1 - np.square(trajectory["actions"]).mean(axis=1)))
    if robot == "Humanoid":
        away = np.abs(trajectory["positions"])
        terms += [1 - 10 * (away - np.minimum(away, 1)).sum(axis=1)]
        terms += [-0.1 * np.square(trajectory["heading"])]
    return np.sum(terms, axis=0)


def evolve_both(robot, steps, seeds):
    runners = {version: Runner(f"{robot}-{version}") for version in ("v5", "v0")}
    return {
        version: np.vstack([runner.evolve(steps, int(seed)) for seed in seeds])
        for version, runner in runners.items()
    }


def compare(robot, genotypes, seed, episodes):
    runner, names = Runner(f"{robot}-v5"), ("metres", "seconds", "speed", "standing", "grounded")
    table = {}
    for version in genotypes:
        cube = [
            [list(map(gait(runner.record(row, seed + e)).get, names)) for e in range(episodes)]
            for row in genotypes[version]
        ]
        table[version] = dict(zip(names, np.mean(cube, axis=1).T, strict=True))
    return table
