"""Run a submission in a child process, and explain what goes wrong in its code."""
