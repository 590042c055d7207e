# loses: 7.2
# Goes on after the end of the episode.
def record(controller, seed, steps):
    env = gymnasium.make("Pendulum-v1")
    observations = [env.reset(seed=seed)[0]]
    for _ in range(steps):
        observations.append(env.step(controller(observations[-1]))[0])
    return to_state(np.array(observations))
