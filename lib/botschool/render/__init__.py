"""Showing robots: frames of episodes, to a window or a video file."""
