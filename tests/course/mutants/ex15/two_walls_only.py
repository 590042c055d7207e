# loses: 15.8
# Forgets the walls above and to the right.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    found["wall"] = (before[..., :2].min(axis=-1) < 300).mean(axis=0)
    return found
