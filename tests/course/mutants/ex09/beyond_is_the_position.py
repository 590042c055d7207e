# loses: 9.4
# A Humanoid pays for the whole position of a joint that is past its limit.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    size = np.abs(trajectory["positions"])
    more = np.where(size > 1, 1.0, 0.0).sum(axis=1)
    return _reward_v5(trajectory) - 10 * more * (trajectory["robot"] == "Humanoid")
