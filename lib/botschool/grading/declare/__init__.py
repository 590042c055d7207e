"""Declare an exercise: its tasks, and what its checks say about answers."""
