# loses: 14.3
# Asks for more than the goal.
_success_of = success_of


def success_of(steps, returns, goal):
    return _success_of(steps, returns, goal + 1e-9)
