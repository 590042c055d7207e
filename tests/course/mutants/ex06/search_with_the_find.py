# loses: 6.4
# Counts the first step near the cylinder as part of the search.
_describe = describe


def describe(poses, rewards, cylinder):
    search = _describe(poses, rewards, cylinder)["search"] + 1
    early = _describe(poses[: search + 1], np.zeros(min(search, len(rewards))), cylinder)
    late = _describe(poses, rewards, cylinder)
    return {**early, "pace": late["pace"], "side": late["side"]}
