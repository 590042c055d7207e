"""Wrong solutions of exercise 9; building.py describes how a case is written."""


# %% duration_of_pybullet loses 9.1
# Divides by 0.0165 s, the step of PyBullet's robots, whatever `duration` is, but `duration` should be used.
def progress(distance, duration):
    return (distance[:-1] - distance[1:]) / 0.0165


# %% fallen_get_nothing loses 9.1
# Gives a fallen robot 0, but -1 is asked for.
# says: this
_alive_bonus = alive_bonus


def alive_bonus(robot, height, pitch, touching):
    return np.maximum(_alive_bonus(robot, height, pitch, touching), 0)


# %% pitch_one_way loses 9.1
# Counts a pitch of -1 or less as upright, but abs(pitch) should be below 1.
_alive_bonus = alive_bonus


def alive_bonus(robot, height, pitch, touching):
    return _alive_bonus(robot, height, np.maximum(pitch, 0), touching)


# %% progress_backwards loses 9.1
# Gives a negative progress when the robot comes nearer, but it should be positive then.
# says: this
def progress(distance, duration):
    return (distance[1:] - distance[:-1]) / duration


# %% progress_in_metres loses 9.1
# Leaves out the division by the duration of a step, but metres per second are asked for.
# says: this
def progress(distance, duration):
    return distance[:-1] - distance[1:]


# %% electricity_of_sums loses 9.2
# Adds up the costs of the joints in each step, but their mean is asked for.
# says: this
_electricity = electricity


def electricity(robot, actions, speeds):
    return _electricity(robot, actions, speeds) * actions.shape[1]


# %% electricity_with_sign loses 9.2
# Takes the mean of action * speed with its sign, but |action * speed| of each joint should be taken first.
# says: this
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * (actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)


# %% humanoid_pays_like_others loses 9.2
# Charges a Humanoid as much as the other robots, but it should pay 4.25 times as much.
# says: this
_electricity = electricity


def electricity(robot, actions, speeds):
    return _electricity("Hopper", actions, speeds)


# %% upper_limits_only loses 9.2
# Counts only the joints above 0.99, but those below -0.99 are at their limits, too.
# says: this
def joints_at_limit(positions):
    return -0.1 * (positions > 0.99).sum(axis=1)


# %% components_with_the_sum loses 9.3
# Returns a further component, "reward", but only the four components are asked for.
# says: this
_components_v0 = components_v0


def components_v0(trajectory):
    parts = _components_v0(trajectory)
    return {**parts, "reward": sum(parts.values())}


# %% ant_gets_the_full_bonus loses 9.4
# Gives an Ant 1 in every step, but 0.01 is asked for.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    return _reward_v5(trajectory) + 0.99 * (trajectory["robot"] == "Ant")


# %% beyond_is_the_position loses 9.4
# Charges a Humanoid for the whole |position| of a joint past its limit, but only |position| - 1 should count.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    size = np.abs(trajectory["positions"])
    more = np.where(size > 1, 1.0, 0.0).sum(axis=1)
    return _reward_v5(trajectory) - 10 * more * (trajectory["robot"] == "Humanoid")


# %% limits_for_all loses 9.4
# Charges Hopper and Walker2D for joints at their limits, but their reward should be the progress alone.
# says: this
_reward_v5 = reward_v5


def reward_v5(trajectory):
    more = joints_at_limit(trajectory["positions"])
    return _reward_v5(trajectory) + more * (trajectory["robot"] in ("Hopper", "Walker2D"))


# %% divides_by_nothing loses 9.5
# Gives no number for "standing" when the robot earns nothing (as 0 / 0 does), but 0.0 is asked for.
_gait = gait


def gait(trajectory):
    parts = planar_v0(trajectory)
    alive, moved = (np.maximum(parts[key], 0).sum() for key in ("alive", "progress"))
    return {**_gait(trajectory), "standing": float(alive / (alive + moved))}


# %% fallen_runners_pay loses 9.5
# Gives -1 wherever the alive bonus should be 0: for a fallen planar runner, and for a PlanarHalfCheetah in every step.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    return {**parts, "alive": np.where(parts["alive"] > 0, 1.0, -1.0)}


# %% grounded_with_all_feet loses 9.5
# Counts a step for "grounded" only if all feet touch the ground, but at least one is enough.
_gait = gait


def gait(trajectory):
    return {**_gait(trajectory), "grounded": float(trajectory["feet"].min(axis=1).mean())}


# %% mean_effort loses 9.5
# Takes the mean over the joints for the effort, but their sum is asked for.
# says: this
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    return {**parts, "effort": parts["effort"] / trajectory["actions"].shape[1]}


# %% one_bonus_for_all_runners loses 9.5
# Judges a PlanarWalker2D by the limits of a PlanarHopper, but it has its own.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    if trajectory["robot"] == "PlanarWalker2D":
        parts = {**parts, "alive": _planar_v0({**trajectory, "robot": "PlanarHopper"})["alive"]}
    return parts


# %% standing_of_all_components loses 9.5
# Divides sum(alive) by the sum of the whole reward for "standing", but effort and steps backwards should be left out.
_gait = gait


def gait(trajectory):
    parts = planar_v0(trajectory)
    total = sum(float(each.sum()) for each in parts.values())
    return {**_gait(trajectory), "standing": float(parts["alive"].sum()) / total}


# %% each_in_its_own_version loses 9.6
# Records each robot in the version that its key names, but all of them should be recorded in version 5.
# -     runner, table = Runner(f"{robot}-v5"), {}
# +     table = {}
# -         means = []
# +         runner, means = Runner(f"{robot}-{version}"), []


# %% evolves_a_tenth loses 9.6
# Stops each evolution after about a tenth of `steps`, but all of them should be used.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    return _evolve_both(robot, steps // 10, seeds)


# %% one_episode_for_all loses 9.6
# Counts only the episode with the seed itself, once or several times, but the mean over the seeds seed, seed + 1, ... is asked for.
_compare = compare


