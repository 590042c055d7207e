"""Wrong solutions of exercise 1; building.py describes how a case is written."""

# %% describe_first_choice loses 1.1
# Gives 0 as the first choice of every Discrete space, but space.start is asked for.
# says: this
_describe = describe


def describe(environment_id):
    description = _describe(environment_id)
    for space in (description["observation"], description["action"]):
        if space["kind"] == "Discrete":
            space["first"] = 0
    return description


# %% describe_known_only loses 1.1
# Gives the spaces and the time limit of CartPole-v1 for every environment except Pendulum-v1, but each environment has its own.
def describe(environment_id):
    box = lambda *limits: {  # noqa: E731
        "kind": "Box",
        "size": len(limits),
        "low": [-limit for limit in limits],
        "high": list(limits),
    }
    choice = {"kind": "Discrete", "choices": 2, "first": 0}
    inf = float("inf")
    if environment_id.startswith("Pendulum"):
        return {"observation": box(1.0, 1.0, 8.0), "action": box(2.0), "maxsteps": 200}
    cartpole = box(4.8, inf, 0.41887903, inf)
    return {"observation": cartpole, "action": choice, "maxsteps": 500}


# %% goes_on_after_the_end loses 1.2
# Goes on after a step that is truncated, but an episode should stop when it is terminated or truncated.
# says: this
def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    observations, actions, rewards = [observation], [], []
    terminated = truncated = False
    while len(actions) < min(maxsteps, 2000) and not terminated:
        action = env.action_space.sample()
        observation, reward, terminated, truncated, _ = env.step(action)
        observations.append(observation)
        actions.append(action)
        rewards.append(float(reward))
    return {
        "observations": np.array(observations),
        "actions": actions,
        "rewards": rewards,
        "terminated": terminated,
        "truncated": truncated,
    }


# %% maxsteps_is_truncation loses 1.2
# Sets truncated to True when only maxsteps has stopped the episode, but terminated and truncated should both be False then.
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    over = episode["terminated"] or len(episode["actions"]) == maxsteps
    return {**episode, "truncated": episode["truncated"] or (over and not episode["terminated"])}


# %% observation_of_reset_missing loses 1.2
# Leaves out the observation of the reset, but it should be the first one.
# says: this
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    return {**episode, "observations": episode["observations"][1:]}


# %% one_kind_of_end loses 1.2
# Sets terminated and truncated both to True when only one of them is, but each should be as the last step said.
# says: this
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    done = episode["terminated"] or episode["truncated"]
    return {**episode, "terminated": done, "truncated": done}


# %% unseeded_actions loses 1.2
# Does not seed the action space, so that each call draws other actions, but the seed should decide them.
# says: another answer: by chance
def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    observations, actions, rewards = [observation], [], []
    terminated = truncated = False
    while len(actions) < maxsteps and not (terminated or truncated):
        action = env.action_space.sample()
        observation, reward, terminated, truncated, _ = env.step(action)
        observations.append(observation)
        actions.append(action)
        rewards.append(float(reward))
    return {
        "observations": np.array(observations),
        "actions": actions,
        "rewards": rewards,
        "terminated": terminated,
        "truncated": truncated,
    }


# %% always_one loses 1.3
# Gives the reward 1 in every state, but 0 is asked for where fallen is True.
def cartpole_reward(observation, action):
    return 1.0


# %% limits_of_the_space loses 1.3
# Uses limits that are too large, such as those of the observation space (4.8 metres and 24 degrees), but 2.4 metres and 12 degrees are asked for.
# says: this
def fallen(observation):
    return bool(abs(observation[0]) > 4.8 or abs(observation[2]) > 0.4189)


# %% one_side_only loses 1.3
# Finds a fall on the right side only, but a position below -2.4 metres or an angle below -12 degrees counts, too.
def fallen(observation):
    return bool(observation[0] > 2.4 or observation[2] > np.deg2rad(12))


