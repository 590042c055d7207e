# loses: 6.4
# Looks for the cylinder from where the robot was before the step.
_describe = describe


def describe(poses, rewards, cylinder):
    away = np.asarray(cylinder) - poses[:-1, :2]
    bearing = np.arctan2(away[:, 1], away[:, 0]) - poses[:-1, 2]
    told = _describe(poses, rewards, cylinder)
    return {**told, "side": mean(np.sin(bearing[rewards > 0]))}