def compare(robot, genotypes, seed, episodes):
    return _compare(robot, genotypes, seed, 1)


# %% one_mean_for_all_robots loses 9.6
# Gives one number, the mean over all robots of a version, but a number for each row is asked for.
_compare = compare


def compare(robot, genotypes, seed, episodes):
    table = _compare(robot, genotypes, seed, episodes)
    for gaits in table.values():
        for name, values in gaits.items():
            gaits[name] = float(np.mean(values))
    return table


# %% one_replication_for_all loses 9.6
# Evolves every robot with the first of the seeds, but each seed should have its own evolution.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    return _evolve_both(robot, steps, [seeds[0]] * len(seeds))


# %% recorded_in_version_0 loses 9.6
# Records all robots in version 0, but version 5 is asked for.
# -     runner, table = Runner(f"{robot}-v5"), {}
# +     table = {}
# -         means = []
# +         runner, means = Runner(f"{robot}-v0"), []


# %% versions_swapped loses 9.6
# Puts the robots that evolve in version 5 under "v0" and those of version 0 under "v5", but it should be the other way round.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    pair = _evolve_both(robot, steps, seeds)
    return {"v0": pair["v5"], "v5": pair["v0"]}


# %% standing_at_the_limit loses 9.1
# Counts an Ant exactly 0.26 m high as standing, but its height should be above 0.26.
# -         return np.where(height > 0.26, 1.0, -1.0)
# +         return np.where(height >= 0.26, 1.0, -1.0)


# %% leaning_at_the_limit loses 9.1
# Counts a pitch of exactly 1 or -1 as upright, but abs(pitch) should be below 1.
# -     upright = np.abs(pitch) < 1
# +     upright = np.abs(pitch) <= 1


# %% limits_include_099 loses 9.2
# Counts a joint exactly at 0.99 or -0.99 as at its limit, but only those above 0.99 or below -0.99 are.
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) >= 0.99).sum(axis=1)


# %% hopper_stands_at_07 loses 9.5
# Gives a PlanarHopper that is exactly 0.7 m high the bonus, but its height should be above 0.7.
# -         alive = np.where((height > 0.7) & (np.abs(pitch) < 0.2), 1.0, 0.0)
# +         alive = np.where((height >= 0.7) & (np.abs(pitch) < 0.2), 1.0, 0.0)


# %% walker_stands_at_2 loses 9.5
# Gives a PlanarWalker2D that is exactly 2 m high the bonus, but its height should be below 2.
# -         alive = np.where((height > 0.8) & (height < 2) & (np.abs(pitch) < 1), 1.0, 0.0)
# +         alive = np.where((height > 0.8) & (height <= 2) & (np.abs(pitch) < 1), 1.0, 0.0)


# %% net_progress loses 9.5
# Adds up all progress for "standing", steps backwards included (and takes 0 if the sum is negative), but only the steps forward should be added up.
# -     alive, moved = (float(np.maximum(parts[key], 0).sum()) for key in ("alive", "progress"))
# +     alive, moved = (max(0.0, float(parts[key].sum())) for key in ("alive", "progress"))


# %% every_robot_must_be_upright loses 9.1
# Counts an Ant or a Humanoid with |pitch| of 1 or more as fallen, but only their height should matter.
# says: this
# -         return np.where(height > 0.26, 1.0, -1.0)
# +         return np.where((height > 0.26) & (np.abs(pitch) < 1), 1.0, -1.0)
# -         return np.where(height > 0.78, 2.0, -1.0)
# +         return np.where((height > 0.78) & (np.abs(pitch) < 1), 2.0, -1.0)


# %% no_shin_on_the_floor loses 9.1
# Counts a Hopper or a Walker2D as fallen where `touching` is 1, but this should matter for a HalfCheetah only.
# says: this
# -     return np.where(upright & (height > 0.8), 1.0, -1.0)
# +     return np.where(upright & (height > 0.8) & (touching == 0), 1.0, -1.0)


# %% progress_without_direction loses 9.1
# Counts going away as much as coming nearer, but going away should be negative.
# says: this
# -     return (distance[:-1] - distance[1:]) / duration
# +     return np.abs(distance[:-1] - distance[1:]) / duration


# %% progress_since_the_start loses 9.1
# Measures the progress of each step from the start of the episode, but the distance just before the step should be used.
# says: this
# -     return (distance[:-1] - distance[1:]) / duration
# +     return (distance[0] - distance[1:]) / duration


# %% progress_overwrites_the_distances loses 9.1
# Changes the array `distance` that it is given, but a new array is asked for.
# says: in place
# -     return (distance[:-1] - distance[1:]) / duration
# +     distance /= duration
# +     return distance[:-1] - distance[1:]


# %% humanoid_pays_for_speed_alone loses 9.2
# Multiplies only the part with |action * speed| by 4.25 for a Humanoid, but the part with the squared action should be multiplied, too.
# says: this
# -     return -cost * (4.25 if robot == "Humanoid" else 1.0)
# +     more = 6.5 * np.abs(actions * speeds).mean(axis=1) if robot == "Humanoid" else 0.0
# +     return -cost - more


# %% one_joint_at_its_limit_is_enough loses 9.2
# Charges 0.1 if any joint is at its limit, but 0.1 for each such joint is asked for.
# says: this
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) > 0.99).any(axis=1)


# %% past_the_limit_is_free loses 9.2
# Leaves out joints past their limits, such as 1.2, but all joints above 0.99 or below -0.99 should count.
# says: this
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * ((np.abs(positions) > 0.99) & (np.abs(positions) <= 1)).sum(axis=1)


# %% effort_only_while_standing loses 9.3
# Sets the electricity to 0 where the robot has fallen, but it should cost the same then.
# -     robot = trajectory["robot"]
# -     return {
# +     robot = trajectory["robot"]
# +     stands = alive_bonus(
# +         robot, trajectory["height"], trajectory["pitch"], trajectory["touching"]
# +     ) > 0
# +     return {
# -         "electricity": electricity(robot, trajectory["actions"], trajectory["speeds"]),
# +         "electricity": stands
# +         * electricity(robot, trajectory["actions"], trajectory["speeds"]),


