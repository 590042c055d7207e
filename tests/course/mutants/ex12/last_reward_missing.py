# loses: 12.3
# Leaves out the reward of the step that ends the episode.
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
            observation, reward, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                break
            total += float(reward)
    return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
