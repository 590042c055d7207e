# loses: 12.3
# Goes on when an episode is truncated.
def run_episode(environment, act, seed, maxsteps=200):
    observations, actions, total = [], [], 0.0
    with gymnasium.make(environment) as env:
        space = env.action_space
        observation, _ = env.reset(seed=seed)
        for _ in range(maxsteps):
            action = act(observation)
            observations.append(observation)
            actions.append(action)
            if isinstance(space, gymnasium.spaces.Box):
                action = np.clip(action, space.low, space.high).astype(space.dtype)
            observation, reward, terminated, _, _ = env.step(action)
            total += float(reward)
            if terminated:
                break
    return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
