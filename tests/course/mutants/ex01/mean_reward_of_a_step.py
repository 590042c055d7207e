# loses: 1.6
# The mean reward of a step instead of the mean return of an episode.
_compare = compare


def compare(environment_ids, episodes, seed):
    return [
        {**row, "mean": row["mean"] / row["length"]}
        for row in _compare(environment_ids, episodes, seed)
    ]
