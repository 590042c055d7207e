"""Wrong solutions of exercise 1; building.py describes how a case is written."""

# %% describe_first_choice loses 1.1
# Takes it for granted that the choices of a Discrete space begin with 0.
# says: first returned 0|first is 0
_describe = describe


def describe(environment_id):
    description = _describe(environment_id)
    for space in (description["observation"], description["action"]):
        if space["kind"] == "Discrete":
            space["first"] = 0
    return description


# %% describe_known_only loses 1.1
# The bounds are looked up in a table of the environments that the student has met.
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
# Looks at `terminated` alone, and goes on when the time limit is over.
# says: is over after 200 steps
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
# Reports an episode that only maxsteps stopped as truncated by the environment.
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    over = episode["terminated"] or len(episode["actions"]) == maxsteps
    return {**episode, "truncated": episode["truncated"] or (over and not episode["terminated"])}


# %% observation_of_reset_missing loses 1.2
# Keeps the observations of the steps, but not the one of the reset.
# says: The first one is missing
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    return {**episode, "observations": episode["observations"][1:]}


# %% one_kind_of_end loses 1.2
# Treats the two ends as one, as the old `done` did.
# says: as the old `done` was
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    done = episode["terminated"] or episode["truncated"]
    return {**episode, "terminated": done, "truncated": done}


# %% unseeded_actions loses 1.2
# Seeds the reset, but not the action space: no episode can be repeated.
# says: do not come from the seed
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
# Has seen nothing but ones, and gives 1 even after the fall.
def cartpole_reward(observation, action):
    return 1.0


# %% limits_of_the_space loses 1.3
# Takes the limits of the observation space, which are twice those of the task.
# says: 12 degrees are 0.2094
def fallen(observation):
    return bool(abs(observation[0]) > 4.8 or abs(observation[2]) > 0.4189)


# %% one_side_only loses 1.3
# Forgets that the pole can fall to the left, too.
def fallen(observation):
    return bool(observation[0] > 2.4 or observation[2] > np.deg2rad(12))


# %% asks_gymnasium loses 1.3, 1.4
# Lets Gymnasium's environments do the step, and passes their reward on.
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
# arctan(sin / cos) knows half of the circle only.
# says: see np.arctan2
def pendulum_reward(observation, action):
    cosine, sine, speed = (float(value) for value in observation)
    torque = np.clip(float(action[0]), -2.0, 2.0)
    return float(-(np.arctan(sine / cosine) ** 2 + 0.1 * speed**2 + 0.001 * torque**2))


# %% torque_not_cut loses 1.4
# Pays for the torque that was wanted, not for the one that the motor gives.
# says: The torque is not cut
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * float(action[0]) ** 2))


# %% angle_only loses 1.5
# Follows the angle and not its speed: swings up and falls after some 40 steps.
def balance(observation):
    return int(observation[2] > 0)


# %% speed_only loses 1.5
# Brakes the pole but lets it lean: 180 of 200 steps.
def balance(observation):
    return int(observation[3] > 0)


# %% deviation_divides_by_n loses 1.6
# np.std without ddof=1 divides by n.
# says: n and n - 1 were mixed up
_compare = compare


def compare(environment_ids, episodes, seed):
    shrink = ((episodes - 1) / episodes) ** 0.5
    return [
        {**row, "deviation": row["deviation"] * shrink}
        for row in _compare(environment_ids, episodes, seed)
    ]


# %% mean_reward_of_a_step loses 1.6
# The mean reward of a step instead of the mean return of an episode.
# says: this
_compare = compare


def compare(environment_ids, episodes, seed):
    return [
        {**row, "mean": row["mean"] / row["length"]}
        for row in _compare(environment_ids, episodes, seed)
    ]


# %% same_episode_again loses 1.6
# Plays the very same episode again and again.
_compare = compare


def compare(environment_ids, episodes, seed):
    table = []
    for row in _compare(environment_ids, 1, seed):
        table.append({**row, "deviation": 0.0})
    return table


# %% last_step_does_not_count loses 1.2
# Takes every episode of maxsteps steps for one that maxsteps has stopped.
# says: in the last of its 200 steps
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    if len(episode["actions"]) == maxsteps:
        episode |= {"terminated": False, "truncated": False}
    return episode


# %% over_at_the_limit loses 1.3
# Ends the episode exactly at the limit, which is still allowed.
# says: exactly 2.4 is still allowed
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) >= 2.4 or abs(angle) >= np.deg2rad(12))


