# loses: 15.8
# Counts a robot exactly 300 mm from a wall as near.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
    found["wall"] = (to_wall <= 300).mean(axis=0)
    return found
