"""Laboratory 8."""
