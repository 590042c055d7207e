# loses: 7.4
# The controller is given the observation of the grid state before.
def next_states(controller, states):
    env = gymnasium.make("Pendulum-v1")
    observation, _ = env.reset(seed=0)
    following = []
    for state in states:
        env.unwrapped.state = np.array(state)
        observation, *_ = env.step(controller(observation))
        following.append(observation)
    return to_state(np.array(following))
