# loses: 2.4
# Uses the outputs of a Box as they are: Pendulum's motor gives half of its torque.
def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        return int(action_space.start + np.argmax(outputs))
    return np.asarray(outputs, dtype=np.float32)
