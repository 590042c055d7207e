# loses: 11.5
# Trains one network for long, and does not begin anew when it is stuck.
def learn(inputs, targets, hiddens, seed):
    torch.manual_seed(seed)
    network = Network(inputs.shape[1], hiddens, targets.shape[1])
    train(network, inputs, targets, epochs=4000, learning_rate=0.2, momentum=0.9)
    return network
