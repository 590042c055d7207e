"""Right solutions of exercise 14 in other styles; building.py describes how a case is written."""

# %% lists_and_loops
# Lists, dicts and loops; the statistics module; sorting instead of comparisons.
import math
import statistics


def train_variations(environment, variations, seeds, steps, folder, evaluations=8, episodes=5):
    records = []
    for seed in seeds:
        for name in variations:
            run = train(
                "ppo", environment, f"{folder}/{name}", params=dict(variations[name]), steps=steps,
                seed=seed, evaluations=evaluations, episodes=episodes,
            )  # fmt: skip
            last = run.evaluations().returns[-1]
            records.append(
                {
                    "folder": str(run.path),
                    "return": float(sum(last) / len(last)),
                    "seed": seed,
                    "variant": name,
                }
            )
    return records


def read_indicators(folder):
    log = EventAccumulator(str(folder), size_guidance={"scalars": 0})
    log.Reload()
    found = {}
    for name in log.Tags()["scalars"]:
        steps, values = [], []
        for entry in log.Scalars(name):
            if entry.value == entry.value:
                steps.append(entry.step)
                values.append(entry.value)
        found[name] = {"steps": steps, "values": values}
    return found


def success_of(steps, returns, goal):
    means = [statistics.fmean(row) for row in returns]
    area = 0.0
    for i in range(1, len(means)):
        area += (steps[i] - steps[i - 1]) * (means[i] + means[i - 1]) / 2
    solved = None
    for i in range(len(means)):
        if all(mean >= goal for mean in means[i:]):
            solved = int(steps[i])
            break
    average = area / (steps[-1] - steps[0]) if len(means) > 1 else means[0]
    return {"last": means[-1], "best": max(means), "average": average, "solved": solved}


def table_of(runs, baseline):
    results = {}
    for run in runs:
        key = run["variant"], run["seed"]
        if key not in results:
            results[key] = run["return"]
    rows = []
    for name in {variant for variant, _ in results}:
        values = [value for (variant, _), value in results.items() if variant == name]
        rows.append({"variant": name, "runs": len(values), "mean": statistics.mean(values)})
        rows[-1]["deviation"] = statistics.stdev(values) if len(values) > 1 else None
    (base,) = [row["mean"] for row in rows if row["variant"] == baseline]
    for row in rows:
        row["gain"] = row["mean"] - base
    return sorted(rows, key=lambda row: row["mean"], reverse=True)


def chance_of(first, second):
    together, n, m = list(first) + list(second), len(first), len(second)
    observed = abs(sum(first) / n - sum(second) / m)
    hits = ways = 0
    for chosen in combinations(range(n + m), n):
        own = [together[i] for i in chosen]
        others = [together[i] for i in range(n + m) if i not in chosen]
        ways += 1
        hits += abs(sum(own) / n - sum(others) / m) >= observed - 1e-9
    return hits / ways


def phase_means(steps, values, total, parts=3):
    groups = [[] for _ in range(parts)]
    for step, value in zip(steps, values, strict=False):
        if not math.isnan(value):
            part = max(0, math.ceil(int(step) * parts / total) - 1)
            if part < parts:
                groups[part].append(float(value))
    return [sum(group) / len(group) if group else None for group in groups]


def warning_signs(indicators, total, signs):
    found = []
    for name in signs:
        indicator, side, limit = signs[name]
        try:
            log = indicators[indicator]
        except KeyError:
            continue
        late = phase_means(log["steps"], log["values"], total)[2]
        if late is None:
            continue
        if (side == "above" and late > limit) or (side == "below" and late < limit):
            found += [name]
    return found


def rank_correlation(first, second):
    def ranks(numbers):
        ordered = sorted(numbers)
        places = {}
        for place, number in enumerate(ordered, 1):
            places.setdefault(number, []).append(place)
        return [statistics.mean(places[number]) for number in numbers]

    first, second = list(first), list(second)
    if len(set(first)) == 1 or len(set(second)) == 1:
        return 0
    return statistics.correlation(ranks(first), ranks(second))


def within_variants(numbers, variants):
    groups = {}
    for number, variant in zip(numbers, variants, strict=False):
        groups.setdefault(variant, []).append(number)
    return [
        round(number - sum(groups[variant]) / len(groups[variant]), 9)
        for number, variant in zip(numbers, variants, strict=False)
    ]


