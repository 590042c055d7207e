# loses: 15.8
# Counts the other robot as faced when it is anywhere in front.
_describe = describe


def describe(poses):
    before = poses[:-1]
    away = before[:, ::-1, :2] - before[..., :2]
    ahead = away[..., 0] * np.cos(before[..., 2]) + away[..., 1] * np.sin(before[..., 2])
    return {**_describe(poses), "facing": (ahead > 0).mean(axis=0)}
