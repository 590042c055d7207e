"""Laboratory 3."""