# %% keeps_pushing loses 1.5
# Keeps the action of the call before while the pole hardly moves.
# says: must depend on the observation alone
_pushed = [0]


def balance(observation):
    lean = observation[2] + 0.5 * observation[3]
    if abs(lean) > 0.02:
        _pushed[0] = int(lean > 0)
    return _pushed[0]


# %% tosses_a_coin loses 1.5
# Tosses a coin while the pole hardly moves.
# says: must depend on the observation alone
_coin = np.random.default_rng()


def balance(observation):
    lean = observation[2] + 0.5 * observation[3]
    return int(lean > 0) if abs(lean) > 0.05 else int(_coin.integers(2))


# %% one_row_for_a_name loses 1.6
# Collects the rows in a dict, so that an environment that is given twice has one row.
# says: a list of 2 rows
_compare = compare


def compare(environment_ids, episodes, seed):
    return list(
        {row["environment"]: row for row in _compare(environment_ids, episodes, seed)}.values()
    )


# %% five_hundred_steps_at_most loses 1.6
# Ends every episode after 500 steps, though some environments allow more.
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 500) for i in range(episodes)]


# %% zero_is_no_seed loses 1.2
# Takes the seed 0 for no seed at all.
# -     observation, _ = env.reset(seed=seed)
# -     env.action_space.seed(seed)
# +     observation, _ = env.reset(seed=seed or None)
# +     env.action_space.seed(seed or None)


# %% thousand_steps_at_most loses 1.6
# Ends every episode after 1000 steps, though an environment may allow more.
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 1000) for i in range(episodes)]


# %% hanging_is_upright loses 1.4
# Gives arccos the sign of the sine, which is 0 when the rod hangs straight down.
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arccos(np.clip(cosine, -1, 1)) * np.sign(sine)


# %% arctan_corrected loses 1.4
# Divides sine by cosine, and turns half of the circle; a cosine of 0 divides by 0.
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arctan(sine / cosine)
# +     if cosine < 0:
# +         angle += np.pi if sine >= 0 else -np.pi


# %% twelve_degrees_is_too_much loses 1.3
# Ends the episode at exactly 12 degrees, which is still allowed.
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) >= 12 * 2 * np.pi / 360)


# %% one_minus_zero loses 1.3
# Tests the fall in whole degrees.
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or round(np.rad2deg(abs(angle))) > 12)


# %% remembers_an_environment loses 1.6
# Remembers the row of an environment, and gives it again when other episodes are asked for.
_compare, _rows = compare, {}


def compare(environment_ids, episodes, seed):
    for name in environment_ids:
        if name not in _rows:
            (_rows[name],) = _compare([name], episodes, seed)
    return [_rows[name] for name in environment_ids]


# %% table_grows loses 1.6
# The table is a default argument, so that a second call finds the rows of the first.
_compare = compare


def compare(environment_ids, episodes, seed, table=[]):  # noqa: B006
    table += _compare(environment_ids, episodes, seed)
    return table


# %% torque_cut_at_the_top_only loses 1.4
# Cuts torques above 2, but not those below -2.
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = min(float(action[0]), 2.0)


# %% median_return loses 1.6
# Takes the median of the returns for their mean.
# -                 "mean": float(np.mean(returns)),
# +                 "mean": float(np.median(returns)),


# %% steps_of_the_last_episode loses 1.6
# Gives the length of the last episode, not the mean length.
# -                 "length": float(np.mean([len(run["rewards"]) for run in runs])),
# +                 "length": float(len(runs[-1]["rewards"])),


# %% last_choice loses 1.1
# Adds the number of the first choice to the number of choices.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             return {"kind": "Discrete", "choices": int(space.start + space.n), "first": int(space.start)}


# %% reset_twice loses 1.2
# Resets a second time, without the seed.
# -     env.action_space.seed(seed)
# +     env.action_space.seed(seed)
# +     observation, _ = env.reset()


# %% whole_rewards loses 1.2
# Makes whole numbers of the rewards.
# says: this
# -         rewards.append(float(reward))
# +         rewards.append(int(reward))


# %% terminated_wins loses 1.2
# Calls an episode truncated only if it is not terminated in the same step.
# says: Both can be True
# -         "truncated": bool(truncated),
# +         "truncated": bool(truncated and not terminated),


