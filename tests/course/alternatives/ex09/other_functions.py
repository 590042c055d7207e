# Differences, einsum, selections and sums of booleans.
STEP = 0.0165


def progress(distance):
    return -np.diff(np.asarray(distance, dtype=np.float64)) / STEP


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
        "progress": progress(one["distance"]),
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


def gait(trajectory):
    parts = components_v0(trajectory)
    alive, moved = (parts[key][parts[key] > 0].sum() for key in ("alive", "progress"))
    seconds = STEP * trajectory["height"].size
    metres = STEP * parts["progress"].sum()
    standing = alive / (alive + moved) if alive or moved else 0.0
    return {"metres": metres, "seconds": seconds, "speed": metres / seconds, "standing": standing}


def evolve_both(robot, steps, seed):
    versions = ["v0", "v5"]
    runners = [Runner(f"{robot}BulletEnv-{version}") for version in versions]
    return dict(zip(versions, [runner.evolve(steps, seed) for runner in runners], strict=False))


def compare(robot, genotypes, seed, episodes):
    runner = Runner(f"{robot}BulletEnv-v5")

    def mean_gait(genotype):
        gaits = [gait(runner.record(genotype, s)) for s in range(seed, seed + episodes)]
        return {name: np.mean([each[name] for each in gaits]) for name in gaits[0]}

    return {key: mean_gait(genotype) for key, genotype in genotypes.items()}
