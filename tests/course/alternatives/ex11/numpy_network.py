# Trains with the gradient that was found by hand, and copies the weights into the network.
class Network(nn.Module):
    def __init__(self, inputs, hiddens, outputs):
        nn.Module.__init__(self)
        self.hidden, self.output = nn.Linear(inputs, hiddens), nn.Linear(hiddens, outputs)

    def features(self, patterns):
        return 1 / (1 + torch.exp(-self.hidden(patterns)))

    def forward(self, patterns):
        return self.features(patterns) @ self.output.weight.T + self.output.bias


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    activation = np.einsum("ni,hi->nh", inputs, w1) + b1
    hidden = (np.tanh(activation / 2) + 1) / 2
    outputs = np.einsum("nh,mh->nm", hidden, w2) + b2
    scale = 2 / np.size(targets)
    d2 = scale * (outputs - targets)
    d1 = np.einsum("nm,mh->nh", d2, w2) * (hidden - hidden**2)
    return {
        "loss": np.square(outputs - targets).mean(),
        "w1": np.einsum("nh,ni->hi", d1, inputs),
        "b1": np.einsum("nh->h", d1),
        "w2": np.einsum("nm,nh->mh", d2, hidden),
        "b2": np.einsum("nm->m", d2),
    }


def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    network = Network(inputs.shape[1], len(b1), len(b2)).double()
    layers = {"w1": network.hidden.weight, "b1": network.hidden.bias,
                  "w2": network.output.weight, "b2": network.output.bias}  # fmt: skip
    for layer, values in zip(layers.values(), (w1, b1, w2, b2), strict=False):
        layer.data = torch.tensor(values, dtype=torch.float64)
    loss = nn.MSELoss()(network(torch.tensor(inputs)), torch.tensor(targets))
    loss.backward()
    found = {name: layer.grad.numpy() for name, layer in layers.items()}
    found["loss"] = float(loss)
    return found


def learn(inputs, targets, hiddens, seed):
    rng, x, t = np.random.default_rng(seed), inputs.double().numpy(), targets.double().numpy()
    worst = 1.0
    while worst > 0.04:
        shapes = ((hiddens, x.shape[1]), (hiddens,), (1, hiddens), (1,))
        parameters = [rng.normal(0, 1.5, shape) for shape in shapes]
        running = [np.zeros(shape) for shape in shapes]
        for _ in range(5000):
            slopes = gradient_by_hand(x, t, *parameters)
            for i, name in enumerate(("w1", "b1", "w2", "b2")):
                running[i] = 0.9 * running[i] + slopes[name]
                parameters[i] = parameters[i] - 0.2 * running[i]
            if slopes["loss"] < 1e-5:
                break
        network = Network(x.shape[1], hiddens, 1)
        for own, value in zip(network.parameters(), parameters, strict=False):
            own.data.copy_(torch.from_numpy(value))
        worst = float((network(inputs) - targets).abs().max())
    return network


def normalise(inputs):
    mean = np.mean(inputs, axis=0)
    deviation = np.sqrt(np.mean(np.square(inputs - mean), axis=0))
    deviation[np.all(inputs == inputs[0], axis=0)] = 1
    return (inputs - mean) / deviation, mean, deviation


def minibatches(n, batch_size, rng):
    order = rng.permutation(n)
    return np.split(order, range(batch_size, n, batch_size))


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    rng, losses = np.random.default_rng(seed), []
    optimiser = torch.optim.SGD(network.parameters(), learning_rate, momentum)
    for _epoch in range(epochs):
        for numbers in minibatches(inputs.shape[0], batch_size, rng):
            numbers = torch.as_tensor(numbers)
            error = network(inputs.index_select(0, numbers)) - targets.index_select(0, numbers)
            optimiser.zero_grad()
            error.pow(2).mean().backward()
            optimiser.step()
        losses.append((network(inputs) - targets).pow(2).mean())
    return torch.stack(losses).detach()


def feature_maps(network, low, high, n):
    x = np.linspace(low, high, n, dtype=np.float32)
    first, second = np.meshgrid(x, x)
    patterns = torch.from_numpy(np.dstack([first, second]).reshape(-1, 2))
    return network.features(patterns).detach().T.unflatten(1, (n, n)).numpy()
