# loses: 2.7
# Right, but a loop over the networks.
def forward_batch(networks, observations):
    return np.array(
        [
            forward({key: stack[i] for key, stack in networks.items()}, observations[i])
            for i in range(len(observations))
        ]
    )
