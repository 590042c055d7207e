"""Wrong solutions of exercise 12; building.py describes how a case is written."""


# %% softmax_over_everything loses 12.1
# One sum for all steps, instead of one for each.
# says: each row has its own
def softmax(scores):
    powers = np.exp(np.asarray(scores, dtype=np.float64) - np.max(scores))
    return powers / powers.sum()


# %% softmax_overflows loses 12.1
# The powers of large scores are more than a computer can hold.
# says: np.exp of a large number|infinity minus infinity
def softmax(scores):
    with np.errstate(all="ignore"):
        powers = np.exp(np.asarray(scores, dtype=np.float64))
        return powers / powers.sum(axis=-1, keepdims=True)


# %% dart_counted_from_the_end loses 12.2
# Lays the probabilities on the ruler from the last to the first.
def choose(probabilities, rng):
    beyond = np.cumsum(np.asarray(probabilities)[::-1]) > rng.random()
    return len(probabilities) - 1 - int(np.argmax(beyond))


# %% most_probable_action loses 12.2
# Takes the most probable action, so that nothing new is ever tried.
# says: this
def choose(probabilities, rng):
    rng.random()
    return int(np.argmax(probabilities))


# %% uniform_choice loses 12.2
# All actions are equally probable, whatever the policy says.
def choose(probabilities, rng):
    return int(rng.random() * len(probabilities))


# %% last_reward_missing loses 12.3
# Leaves out the reward of the step that ends the episode.
# says: one less than expected
# -             observation, reward, terminated, truncated, _ = env.step(action)
# -             total += float(reward)
# +             observation, reward, terminated, truncated, _ = env.step(action)
# -                 break
# +                 break
# +             total += float(reward)


# %% counts_steps loses 12.3
# Counts the steps instead of adding up the rewards.
# says: The steps are counted
# -             total += float(reward)
# +             total += 1


# %% negative_rewards_left_out loses 12.3
# Adds up only the rewards that are positive.
# says: Negative rewards are left out
# -             total += float(reward)
# +             total += max(0.0, float(reward))


# %% whole_rewards loses 12.3
# Rounds each reward towards 0.
# -             total += float(reward)
# +             total += int(reward)


# %% never_cut loses 12.3
# Hands actions on without cutting them to the limits.
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
# Goes on when an episode is truncated.
# -             observation, reward, terminated, truncated, _ = env.step(action)
# +             observation, reward, terminated, _, _ = env.step(action)
# -             if terminated or truncated:
# +             if terminated:


# %% no_limit_of_steps loses 12.3
# Runs to the end of the episode, however long that is.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    return _run_episode(environment, act, seed, 210)


# %% records_cut_actions loses 12.3
# Records the actions as the environment got them, cut to the limits.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    found = _run_episode(environment, act, seed, maxsteps)
    with gymnasium.make(environment) as env:
        if isinstance(env.action_space, gymnasium.spaces.Box):
            found["actions"] = found["actions"].clip(env.action_space.low, env.action_space.high)
    return found


# %% records_the_next_observation loses 12.3
# Records what was observed after each action instead of before it.
# says: one place too early
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    found = _run_episode(environment, act, seed, maxsteps)
    after = np.concatenate([found["observations"][1:], found["observations"][-1:]])
    return {**found, "observations": after}


# %% reset_without_seed loses 12.3
# The episode does not begin where the seed says: reset gets another seed, or none.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    return _run_episode(environment, act, seed + 1, maxsteps)


# %% keeps_everything loses 12.4
# Learns from all episodes, good or bad.
# says: All episodes are kept
_elite = elite


def elite(episodes, percentile):
    bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
    return {**_elite(episodes, 0), "bound": bound}


# %% keeps_only_above_the_bound loses 12.4
# Drops the episodes that are exactly at the bound.
# says: this
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept = [episode for episode in episodes if episode["return"] > bound]


# %% keeps_the_worst loses 12.4
# Learns from the worst episodes.
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept = [episode for episode in episodes if episode["return"] <= bound]


# %% gradient_cut_off loses 12.5
# Goes through NumPy, where torch cannot follow.
# says: torch cannot follow the loss back|this
_cross_entropy = cross_entropy


def cross_entropy(scores, actions):
    value = _cross_entropy(scores, actions).detach()
    return value + 0 * scores.sum()


