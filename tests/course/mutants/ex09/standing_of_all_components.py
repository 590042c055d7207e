# loses: 9.5
# The share of standing is taken of the whole reward, costs included.
_gait = gait


def gait(trajectory):
    parts = planar_v0(trajectory)
    total = sum(float(each.sum()) for each in parts.values())
    return {**_gait(trajectory), "standing": float(parts["alive"].sum()) / total}
