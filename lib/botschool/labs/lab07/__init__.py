"""Laboratory 7."""
