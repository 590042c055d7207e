# loses: 9.6
# Stops long before the budget is used up.
_evolve_both = evolve_both


def evolve_both(robot, steps, seed):
    return _evolve_both(robot, 1, seed)