# %% asks_gymnasium loses 1.3, 1.4
# Lets Gymnasium's environment do the step and passes its reward on, but your own code should compute the reward.
def cartpole_reward(observation, action):
    env = gymnasium.make("CartPole-v1").unwrapped
    env.reset(seed=1)
    env.state = np.array(observation, dtype=float)
    env.steps_beyond_terminated = 0 if fallen(observation) else None
    return 0.0 if fallen(observation) else env.step(int(action))[1]


def pendulum_reward(observation, action):
    env = gymnasium.make("Pendulum-v1").unwrapped
    env.reset(seed=1)
    env.state = np.array([np.arctan2(observation[1], observation[0]), observation[2]])
    return float(env.step(action)[1])


# %% arctan_of_the_quotient loses 1.4
# Divides the sine by the cosine, which fails where the cosine is 0, and finds half of the circle only. np.arctan2(sine, cosine) gives every angle.
# says: this
def pendulum_reward(observation, action):
    cosine, sine, speed = (float(value) for value in observation)
    torque = np.clip(float(action[0]), -2.0, 2.0)
    return float(-(np.arctan(sine / cosine) ** 2 + 0.1 * speed**2 + 0.001 * torque**2))


# %% torque_not_cut loses 1.4
# Uses the torque as it is given, but it should first be cut to the range from -2 to 2.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * float(action[0]) ** 2))


# %% angle_only loses 1.5
# Looks at the sign of the angle alone, so that the pole swings to the other side and falls; the speed of the angle should count, too.
def balance(observation):
    return int(observation[2] > 0)


# %% speed_only loses 1.5
# Looks at the sign of the angle's speed alone, so that the pole stays leaning and falls in the end; the angle should count, too.
def balance(observation):
    return int(observation[3] > 0)


# %% deviation_divides_by_n loses 1.6
# Divides by the number of episodes in the standard deviation, but the number of episodes minus one is asked for.
# says: this
_compare = compare


def compare(environment_ids, episodes, seed):
    shrink = ((episodes - 1) / episodes) ** 0.5
    return [
        {**row, "deviation": row["deviation"] * shrink}
        for row in _compare(environment_ids, episodes, seed)
    ]


# %% mean_reward_of_a_step loses 1.6
# Gives the mean reward of a step, but the mean return of an episode is asked for.
# says: this
_compare = compare


def compare(environment_ids, episodes, seed):
    return [
        {**row, "mean": row["mean"] / row["length"]}
        for row in _compare(environment_ids, episodes, seed)
    ]


# %% same_episode_again loses 1.6
# Uses only the episode with seed itself, once or several times, but episode i should have seed + i.
_compare = compare


def compare(environment_ids, episodes, seed):
    table = []
    for row in _compare(environment_ids, 1, seed):
        table.append({**row, "deviation": 0.0})
    return table


# %% last_step_does_not_count loses 1.2
# Sets both ends to False whenever an episode has maxsteps steps, but its last step may have ended it: then one is True.
# says: this
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    if len(episode["actions"]) == maxsteps:
        episode |= {"terminated": False, "truncated": False}
    return episode


# %% over_at_the_limit loses 1.3
# Returns True where the cart is exactly 2.4 metres from the middle, but only more than that is a fall.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) >= 2.4 or abs(angle) >= np.deg2rad(12))


# %% keeps_pushing loses 1.5
# Repeats the action of the call before while the pole hardly moves, but the action must depend on the observation alone.
# says: must depend on the observation alone
_pushed = [0]


def balance(observation):
    lean = observation[2] + 0.5 * observation[3]
    if abs(lean) > 0.02:
        _pushed[0] = int(lean > 0)
    return _pushed[0]


# %% tosses_a_coin loses 1.5
# Draws a random action while the pole hardly moves, but the action must depend on the observation alone.
# says: must depend on the observation alone
_coin = np.random.default_rng()


def balance(observation):
    lean = observation[2] + 0.5 * observation[3]
    return int(lean > 0) if abs(lean) > 0.05 else int(_coin.integers(2))


