# loses: 2.6
# Every episode begins with the first seed.
def fitness(environment_id, network, seeds, maxsteps=200):
    runs = [run_episode(environment_id, network, seeds[0], maxsteps) for _ in seeds]
    return float(np.mean([run["return"] for run in runs]))
