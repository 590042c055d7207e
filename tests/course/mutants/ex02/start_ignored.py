# loses: 2.4
# The first choice is always 0.
_act = act


def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        return int(np.argmax(outputs))
    return _act(outputs, action_space)
