"""Declare an exercise: its tasks, and the sentences of its checks about answers."""