# %% degrees_for_radians loses 1.3
# Compares radians with 12.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) > 12)


# %% rounded_limit loses 1.3
# Takes 0.21 for 12 degrees.
# says: not with rounded numbers
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) > 0.21)


# %% over_at_the_limit_for_the_reward loses 1.3
# Pays only while cart and pole are inside the limits, not at them.
# says: exactly|until the cart is more
# -     return 0.0 if fallen(observation) else 1.0
# +     return 1.0 if abs(observation[0]) < 2.4 and abs(observation[2]) < np.deg2rad(12) else 0.0


# %% pole_alone_pays loses 1.3
# Pays while the pole is up, wherever the cart is.
# says: this
# -     return 0.0 if fallen(observation) else 1.0
# +     return 1.0 if abs(observation[2]) <= np.deg2rad(12) else 0.0


# %% costs_swapped loses 1.4
# Exchanges the factors of speed and torque.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.001 * speed**2 + 0.1 * torque**2))


# %% arcsine loses 1.4
# Takes the angle from the sine alone.
# says: this
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arcsin(sine)


# %% cut_after_the_square loses 1.4
# Cuts the square of the torque.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     effort = np.clip(float(action[0]) ** 2, -2.0, 2.0)
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * effort))


# %% half_circle_only loses 1.4
# Counts the angle from 0 to 2 pi.
# says: this
# -     angle = np.arctan2(sine, cosine)
# +     angle = np.arctan2(sine, cosine) % (2 * np.pi)


# %% refuses_large_torques loses 1.4
# Pays nothing for a torque beyond the limits.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = float(action[0]) if abs(action[0]) <= 2 else 0.0


# %% alternates loses 1.5
# Pushes left and right in turn, whatever happens.
# says: depend on the observation alone
_turn = [0]


def balance(observation):
    _turn[0] = 1 - _turn[0]
    return _turn[0]


# %% lean_and_speed_both loses 1.5
# Pushes to the right only if the pole leans and turns to the right.
# says: this
# -     return int(angle + 0.5 * speed > 0)
# +     return int(angle > 0 and speed > 0)


# %% seed_runs_on loses 1.6
# Goes on counting the seeds in the next environment.
# says: this
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         seed += episodes


# %% error_of_the_mean loses 1.6
# Divides the standard deviation by the root of the number of episodes.
# says: this
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std(returns, ddof=1) / episodes**0.5) if episodes > 1 else 0.0,


# %% length_rounded_down loses 1.6
# Divides the steps as whole numbers.
# says: an environment without a time limit
# -                 "length": float(np.mean([len(run["rewards"]) for run in runs])),
# +                 "length": float(sum(len(run["rewards"]) for run in runs) // episodes),


# %% two_decimals loses 1.6
# Rounds the mean to two places.
# says: this
# -                 "mean": float(np.mean(returns)),
# +                 "mean": round(float(np.mean(returns)), 2),


# %% dimensions_for_the_size loses 1.1
# The size is the number of dimensions of the array, not of the numbers in it.
# says: this
# -         return {"kind": "Box", "size": len(low), "low": low, "high": high}
# +         return {"kind": "Box", "size": space.low.ndim, "low": low, "high": high}


# %% seeds_before_each_sample loses 1.2
# Every action is the first one: seed the space once, and draw anew in each step.
# says: this
# -     env.action_space.seed(seed)
# -     observations, actions, rewards = [observation], [], []
# +     observations, actions, rewards = [observation], [], []
# -         action = env.action_space.sample()
# +         env.action_space.seed(seed)
# +         action = env.action_space.sample()


# %% observations_for_steps loses 1.6
# The length counts the observations, of which there is one more than steps.
# says: this
# -                 "length": float(np.mean([len(run["rewards"]) for run in runs])),
# +                 "length": float(np.mean([len(run["observations"]) for run in runs])),


# %% rows_add_up loses 1.6
# A row still holds the episodes of the environments before.
# says: this
# -     table = []
# +     table, runs = [], []
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs += [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std(returns, ddof=1)) if len(runs) > 1 else 0.0,


# %% torque_without_square loses 1.4
# Takes the size of the torque instead of its square.
# says: The torque has no square
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * abs(torque)))


# %% symmetric_limits loses 1.1
# Takes minus the upper limit for the lower one.
# says: minus the other limit
# -         low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
# +         high = space.high.ravel().tolist()
# +         low = [-value for value in high]


