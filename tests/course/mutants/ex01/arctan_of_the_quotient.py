# loses: 1.4
# arctan(sin / cos) knows half of the circle only.
def pendulum_reward(observation, action):
    cosine, sine, speed = (float(value) for value in observation)
    torque = np.clip(float(action[0]), -2.0, 2.0)
    return float(-(np.arctan(sine / cosine) ** 2 + 0.1 * speed**2 + 0.001 * torque**2))
