# loses: 6.4
# Measures how far the robot moves, be it forwards or backwards.
_describe = describe


def describe(poses, rewards, cylinder):
    told = _describe(poses, rewards, cylinder)
    moved = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    return {**told, "speed": mean(moved[: told["search"]])}