# %% one_row_for_a_name loses 1.6
# Makes a single row for an environment that is given twice, but a row for each name in the list is asked for.
# says: this
_compare = compare


def compare(environment_ids, episodes, seed):
    return list(
        {row["environment"]: row for row in _compare(environment_ids, episodes, seed)}.values()
    )


# %% five_hundred_steps_at_most loses 1.6
# Stops episodes after 500 steps, but they should go on until they are terminated or truncated.
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 500) for i in range(episodes)]


# %% zero_is_no_seed loses 1.2
# Plays without a seed when the seed is 0, but 0 is a seed like any other.
# -     observation, _ = env.reset(seed=seed)
# -     env.action_space.seed(seed)
# +     observation, _ = env.reset(seed=seed or None)
# +     env.action_space.seed(seed or None)


# %% thousand_steps_at_most loses 1.6
# Stops episodes after 1000 steps, but they should go on until they are terminated or truncated.
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 1000) for i in range(episodes)]


# %% hanging_is_upright loses 1.4
# Takes the angle 0 for a rod that hangs straight down (as np.arccos(cosine) * np.sign(sine) does), but the angle should be pi there.
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arccos(np.clip(cosine, -1, 1)) * np.sign(sine)


# %% arctan_corrected loses 1.4
# Divides by the cosine, which fails where the cosine is 0: np.arctan2(sine, cosine) needs no division.
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arctan(sine / cosine)
# +     if cosine < 0:
# +         angle += np.pi if sine >= 0 else -np.pi


# %% twelve_degrees_is_too_much loses 1.3
# Returns True at exactly 12 degrees, but only an angle beyond 12 degrees is a fall.
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) >= 12 * 2 * np.pi / 360)


# %% one_minus_zero loses 1.3
# Finds a fall only beyond 12.5 degrees (as a comparison of rounded degrees does), but everything beyond 12 degrees is one.
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or round(np.rad2deg(abs(angle))) > 12)


# %% remembers_an_environment loses 1.6
# Gives the row that an earlier call has found for the same environment, but each call should play its own episodes.
_compare, _rows = compare, {}


def compare(environment_ids, episodes, seed):
    for name in environment_ids:
        if name not in _rows:
            (_rows[name],) = _compare([name], episodes, seed)
    return [_rows[name] for name in environment_ids]


# %% table_grows loses 1.6
# Adds its rows to those of the calls before, but each call should return a table of its own.
_compare = compare


def compare(environment_ids, episodes, seed, table=[]):  # noqa: B006
    table += _compare(environment_ids, episodes, seed)
    return table


# %% torque_cut_at_the_top_only loses 1.4
# Cuts torques above 2, but not those below -2, which should be cut to -2.
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = min(float(action[0]), 2.0)


# %% median_return loses 1.6
# Gives the median of the returns, but their mean is asked for.
# -                 "mean": float(np.mean(returns)),
# +                 "mean": float(np.median(returns)),


# %% steps_of_the_last_episode loses 1.6
# Gives the length of the last episode, but the mean length is asked for.
# -                 "length": float(np.mean([len(run["rewards"]) for run in runs])),
# +                 "length": float(len(runs[-1]["rewards"])),


# %% last_choice loses 1.1
# Gives space.n + space.start as the number of choices, but space.n is asked for.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             return {"kind": "Discrete", "choices": int(space.start + space.n), "first": int(space.start)}


# %% reset_twice loses 1.2
# Resets the environment a second time, without the seed, but a single env.reset(seed=seed) is asked for.
# -     env.action_space.seed(seed)
# +     env.action_space.seed(seed)
# +     observation, _ = env.reset()


# %% whole_rewards loses 1.2
# Cuts the rewards to whole numbers, but they should be kept as they are.
# says: this
# -         rewards.append(float(reward))
# +         rewards.append(int(reward))


# %% terminated_wins loses 1.2
# Sets truncated to False when the last step says that both are True, but then both should be True.
# says: this
# -         "truncated": bool(truncated),
# +         "truncated": bool(truncated and not terminated),


