"""Evolutionary algorithms: one readable file each, and the loop that runs them."""
