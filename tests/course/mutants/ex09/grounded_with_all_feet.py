# loses: 9.5
# A walker counts as grounded only while both feet are down.
_gait = gait


def gait(trajectory):
    return {**_gait(trajectory), "grounded": float(trajectory["feet"].min(axis=1).mean())}
