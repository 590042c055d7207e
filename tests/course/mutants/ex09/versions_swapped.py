# loses: 9.6
# Calls the robots of each version by the name of the other.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    pair = _evolve_both(robot, steps, seeds)
    return {"v0": pair["v5"], "v5": pair["v0"]}
