"""Laboratory 5."""
