# loses: 13.1
# Later surprises count less by gamma alone.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, dones, gamma, 1.0)