# %% loss_of_the_library loses 12.5
# Calls torch's own cross-entropy.
from torch.nn.functional import cross_entropy as ready_made


def cross_entropy(scores, actions):
    return ready_made(scores, actions)


# %% summed_surprise loses 12.5
# The sum over the steps instead of the mean.
# says: a sum for a mean
_cross_entropy = cross_entropy


def cross_entropy(scores, actions):
    return _cross_entropy(scores, actions) * len(actions)


# %% surprise_overflows loses 12.5
# The powers of large scores are more than a computer can hold.
def cross_entropy(scores, actions):
    powers = torch.exp(scores)
    shares = powers / powers.sum(dim=1, keepdim=True)
    return -torch.log(shares[torch.arange(len(actions)), actions]).mean()


# %% gradients_pile_up loses 12.6
# Never sets the gradients back to zero.
# says: zero_grad
# -         value = loss(network(inputs), wanted)
# -         optimiser.zero_grad()
# +         value = loss(network(inputs), wanted)


# %% losses_after_each_update loses 12.6
# Reports the losses after the updates instead of before.
_improve = improve


def improve(network, optimiser, observations, actions, loss, updates):
    losses = _improve(network, optimiser, observations, actions, loss, updates)
    return [*losses[1:], losses[-1] * 0.9]


# %% constant_forgotten loses 12.7
# Leaves the constant out: the gradients are right, but it is no density.
def gaussian_loss(means, log_deviation, actions):
    distance = (actions - means) / torch.exp(log_deviation)
    return (distance**2 / 2 + log_deviation).sum(dim=1).mean()


# %% variance_for_deviation loses 12.7
# Takes the parameter for the logarithm of the variance.
# says: logarithm of the variance
def gaussian_action(mean, log_deviation, rng):
    return mean + np.exp(log_deviation / 2) * rng.standard_normal(len(mean))


# %% evolved_instead loses 12.8
# Learns by another algorithm: it varies the parameters at random and keeps the better ones.
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
# Returns a policy that was worked out beforehand.
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
# Returns the parameters of the beginning.
_train = train


def train(environment, seed):
    return _train(environment, seed, iterations=1, attempts=1)


# %% ppo_by_hand loses 12.8
# Learns well, but by another algorithm: PPO's clipped ratio, over all episodes.
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
# Returns a learning curve that no episode had.
_train = train


def train(environment, seed):
    found = _train(environment, seed)
    found["returns"] = [[each + 0.5 for each in some] for some in found["returns"]]
    return found


# %% log_softmax_of_the_tensor loses 12.5
# The logarithms of the probabilities are those of torch.
# says: write it yourself: torch\.Tensor\.log_softmax
def cross_entropy(scores, actions):
    return -scores.log_softmax(1)[torch.arange(len(actions)), actions].mean()


# %% log_prob_of_categorical loses 12.5
# The logarithms of the probabilities are those of torch's distribution.
# says: write it yourself
def cross_entropy(scores, actions):
    return -torch.distributions.Categorical(logits=scores).log_prob(actions).mean()


# %% log_prob_of_normal loses 12.7
# The logarithm of the density is that of torch's distribution.
# says: write it yourself
def gaussian_loss(means, log_deviation, actions):
    normal = torch.distributions.Normal(means, log_deviation.exp())
    return -normal.log_prob(actions).sum(1).mean()


# %% absolute_scores loses 12.1
# Scores count by their absolute value: bad actions are as probable as good ones.
# says: this
# -     scores = np.asarray(scores, dtype=np.float64)
# +     scores = np.abs(np.asarray(scores, dtype=np.float64))


# %% softmax_of_whole_numbers loses 12.1
# The probabilities have the type of the scores: those of integers are cut off to 0.
# says: type of the scores
# -     return powers / powers.sum(axis=-1, keepdims=True)
# +     return (powers / powers.sum(axis=-1, keepdims=True)).astype(np.result_type(given))
# -     scores = np.asarray(scores, dtype=np.float64)
# +     given = np.asarray(scores)
# +     scores = np.asarray(scores, dtype=np.float64)


# %% two_darts loses 12.2
# Throws a dart at each action instead of one at the ruler.
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(probabilities) > rng.random(len(probabilities))


# %% act_sees_the_first_observation loses 12.3
# The policy is asked with the observation of the start in every step.
# -             action = act(observation)
# +             action = act(observation if not observations else observations[0])


