"""Wrong solutions of exercise 12; building.py describes how a case is written."""


# %% softmax_over_everything loses 12.1
# Divides by one sum over all rows, but each row should be divided by its own sum.
# says: this
def softmax(scores):
    powers = np.exp(np.asarray(scores, dtype=np.float64) - np.max(scores))
    return powers / powers.sum()


# %% softmax_overflows loses 12.1
# Takes exponentials of large scores that a floating-point number cannot hold, but the largest score of each row should be subtracted first.
# says: this
def softmax(scores):
    with np.errstate(all="ignore"):
        powers = np.exp(np.asarray(scores, dtype=np.float64))
        return powers / powers.sum(axis=-1, keepdims=True)


# %% dart_counted_from_the_end loses 12.2
# Gives action 0 the upper end of the ruler and the last action the lower end, but the probabilities should be laid down from action 0 on.
def choose(probabilities, rng):
    beyond = np.cumsum(np.asarray(probabilities)[::-1]) > rng.random()
    return len(probabilities) - 1 - int(np.argmax(beyond))


# %% most_probable_action loses 12.2
# Always takes the most probable action, but it should be drawn at random with these probabilities.
# says: this
def choose(probabilities, rng):
    rng.random()
    return int(np.argmax(probabilities))


# %% uniform_choice loses 12.2
# Gives all actions the same probability, but they should be drawn with the probabilities given.
def choose(probabilities, rng):
    return int(rng.random() * len(probabilities))


# %% last_reward_missing loses 12.3
# Leaves out the reward of the step that ends the episode, but all rewards should be added up.
# says: this
# -             observation, reward, terminated, truncated, _ = env.step(action)
# -             total += float(reward)
# +             observation, reward, terminated, truncated, _ = env.step(action)
# -                 break
# +                 break
# +             total += float(reward)


# %% counts_steps loses 12.3
# Counts the steps instead of adding up the rewards.
# says: this
# -             total += float(reward)
# +             total += 1


# %% negative_rewards_left_out loses 12.3
# Adds up only the positive rewards, but negative ones count, too.
# says: this
# -             total += float(reward)
# +             total += max(0.0, float(reward))


# %% whole_rewards loses 12.3
# Cuts off the fraction of each reward, but the rewards should be added up as they are.
# -             total += float(reward)
# +             total += int(reward)


# %% never_cut loses 12.3
# Gives the environment actions beyond the limits of its action space, but they should be cut to these limits first.
def run_episode(environment, act, seed, maxsteps=200):
    observations, actions, total = [], [], 0.0
    with gymnasium.make(environment) as env:
        observation, _ = env.reset(seed=seed)
        for _ in range(maxsteps):
            observations.append(observation)
            actions.append(act(observation))
            observation, reward, terminated, truncated, _ = env.step(actions[-1])
            total += float(reward)
            if terminated or truncated:
                break
    return {"observations": np.array(observations), "actions": np.array(actions), "return": total}


# %% never_truncated loses 12.3
# Goes on after the environment's own limit of steps, but the episode should end when terminated or truncated is True.
# -             observation, reward, terminated, truncated, _ = env.step(action)
# +             observation, reward, terminated, _, _ = env.step(action)
# -             if terminated or truncated:
# +             if terminated:


# %% no_limit_of_steps loses 12.3
# Goes on after maxsteps steps, but an episode should have at most maxsteps steps.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    return _run_episode(environment, act, seed, 210)


# %% records_cut_actions loses 12.3
# Records the actions cut to the limits, but they should be recorded as act chose them.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    found = _run_episode(environment, act, seed, maxsteps)
    with gymnasium.make(environment) as env:
        if isinstance(env.action_space, gymnasium.spaces.Box):
            found["actions"] = found["actions"].clip(env.action_space.low, env.action_space.high)
    return found


# %% records_the_next_observation loses 12.3
# Leaves out the observation that reset returns, so that the others stand one row too early; what was seen before each step is asked for.
# says: this
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    found = _run_episode(environment, act, seed, maxsteps)
    after = np.concatenate([found["observations"][1:], found["observations"][-1:]])
    return {**found, "observations": after}


# %% reset_without_seed loses 12.3
# Begins the episode as reset(seed=seed + 1) does, but reset(seed=seed) is asked for.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    return _run_episode(environment, act, seed + 1, maxsteps)


# %% keeps_everything loses 12.4
# Keeps all episodes, but only those with a return of at least the bound should be kept.
# says: this
_elite = elite


def elite(episodes, percentile):
    bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
    return {**_elite(episodes, 0), "bound": bound}


# %% keeps_only_above_the_bound loses 12.4
# Leaves out the episodes whose return equals the bound, but a return of at least the bound is asked for.
# says: this
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept = [episode for episode in episodes if episode["return"] > bound]


# %% keeps_the_worst loses 12.4
# Keeps the episodes with a return of at most the bound, but those with at least the bound are asked for.
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept = [episode for episode in episodes if episode["return"] <= bound]