# %% degrees_for_radians loses 1.3
# Never finds that the pole leans too far: the angle is left out, or it is compared with 12. It is in radians, and 12 degrees are 0.2094 radians.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) > 12)


# %% rounded_limit loses 1.3
# Takes a rounded number, such as 0.21 radians, for 12 degrees, but the limit should be exactly 12 degrees.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) > 0.21)


# %% over_at_the_limit_for_the_reward loses 1.3
# Gives 0 where the cart is exactly 2.4 metres away, but the reward should be 1 as long as no limit is exceeded.
# says: this
# -     return 0.0 if fallen(observation) else 1.0
# +     return 1.0 if abs(observation[0]) < 2.4 and abs(observation[2]) < np.deg2rad(12) else 0.0


# %% pole_alone_pays loses 1.3
# Gives 1 while the pole is up, wherever the cart is, but 0 is asked for where the cart is beyond 2.4 metres.
# says: this
# -     return 0.0 if fallen(observation) else 1.0
# +     return 1.0 if abs(observation[2]) <= np.deg2rad(12) else 0.0


# %% costs_swapped loses 1.4
# Exchanges the factors of speed and torque: 0.1 should be that of the speed, 0.001 that of the torque.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.001 * speed**2 + 0.1 * torque**2))


# %% arcsine loses 1.4
# Finds only angles between -90 and 90 degrees, as np.arcsin(sine) or np.arctan(sine / cosine) give them; np.arctan2(sine, cosine) gives every angle.
# says: this
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arcsin(sine)


# %% cut_after_the_square loses 1.4
# Cuts the square of the torque at 2, but the torque itself should be cut, before it is squared.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     effort = np.clip(float(action[0]) ** 2, -2.0, 2.0)
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * effort))


# %% half_circle_only loses 1.4
# Counts the angle from 0 to 2 pi, but it should lie between -pi and pi.
# says: this
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arctan2(sine, cosine) % (2 * np.pi)


# %% refuses_large_torques loses 1.4
# Counts a torque beyond the limits as 0, but it should be cut to -2 or 2.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = float(action[0]) if abs(action[0]) <= 2 else 0.0


# %% alternates loses 1.5
# Pushes left and right in turn, but the observation should decide.
# says: depend on the observation alone
_turn = [0]


def balance(observation):
    _turn[0] = 1 - _turn[0]
    return _turn[0]


# %% lean_and_speed_both loses 1.5
# Pushes to the right only if the angle and its speed are both above 0, but where their signs differ, the stronger of the two should decide.
# says: this
# -     return int(angle + 0.5 * speed > 0)
# +     return int(angle > 0 and speed > 0)


# %% seed_runs_on loses 1.6
# Goes on counting the seeds from one environment to the next, but each environment should begin with seed again.
# says: this
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         seed += episodes


# %% error_of_the_mean loses 1.6
# Divides the standard deviation by the root of the number of episodes, but the standard deviation itself is asked for.
# says: this
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std(returns, ddof=1) / episodes**0.5) if episodes > 1 else 0.0,


# %% length_rounded_down loses 1.6
# Rounds the mean length down to a whole number (as // does), but its fraction should stay.
# says: this
# -                 "length": float(np.mean([len(run["rewards"]) for run in runs])),
# +                 "length": float(sum(len(run["rewards"]) for run in runs) // episodes),


# %% two_decimals loses 1.6
# Rounds the mean to two decimals, but the exact mean is asked for.
# says: this
# -                 "mean": float(np.mean(returns)),
# +                 "mean": round(float(np.mean(returns)), 2),


# %% dimensions_for_the_size loses 1.1
# Gives every Box the size 1 (its number of dimensions), but how many numbers it holds is asked for.
# says: this
# -         return {"kind": "Box", "size": len(low), "low": low, "high": high}
# +         return {"kind": "Box", "size": space.low.ndim, "low": low, "high": high}


