# loses: 1.2
# Looks at `terminated` alone, and goes on when the time limit is over.
def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    observations, actions, rewards = [observation], [], []
    terminated = truncated = False
    while len(actions) < min(maxsteps, 2000) and not terminated:
        action = env.action_space.sample()
        observation, reward, terminated, truncated, _ = env.step(action)
        observations.append(observation)
        actions.append(action)
        rewards.append(float(reward))
    return {
        "observations": np.array(observations),
        "actions": actions,
        "rewards": rewards,
        "terminated": terminated,
        "truncated": truncated,
    }
