# loses: 9.6
# Records all robots in version 0.
def compare(robot, genotypes, seed, episodes):
    runner, means = Runner(f"{robot}BulletEnv-v0"), {}
    for key, genotype in genotypes.items():
        gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
        means[key] = {name: float(np.mean([each[name] for each in gaits])) for name in gaits[0]}
    return means