# %% gradient_cut_off loses 12.5
# Gives the right loss, but a gradient of 0 for every score: torch should be able to follow the whole computation from the scores to the loss.
# says: this
_cross_entropy = cross_entropy


def cross_entropy(scores, actions):
    value = _cross_entropy(scores, actions).detach()
    return value + 0 * scores.sum()


# %% loss_of_the_library loses 12.5
# Uses torch's own cross_entropy, but you should write this loss yourself.
from torch.nn.functional import cross_entropy as ready_made


def cross_entropy(scores, actions):
    return ready_made(scores, actions)


# %% summed_surprise loses 12.5
# Adds up the surprises of all steps instead of taking their mean.
# says: this
_cross_entropy = cross_entropy


def cross_entropy(scores, actions):
    return _cross_entropy(scores, actions) * len(actions)


# %% surprise_overflows loses 12.5
# Takes exponentials of large scores that a floating-point number cannot hold, so that the loss is NaN, but the scores may be large.
def cross_entropy(scores, actions):
    powers = torch.exp(scores)
    shares = powers / powers.sum(dim=1, keepdim=True)
    return -torch.log(shares[torch.arange(len(actions)), actions]).mean()


# %% gradients_pile_up loses 12.6
# Adds the gradients of each update to all that were there before (zero_grad clears them), but each update should use its own gradients alone.
# says: this
# -         value = loss(network(inputs), wanted)
# -         optimiser.zero_grad()
# +         value = loss(network(inputs), wanted)


# %% losses_after_each_update loses 12.6
# Leaves out the loss before the first update, so that the others stand one place too early; the loss before each update is asked for.
_improve = improve


def improve(network, optimiser, observations, actions, loss, updates):
    losses = _improve(network, optimiser, observations, actions, loss, updates)
    return [*losses[1:], losses[-1] * 0.9]


# %% constant_forgotten loses 12.7
# Leaves out the constant ln(2 pi) / 2, but it should be added for each number of the action.
def gaussian_loss(means, log_deviation, actions):
    distance = (actions - means) / torch.exp(log_deviation)
    return (distance**2 / 2 + log_deviation).sum(dim=1).mean()


# %% variance_for_deviation loses 12.7
# Multiplies the noise by exp(log_deviation / 2) instead of exp(log_deviation).
# says: this
def gaussian_action(mean, log_deviation, rng):
    return mean + np.exp(log_deviation / 2) * rng.standard_normal(len(mean))


# %% evolved_instead loses 12.8
# Varies the parameters at random and keeps the better ones, but the policy should learn by your losses.
def train(environment, seed):
    rng = np.random.default_rng(seed)
    outputs = 2 if environment == "CartPole-v1" else 1
    sizes = ((8, 4), (8,), (outputs, 8), (outputs,))
    best, centre = -1.0, [np.zeros(size) for size in sizes]
    returns = []
    while best < 200 and len(returns) < 400:
        tried = [each + 0.5 * rng.standard_normal(each.shape) for each in centre]

        def act(observation, tried=tried):
            found = outputs_of(tried, observation)
            return int(found.argmax()) if outputs == 2 else found

        returns.append([run_episode(environment, act, seed + e)["return"] for e in range(8)])
        if np.mean(returns[-1]) >= best:
            best, centre = np.mean(returns[-1]), tried
    return {"parameters": centre, "returns": returns}


# %% known_by_heart loses 12.8
# Returns parameters that do not come from training, but the policy should be learnt in the environment that gymnasium.make gives.
def train(environment, seed):
    signs = np.array([0.1, 0.4, 3.0, 1.0])
    outputs = 2 if environment == "CartPole-v1" else 1
    W2 = np.array([[-1.0], [1.0]])[-outputs:]
    parameters = [signs[None], np.zeros(1), W2, np.zeros(outputs)]

    def act(observation):
        found = outputs_of(parameters, observation)
        return int(found.argmax()) if outputs == 2 else found

    returns = [[run_episode(environment, act, seed + e)["return"] for e in range(20)]]
    return {"parameters": parameters, "returns": returns}


# %% never_learns loses 12.8
# Trains for one iteration only, but training should go on until the mean return of an iteration reaches the goal.
_train = train


def train(environment, seed):
    return _train(environment, seed, iterations=1, attempts=1)


