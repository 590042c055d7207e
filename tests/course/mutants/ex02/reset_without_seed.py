# loses: 2.5
# The seed is not passed to reset.
def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset()
    actions, total = [], 0.0
    terminated = truncated = False
    while len(actions) < maxsteps and not (terminated or truncated):
        action = act(forward(network, observation), env.action_space)
        observation, reward, terminated, truncated, _ = env.step(action)
        actions.append(action)
        total += float(reward)
    return {"actions": actions, "return": total}
