# loses: 15.5
# Counts only those who do better, and nothing for a draw.
_progress = progress


def progress(matrix):
    cases = np.concatenate([row[:g] for g, row in enumerate(np.diff(matrix, axis=0), 1)])
    return {**_progress(matrix), "share": float(np.mean(cases > 0))}
