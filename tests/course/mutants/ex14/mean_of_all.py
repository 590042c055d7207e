# loses: 14.7
# Subtracts the mean of all trainings instead of that of the variation.
def within_variants(numbers, variants):
    return np.round(np.asarray(numbers) - np.mean(numbers), 9)
