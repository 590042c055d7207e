# loses: 4.5
# Leaves out a generation that is complete exactly at the budget.
def curves(stats, column, budgets):
    values = [
        stat[column][np.searchsorted(stat["steps"], budgets, side="left") - 1] for stat in stats
    ]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}
