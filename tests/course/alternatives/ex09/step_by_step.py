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