# %% ppo_by_hand loses 12.8
# Learns by PPO from all episodes, but the policy should learn from the elite by cross_entropy and gaussian_loss.
def train(environment, seed):
    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    discrete = environment == "CartPole-v1"
    network = make_network(4, 2 if discrete else 1)
    log_deviation = torch.zeros(1, requires_grad=True)
    optimiser = torch.optim.Adam([*network.parameters(), log_deviation], lr=0.01)

    def log_probabilities(seen, actions):
        outputs = network(seen)
        if discrete:
            return torch.log_softmax(outputs, dim=1).gather(1, actions[:, None])[:, 0]
        distance = (actions - outputs) / torch.exp(log_deviation)
        return (-(distance**2) / 2 - log_deviation).sum(dim=1)

    def act(observation):
        outputs = outputs_of(parameters, observation)
        return choose(softmax(outputs), rng) if discrete else gaussian_action(outputs, spread, rng)

    returns = []
    for iteration in range(60):
        parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
        found = [run_episode(environment, act, seed + 20 * iteration + e) for e in range(20)]
        returns.append([episode["return"] for episode in found])
        if np.mean(returns[-1]) >= 195:
            break
        seen = torch.tensor(np.concatenate([each["observations"] for each in found])).float()
        actions = torch.tensor(np.concatenate([each["actions"] for each in found]))
        to_come = [1 - 0.97 ** np.arange(len(each["actions"]), 0, -1) for each in found]
        advantages = torch.tensor(np.concatenate(to_come)).float()
        advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        with torch.no_grad():
            before = log_probabilities(seen, actions)
        for _ in range(10):
            ratio = torch.exp(log_probabilities(seen, actions) - before)
            clipped = ratio.clip(0.8, 1.2)
            optimiser.zero_grad()
            (-torch.minimum(ratio * advantages, clipped * advantages).mean()).backward()
            optimiser.step()
    return {"parameters": parameters_of(network), "returns": returns}


# %% returns_made_up loses 12.8
# Gives returns that no episode had, but the returns of all episodes are asked for.
_train = train


def train(environment, seed):
    found = _train(environment, seed)
    found["returns"] = [[each + 0.5 for each in some] for some in found["returns"]]
    return found


# %% log_softmax_of_the_tensor loses 12.5
# Uses the tensor's own log_softmax, but you should write this loss without it.
# says: write it yourself
def cross_entropy(scores, actions):
    return -scores.log_softmax(1)[torch.arange(len(actions)), actions].mean()


# %% log_prob_of_categorical loses 12.5
# Uses log_prob of torch's Categorical, but you should write this loss yourself.
# says: write it yourself
def cross_entropy(scores, actions):
    return -torch.distributions.Categorical(logits=scores).log_prob(actions).mean()


# %% log_prob_of_normal loses 12.7
# Uses log_prob of torch's Normal, but you should write this loss yourself.
# says: write it yourself
def gaussian_loss(means, log_deviation, actions):
    normal = torch.distributions.Normal(means, log_deviation.exp())
    return -normal.log_prob(actions).sum(1).mean()


# %% absolute_scores loses 12.1
# Uses the absolute values of the scores, so that -2 counts as much as 2, but the scores should keep their signs.
# says: this
# -     scores = np.asarray(scores, dtype=np.float64)
# +     scores = np.abs(np.asarray(scores, dtype=np.float64))


# %% softmax_of_whole_numbers loses 12.1
# Gives whole numbers if the scores are whole numbers, so that probabilities below 1 become 0, but floats are asked for.
# says: this
# -     return powers / powers.sum(axis=-1, keepdims=True)
# +     return (powers / powers.sum(axis=-1, keepdims=True)).astype(np.result_type(given))
# -     scores = np.asarray(scores, dtype=np.float64)
# +     given = np.asarray(scores)
# +     scores = np.asarray(scores, dtype=np.float64)


# %% two_darts loses 12.2
# Compares each sum with a random number of its own, but one u = rng.random() for all of them is asked for.
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(probabilities) > rng.random(len(probabilities))


# %% act_sees_the_first_observation loses 12.3
# Calls act with the first observation in every step, but act should get the latest one.
# -             action = act(observation)
# +             action = act(observation if not observations else observations[0])


# %% cut_to_one loses 12.3
# Cuts the actions to between -1 and 1, but the limits of the action space are asked for.
# says: this
# -                 action = np.clip(action, space.low, space.high).astype(space.dtype)
# +                 action = np.clip(action, -1, 1).astype(space.dtype)


# %% one_list_for_all_observations loses 12.3
# Gives the last recorded observation in all rows, but what was seen before each step is asked for.
# -             observations.append(observation)
# +             observations.append(observation)
# +             observations = [observation] * len(observations)


# %% bound_of_the_elite loses 12.4
# Gives the lowest return of the kept episodes as the bound, but np.percentile(returns, percentile) is asked for.
# -     return {
# -         "observations": np.concatenate([episode["observations"] for episode in kept]),
# -         "actions": np.concatenate([episode["actions"] for episode in kept]),
# -         "bound": bound,
# -     }
# +     return {
# +         "observations": np.concatenate([episode["observations"] for episode in kept]),
# +         "actions": np.concatenate([episode["actions"] for episode in kept]),
# +         "bound": min(episode["return"] for episode in kept),
# +     }


# %% a_share_of_the_episodes loses 12.4
# Keeps a fixed number of episodes, but all with at least the bound should be kept, also if several have the same return.
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     count = max(1, round(len(episodes) * (1 - percentile / 100)))
# +     order = np.argsort([-episode["return"] for episode in episodes], kind="stable")
# +     kept = [episodes[i] for i in sorted(order[:count])]


