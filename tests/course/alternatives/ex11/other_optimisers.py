# Adam and L-BFGS, restarts chosen among several networks, early stopping on held-out patterns.
def train(network, inputs, targets, epochs, learning_rate, momentum):
    optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    measure = nn.MSELoss(reduction="sum")
    losses = np.zeros(epochs)
    for epoch in range(epochs):
        loss = measure(network(inputs), targets) / targets.numel()
        optimiser.zero_grad(set_to_none=False)
        loss.backward()
        losses[epoch] = loss.item()
        optimiser.step()
    return losses


def learn(inputs, targets, hiddens, seed):
    generator = torch.Generator().manual_seed(seed)
    while True:
        networks = []
        for _ in range(6):
            network = Network(inputs.shape[1], hiddens, targets.shape[1])
            for parameter in network.parameters():
                nn.init.normal_(parameter, std=1.0, generator=generator)
            optimiser = torch.optim.LBFGS(
                network.parameters(), max_iter=300, line_search_fn="strong_wolfe"
            )

            def closure(network=network, optimiser=optimiser):
                optimiser.zero_grad()
                loss = nn.functional.mse_loss(network(inputs), targets)
                loss.backward()
                return loss

            optimiser.step(closure)
            networks.append(
                (float((network(inputs) - targets).abs().max()), len(networks), network)
            )
        worst, _, best = min(networks)
        if worst < 0.03:
            return best


def normalise(inputs):
    mean = inputs.sum(0) / len(inputs)
    centred = inputs - mean
    deviation = np.sqrt((centred * centred).sum(0) / len(inputs))
    deviation = np.where(deviation < 1e-9 * (1 + np.abs(mean)), 1.0, deviation)
    return centred / deviation, mean, deviation


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    rng = np.random.default_rng(seed)
    losses, velocity = [], {}
    for _ in range(epochs):
        order = rng.permutation(len(inputs))
        for start in range(0, len(order), batch_size):
            chosen = order[start : start + batch_size].tolist()
            loss = (network(inputs[chosen]) - targets[chosen]).square().mean()
            slopes = torch.autograd.grad(loss, list(network.parameters()))
            with torch.no_grad():
                for i, (parameter, slope) in enumerate(
                    zip(network.parameters(), slopes, strict=False)
                ):
                    velocity[i] = momentum * velocity.get(i, 0) + slope
                    parameter -= learning_rate * velocity[i]
        losses.append(((network(inputs) - targets) ** 2).mean().item())
    return tuple(losses)


def fit(inputs, targets, seed):
    torch.manual_seed(seed)
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
    x = torch.tensor((inputs - mean) / deviation, dtype=torch.float32)
    t = torch.tensor(targets, dtype=torch.float32)
    network = Network(x.shape[1], 40, t.shape[1])
    optimiser = torch.optim.Adam(network.parameters(), lr=0.02)
    for _ in range(1500):
        optimiser.zero_grad()
        loss = nn.functional.mse_loss(network(x), t)
        loss.backward()
        optimiser.step()
    return network, mean.tolist(), deviation.tolist()
