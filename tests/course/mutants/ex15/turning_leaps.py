# loses: 15.8
# Takes a step from 359 to 1 degree for nearly a whole turn.
_describe = describe


def describe(poses):
    turning = np.abs(np.diff(poses[..., 2], axis=0)).mean(axis=0) / 0.1
    return {**_describe(poses), "turning": turning}
