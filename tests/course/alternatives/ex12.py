"""Right solutions of exercise 12 in other styles; building.py describes how a case is written."""

# %% lists_and_loops
# Plain Python: math, lists and loops where the solution has arrays.
import math


def softmax(scores):
    scores = np.asarray(scores, dtype=float)
    if scores.ndim > 1:
        return [softmax(row) for row in scores]
    top = max(scores)
    powers = [math.exp(score - top) for score in scores]
    return [power / sum(powers) for power in powers]


def choose(probabilities, rng):
    dart, edge = rng.random(), 0.0
    for action, probability in enumerate(probabilities):
        edge += probability
        if dart < edge:
            return action
    return len(probabilities) - 1


def run_episode(environment, act, seed, maxsteps=200):
    env = gymnasium.make(environment)
    limits = getattr(env.action_space, "low", None), getattr(env.action_space, "high", None)
    observation = env.reset(seed=seed)[0]
    record = {"observations": [], "actions": [], "return": 0.0}
    ended = False
    while not ended and len(record["actions"]) < maxsteps:
        action = act(observation)
        record["observations"].append(observation.tolist())
        record["actions"].append(action)
        if limits[0] is not None:
            bounded = zip(action, *limits, strict=True)
            action = np.array([min(max(a, low), high) for a, low, high in bounded])
        observation, reward, terminated, truncated, _ = env.step(action)
        record["return"] += reward
        ended = terminated or truncated
    env.close()
    return record


def elite(episodes, percentile):
    returns = []
    for episode in episodes:
        returns.append(episode["return"])
    bound = np.percentile(returns, percentile)
    observations, actions = [], []
    for episode in episodes:
        if episode["return"] >= bound:
            observations += list(episode["observations"])
            actions += list(episode["actions"])
    return {"observations": observations, "actions": actions, "bound": bound}


def cross_entropy(scores, actions):
    top = scores.max(dim=1).values.detach()
    below, chosen = 0.0, 0.0
    for action in range(scores.shape[1]):
        below = below + torch.exp(scores[:, action] - top)
        chosen = chosen + scores[:, action] * (actions == action)
    surprises = top + torch.log(below) - chosen
    return sum(surprises) / len(surprises) if len(surprises) < 50 else surprises.mean()


def gaussian_action(mean, log_deviation, rng):
    noise = rng.standard_normal(len(mean))
    return [m + math.exp(d) * e for m, d, e in zip(mean, log_deviation, noise, strict=False)]


def gaussian_loss(means, log_deviation, actions):
    total = 0.0
    for i in range(means.shape[1]):
        sigma = log_deviation[i].exp()
        total = total + (actions[:, i] - means[:, i]) ** 2 / (2 * sigma**2)
        total = total + log_deviation[i] + 0.5 * math.log(2 * math.pi)
    return torch.mean(total)


# %% one_hot
# One-hot actions, a matrix product for the elite's rows, an iteration with wrappers of its own.
def softmax(scores):
    shifted = np.array(scores, dtype=np.float64)
    shifted -= np.max(shifted, axis=-1)[..., None]
    return np.exp(shifted) / np.einsum("...a->...", np.exp(shifted))[..., None]


def choose(probabilities, rng):
    dart = rng.random()
    for action in range(len(probabilities)):
        if np.sum(probabilities[: action + 1]) > dart:
            return action
    return action


def cross_entropy(scores, actions):
    hot = torch.eye(scores.shape[1], dtype=scores.dtype)[actions]
    return (torch.logsumexp(scores, 1) - (hot * scores).sum(1)).sum() / scores.shape[0]


def improve(network, optimiser, observations, actions, loss, updates):
    kind = torch.float32
    if np.asarray(actions).dtype.kind in "iu":
        kind = torch.int64
    observations, actions = torch.tensor(observations).float(), torch.tensor(actions).to(kind)

    def update():
        optimiser.zero_grad()
        value = loss(network(observations), actions)
        value.backward()
        optimiser.step()
        return value.item()

    return [update() for _ in range(updates)]


def gaussian_loss(means, log_deviation, actions):
    variance = torch.exp(2 * log_deviation)
    squares = (means - actions).square() / variance
    constant = torch.log(2 * torch.pi * variance)
    return 0.5 * (squares + constant).sum() / len(means)


