"""Read the results of runs: their files, curves and averages."""
