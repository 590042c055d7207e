# loses: 1.2
# Keeps the observations of the steps, but not the one of the reset.
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    return {**episode, "observations": episode["observations"][1:]}
