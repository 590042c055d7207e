# Single precision where six digits are asked for, recursion, masked arrays, fractions.
from fractions import Fraction


def success_of(steps, returns, goal):
    def solved_from(i):
        if i == 0 or means[i - 1] < goal:
            return i
        return solved_from(i - 1)

    means = np.float64(returns).mean(axis=1)
    first = solved_from(len(means))
    average = means[0]
    if len(steps) > 1:
        average = np.trapezoid(means, steps) if hasattr(np, "trapezoid") else np.trapz(means, steps)
        average = average / np.ptp(steps)
    solved = None if first == len(means) else int(steps[first])
    return {"last": means[-1], "best": sorted(means)[-1], "average": average, "solved": solved}


def table_of(runs, baseline):
    seen, results = set(), {}
    for run in runs:
        if (run["variant"], run["seed"]) in seen:
            continue
        seen.add((run["variant"], run["seed"]))
        results.setdefault(run["variant"], []).append(np.float64(run["return"]))

    def row(name):
        values = results[name]
        gain = np.mean(values) - np.mean(results[baseline])
        return {
            "variant": name,
            "runs": np.int64(len(values)),
            "mean": np.mean(values),
            "deviation": None if len(values) < 2 else np.std(values, ddof=1),
            "gain": gain,
        }

    return sorted(map(row, results), key=lambda found: -found["gain"])


def chance_of(first, second):
    numbers = [Fraction(str(float(each))) for each in [*first, *second]]
    n, m = len(first), len(second)

    def difference(own):
        return abs(Fraction(own, n) - Fraction(sum(numbers) - own, m))

    real = difference(sum(numbers[:n]))
    ways = [difference(sum(own)) >= real for own in combinations(numbers, n)]
    return float(Fraction(sum(ways), len(ways)))


def phase_means(steps, values, total, parts=3):
    steps, values = np.asarray(steps), np.ma.masked_invalid(np.asarray(values, dtype=float))
    means = []
    for k in range(parts):
        low = -1 if k == 0 else k * total / parts
        own = values[(steps > low) & (steps <= (k + 1) * total / parts)].compressed()
        means.append(np.float32(own.mean()) if own.size else None)
    return means


def warning_signs(indicators, total, signs):
    def late(name):
        steps, values = (np.asarray(indicators[name][key]) for key in ("steps", "values"))
        own = values[(3 * steps > 2 * total) & (steps <= total) & ~np.isnan(values)]
        return own.mean() if own.size else np.nan

    def shown(name, side, limit):
        if name not in indicators:
            return False
        return late(name) > limit if side == "above" else late(name) < limit

    return [sign for sign, what in signs.items() if shown(*what)]


def rank_correlation(first, second):
    def centred(numbers):
        numbers = np.asarray(numbers)
        below = np.less.outer(numbers, numbers).sum(axis=0)
        above = np.greater.outer(numbers, numbers).sum(axis=0)
        return (below - above) / 2

    a, b = centred(first), centred(second)
    if not a.any() or not b.any():
        return 0.0
    return a @ b / np.linalg.norm(a) / np.linalg.norm(b)


def within_variants(numbers, variants):
    result = np.array(numbers, dtype=float)
    names = np.array(variants)
    for name in set(variants):
        result[names == name] -= np.mean(result[names == name])
    return result.round(9)


def at_equal_steps(groups, points):
    first = [curve["steps"][0] for group in groups.values() for curve in group]
    last = [curve["steps"][-1] for group in groups.values() for curve in group]
    steps = np.linspace(max(first), min(last), points)

    def value(curve, mark):
        number = 0
        while number + 1 < len(curve["steps"]) and curve["steps"][number + 1] <= mark:
            number += 1
        return curve["best"][number]

    table = {
        name: [[value(curve, mark) for mark in steps] for curve in group]
        for name, group in groups.items()
    }
    return {**table, "steps": steps}
