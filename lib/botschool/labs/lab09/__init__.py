"""Laboratory 9."""
