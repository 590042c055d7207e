# loses: 15.7
# Draws without replacement: the same individuals in another order.
class _Shuffled:
    def __init__(self, rng):
        self._rng = rng

    def integers(self, high, size):
        return self._rng.permuted(np.tile(np.arange(high), (size[0], 1)), axis=1)


_interval = interval


def interval(table, measure, rng, resamples=300):
    return _interval(table, measure, _Shuffled(rng), resamples)
