# loses: 2.5
# Ignores maxsteps.
_run_episode = run_episode


def run_episode(environment_id, network, seed, maxsteps=200):
    return _run_episode(environment_id, network, seed, 10_000)