# %% best_first loses 12.4
# Sorts the kept episodes by their returns, the best first, but they should stay in the order of the list.
# says: this
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept.sort(key=lambda episode: -episode["return"])


# %% elite_sorts_the_list loses 12.4
# Sorts the list of episodes that it gets, but this list should stay as it is.
# says: in place
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     episodes.sort(key=lambda episode: episode["return"])


# %% surprise_by_the_actions loses 12.5
# Divides the sum of the surprises by the number of all scores, but it should be divided by the number of steps.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - chosen).sum() / scores.numel()


# %% confidence_for_surprise loses 12.5
# Gives the mean of ln p(a), but minus this mean is asked for.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (chosen - torch.logsumexp(scores, dim=1)).mean()


# %% one_update_too_many loses 12.6
# Makes one more update than asked for.
# -     for _ in range(updates):
# -         value = loss(network(inputs), wanted)
# +     for _ in range(updates + 1):
# +         value = loss(network(inputs), wanted)


# %% in_batches_of_32 loses 12.6
# Uses no more than the first 32 steps in each update, but all steps should be used.
# -         value = loss(network(inputs), wanted)
# +         some = torch.arange(len(inputs))[:32]
# +         value = loss(network(inputs[some]), wanted[some])


# %% learning_rate_of_its_own loses 12.6
# Uses an optimiser of its own instead of the one that it gets.
# -     losses = []
# -     for _ in range(updates):
# +     losses = []
# +     optimiser = torch.optim.Adam(network.parameters(), lr=0.01)
# +     for _ in range(updates):


# %% one_noise_for_all_actuators loses 12.7
# Draws one random number for all actuators, but each should have its own.
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return mean + np.exp(log_deviation) * rng.standard_normal()


# %% mean_over_the_actuators loses 12.7
# Takes the mean over the actuators, too, but their surprises should be added up.
# says: this
# -     return surprise.sum(dim=1).mean()
# +     return surprise.mean()


# %% half_is_forgotten loses 12.7
# Divides the squared distance by sigma^2, but it should be divided by 2 sigma^2.
# says: this
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     surprise = distance**2 + log_deviation + np.log(2 * np.pi) / 2


# %% learns_nothing_of_the_deviation loses 12.7
# Gives the right loss, but a gradient of 0 for log_deviation: torch should be able to follow it to the loss, too.
# -     distance = (actions - means) / torch.exp(log_deviation)
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     log_deviation = log_deviation.detach()
# +     distance = (actions - means) / torch.exp(log_deviation)
# +     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2


# %% one_training_for_all_seeds loses 12.8
# Trains with the seed 1 whatever `seed` is, but `seed` should decide about all random numbers.
# -     torch.manual_seed(seed)
# -     rng = np.random.default_rng(seed)
# +     seed = 1
# +     torch.manual_seed(seed)
# +     rng = np.random.default_rng(seed)


# %% weights_never_seeded loses 12.8
# Draws the first weights of the network without the seed, but the same seed should give the same training.
# -     torch.manual_seed(seed)
# -     rng = np.random.default_rng(seed)
# +     torch.seed()
# +     rng = np.random.default_rng(seed)


# %% found_at_random_and_trained_for_show loses 12.8
# Finds the policy by a random search, and the losses hardly change it, but the policy should learn by your losses.
_train = train


def train(environment, seed, iterations=50, episodes=20, **others):
    rng, best = np.random.default_rng(seed), -1.0
    torch.manual_seed(seed)
    with gymnasium.make(environment) as env:
        discrete = isinstance(env.action_space, gymnasium.spaces.Discrete)
    network = make_network(4, 2 if discrete else 1)
    deviation = torch.full((2 if discrete else 1,), -3.0, requires_grad=True)
    kept, returns = [each.detach().clone() for each in network.parameters()], []
    for _ in range(400):
        with torch.no_grad():
            for own, before in zip(network.parameters(), kept, strict=True):
                own.copy_(before + 0.5 * torch.tensor(rng.standard_normal(before.shape)))
        parameters = parameters_of(network)

        def act(observation, parameters=parameters):
            outputs = outputs_of(parameters, observation)
            return int(outputs.argmax()) if discrete else outputs

        found = [run_episode(environment, act, seed + e) for e in range(5)]
        mean = np.mean([episode["return"] for episode in found])
        if mean > best:
            best, kept = mean, [each.detach().clone() for each in network.parameters()]
            returns.append([episode["return"] for episode in found])
        if best >= 199:
            break
    with torch.no_grad():
        for own, one in zip(network.parameters(), kept, strict=True):
            own.copy_(one)
    optimiser = torch.optim.Adam([*network.parameters(), deviation], lr=1e-9)
    chosen = elite(found, 0)

    def loss(outputs, actions):
        if discrete:
            return cross_entropy(outputs, actions)
        return gaussian_loss(outputs, deviation, actions)

    improve(network, optimiser, chosen["observations"], chosen["actions"], loss, 20)
    return {"parameters": parameters_of(network), "returns": returns}


