# loses: 7.4
# Sets the state on the outermost wrapper, where nobody reads it.
def next_states(controller, states):
    env = gymnasium.make("Pendulum-v1")
    observation, _ = env.reset()
    following = []
    for angle, velocity in states:
        env.state = np.array([angle, velocity])
        seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
        observation, *_ = env.step(controller(seen))
        following.append(observation)
    return to_state(np.array(following))