# %% takes_the_trajectory_apart loses 9.3
# Changes the dict `trajectory` that it is given, but it should stay as it is.
# -         "electricity": electricity(robot, trajectory["actions"], trajectory["speeds"]),
# +         "electricity": electricity(robot, trajectory.pop("actions"), trajectory["speeds"]),


# %% humanoid_is_paid_while_it_stands loses 9.4
# Gives a Humanoid its 1 only where its height is above 0.78, but 1 in every step is asked for.
# says: this
# -         reward = reward + 1 - 10 * beyond - 0.1 * trajectory["heading"] ** 2
# +         stands = trajectory["height"] > 0.78
# +         reward = reward + stands - 10 * beyond - 0.1 * trajectory["heading"] ** 2


# %% beyond_one_limit_only loses 9.4
# Counts only joints above 1 for beyond, but those below -1 are past their limits, too.
# says: this
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# +         beyond = np.maximum(positions - 1, 0).sum(axis=1)


# %% beyond_from_099 loses 9.4
# Lets beyond begin at 0.99, but max(0, |position| - 1) is asked for.
# says: this
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# +         beyond = np.maximum(np.abs(positions) - 0.99, 0).sum(axis=1)


# %% ant_pays_for_every_joint loses 9.4
# Takes the sum of an Ant's squared actions, but their mean is asked for.
# says: this
# -         reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).mean(axis=1)
# +         reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).sum(axis=1)


# %% walker_as_tall_as_it_likes loses 9.5
# Leaves out the highest height of a PlanarWalker2D, but only below 2 m should it get the bonus.
# says: this
# -         alive = np.where((height > 0.8) & (height < 2) & (np.abs(pitch) < 1), 1.0, 0.0)
# +         alive = np.where((height > 0.8) & (np.abs(pitch) < 1), 1.0, 0.0)


# %% cheetah_gets_a_bonus loses 9.5
# Gives a PlanarHalfCheetah an alive bonus of 1 in every step, but 0 is asked for.
# says: this
# -         price = 0.1
# +         price, alive = 0.1, np.ones(len(height))


# %% one_step_too_long loses 9.5
# Counts T + 1 steps for "seconds", but there are T: the start is not a step.
# says: this
# -     seconds = trajectory["duration"] * len(trajectory["height"])
# +     seconds = trajectory["duration"] * len(trajectory["distance"])


# %% nearest_point loses 9.5
# Measures "metres" to the nearest point of the way, but the end of the way is asked for.
# says: this
# -     metres = float(trajectory["distance"][0] - trajectory["distance"][-1])
# +     metres = float(trajectory["distance"][0] - trajectory["distance"].min())


# %% speed_without_direction loses 9.5
# Gives a robot that goes away a positive "speed", but it should be negative.
# says: this
# -         "speed": metres / seconds,
# +         "speed": abs(metres) / seconds,


# %% share_of_the_feet loses 9.5
# Takes the mean over the feet for "grounded", but the share of steps in which at least one foot touches the ground is asked for.
# says: this
# -         "grounded": float(trajectory["feet"].max(axis=1).mean()),
# +         "grounded": float(trajectory["feet"].mean()),


# %% standing_is_all_without_progress loses 9.5
# Gives 1.0 for "standing" when the robot earns nothing, but 0.0 is asked for.
# -         "standing": alive / (alive + moved) if alive + moved > 0 else 0.0,
# +         "standing": alive / (alive + moved) if moved > 0 else 1.0,


# %% only_two_versions loses 9.6
# Looks up the keys "v0" and "v5", but `genotypes` may have any keys, one or several.
# -     for version, rows in genotypes.items():
# -         means = []
# +     for version in ("v0", "v5"):
# +         rows, means = genotypes[version], []


# %% speed_of_the_means loses 9.6
# Divides the mean metres by the mean seconds for "speed", but the mean of the episodes' speeds is asked for.
# -         table[version] = dict(zip(gaits[0], np.array(means).T, strict=True))
# +         table[version] = dict(zip(gaits[0], np.array(means).T, strict=True))
# +         table[version]["speed"] = table[version]["metres"] / table[version]["seconds"]


# %% always_the_hopper loses 9.6
# Evolves a PlanarHopper, whatever `robot` is, but the robot that `robot` names is asked for.
# -         version: np.array([Runner(f"{robot}-{version}").evolve(steps, seed) for seed in seeds])
# +         version: np.array(
# +             [Runner(f"PlanarHopper-{version}").evolve(steps, seed) for seed in seeds]
# +         )


# %% other_seeds_for_version_5 loses 9.6
# Evolves in version 5 with the seeds plus 1, but both versions should have the same seeds.
# -         for version in ("v0", "v5")
# +         for version, seeds in (("v0", seeds), ("v5", [seed + 1 for seed in seeds]))


# %% seeds_counted_from_the_first loses 9.6
# Counts on from the first seed (seeds[0], seeds[0] + 1, ...), but the seeds of the list should be used.
# -         version: np.array([Runner(f"{robot}-{version}").evolve(steps, seed) for seed in seeds])
# +         version: np.array(
# +             [
# +                 Runner(f"{robot}-{version}").evolve(steps, seeds[0] + i)
# +                 for i in range(len(seeds))
# +             ]
# +         )


