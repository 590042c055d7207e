# loses: 12.6
# Never sets the gradients back to zero.
def improve(network, optimiser, observations, actions, loss, updates):
    whole = np.issubdtype(np.asarray(actions).dtype, np.integer)
    inputs = torch.as_tensor(np.asarray(observations), dtype=torch.float32)
    wanted = torch.as_tensor(np.asarray(actions), dtype=torch.int64 if whole else torch.float32)
    losses = []
    for _ in range(updates):
        value = loss(network(inputs), wanted)
        value.backward()
        optimiser.step()
        losses.append(value.item())
    return losses
