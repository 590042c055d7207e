"""Judge a submission: points for each task, and what is missing."""
