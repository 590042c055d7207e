# loses: 9.4
# An Ant gets 1 instead of 0.01 for every step.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    return _reward_v5(trajectory) + 0.99 * (trajectory["robot"] == "Ant")