# %% observed_before_the_step loses 1.2
# Keeps what was observed before each step: the start comes twice, and the end is missing.
# says: before each step, not after it
# -         observation, reward, terminated, truncated, _ = env.step(action)
# -         observations.append(observation)
# +         observations.append(observation)
# +         observation, reward, terminated, truncated, _ = env.step(action)


# %% speed_for_the_angle loses 1.3
# Compares the speed of the angle with 12 degrees.
# says: this
# -     position, _, angle, _ = observation
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     position, _, _, angle = observation
# +     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))


# %% limits_with_two_places loses 1.1
# Rounds the limits to two places.
# says: These are rounded limits
# -         low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
# +         low, high = np.round([space.low.ravel(), space.high.ravel()], 2).tolist()


# %% limits_of_the_observations loses 1.1
# Gives the limits of the observations for the actions.
# says: this
_describe = describe


def describe(environment_id):
    description = _describe(environment_id)
    observed, acted = description["observation"], description["action"]
    if observed["kind"] == acted["kind"] == "Box":
        acted |= {side: (observed[side] * 9)[: acted["size"]] for side in ("low", "high")}
    return description


# %% fall_costs_its_step loses 1.3
# Gives 0 to the step in which the pole falls, by looking one step ahead.
# says: the state in which a step begins
# -     return 0.0 if fallen(observation) else 1.0
# +     position, speed, angle, turning = observation
# +     ahead = np.array([position + 0.02 * speed, speed, angle + 0.02 * turning, turning])
# +     return 0.0 if fallen(ahead) else 1.0


# %% speed_after_the_step loses 1.4
# Moves the rod first, and pays for its new speed.
# says: that at its beginning counts
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     speed = np.clip(speed + 0.05 * (15 * np.sin(angle) + 3 * torque), -8, 8)
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))


# %% state_after_the_step loses 1.4
# Moves the rod first, and pays for its new angle and speed.
# says: those at its beginning count
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     speed = np.clip(speed + 0.05 * (15 * np.sin(angle) + 3 * torque), -8, 8)
# +     angle = (angle + 0.05 * speed + np.pi) % (2 * np.pi) - np.pi
# +     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))


# %% cut_at_one loses 1.4
# Cuts the torque at 1, though the motor gives 2.
# says: The torque is cut to -1 and 1
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = np.clip(float(action[0]), -1.0, 1.0)


# %% speed_of_the_cart loses 1.5
# Looks ahead with the speed of the cart, not with that of the angle.
# says: looks at the cart's speed
# -     _, _, angle, speed = observation
# +     _, speed, angle, _ = observation


# %% factor_of_the_speed_squared loses 1.4
# Squares the factor of the speed, too.
# says: 0.01 times the square of the speed
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + (0.1 * speed) ** 2 + 0.001 * torque**2))


# %% deviation_of_the_lengths loses 1.6
# Gives the standard deviation of the lengths, not of the returns.
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std([len(run["rewards"]) for run in runs], ddof=1)) if episodes > 1 else 0.0,


# %% whole_degrees loses 1.3
# Cuts the angle to whole degrees before it compares.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or int(np.rad2deg(abs(angle))) > 12)


