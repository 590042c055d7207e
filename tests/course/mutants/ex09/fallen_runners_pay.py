# loses: 9.5
# Planar runners that have fallen get -1, as PyBullet's do.
_planar_v0 = planar_v0


def planar_v0(trajectory):
    parts = _planar_v0(trajectory)
    return {**parts, "alive": np.where(parts["alive"] > 0, 1.0, -1.0)}
