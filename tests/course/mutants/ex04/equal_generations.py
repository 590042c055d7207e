# loses: 4.5
# Compares the runs at equal generations instead of equal steps.
def curves(stats, column, budgets):
    chosen = np.linspace(0, min(len(stat["steps"]) for stat in stats) - 1, len(budgets))
    values = [stat[column][chosen.astype(int)] for stat in stats]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}
