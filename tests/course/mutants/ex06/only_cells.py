# loses: 6.7
# Shows the network the cells, but not the outputs of the step before.
_reactions = reactions


def reactions(brain, observation, memories):
    memories = np.array(memories)
    memories[:, 1] = 0
    return _reactions(brain, observation, memories)
