"""Show robots: frames of episodes, in a window or in a video file."""
