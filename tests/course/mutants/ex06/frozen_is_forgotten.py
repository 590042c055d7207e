# loses: 6.6
# Empties the memory instead of freezing it.
def freeze(since):
    return lambda step, before, after: after if step < since else np.zeros_like(after)
