"""Laboratory 15."""
