# loses: 13.1
# Lets the surprises after an end count for the actions before it.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    none = np.zeros_like(episode_starts)
    return _advantages(rewards, values, none, last_values, 0 * dones, gamma, gae_lambda)
