# loses: 14.6
# Divides the entries into equal parts instead of the training.
def phase_means(steps, values, total, parts=3):
    found = [part[~np.isnan(part)] for part in np.array_split(np.asarray(values), parts)]
    return [float(part.mean()) if len(part) else None for part in found]
