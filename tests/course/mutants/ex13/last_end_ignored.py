# loses: 13.1
# Does not look whether the last step ended its episode.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, 0 * dones, gamma, gae_lambda)
