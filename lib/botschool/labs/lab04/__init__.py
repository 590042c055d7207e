"""Laboratory 4."""
