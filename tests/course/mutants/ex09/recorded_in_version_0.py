# loses: 9.6
# Records all robots in version 0.
def compare(robot, genotypes, seed, episodes):
    table = {}
    for version, rows in genotypes.items():
        runner, means = Runner(f"{robot}-v0"), []
        for genotype in rows:
            gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
            means.append([np.mean([each[name] for each in gaits]) for name in gaits[0]])
        table[version] = dict(zip(gaits[0], np.array(means).T, strict=True))
    return table
