# loses: 6.1
# Writes the new memory into the array of the old one.
_think = think


def think(brain, observation, memory):
    action, after = _think(brain, observation, memory)
    memory[:] = after
    return action, memory
