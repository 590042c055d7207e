# loses: 11.8
# Trains on the inputs as they come.
def fit(inputs, targets, seed):
    torch.manual_seed(seed)
    network = Network(inputs.shape[1], 30, targets.shape[1])
    patterns = torch.tensor(inputs, dtype=torch.float32)
    wanted = torch.tensor(targets, dtype=torch.float32)
    train_in_batches(network, patterns, wanted, 100, 20, 0.1, 0.9, seed)
    return network, np.zeros(inputs.shape[1]), np.ones(inputs.shape[1])
