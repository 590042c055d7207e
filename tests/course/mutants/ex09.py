"""Wrong solutions of exercise 9; building.py describes how a case is written."""


# %% duration_of_pybullet loses 9.1
# All steps are thought to last as long as PyBullet's.
def progress(distance, duration):
    return (distance[:-1] - distance[1:]) / 0.0165


# %% fallen_get_nothing loses 9.1
# A fallen robot gets 0 instead of -1.
# says: The fallen get 0
_alive_bonus = alive_bonus


def alive_bonus(robot, height, pitch, touching):
    return np.maximum(_alive_bonus(robot, height, pitch, touching), 0)


# %% pitch_one_way loses 9.1
# A robot may lean back as far as it likes.
_alive_bonus = alive_bonus


def alive_bonus(robot, height, pitch, touching):
    return _alive_bonus(robot, height, np.maximum(pitch, 0), touching)


# %% progress_backwards loses 9.1
# Progress is positive when the robot goes away.
# says: sign: it is turned around
def progress(distance, duration):
    return (distance[1:] - distance[:-1]) / duration


# %% progress_in_metres loses 9.1
# The progress is not divided by the duration of a step.
# says: duration of a step is left out
def progress(distance, duration):
    return distance[:-1] - distance[1:]


# %% electricity_of_sums loses 9.2
# The costs of the joints are added up instead of averaged.
# says: a sum for a mean
_electricity = electricity


def electricity(robot, actions, speeds):
    return _electricity(robot, actions, speeds) * actions.shape[1]


# %% electricity_with_sign loses 9.2
# Braking is paid for: the absolute value is missing.
# says: Braking is paid for
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * (actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)


# %% humanoid_pays_like_others loses 9.2
# A Humanoid's electricity costs no more than that of others.
# says: Humanoid costs more
_electricity = electricity


def electricity(robot, actions, speeds):
    return _electricity("Hopper", actions, speeds)


# %% upper_limits_only loses 9.2
# Only joints at their upper limits are counted.
# says: lower limits count, too
def joints_at_limit(positions):
    return -0.1 * (positions > 0.99).sum(axis=1)


# %% components_with_the_sum loses 9.3
# The reward itself is returned as a further component.
# says: does not have: \['reward'\]
_components_v0 = components_v0


def components_v0(trajectory):
    parts = _components_v0(trajectory)
    return {**parts, "reward": sum(parts.values())}


# %% ant_gets_the_full_bonus loses 9.4
# An Ant gets 1 instead of 0.01 for every step.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    return _reward_v5(trajectory) + 0.99 * (trajectory["robot"] == "Ant")


# %% beyond_is_the_position loses 9.4
# A Humanoid pays for the whole position of a joint that is past its limit.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    size = np.abs(trajectory["positions"])
    more = np.where(size > 1, 1.0, 0.0).sum(axis=1)
    return _reward_v5(trajectory) - 10 * more * (trajectory["robot"] == "Humanoid")


# %% limits_for_all loses 9.4
# Hopper and Walker2D pay for joints at their limits too.
# says: cost this robot nothing
_reward_v5 = reward_v5


def reward_v5(trajectory):
    more = joints_at_limit(trajectory["positions"])
    return _reward_v5(trajectory) + more * (trajectory["robot"] in ("Hopper", "Walker2D"))


# %% divides_by_nothing loses 9.5
# It divides by 0 for a robot that earns nothing.
_gait = gait


def gait(trajectory):
    parts = planar_v0(trajectory)
    alive, moved = (np.maximum(parts[key], 0).sum() for key in ("alive", "progress"))
    return {**_gait(trajectory), "standing": float(alive / (alive + moved))}


# %% fallen_runners_pay loses 9.5
# Planar runners that have fallen get -1, as PyBullet's do.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    return {**parts, "alive": np.where(parts["alive"] > 0, 1.0, -1.0)}


# %% grounded_with_all_feet loses 9.5
# A walker counts as grounded only while both feet are down.
_gait = gait