# %% cut_to_one loses 12.3
# Actions are cut to between -1 and 1, whatever the limits of the space are.
# says: this
# -                 action = np.clip(action, space.low, space.high).astype(space.dtype)
# +                 action = np.clip(action, -1, 1).astype(space.dtype)


# %% one_list_for_all_observations loses 12.3
# The same array is kept for each step: all observations are the last one.
# -             observations.append(observation)
# +             observations.append(observation)
# +             observations = [observation] * len(observations)


# %% bound_of_the_elite loses 12.4
# The bound is the worst return that was kept, not the percentile.
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
# Keeps a fixed number of episodes, although several may have the return of the bound.
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     count = max(1, round(len(episodes) * (1 - percentile / 100)))
# +     order = np.argsort([-episode["return"] for episode in episodes], kind="stable")
# +     kept = [episodes[i] for i in sorted(order[:count])]


# %% best_first loses 12.4
# The kept episodes stand in the order of their returns, not of the list.
# says: this
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     kept.sort(key=lambda episode: -episode["return"])


# %% elite_sorts_the_list loses 12.4
# Sorts the caller's list of episodes.
# says: in place
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# -     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     kept = [episode for episode in episodes if episode["return"] >= bound]
# +     episodes.sort(key=lambda episode: episode["return"])


# %% surprise_by_the_actions loses 12.5
# The mean divides by the number of numbers, not of steps.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - chosen).sum() / scores.numel()


# %% confidence_for_surprise loses 12.5
# The sign is wrong: the loss falls when the actions become less probable.
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
# Each update looks at 32 of the steps, not at all of them.
# -         value = loss(network(inputs), wanted)
# +         some = torch.arange(len(inputs))[:32]
# +         value = loss(network(inputs[some]), wanted[some])


# %% learning_rate_of_its_own loses 12.6
# Makes an optimiser of its own instead of using the one that is given.
# -     losses = []
# -     for _ in range(updates):
# +     losses = []
# +     optimiser = torch.optim.Adam(network.parameters(), lr=0.01)
# +     for _ in range(updates):


# %% one_noise_for_all_actuators loses 12.7
# All actuators get the same noise.
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return mean + np.exp(log_deviation) * rng.standard_normal()


# %% mean_over_the_actuators loses 12.7
# The mean goes over the actuators, too, where the formula adds them up.
# says: this
# -     return surprise.sum(dim=1).mean()
# +     return surprise.mean()


# %% half_is_forgotten loses 12.7
# The squared distance is not halved.
# says: this
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     surprise = distance**2 + log_deviation + np.log(2 * np.pi) / 2


# %% learns_nothing_of_the_deviation loses 12.7
# No gradient reaches the deviation: it is detached.
# -     distance = (actions - means) / torch.exp(log_deviation)
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     log_deviation = log_deviation.detach()
# +     distance = (actions - means) / torch.exp(log_deviation)
# +     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2


# %% one_training_for_all_seeds loses 12.8
# Each training is the one with the seed 1.
# -     torch.manual_seed(seed)
# -     rng = np.random.default_rng(seed)
# +     seed = 1
# +     torch.manual_seed(seed)
# +     rng = np.random.default_rng(seed)


# %% weights_never_seeded loses 12.8
# The weights do not come from the seed: no training can be repeated.
# -     torch.manual_seed(seed)
# -     rng = np.random.default_rng(seed)
# +     torch.seed()
# +     rng = np.random.default_rng(seed)


