from botschool.course.foraging import *  # noqa: F403  (files written before it moved)
