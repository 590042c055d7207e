# loses: 4.5
# Draws straight lines between generations, and so looks into the future.
def curves(stats, column, budgets):
    values = [np.interp(budgets, stat["steps"], stat[column]) for stat in stats]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}
