# loses: 13.1
# Takes the first step of an episode for its last one.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    shifted = np.concatenate([episode_starts[:1], episode_starts[:-1]])
    return _advantages(rewards, values, shifted, last_values, dones, gamma, gae_lambda)
