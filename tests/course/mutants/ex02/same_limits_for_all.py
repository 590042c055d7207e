# loses: 2.4
# Stretches every number by the upper limit of the first, which one-motor robots forgive.
def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        return int(action_space.start + np.argmax(outputs))
    return (outputs * action_space.high[0]).astype(np.float32)