# %% seeds_before_each_sample loses 1.2
# Uses the first action in every step: the action space is seeded again and again, or sampled only once. Seed it once, and sample in each step.
# says: this
# -     env.action_space.seed(seed)
# -     observations, actions, rewards = [observation], [], []
# +     observations, actions, rewards = [observation], [], []
# -         action = env.action_space.sample()
# +         env.action_space.seed(seed)
# +         action = env.action_space.sample()


# %% observations_for_steps loses 1.6
# Counts the observations of an episode as its length, but the number of steps, which is one less, is asked for.
# says: this
# -                 "length": float(np.mean([len(run["rewards"]) for run in runs])),
# +                 "length": float(np.mean([len(run["observations"]) for run in runs])),


# %% rows_add_up loses 1.6
# Counts the episodes of the environments before in each row, too, but a row should be about its own environment alone.
# says: this
# -     table = []
# +     table, runs = [], []
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs += [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std(returns, ddof=1)) if len(runs) > 1 else 0.0,


# %% torque_without_square loses 1.4
# Takes the absolute value of the torque instead of its square.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * abs(torque)))


# %% symmetric_limits loses 1.1
# Gives minus the upper limits as the lower ones, but space.low is asked for.
# says: this
# -         low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
# +         high = space.high.ravel().tolist()
# +         low = [-value for value in high]


# %% observed_before_the_step loses 1.2
# Keeps the observation from before each step instead of the one after it, so that the first comes twice and the last is missing.
# says: this
# -         observation, reward, terminated, truncated, _ = env.step(action)
# -         observations.append(observation)
# +         observations.append(observation)
# +         observation, reward, terminated, truncated, _ = env.step(action)


# %% speed_for_the_angle loses 1.3
# Compares the angle's speed, observation[3], with 12 degrees, but the angle, observation[2], is asked for.
# says: this
# -     position, _, angle, _ = observation
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     position, _, _, angle = observation
# +     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))


# %% limits_with_two_places loses 1.1
# Rounds the limits to two decimals, but they should be given as they are.
# says: this
# -         low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
# +         low, high = np.round([space.low.ravel(), space.high.ravel()], 2).tolist()


# %% limits_of_the_observations loses 1.1
# Gives the limits of the observations for the actions, too, but the action space has limits of its own.
# says: this
_describe = describe


def describe(environment_id):
    description = _describe(environment_id)
    observed, acted = description["observation"], description["action"]
    if observed["kind"] == acted["kind"] == "Box":
        acted |= {side: (observed[side] * 9)[: acted["size"]] for side in ("low", "high")}
    return description


# %% fall_costs_its_step loses 1.3
# Gives 0 for the step in which the pole falls, but a step that begins with the pole up should give 1.
# says: this
# -     return 0.0 if fallen(observation) else 1.0
# +     position, speed, angle, turning = observation
# +     ahead = np.array([position + 0.02 * speed, speed, angle + 0.02 * turning, turning])
# +     return 0.0 if fallen(ahead) else 1.0


# %% speed_after_the_step loses 1.4
# Uses the speed at the end of the step, but the speed at its beginning counts.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     speed = np.clip(speed + 0.05 * (15 * np.sin(angle) + 3 * torque), -8, 8)
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))


# %% state_after_the_step loses 1.4
# Uses the angle and the speed at the end of the step, but those at its beginning count.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     speed = np.clip(speed + 0.05 * (15 * np.sin(angle) + 3 * torque), -8, 8)
# +     angle = (angle + 0.05 * speed + np.pi) % (2 * np.pi) - np.pi
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))


# %% cut_at_one loses 1.4
# Cuts the torque to the range from -1 to 1, but it should be cut to the range from -2 to 2.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = np.clip(float(action[0]), -1.0, 1.0)


# %% speed_of_the_cart loses 1.5
# Uses the speed of the cart, observation[1], where the speed of the angle, observation[3], is needed.
# says: this
# -     _, _, angle, speed = observation
# +     _, speed, angle, _ = observation


# %% factor_of_the_speed_squared loses 1.4
# Squares the factor of the speed, too: 0.01 times the square of the speed counts, but 0.1 times is asked for.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + (0.1 * speed) ** 2 + 0.001 * torque**2))


