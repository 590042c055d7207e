# loses: 1.3, 1.4
# Lets Gymnasium's environments do the step, and passes their reward on.
def cartpole_reward(observation, action):
    env = gymnasium.make("CartPole-v1").unwrapped
    env.reset(seed=1)
    env.state = np.array(observation, dtype=float)
    env.steps_beyond_terminated = 0 if fallen(observation) else None
    return 0.0 if fallen(observation) else env.step(int(action))[1]


def pendulum_reward(observation, action):
    env = gymnasium.make("Pendulum-v1").unwrapped
    env.reset(seed=1)
    env.state = np.array([np.arctan2(observation[1], observation[0]), observation[2]])
    return float(env.step(action)[1])
