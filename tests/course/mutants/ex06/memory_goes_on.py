# loses: 6.7
# Carries the memory on from one reaction to the next.
def reactions(brain, observation, memories):
    actions, memory = [], memories[0]
    for _ in memories:
        action, memory = think(brain, observation, memory)
        actions.append(action)
    return np.array(actions)
