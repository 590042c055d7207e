# loses: 9.5
# Divides by 0 for a robot that earns nothing.
_gait = gait


def gait(trajectory):
    parts = planar_v0(trajectory)
    alive, moved = (np.maximum(parts[key], 0).sum() for key in ("alive", "progress"))
    return {**_gait(trajectory), "standing": float(alive / (alive + moved))}