# %% found_at_random_and_trained_for_show loses 12.8
# A random search finds the policy; the losses then change it at a learning rate of nearly 0.
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
# Divides the shifted scores by their sum, without the exponential.
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = scores - scores.min(axis=-1, keepdims=True) + 1e-12
# %% one_action_too_far loses 12.2
# Gives the action after the one that the dart hits.
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     return int(np.argmax(beyond)) + 1 if beyond.any() else len(probabilities) - 1
# %% discounted_return loses 12.3
# The return is discounted by 0.99 in each step.
# -             total += float(reward)
# +             total += float(reward) * 0.99 ** (len(actions) - 1)
# %% second_reset_without_seed loses 12.3
# Resets a second time, without the seed, and so begins another episode.
# -         observation, _ = env.reset(seed=seed)
# +         env.reset(seed=seed)
# +         observation, _ = env.reset()
# %% bound_of_the_lengths loses 12.4
# The bound is the percentile of the lengths instead of the returns.
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.percentile([len(episode["actions"]) for episode in episodes], percentile))
# %% percentile_upside_down loses 12.4
# The percentile counts from the best episode.
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.percentile([episode["return"] for episode in episodes], 100 - percentile))
# %% probability_for_surprise loses 12.5
# The loss is one minus the probability of the action.
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (1 - torch.exp(chosen - torch.logsumexp(scores, dim=1))).mean()
# %% normalised_over_steps loses 12.5
# The probabilities add up to 1 over the steps instead of the actions.
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=0)[actions] - chosen).mean()
# %% one_gradient_for_all_updates loses 12.6
# One gradient is used for all updates.
# -         optimiser.zero_grad()
# -         value.backward()
# -         optimiser.step()
# +         if not losses:
# +             optimiser.zero_grad()
# +             value.backward()
# +         optimiser.step()
# %% same_loss_each_time loses 12.6
# The first loss is returned for each update.
# -         losses.append(value.item())
# +         losses.append(losses[0] if losses else value.item())
# %% noise_without_exponential loses 12.7
# Multiplies the noise by the logarithm of the deviation.
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return mean + np.asarray(log_deviation) * rng.standard_normal(len(mean))
# %% deviation_not_in_the_density loses 12.7
# The logarithm of the deviation is not added to the loss.
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     surprise = distance**2 / 2 + np.log(2 * np.pi) / 2
# %% steps_summed loses 12.7
# The sum goes over the steps and the mean over the actuators.
# -     return surprise.sum(dim=1).mean()
# +     return surprise.sum(dim=0).mean()
# %% trains_on_all_episodes loses 12.8
# The network learns from all episodes instead of the elite.
# -         best = elite(found, percentile)
# +         best = elite(found, 0)


# %% dart_on_the_border loses 12.2
# Stops as soon as the sum has reached the dart.
# says: must be greater than u
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(probabilities) >= rng.random()


# %% divides_by_the_largest loses 12.1
# Divides by the largest score, which changes the probabilities; subtracting it does not.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores / np.abs(scores).max(axis=-1, keepdims=True))


# %% scores_without_exponential loses 12.1
# Divides the scores by their sum: the exponential is missing.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.abs(scores)


# %% no_gradient_for_the_step loses 12.6
# The optimiser's step finds no gradient: backward is missing, too late, or cleared before it.
# says: this
# -         optimiser.zero_grad()
# -         value.backward()
# -         optimiser.step()
# +         value.backward()
# +         optimiser.zero_grad()
# +         optimiser.step()


# %% first_kept_episode loses 12.4
# Returns the first one of the kept episodes only.
# says: this
# -         "observations": np.concatenate([episode["observations"] for episode in kept]),
# -         "actions": np.concatenate([episode["actions"] for episode in kept]),
# +         "observations": kept[0]["observations"],
# +         "actions": kept[0]["actions"],


# %% every_action_of_every_step loses 12.5
# Takes the scores of all the actions done, in every step, not the one of each step's own.
# says: this
# -     chosen = scores[torch.arange(len(actions)), actions]
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - scores[:, actions]).mean()


# %% actions_always_float loses 12.6
# Whole actions become numbers of float32, too.
# says: this
# -     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64 if whole else torch.float32)
# +     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.float32)


# %% one_action_too_early loses 12.2
# Counts the sums below the dart and takes one off: the action before the right one.
# says: this
def choose(probabilities, rng):
    return max(0, int(np.sum(np.cumsum(probabilities) < rng.random())) - 1)


# %% sigma_is_no_parameter loses 12.8
# The optimiser does not get ln sigma, so it stays as it is at the beginning.
# says: ln sigma is the same number in all calls of gaussian_loss
# -     optimiser = torch.optim.Adam([*network.parameters(), log_deviation], lr=learning_rate)
# +     optimiser = torch.optim.Adam(network.parameters(), lr=learning_rate)


# %% noise_of_the_beginning loses 12.8
# ln sigma is learnt, but the actions are drawn with that of the beginning.
# says: always acts with one deviation
# -         parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
# +         parameters, spread = parameters_of(network), np.zeros(noutputs)


# %% starts_of_the_first_iteration loses 12.8
# Each iteration begins its episodes with the seeds of the first one.
# says: all iterations begin their episodes with the seeds of the first one
# -         first = seed + iteration * starts
# +         first = seed


