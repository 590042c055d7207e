# loses: 2.5
# Does all of the steps, even when the pole has fallen or the goal is reached.
def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    actions, total = [], 0.0
    for _ in range(maxsteps):
        action = act(forward(network, observation), env.action_space)
        observation, reward, _, _, _ = env.step(action)
        actions.append(action)
        total += float(reward)
    return {"actions": actions, "return": total}
