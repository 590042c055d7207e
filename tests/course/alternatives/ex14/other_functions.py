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
        table = table[np.isfinite(table[:, 1])]
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
