# loses: 5.8
# Counts the own body and brain among the others.
def loss(matrix):
    own = np.diagonal(matrix)
    return {
        "own": float(own.mean()),
        "foreign": float(matrix.mean()),
        "brains": own - matrix.mean(axis=1),
        "bodies": own - matrix.mean(axis=0),
        "at home": int(np.sum(own == matrix.max(axis=1))),
    }
