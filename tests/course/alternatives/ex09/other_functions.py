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
