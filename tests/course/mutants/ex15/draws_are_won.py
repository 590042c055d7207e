# loses: 15.5
# Takes a draw for a match that was won.
def cycles(matrix):
    wins, count = matrix >= matrix.T, len(matrix)
    triples = [
        (wins[a, b] and wins[b, c] and wins[c, a]) or (wins[b, a] and wins[c, b] and wins[a, c])
        for c in range(count)
        for b in range(c)
        for a in range(b)
    ]
    return float(np.mean(triples)) if triples else 0.0
