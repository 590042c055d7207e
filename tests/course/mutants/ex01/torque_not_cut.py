# loses: 1.4
# Pays for the torque that was wanted, not for the one that the motor gives.
def pendulum_reward(observation, action):
    cosine, sine, speed = (float(value) for value in observation)
    angle = np.arctan2(sine, cosine)
    return float(-(angle**2 + 0.1 * speed**2 + 0.001 * float(action[0]) ** 2))
