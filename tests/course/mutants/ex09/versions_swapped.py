# loses: 9.6
# Calls the robot of each version by the name of the other.
_evolve_both = evolve_both


def evolve_both(robot, steps, seed):
    pair = _evolve_both(robot, steps, seed)
    return {"v0": pair["v5"], "v5": pair["v0"]}
