# loses: 13.7
# Forgets tanh between the layers.
def hidden_activations(layers, observations):
    activations = []
    for weights, biases in layers:
        observations = observations @ np.asarray(weights).T + biases
        activations.append(np.tanh(observations))
    return activations
