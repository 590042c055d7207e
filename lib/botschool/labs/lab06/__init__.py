"""Laboratory 6."""
