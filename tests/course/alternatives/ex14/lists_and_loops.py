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