def train(environment, seed):
    """Larger iterations, another optimiser, observations scaled by what CartPole's can be."""
    torch.manual_seed(seed)
    rng = np.random.default_rng(seed + 1)
    scale = np.array([2.4, 2.0, 0.2, 2.0])
    with gymnasium.make(environment) as env:
        discrete = env.action_space.__class__.__name__ == "Discrete"
    network = make_network(4, 2 if discrete else 1, 16)
    log_deviation = torch.full((1,), -0.5, requires_grad=True)
    chosen = [*network.parameters(), log_deviation]
    optimiser = torch.optim.RMSprop(chosen, lr=0.01)
    returns, episode_seed = [], 1000 * seed

    def act(observation):
        scores = outputs_of(parameters, observation / scale)
        if discrete:
            return choose(softmax(scores), rng)
        return gaussian_action(scores, spread, rng)

    for _ in range(120):
        parameters = parameters_of(network)
        spread = log_deviation.detach().numpy().copy()
        played = []
        for _ in range(25):
            episode_seed += 1
            played.append(run_episode(environment, act, episode_seed))
        returns.append(np.array([episode["return"] for episode in played]))
        if returns[-1].mean() > 197:
            break
        best = elite(played, 75)
        improve(
            network, optimiser, np.asarray(best["observations"]) / scale, best["actions"],
            cross_entropy if discrete else lambda m, a: gaussian_loss(m, log_deviation, a), 8,
        )  # fmt: skip
    W1, b1, W2, b2 = parameters_of(network)
    return {"parameters": [W1 / scale, b1, W2, b2], "returns": returns}


# %% other_functions
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
    logarithms = scores - scores.logsumexp(dim=-1, keepdim=True)
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
    variance = log_deviation.mul(2).exp()
    density = -((actions - means) ** 2) / (2 * variance) - 0.5 * torch.log(2 * np.pi * variance)
    return -density.sum(-1).mean()


# %% probabilities_by_differences
# Probabilities by the differences of scores; a search in the ruler; boolean rows for the elite.
def softmax(scores):
    scores = np.asarray(scores, dtype=np.float64)
    apart = scores[..., None, :] - scores[..., :, None]
    return 1 / np.exp(np.minimum(apart, 700)).sum(axis=-1)


def choose(probabilities, rng):
    place = np.searchsorted(np.cumsum(probabilities), rng.random(), side="right")
    return min(int(place), len(probabilities) - 1)


def elite(episodes, percentile):
    returns = np.array([episode["return"] for episode in episodes])
    bound = np.percentile(returns, percentile)
    chosen = np.flatnonzero(returns >= bound)
    parts = {
        key: np.concatenate([np.asarray(episodes[i][key]) for i in chosen])
        for key in ("observations", "actions")
    }
    return {**parts, "bound": np.float64(bound)}


# %% gathered_scores
# gather for the chosen scores, a density by its factors, closures for the optimiser.
def cross_entropy(scores, actions):
    highest = scores.max(dim=1, keepdim=True).values.detach()
    chosen = scores.gather(1, actions.long().unsqueeze(1))
    sums = (scores - highest).exp().sum(dim=1, keepdim=True)
    return torch.mean(highest + sums.log() - chosen)


def improve(network, optimiser, observations, actions, loss, updates):
    actions = np.asarray(actions)
    inputs = torch.from_numpy(np.array(observations, dtype=np.float32))
    kind = torch.long if actions.dtype.kind in "iu" else torch.float
    wanted, losses = torch.from_numpy(actions.copy()).to(kind), []

    def closure():
        optimiser.zero_grad(set_to_none=True)
        value = loss(network(inputs), wanted)
        value.backward()
        losses.append(float(value.detach()))
        return value

    for _ in range(updates):
        optimiser.step(closure)
    return losses


def gaussian_action(mean, log_deviation, rng):
    noise = rng.standard_normal(np.shape(mean)[0])
    return np.add(mean, noise * np.e ** np.asarray(log_deviation))


def gaussian_loss(means, log_deviation, actions):
    count = len(means)
    squares = ((actions - means) ** 2 * torch.exp(-2 * log_deviation)).sum() / (2 * count)
    return squares + log_deviation.sum() + means.shape[1] * np.log(2 * np.pi) / 2


# %% an_environment_by_hand
# The environment is opened and closed by hand; while loops; actions are cut by minimum and maximum.
def run_episode(environment, act, seed, maxsteps=200):
    env = gymnasium.make(environment)
    space, record, total, ended = env.action_space, [], 0, False
    observation = env.reset(seed=seed)[0]
    try:
        while not ended and len(record) < maxsteps:
            action = act(observation)
            record.append((np.array(observation), np.array(action)))
            if hasattr(space, "low"):
                action = np.minimum(np.maximum(action, space.low), space.high)
                action = action.astype(np.float32)
            observation, reward, terminated, truncated, _ = env.step(action)
            ended, total = terminated or truncated, total + reward
    finally:
        env.close()
    seen, done = zip(*record, strict=True)
    return {"return": float(total), "actions": np.stack(done), "observations": np.stack(seen)}


