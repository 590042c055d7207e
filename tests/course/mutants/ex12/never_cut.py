# loses: 12.3
# Hands actions on without cutting them to the limits.
def run_episode(environment, act, seed, maxsteps=200):
    observations, actions, total = [], [], 0.0
    with gymnasium.make(environment) as env:
        observation, _ = env.reset(seed=seed)
        for _ in range(maxsteps):
            observations.append(observation)
            actions.append(act(observation))
            observation, reward, terminated, truncated, _ = env.step(actions[-1])
            total += float(reward)
            if terminated or truncated:
                break
    return {"observations": np.array(observations), "actions": np.array(actions), "return": total}