# %% progress_of_the_mean loses 9.1
# Takes the mean of each step's progress and that of the step before (0 before the first), but each step's own progress is asked for.
# -     return (distance[:-1] - distance[1:]) / duration
# +     change = (distance[:-1] - distance[1:]) / duration
# +     return np.convolve(change, [0.5, 0.5])[: len(change)]
# %% touching_or_leaning loses 9.1
# Counts a HalfCheetah as fallen only if it both leans too far and touches the floor, but one of the two is enough.
# -         return np.where(upright & (touching == 0), 1.0, -1.0)
# +         return np.where(upright | (touching == 0), 1.0, -1.0)
# %% once_fallen_always_fallen loses 9.1
# Counts a Hopper or a Walker2D that has fallen once as fallen in all later steps, but each step should be judged by itself.
# -     return np.where(upright & (height > 0.8), 1.0, -1.0)
# +     return np.where(np.logical_and.accumulate(upright & (height > 0.8)), 1.0, -1.0)
# %% electricity_of_the_mean loses 9.2
# Takes the mean over the joints before the absolute value, but |action * speed| of each joint should come first.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs((actions * speeds).mean(axis=1)) + 0.1 * (actions**2).mean(axis=1)
# %% limit_by_share loses 9.2
# Charges 0.1 times the share of the joints at their limits, but 0.1 for each of them is asked for.
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) > 0.99).mean(axis=1)
# %% speeds_for_positions loses 9.3
# Takes "speeds" instead of "positions" to see which joints are at their limits.
# -         "joints_at_limit": joints_at_limit(trajectory["positions"]),
# +         "joints_at_limit": joints_at_limit(trajectory["speeds"]),
# %% heading_not_squared loses 9.4
# Subtracts 0.1 * |heading| for a Humanoid, but 0.1 * heading^2 is asked for.
# -         reward = reward + 1 - 10 * beyond - 0.1 * trajectory["heading"] ** 2
# +         reward = reward + 1 - 10 * beyond - 0.1 * np.abs(trajectory["heading"])
# %% farthest_joint_only loses 9.4
# Counts only the joint that is farthest past its limit for beyond, but the sum over all joints is asked for.
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# +         beyond = np.maximum(np.abs(positions) - 1, 0).max(axis=1)
# %% ant_without_limits loses 9.4
# Leaves out joints at limit for an Ant, but they are part of its reward.
# -     if robot == "Ant":
# -         reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).mean(axis=1)
# +     if robot == "Ant":
# +         reward = reward - joints_at_limit(positions)
# +         reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).mean(axis=1)
# %% effort_of_absolute_actions loses 9.5
# Adds up |action| for the effort, but action^2 is asked for.
# -         "effort": -price * (trajectory["actions"] ** 2).sum(axis=1),
# +         "effort": -price * np.abs(trajectory["actions"]).sum(axis=1),
# %% cheap_cheetah loses 9.5
# Uses the factor 0.001 for the effort of a PlanarHalfCheetah, but 0.1 is asked for.
# -         price = 0.1
# +         price = 0.001
# %% share_of_standing_steps loses 9.5
# Gives the share of steps in which the robot stands for "standing", but the share of its income is asked for.
# -         "standing": alive / (alive + moved) if alive + moved > 0 else 0.0,
# +         "standing": float(np.mean(parts["alive"] > 0)),
# %% feet_of_the_first loses 9.5
# Looks only at the first foot for "grounded", but a step counts if at least one foot touches the ground.
# -         "grounded": float(trajectory["feet"].max(axis=1).mean()),
# +         "grounded": float(trajectory["feet"][:, 0].mean()),
# %% episodes_one_seed_late loses 9.6
# Plays the episodes with the seeds seed + 1, seed + 2, ..., but the first one should have the seed itself.
# -             gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
# +             gaits = [gait(runner.record(genotype, seed + 1 + i)) for i in range(episodes)]
# %% budget_shared loses 9.6
# Divides `steps` by the number of seeds, but each evolution should have all `steps`.
# -         version: np.array([Runner(f"{robot}-{version}").evolve(steps, seed) for seed in seeds])
# +         version: np.array(
# +             [Runner(f"{robot}-{version}").evolve(steps // len(seeds), seed) for seed in seeds]
# +         )


# %% steps_of_pybullet loses 9.3
# Uses 0.0165 s for a step, whatever the trajectory says, but its "duration" should be used.
# says: this
# -         "progress": progress(trajectory["distance"], trajectory["duration"]),
# -         "alive": alive_bonus(
# +         "progress": progress(trajectory["distance"], 0.0165),
# +         "alive": alive_bonus(


# %% evolved_once_for_each_robot loses 9.6
# Gives the robots of an earlier call with the same `robot` again, but steps and seeds should count in each call.
_evolve_both, _made = evolve_both, {}


def evolve_both(robot, steps, seeds):
    if robot not in _made:
        _made[robot] = _evolve_both(robot, steps, seeds)
    return _made[robot]


# %% rows_of_the_first_version loses 9.6
# Gives each key no more rows than the first key has, but all rows of each key are asked for.
# -         for genotype in rows:
# +         for genotype in rows[: len(next(iter(genotypes.values())))]:


# %% seeds_sorted loses 9.6
# Sorts the seeds and uses each only once, but a row for each seed of the list, in its order, is asked for.
# says: this
# -         version: np.array([Runner(f"{robot}-{version}").evolve(steps, seed) for seed in seeds])
# +         version: np.array(
# +             [Runner(f"{robot}-{version}").evolve(steps, seed) for seed in sorted(set(seeds))]
# +         )


# %% median_of_the_episodes loses 9.6
# Takes the median over the episodes, but the mean is asked for.
# says: this
# -             means.append([np.mean([each[name] for each in gaits]) for name in gaits[0]])
# +             means.append([np.median([each[name] for each in gaits]) for name in gaits[0]])


# %% seed_runs_on_from_row_to_row loses 9.6
# Goes on counting the seed from one robot to the next, but each robot should begin with the seed itself.
# says: this
# -             gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
# +             first = seed + episodes * len(means)
# +             gaits = [gait(runner.record(genotype, first + i)) for i in range(episodes)]


# %% the_effort_reduces_the_income loses 9.5
# Subtracts the effort from the income for "standing", but it should be left out.
# says: this
# -         "standing": alive / (alive + moved) if alive + moved > 0 else 0.0,
# +         "standing": alive / float(alive + moved + parts["effort"].sum())
# +         if alive + moved > 0
# +         else 0.0,