# %% choices_without_the_first loses 1.1
# Subtracts the first choice from the number of choices.
# says: The first choice is subtracted
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             return {
# +                 "kind": "Discrete",
# +                 "choices": int(space.n) - int(space.start),
# +                 "first": int(space.start),
# +             }


# %% rows_after_the_end loses 1.2
# Rows of zeros are left over where the episode ends before maxsteps.
# says: more of zeros follow: cut them off
_random_episode_1 = random_episode


def random_episode(environment_id, seed, maxsteps=1000):
    found = _random_episode_1(environment_id, seed, maxsteps)
    seen = found["observations"]
    rows = np.zeros((maxsteps + 1 - len(seen), *seen.shape[1:]))
    return {**found, "observations": np.concatenate([seen, rows])}


# %% two_hundred_steps_at_most loses 1.6
# Ends every episode after 200 steps, but it goes on until it is terminated or truncated.
# says: this
# -         runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
# +         runs = [random_episode(environment_id, seed + i, 200) for i in range(episodes)]


# %% rewards_of_all_steps loses 1.6
# Takes the single rewards of all steps for the returns of the episodes.
# says: this
# -         returns = [sum(run["rewards"]) for run in runs]
# +         returns = [reward for run in runs for reward in run["rewards"]]


# %% last_reward_for_the_return loses 1.6
# Takes the last reward of an episode for its return, which is the sum of all rewards.
# says: this
# -         returns = [sum(run["rewards"]) for run in runs]
# +         returns = [run["rewards"][-1] for run in runs]


# %% mean_divided_by_n_minus_one loses 1.6
# Divides by the number of episodes minus one for the mean, too.
# says: this
# -                 "mean": float(np.mean(returns)),
# +                 "mean": float(np.sum(returns) / max(1, episodes - 1)),


# %% range_of_the_returns loses 1.6
# Gives the difference between the largest and the smallest return for the standard deviation.
# says: this
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(max(returns) - min(returns)),


# %% first_episode_left_out loses 1.6
# Leaves the episode with the seed itself out: the first one has seed + 0.
# says: this
_compare = compare


def compare(environment_ids, episodes, seed):
    fewer = max(1, episodes - 1)
    return _compare(environment_ids, fewer, seed + (episodes > 1))


# %% divides_by_zero_for_one_episode loses 1.6
# Divides by 0 for a single episode, whose deviation is 0.
# says: it is 0 for a single episode
# -                 "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
# +                 "deviation": float(np.std(returns, ddof=1)),


# %% size_of_the_speed loses 1.4
# Takes the size of the angle's speed instead of its square.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(angle**2 + 0.1 * abs(speed) + 0.001 * torque**2))


# %% size_of_the_angle loses 1.4
# Takes the size of the angle instead of its square.
# says: this
# -     return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
# +     return float(-(abs(angle) + 0.1 * speed**2 + 0.001 * torque**2))


# %% torque_through_tanh loses 1.4
# Puts the torque through tanh instead of cutting it off at -2 and 2.
# says: this
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = 2 * np.tanh(float(action[0]))


# %% torque_in_shares_of_the_limit loses 1.4
# Cuts the torque off at -1 and 1 and then doubles it.
# says: and then doubled
# -     torque = np.clip(float(action[0]), -2.0, 2.0)
# +     torque = 2 * np.clip(float(action[0]), -1.0, 1.0)


# %% fall_costs_one loses 1.3
# Gives -1 after the fall, but 0 is asked for.
# says: this
# -     return 0.0 if fallen(observation) else 1.0
# +     return -1.0 if fallen(observation) else 1.0


# %% leaning_or_turning loses 1.5
# Pushes to the right as soon as either the angle or its speed is above 0.
# says: this
# -     return int(angle + 0.5 * speed > 0)
# +     return int(angle > 0 or speed > 0)


# %% two_samples_for_an_action loses 1.2
# Draws two actions in each step and uses the second one.
# says: this
# -         action = env.action_space.sample()
# +         env.action_space.sample()
# +         action = env.action_space.sample()


# %% action_seed_plus_one loses 1.2
# Seeds the action space with seed + 1, but with the seed itself is asked for.
# says: this
# -     env.action_space.seed(seed)
# +     env.action_space.seed(seed + 1)


# %% last_step_left_out loses 1.2
# Leaves out the last step: the loop ends before its observation, action and reward are kept.
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
# Gives the last choice of a Discrete space for the first.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             last = int(space.start + space.n - 1)
# +             return {"kind": "Discrete", "choices": int(space.n), "first": last}


# %% limit_of_what_is_observed loses 1.3
# Takes 24 degrees, the limit of what can be observed, for the limit of the angle.
# says: this
# -     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
# +     return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(24))


# %% end_of_a_range loses 1.1
# Takes the number of choices of a Discrete space for the end of a range that begins with the first one.
# says: this
# -             return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
# +             first = int(space.start)
# +             return {"kind": "Discrete", "choices": len(range(first, space.n)), "first": first}


# %% no_infinite_limits loses 1.1
# Replaces infinite limits by large numbers, as np.nan_to_num does: give them as they are.
# says: this
# -         low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
# +         low, high = (np.nan_to_num(limits.ravel()).tolist() for limits in (space.low, space.high))


# %% square_of_the_mean_once loses 1.6
# Subtracts the square of the mean once from the sum of squares, not n times.
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
# Fills one and the same dict for both spaces.
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
# Gives 0 where there is no time limit.
# says: None was expected
# -         "maxsteps": env.spec.max_episode_steps,
# +         "maxsteps": int(env.spec.max_episode_steps or 0),
