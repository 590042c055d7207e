# loses: 14.8
# Draws straight lines between the values, and so knows at a step what came only later.
def at_equal_steps(groups, points):
    curves = [curve for group in groups.values() for curve in group]
    start = max(curve["steps"][0] for curve in curves)
    end = min(curve["steps"][-1] for curve in curves)
    steps = np.linspace(start, end, points)
    found = {
        name: np.array([np.interp(steps, curve["steps"], curve["best"]) for curve in group])
        for name, group in groups.items()
    }
    return {"steps": steps, **found}