# %% shares_of_the_scores loses 12.1
# Subtracts the smallest score of each row and divides by the sum, but the exponentials of the scores should be divided by their sum.
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = scores - scores.min(axis=-1, keepdims=True) + 1e-12
# %% one_action_too_far loses 12.2
# Returns one more than the action that the dart hits, even after the last action.
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     return int(np.argmax(beyond)) + 1 if beyond.any() else len(probabilities) - 1
# %% discounted_return loses 12.3
# Discounts the rewards by 0.99 in each step, but they should be added up as they are.
# -             total += float(reward)
# +             total += float(reward) * 0.99 ** (len(actions) - 1)
# %% second_reset_without_seed loses 12.3
# Resets the environment a second time, so that the episode does not begin as reset(seed=seed) does.
# -         observation, _ = env.reset(seed=seed)
# +         env.reset(seed=seed)
# +         observation, _ = env.reset()
# %% bound_of_the_lengths loses 12.4
# Takes the percentile of the episodes' numbers of steps, but that of their returns is asked for.
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.percentile([len(episode["actions"]) for episode in episodes], percentile))
# %% percentile_upside_down loses 12.4
# Counts the percentile from the highest return, but np.percentile(returns, percentile), which counts from the lowest, is asked for.
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.percentile([episode["return"] for episode in episodes], 100 - percentile))
# %% probability_for_surprise loses 12.5
# Takes 1 minus the probability of each action that was done, but minus the logarithm of the probability is asked for.
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (1 - torch.exp(chosen - torch.logsumexp(scores, dim=1))).mean()
# %% normalised_over_steps loses 12.5
# Adds up the exponentials over the steps (dim=0), but they should be added up over the actions (dim=1).
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=0)[actions] - chosen).mean()
# %% one_gradient_for_all_updates loses 12.6
# Uses the gradients of the first update in all updates, but each update should compute its own.
# -         optimiser.zero_grad()
# -         value.backward()
# -         optimiser.step()
# +         if not losses:
# +             optimiser.zero_grad()
# +             value.backward()
# +         optimiser.step()
# %% same_loss_each_time loses 12.6
# Returns the first loss for each update, but the loss before each update is asked for.
# -         losses.append(value.item())
# +         losses.append(losses[0] if losses else value.item())
# %% noise_without_exponential loses 12.7
# Multiplies the noise by log_deviation instead of exp(log_deviation).
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return mean + np.asarray(log_deviation) * rng.standard_normal(len(mean))
# %% deviation_not_in_the_density loses 12.7
# Leaves out ln sigma (log_deviation), but it should be added for each number of the action.
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     surprise = distance**2 / 2 + np.log(2 * np.pi) / 2
# %% steps_summed loses 12.7
# Adds up over the steps and takes the mean over the actuators, but it should be the other way round.
# -     return surprise.sum(dim=1).mean()
# +     return surprise.sum(dim=0).mean()
# %% trains_on_all_episodes loses 12.8
# Learns from all episodes instead of the elite.
# -         best = elite(found, percentile)
# +         best = elite(found, 0)


# %% dart_on_the_border loses 12.2
# Takes the first action whose sum is at least u, but the sum should be greater than u.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(probabilities) >= rng.random()


# %% divides_by_the_largest loses 12.1
# Divides the scores by the largest absolute score of their row, which changes the probabilities, instead of subtracting the largest score.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores / np.abs(scores).max(axis=-1, keepdims=True))


# %% scores_without_exponential loses 12.1
# Divides the absolute values of the scores by their sum, but the exponentials of the scores should be divided by their sum.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.abs(scores)


# %% no_gradient_for_the_step loses 12.6
# Leaves the parameters as they are, but optimiser.step() should change them by the gradients that backward has computed.
# says: this
# -         optimiser.zero_grad()
# -         value.backward()
# -         optimiser.step()
# +         value.backward()
# +         optimiser.zero_grad()
# +         optimiser.step()


# %% first_kept_episode loses 12.4
# Returns only the first of the kept episodes, but the steps of all kept episodes are asked for.
# says: this
# -         "observations": np.concatenate([episode["observations"] for episode in kept]),
# -         "actions": np.concatenate([episode["actions"] for episode in kept]),
# +         "observations": kept[0]["observations"],
# +         "actions": kept[0]["actions"],


# %% every_action_of_every_step loses 12.5
# Takes the scores of all recorded actions in each step, as scores[:, actions] does, but each step should count only its own action.
# says: this
# -     chosen = scores[torch.arange(len(actions)), actions]
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - scores[:, actions]).mean()


# %% actions_always_float loses 12.6
# Turns whole actions into float32, too, but int64 is asked for.
# says: this
# -     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64 if whole else torch.float32)
# +     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.float32)


# %% one_action_too_early loses 12.2
# Returns the action before the one that the dart hits (0 stays 0), but the action that the dart hits is asked for.
# says: this
def choose(probabilities, rng):
    return max(0, int(np.sum(np.cumsum(probabilities) < rng.random())) - 1)


