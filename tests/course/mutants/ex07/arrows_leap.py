# loses: 7.3
# Arrows through the lowest point leap across the whole picture.
def arrows(before, after):
    return np.hstack([before, after - before])
