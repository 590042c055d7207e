# loses: 12.3
# Records what was observed after each action instead of before it.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    found = _run_episode(environment, act, seed, maxsteps)
    after = np.concatenate([found["observations"][1:], found["observations"][-1:]])
    return {**found, "observations": after}