# %% sigma_is_no_parameter loses 12.8
# Leaves ln sigma as it is at the beginning, but the optimiser should change it, too.
# says: log_deviation never changes in gaussian_action and gaussian_loss
# -     optimiser = torch.optim.Adam([*network.parameters(), log_deviation], lr=learning_rate)
# +     optimiser = torch.optim.Adam(network.parameters(), lr=learning_rate)


# %% noise_of_the_beginning loses 12.8
# Draws all actions with the ln sigma of the beginning, but gaussian_action should get the one that is learnt.
# says: log_deviation never changes in gaussian_action:
# -         parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
# +         parameters, spread = parameters_of(network), np.zeros(noutputs)


# %% starts_of_the_first_iteration loses 12.8
# Begins the episodes of each iteration with the seeds of the first one, but `seed + i * starts + e % starts` is asked for.
# says: begins its episodes with the seeds
# -         first = seed + iteration * starts
# +         first = seed


# %% starts_one_further_in_each_iteration loses 12.8
# Adds the iteration i to the seed of an episode, but i * starts should be added.
# says: begins its episodes with the seeds
# -         first = seed + iteration * starts
# +         first = seed + iteration


# %% starts_without_the_seed loses 12.8
# Leaves `seed` out of the seeds of the episodes, but `seed + i * starts + e % starts` is asked for.
# says: begins its episodes with the seeds
# -         first = seed + iteration * starts
# +         first = iteration * starts


# %% nothing_for_the_rest_of_the_ruler loses 12.2
# Returns action 0 if no sum is greater than u (by rounding), but the last action is asked for.
# says: this
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     return int(np.argmax(beyond))


# %% one_largest_score_for_all_steps loses 12.1
# Subtracts the same number from all rows, so that rows of much lower scores become 0 / 0 = NaN, but each row's own largest score should be subtracted.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores - scores.max())


# %% action_after_the_right_one loses 12.2
# Returns the action after the one that the dart hits (the last stays the last), but the action that the dart hits is asked for.
# says: this
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     return min(int(np.argmax(beyond)) + 1, len(probabilities) - 1) if beyond.any() else len(beyond) - 1


# %% actions_always_whole loses 12.6
# Turns all actions into int64, but float32 is asked for if they are not whole.
# -     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64 if whole else torch.float32)
# +     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64)


# %% mean_subtracted_from_the_scores loses 12.1
# Subtracts another number than the largest score of each row, so that exponentials of large scores overflow and give NaN.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores - scores.mean(axis=-1, keepdims=True))


# %% tiny_number_against_0 loses 12.5
# Keeps the probability under the logarithm at 1e-10 or more, so that large surprises come out too small; ln p(a) should be computed from the scores.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return -torch.log(torch.exp(chosen - torch.logsumexp(scores, dim=1)) + 1e-10).mean()


# %% one_column_is_whole loses 12.6
# Turns actions with a single column into int64, but float32 is asked for if they are not whole.
# says: this
# -     whole = np.issubdtype(np.asarray(actions).dtype, np.integer)
# +     whole = np.asarray(actions).ndim == 1 or np.shape(actions)[1] == 1


# %% acts_as_in_the_beginning loses 12.8
# Acts with the parameters of the beginning in all iterations, but each iteration should act with those learnt so far.
# -     for iteration in range(iterations):
# -         parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
# +     parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
# +     for iteration in range(iterations):


# %% scores_are_cut loses 12.1
# Cuts large scores off at about 500, which makes them equally probable, instead of subtracting the largest score of each row.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(np.clip(scores, -500, 500))


# %% place_among_the_sorted loses 12.2
# Returns a place among the probabilities sorted from the largest to the smallest, but the action itself is asked for.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(np.sort(probabilities)[::-1]) > rng.random()


# %% mean_reward loses 12.3
# Gives the mean of the rewards instead of their sum.
# says: this
# -     return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
# +     mean = total / len(actions)
# +     return {"observations": np.array(observations), "actions": np.array(actions), "return": mean}


# %% observations_normalised loses 12.6
# Normalises the observations before the network gets them, but the network should get them as they are.
# says: this
# -     inputs = torch.as_tensor(np.asarray(observations), dtype=torch.float32)
# +     seen = np.asarray(observations)
# +     inputs = torch.as_tensor((seen - seen.mean(0)) / seen.std(0), dtype=torch.float32)


# %% scores_cut_at_700 loses 12.1
# Cuts large scores off at about 700, which makes them equally probable, instead of subtracting the largest score of each row.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(np.clip(scores, -700, 700))


# %% rounded_dart loses 12.2
# Rounds u to one decimal place, but u should be used as it is.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(probabilities) > round(rng.random(), 1)


# %% observation_at_the_end loses 12.3
# Records the observation after the last step, too, but only what was seen before each step is asked for.
# says: this
# -     return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
# +     observations.append(observation)
# +     return {"observations": np.array(observations), "actions": np.array(actions), "return": total}


