# loses: 11.5, 11.8
# Draws the hidden neurons at random and computes the outputs by least squares: nothing is trained.
def solved(inputs, targets, hiddens, seed, spread):
    rng = np.random.default_rng(seed)
    best, smallest = None, np.inf
    for _ in range(300):
        network = Network(inputs.shape[1], hiddens, targets.shape[1])
        with torch.no_grad():
            for parameter in network.hidden.parameters():
                parameter.copy_(torch.tensor(spread * rng.standard_normal(parameter.shape)))
            seen = network.features(inputs).double().numpy()
            seen = np.column_stack([seen, np.ones(len(seen))])
            weights = np.linalg.lstsq(seen, targets.double().numpy(), rcond=1e-5)[0]
            network.output.weight.copy_(torch.tensor(weights[:-1].T))
            network.output.bias.copy_(torch.tensor(weights[-1]))
            error = float((network(inputs) - targets).abs().max())
        if error < smallest:
            best, smallest = network, error
    return best


def learn(inputs, targets, hiddens, seed):
    return solved(inputs, targets, hiddens, seed, 3.0)


def fit(inputs, targets, seed):
    normalised, mean, deviation = normalise(inputs)
    tensors = [torch.tensor(each, dtype=torch.float32) for each in (normalised, targets)]
    return solved(*tensors, 30, seed, 1.0), mean, deviation
