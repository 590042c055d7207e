"""Make the copies of the course: skeletons, the release for students, notebooks for nbgrader."""