# %% deviation_of_the_lengths loses 1.6
# Gives the standard deviation of the lengths, but that of the returns is asked for.
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std([len(run["rewards"]) for run in runs], ddof=1)) if episodes > 1 else 0.0,


# %% whole_degrees loses 1.3
# Finds a fall only from 13 degrees on (as int(np.rad2deg(angle)) > 12 does), but everything beyond 12 degrees is one.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or int(np.rad2deg(abs(angle))) > 12)


# %% choices_without_the_first loses 1.1
# Gives space.n - space.start as the number of choices, but space.n is asked for.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             return {
# +                 "kind": "Discrete",
# +                 "choices": int(space.n) - int(space.start),
# +                 "first": int(space.start),
# +             }


# %% rows_after_the_end loses 1.2
# Leaves rows of zeros in observations when the episode ends before maxsteps, but only steps + 1 rows are asked for.
# says: this
_random_episode_1 = random_episode


def random_episode(environment_id, seed, maxsteps=1000):
    found = _random_episode_1(environment_id, seed, maxsteps)
    seen = found["observations"]
    rows = np.zeros((maxsteps + 1 - len(seen), *seen.shape[1:]))
    return {**found, "observations": np.concatenate([seen, rows])}


# %% two_hundred_steps_at_most loses 1.6
# Stops episodes after 200 steps, but they should go on until they are terminated or truncated.
# says: this
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 200) for i in range(episodes)]


# %% rewards_of_all_steps loses 1.6
# Uses the rewards of single steps where the returns of whole episodes are asked for.
# says: this
# -         returns = [sum(run["rewards"]) for run in runs]
# +         returns = [reward for run in runs for reward in run["rewards"]]


# %% last_reward_for_the_return loses 1.6
# Takes the last reward of an episode as its return, but the return is the sum of all its rewards.
# says: this
# -         returns = [sum(run["rewards"]) for run in runs]
# +         returns = [run["rewards"][-1] for run in runs]


# %% mean_divided_by_n_minus_one loses 1.6
# Divides by the number of episodes minus one in the mean, too, but the mean should be divided by the number of episodes.
# says: this
# -                 "mean": float(np.mean(returns)),
# +                 "mean": float(np.sum(returns) / max(1, episodes - 1)),


# %% range_of_the_returns loses 1.6
# Gives the difference between the largest and the smallest return, but the standard deviation is asked for.
# says: this
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(max(returns) - min(returns)),


# %% first_episode_left_out loses 1.6
# Leaves out the episode with seed itself, but it should be the first one.
# says: this
_compare = compare


def compare(environment_ids, episodes, seed):
    fewer = max(1, episodes - 1)
    return _compare(environment_ids, fewer, seed + (episodes > 1))


# %% divides_by_zero_for_one_episode loses 1.6
# Gives NaN as the deviation of a single episode (a division by 0), but 0 is asked for.
# says: this
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std(returns, ddof=1)),


# %% size_of_the_speed loses 1.4
# Takes the absolute value of the angle's speed instead of its square.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.1 * abs(speed) + 0.001 * torque**2))


# %% size_of_the_angle loses 1.4
# Takes the absolute value of the angle instead of its square.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(abs(angle) + 0.1 * speed**2 + 0.001 * torque**2))


# %% torque_through_tanh loses 1.4
# Puts the torque through tanh instead of cutting it off at -2 and 2.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = 2 * np.tanh(float(action[0]))


# %% torque_in_shares_of_the_limit loses 1.4
# Cuts the torque to the range from -1 to 1 and then doubles it, but it should only be cut, to the range from -2 to 2.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = 2 * np.clip(float(action[0]), -1.0, 1.0)


# %% fall_costs_one loses 1.3
# Gives -1 after the fall, but 0 is asked for.
# says: this
# -     return 0.0 if fallen(observation) else 1.0
# +     return -1.0 if fallen(observation) else 1.0