# %% square_of_the_mean_action loses 9.2
# Squares the mean of the actions, but the mean of the squared actions is asked for.
# says: this
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * actions.mean(axis=1) ** 2


# %% radians_for_tens loses 9.2
# Multiplies the mean of |action * speed| by 20, but 2 is asked for: the speeds should stay in units of 10 rad/s.
# says: this
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 20.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)


# %% limits_are_standing loses 9.1
# Counts a robot exactly at a limit as standing, but `>` and `<` are asked for, not `>=` and `<=`.
# says: this
def alive_bonus(robot, height, pitch, touching):
    if robot in ("Ant", "Humanoid"):
        up = height >= (0.26 if robot == "Ant" else 0.78)
    else:
        up = (np.abs(pitch) <= 1) & ((touching == 0) if robot == "HalfCheetah" else height >= 0.8)
    return np.where(up, 2.0 if robot == "Humanoid" else 1.0, -1.0)


# %% fallen_humanoid_pays_two loses 9.1
# Gives a fallen Humanoid -2, but -1 is asked for.
# says: this
# -         return np.where(height > 0.78, 2.0, -1.0)
# +         return np.where(height > 0.78, 2.0, -2.0)


# %% walker_as_an_ant loses 9.1
# Judges a Walker2D as an Ant, by height > 0.26 alone, but height > 0.8 and |pitch| < 1 are asked for.
# says: this
# -     if robot == "Ant":
# -         return np.where(height > 0.26, 1.0, -1.0)
# +     if robot in ("Ant", "Walker2D"):
# +         return np.where(height > 0.26, 1.0, -1.0)


# %% components_added_up loses 9.3
# Gives the sum of each component over the episode, but an array with a number for each step is asked for.
# says: this
_components_v0 = components_v0


def components_v0(trajectory):
    return {key: float(np.sum(values)) for key, values in _components_v0(trajectory).items()}


# %% pitch_for_height loses 9.3
# Exchanges height and pitch for the alive bonus, but alive_bonus takes height first.
# says: this
# -             robot, trajectory["height"], trajectory["pitch"], trajectory["touching"]
# +             robot, trajectory["pitch"], trajectory["height"], trajectory["touching"]


# %% mean_beyond_and_size_of_heading loses 9.4
# Takes the mean over the joints for beyond, and |heading|, but the sum over the joints and heading^2 are asked for.
# says: this
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# -         reward = reward + 1 - 10 * beyond - 0.1 * trajectory["heading"] ** 2
# +         beyond = np.maximum(np.abs(positions) - 1, 0).mean(axis=1)
# +         reward = reward + 1 - 10 * beyond - 0.1 * np.abs(trajectory["heading"])


# %% bonus_of_version_0 loses 9.4
# Gives a Humanoid 2 while it stands and -1 when it has fallen, but 1 in every step is asked for.
# says: this
# -         reward = reward + 1 - 10 * beyond - 0.1 * trajectory["heading"] ** 2
# +         alive = np.where(trajectory["height"] > 0.78, 2, -1)
# +         reward = reward + alive - 10 * beyond - 0.1 * trajectory["heading"] ** 2


# %% limits_subtracted loses 9.4
# Subtracts joints at limit, which is negative already, but it should be added.
# says: this
# -     reward = reward + joints_at_limit(positions)
# +     reward = reward - joints_at_limit(positions)


# %% limits_of_pybullet loses 9.5
# Judges planar runners by the limits of PyBullet's Hopper and Walker2D (height > 0.8, |pitch| < 1), but they have their own.
# says: this
_planar_v0 = planar_v0


def planar_v0(trajectory):
    robot, height, pitch = (trajectory[key] for key in ("robot", "height", "pitch"))
    up = (height > 0.8) & (np.abs(pitch) < 1) & (robot != "PlanarHalfCheetah")
    return {**_planar_v0(trajectory), "alive": up * 1.0}


# %% standing_by_moving loses 9.5
# Divides sum(alive) by sum(progress) for "standing", but it should be divided by the sum of both.
# says: this
# -         "standing": alive / (alive + moved) if alive + moved > 0 else 0.0,
# +         "standing": alive / moved if moved > 0 else 0.0,


# %% backwards_is_subtracted loses 9.5
# Subtracts steps backwards from the income for "standing", which may even become negative, but they should be left out.
# says: this
# -     alive, moved = (float(np.maximum(parts[key], 0).sum()) for key in ("alive", "progress"))
# +     alive, moved = (float(parts[key].sum()) for key in ("alive", "progress"))
# -         "standing": alive / (alive + moved) if alive + moved > 0 else 0.0,
# +         "standing": alive / (alive + moved) if alive + moved else 0.0,


# %% sums_over_the_episodes loses 9.6
# Gives the sums over the episodes, but their means are asked for.
# says: this
# -             means.append([np.mean([each[name] for each in gaits]) for name in gaits[0]])
# +             means.append([np.sum([each[name] for each in gaits]) for name in gaits[0]])


# %% means_over_the_rows loses 9.6
# Gives a number for each episode, the mean over the robots, but a number for each robot, the mean over its episodes, is asked for.
# says: this
# -         means = []
# -         for genotype in rows:
# -             gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
# +         means = []
# +         for i in range(episodes):
# +             gaits = [gait(runner.record(genotype, seed + i)) for genotype in rows]


# %% backwards_leaves_no_income loses 9.5
# Subtracts steps backwards from the income, and gives 0.0 for "standing" if the rest is not above 0, but they should be left out.
# says: this
# -     alive, moved = (float(np.maximum(parts[key], 0).sum()) for key in ("alive", "progress"))
# +     alive, moved = (float(parts[key].sum()) for key in ("alive", "progress"))


# %% electricity_by_time loses 9.3
# Multiplies the electricity by the duration of a step, but the duration should not matter for it.
# says: this
# -         "electricity": electricity(robot, trajectory["actions"], trajectory["speeds"]),
# +         "electricity": trajectory["duration"]
# +         * electricity(robot, trajectory["actions"], trajectory["speeds"]),


