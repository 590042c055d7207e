# loses: 1.2
# Seeds the reset, but not the action space: no episode can be repeated.
def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    observations, actions, rewards = [observation], [], []
    terminated = truncated = False
    while len(actions) < maxsteps and not (terminated or truncated):
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
