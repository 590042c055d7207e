from botschool.course.robots import *  # noqa: F403  (files written before it moved)
