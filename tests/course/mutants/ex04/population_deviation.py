# loses: 4.5
# Divides by the number of runs instead of that number minus one.
_curves = curves


def curves(stats, column, budgets):
    shrunk = np.sqrt((len(stats) - 1) / len(stats))
    band = _curves(stats, column, budgets)
    return {"mean": band["mean"], "deviation": band["deviation"] * shrunk}
