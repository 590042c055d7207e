from botschool.course.locomotion import *  # noqa: F403  (files written before it moved)
