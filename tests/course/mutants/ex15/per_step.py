# loses: 15.8
# Measures speed by step and not by second.
_describe = describe


def describe(poses):
    found = _describe(poses)
    return {**found, "speed": found["speed"] / 10}
