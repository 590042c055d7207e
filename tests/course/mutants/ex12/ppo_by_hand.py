# loses: 12.8
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