def gait(trajectory):
    return {**_gait(trajectory), "grounded": float(trajectory["feet"].min(axis=1).mean())}


# %% mean_effort loses 9.5
# The effort is the mean over the joints instead of their sum.
# says: not their mean
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    return {**parts, "effort": parts["effort"] / trajectory["actions"].shape[1]}


# %% one_bonus_for_all_runners loses 9.5
# A Walker2D has fallen when a Hopper would have.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    if trajectory["robot"] == "PlanarWalker2D":
        parts = {**parts, "alive": _planar_v0({**trajectory, "robot": "PlanarHopper"})["alive"]}
    return parts


# %% standing_of_all_components loses 9.5
# The share of standing is taken of the whole reward, costs included.
_gait = gait


def gait(trajectory):
    parts = planar_v0(trajectory)
    total = sum(float(each.sum()) for each in parts.values())
    return {**_gait(trajectory), "standing": float(parts["alive"].sum()) / total}


# %% each_in_its_own_version loses 9.6
# Records each robot in the version whose name it has.
# -     runner, table = Runner(f"{robot}-v5"), {}
# +     table = {}
# -         means = []
# +         runner, means = Runner(f"{robot}-{version}"), []


# %% evolves_a_tenth loses 9.6
# Stops long before the budget is used up.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    return _evolve_both(robot, steps // 10, seeds)


# %% one_episode_for_all loses 9.6
# Plays the same episode over and over.
_compare = compare


def compare(robot, genotypes, seed, episodes):
    return _compare(robot, genotypes, seed, 1)


# %% one_mean_for_all_robots loses 9.6
# Takes the mean over the robots, too.
_compare = compare


def compare(robot, genotypes, seed, episodes):
    table = _compare(robot, genotypes, seed, episodes)
    for gaits in table.values():
        for name, values in gaits.items():
            gaits[name] = float(np.mean(values))
    return table


# %% one_replication_for_all loses 9.6
# Evolves every replication with the same seed.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    return _evolve_both(robot, steps, [seeds[0]] * len(seeds))


# %% recorded_in_version_0 loses 9.6
# Records all robots in version 0.
# -     runner, table = Runner(f"{robot}-v5"), {}
# +     table = {}
# -         means = []
# +         runner, means = Runner(f"{robot}-v0"), []


# %% versions_swapped loses 9.6
# Calls the robots of each version by the name of the other.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    pair = _evolve_both(robot, steps, seeds)
    return {"v0": pair["v5"], "v5": pair["v0"]}


# %% standing_at_the_limit loses 9.1
# A robot exactly at the lowest height counts as standing.
# -         return np.where(height > 0.26, 1.0, -1.0)
# +         return np.where(height >= 0.26, 1.0, -1.0)


# %% leaning_at_the_limit loses 9.1
# A pitch of exactly 1 counts as upright.
# -     upright = np.abs(pitch) < 1
# +     upright = np.abs(pitch) <= 1


# %% limits_include_099 loses 9.2
# A joint exactly at 0.99 counts as one at its limit.
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) >= 0.99).sum(axis=1)


# %% hopper_stands_at_07 loses 9.5
# A PlanarHopper exactly 0.7 m high counts as standing.
# -         alive = np.where((height > 0.7) & (np.abs(pitch) < 0.2), 1.0, 0.0)
# +         alive = np.where((height >= 0.7) & (np.abs(pitch) < 0.2), 1.0, 0.0)


# %% walker_stands_at_2 loses 9.5
# A PlanarWalker2D exactly 2 m high counts as standing.
# -         alive = np.where((height > 0.8) & (height < 2) & (np.abs(pitch) < 1), 1.0, 0.0)
# +         alive = np.where((height > 0.8) & (height <= 2) & (np.abs(pitch) < 1), 1.0, 0.0)


# %% net_progress loses 9.5
# Steps backwards are subtracted from the income: only positive steps are added up.
# -     alive, moved = (float(np.maximum(parts[key], 0).sum()) for key in ("alive", "progress"))
# +     alive, moved = (max(0.0, float(parts[key].sum())) for key in ("alive", "progress"))
