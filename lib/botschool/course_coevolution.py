from botschool.course.coevolution import *  # noqa: F403  (files written before it moved)