def curve_of(place):
    if place.endswith(".npy"):
        rows = np.load(place).reshape(-1, 6)
        return {"steps": [row[0] for row in rows], "best": [row[2] for row in rows]}
    found = RunFolder(place).evaluations()
    steps, best, spent, top = [], [], 0, -math.inf
    for when, returns, lengths in zip(found.steps, found.returns, found.lengths, strict=False):
        spent += sum(lengths)
        top = max(top, sum(returns) / len(returns))
        steps.append(when + spent)
        best.append(top)
    return {"steps": steps, "best": best}


def at_equal_steps(groups, points):
    first = [curve["steps"][0] for group in groups.values() for curve in group]
    last = [curve["steps"][-1] for group in groups.values() for curve in group]
    marks = np.linspace(max(first), min(last), points)
    found = {"steps": marks.tolist()}
    for name, group in groups.items():
        found[name] = []
        for curve in group:
            row = []
            for mark in marks:
                reached = [
                    b for s, b in zip(curve["steps"], curve["best"], strict=False) if s <= mark
                ]
                row.append(reached[-1])
            found[name].append(row)
    return found


# %% other_functions
# Other functions of NumPy: trapezoids, searchsorted, unique, groups by sorting.
import functools
import operator
from itertools import product


def train_variations(environment, variations, seeds, steps, folder, evaluations=8, episodes=5):
    options = {"steps": steps, "evaluations": evaluations, "episodes": episodes}

    def one(name, seed):
        place = Path(folder).joinpath(name)
        run = train("ppo", environment, place, params=variations[name], seed=seed, **options)
        result = run.evaluations().returns.mean(axis=1)[-1]
        return {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}

    return [one(name, seed) for name, seed in product(variations, seeds)]


def read_indicators(folder):
    log = EventAccumulator(folder, {"scalars": 0})
    log.Reload()
    found = {}
    for name in log.scalars.Keys():
        table = np.array([(entry.step, entry.value) for entry in log.Scalars(name)])
        table = table[~np.isnan(table[:, 1])]
        found[name] = {"steps": table[:, 0], "values": table[:, 1]}
    return found


def success_of(steps, returns, goal):
    means = np.mean(returns, axis=-1)
    below = np.flatnonzero(means < goal)
    first = below[-1] + 1 if below.size else 0
    weights = np.zeros(len(means))
    weights[1:] += np.diff(steps) / 2
    weights[:-1] += np.diff(steps) / 2
    return {
        "last": means[-1],
        "best": np.max(means),
        "average": weights @ means / weights.sum() if weights.any() else means[0],
        "solved": steps[first] if first < len(steps) else None,
    }


def table_of(runs, baseline):
    kept = {}
    for run in reversed(runs):
        kept[run["variant"], run["seed"]] = run["return"]
    names = np.array([variant for variant, _ in kept])
    returns = np.array(list(kept.values()))
    means = {name: returns[names == name].mean() for name in np.unique(names)}
    rows = []
    for name, mean in means.items():
        own = returns[names == name]
        spread = np.sqrt(((own - mean) ** 2).sum() / (len(own) - 1)) if len(own) > 1 else None
        rows.append({"variant": str(name), "runs": own.size, "mean": mean,
                     "deviation": spread, "gain": mean - means[baseline]})  # fmt: skip
    return [rows[i] for i in np.argsort([-row["mean"] for row in rows])]


def chance_of(first, second):
    together, n = np.concatenate([first, second]), len(first)
    rest = len(together) - n
    chosen = np.array(list(combinations(range(len(together)), n)))
    sums = together[chosen].sum(axis=1)
    differences = np.abs(sums / n - (together.sum() - sums) / rest)
    observed = np.abs(np.mean(first) - np.mean(second))
    return np.count_nonzero(differences > observed - 1e-9) / len(chosen)


def phase_means(steps, values, total, parts=3):
    borders = np.arange(1, parts) * total / parts
    part = np.searchsorted(borders, steps, side="left")
    known = ~np.isnan(values) & (np.asarray(steps) <= total)
    return [
        values[known & (part == k)].mean() if (known & (part == k)).any() else None
        for k in range(parts)
    ]


