# loses: 4.6
# Evaluates in the episodes of the run's own post-evaluation instead of new ones.
def compare(experiment_file, folder, seeds, episodes, test_seed):
    rows = []
    for seed in seeds:
        stat = read_stat(Path(folder) / f"statS{seed}.npy")
        row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
        for kind in ("best", "bestg"):
            robot = SavedRobot(experiment_file, np.load(Path(folder) / f"{kind}S{seed}.npy"))
            row[kind] = float(robot.evaluate(seed + 100_000, episodes).mean())
        rows.append(row)
    return rows
