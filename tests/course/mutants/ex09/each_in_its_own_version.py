# loses: 9.6
# Records each robot in the version whose name it has.
def compare(robot, genotypes, seed, episodes):
    means = {}
    for key, genotype in genotypes.items():
        runner = Runner(f"{robot}BulletEnv-{key}")
        gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
        means[key] = {name: float(np.mean([each[name] for each in gaits])) for name in gaits[0]}
    return means
