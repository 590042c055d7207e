# loses: 4.3
# Always runs the whole budget of the experiment file.
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None):
    return _replicate(experiment_file, seeds, folder)
