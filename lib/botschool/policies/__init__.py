"""Policies: their hyperparameters, their networks, and how they fit a problem."""
