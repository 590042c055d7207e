# loses: 15.1
# Gives the predator what the prey senses, and the other way round.
def chase(predator, prey, maxsteps=2000):
    arena = arenas.make("predprey", max_steps=maxsteps)
    networks = robot(predator), robot(prey)
    poses, fitness = [arena.robots.copy()], 0.0
    while not arena.done:
        for k, network in enumerate(networks):
            network.observation = arena.observation[24 * (1 - k) :][:24]
        arena.action = np.concatenate([network.step() for network in networks])
        fitness += arena.step()
        poses.append(arena.robots.copy())
    return {"poses": np.array(poses), "caught": arena.terminated, "fitness": fitness}
