# loses: 15.1
# Uses the networks of a chase again in the next one, with what they remember.
_robot = robot
_known = {}


def robot(genotype):
    key = genotype.tobytes()
    if key not in _known:
        _known[key] = _robot(genotype)
    return _known[key]
