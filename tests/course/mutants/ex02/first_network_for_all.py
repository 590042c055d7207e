# loses: 2.7
# Uses the second layer of the first network for all of them.
def forward_batch(networks, observations):
    hidden = np.einsum("nhi,ni->nh", networks["W1"], observations) + networks["b1"]
    return np.tanh(np.tanh(hidden) @ networks["W2"][0].T + networks["b2"])
