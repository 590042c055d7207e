# loses: 5.2
# Scales the default angles without cutting them off.
_joints = joints


def joints(parameters):
    return _joints(parameters) | {"angles": 3 * np.pi / 4 * parameters[42:53]}
