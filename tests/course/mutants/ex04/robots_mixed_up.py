# loses: 4.6
# The two saved robots are mixed up.
_compare = compare


def compare(experiment_file, folder, seeds, episodes, test_seed):
    rows = _compare(experiment_file, folder, seeds, episodes, test_seed)
    return [row | {"best": row["bestg"], "bestg": row["best"]} for row in rows]