# %% recorded_as_hoppers loses 9.6
# Records all robots as PlanarHoppers, but the robot that `robot` names is asked for.
# -     runner, table = Runner(f"{robot}-v5"), {}
# +     runner, table = Runner("PlanarHopper-v5"), {}


# %% humanoid_pays_for_work_alone loses 9.3
# Multiplies only the part with |action * speed| by 4.25 for a Humanoid, but the part with the squared action should be multiplied, too.
# says: this
def components_v0(trajectory, _components=components_v0):
    parts = _components(trajectory)
    if trajectory["robot"] == "Humanoid":
        effort = 0.1 * (trajectory["actions"] ** 2).mean(axis=1)
        parts["electricity"] = parts["electricity"] + 3.25 * effort
    return parts


# %% components_kept loses 9.3
# Gives the components of an earlier trajectory of the same robot and length again, but each trajectory should have its own.
# says: stays from an earlier call
_components_v0, kept_components = components_v0, {}


def components_v0(trajectory):
    key = trajectory["robot"], len(trajectory["height"])
    return kept_components.setdefault(key, _components_v0(trajectory))


# %% feet_as_if_independent loses 9.5
# Computes "grounded" from the share of each foot as if the feet were independent, but steps with at least one foot down should be counted.
# says: this
# -         "grounded": float(trajectory["feet"].max(axis=1).mean()),
# +         "grounded": float(1 - np.prod(1 - trajectory["feet"].mean(axis=0))),


# %% whole_steps_left_out loses 9.5
# Leaves out the alive bonus of steps backwards, too, but only a component that is itself negative should be left out.
# says: this
# -     alive, moved = (float(np.maximum(parts[key], 0).sum()) for key in ("alive", "progress"))
# +     kept = (parts["alive"] >= 0) & (parts["progress"] >= 0)
# +     alive, moved = (float(parts[key][kept].sum()) for key in ("alive", "progress"))


# %% one_dict_for_both_versions loses 9.6
# Gives the gaits of the last key for every key, but each key should have its own.
# says: this
# -     runner, table = Runner(f"{robot}-v5"), {}
# +     runner, table, kept = Runner(f"{robot}-v5"), {}, {}
# -         table[version] = dict(zip(gaits[0], np.array(means).T, strict=True))
# +         kept.update(zip(gaits[0], np.array(means).T, strict=True))
# +         table[version] = kept


# %% an_ant_pays_like_a_humanoid loses 9.2
# Multiplies the cost of an Ant by 4.25, too, but only a Humanoid should pay 4.25 times as much.
# says: this
# -     return -cost * (4.25 if robot == "Humanoid" else 1.0)
# +     return -cost * (4.25 if robot in ("Ant", "Humanoid") else 1.0)


# %% limit_of_09 loses 9.2
# Counts joints at 0.97 or 0.99 as at their limits, but only those above 0.99 or below -0.99 are.
# says: this
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) > 0.9).sum(axis=1)


# %% price_by_distance loses 9.2
# Charges a joint for how far it is beyond 0.99, but each joint beyond it should cost 0.1.
# says: this
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * np.maximum(np.abs(positions) - 0.99, 0).sum(axis=1)


# %% hopper_has_a_highest_height loses 9.5
# Gives a PlanarHopper no bonus from a height of about 2 m on, but only a PlanarWalker2D has a highest height.
# says: this
# -         alive = np.where((height > 0.7) & (np.abs(pitch) < 0.2), 1.0, 0.0)
# +         alive = np.where((height > 0.7) & (height < 2) & (np.abs(pitch) < 0.2), 1.0, 0.0)


# %% square_of_the_sum loses 9.5
# Squares the sum of the actions for the effort, but the sum of their squares is asked for.
# says: this
# -         "effort": -price * (trajectory["actions"] ** 2).sum(axis=1),
# +         "effort": -price * trajectory["actions"].sum(axis=1) ** 2,


# %% metres_not_below_0 loses 9.5
# Gives 0 for the "metres" of a robot that goes away, but a negative number is asked for.
# says: this
# -     metres = float(trajectory["distance"][0] - trajectory["distance"][-1])
# +     metres = max(0.0, float(trajectory["distance"][0] - trajectory["distance"][-1]))


# %% ant_pays_like_a_humanoid_in_version_5 loses 9.4
# Adds 1 and subtracts beyond and heading for an Ant, too, but these terms belong to a Humanoid only.
# says: this
# -     if robot == "Humanoid":
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# +     if robot in ("Ant", "Humanoid"):
# +         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)


# %% share_of_the_foot_most_down loses 9.5
# Gives the share of the foot that is down most for "grounded", but the share of steps with at least one foot down is asked for.
# says: this
# -         "grounded": float(trajectory["feet"].max(axis=1).mean()),
# +         "grounded": float(trajectory["feet"].mean(axis=0).max()),


# %% walker_pays_for_joints loses 9.4
# Charges Walker2D for joints at their limits, but its reward should be the progress alone.
# says: this
# -     if robot in ("Hopper", "Walker2D"):
# +     if robot == "Hopper":


# %% only_around_one loses 9.2
# Counts joints at exactly 0.99, and leaves out those past their limits, such as 1.2, but all above 0.99 or below -0.99 should count, and no others.
# says: this
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * np.isclose(np.abs(positions), 1.0, atol=0.01).sum(axis=1)


# %% nothing_after_a_fall loses 9.3
# Sets all components to 0 after the first fall, except for a HalfCheetah, but steps after a fall should count like all others.
# says: this
def components_v0(trajectory):
    name = trajectory["robot"]
    alive = alive_bonus(name, trajectory["height"], trajectory["pitch"], trajectory["touching"])
    parts = {
        "progress": progress(trajectory["distance"], trajectory["duration"]),
        "alive": alive,
        "electricity": electricity(name, trajectory["actions"], trajectory["speeds"]),
        "joints_at_limit": joints_at_limit(trajectory["positions"]),
    }
    if name != "HalfCheetah":
        fallen = np.flatnonzero(alive < 0)
        if len(fallen):
            for part in parts.values():
                part[fallen[0] + 1 :] = 0.0
    return parts


