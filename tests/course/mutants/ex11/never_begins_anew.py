# loses: 11.5
# Trains one network for a fixed time and does not look at what has come out.
def learn(inputs, targets, hiddens, seed):
    torch.manual_seed(seed)
    network = Network(inputs.shape[1], hiddens, targets.shape[1])
    train(network, inputs, targets, epochs=200, learning_rate=0.1, momentum=0.9)
    return network