# %% cut_to_half_the_limits loses 12.3
# Cuts the actions to half of the limits of the action space instead of the limits themselves.
# says: this
# -                 action = np.clip(action, space.low, space.high).astype(space.dtype)
# +                 action = np.clip(action, space.low / 2, space.high / 2).astype(space.dtype)


# %% largest_reward loses 12.3
# Gives the largest reward, or 0 if all are negative, but the sum of the rewards is asked for.
# says: this
# -             total += float(reward)
# +             total = max(total, float(reward))


# %% limits_of_the_first_actuator loses 12.3
# Cuts all actuators to the limits of the first one, but each should be cut to its own.
# says: this
# -                 action = np.clip(action, space.low, space.high).astype(space.dtype)
# +                 action = np.clip(action, space.low[0], space.high[0]).astype(space.dtype)


# %% one_step_more loses 12.3
# Makes up to maxsteps + 1 steps, but an episode should have at most maxsteps steps.
# says: this
# -         for _ in range(maxsteps):
# +         for _ in range(maxsteps + 1):


# %% percentile_for_a_share loses 12.4
# Divides the percentile by 100, but np.percentile needs it as it is, from 0 to 100.
# says: this
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.percentile([e["return"] for e in episodes], percentile / 100))


# %% mean_for_the_bound loses 12.4
# Takes the mean of the returns as the bound, whatever the percentile, but np.percentile(returns, percentile) is asked for.
# says: this
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.mean([episode["return"] for episode in episodes]))


# %% observations_of_all loses 12.4
# Gives the observations of all episodes, but only those of the kept episodes are asked for.
# says: this
# -         "observations": np.concatenate([episode["observations"] for episode in kept]),
# +         "observations": np.concatenate([episode["observations"] for episode in episodes]),


# %% actions_as_floats loses 12.4
# Turns whole actions into floats, but they should stay whole numbers.
# says: this
# -         "actions": np.concatenate([episode["actions"] for episode in kept]),
# +         "actions": np.concatenate([episode["actions"] for episode in kept]).astype(float),


# %% scores_with_the_wrong_sign loses 12.5
# Adds up the exponentials of minus the scores, but those of the scores themselves are asked for.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(-scores, dim=1) - chosen).mean()


# %% largest_for_the_sum loses 12.5
# Takes the largest score instead of the logarithm of the sum of the exponentials.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (scores.max(dim=1).values - chosen).mean()


# %% last_step_only loses 12.5
# Gives the surprise of the last step only, but the mean over all steps is asked for.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - chosen)[-1]


# %% action_of_the_highest_score loses 12.5
# Takes the highest score of each step, but the score of the action that was done is asked for.
# says: this
# -     chosen = scores[torch.arange(len(actions)), actions]
# +     chosen = scores.max(dim=1).values


# %% last_loss_for_all loses 12.6
# Returns the last loss for each update, but the loss before each update is asked for.
# says: this
# -         losses.append(value.item())
# -     return losses
# +         losses.append(value.item())
# +     return [losses[-1]] * updates


# %% mean_of_the_losses_so_far loses 12.6
# Returns the mean of the losses so far for each update, but the loss before this update alone is asked for.
# says: this
# -         losses.append(value.item())
# -     return losses
# +         losses.append(value.item())
# +     return [sum(losses[: i + 1]) / (i + 1) for i in range(updates)]


# %% variance_in_the_square loses 12.7
# Divides the squared distance by 2 sigma^4, but it should be divided by 2 sigma^2.
# says: this
# -     distance = (actions - means) / torch.exp(log_deviation)
# +     distance = (actions - means) / torch.exp(log_deviation) ** 2


# %% sigma_for_its_logarithm loses 12.7
# Adds sigma itself instead of ln sigma.
# says: this
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     surprise = distance**2 / 2 + torch.exp(log_deviation) + np.log(2 * np.pi) / 2


# %% uniform_noise loses 12.7
# Draws uniform noise from -1 to 1, but Gaussian noise (rng.standard_normal) is asked for.
# says: this
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return mean + np.exp(log_deviation) * rng.uniform(-1, 1, len(mean))


# %% action_cut_when_drawn loses 12.7
# Cuts the action to between -1 and 1, but gaussian_action should return it as it was drawn.
# says: this
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return np.clip(mean + np.exp(log_deviation) * rng.standard_normal(len(mean)), -1, 1)


# %% number_for_the_loss loses 12.5
# Returns a plain number, but the loss should be a tensor, so that torch can compute gradients through it.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - chosen).mean().item()


# %% two_numbers_for_each_choice loses 12.2
# Draws two random numbers in each call and uses the second one, but only one should be drawn.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     rng.random()
# +     beyond = np.cumsum(probabilities) > rng.random()


# %% quotient_of_starts loses 12.8
# Uses e // starts in the seed of episode e, but e % starts is asked for.
# says: begins its episodes with the seeds
# -         found = [run_episode(environment, act, first + e % starts) for e in range(episodes)]
# +         found = [run_episode(environment, act, first + e // starts) for e in range(episodes)]


