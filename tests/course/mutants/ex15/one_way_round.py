# loses: 15.5
# Knows cycles in one direction only.
def cycles(matrix):
    wins, count = matrix > matrix.T, len(matrix)
    triples = [
        wins[a, b] and wins[b, c] and wins[c, a]
        for c in range(count)
        for b in range(c)
        for a in range(b)
    ]
    return float(np.mean(triples)) if triples else 0.0
