# loses: 12.4
# Learns from the worst episodes.
def elite(episodes, percentile):
    bound = float(np.percentile([episode["return"] for episode in episodes], percentile))
    kept = [episode for episode in episodes if episode["return"] <= bound]
    return {
        "observations": np.concatenate([episode["observations"] for episode in kept]),
        "actions": np.concatenate([episode["actions"] for episode in kept]),
        "bound": bound,
    }
