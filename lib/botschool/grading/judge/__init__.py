"""Judge a submission: points for each task, and the reasons for missing points."""
