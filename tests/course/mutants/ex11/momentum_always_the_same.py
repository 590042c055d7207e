# loses: 11.4
# Uses a momentum of 0.9, whatever it is asked for.
_train = train


def train(network, inputs, targets, epochs, learning_rate, momentum):
    return _train(network, inputs, targets, epochs, learning_rate, 0.9)
