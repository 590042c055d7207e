# loses: 12.3
# Records the actions as the environment got them, cut to the limits.
_run_episode = run_episode


def run_episode(environment, act, seed, maxsteps=200):
    found = _run_episode(environment, act, seed, maxsteps)
    with gymnasium.make(environment) as env:
        if isinstance(env.action_space, gymnasium.spaces.Box):
            found["actions"] = found["actions"].clip(env.action_space.low, env.action_space.high)
    return found
