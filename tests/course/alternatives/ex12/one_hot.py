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