def warning_signs(indicators, total, signs):
    found = []
    for name, (indicator, side, limit) in signs.items():
        log = indicators.get(indicator, {"steps": np.zeros(0), "values": np.zeros(0)})
        *_, late = phase_means(np.asarray(log["steps"]), np.asarray(log["values"]), total, 3)
        sign = {"above": 1, "below": -1}[side]
        if late is not None and sign * (late - limit) > 0:
            found.append(name)
    return found


def rank_correlation(first, second):
    ranks = []
    for numbers in (first, second):
        _, where, counts = np.unique(numbers, return_inverse=True, return_counts=True)
        if len(counts) == 1:
            return 0.0
        ranks.append((np.cumsum(counts) - (counts - 1) / 2)[where])
    return np.corrcoef(*ranks)[0, 1]


def within_variants(numbers, variants):
    _, where, counts = np.unique(variants, return_inverse=True, return_counts=True)
    means = np.bincount(where, weights=numbers) / counts
    return np.around(numbers - means[where], 9)


def curve_of(place):
    if Path(place).suffix == ".npy":
        steps, _, best, *_ = read_stat(place).T
        return {"steps": steps, "best": best}
    found = RunFolder(place).evaluations()
    means = found.returns.sum(axis=1) / found.returns.shape[1]
    return {
        "steps": found.steps + np.cumsum(np.sum(found.lengths, axis=1)),
        "best": [means[: i + 1].max() for i in range(len(means))],
    }


def at_equal_steps(groups, points):
    curves = functools.reduce(operator.iadd, groups.values(), [])
    low = np.max([curve["steps"][0] for curve in curves])
    high = np.min([curve["steps"][-1] for curve in curves])
    steps = np.linspace(low, high, num=points)
    found = {"steps": steps}
    for name in groups:
        found[name] = np.array(
            [
                [curve["best"][np.flatnonzero(curve["steps"] <= step).max()] for step in steps]
                for curve in groups[name]
            ]
        )
    return found


# %% single_precision
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


# %% pairs_and_sums
# Sums over pairs of neighbours, loops from the end, dicts of lists.
def success_of(steps, returns, goal):
    means = [float(sum(row)) / len(row) for row in returns]
    area = 0.0
    for i in range(len(steps) - 1):
        area += (steps[i + 1] - steps[i]) * 0.5 * (means[i] + means[i + 1])
    late = len(means)
    while late > 0 and means[late - 1] >= goal:
        late -= 1
    return {
        "solved": steps[late] if late < len(means) else None,
        "average": area / (steps[-1] - steps[0]) if len(means) > 1 else means[0],
        "best": max(means),
        "last": means[-1],
    }


def chance_of(first, second):
    first, second = list(first), list(second)
    everything, count, ways = first + second, 0, 0
    real = abs(sum(first) / len(first) - sum(second) / len(second))
    for chosen in combinations(range(len(everything)), len(first)):
        one = [everything[i] for i in chosen]
        other = [x for i, x in enumerate(everything) if i not in chosen]
        ways += 1
        count += abs(sum(one) / len(one) - sum(other) / len(other)) > real - 1e-9
    return count / ways


# %% parts_by_edges
# Parts by their edges, nanmean, ranks by sorting twice with shared places.
def phase_means(steps, values, total, parts=3):
    found = [[] for _ in range(parts)]
    for step, value in zip(steps, values, strict=True):
        part = 0
        while step * parts > (part + 1) * total:
            part += 1
        if part < parts and value == value:
            found[part].append(float(value))
    return [sum(each) / len(each) if each else None for each in found]


def rank_correlation(first, second):
    def ranks(numbers):
        ordered = sorted(numbers)
        return np.array([ordered.index(x) + (ordered.count(x) - 1) / 2 for x in numbers])

    a, b = ranks(list(first)), ranks(list(second))
    if a.std() == 0 or b.std() == 0:
        return 0
    return np.corrcoef(a, b)[0, 1]


def within_variants(numbers, variants):
    groups = {}
    for number, variant in zip(numbers, variants, strict=True):
        groups.setdefault(variant, []).append(number)
    means = {variant: sum(group) / len(group) for variant, group in groups.items()}
    pairs = zip(numbers, variants, strict=True)
    return np.array([round(float(number - means[variant]), 9) for number, variant in pairs])


