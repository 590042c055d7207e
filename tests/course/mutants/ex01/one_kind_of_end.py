# loses: 1.2
# Treats the two ends as one, as the old `done` did.
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    done = episode["terminated"] or episode["truncated"]
    return {**episode, "terminated": done, "truncated": done}
