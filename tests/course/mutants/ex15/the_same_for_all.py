# loses: 15.7
# Draws the same individuals for all generations.
def interval(table, measure, rng, resamples=300):
    measures = []
    for _ in range(resamples):
        own, met = (
            rng.integers(table.shape[1], size=table.shape[1]),
            rng.integers(table.shape[3], size=table.shape[3]),
        )
        measures.append(measure(table[:, own][..., met]))
    return tuple(np.quantile(measures, [0.025, 0.975]))
