# loses: 12.4
# Drops the episodes that are exactly at the bound.
_elite = elite


def elite(episodes, percentile):
    bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
    above = [episode for episode in episodes if episode["return"] > bound]
    return {**_elite(above or episodes, 0), "bound": bound}
