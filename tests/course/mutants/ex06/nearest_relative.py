# loses: 6.5
# A family is as near as its nearest robot.
def families(table, threshold):
    rows = standardise(table)
    labels = np.arange(len(rows))
    for i in range(len(rows)):
        for j in range(i):
            if np.linalg.norm(rows[i] - rows[j]) < threshold:
                labels[labels == labels[i]] = labels[j]
    names = list(dict.fromkeys(labels.tolist()))
    return [names.index(label) for label in labels]
