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
