# loses: 14.5
# Counts differences in one direction only.
def chance_of(first, second):
    together, n = np.array([*first, *second], dtype=float), len(first)
    observed, hits = np.mean(first) - np.mean(second), []
    for chosen in combinations(range(len(together)), n):
        others = [i for i in range(len(together)) if i not in chosen]
        difference = together[list(chosen)].mean() - together[others].mean()
        hits.append(difference * np.sign(observed) >= abs(observed) - 1e-9)
    return float(np.mean(hits))
