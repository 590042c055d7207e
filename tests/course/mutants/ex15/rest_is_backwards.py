# loses: 15.8
# Takes standing still for driving backwards.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    heading, moved = before[..., 2], poses[1:, :, :2] - before[..., :2]
    forward = moved[..., 0] * np.cos(heading) + moved[..., 1] * np.sin(heading)
    found["backwards"] = (forward <= 0).mean(axis=0)
    return found