# %% starts_one_further_in_each_iteration loses 12.8
# The iteration is added to the seed, and not the iteration times the starts.
# says: share most of their starts
# -         first = seed + iteration * starts
# +         first = seed + iteration


# %% starts_without_the_seed loses 12.8
# The seeds of the episodes do not depend on that of the training.
# says: begins its episodes with the same seeds
# -         first = seed + iteration * starts
# +         first = iteration * starts


# %% nothing_for_the_rest_of_the_ruler loses 12.2
# Gives action 0 where rounding leaves a gap between the last sum and the dart.
# says: the last action owns the rest of the ruler
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     return int(np.argmax(beyond))


# %% one_largest_score_for_all_steps loses 12.1
# Subtracts the largest score of all steps from each of them, so that small ones become 0 / 0.
# says: Each row has its own largest score
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores - scores.max())


# %% action_after_the_right_one loses 12.2
# Takes the action after the one on which the dart lands.
# says: this
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     return min(int(np.argmax(beyond)) + 1, len(probabilities) - 1) if beyond.any() else len(beyond) - 1


# %% actions_always_whole loses 12.6
# Actions of any kind become whole numbers of int64.
# -     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64 if whole else torch.float32)
# +     wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64)


# %% mean_subtracted_from_the_scores loses 12.1
# The mean of the scores is subtracted, not the largest one, so large scores overflow.
# says: not the largest one of their row
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores - scores.mean(axis=-1, keepdims=True))


# %% tiny_number_against_0 loses 12.5
# A tiny number is added to the probability, which hides how improbable an action is.
# says: no surprise is larger
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return -torch.log(torch.exp(chosen - torch.logsumexp(scores, dim=1)) + 1e-10).mean()


# %% one_column_is_whole loses 12.6
# Actions with a single column are taken for whole numbers, whatever they are.
# says: this|with actions of torch.float32
# -     whole = np.issubdtype(np.asarray(actions).dtype, np.integer)
# +     whole = np.asarray(actions).ndim == 1 or np.shape(actions)[1] == 1


# %% acts_as_in_the_beginning loses 12.8
# The parameters that choose the actions are taken once, before the first iteration.
# says: the policy that acts stays as it was
# -     for iteration in range(iterations):
# -         parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
# +     parameters, spread = parameters_of(network), log_deviation.detach().numpy().copy()
# +     for iteration in range(iterations):


# %% scores_are_cut loses 12.1
# Cuts large scores off against overflow, which makes them equally probable: shift them.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(np.clip(scores, -500, 500))


# %% place_among_the_sorted loses 12.2
# Returns the place among the sorted probabilities instead of the action.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(np.sort(probabilities)[::-1]) > rng.random()


# %% mean_reward loses 12.3
# The return is the mean reward of a step instead of the sum.
# says: this|mean of the rewards is not
# -     return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
# +     mean = total / len(actions)
# +     return {"observations": np.array(observations), "actions": np.array(actions), "return": mean}


# %% observations_normalised loses 12.6
# Normalises the observations before they reach the network.
# says: this
# -     inputs = torch.as_tensor(np.asarray(observations), dtype=torch.float32)
# +     seen = np.asarray(observations)
# +     inputs = torch.as_tensor((seen - seen.mean(0)) / seen.std(0), dtype=torch.float32)


# %% scores_cut_at_700 loses 12.1
# Scores are cut off at 700 against overflow.
# says: cut off at a limit
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(np.clip(scores, -700, 700))


# %% rounded_dart loses 12.2
# The dart is rounded to one place.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     beyond = np.cumsum(probabilities) > round(rng.random(), 1)


# %% observation_at_the_end loses 12.3
# The observation at the end is recorded, too: one row more than actions.
# says: this|Its last row is what was seen after the last step
# -     return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
# +     observations.append(observation)
# +     return {"observations": np.array(observations), "actions": np.array(actions), "return": total}


# %% cut_to_half_the_limits loses 12.3
# Actions are cut to half of the limits.
# says: this
# -                 action = np.clip(action, space.low, space.high).astype(space.dtype)
# +                 action = np.clip(action, space.low / 2, space.high / 2).astype(space.dtype)


# %% largest_reward loses 12.3
# The return is the largest reward.
# says: this
# -             total += float(reward)
# +             total = max(total, float(reward))


