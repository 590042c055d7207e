# loses: 9.4
# Hopper and Walker2D pay for joints at their limits too.
_reward_v5 = reward_v5


def reward_v5(trajectory):
    more = joints_at_limit(trajectory["positions"])
    return _reward_v5(trajectory) + more * (trajectory["robot"] in ("Hopper", "Walker2D"))
