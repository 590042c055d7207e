"""Declare arenas of wheeled robots and step them by hand: the public name of botschool.arenas."""

from botschool.arenas.arena import Arena, make
from botschool.arenas.plan import Plan
from botschool.arenas.things import Cylinder, Light, Robot, Wall, Zone

__all__ = ["Arena", "Cylinder", "Light", "Plan", "Robot", "Wall", "Zone", "make"]
