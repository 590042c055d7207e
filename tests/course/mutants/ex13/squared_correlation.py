# loses: 13.6
# Takes the squared correlation for the explained variance.
def explained_variance(values, returns):
    return float(np.corrcoef(values.ravel(), returns.ravel())[0, 1] ** 2)
