# loses: 6.5
# Asks whether the deviation is exactly 0, which rounding prevents.
def standardise(table):
    deviation = table.std(axis=0)
    return (table - table.mean(axis=0)) / np.where(deviation == 0, 1.0, deviation)