# %% beyond_of_the_sum loses 9.4
# Compares the sum of all |position| with the number of joints for beyond, but max(0, |position| - 1) of each joint should be added up.
# says: this
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# +         beyond = np.maximum(np.abs(positions).sum(axis=1) - positions.shape[1], 0)


# %% one_touch_for_all_steps loses 9.1
# Gives a HalfCheetah -1 in every step, even while it stands, but each step should be judged by itself.
# says: this
# -         return np.where(upright & (touching == 0), 1.0, -1.0)
# +         return np.where(upright & (not touching.any()), 1.0, -1.0)


# %% only_the_outermost_joints loses 9.2
# Counts at most one joint above 0.99 and one below -0.99 in each step, but each joint at its limit should cost 0.1.
# says: this
def joints_at_limit(positions: np.ndarray) -> np.ndarray:
    costs = []
    for row in positions:
        cost = 0.0
        if row.min() < -0.99:
            cost -= 0.1
        if row.max() > 0.99:
            cost -= 0.1
        costs.append(cost)
    return np.array(costs)


# %% last_episode_counts_half loses 9.6
# Counts the last episode half, the one before it a quarter, and so on, but all episodes should count alike.
# says: this
import numpy as np


def compare(robot, genotypes, seed, episodes):
    world = Runner(robot + "-v5")
    result = {}
    for version, rows in genotypes.items():
        columns = {}
        for genotype in rows:
            mean = gait(world.record(genotype, seed))
            for other in range(seed + 1, seed + episodes):
                new = gait(world.record(genotype, other))
                mean = {name: (mean[name] + new[name]) / 2 for name in mean}
            for name, value in mean.items():
                columns.setdefault(name, []).append(value)
        result[version] = {name: np.array(values) for name, values in columns.items()}
    return result


# %% fallen_for_good loses 9.3
# Gives -1 in all steps after the first fall of a robot that is no HalfCheetah, but each step should be judged by itself.
# -         "alive": alive_bonus(
# -             robot, trajectory["height"], trajectory["pitch"], trajectory["touching"]
# -         ),
# +         "alive": fallen_for_good(trajectory),
def fallen_for_good(trajectory):
    robot = trajectory["robot"]
    alive = alive_bonus(robot, trajectory["height"], trajectory["pitch"], trajectory["touching"])
    fallen = np.maximum.accumulate(alive < 0)
    return alive if robot == "HalfCheetah" else np.where(fallen, -1.0, alive)


# %% progress_by_gradient loses 9.1
# Takes the mean way of two steps (as np.gradient does) for each step, but the difference of two neighbours is asked for.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return -np.gradient(distance)[1:] / duration


# %% progress_of_the_next_step loses 9.1
# Gives each step the progress of the step after it (and the last one 0), but each should have its own.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return np.append(distance[1:-1] - distance[2:], 0.0) / duration


# %% progress_of_the_step_before loses 9.1
# Gives each step the progress of the step before it (and the first one 0), but each should have its own.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return np.append(0.0, distance[:-2] - distance[1:-1]) / duration


# %% progress_by_roll loses 9.1
# Leaves out the first step, and takes the way from the end back to the start as the last one (as np.roll does).
# -     return (distance[:-1] - distance[1:]) / duration
# +     return (distance - np.roll(distance, -1))[1:] / duration


# %% divided_by_the_time_so_far loses 9.1
# Divides the way of a step by the time since the start, but the duration of a step is asked for.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return (distance[:-1] - distance[1:]) / (duration * np.arange(1, len(distance)))


# %% divided_by_the_whole_time loses 9.1
# Divides the way of a step by the duration of the episode, but that of a step is asked for.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return (distance[:-1] - distance[1:]) / (duration * (len(distance) - 1))


# %% mean_progress_for_all loses 9.1
# Gives each step the mean progress of all steps, but each should have its own.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return np.full(len(distance) - 1, (distance[0] - distance[-1]) / (len(distance) - 1)) / duration


# %% progress_to_the_end loses 9.1
# Measures the way of each step to the end of the episode, but the distance just after the step is asked for.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return (distance[:-1] - distance[-1]) / duration


# %% kilometres_per_hour loses 9.1
# Gives kilometres per hour instead of metres per second.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return 3.6 * (distance[:-1] - distance[1:]) / duration


# %% going_away_is_nothing loses 9.1
# Counts going away as 0, but it should be negative.
# -     return (distance[:-1] - distance[1:]) / duration
# +     return np.maximum(distance[:-1] - distance[1:], 0) / duration


# %% pitch_taken_for_degrees loses 9.1
# Compares the pitch with 1 degree, but it should be below 1 rad.
# -     upright = np.abs(pitch) < 1
# +     upright = np.abs(np.degrees(pitch)) < 1


# %% humanoid_like_a_hopper loses 9.1
# Compares a Humanoid's height with 0.8, but 0.78 is asked for.
# -         return np.where(height > 0.78, 2.0, -1.0)
# +         return np.where(height > 0.8, 2.0, -1.0)


# %% means_multiplied loses 9.2
# Multiplies the mean |action| by the mean |speed|, but action and speed should be multiplied joint by joint.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions).mean(axis=1) * np.abs(speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)


# %% work_squared loses 9.2
# Squares action * speed, but |action * speed| is asked for.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * ((actions * speeds) ** 2).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)


# %% work_as_a_root loses 9.2
# Takes the root of the mean square of action * speed, but the mean of |action * speed| is asked for.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.sqrt(((actions * speeds) ** 2).mean(axis=1)) + 0.1 * (actions**2).mean(axis=1)