# %% leaning_or_turning loses 1.5
# Pushes to the right as soon as the angle or its speed is above 0, but where their signs differ, the stronger of the two should decide.
# says: this
# -     return int(angle + 0.5 * speed > 0)
# +     return int(angle > 0 or speed > 0)


# %% two_samples_for_an_action loses 1.2
# Draws two actions in each step and uses the second one, but one sample() for each step is asked for.
# says: this
# -         action = env.action_space.sample()
# +         env.action_space.sample()
# +         action = env.action_space.sample()


# %% action_seed_plus_one loses 1.2
# Seeds the action space with seed + 1, but seed itself is asked for.
# says: this
# -     env.action_space.seed(seed)
# +     env.action_space.seed(seed + 1)


# %% last_step_left_out loses 1.2
# Leaves out the step that ends the episode, but its observation, action and reward should be kept.
# says: this
# -         observations.append(observation)
# -         actions.append(action)
# -         rewards.append(float(reward))
# +         if terminated or truncated:
# +             break
# +         observations.append(observation)
# +         actions.append(action)
# +         rewards.append(float(reward))


# %% thousand_for_no_limit loses 1.1
# Gives 1000 steps for an environment without a time limit, but None is asked for.
# -         "maxsteps": env.spec.max_episode_steps,
# +         "maxsteps": env.spec.max_episode_steps or 1000,


# %% last_choice_for_the_first loses 1.1
# Gives the last choice of a Discrete space as the first, but space.start is asked for.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             last = int(space.start + space.n - 1)
# +             return {"kind": "Discrete", "choices": int(space.n), "first": last}


# %% limit_of_what_is_observed loses 1.3
# Takes 24 degrees, the limit in the observation space, as the limit of the angle, but 12 degrees are asked for.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(24))


# %% end_of_a_range loses 1.1
# Gives len(range(space.start, space.n)) as the number of choices, but space.n is asked for.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             first = int(space.start)
# +             return {"kind": "Discrete", "choices": len(range(first, space.n)), "first": first}


# %% no_infinite_limits loses 1.1
# Replaces infinite limits by large numbers (as np.nan_to_num does), but they should stay infinite.
# says: this
# -         low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
# +         low, high = (np.nan_to_num(limits.ravel()).tolist() for limits in (space.low, space.high))


# %% square_of_the_mean_once loses 1.6
# Subtracts the square of the mean only once from the sum of the squared returns, but it should be subtracted once for each episode.
# says: this
def compare(environment_ids, episodes, seed):
    def play(name):
        total = squares = steps = 0.0
        for i in range(episodes):
            rewards = random_episode(name, seed + i, 10**6)["rewards"]
            gained = sum(rewards)
            total += gained
            squares += gained**2
            steps += len(rewards)
        mean = total / episodes
        deviation = 0.0 if episodes == 1 else float(np.sqrt((squares - mean**2) / (episodes - 1)))
        return {
            "environment": name,
            "mean": mean,
            "deviation": deviation,
            "length": steps / episodes,
        }

    return list(map(play, environment_ids))


# %% one_dict_filled_twice loses 1.1
# Gives the same dict for both spaces, in which the action's values replace the observation's, but each space should have a dict of its own.
# says: this
def describe(environment_id):
    env = gymnasium.make(environment_id)
    result, details = {}, {}
    for key in ("observation", "action"):
        space = getattr(env, key + "_space")
        details["kind"] = type(space).__name__
        if isinstance(space, spaces.Box):
            details["size"] = int(space.low.size)
            details["low"] = [float(v) for v in space.low.flat]
            details["high"] = [float(v) for v in space.high.flat]
        else:
            details["choices"], details["first"] = int(space.n), int(space.start)
        result[key] = details
    result["maxsteps"] = env.spec.max_episode_steps
    env.close()
    return result


# %% zero_for_no_limit loses 1.1
# Gives 0 where there is no time limit, but None is asked for.
# says: this
# -         "maxsteps": env.spec.max_episode_steps,
# +         "maxsteps": int(env.spec.max_episode_steps or 0),
