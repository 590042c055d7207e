# loses: 6.5
# Divides by n - 1 in the standard deviation.
def standardise(table):
    deviation = table.std(axis=0, ddof=1)
    alike = deviation < 1e-12
    return np.where(alike, 0.0, (table - table.mean(axis=0)) / np.where(alike, 1.0, deviation))