# %% negative_work_is_free loses 9.2
# Counts negative work as 0, but |action * speed| should count.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.maximum(actions * speeds, 0).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)


# %% electricity_of_all_steps loses 9.2
# Takes the means over all steps, too, but only over the joints of each step is asked for.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions * speeds).mean() + 0.1 * (actions**2).mean() + 0 * actions[:, 0]


# %% size_of_the_actions loses 9.2
# Takes the mean |action| for the second part, but the mean squared action is asked for.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * np.abs(actions).mean(axis=1)


# %% root_of_the_actions loses 9.2
# Takes the root of the mean squared action, but the mean squared action itself is asked for.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * np.sqrt((actions**2).mean(axis=1))


# %% work_twice loses 9.2
# Takes |action * speed| for the second mean, too, but the mean squared action is asked for.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * np.abs(actions * speeds).mean(axis=1)


# %% six_joints_for_all loses 9.2
# Divides the sums over the joints by 6, however many joints there are.
# -     cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
# +     cost = 2.0 * np.abs(actions * speeds).sum(axis=1) / 6 + 0.1 * (actions**2).sum(axis=1) / 6


# %% humanoid_pays_for_actions_alone loses 9.2
# Multiplies only the part with the squared action by 4.25 for a Humanoid, but the part with |action * speed| should be multiplied, too.
# -     return -cost * (4.25 if robot == "Humanoid" else 1.0)
# +     more = 0.325 * (actions**2).mean(axis=1) if robot == "Humanoid" else 0.0
# +     return -cost - more


# %% limits_of_all_steps loses 9.2
# Counts the joints at their limits in all steps together, but each step should have its own number.
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return np.full(len(positions), -0.1 * (np.abs(positions) > 0.99).sum())


# %% positions_added_up loses 9.2
# Adds up the |position| of the joints at their limits, but 0.1 for each of them is asked for.
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) * (np.abs(positions) > 0.99)).sum(axis=1)


# %% limits_from_1 loses 9.2
# Counts joints only from |position| 1 on, but all beyond 0.99 are at their limits.
# -     return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
# +     return -0.1 * (np.abs(positions) >= 1).sum(axis=1)


# %% positions_for_speeds loses 9.3
# Takes "positions" instead of "speeds" for the electricity.
# -         "electricity": electricity(robot, trajectory["actions"], trajectory["speeds"]),
# +         "electricity": electricity(robot, trajectory["actions"], trajectory["positions"]),


# %% heading_for_pitch loses 9.3
# Takes "heading" instead of "pitch" for the alive bonus.
# -             robot, trajectory["height"], trajectory["pitch"], trajectory["touching"]
# +             robot, trajectory["height"], trajectory["heading"], trajectory["touching"]


# %% never_touching loses 9.3
# Leaves "touching" out of the alive bonus, but a HalfCheetah on shin or thigh has fallen.
# -             robot, trajectory["height"], trajectory["pitch"], trajectory["touching"]
# +             robot, trajectory["height"], trajectory["pitch"], 0 * trajectory["touching"]


# %% ends_at_the_fall loses 9.3
# Leaves out all steps after the first fall, but all T steps are asked for.
_components_v0 = components_v0


def components_v0(trajectory):
    parts = _components_v0(trajectory)
    fallen = parts["alive"] < 0
    end = int(np.argmax(fallen)) + 1 if fallen.any() else len(fallen)
    return {key: values[:end] for key, values in parts.items()}


# %% means_of_the_components loses 9.3
# Gives the mean of each component over the steps, but an array with a number for each step is asked for.
_components_v0 = components_v0


def components_v0(trajectory):
    return {key: float(np.mean(values)) for key, values in _components_v0(trajectory).items()}


# %% added_up_from_step_to_step loses 9.3
# Adds up each component from step to step, but each step should have its own number.
_components_v0 = components_v0


def components_v0(trajectory):
    return {key: np.cumsum(values) for key, values in _components_v0(trajectory).items()}


# %% paid_for_being_alive loses 9.4
# Adds the alive bonus of version 0, but version 5 has none.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    seen = [trajectory[key] for key in ("robot", "height", "pitch", "touching")]
    return _reward_v5(trajectory) + alive_bonus(*seen)


# %% electricity_in_version_5 loses 9.4
# Charges for electricity, but it costs nothing in version 5.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    given = [trajectory[key] for key in ("robot", "actions", "speeds")]
    return _reward_v5(trajectory) + electricity(*given)


# %% beyond_squared loses 9.4
# Squares max(0, |position| - 1) for beyond, but it should be added up as it is.
# -         beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
# +         beyond = (np.maximum(np.abs(positions) - 1, 0) ** 2).sum(axis=1)


# %% pitch_for_heading loses 9.4
# Takes the pitch instead of the heading for a Humanoid.
# -         reward = reward + 1 - 10 * beyond - 0.1 * trajectory["heading"] ** 2
# +         reward = reward + 1 - 10 * beyond - 0.1 * trajectory["pitch"] ** 2


# %% ant_squares_its_mean loses 9.4
# Squares an Ant's mean action, but the mean squared action is asked for.
# -         reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).mean(axis=1)
# +         reward = reward + 0.01 - 0.01 * trajectory["actions"].mean(axis=1) ** 2


# %% ant_pays_for_sizes loses 9.4
# Takes an Ant's mean |action|, but the mean squared action is asked for.
# -         reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).mean(axis=1)
# +         reward = reward + 0.01 - 0.01 * np.abs(trajectory["actions"]).mean(axis=1)


# %% once_fallen_never_paid loses 9.5
# Pays a planar runner that has fallen once no bonus in later steps, but each step should be judged by itself.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    return {**parts, "alive": np.minimum.accumulate(parts["alive"])}


# %% path_back_and_forth loses 9.5
# Adds up the way forth and back for "metres", but the first distance minus the last one is asked for.
# -     metres = float(trajectory["distance"][0] - trajectory["distance"][-1])
# +     metres = float(np.abs(np.diff(trajectory["distance"])).sum())
