# loses: 11.7
# Makes the generator anew in each epoch, and so the same minibatches.
_train_in_batches = train_in_batches


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    losses = []
    for _ in range(epochs):
        for batch in minibatches(len(inputs), batch_size, np.random.default_rng(seed)):
            optimiser.zero_grad()
            nn.functional.mse_loss(network(inputs[batch]), targets[batch]).backward()
            optimiser.step()
        losses.append(nn.functional.mse_loss(network(inputs), targets).item())
    return losses
