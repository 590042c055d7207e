# loses: 2.6
# Sums the returns instead of averaging them.
def fitness(environment_id, network, seeds, maxsteps=200):
    return sum(run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds)
