# loses: 9.2
# Counts joints at their upper limits only.
def joints_at_limit(positions):
    return -0.1 * (positions > 0.99).sum(axis=1)
