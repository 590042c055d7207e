"""Wrong solutions of exercise 2; building.py describes how a case is written."""

# %% random_biases loses 2.1
# Draws the biases, too.
# says: b1 must be all zeros
_parameters = parameters


def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.default_rng(seed + 1)
    biases = {"b1": 0.1 * rng.normal(size=nhiddens), "b2": 0.1 * rng.normal(size=noutputs)}
    return {**_parameters(ninputs, nhiddens, noutputs, seed), **biases}


# %% seeded_for_each_layer loses 2.1
# Seeds again for the second layer, which gets the numbers of the first.
def parameters(ninputs, nhiddens, noutputs, seed):
    return {
        "W1": 0.1 * np.random.default_rng(seed).standard_normal((nhiddens, ninputs)),
        "b1": np.zeros(nhiddens),
        "W2": 0.1 * np.random.default_rng(seed).standard_normal((noutputs, nhiddens)),
        "b2": np.zeros(noutputs),
    }


# %% uniform_weights loses 2.1
# Uniform instead of Gaussian numbers, with the right deviation.
# -     rng = np.random.default_rng(seed)
# +     rng = np.random.default_rng(seed)
# +     limit = 0.1 * 3**0.5
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.uniform(-limit, limit, (nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.uniform(-limit, limit, (noutputs, nhiddens)),


# %% variance_for_deviation loses 2.1
# Takes 0.1 for the variance: the weights are three times too large.
# says: standard deviation 0\.3
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.normal(0, 0.1**0.5, (nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.normal(0, 0.1**0.5, (noutputs, nhiddens)),


# %% biases_forgotten loses 2.2
# Leaves out the biases, which are 0 in random networks, but not in evolved ones.
# says: The biases are left out
def forward(network, observation):
    return np.tanh(network["W2"] @ np.tanh(network["W1"] @ observation))


# %% linear_outputs loses 2.2
# Forgets tanh at the outputs: their order stays, so discrete actions are right.
# says: tanh is left out at the outputs
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return network["W2"] @ hidden + network["b2"]


# %% multiplies_from_the_wrong_side loses 2.2
# Multiplies from the wrong side.
# says: transpose one|exchange the two sides
def forward(network, observation):
    hidden = np.tanh(observation @ network["W1"] + network["b1"])
    return np.tanh(hidden @ network["W2"] + network["b2"])


# %% reshaped_in_place loses 2.2
# Makes columns of the biases in the network itself.
def forward(network, observation):
    values = observation[:, None]
    for layer in "12":
        network["b" + layer].shape = (-1, 1)
        values = np.tanh(network["W" + layer] @ values + network["b" + layer])
    return values[:, 0]


# %% one_output_for_discrete loses 2.3
# One output whatever the number of choices.
def sizes(environment_id):
    env = gymnasium.make(environment_id)
    return env.observation_space.shape[0], 1


# %% raw_outputs loses 2.4
# Uses the outputs of a Box as they are: Pendulum's motor gives half of its torque.
# says: stretch them to the space's limits
# -     low, high = action_space.low, action_space.high
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return np.asarray(outputs, dtype=np.float32)


# %% same_limits_for_all loses 2.4
# Stretches every number by the upper limit of the first, which one-motor robots forgive.
# -     low, high = action_space.low, action_space.high
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (outputs * action_space.high[0]).astype(np.float32)


# %% start_ignored loses 2.4
# The first choice is always 0.
_act = act


def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        return int(np.argmax(outputs))
    return _act(outputs, action_space)


# %% last_reward_missing loses 2.5
# The return leaves out the reward of the last step.
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
# Does all of the steps, even when the pole has fallen or the goal is reached.
# says: is over after 10 steps
# -     terminated = truncated = False
# -     while len(actions) < maxsteps and not (terminated or truncated):
# +     for _ in range(maxsteps):
# -         observation, reward, terminated, truncated, _ = env.step(action)
# +         observation, reward, _, _, _ = env.step(action)
# -         total += float(reward)
# -     env.close()
# +         total += float(reward)


# %% no_limit_of_steps loses 2.5
# Ignores maxsteps.
_run_episode = run_episode


def run_episode(environment_id, network, seed, maxsteps=200):
    return _run_episode(environment_id, network, seed, 10_000)


# %% reset_without_seed loses 2.5
# The seed is not passed to reset.
# says: do not come from the seed
# -     observation, _ = env.reset(seed=seed)
# +     observation, _ = env.reset()
# -         total += float(reward)
# -     env.close()
# +         total += float(reward)


# %% sum_of_returns loses 2.6
# Sums the returns instead of averaging them.
# says: It is the sum of the returns
def fitness(environment_id, network, seeds, maxsteps=200):
    return sum(run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds)


# %% ten_times_the_first_seed loses 2.6
# Every episode begins with the first seed.
def fitness(environment_id, network, seeds, maxsteps=200):
    runs = [run_episode(environment_id, network, seeds[0], maxsteps) for _ in seeds]
    return float(np.mean([run["return"] for run in runs]))


# %% first_network_for_all loses 2.7
# Uses the second layer of the first network for all of them.
def forward_batch(networks, observations):
    hidden = np.einsum("nhi,ni->nh", networks["W1"], observations) + networks["b1"]
    return np.tanh(np.tanh(hidden) @ networks["W2"][0].T + networks["b2"])


# %% loop_over_networks loses 2.7
# Right, but a loop over the networks.
def forward_batch(networks, observations):
    return np.array(
        [
            forward({key: stack[i] for key, stack in networks.items()}, observations[i])
            for i in range(len(observations))
        ]
    )


# %% last_of_equals loses 2.8
# Of networks with equal fitness, takes the last.
_random_search = random_search


def random_search(environment_id, nnetworks, nhiddens, seed):
    report = _random_search(environment_id, nnetworks, nhiddens, seed)
    order = sorted(range(nnetworks), key=lambda i: report["fitness"][i])
    return {**report, "best": order[-1]}


# %% lowest_fitness loses 2.8
# Picks the network with the lowest fitness.
_random_search = random_search


def random_search(environment_id, nnetworks, nhiddens, seed):
    report = _random_search(environment_id, nnetworks, nhiddens, seed)
    return {**report, "best": int(np.argmin(report["fitness"]))}


# %% own_episodes_for_each loses 2.8
# Every network meets other episodes, so their fitness cannot be compared.
# -     seeds = list(range(seed, seed + 10))
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [
# +         fitness(environment_id, network, range(seed + 10 * i, seed + 10 * i + 10))
# +         for i, network in enumerate(networks)
# +     ]


# %% renames_a_function loses 2.8
# Renames a function it calls.
# says: fitnes' is not defined. Did you mean
def random_search(environment_id, nnetworks, nhiddens, seed):
    return fitnes(environment_id, parameters(4, nhiddens, 2, seed), range(10))


# %% second_layer_from_the_next_seed loses 2.1
# W2 is drawn from seed + 1, with which W1 of the next network begins.
# says: are also in the network of seed
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": 0.1 * np.random.default_rng(seed + 1).standard_normal((noutputs, nhiddens)),


# %% counts_up_to_the_last_choice loses 2.3
# Adds the number of the first choice to the number of choices.
# says: start=5
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     if isinstance(actions, spaces.Discrete):
# +         return ninputs, int(actions.start + actions.n)
# +     return ninputs, actions.shape[0]


# %% beats_zero loses 2.4
# Looks for an output above 0: where all are negative, the first wins.
# -         return int(action_space.start + np.argmax(outputs))
# +         best, highest = 0, 0.0
# +         for number, output in enumerate(outputs):
# +             if output > highest:
# +                 best, highest = number, output
# +         return int(action_space.start + best)


# %% stretches_in_place loses 2.4
# Stretches the outputs themselves.
# says: they must stay as they are
# -     low, high = action_space.low, action_space.high
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     outputs += 1
# +     outputs *= (action_space.high - action_space.low) / 2
# +     outputs += action_space.low
# +     return outputs


# %% each_seed_once loses 2.6
# Makes a set of the seeds, so that a seed counts once.
# says: seeds=
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     returns = [run_episode(environment_id, network, s, maxsteps)["return"] for s in set(seeds)]


# %% biases_reshaped_in_place loses 2.7
# Makes columns of the biases of the networks that it was given.
# says: of what it was given
def forward_batch(networks, observations):
    values = observations[:, :, None]
    for layer in "12":
        biases = networks["b" + layer]
        biases.shape = (*biases.shape[:2], 1)
        values = np.tanh(networks["W" + layer] @ values + biases)
    return values[:, :, 0]


# %% better_than_zero loses 2.8
# The highest fitness begins at 0, so that a negative one never beats it.
# says: must be
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     best, highest = 0, 0
# +     for number, value in enumerate(measured):
# +         if value > highest:
# +             best, highest = number, value
# +     return {"networks": networks, "fitness": measured, "best": best}


# %% zero_is_no_seed loses 2.1
# Takes the seed 0 for no seed at all.
# -     rng = np.random.default_rng(seed)
# +     rng = np.random.default_rng(seed or None)


# %% episode_without_seed_zero loses 2.5
# Takes the seed 0 for no seed at all.
# -     observation, _ = env.reset(seed=seed)
# +     observation, _ = env.reset(seed=seed if seed else None)


# %% five_hundred_by_default loses 2.5
# An episode of which no maxsteps are given has 500 steps instead of 200.
_run_episode = run_episode


def run_episode(environment_id, network, seed, maxsteps=500):
    return _run_episode(environment_id, network, seed, maxsteps)


# %% rounds_the_outputs loses 2.4
# Rounds the outputs to two places before it compares them.
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + np.argmax(np.round(outputs, 2)))


# %% sorts_the_seeds loses 2.6
# Sorts the list of seeds that it was given.
_fitness = fitness


def fitness(environment_id, network, seeds, maxsteps=200):
    if isinstance(seeds, list):
        seeds.sort()
    return _fitness(environment_id, network, seeds, maxsteps)


# %% remembers_a_search loses 2.8
# Remembers a search by its environment and sizes, and gives it again for another seed.
_random_search, _kept = random_search, {}


def random_search(environment_id, nnetworks, nhiddens, seed):
    key = environment_id, nnetworks, nhiddens
    if key not in _kept:
        _kept[key] = _random_search(environment_id, nnetworks, nhiddens, seed)
    return _kept[key]


# %% whole_actions loses 2.4
# Gives whole numbers in a Box.
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (low + (outputs + 1) / 2 * (high - low)).astype(int)


# %% median_return loses 2.6
# Takes the median of the returns.
# -     return float(np.mean(returns))
# +     return float(np.median(returns))


# %% squeezed loses 2.7
# Squeezes all axes of length 1, so that one network, or one output, loses an axis.
# -     hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"])
# -     return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
# +     hidden = np.tanh((networks["W1"] @ observations[:, :, None]).squeeze() + networks["b1"])
# +     return np.tanh((networks["W2"] @ hidden[:, :, None]).squeeze() + networks["b2"])


# %% goal_not_counted loses 2.5
# Stops before it counts the reward of a step that ends the episode by itself.
# -         actions.append(action)
# -         total += float(reward)
# +         actions.append(action)
# +         total += 0.0 if terminated else float(reward)


# %% logistic_hidden loses 2.2
# Uses the logistic function in the hidden neurons.
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
# Computes every action from the first observation.
# -         observation, reward, terminated, truncated, _ = env.step(action)
# -         actions.append(action)
# +         _, reward, terminated, truncated, _ = env.step(action)
# +         actions.append(action)


# %% network_remembered loses 2.1
# Remembers a network and gives the very same arrays again, whatever was done to them.
# says: gives the changed arrays
_parameters, _networks = parameters, {}


def parameters(ninputs, nhiddens, noutputs, seed):
    key = ninputs, nhiddens, noutputs, seed
    if key not in _networks:
        _networks[key] = _parameters(*key)
    return _networks[key]


# %% scaled_by_the_layer loses 2.1
# Divides the second layer by the root of the number of hidden neurons instead of multiplying by 0.1.
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.standard_normal((noutputs, nhiddens)) / np.sqrt(nhiddens),


# %% bias_after_tanh loses 2.2
# Adds the biases of the hidden neurons after tanh.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ observation) + network["b1"]


# %% rectified_hidden loses 2.2
# Uses the larger of 0 and the sum in the hidden neurons.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.maximum(0, network["W1"] @ observation + network["b1"])


# %% bias_of_the_first loses 2.2
# Adds the first bias to all hidden neurons.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ observation + network["b1"][0])


# %% observation_normalised loses 2.2
# Divides the observation by its length.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ (observation / np.linalg.norm(observation)) + network["b1"])


# %% rounded_outputs loses 2.2
# Rounds the outputs to four places.
# says: this
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return np.round(np.tanh(network["W2"] @ hidden + network["b2"]), 4)


# %% one_for_each_limit loses 2.3
# Counts two outputs for each number of a Box, for its two limits.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else 2 * actions.shape[0]


# %% largest_by_size loses 2.4
# Takes the output with the largest absolute value.
# says: this
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + np.argmax(np.abs(outputs)))


# %% from_the_lower_limit loses 2.4
# Forgets that the outputs begin at -1.
# says: this
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (low + outputs * (high - low)).astype(action_space.dtype)


# %% half_the_range loses 2.4
# Stretches around 0 by half of the range, not around the middle.
# -     return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
# +     return (outputs * (high - low) / 2).astype(action_space.dtype)


# %% two_choices_by_sign loses 2.4
# Decides between two choices by the sign of the first output.
# -         return int(action_space.start + np.argmax(outputs))
# +         if action_space.n == 2:
# +             return int(action_space.start + (outputs[0] < 0))
# +         return int(action_space.start + np.argmax(outputs))


# %% draws_among_equals loses 2.4
# Draws one of the most active outputs by lot.
# says: Two calls with the same
# -         return int(action_space.start + np.argmax(outputs))
# +         equal = np.flatnonzero(outputs == np.max(outputs))
# +         return int(action_space.start + np.random.default_rng().choice(equal))


# %% one_action_late loses 2.5
# Acts by the observation before the last one.
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
# Divides the sum of the rewards by the number of steps.
# says: this
# -     return {"actions": actions, "return": total}
# +     return {"actions": actions, "return": total / len(actions)}


# %% whole_return loses 2.5
# Makes a whole number of every reward.
# says: this
# -         total += float(reward)
# +         total += int(reward)


# %% maxsteps_not_passed loses 2.6
# Does not pass maxsteps on.
# says: this
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     returns = [run_episode(environment_id, network, seed)["return"] for seed in seeds]


# %% divides_by_ten loses 2.6
# Divides by 10 however many seeds there are.
# says: this
# -     return float(np.mean(returns))
# +     return float(np.sum(returns) / 10)


# %% counts_seeds_from_the_first loses 2.6
# Uses the first seed and those that follow it.
# says: this
# -     returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
# +     returns = [run_episode(environment_id, network, seeds[0] + i, maxsteps)["return"] for i in range(len(seeds))]


# %% divided_as_whole_numbers loses 2.6
# Divides with // and loses the fraction.
# says: this
# -     return float(np.mean(returns))
# +     return float(sum(returns) // len(returns))


# %% rounded_to_three_places loses 2.6
# Rounds the fitness to three places.
# -     return float(np.mean(returns))
# +     return round(float(np.mean(returns)), 3)


# %% first_biases_for_all loses 2.7
# Adds the biases of network 0 to all.
# says: this
# -     hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"])
# +     hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"][0])


# %% nine_seeds loses 2.8
# Measures with the seeds from seed to seed + 8.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(seed, seed + 9))


# %% sorted_networks loses 2.8
# Sorts networks and fitness, the best first.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     order = np.argsort(-np.array(measured), kind="stable")
# +     networks, measured = [networks[i] for i in order], [measured[i] for i in order]
# +     return {"networks": networks, "fitness": measured, "best": 0}


# %% seeds_from_one loses 2.8
# Numbers the networks from 1.
# says: network i has
# -     networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(nnetworks)]
# +     networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(1, nnetworks + 1)]


# %% beats_minus_2000 loses 2.8
# The highest fitness begins at -2000, which no robot of this course falls below.
# says: all returns are
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     best, highest = 0, -2000.0
# +     for i, value in enumerate(measured):
# +         if value > highest:
# +             best, highest = i, value
# +     return {"networks": networks, "fitness": measured, "best": best}


# %% stops_when_solved loses 2.8
# Ends the search as soon as a network reaches 195.
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = []
# +     for network in networks:
# +         measured.append(fitness(environment_id, network, seeds))
# +         if measured[-1] >= 195:
# +             break
# +     networks = networks[: len(measured)]


# %% one_output_for_all_choices loses 2.3
# A discrete action gets one output, but each choice needs its own.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, 1 if isinstance(actions, spaces.Discrete) else actions.shape[0]


# %% seeds_of_its_own_for_each_network loses 2.8
# The networks meet different episodes: the seeds move on with the number of the network.
# says: this
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [
# +         fitness(environment_id, networks[i], [i + each for each in seeds])
# +         for i in range(nnetworks)
# +     ]


# %% a_single_episode_each loses 2.8
# Each network is measured in one episode only, with the seed itself.
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
# Takes it for granted that an action of a Box is one number.
# says: this
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else 1


# %% subtracts_the_biases loses 2.2
# Subtracts the biases, as if they were thresholds.
# says: The biases are subtracted
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = np.tanh(network["W1"] @ observation - network["b1"])
# +     return np.tanh(network["W2"] @ hidden - network["b2"])


# %% even_weights_up_to_a_tenth loses 2.1
# Draws the weights evenly between -0.1 and 0.1.
# says: evenly distributed
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.uniform(-0.1, 0.1, (nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.uniform(-0.1, 0.1, (noutputs, nhiddens)),


# %% fitness_for_its_number loses 2.8
# Gives the fitness of the best network for its number.
# says: but its number is asked for
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     return {"networks": networks, "fitness": measured, "best": float(np.max(measured))}


# %% hidden_neurons_of_the_first loses 2.7
# Gives the hidden neurons of network 0 to all.
# says: hidden neurons of network 0
# -     return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
# +     return np.tanh(networks["W2"] @ hidden[0] + networks["b2"])


# %% a_tenth_for_the_mean loses 2.1
# Gives 0.1 as the mean of the random numbers, whose deviation stays 1.
# says: not the mean
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": rng.normal(0.1, size=(nhiddens, ninputs)),
# -         "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
# +         "W2": rng.normal(0.1, size=(noutputs, nhiddens)),


# %% bias_for_each_input loses 2.2
# Adds a neuron's bias inside the loop over its inputs, once for each.
# says: once for each of its inputs
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
# Subtracts the start of the space from the number of choices.
# says: The start of the space is subtracted
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     return ninputs, int(actions.n - actions.start) if isinstance(actions, spaces.Discrete) else actions.shape[0]


# %% first_output_stretched_over_the_choices loses 2.4
# Stretches the first output over the choices and rounds it.
# says: The first output alone decides
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + round((outputs[0] + 1) / 2 * (action_space.n - 1)))


# %% last_of_equal_outputs loses 2.4
# Lets the last of equal outputs decide.
# says: the last one decides
# -         return int(action_space.start + np.argmax(outputs))
# +         return int(action_space.start + len(outputs) - 1 - np.argmax(outputs[::-1]))


# %% weights_reshaped loses 2.7
# Reshapes the weights where rows and columns must be exchanged.
# says: The weights are reshaped
def forward_batch(networks, observations):
    values = observations[:, None, :]
    for layer in "12":
        weights, biases = networks["W" + layer], networks["b" + layer]
        count, rows, columns = weights.shape
        values = np.tanh(values @ weights.reshape(count, columns, rows) + biases[:, None, :])
    return values[:, 0]


# %% seeds_from_zero_to_nine loses 2.8
# Measures with the seeds 0 to 9, whatever the seed is.
# says: the seeds 0 to 9
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(10))


# %% weights_cut_off loses 2.1
# Cuts the weights off at 0.1.
# says: Gaussian numbers have no limits
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": np.clip(0.1 * rng.standard_normal((nhiddens, ninputs)), -0.1, 0.1),


# %% weights_without_sign loses 2.1
# Takes the absolute values of the weights.
# says: None of them is negative
# -         "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
# +         "W1": 0.1 * np.abs(rng.standard_normal((nhiddens, ninputs))),


# %% softmax_outputs loses 2.2
# Makes shares of 1 of the outputs.
# says: softmax
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     powers = np.exp(network["W2"] @ hidden + network["b2"])
# +     return powers / powers.sum()


# %% squeezed_inputs loses 2.2
# Squeezes the inputs, too.
# says: The inputs go through tanh
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ np.tanh(observation) + network["b1"])


# %% negative_outputs_cut_off loses 2.4
# Cuts off outputs below 0.
# says: Outputs below 0 are cut off
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
# Divides the sum of the returns by maxsteps.
# says: this
# -     return float(np.mean(returns))
# +     return float(np.sum(returns) / maxsteps)


# %% last_step_not_written_down loses 2.5
# Leaves the loop at the end of the episode before the last action and reward are written down.
# says: ends the episode of this seed
_run_episode_2 = run_episode


def run_episode(environment_id, network, seed, maxsteps=200):
    whole = _run_episode_2(environment_id, network, seed, maxsteps)
    if len(whole["actions"]) == maxsteps:
        return whole
    return _run_episode_2(environment_id, network, seed, len(whole["actions"]) - 1)


# %% signs_of_the_observation_lost loses 2.2
# Takes the absolute values of the observation.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] @ np.abs(observation) + network["b1"])


# %% tanh_of_each_product loses 2.2
# Puts each product of a weight and an input through tanh, not their sum.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     hidden = np.tanh(network["W1"] * observation).sum(axis=1) + network["b1"]


# %% all_biases_at_each_output loses 2.2
# Adds the biases of all outputs to each output.
# says: this
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return np.tanh(network["W2"] @ hidden + network["b2"].sum())


# %% tangent_for_tanh loses 2.2
# Uses np.tan, the tangent, where np.tanh is asked for.
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
# Uses the logistic function at the outputs, where tanh is asked for.
# says: logistic function where tanh
# -     return np.tanh(network["W2"] @ hidden + network["b2"])
# +     return 1 / (1 + np.exp(-(network["W2"] @ hidden + network["b2"])))


# %% seeds_from_the_next loses 2.8
# Measures with the seeds from seed + 1 to seed + 10.
# says: seed \+ 1 to seed \+ 10
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(seed + 1, seed + 11))


# %% eleven_seeds loses 2.8
# Measures with eleven seeds, from seed to seed + 10.
# says: this
# -     seeds = list(range(seed, seed + 10))
# +     seeds = list(range(seed, seed + 11))


# %% better_than_the_one_before loses 2.8
# Compares each network with the one before it, not with the best so far.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     best = 0
# +     for i in range(1, nnetworks):
# +         if measured[i] > measured[i - 1]:
# +             best = i
# +     return {"networks": networks, "fitness": measured, "best": best}


# %% same_network_again loses 2.8
# Gives all networks the parameters of the seed itself, but network i has those of seed + i.
# says: is the same in some networks|the seed itself
# -     networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(nnetworks)]
# +     networks = [parameters(ninputs, nhiddens, noutputs, seed) for i in range(nnetworks)]


# %% hundred_steps loses 2.8
# Ends each episode after 100 steps.
# says: this
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [fitness(environment_id, network, seeds, 100) for network in networks]


# %% five_hundred_steps loses 2.8
# Goes on for up to 500 steps in each episode, but 200 are asked for.
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [fitness(environment_id, network, seeds, 500) for network in networks]


# %% counts_the_best_from_one loses 2.8
# Counts the number of the best network from 1.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured)) + 1}


# %% best_network_itself loses 2.8
# Gives the best network itself, but its number is asked for.
# says: this
# -     return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
# +     return {"networks": networks, "fitness": measured, "best": networks[int(np.argmax(measured))]}


# %% measures_the_first_only loses 2.8
# Measures network 0 again and again, and gives its fitness for all networks.
# says: this
# -     measured = [fitness(environment_id, network, seeds) for network in networks]
# +     measured = [fitness(environment_id, networks[0], seeds) for network in networks]


# %% dimensions_for_inputs loses 2.3
# Gives the number of dimensions of the observation space, but how many numbers it has is asked for.
# says: this
# -     ninputs, actions = env.observation_space.shape[0], env.action_space
# +     ninputs, actions = len(env.observation_space.shape), env.action_space


# %% one_output_decides_between_two loses 2.3
# Two choices get one output, but each choice needs its own.
# says: Each of the 2 choices
# -     return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
# +     if isinstance(actions, spaces.Discrete):
# +         return ninputs, 1 if actions.n == 2 else int(actions.n)
# +     return ninputs, actions.shape[0]


# %% a_time_limit_of_its_own loses 2.5
# Goes on to maxsteps steps although the environment's own time limit ends the episode before.
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
# Applies tanh to the constant 1 that stands for the bias of the second layer, too: b2 counts 0.76 times.
# says: this
def forward(network, observation):
    first = np.column_stack([network["W1"], network["b1"]])
    second = np.column_stack([network["W2"], network["b2"]])
    return np.tanh(second @ np.tanh(np.append(first @ np.append(observation, 1), 1)))


# %% widest_limits loses 2.4
# Stretches all numbers of an action to the lowest and the highest limit of the whole space, but each has its own.
# says: this
# -     low, high = action_space.low, action_space.high
# +     low, high = action_space.low.min(), action_space.high.max()


# %% squeezed_batch loses 2.7
# With one output, the biases are added to outputs that have lost their dimension (squeeze): each network gets the biases of all.
# says: this
# -     return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
# +     return np.tanh((networks["W2"] @ hidden[:, :, None]).squeeze() + networks["b2"])


# %% weights_over_the_root_of_the_inputs loses 2.1
# Divides the weights by the root of the layer's inputs.
def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.default_rng(seed)

    def dense(fan_in, fan_out):
        scale = 0.1 / np.sqrt(fan_in)
        return rng.normal(loc=0.0, scale=scale, size=(fan_out, fan_in)), np.zeros(fan_out)

    W1, b1 = dense(ninputs, nhiddens)
    W2, b2 = dense(nhiddens, noutputs)
    return {"W1": W1, "b1": b1, "W2": W2, "b2": b2}


# %% weights_of_exact_mean loses 2.1
# Subtracts the mean of the weights drawn, so that they sum up to 0.
# says: sum up to 0
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
# Reshapes W1 where rows and columns must be exchanged.
# says: this
# -     hidden = np.tanh(network["W1"] @ observation + network["b1"])
# +     weights = network["W1"].reshape(len(observation), -1)
# +     hidden = np.tanh(observation @ weights + network["b1"])


# %% tanh_written_out loses 2.2
# Writes tanh with exponentials, which overflow for large sums: the quotient is NaN.
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
# Stretches from the lowest to the highest of the outputs, not from -1 to 1.
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
# Discounts the rewards: the return is their plain sum.
# says: this
# -         actions.append(action)
# -         total += float(reward)
# +         total += 0.99 ** len(actions) * float(reward)
# +         actions.append(action)


# %% last_return_counts_half loses 2.6
# Takes (mean + new return) / 2 from episode to episode, so that the last one counts half.
# says: this
def fitness(environment_id, network, seeds, maxsteps=200):
    def play(seed):
        return run_episode(environment_id, network, seed, maxsteps)["return"]

    average = play(seeds[0])
    for seed in seeds[1:]:
        average = (average + play(seed)) / 2
    return float(average)
