# loses: 1.6
# np.std without ddof=1 divides by n.
_compare = compare


def compare(environment_ids, episodes, seed):
    shrink = ((episodes - 1) / episodes) ** 0.5
    return [
        {**row, "deviation": row["deviation"] * shrink}
        for row in _compare(environment_ids, episodes, seed)
    ]
