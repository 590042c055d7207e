"""Wrong solutions of exercise 2; building.py describes how a case is written."""

# %% random_biases loses 2.1
# Draws the biases at random, but all of them should be 0.
# says: this
_parameters = parameters


def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.default_rng(seed + 1)
    biases = {"b1": 0.1 * rng.normal(size=nhiddens), "b2": 0.1 * rng.normal(size=noutputs)}
    return {**_parameters(ninputs, nhiddens, noutputs, seed), **biases}


# %% seeded_for_each_layer loses 2.1
# Begins again with the same seed for W2, so that it holds the numbers of W1, but each weight should be drawn on its own.
def parameters(ninputs, nhiddens, noutputs, seed):
    return {
        "W1": 0.1 * np.random.default_rng(seed).standard_normal((nhiddens, ninputs)),
        "b1": np.zeros(nhiddens),
        "W2": 0.1 * np.random.default_rng(seed).standard_normal((noutputs, nhiddens)),
        "b2": np.zeros(noutputs),
    }


# %% uniform_weights loses 2.1
# Draws evenly distributed (uniform) weights with the right standard deviation, but Gaussian ones are asked for.
# -     rng = np.random.default_rng(seed)
# +     rng = np.random.default_rng(seed)
# +     limit = 0.1 * 3**0.5
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.uniform(-limit, limit, (nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.uniform(-limit, limit, (noutputs, nhiddens)),


# %% variance_for_deviation loses 2.1
# Takes 0.1 as the variance, so that the weights are three times too large, but it should be the standard deviation.
# says: this
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.normal(0, 0.1**0.5, (nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.normal(0, 0.1**0.5, (noutputs, nhiddens)),


# %% biases_forgotten loses 2.2
# Leaves out the biases b1 and b2, but they should be added before tanh.
# says: this
def forward(network, observation):
    return np.tanh(network["W2"] @ np.tanh(network["W1"] @ observation))


# %% linear_outputs loses 2.2
# Leaves out tanh at the outputs, but both layers should have it.
# says: this
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return network["W2"] @ hidden + network["b2"]


# %% multiplies_from_the_wrong_side loses 2.2
# Multiplies the vector and the matrix in the wrong order, as in observation @ W1, but W1 @ observation is asked for.
# says: print .shape of both
def forward(network, observation):
    hidden = np.tanh(observation @ network["W1"] + network["b1"])
    return np.tanh(hidden @ network["W2"] + network["b2"])


# %% reshaped_in_place loses 2.2
# Changes the shape of the network's own biases, but the arrays given should stay as they are.
def forward(network, observation):
    values = observation[:, None]
    for layer in "12":
        network["b" + layer].shape = (-1, 1)
        values = np.tanh(network["W" + layer] @ values + network["b" + layer])
    return values[:, 0]


# %% one_output_for_discrete loses 2.3
# Gives one output for every environment, but one for each choice, or for each number of a Box, is asked for.
def sizes(environment_id):
    env = gymnasium.make(environment_id)
    return env.observation_space.shape[0], 1


# %% raw_outputs loses 2.4
# Returns the outputs for a Box as they are, but they should be stretched to the limits of the space.
# says: this
# -     low, high = action_space.low, action_space.high
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return np.asarray(outputs, dtype=np.float32)


# %% same_limits_for_all loses 2.4
# Multiplies every output by the upper limit of the first number, but each should be stretched to both of its own limits.
# -     low, high = action_space.low, action_space.high
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (outputs * action_space.high[0]).astype(np.float32)


# %% start_ignored loses 2.4
# Returns the number of the most active output, but action_space.start should be added to it.
_act = act


def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        return int(np.argmax(outputs))
    return _act(outputs, action_space)


# %% last_reward_missing loses 2.5
# Leaves out the reward of the step in which the episode is terminated or truncated, but the return should count it.
def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    actions, total = [], 0.0
    for _ in range(maxsteps):
        actions.append(act(forward(network, observation), env.action_space))
        observation, reward, terminated, truncated, _ = env.step(actions[-1])
        if terminated or truncated:
            break
        total += float(reward)
    return {"actions": actions, "return": total}


# %% never_stops loses 2.5
# Does all maxsteps steps, but it should stop when the episode is terminated or truncated.
# says: this
# -     terminated = truncated = False
# -     while len(actions) < maxsteps and not (terminated or truncated):
# +     for _ in range(maxsteps):
# -         observation, reward, terminated, truncated, _ = env.step(action)
# +         observation, reward, _, _, _ = env.step(action)
# -         total += float(reward)
# -     env.close()
# +         total += float(reward)


# %% no_limit_of_steps loses 2.5
# Goes on to the end of the episode whatever maxsteps is, but it should stop after maxsteps steps at the latest.
_run_episode = run_episode


def run_episode(environment_id, network, seed, maxsteps=200):
    return _run_episode(environment_id, network, seed, 10_000)


# %% reset_without_seed loses 2.5
# Resets the environment without the seed, but env.reset(seed=seed) is asked for.
# says: another answer: by chance
# -     observation, _ = env.reset(seed=seed)
# +     observation, _ = env.reset()
# -         total += float(reward)
# -     env.close()
# +         total += float(reward)


# %% sum_of_returns loses 2.6
# Gives the sum of the returns, but their mean is asked for.
# says: this
def fitness(environment_id, network, seeds, maxsteps=200):
    return sum(run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds)


# %% ten_times_the_first_seed loses 2.6
# Uses the first seed alone, once or several times, but an episode for each seed is asked for.
def fitness(environment_id, network, seeds, maxsteps=200):
    runs = [run_episode(environment_id, network, seeds[0], maxsteps) for _ in seeds]
    return float(np.mean([run["return"] for run in runs]))


# %% first_network_for_all loses 2.7
# Uses W2 of network 0 for all networks, but each has a W2 of its own.
def forward_batch(networks, observations):
    hidden = np.einsum("nhi,ni->nh", networks["W1"], observations) + networks["b1"]
    return np.tanh(np.tanh(hidden) @ networks["W2"][0].T + networks["b2"])


# %% loop_over_networks loses 2.7
# Computes one network after the other in a loop, but all should be computed at once.
def forward_batch(networks, observations):
    return np.array(
        [
            forward({key: stack[i] for key, stack in networks.items()}, observations[i])
            for i in range(len(observations))
        ]
    )


# %% last_of_equals loses 2.8
# Gives the last of the networks with the highest fitness, but of equals the lowest number is asked for.
_random_search = random_search


def random_search(environment_id, nnetworks, nhiddens, seed):
    report = _random_search(environment_id, nnetworks, nhiddens, seed)
    order = sorted(range(nnetworks), key=lambda i: report["fitness"][i])
    return {**report, "best": order[-1]}


# %% lowest_fitness loses 2.8
# Gives the network with the lowest fitness as the best, but the highest is asked for.
_random_search = random_search


def random_search(environment_id, nnetworks, nhiddens, seed):
    report = _random_search(environment_id, nnetworks, nhiddens, seed)
    return {**report, "best": int(np.argmin(report["fitness"]))}


# %% own_episodes_for_each loses 2.8
# Measures network i with the seeds from seed + 10 * i on, but all networks should have those from seed to seed + 9.
# -     seeds = list(range(seed, seed + 10))
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [
# +         fitness(environment_id, network, range(seed + 10 * i, seed + 10 * i + 10))
# +         for i, network in enumerate(networks)
# +     ]


# %% renames_a_function loses 2.8
# Calls fitness by a name that does not exist.
# says: fitnes' is not defined. Did you mean
def random_search(environment_id, nnetworks, nhiddens, seed):
    return fitnes(environment_id, parameters(4, nhiddens, 2, seed), range(10))


# %% second_layer_from_the_next_seed loses 2.1
# Draws W2 with seed + 1, so that it has the numbers of W1 in the network of the next seed, but two seeds should have no weight in common.
# says: this
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": 0.1 * np.random.default_rng(seed + 1).standard_normal((noutputs, nhiddens)),


# %% counts_up_to_the_last_choice loses 2.3
# Gives start + n outputs for a Discrete space, but one for each of its n choices is asked for.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     if isinstance(actions, spaces.Discrete):
# +         return ninputs, int(actions.start + actions.n)
# +     return ninputs, actions.shape[0]


# %% beats_zero loses 2.4
# Chooses the first output where none is above 0, but the largest should decide, even if all are negative.
# -         return int(action_space.start + np.argmax(outputs))
# +         best, highest = 0, 0.0
# +         for number, output in enumerate(outputs):
# +             if output > highest:
# +                 best, highest = number, output
# +         return int(action_space.start + best)


# %% stretches_in_place loses 2.4
# Changes the array `outputs` that it is given, but that should stay as it is.
# says: the outputs, afterwards,
# -     low, high = action_space.low, action_space.high
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     outputs += 1
# +     outputs *= (action_space.high - action_space.low) / 2
# +     outputs += action_space.low
# +     return outputs


# %% each_seed_once loses 2.6
# Counts a seed that comes twice only once, but it should count twice.
# says: this
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     returns = [run_episode(environment_id, network, s, maxsteps)["return"] for s in set(seeds)]


# %% biases_reshaped_in_place loses 2.7
# Changes the shape of the biases that it is given, but the arrays given should stay as they are.
# says: changed its argument number 1
def forward_batch(networks, observations):
    values = observations[:, :, None]
    for layer in "12":
        biases = networks["b" + layer]
        biases.shape = (*biases.shape[:2], 1)
        values = np.tanh(networks["W" + layer] @ values + biases)
    return values[:, :, 0]


# %% better_than_zero loses 2.8
# Gives network 0 as the best where no fitness is above 0, but the highest should win, even if all are negative.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     best, highest = 0, 0
# +     for number, value in enumerate(measured):
# +         if value > highest:
# +             best, highest = number, value
# +     return {"networks": networks, "fitness": measured, "best": best}


# %% zero_is_no_seed loses 2.1
# Draws without a seed when the seed is 0, but 0 is a seed like any other.
# -     rng = np.random.default_rng(seed)
# +     rng = np.random.default_rng(seed or None)


# %% episode_without_seed_zero loses 2.5
# Resets without a seed when the seed is 0, but 0 is a seed like any other.
# -     observation, _ = env.reset(seed=seed)
# +     observation, _ = env.reset(seed=seed if seed else None)


# %% five_hundred_by_default loses 2.5
# Does up to 500 steps where maxsteps is not given, but the default should be 200.
_run_episode = run_episode


def run_episode(environment_id, network, seed, maxsteps=500):
    return _run_episode(environment_id, network, seed, maxsteps)


# %% rounds_the_outputs loses 2.4
# Takes outputs that are nearly equal as equal (as rounding makes them), but the largest should decide, however close the others are.
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + np.argmax(np.round(outputs, 2)))


# %% sorts_the_seeds loses 2.6
# Sorts the list of seeds that it is given, but that should stay as it is.
_fitness = fitness


def fitness(environment_id, network, seeds, maxsteps=200):
    if isinstance(seeds, list):
        seeds.sort()
    return _fitness(environment_id, network, seeds, maxsteps)


# %% remembers_a_search loses 2.8
# Gives the result of an earlier call again when only the seed is another one, but each seed should have a search of its own.
_random_search, _kept = random_search, {}


def random_search(environment_id, nnetworks, nhiddens, seed):
    key = environment_id, nnetworks, nhiddens
    if key not in _kept:
        _kept[key] = _random_search(environment_id, nnetworks, nhiddens, seed)
    return _kept[key]


# %% whole_actions loses 2.4
# Cuts the actions of a Box to whole numbers, but their fractions should stay.
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (low + (outputs + 1) / 2 * (high - low)).astype(int)


# %% median_return loses 2.6
# Gives the median of the returns, but their mean is asked for.
# -     return float(np.mean(returns))
# +     return float(np.median(returns))


# %% squeezed loses 2.7
# Loses the dimension of length 1 where there is one hidden neuron or one output (as squeeze does), but the shape (n, noutputs) is asked for.
# -     hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"])
# -     return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
# +     hidden = np.tanh((networks["W1"] @ observations[:, :, None]).squeeze() + networks["b1"])
# +     return np.tanh((networks["W2"] @ hidden[:, :, None]).squeeze() + networks["b2"])


# %% goal_not_counted loses 2.5
# Leaves out the reward of the step in which the episode is terminated, but the return should count it.
# -         actions.append(action)
# -         total += float(reward)
# +         actions.append(action)
# +         total += 0.0 if terminated else float(reward)


# %% logistic_hidden loses 2.2
# Uses the logistic function in the hidden neurons, but tanh is asked for.
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = 1 / (1 + np.exp(-(network["W1"] @ observation + network["b1"])))
# +     return np.tanh(network["W2"] @ hidden + network["b2"])


# %% sums_are_cut_off loses 2.2
# Cuts the sums off at -1 and 1 instead of using tanh.
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = np.clip(network["W1"] @ observation + network["b1"], -1, 1)
# +     return np.clip(network["W2"] @ hidden + network["b2"], -1, 1)


# %% first_observation_always loses 2.5
# Computes every action from the observation of the reset, but each should follow from the observation that came last.
# -         observation, reward, terminated, truncated, _ = env.step(action)
# -         actions.append(action)
# +         _, reward, terminated, truncated, _ = env.step(action)
# +         actions.append(action)


# %% network_remembered loses 2.1
# Returns the arrays of an earlier call again, with what was changed in them since, but each call should make new ones.
# says: this
_parameters, _networks = parameters, {}


def parameters(ninputs, nhiddens, noutputs, seed):
    key = ninputs, nhiddens, noutputs, seed
    if key not in _networks:
        _networks[key] = _parameters(*key)
    return _networks[key]


# %% scaled_by_the_layer loses 2.1
# Divides W2 by the root of the number of hidden neurons instead of multiplying it by 0.1.
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.standard_normal((noutputs, nhiddens)) / np.sqrt(nhiddens),


# %% bias_after_tanh loses 2.2
# Adds the biases of the hidden neurons after tanh, but they should be added before it.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ observation) + network["b1"]


# %% rectified_hidden loses 2.2
# Uses max(0, sum) (ReLU) in the hidden neurons, but tanh is asked for.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.maximum(0, network["W1"] @ observation + network["b1"])


# %% bias_of_the_first loses 2.2
# Adds the first bias of b1 to all hidden neurons, but each has a bias of its own.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ observation + network["b1"][0])


# %% observation_normalised loses 2.2
# Divides the observation by its norm (its length as a vector), but it should be used as it is.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ (observation / np.linalg.norm(observation)) + network["b1"])


# %% rounded_outputs loses 2.2
# Rounds the outputs to four decimals, but they should be given as they are.
# says: this
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return np.round(np.tanh(network["W2"] @ hidden + network["b2"]), 4)


# %% one_for_each_limit loses 2.3
# Gives two outputs for each number of an action in a Box, but one for each is asked for.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else 2 * actions.shape[0]


# %% largest_by_size loses 2.4
# Takes the output with the largest absolute value, but the largest output is asked for.
# says: this
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + np.argmax(np.abs(outputs)))


# %% from_the_lower_limit loses 2.4
# Computes low + outputs * (high - low), which would be right for outputs between 0 and 1, but they lie between -1 and 1.
# says: this
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (low + outputs * (high - low)).astype(action_space.dtype)


# %% half_the_range loses 2.4
# Multiplies the outputs by half of the range, but the middle of the range should also be added.
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (outputs * (high - low) / 2).astype(action_space.dtype)


# %% two_choices_by_sign loses 2.4
# Decides between two choices by the sign of the first output, but the larger of the two outputs should decide.
# -         return int(action_space.start + np.argmax(outputs))
# +         if action_space.n == 2:
# +             return int(action_space.start + (outputs[0] < 0))
# +         return int(action_space.start + np.argmax(outputs))


# %% draws_among_equals loses 2.4
# Draws one of several equal outputs at random, but the lowest number is asked for.
# -         return int(action_space.start + np.argmax(outputs))
# +         equal = np.flatnonzero(outputs == np.max(outputs))
# +         return int(action_space.start + np.random.default_rng().choice(equal))


# %% one_action_late loses 2.5
# Computes each action from the observation before the last one, but the last one is asked for.
# says: this
# -     while len(actions) < maxsteps and not (terminated or truncated):
# -         action = act(forward(network, observation), env.action_space)
# -         observation, reward, terminated, truncated, _ = env.step(action)
# +     before = observation
# +     while len(actions) < maxsteps and not (terminated or truncated):
# +         action = act(forward(network, before), env.action_space)
# +         before = observation
# +         observation, reward, terminated, truncated, _ = env.step(action)


# %% mean_reward loses 2.5
# Divides the sum of the rewards by the number of steps, but the sum itself is asked for.
# says: this
# -     return {"actions": actions, "return": total}
# +     return {"actions": actions, "return": total / len(actions)}


# %% whole_return loses 2.5
# Cuts every reward to a whole number, but the rewards should be added up as they are.
# says: this
# -         total += float(reward)
# +         total += int(reward)


# %% maxsteps_not_passed loses 2.6
# Ignores maxsteps, so that every episode has up to 200 steps, but maxsteps should be passed on to run_episode.
# says: this
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     returns = [run_episode(environment_id, network, seed)["return"] for seed in seeds]


# %% divides_by_ten loses 2.6
# Divides the sum of the returns by 10, but it should be divided by the number of seeds.
# says: this
# -     return float(np.mean(returns))
# +     return float(np.sum(returns) / 10)


# %% counts_seeds_from_the_first loses 2.6
# Uses seeds[0], seeds[0] + 1 and so on, but the seeds in the list are asked for.
# says: this
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     returns = [run_episode(environment_id, network, seeds[0] + i, maxsteps)["return"] for i in range(len(seeds))]


# %% divided_as_whole_numbers loses 2.6
# Rounds the mean down to a whole number (as // does), but its fraction should stay.
# says: this
# -     return float(np.mean(returns))
# +     return float(sum(returns) // len(returns))


# %% rounded_to_three_places loses 2.6
# Rounds the fitness to three decimals, but the exact mean is asked for.
# -     return float(np.mean(returns))
# +     return round(float(np.mean(returns)), 3)


# %% first_biases_for_all loses 2.7
# Adds b1 of network 0 to the hidden neurons of all networks, but each network has a b1 of its own.
# says: this
# -     hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"])
# +     hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"][0])


# %% nine_seeds loses 2.8
# Measures with the nine seeds from seed to seed + 8, but the ten from seed to seed + 9 are asked for.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(seed, seed + 9))


# %% sorted_networks loses 2.8
# Sorts networks and fitness, the best first, but network i should have the parameters of seed + i.
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     order = np.argsort(-np.array(measured), kind="stable")
# +     networks, measured = [networks[i] for i in order], [measured[i] for i in order]
# +     return {"networks": networks, "fitness": measured, "best": 0}


# %% seeds_from_one loses 2.8
# Gives network i the parameters of seed + i + 1, but those of seed + i are asked for.
# says: this
# -     networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(nnetworks)]
# +     networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(1, nnetworks + 1)]


# %% beats_minus_2000 loses 2.8
# Gives network 0 as the best where every fitness is below some start value (such as -2000), but the highest should win, however low it is.
# says: minus the number of the highest
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     best, highest = 0, -2000.0
# +     for i, value in enumerate(measured):
# +         if value > highest:
# +             best, highest = i, value
# +     return {"networks": networks, "fitness": measured, "best": best}


# %% stops_when_solved loses 2.8
# Ends the search as soon as a network is good enough, but all nnetworks should be tried.
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = []
# +     for network in networks:
# +         measured.append(fitness(environment_id, network, seeds))
# +         if measured[-1] >= 195:
# +             break
# +     networks = networks[: len(measured)]


# %% one_output_for_all_choices loses 2.3
# Gives one output for a Discrete space, but one for each of its choices is asked for.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, 1 if isinstance(actions, spaces.Discrete) else actions.shape[0]


# %% seeds_of_its_own_for_each_network loses 2.8
# Measures network i with the seeds from seed + i on, but all networks should have those from seed to seed + 9.
# says: this
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [
# +         fitness(environment_id, networks[i], [i + each for each in seeds])
# +         for i in range(nnetworks)
# +     ]


# %% a_single_episode_each loses 2.8
# Measures each network with seed alone, once or several times, but the 10 seeds from seed to seed + 9 are asked for.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = [seed]


# %% steps_for_rewards loses 2.6
# Counts the steps instead of adding up the rewards.
# says: this
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     runs = [run_episode(environment_id, network, seed, maxsteps) for seed in seeds]
# +     returns = [len(run["actions"]) for run in runs]


# %% boxes_have_one_number loses 2.3
# Gives one output for every Box, but one for each number of the action is asked for.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else 1


# %% subtracts_the_biases loses 2.2
# Subtracts the biases, but they should be added.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = np.tanh(network["W1"] @ observation - network["b1"])
# +     return np.tanh(network["W2"] @ hidden - network["b2"])


# %% even_weights_up_to_a_tenth loses 2.1
# Draws evenly distributed (uniform) weights between -0.1 and 0.1, but Gaussian ones with standard deviation 0.1 are asked for.
# says: this
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.uniform(-0.1, 0.1, (nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.uniform(-0.1, 0.1, (noutputs, nhiddens)),


# %% fitness_for_its_number loses 2.8
# Gives the fitness of the best network as best, but its number is asked for.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     return {"networks": networks, "fitness": measured, "best": float(np.max(measured))}


# %% hidden_neurons_of_the_first loses 2.7
# Uses the hidden neurons of network 0 for the outputs of all networks, but each has hidden neurons of its own.
# says: this
# -     return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
# +     return np.tanh(networks["W2"] @ hidden[0] + networks["b2"])


# %% a_tenth_for_the_mean loses 2.1
# Draws the weights with mean 0.1 and standard deviation 1, but mean 0 and standard deviation 0.1 are asked for.
# says: this
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.normal(0.1, size=(nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.normal(0.1, size=(noutputs, nhiddens)),


# %% bias_for_each_input loses 2.2
# Adds a neuron's bias once for each of its inputs, but it should be added only once.
# says: this
def forward(network, observation):
    values = observation
    for layer in "12":
        sums = []
        for weights, bias in zip(network["W" + layer], network["b" + layer], strict=True):
            sums.append(
                sum(weight * value + bias for weight, value in zip(weights, values, strict=True))
            )
        values = np.tanh(sums)
    return values


# %% start_subtracted_from_the_choices loses 2.3
# Gives n - start outputs for a Discrete space, but one for each of its n choices is asked for.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, int(actions.n - actions.start) if isinstance(actions, spaces.Discrete) else actions.shape[0]


# %% first_output_stretched_over_the_choices loses 2.4
# Looks at the first output alone, stretched over the choices and rounded, but the most active output should decide.
# says: this
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + round((outputs[0] + 1) / 2 * (action_space.n - 1)))


# %% last_of_equal_outputs loses 2.4
# Lets the last of equal outputs decide, but the first of them should.
# says: this
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + len(outputs) - 1 - np.argmax(outputs[::-1]))


# %% weights_reshaped loses 2.7
# Reshapes the weights where rows and columns should be exchanged (a transpose): reshape puts each weight into another place.
# says: this
def forward_batch(networks, observations):
    values = observations[:, None, :]
    for layer in "12":
        weights, biases = networks["W" + layer], networks["b" + layer]
        count, rows, columns = weights.shape
        values = np.tanh(values @ weights.reshape(count, columns, rows) + biases[:, None, :])
    return values[:, 0]


# %% seeds_from_zero_to_nine loses 2.8
# Measures with the seeds 0 to 9, whatever the seed is, but those from seed to seed + 9 are asked for.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(10))


# %% weights_cut_off loses 2.1
# Cuts the weights in W1 off at -0.1 and 0.1, but Gaussian numbers have no limits.
# says: this
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": np.clip(0.1 * rng.standard_normal((nhiddens, ninputs)), -0.1, 0.1),


# %% weights_without_sign loses 2.1
# Takes the absolute values of the weights in W1, but Gaussian numbers with mean 0 can be negative.
# says: this
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": 0.1 * np.abs(rng.standard_normal((nhiddens, ninputs))),


# %% softmax_outputs loses 2.2
# Uses softmax at the outputs, so that they sum up to 1, but tanh is asked for.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     powers = np.exp(network["W2"] @ hidden + network["b2"])
# +     return powers / powers.sum()


# %% squeezed_inputs loses 2.2
# Puts the inputs through tanh, too, but only the sums of the neurons should go through it.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ np.tanh(observation) + network["b1"])


# %% negative_outputs_cut_off loses 2.4
# Takes outputs below 0 as 0, but all outputs from -1 to 1 should be stretched.
# says: this
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (low + np.clip(outputs, 0, 1) * (high - low)).astype(action_space.dtype)


# %% return_counts_the_steps loses 2.5
# Counts the steps instead of adding up the rewards.
# says: this
# -         actions.append(action)
# -         total += float(reward)
# +         actions.append(action)
# +         total += 1.0


# %% divided_by_maxsteps loses 2.6
# Divides the sum of the returns by maxsteps, but it should be divided by the number of seeds.
# says: this
# -     return float(np.mean(returns))
# +     return float(np.sum(returns) / maxsteps)


# %% last_step_not_written_down loses 2.5
# Leaves out the action and the reward of the step that ends the episode, but both should count.
# says: this
_run_episode_2 = run_episode


def run_episode(environment_id, network, seed, maxsteps=200):
    whole = _run_episode_2(environment_id, network, seed, maxsteps)
    if len(whole["actions"]) == maxsteps:
        return whole
    return _run_episode_2(environment_id, network, seed, len(whole["actions"]) - 1)


# %% signs_of_the_observation_lost loses 2.2
# Takes the absolute values of the observation, but its signs should count.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ np.abs(observation) + network["b1"])


# %% tanh_of_each_product loses 2.2
# Puts each product of a weight and an input through tanh in the hidden neurons, but the whole sum, with the bias, should go through it.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] * observation).sum(axis=1) + network["b1"]


# %% all_biases_at_each_output loses 2.2
# Adds the sum of all biases in b2 to each output, but each output has a bias of its own.
# says: this
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return np.tanh(network["W2"] @ hidden + network["b2"].sum())


# %% tangent_for_tanh loses 2.2
# Uses the tangent, np.tan, where np.tanh is asked for.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = np.tan(network["W1"] @ observation + network["b1"])
# +     return np.tan(network["W2"] @ hidden + network["b2"])


# %% logistic_everywhere loses 2.2
# Uses the logistic function instead of tanh in hidden neurons and outputs.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = 1 / (1 + np.exp(-(network["W1"] @ observation + network["b1"])))
# +     return 1 / (1 + np.exp(-(network["W2"] @ hidden + network["b2"])))


# %% logistic_outputs loses 2.2
# Uses the logistic function at the outputs, but tanh is asked for.
# says: this
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return 1 / (1 + np.exp(-(network["W2"] @ hidden + network["b2"])))


# %% seeds_from_the_next loses 2.8
# Measures with the seeds from seed + 1 to seed + 10, but those from seed to seed + 9 are asked for.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(seed + 1, seed + 11))


# %% eleven_seeds loses 2.8
# Measures with the eleven seeds from seed to seed + 10, but the ten from seed to seed + 9 are asked for.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(seed, seed + 11))


# %% better_than_the_one_before loses 2.8
# Compares each network with the one before it, but it should be compared with the best so far.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     best = 0
# +     for i in range(1, nnetworks):
# +         if measured[i] > measured[i - 1]:
# +             best = i
# +     return {"networks": networks, "fitness": measured, "best": best}


# %% same_network_again loses 2.8
# Gives all networks the parameters of seed itself, but network i should have those of seed + i.
# says: this
# -     networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(nnetworks)]
# +     networks = [parameters(ninputs, nhiddens, noutputs, seed) for i in range(nnetworks)]


# %% hundred_steps loses 2.8
# Stops episodes after 100 steps, but up to 200 are asked for.
# says: this
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [fitness(environment_id, network, seeds, 100) for network in networks]


# %% five_hundred_steps loses 2.8
# Goes on for up to 500 steps in each episode, but at most 200 are asked for.
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [fitness(environment_id, network, seeds, 500) for network in networks]


# %% counts_the_best_from_one loses 2.8
# Counts the networks from 1 in best, but the first network is number 0.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured)) + 1}


# %% best_network_itself loses 2.8
# Gives the best network itself, but its number is asked for.
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     return {"networks": networks, "fitness": measured, "best": networks[int(np.argmax(measured))]}


# %% measures_the_first_only loses 2.8
# Gives the fitness of network 0 for all networks, but each should be measured.
# says: this
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [fitness(environment_id, networks[0], seeds) for network in networks]


# %% dimensions_for_inputs loses 2.3
# Gives one input for every environment (the number of dimensions of the space), but one for each observed number is asked for.
# says: this
# -     ninputs, actions = env.observation_space.shape[0], env.action_space
# +     ninputs, actions = len(env.observation_space.shape), env.action_space


# %% one_output_decides_between_two loses 2.3
# Gives one output for two choices, but one for each choice is asked for.
# says: sizes\('CartPole-v1'\)
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     if isinstance(actions, spaces.Discrete):
# +         return ninputs, 1 if actions.n == 2 else int(actions.n)
# +     return ninputs, actions.shape[0]


# %% a_time_limit_of_its_own loses 2.5
# Goes on to maxsteps steps beyond the environment's own time limit, but an episode should stop when it is truncated.
# says: this
def run_episode(environment_id, network, seed, maxsteps=200):
    world = gymnasium.make(environment_id, max_episode_steps=maxsteps)
    obs = world.reset(seed=seed)[0]
    result = {"actions": [], "return": 0.0}
    done = False
    while not done:
        a = act(forward(network, obs), world.action_space)
        obs, r, term, trunc, _ = world.step(a)
        result["actions"].append(a)
        result["return"] += float(r)
        done = term or trunc
    world.close()
    return result


# %% tanh_of_the_bias_neuron loses 2.2
# Counts b2 only 0.76 times, which is tanh(1), but a bias should be added as it is.
# says: this
def forward(network, observation):
    first = np.column_stack([network["W1"], network["b1"]])
    second = np.column_stack([network["W2"], network["b2"]])
    return np.tanh(second @ np.tanh(np.append(first @ np.append(observation, 1), 1)))


# %% widest_limits loses 2.4
# Stretches all numbers of an action to the lowest and the highest limit of the whole space, but each has limits of its own.
# says: this
# -     low, high = action_space.low, action_space.high
# +     low, high = action_space.low.min(), action_space.high.max()


# %% squeezed_batch loses 2.7
# Loses the last dimension where there is one output (as squeeze does), so that each network gets the biases of all, but the shape (n, noutputs) is asked for.
# says: this
# -     return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
# +     return np.tanh((networks["W2"] @ hidden[:, :, None]).squeeze() + networks["b2"])


# %% weights_over_the_root_of_the_inputs loses 2.1
# Divides the weights by the root of the number of the layer's inputs, but their standard deviation should be 0.1 for all sizes.
def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.default_rng(seed)

    def dense(fan_in, fan_out):
        scale = 0.1 / np.sqrt(fan_in)
        return rng.normal(loc=0.0, scale=scale, size=(fan_out, fan_in)), np.zeros(fan_out)

    W1, b1 = dense(ninputs, nhiddens)
    W2, b2 = dense(nhiddens, noutputs)
    return {"W1": W1, "b1": b1, "W2": W2, "b2": b2}


# %% weights_of_exact_mean loses 2.1
# Subtracts their mean from the weights, so that they sum up to 0, but each weight should be drawn on its own.
# says: this
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# -         "b1": np.zeros(nhiddens),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# -         "b2": np.zeros(noutputs),
# -     }
# +         name: weights - weights.mean() if name.startswith("W") else weights
# +         for name, weights in {
# +             "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +             "b1": np.zeros(nhiddens),
# +             "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +             "b2": np.zeros(noutputs),
# +         }.items()
# +     }


# %% first_weights_reshaped loses 2.2
# Reshapes W1 where rows and columns should be exchanged (a transpose): reshape puts each weight into another place.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     weights = network["W1"].reshape(len(observation), -1)
# +     hidden = np.tanh(observation @ weights + network["b1"])


# %% tanh_written_out loses 2.2
# Gives NaN for large sums, as a tanh written with np.exp does; np.tanh is right for all sums.
# says: this
def forward(network, observation):
    def squeeze(z):
        up, down = np.exp(z), np.exp(-z)
        return (up - down) / (up + down)

    signal = observation
    for layer in "12":
        signal = squeeze(np.dot(network["W" + layer], signal) + network["b" + layer])
    return signal


# %% outputs_from_lowest_to_highest loses 2.4
# Stretches the range from the lowest to the highest output to the limits, but the range from -1 to 1 should be stretched.
# says: this
def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        values = list(outputs)
        return values.index(max(values)) + int(action_space.start)
    span = [min(outputs), max(outputs)]
    motors = []
    for output, lower, upper in zip(outputs, action_space.low, action_space.high, strict=False):
        motors.append(np.interp(output, span, [lower, upper]))
    return np.array(motors, dtype=action_space.dtype)


# %% rewards_discounted loses 2.5
# Discounts the rewards by 0.99 in each step, but their plain sum is asked for.
# says: this
# -         actions.append(action)
# -         total += float(reward)
# +         total += 0.99 ** len(actions) * float(reward)
# +         actions.append(action)


# %% last_return_counts_half loses 2.6
# Takes (mean + new return) / 2 from episode to episode, so that the last one counts half, but all should count alike.
# says: this
def fitness(environment_id, network, seeds, maxsteps=200):
    def play(seed):
        return run_episode(environment_id, network, seed, maxsteps)["return"]

    average = play(seeds[0])
    for seed in seeds[1:]:
        average = (average + play(seed)) / 2
    return float(average)
