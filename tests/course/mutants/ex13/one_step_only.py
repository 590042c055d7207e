# loses: 13.1
# Stops at the first surprise.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, dones, gamma, 0.0)
