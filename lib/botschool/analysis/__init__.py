"""Looking at the results of runs: their files, their curves, their averages."""
