# loses: 15.7
# Assumes a bell-shaped distribution: mean and 1.96 standard deviations.
_interval = interval


def interval(table, measure, rng, resamples=300):
    kept = []

    def keeping(resample):
        kept.append(measure(resample))
        return kept[-1]

    _interval(table, keeping, rng, resamples)
    return np.mean(kept) - 1.96 * np.std(kept), np.mean(kept) + 1.96 * np.std(kept)
