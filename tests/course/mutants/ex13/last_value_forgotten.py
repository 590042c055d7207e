# loses: 13.1
# Takes the rollout for over: nothing comes after its last step.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, 0 * last_values, dones, gamma, gae_lambda)
