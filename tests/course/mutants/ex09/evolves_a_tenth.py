# loses: 9.6
# Stops long before the budget is used up.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    return _evolve_both(robot, steps // 10, seeds)
