# loses: 14.5
# Counts only differences that are greater than the real one, so that 0 can come out.
def chance_of(first, second):
    together, n = np.array([*first, *second], dtype=float), len(first)
    observed, hits = abs(np.mean(first) - np.mean(second)), []
    for chosen in combinations(range(len(together)), n):
        others = [i for i in range(len(together)) if i not in chosen]
        difference = abs(together[list(chosen)].mean() - together[others].mean())
        hits.append(difference > observed + 1e-9)
    return float(np.mean(hits))
