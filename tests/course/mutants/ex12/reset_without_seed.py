# loses: 12.3
# Begins anywhere instead of where the seed says.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    return _run_episode(environment, act, seed + 1, maxsteps)
