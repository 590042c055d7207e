# loses: 14.3
# Takes the first time that the goal was reached, also if it was lost again.
_success_of = success_of


def success_of(steps, returns, goal):
    reached = np.flatnonzero(np.mean(returns, axis=1) >= goal)
    solved = int(steps[reached[0]]) if len(reached) else None
    return {**_success_of(steps, returns, goal), "solved": solved}
