# loses: 5.2
# Takes the first limit of each joint for the lower one.
_joints = joints


def joints(parameters):
    limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
    return _joints(parameters) | {"lower": limits[:, 0], "upper": limits[:, 1]}