# %% limits_of_the_first_actuator loses 12.3
# The limits of the first actuator are taken for all of them.
# says: this
# -                 action = np.clip(action, space.low, space.high).astype(space.dtype)
# +                 action = np.clip(action, space.low[0], space.high[0]).astype(space.dtype)


# %% one_step_more loses 12.3
# Makes one step more than maxsteps.
# says: this
# -         for _ in range(maxsteps):
# +         for _ in range(maxsteps + 1):


# %% percentile_for_a_share loses 12.4
# The bound is a quantile: the percentile is taken for a share from 0 to 1.
# says: this
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.percentile([e["return"] for e in episodes], percentile / 100))


# %% mean_for_the_bound loses 12.4
# The bound is the mean of the returns, whatever the percentile.
# says: this
# -     bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
# +     bound = float(np.mean([episode["return"] for episode in episodes]))


# %% observations_of_all loses 12.4
# The observations are those of all episodes; only the actions are those of the elite.
# says: this
# -         "observations": np.concatenate([episode["observations"] for episode in kept]),
# +         "observations": np.concatenate([episode["observations"] for episode in episodes]),


# %% actions_as_floats loses 12.4
# Whole actions become floats.
# says: this|actions must stay whole numbers
# -         "actions": np.concatenate([episode["actions"] for episode in kept]),
# +         "actions": np.concatenate([episode["actions"] for episode in kept]).astype(float),


# %% scores_with_the_wrong_sign loses 12.5
# The scores enter the sum with the wrong sign.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(-scores, dim=1) - chosen).mean()


# %% largest_for_the_sum loses 12.5
# The largest score is taken for the logarithm of the sum.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (scores.max(dim=1).values - chosen).mean()


# %% last_step_only loses 12.5
# Only the last step counts, not the mean.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - chosen)[-1]


# %% action_of_the_highest_score loses 12.5
# The action with the highest score is taken for the one that was done.
# says: this
# -     chosen = scores[torch.arange(len(actions)), actions]
# +     chosen = scores.max(dim=1).values


# %% last_loss_for_all loses 12.6
# The last loss is returned for each update.
# says: this
# -         losses.append(value.item())
# -     return losses
# +         losses.append(value.item())
# +     return [losses[-1]] * updates


# %% mean_of_the_losses_so_far loses 12.6
# Gives the mean of the losses so far.
# says: this
# -         losses.append(value.item())
# -     return losses
# +         losses.append(value.item())
# +     return [sum(losses[: i + 1]) / (i + 1) for i in range(updates)]


# %% variance_in_the_square loses 12.7
# The distance is divided by the variance, not by the deviation.
# says: this
# -     distance = (actions - means) / torch.exp(log_deviation)
# +     distance = (actions - means) / torch.exp(log_deviation) ** 2


# %% sigma_for_its_logarithm loses 12.7
# sigma itself is added, not ln sigma.
# says: this
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# +     surprise = distance**2 / 2 + torch.exp(log_deviation) + np.log(2 * np.pi) / 2


# %% uniform_noise loses 12.7
# The noise is even (rng.uniform), not Gaussian.
# says: this
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return mean + np.exp(log_deviation) * rng.uniform(-1, 1, len(mean))


# %% action_cut_when_drawn loses 12.7
# The action is cut to -1..1 here: that is left to run_episode.
# says: this
# -     return mean + np.exp(log_deviation) * rng.standard_normal(len(mean))
# +     return np.clip(mean + np.exp(log_deviation) * rng.standard_normal(len(mean)), -1, 1)


# %% number_for_the_loss loses 12.5
# The loss is a plain number (.item()): torch needs a tensor, to go back to the scores.
# says: this
# -     return (torch.logsumexp(scores, dim=1) - chosen).mean()
# +     return (torch.logsumexp(scores, dim=1) - chosen).mean().item()


# %% two_numbers_for_each_choice loses 12.2
# Draws two random numbers for each action and uses the second one: one is asked for.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# +     rng.random()
# +     beyond = np.cumsum(probabilities) > rng.random()


# %% quotient_of_starts loses 12.8
# Episode e begins with the seed of e // starts, not of e % starts: all of an iteration begin alike.
# says: right only if starts is 1
# -         found = [run_episode(environment, act, first + e % starts) for e in range(episodes)]
# +         found = [run_episode(environment, act, first + e // starts) for e in range(episodes)]


