# loses: 11.4
# Returns the loss of each epoch as it is after the step.
_train = train


def train(network, inputs, targets, *rest, **more):
    losses = _train(network, inputs, targets, *rest, **more)
    return [*losses[1:], nn.functional.mse_loss(network(inputs), targets).item()]