# %% scores_divided_by_100 loses 12.1
# Divides the scores by 100 before the exponential, which changes the probabilities, instead of subtracting the largest score.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores / 100)


# %% gumbel_noise loses 12.2
# Adds Gumbel noise to the logarithms of the probabilities, but the action should come from a single u = rng.random().
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     with np.errstate(divide="ignore"):
# +         logarithms = np.log(probabilities)
# +     return int(np.argmax(logarithms + rng.gumbel(size=len(probabilities))))


# %% sigma_in_the_root_as_it_is loses 12.7
# Adds only half of ln sigma, as in ln(2 pi sigma) / 2, but the whole of ln sigma is asked for.
# says: this
def gaussian_loss(means, log_deviation, actions):
    variance = torch.exp(2 * log_deviation)
    exponent = (actions - means).pow(2) / (2 * variance)
    normaliser = 0.5 * torch.log(2 * torch.pi * variance.sqrt())
    density = exponent + normaliser
    return density.sum(-1).mean()


# %% deviation_without_gradient loses 12.7
# Leaves the distance divided by sigma out of the gradient of log_deviation: torch should be able to follow this sigma, too (no .detach() or NumPy).
# says: this
def gaussian_loss(means, log_deviation, actions):
    sigma = torch.from_numpy(np.exp(log_deviation.detach().numpy()))
    z = (actions - means) / sigma
    per_step = torch.zeros(len(z))
    for i in range(z.shape[1]):
        per_step = per_step + 0.5 * z[:, i] ** 2 + log_deviation[i] + 0.5 * np.log(2 * np.pi)
    return per_step.mean()


# %% constant_of_one_number loses 12.7
# Adds the constant ln(2 pi) / 2 once for each step, but it should be added for each number of the action.
# says: this
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# -     return surprise.sum(dim=1).mean()
# +     surprise = distance**2 / 2 + log_deviation
# +     return surprise.sum(dim=1).mean() + np.log(2 * np.pi) / 2


# %% density_before_its_logarithm loses 12.7
# Computes the density before its logarithm: far from the mean it is rounded to 0 and the loss becomes infinite, but the formula needs no density.
# says: this
def gaussian_loss(means, log_deviation, actions):
    sigma = log_deviation.exp()
    bell = torch.exp(-((actions - means) ** 2) / (2 * sigma**2))
    density = bell / (sigma * (2 * torch.pi) ** 0.5)
    return -density.prod(dim=1).log().mean()


# %% chosen_scores_cut_off loses 12.5
# Leaves the scores of the chosen actions out of the gradient: torch should be able to follow them to the loss, too (no .item(), .detach() or torch.tensor).
# says: this
def cross_entropy(scores, actions):
    chosen = torch.tensor([scores[t, a].item() for t, a in enumerate(actions)])
    largest = scores.max(dim=1).values
    log_sum = largest + (scores - largest[:, None]).exp().sum(dim=1).log()
    return (log_sum - chosen).mean()


# %% best_episode_ends_it loses 12.8
# Ends training when the best episode of an iteration reaches the goal, but the mean return of the iteration should reach it.
# says: training should go on until
# -         if np.mean(returns[-1]) >= goal:
# -             break
# +         if np.max(returns[-1]) >= goal:
# +             break
# -     if attempts > 1 and np.mean(returns[-1]) < goal:
# +     if attempts > 1 and np.max(returns[-1]) < goal:


# %% largest_score_on_one_side loses 12.5
# Subtracts the largest score under the logarithm only, but it should also be subtracted from the score of the chosen action.
# says: this
def cross_entropy(scores, actions):
    largest = scores.max(dim=1, keepdim=True).values
    log_sum = torch.log(torch.sum(torch.exp(scores - largest), dim=1))
    chosen = torch.gather(scores, 1, actions.unsqueeze(1)).squeeze(1)
    return torch.mean(log_sum - chosen)


# %% gradients_cleared_once loses 12.6
# Sets the gradients to zero only before the first update, so that later updates add theirs to them, but each should use its own alone.
# says: this
# -     for _ in range(updates):
# -         value = loss(network(inputs), wanted)
# -         optimiser.zero_grad()
# +     optimiser.zero_grad()
# +     for _ in range(updates):
# +         value = loss(network(inputs), wanted)
# %% logarithm_of_softmax loses 12.5
# Takes the logarithm of probabilities that are rounded to 0 where scores are large, so that the loss is infinite; ln p(a) should be computed from the scores.
# says: this
# -     chosen = scores[torch.arange(len(actions)), actions]
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     chosen = torch.softmax(scores, dim=1)[torch.arange(len(actions)), actions]
# +     return -torch.log(chosen).mean()
# %% cleared_after_the_step loses 12.6
# Adds the gradients that the network had before the call to those of the first update; the gradients should be cleared before each backward().
# says: this
# -         optimiser.zero_grad()
# -         value.backward()
# -         optimiser.step()
# +         value.backward()
# +         optimiser.step()
# +         optimiser.zero_grad()
