"""Laboratory 14."""