# %% tables_by_hand
# A class for the rows, variance by hand, curves by loops.
def table_of(runs, baseline):
    seen, groups = set(), {}
    for run in runs:
        key = run["variant"], run["seed"]
        if key not in seen:
            seen.add(key)
            groups.setdefault(run["variant"], []).append(float(run["return"]))
    rows = []
    for variant, group in groups.items():
        n, mean = len(group), sum(group) / len(group)
        spread = (sum((x - mean) ** 2 for x in group) / (n - 1)) ** 0.5 if n > 1 else None
        rows.append({"variant": variant, "runs": n, "mean": mean, "deviation": spread})
    base = [row["mean"] for row in rows if row["variant"] == baseline][0]
    return sorted(
        ({**row, "gain": row["mean"] - base} for row in rows), key=lambda row: -row["mean"]
    )


def at_equal_steps(groups, points):
    curves = [curve for name in groups for curve in groups[name]]
    start, end = max(c["steps"][0] for c in curves), min(c["steps"][-1] for c in curves)
    steps = np.linspace(start, end, num=points)

    def reached(curve, step):
        return [b for s, b in zip(curve["steps"], curve["best"], strict=True) if s <= step][-1]

    return {
        "steps": steps,
        **{
            name: [[reached(curve, step) for step in steps] for curve in group]
            for name, group in groups.items()
        },
    }


# %% other_formulas
# Loops, scipy, fractions.
def success_of(steps, returns, goal):
    m = [float(np.mean(r)) for r in returns]
    s = [int(x) for x in steps]
    if len(m) > 1:
        average = sum((s[i + 1] - s[i]) * (m[i] + m[i + 1]) / 2 for i in range(len(m) - 1)) / (
            s[-1] - s[0]
        )
    else:
        average = m[0]
    solved = next((s[i] for i in range(len(m)) if all(x >= goal for x in m[i:])), None)
    return {"last": m[-1], "best": max(m), "average": average, "solved": solved}


def table_of(runs, baseline):
    first = {}
    for run in reversed(runs):
        first[run["variant"], run["seed"]] = run["return"]
    groups = {}
    for (variant, _), value in first.items():
        groups.setdefault(variant, []).append(value)
    base = sum(groups[baseline]) / len(groups[baseline])
    rows = [
        {
            "variant": v,
            "runs": len(x),
            "mean": sum(x) / len(x),
            "deviation": None
            if len(x) == 1
            else (sum((y - sum(x) / len(x)) ** 2 for y in x) / (len(x) - 1)) ** 0.5,
            "gain": sum(x) / len(x) - base,
        }
        for v, x in groups.items()
    ]
    return sorted(rows, key=lambda row: -row["mean"])


def chance_of(first, second):
    both = [*first, *second]
    n, m = len(first), len(second)
    real = abs(sum(first) / n - sum(second) / m)
    hits = count = 0
    for chosen in combinations(range(n + m), n):
        a = sum(both[i] for i in chosen) / n
        b = sum(both[i] for i in range(n + m) if i not in chosen) / m
        count += 1
        hits += abs(a - b) > real - 1e-9
    return hits / count


def phase_means(steps, values, total, parts=3):
    sums = [[] for _ in range(parts)]
    for s, v in zip(steps, values):
        if v != v:
            continue
        k = 0 if s == 0 else (int(s) * parts - 1) // total
        if 0 <= k < parts:
            sums[k].append(float(v))
    return [sum(x) / len(x) if x else None for x in sums]


def rank_correlation(first, second):
    from scipy.stats import rankdata

    a, b = rankdata(first), rankdata(second)
    a, b = a - a.mean(), b - b.mean()
    d = np.sqrt((a @ a) * (b @ b))
    return float(a @ b / d) if d else 0


def within_variants(numbers, variants):
    groups = {}
    for x, v in zip(numbers, variants):
        groups.setdefault(v, []).append(x)
    return np.array(
        [round(x - sum(groups[v]) / len(groups[v]), 9) for x, v in zip(numbers, variants)]
    )


def at_equal_steps(groups, points):
    every = [c for g in groups.values() for c in g]
    first, last = max(c["steps"][0] for c in every), min(c["steps"][-1] for c in every)
    out = {"steps": np.linspace(first, last, points)}
    for name, g in groups.items():
        out[name] = np.array(
            [
                [
                    c["best"][max(i for i in range(len(c["steps"])) if c["steps"][i] <= s)]
                    for s in out["steps"]
                ]
                for c in g
            ]
        )
    return out
