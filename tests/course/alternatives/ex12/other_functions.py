# Other functions of NumPy and torch that compute the same.
def softmax(scores):
    scores = np.asarray(scores, dtype=np.float64)
    logarithms = scores - np.logaddexp.reduce(scores, axis=-1, keepdims=True)
    return np.exp(logarithms)


def choose(probabilities, rng):
    edges = np.cumsum(probabilities)
    return int(min(np.searchsorted(edges, rng.random(), side="right"), len(edges) - 1))


def run_episode(environment, act, seed, maxsteps=200):
    env = gymnasium.make(environment)
    seen, done, rewards = [], [], []
    observation, _info = env.reset(seed=seed)
    for _step in range(maxsteps):
        seen.append(np.copy(observation))
        done.append(act(observation))
        motor = done[-1]
        if not isinstance(env.action_space, gymnasium.spaces.Discrete):
            motor = np.clip(motor, env.action_space.low, env.action_space.high)
        observation, reward, terminated, truncated, _info = env.step(motor)
        rewards.append(reward)
        if terminated | truncated:
            break
    env.close()
    return {"observations": np.stack(seen), "actions": np.stack(done), "return": sum(rewards)}


def elite(episodes, percentile):
    returns = np.array([episode["return"] for episode in episodes])
    bound = np.percentile(returns, percentile)
    kept = [episodes[i] for i in np.flatnonzero(returns >= bound)]
    found = {"bound": bound}
    for key in ("observations", "actions"):
        stack = np.vstack if np.ndim(kept[0][key]) > 1 else np.hstack
        found[key] = stack([episode[key] for episode in kept])
    return found


def cross_entropy(scores, actions):
    logarithms = torch.log_softmax(scores, dim=-1)
    return -torch.gather(logarithms, 1, actions.view(-1, 1)).mean()


def improve(network, optimiser, observations, actions, loss, updates):
    inputs = torch.from_numpy(np.array(observations, dtype=np.float32))
    actions = np.array(actions)
    wanted = torch.from_numpy(actions.astype("int64" if actions.dtype.kind in "iu" else "float32"))
    losses = []
    while len(losses) < updates:
        network.zero_grad(set_to_none=True)
        optimiser.zero_grad()
        value = loss(network(inputs), wanted)
        value.backward()
        losses.append(float(value.detach()))
        optimiser.step()
    return losses


def gaussian_action(mean, log_deviation, rng):
    return rng.standard_normal(np.shape(mean)) * np.exp(log_deviation) + mean


def gaussian_loss(means, log_deviation, actions):
    normal = torch.distributions.Normal(means, log_deviation.exp())
    return -normal.log_prob(actions).sum(-1).mean()
