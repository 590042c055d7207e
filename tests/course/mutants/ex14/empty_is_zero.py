# loses: 14.6
# Takes 0 for a part in which nothing was logged.
_phase_means = phase_means


def phase_means(steps, values, total, parts=3):
    return [mean or 0.0 for mean in _phase_means(steps, values, total, parts)]
