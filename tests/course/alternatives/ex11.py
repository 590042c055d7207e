"""Right solutions of exercise 11 in other styles; building.py describes how a case is written."""


# %% numpy_network
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


# %% other_optimisers
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


# %% sums_and_loops
# Loops over patterns and neurons; lists where arrays are asked for; plain gradient steps.
import math


class Network(nn.Module):
    def __init__(self, inputs, hiddens, outputs):
        super().__init__()
        self.hidden = nn.Linear(in_features=inputs, out_features=hiddens)
        self.output = nn.Linear(in_features=hiddens, out_features=outputs)
        self.activation = nn.Sigmoid()

    def features(self, patterns):
        return self.activation(self.hidden(patterns))

    def forward(self, patterns):
        return self.output(self.activation(self.hidden(patterns)))


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    n, m, h = len(inputs), targets.shape[1], len(b1)
    loss = 0.0
    slopes = [np.zeros_like(each, dtype=float) for each in (w1, b1, w2, b2)]
    for x, t in zip(inputs, targets, strict=True):
        hidden = [1 / (1 + math.exp(-(sum(w * v for w, v in zip(w1[k], x, strict=True)) + b1[k])))
                  for k in range(h)]  # fmt: skip
        for j in range(m):
            y = sum(w2[j][k] * hidden[k] for k in range(h)) + b2[j]
            loss += (y - t[j]) ** 2 / (n * m)
            d2 = 2 * (y - t[j]) / (n * m)
            slopes[3][j] += d2
            for k in range(h):
                slopes[2][j, k] += d2 * hidden[k]
                d1 = d2 * w2[j][k] * hidden[k] * (1 - hidden[k])
                slopes[1][k] += d1
                slopes[0][k] += d1 * x
    return dict(
        zip(("w1", "b1", "w2", "b2"), (s.tolist() for s in slopes), strict=False), loss=loss
    )


def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    parameters = [torch.from_numpy(np.array(p, dtype=float)) for p in (w1, b1, w2, b2)]
    for each in parameters:
        each.requires_grad_()
    x, t = torch.from_numpy(inputs), torch.from_numpy(targets)
    hidden = torch.sigmoid(nn.functional.linear(x, parameters[0], parameters[1]))
    loss = nn.functional.mse_loss(nn.functional.linear(hidden, *parameters[2:]), t)
    slopes = torch.autograd.grad(loss, parameters)
    w1, b1, w2, b2 = (slope.numpy() for slope in slopes)
    return {"loss": loss.detach().numpy(), "w1": w1, "b1": b1, "w2": w2, "b2": b2}


def train(network, inputs, targets, epochs, learning_rate, momentum):
    velocity = [torch.zeros_like(p) for p in network.parameters()]
    losses = []
    for _ in range(epochs):
        network.zero_grad()
        loss = ((network(inputs) - targets) ** 2).mean()
        loss.backward()
        losses.append(loss)
        with torch.no_grad():
            for p, v in zip(network.parameters(), velocity, strict=True):
                v.mul_(momentum).add_(p.grad)
                p.sub_(learning_rate * v)
    return [float(each) for each in losses]


def learn(inputs, targets, hiddens, seed):
    attempt = 0
    while True:
        torch.manual_seed(1000 * seed + attempt)
        attempt += 1
        network = Network(inputs.shape[1], hiddens, 1)
        losses = [1.0]
        while len(losses) < 4000 and losses[-1] > 1e-5:
            losses += train(network, inputs, targets, 200, 0.3, 0.9)
        if losses[-1] < 1e-4:
            return network


def normalise(inputs):
    means, deviations = [], []
    for column in inputs.T:
        mean = sum(column) / len(column)
        variance = sum((each - mean) ** 2 for each in column) / len(column)
        means.append(mean)
        deviations.append(math.sqrt(variance) if len(set(column.tolist())) > 1 else 1.0)
    return (
        [[(x - m) / d for x, m, d in zip(row, means, deviations, strict=False)] for row in inputs],
        means,
        deviations,
    )


def minibatches(n, batch_size, rng):
    order, batches = list(rng.permutation(n)), []
    while order:
        batches.append(np.array(order[:batch_size]))
        order = order[batch_size:]
    return batches


def feature_maps(network, low, high, n):
    x = np.linspace(low, high, n)
    maps = np.zeros((network.hidden.out_features, n, n))
    for row in range(n):
        for column in range(n):
            pattern = torch.tensor([[x[column], x[row]]], dtype=torch.float32)
            maps[:, row, column] = network.features(pattern).detach().numpy()[0]
    return maps


