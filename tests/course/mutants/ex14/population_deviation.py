# loses: 14.4
# Divides by the number of runs, as np.std does unless told otherwise.
_table_of = table_of


def table_of(runs, baseline):
    rows = _table_of(runs, baseline)
    for row in rows:
        if row["deviation"] is not None:
            row["deviation"] *= np.sqrt((row["runs"] - 1) / row["runs"])
    return rows
