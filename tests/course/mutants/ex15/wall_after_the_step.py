# loses: 15.8
# Looks at the wall at the end of each step.
_describe = describe


def describe(poses):
    found, _before = _describe(poses), poses[:-1]
    after = poses[1:]
    to_wall = np.minimum(after[..., :2], 3000 - after[..., :2]).min(axis=-1)
    found["wall"] = (to_wall < 300).mean(axis=0)
    return found