# %% scores_divided_by_100 loses 12.1
# Divides the scores by 100 before the exponential: this changes the probabilities.
# says: this
# -     powers = np.exp(scores - scores.max(axis=-1, keepdims=True))
# +     powers = np.exp(scores / 100)


# %% gumbel_noise loses 12.2
# Draws a random number for each action (Gumbel noise), but the dart is the only one.
# says: this
# -     beyond = np.cumsum(probabilities) > rng.random()
# -     return int(np.argmax(beyond)) if beyond.any() else len(probabilities) - 1
# +     with np.errstate(divide="ignore"):
# +         logarithms = np.log(probabilities)
# +     return int(np.argmax(logarithms + rng.gumbel(size=len(probabilities))))


# %% sigma_in_the_root_as_it_is loses 12.7
# Takes half the logarithm of 2 pi sigma: sigma is squared there, so that ln sigma counts whole.
# says: this
def gaussian_loss(means, log_deviation, actions):
    variance = torch.exp(2 * log_deviation)
    exponent = (actions - means).pow(2) / (2 * variance)
    normaliser = 0.5 * torch.log(2 * torch.pi * variance.sqrt())
    density = exponent + normaliser
    return density.sum(-1).mean()


# %% deviation_without_gradient loses 12.7
# Takes sigma out of torch (detach, numpy), so that the distance gives log_deviation no gradient.
# says: this
def gaussian_loss(means, log_deviation, actions):
    sigma = torch.from_numpy(np.exp(log_deviation.detach().numpy()))
    z = (actions - means) / sigma
    per_step = torch.zeros(len(z))
    for i in range(z.shape[1]):
        per_step = per_step + 0.5 * z[:, i] ** 2 + log_deviation[i] + 0.5 * np.log(2 * np.pi)
    return per_step.mean()


# %% constant_of_one_number loses 12.7
# The constant ln(2 pi) / 2 counts once, but it counts for each number of the action.
# says: this
# -     surprise = distance**2 / 2 + log_deviation + np.log(2 * np.pi) / 2
# -     return surprise.sum(dim=1).mean()
# +     surprise = distance**2 / 2 + log_deviation
# +     return surprise.sum(dim=1).mean() + np.log(2 * np.pi) / 2


# %% density_before_its_logarithm loses 12.7
# Multiplies the densities first: they underflow to 0, and the loss is infinite.
# says: this|the logarithm of 0
def gaussian_loss(means, log_deviation, actions):
    sigma = log_deviation.exp()
    bell = torch.exp(-((actions - means) ** 2) / (2 * sigma**2))
    density = bell / (sigma * (2 * torch.pi) ** 0.5)
    return -density.prod(dim=1).log().mean()


# %% chosen_scores_cut_off loses 12.5
# Makes a new tensor of the scores of the chosen actions, which cuts them off from the network.
# says: this
def cross_entropy(scores, actions):
    chosen = torch.tensor([scores[t, a].item() for t, a in enumerate(actions)])
    largest = scores.max(dim=1).values
    log_sum = largest + (scores - largest[:, None]).exp().sum(dim=1).log()
    return (log_sum - chosen).mean()


# %% best_episode_ends_it loses 12.8
# Ends training when the best episode of an iteration reaches the goal, not their mean.
# says: training goes on until
# -         if np.mean(returns[-1]) >= goal:
# -             break
# +         if np.max(returns[-1]) >= goal:
# +             break
# -     if attempts > 1 and np.mean(returns[-1]) < goal:
# +     if attempts > 1 and np.max(returns[-1]) < goal:


# %% largest_score_on_one_side loses 12.5
# Subtracts the largest score under the logarithm, but not from the score of the chosen action.
# says: this
def cross_entropy(scores, actions):
    largest = scores.max(dim=1, keepdim=True).values
    log_sum = torch.log(torch.sum(torch.exp(scores - largest), dim=1))
    chosen = torch.gather(scores, 1, actions.unsqueeze(1)).squeeze(1)
    return torch.mean(log_sum - chosen)


# %% gradients_cleared_once loses 12.6
# The gradients are cleared once, before the loop: each update adds its own to those before.
# says: this
# -     for _ in range(updates):
# -         value = loss(network(inputs), wanted)
# -         optimiser.zero_grad()
# +     optimiser.zero_grad()
# +     for _ in range(updates):
# +         value = loss(network(inputs), wanted)