# %% layers_in_a_sequence
# The gradient by einsum, pattern by pattern; the deviation by its formula; batches by splitting.
def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    n, m = targets.shape
    found = {"loss": 0.0, "w1": 0 * w1, "b1": 0 * b1, "w2": 0 * w2, "b2": 0 * b2}
    for x, y in zip(inputs, targets, strict=True):
        h = 1 / (1 + np.exp(-(w1 @ x) - b1))
        e = w2 @ h + b2 - y
        back = 2 / (n * m) * e
        inner = (back @ w2) * h * (1 - h)
        found["loss"] = found["loss"] + np.sum(e * e) / (n * m)
        found["w1"] = found["w1"] + np.outer(inner, x)
        found["b1"] = found["b1"] + inner
        found["w2"] = found["w2"] + np.outer(back, h)
        found["b2"] = found["b2"] + back
    return found


def normalise(inputs):
    inputs = np.array(inputs, dtype=np.float64)
    mean = inputs.sum(axis=0) / len(inputs)
    deviation = np.sqrt(((inputs - mean) ** 2).sum(axis=0) / len(inputs))
    same = np.all(inputs == inputs[0], axis=0)
    deviation[same] = 1.0
    mean[same] = inputs[0, same]
    return (inputs - mean) / deviation, mean, deviation


def minibatches(n, batch_size, rng):
    return np.split(rng.permutation(n), range(batch_size, n, batch_size))


# %% gradients_by_autograd_grad
# torch.autograd.grad in place of backward; the network is a chain of modules; steps by hand.
class Network(nn.Module):
    def __init__(self, inputs, hiddens, outputs):
        super().__init__()
        self.hidden, self.output = nn.Linear(inputs, hiddens), nn.Linear(hiddens, outputs)
        self.squash = nn.Sigmoid()

    def features(self, patterns):
        return self.squash(patterns @ self.hidden.weight.T + self.hidden.bias)

    def forward(self, patterns):
        return torch.nn.functional.linear(
            self.features(patterns), self.output.weight, self.output.bias
        )


def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    x, y = (torch.as_tensor(each, dtype=torch.float64) for each in (inputs, targets))
    own = [torch.from_numpy(np.array(each, dtype=float)) for each in (w1, b1, w2, b2)]
    for each in own:
        each.requires_grad_(True)
    hidden = 1 / (1 + torch.exp(-(x @ own[0].T + own[1])))
    loss = torch.nn.functional.mse_loss(hidden @ own[2].T + own[3], y)
    loss.backward()
    return {
        "loss": loss.detach().numpy(),
        **{
            name: each.grad.numpy()
            for name, each in zip(("w1", "b1", "w2", "b2"), own, strict=True)
        },
    }


# %% momentum_by_hand
# The velocity is kept by hand, and the weights are changed under no_grad.
def train(network, inputs, targets, epochs, learning_rate, momentum):
    own, losses = list(network.parameters()), []
    velocity = [torch.zeros_like(each) for each in own]
    for _ in range(epochs):
        loss = ((network(inputs) - targets) ** 2).mean()
        network.zero_grad()
        loss.backward()
        with torch.no_grad():
            for i, each in enumerate(own):
                velocity[i] = momentum * velocity[i] + each.grad
                each.sub_(learning_rate * velocity[i])
        losses.append(float(loss))
    return losses


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    rng, losses = np.random.default_rng(seed), []
    optimiser = torch.optim.SGD(network.parameters(), learning_rate, momentum)
    for _ in range(epochs):
        for chosen in minibatches(inputs.shape[0], batch_size, rng):
            chosen = torch.from_numpy(np.array(chosen))
            network.zero_grad()
            torch.square(network(inputs[chosen]) - targets[chosen]).mean().backward()
            optimiser.step()
        losses.append(torch.square(network(inputs) - targets).mean().item())
    return losses


# %% single_precision
# Computes in torch's usual single precision.
def gradient_by_torch(inputs, targets, *parameters):
    w1, b1, w2, b2 = tensors = [torch.tensor(p).float().requires_grad_() for p in parameters]
    hidden = torch.sigmoid(torch.tensor(inputs).float() @ w1.T + b1)
    loss = ((hidden @ w2.T + b2 - torch.tensor(targets).float()) ** 2).mean()
    loss.backward()
    gradients = [tensor.grad.numpy() for tensor in tensors]
    return {"loss": loss.item(), **dict(zip(("w1", "b1", "w2", "b2"), gradients, strict=True))}


