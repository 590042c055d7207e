# loses: 14.7
# Gives equal numbers different ranks, by their order.
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    ranks = [np.argsort(np.argsort(numbers, kind="stable")) for numbers in (first, second)]
    return float(np.corrcoef(*ranks)[0, 1])
