# loses: 1.2
# Reports an episode that only maxsteps stopped as truncated by the environment.
_random_episode = random_episode


def random_episode(environment_id, seed, maxsteps):
    episode = _random_episode(environment_id, seed, maxsteps)
    over = episode["terminated"] or len(episode["actions"]) == maxsteps
    return {**episode, "truncated": episode["truncated"] or (over and not episode["terminated"])}