# %% by_elements
# Loops over patterns, manual momentum.
def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    n, m = targets.shape
    g = {
        "w1": np.zeros_like(w1),
        "b1": np.zeros_like(b1),
        "w2": np.zeros_like(w2),
        "b2": np.zeros_like(b2),
    }
    loss = 0.0
    for x, t in zip(inputs, targets):
        h = 1 / (1 + np.exp(-(w1 @ x + b1)))
        e = w2 @ h + b2 - t
        loss += float(e @ e)
        d2 = 2 * e
        d1 = (w2.T @ d2) * h * (1 - h)
        g["w2"] += np.outer(d2, h)
        g["b2"] += d2
        g["w1"] += np.outer(d1, x)
        g["b1"] += d1
    return {"loss": loss / (n * m), **{k: v / (n * m) for k, v in g.items()}}


def train(network, inputs, targets, epochs, learning_rate, momentum):
    speed = [torch.zeros_like(p) for p in network.parameters()]
    losses = []
    for _ in range(epochs):
        network.zero_grad()
        loss = ((network(inputs) - targets) ** 2).mean()
        loss.backward()
        losses.append(float(loss))
        with torch.no_grad():
            for v, p in zip(speed, network.parameters()):
                v.mul_(momentum).add_(p.grad)
                p -= learning_rate * v
    return losses


def normalise(inputs):
    mean = inputs.sum(axis=0) / len(inputs)
    dev = np.sqrt(((inputs - mean) ** 2).mean(axis=0))
    for i in range(inputs.shape[1]):
        if inputs[:, i].max() == inputs[:, i].min():
            dev[i] = 1
    return (inputs - mean) / dev, mean, dev


def minibatches(n, batch_size, rng):
    p = rng.permutation(n)
    return np.split(p, range(batch_size, n, batch_size))


def feature_maps(network, low, high, n):
    x = np.linspace(low, high, n)
    a, b = np.meshgrid(x, x)
    p = torch.tensor(np.dstack([a, b]).reshape(-1, 2), dtype=torch.float32)
    f = network.features(p).detach().numpy()
    return np.moveaxis(f.reshape(n, n, -1), 2, 0)


# %% learns_in_numpy_by_keywords
# XOR is learnt in NumPy by 11.2's gradient, called by keywords; each network has one seed of torch's.
def learn(inputs, targets, hiddens, seed):
    x, t = inputs.numpy().astype(float), targets.numpy().astype(float)
    rng = np.random.default_rng(seed)
    while True:
        weights = {
            "w1": rng.normal(0, 1, (hiddens, x.shape[1])),
            "b1": rng.normal(0, 1, hiddens),
            "w2": rng.normal(0, 0.5, (t.shape[1], hiddens)),
            "b2": np.zeros(t.shape[1]),
        }
        speed = {name: 0.0 for name in weights}
        for _ in range(4000):
            found = gradient_by_hand(inputs=x, targets=t, **weights)
            for name in weights:
                speed[name] = 0.9 * speed[name] - 0.2 * found[name]
                weights[name] = weights[name] + speed[name]
        torch.manual_seed(seed)
        network = Network(x.shape[1], hiddens, t.shape[1])
        layers = (network.hidden.weight, network.hidden.bias)
        layers += (network.output.weight, network.output.bias)
        with torch.no_grad():
            for layer, value in zip(layers, weights.values(), strict=True):
                layer.copy_(torch.from_numpy(value))
            if float((network(inputs) - targets).abs().max()) < 0.04:
                return network


# %% gradient_as_a_default_argument
# The function of 11.2 is bound as a default argument, and torch's gradients by a name of their own.
from torch.autograd import grad


def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    x, t = torch.tensor(inputs), torch.tensor(targets)
    leaves = [torch.tensor(each, requires_grad=True) for each in (w1, b1, w2, b2)]
    hidden = torch.sigmoid(x @ leaves[0].T + leaves[1])
    loss = ((hidden @ leaves[2].T + leaves[3] - t) ** 2).mean()
    found = grad(loss, leaves)
    names = ("w1", "b1", "w2", "b2")
    return {"loss": loss.item()} | {n: g.numpy() for n, g in zip(names, found, strict=True)}


def learn(inputs, targets, hiddens, seed, gradient=gradient_by_hand):
    torch.manual_seed(seed)
    x, t = inputs.numpy().astype(float), targets.numpy().astype(float)
    while True:
        network = Network(x.shape[1], hiddens, t.shape[1])
        weights = [each.detach().numpy().astype(float) for each in network.parameters()]
        speed = [0 * each for each in weights]
        for _ in range(4000):
            found = gradient(x, t, *weights)
            slopes = [found[name] for name in ("w1", "b1", "w2", "b2")]
            speed = [0.9 * a + b for a, b in zip(speed, slopes, strict=True)]
            weights = [a - 0.25 * b for a, b in zip(weights, speed, strict=True)]
        with torch.no_grad():
            for layer, value in zip(network.parameters(), weights, strict=True):
                layer.copy_(torch.from_numpy(value))
            if float((network(inputs) - targets).abs().max()) < 0.04:
                return network
