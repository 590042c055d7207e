"""Give exercise 10 PyBullet or, where it is not installed, what stands in for it."""

from importlib.util import find_spec

if find_spec("pybullet"):
    from botschool.envs.bullet import import_pybullet

    pybullet = import_pybullet()
    import pybullet_data
else:
    from botschool.course import stand_in as pybullet

    pybullet_data = pybullet

__all__ = ["pybullet", "pybullet_data"]
