from botschool.course.rl import *  # noqa: F403  (files written before it moved)
