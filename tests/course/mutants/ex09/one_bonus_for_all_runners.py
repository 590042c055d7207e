# loses: 9.5
# A Walker2D has fallen when a Hopper would have.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    if trajectory["robot"] == "PlanarWalker2D":
        parts = {**parts, "alive": _planar_v0({**trajectory, "robot": "PlanarHopper"})["alive"]}
    return parts
