# loses: 12.4
# Learns from all episodes, good or bad.
_elite = elite


def elite(episodes, percentile):
    bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
    return {**_elite(episodes, 0), "bound": bound}
