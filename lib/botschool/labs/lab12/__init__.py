"""Laboratory 12."""
