# loses: 2.2
# Forgets tanh at the outputs: their order stays, so discrete actions are right.
def forward(network, observation):
    hidden = np.tanh(network["W1"] @ observation + network["b1"])
    return network["W2"] @ hidden + network["b2"]