# %% other_formulas
# logaddexp, searchsorted, distributions by hand.
def softmax(scores):
    s = np.asarray(scores, dtype=float)
    return np.exp(s - np.logaddexp.reduce(s, axis=-1, keepdims=True))


def choose(probabilities, rng):
    u = rng.random()
    return int(
        min(np.searchsorted(np.cumsum(probabilities), u, side="right"), len(probabilities) - 1)
    )


def run_episode(environment, act, seed, maxsteps=200):
    env = gymnasium.make(environment)
    state, _ = env.reset(seed=seed)
    box = hasattr(env.action_space, "low")
    rows, rewards = [], []
    while len(rows) < maxsteps:
        a = act(state)
        rows.append((state, a))
        given = (
            np.minimum(np.maximum(a, env.action_space.low), env.action_space.high).astype(
                np.float32
            )
            if box
            else int(a)
        )
        state, r, t1, t2, _ = env.step(given)
        rewards.append(float(r))
        if t1 or t2:
            break
    return {
        "observations": np.array([r[0] for r in rows]),
        "actions": np.array([r[1] for r in rows]),
        "return": sum(rewards),
    }


def elite(episodes, percentile):
    bound = np.percentile(np.array([e["return"] for e in episodes]), percentile)
    good = [i for i in range(len(episodes)) if not episodes[i]["return"] < bound]
    return {
        k: np.concatenate([episodes[i][k] for i in good]) for k in ("observations", "actions")
    } | {"bound": float(bound)}


def cross_entropy(scores, actions):
    top = scores.max(dim=1, keepdim=True).values
    e = torch.exp(scores - top)
    logs = scores - top - torch.log(e.sum(dim=1, keepdim=True))
    return -logs.gather(1, actions.reshape(-1, 1)).sum() / len(actions)


def gaussian_action(mean, log_deviation, rng):
    z = rng.standard_normal(np.shape(mean)[0])
    return np.array([m + np.exp(s) * n for m, s, n in zip(mean, log_deviation, z)])


def gaussian_loss(means, log_deviation, actions):
    z = (actions - means) * torch.exp(-log_deviation)
    k = actions.shape[1]
    return 0.5 * (z * z).sum(1).mean() + log_deviation.sum() + k * 0.5 * float(np.log(2 * np.pi))


# %% looks_before_and_between
# Resets once to see the shapes; one start an iteration; tests without chance; attempts in a loop.
def train(environment, seed):
    env = gymnasium.make(environment)
    observation, _ = env.reset(seed=seed)
    space = env.action_space
    env.close()
    discrete = hasattr(space, "n")
    rng = np.random.default_rng([seed, 7])
    generator = torch.manual_seed(seed)
    for _attempt in range(4):
        torch.manual_seed(int(torch.randint(2**31, (1,), generator=generator)))
        network = make_network(len(observation), space.n if discrete else len(space.low))
        network.register_parameter("sigma", torch.nn.Parameter(torch.zeros(1)))
        optimiser = torch.optim.Adam(network.parameters(), lr=0.01)

        def forward(patterns, network=network):
            return network(patterns)

        def act(seen, network=network):
            outputs = outputs_of(parameters, seen)
            if discrete:
                return choose(softmax(outputs), rng)
            return gaussian_action(outputs, network.sigma.detach().numpy(), rng)

        def best_act(seen):
            outputs = outputs_of(parameters, seen)
            return int(outputs.argmax()) if discrete else outputs

        def loss(outputs, actions, network=network):
            if discrete:
                return cross_entropy(outputs, actions)
            return gaussian_loss(outputs, log_deviation=network.sigma, actions=actions)

        returns = []
        for i in range(60):
            parameters = [p.detach().numpy().astype(float) for p in list(network.parameters())[-4:]]
            played = [run_episode(environment, act, seed + 30 * i + e) for e in range(30)]
            returns.append([each["return"] for each in played])
            tests = [run_episode(environment, best_act, seed + e)["return"] for e in range(10)]
            if min(tests) >= 199:
                return {"parameters": parameters, "returns": returns}
            best = elite(played, 70)
            improve(forward, optimiser, best["observations"], best["actions"], loss, 10)
    return {"parameters": parameters, "returns": returns}
