# loses: 5.5
# Leaves the files of the runs in a temporary folder.
import tempfile

_evolve_walkers = evolve_walkers


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    with tempfile.TemporaryDirectory(dir=".") as elsewhere:
        return _evolve_walkers(experiment_file, seeds, elsewhere, steps)
