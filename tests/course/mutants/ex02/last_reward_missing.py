# loses: 2.5
# The return leaves out the reward of the last step.
def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    actions, total = [], 0.0
    for _ in range(maxsteps):
        actions.append(act(forward(network, observation), env.action_space))
        observation, reward, terminated, truncated, _ = env.step(actions[-1])
        if terminated or truncated:
            break
        total += float(reward)
    return {"actions": actions, "return": total}
