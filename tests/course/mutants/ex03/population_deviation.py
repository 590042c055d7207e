# loses: 3.6
# Divides by the number of replications instead of that number minus one.
def replicate(experiment, seeds):
    runs = [experiment(seed) for seed in seeds]
    histories = np.array([run["history"] for run in runs])
    return {
        "mean": histories.mean(axis=0),
        "deviation": histories.std(axis=0),
        "best": [run["fitness"] for run in runs],
    }
