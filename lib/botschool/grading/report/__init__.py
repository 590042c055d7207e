"""Report to a learner: the screen, pages, hints, progress."""
