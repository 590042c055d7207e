# loses: 14.3
# Averages the post-evaluations without regard to how far they lie apart.
_success_of = success_of


def success_of(steps, returns, goal):
    return {**_success_of(steps, returns, goal), "average": float(np.mean(returns))}
