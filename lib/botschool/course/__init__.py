"""Give exercises ready-made parts: robots to evaluate, pictures, films.

Parts for a single exercise have a module of their own, such as botschool.course.foraging.
"""

from botschool.course.evaluation import Robot, SavedRobot, controller_of
from botschool.course.files import experiment_file, genotype_file, robot_file
from botschool.course.films import film, film_agent
from botschool.course.pictures import (
    draw_bands,
    draw_curves,
    draw_distributions,
    draw_features,
    draw_verdicts,
)

__all__ = [
    "Robot",
    "SavedRobot",
    "controller_of",
    "draw_bands",
    "draw_curves",
    "draw_distributions",
    "draw_features",
    "draw_verdicts",
    "experiment_file",
    "film",
    "film_agent",
    "genotype_file",
    "robot_file",
]
