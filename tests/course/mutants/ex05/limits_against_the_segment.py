# loses: 5.2
# Counts the limits from the segment before, instead of from the default angle.
_joints = joints


def joints(parameters):
    found = _joints(parameters)
    rest = found["angles"][1:]
    return found | {"lower": rest + found["lower"], "upper": rest + found["upper"]}
