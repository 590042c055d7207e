# loses: 2.2
# Makes columns of the biases in the network itself.
def forward(network, observation):
    values = observation[:, None]
    for layer in "12":
        network["b" + layer].shape = (-1, 1)
        values = np.tanh(network["W" + layer] @ values + network["b" + layer])
    return values[:, 0]
