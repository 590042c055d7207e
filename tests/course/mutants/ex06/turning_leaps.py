# loses: 6.4
# A heading that goes beyond the whole turn counts as a turn back.
_describe = describe


def describe(poses, rewards, cylinder):
    told = _describe(poses, rewards, cylinder)
    return {**told, "turning": mean(np.diff(poses[:, 2])[: told["search"]])}
