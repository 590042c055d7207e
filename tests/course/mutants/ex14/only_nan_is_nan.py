# loses: 14.6
# Gives NaN for a part in which nothing but NaN was logged.
def phase_means(steps, values, total, parts=3):
    means = []
    for part in range(parts):
        inside = (steps > part * total / parts) & (steps <= (part + 1) * total / parts)
        inside |= (steps == 0) & (part == 0)
        known = values[inside][~np.isnan(values[inside])]
        nothing = None if not inside.any() else float("nan")
        means.append(float(known.mean()) if len(known) else nothing)
    return means
