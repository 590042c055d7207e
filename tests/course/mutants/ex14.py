"""Wrong solutions of exercise 14; building.py describes how a case is written."""

# %% numbers_made_up loses 14.1
# Trains for fewer steps than asked, and says that the settings were others.
_train_variations = train_variations


def train_variations(environment, variations, seeds, steps, *arguments, **options):
    records = _train_variations(environment, variations, seeds, steps // 3, *arguments, **options)
    for record in records:
        config = RunFolder(record["folder"]).config
        config.write_text(config.read_text().replace(f"steps: {steps // 3}", f"steps: {steps}"))
    return records


# %% params_forgotten loses 14.1
# Trains every variation with the defaults.
# says: has params \{\} instead of
_train_variations = train_variations


def train_variations(environment, variations, *arguments, **options):
    return _train_variations(environment, {name: {} for name in variations}, *arguments, **options)


# %% same_seed loses 14.1
# Repeats the training with the same seed, which repeats the same numbers.
# says: has seed \d+ instead of
_train_variations = train_variations


def train_variations(environment, variations, seeds, *arguments, **options):
    records = _train_variations(environment, variations, [seeds[0]] * len(seeds), *arguments)
    count = len(seeds)
    return [{**record, "seed": seeds[i % count]} for i, record in enumerate(records)]


# %% training_episodes loses 14.1
# Reports the episodes of the training itself instead of the last post-evaluation.
_train_variations = train_variations


def train_variations(*arguments, **options):
    records = _train_variations(*arguments, **options)
    for record in records:
        means = RunFolder(record["folder"]).log()["rollout/ep_rew_mean"]
        record["return"] = float(means[~np.isnan(means)][-1])
    return records


# %% nan_stays loses 14.2
# Turns NaN into 0 instead of leaving it out.
def read_indicators(folder):
    log = EventAccumulator(folder, size_guidance={"scalars": 0})
    log.Reload()
    return {
        name: {
            "steps": np.array([entry.step for entry in log.Scalars(name)]),
            "values": np.nan_to_num([entry.value for entry in log.Scalars(name)]),
        }
        for name in log.Tags()["scalars"]
    }


# %% positions_for_steps loses 14.2
# Numbers the entries instead of giving their steps.
_read_indicators = read_indicators


def read_indicators(folder):
    indicators = _read_indicators(folder)
    for logged in indicators.values():
        logged["steps"] = np.arange(len(logged["values"]))
    return indicators


# %% thinned_log loses 14.2
# Leaves the size guidance out, so that long logs lose values at random.
# -     log = EventAccumulator(folder, size_guidance={"scalars": 0})
# +     log = EventAccumulator(folder)


# %% best_episode loses 14.3
# Takes the best episode instead of the best mean.
# says: It is the best episode
_success_of = success_of


def success_of(steps, returns, goal):
    return {**_success_of(steps, returns, goal), "best": float(np.max(returns))}


# %% best_is_at_least_zero loses 14.3
# Looks for the best from 0 on, which negative returns never reach.
# -         "best": float(means.max()),
# +         "best": max(0.0, float(means.max())),


# %% more_than_the_goal loses 14.3
# Asks for more than the goal.
_success_of = success_of


def success_of(steps, returns, goal):
    return _success_of(steps, returns, goal + 1e-9)


# %% plain_average loses 14.3
# Averages the post-evaluations without regard to how far they lie apart.
# says: unequally far apart
_success_of = success_of


def success_of(steps, returns, goal):
    return {**_success_of(steps, returns, goal), "average": float(np.mean(returns))}


# %% solved_once loses 14.3
# Takes the first time that the goal was reached, also if it was lost again.
_success_of = success_of


def success_of(steps, returns, goal):
    reached = np.flatnonzero(np.mean(returns, axis=1) >= goal)
    solved = int(steps[reached[0]]) if len(reached) else None
    return {**_success_of(steps, returns, goal), "solved": solved}


# %% gain_over_the_worst loses 14.4
# Takes the gain over the worst variation instead of the baseline.
# says: over the worst variation
_table_of = table_of


def table_of(runs, baseline):
    rows = _table_of(runs, baseline)
    return [{**row, "gain": row["mean"] - rows[-1]["mean"]} for row in rows]


# %% no_deviation_is_none loses 14.4
# Takes a deviation of 0 for none.
_table_of = table_of


def table_of(runs, baseline):
    return [{**row, "deviation": row["deviation"] or None} for row in _table_of(runs, baseline)]


# %% population_deviation loses 14.4
# Divides by the number of runs, as np.std does unless told otherwise.
# says: ddof=1
_table_of = table_of


def table_of(runs, baseline):
    rows = _table_of(runs, baseline)
    for row in rows:
        if row["deviation"] is not None:
            row["deviation"] *= np.sqrt((row["runs"] - 1) / row["runs"])
    return rows


# %% seeds_counted_twice loses 14.4
# Counts a repetition with the same seed as one more run.
_table_of = table_of


def table_of(runs, baseline):
    return _table_of([{**run, "seed": i} for i, run in enumerate(runs)], baseline)


# %% equal_ones_left_out loses 14.5
# Counts only differences that are greater than the real one, so that 0 can come out.
# says: equal ones count, too
def chance_of(first, second):
    together, n = np.array([*first, *second], dtype=float), len(first)
    observed, hits = abs(np.mean(first) - np.mean(second)), []
    for chosen in combinations(range(len(together)), n):
        others = [i for i in range(len(together)) if i not in chosen]
        difference = abs(together[list(chosen)].mean() - together[others].mean())
        hits.append(difference > observed + 1e-9)
    return float(np.mean(hits))


# %% one_sided loses 14.5
# Counts differences in one direction only.
# says: in one direction
def chance_of(first, second):
    together, n = np.array([*first, *second], dtype=float), len(first)
    observed, hits = np.mean(first) - np.mean(second), []
    for chosen in combinations(range(len(together)), n):
        others = [i for i in range(len(together)) if i not in chosen]
        difference = together[list(chosen)].mean() - together[others].mean()
        hits.append(difference * np.sign(observed) >= abs(observed) - 1e-9)
    return float(np.mean(hits))


# %% empty_is_zero loses 14.6
# Takes 0 for a part in which nothing was logged.
_phase_means = phase_means


def phase_means(steps, values, total, parts=3):
    return [mean or 0.0 for mean in _phase_means(steps, values, total, parts)]


# %% entries_for_steps loses 14.6
# Divides the entries into equal parts instead of the training.
def phase_means(steps, values, total, parts=3):
    found = [part[~np.isnan(part)] for part in np.array_split(np.asarray(values), parts)]
    return [float(part.mean()) if len(part) else None for part in found]


# %% limit_is_a_sign loses 14.6
# Takes an indicator that equals its limit for a warning sign.
def warning_signs(indicators, total, signs):
    found = []
    for name, (indicator, side, limit) in signs.items():
        if indicator in indicators:
            logged = indicators[indicator]
            late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
            if late is not None and (late >= limit if side == "above" else late <= limit):
                found.append(name)
    return found


# %% only_nan_is_nan loses 14.6
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


# %% whole_training loses 14.6
# Looks for signs in the whole training instead of its last third.
def warning_signs(indicators, total, signs):
    found = []
    for name, (indicator, side, limit) in signs.items():
        if indicator in indicators:
            mean = np.nanmean(indicators[indicator]["values"])
            if mean > limit if side == "above" else mean < limit:
                found.append(name)
    return found


# %% mean_of_all loses 14.7
# Subtracts the mean of all trainings instead of that of the variation.
# says: not that of the variant
def within_variants(numbers, variants):
    return np.round(np.asarray(numbers) - np.mean(numbers), 9)


# %% no_shared_ranks loses 14.7
# Gives equal numbers different ranks, by their order.
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    ranks = [np.argsort(np.argsort(numbers, kind="stable")) for numbers in (first, second)]
    return float(np.corrcoef(*ranks)[0, 1])


# %% values_for_ranks loses 14.7
# Correlates the numbers themselves.
# says: not their ranks
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    return float(np.corrcoef(first, second)[0, 1])


# %% best_on_the_training_episodes loses 14.8
# Takes the best fitness of evolution, measured on the episodes that it was selected by.
_curve_of = curve_of


def curve_of(place):
    if str(place).endswith(".npy"):
        stat = read_stat(place)
        return {"steps": stat[:, 0], "best": stat[:, 1]}
    return _curve_of(place)


# %% best_so_far_from_zero loses 14.8
# Begins with 0 as the best so far, which negative returns never reach.
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": np.maximum.accumulate(found.returns.mean(axis=1).clip(min=0)),


# %% before_the_step loses 14.8
# Takes the last value before a step, also if there is one at the step.
# -             last = np.searchsorted(curve["steps"], steps, side="right") - 1
# +             last = np.maximum(np.searchsorted(curve["steps"], steps, side="left") - 1, 0)


# %% looks_ahead loses 14.8
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


# %% post_evaluations_free loses 14.8
# Forgets the steps of the post-evaluations, which evolution has to pay for.
_curve_of = curve_of


def curve_of(place):
    curve = _curve_of(place)
    if not str(place).endswith(".npy"):
        curve["steps"] = RunFolder(place).evaluations().steps
    return curve


# %% last_run_of_each_variation loses 14.1
# Keeps the last seed of each variation only.
# -             records.append(
# -                 {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# -             )
# -     return records
# +         records.append(
# +             {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# +         )
# +     return records


# %% one_folder_for_all loses 14.1
# All variations lie in one folder.
# -             run = train("ppo", environment, Path(folder) / name, params=params, steps=steps,
# +             run = train("ppo", environment, Path(folder), params=params, steps=steps,


# %% best_post_evaluation loses 14.1
# Reports the best post-evaluation instead of the last one.
# -             result = run.evaluations().last
# +             result = float(run.evaluations().returns.mean(axis=1).max())


# %% eight_evaluations_always loses 14.1
# The numbers of evaluations and episodes are the defaults, whatever is asked for.
_train_variations = train_variations


def train_variations(environment, variations, seeds, steps, folder, evaluations=8, episodes=5):
    return _train_variations(environment, variations, seeds, steps, folder)


# %% train_indicators_only loses 14.2
# Reads the indicators of the training only, and not those of the episodes.
# -     for name in log.Tags()["scalars"]:
# +     for name in [each for each in log.Tags()["scalars"] if each.startswith("train/")]:


# %% area_by_left_edges loses 14.3
# The average weighs each value by the steps until the next one, without the line between them.
# says: this
# -     area = np.sum(widths * (means[:-1] + means[1:]) / 2)
# +     area = np.sum(widths * means[:-1])


# %% area_from_zero loses 14.3
# The average counts the steps before the first post-evaluation, too.
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float((area + steps[0] * means[0]) / steps[-1]),


# %% solved_by_the_best_episode loses 14.3
# The goal counts as reached if one episode reaches it.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# +     for when, mean in zip(steps[::-1], np.max(returns, axis=1)[::-1], strict=True):


# %% never_solved_is_zero loses 14.3
# A training that never reaches the goal is solved after 0 steps.
# -         "solved": solved,
# +         "solved": solved or 0,


# %% last_result_counts loses 14.4
# Of several results with the same variant and seed the last one counts.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         results.setdefault(run["variant"], {})[run["seed"]] = run["return"]


# %% lowest_first loses 14.4
# The rows begin with the lowest mean.
# says: this
# -     for variant in sorted(means, key=means.get, reverse=True):
# +     for variant in sorted(means, key=means.get):


# %% gain_in_percent loses 14.4
# The gain is a share of the baseline's mean.
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float((means[variant] - means[baseline]) / abs(means[baseline])),


# %% halves_only loses 14.5
# The groups are dealt out as if both had the size of the first one.
# -     n, m = len(first), len(second)
# -     observed = abs(np.mean(first) - np.mean(second))
# -     ways = np.array(list(combinations(range(n + m), n)))
# +     n, m = len(first), len(second)
# +     observed = abs(np.mean(first) - np.mean(second))
# +     ways = np.array(list(combinations(range(n + m), min(n, m))))


# %% without_the_real_way loses 14.5
# The way in which the results really fell is not counted among the ways.
# -     return float(np.mean(differences >= observed - 1e-9))
# +     return float(np.mean(differences[1:] >= observed - 1e-9))


# %% medians_for_means loses 14.5
# Compares medians, not means.
# -     observed = abs(np.mean(first) - np.mean(second))
# +     observed = abs(np.median(first) - np.median(second))
# -     totals = together[ways].sum(axis=1)
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     rest = [[i for i in range(n + m) if i not in way] for way in ways.tolist()]
# +     medians = np.median(together[ways], axis=1)
# +     differences = abs(medians - np.median(together[np.array(rest, dtype=int)], axis=1))


# %% step_0_left_out loses 14.6
# What was logged at step 0 belongs to no part.
# says: this
# -         if part == 0:
# -             inside |= steps == 0


# %% border_in_both loses 14.6
# What was logged at the border of two parts counts in both.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps * parts >= part * total) & (steps * parts <= (part + 1) * total)


# %% three_parts_always loses 14.6
# There are three parts, however many are asked for.
# says: this
# -     means = []
# -     for part in range(parts):
# +     means, parts = [], 3
# +     for part in range(parts):


# %% signs_in_the_order_of_their_names loses 14.6
# The signs come in the order of their names.
_warning_signs = warning_signs


def warning_signs(indicators, total, signs):
    return sorted(_warning_signs(indicators, total, signs))


# %% equal_numbers_share_the_lowest_rank loses 14.7
# Equal numbers get the lowest rank of theirs, not the mean.
# says: this
# -         ranks = smaller + (equal + 1) / 2
# +         ranks = smaller + (equal > 0)


# %% correlation_without_sign loses 14.7
# The correlation is never negative.
# says: this
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return abs(float((a * b).sum() / below)) if below > 0 else 0.0


# %% one_when_all_are_equal loses 14.7
# Two arrays of which one holds equal numbers correlate by 1.
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return float((a * b).sum() / below) if below > 0 else 1.0


# %% last_value_for_best loses 14.8
# The curve of a training falls again: it holds the means, not the best so far.
# says: this
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": found.returns.mean(axis=1),


# %% post_evaluation_not_included loses 14.8
# The steps of a post-evaluation count from the next one on.
# says: this
# -         "steps": found.steps + found.lengths.sum(axis=1).cumsum(),
# +         "steps": found.steps + found.lengths.sum(axis=1).cumsum() - found.lengths.sum(axis=1),


# %% each_group_has_its_own_steps loses 14.8
# The range of the steps follows from the last group only.
# -     curves = [curve for group in groups.values() for curve in group]
# +     curves = [*groups.values()][-1]


# %% steps_shared_by_the_seeds loses 14.1
# Divides the steps by the number of seeds.
# -             run = train("ppo", environment, Path(folder) / name, params=params, steps=steps,
# +             run = train("ppo", environment, Path(folder) / name, params=params, steps=steps // len(seeds),


# %% settings_kept_from_the_last_variation loses 14.1
# Settings of one variation stay for the next one, which does not set them.
# -     for name, params in variations.items():
# -         for seed in seeds:
# +     params = {}
# +     for name, own in variations.items():
# +         params = {**params, **own}
# +         for seed in seeds:


# %% steps_from_zero loses 14.2
# Steps count from the first entry.
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.step - entries[0].step for entry in entries]),


# %% times_for_steps loses 14.2
# Each value stands at the step of the entry before it was filtered.
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.step for entry in log.Scalars(name)][: len(entries)]),


# %% area_by_right_edges loses 14.3
# The area under the curve is made of rectangles as high as their right edge, not of trapezoids.
# -     area = np.sum(widths * (means[:-1] + means[1:]) / 2)
# +     area = np.sum(widths * means[1:])


# %% solved_at_the_last_failure loses 14.3
# Gives the steps of the last post-evaluation below the goal instead of the next one.
# -         if mean < goal:
# -             break
# -         solved = int(when)
# +         if mean < goal:
# +             solved = int(when) if solved is not None else None
# +             break
# +         solved = int(when)


# %% median_for_mean loses 14.4
# The median of the returns takes the place of the mean.
# -     means = {variant: np.mean(list(found.values())) for variant, found in results.items()}
# +     means = {variant: np.median(list(found.values())) for variant, found in results.items()}


# %% deviation_of_the_mean loses 14.4
# Gives the standard error of the mean instead of the standard deviation.
# -                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
# +                 "deviation": float(np.std(values, ddof=1) / len(values) ** 0.5) if len(values) > 1 else None,


# %% gain_turned_around loses 14.4
# The gain is the baseline's mean minus the variation's.
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(means[baseline] - means[variant]),


# %% sums_for_means loses 14.5
# Compares the sums of the two groups, not the means.
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     differences = abs(totals - (together.sum() - totals))


# %% total_of_the_last_step loses 14.6
# Divides the steps up to the last entry into parts, not those of the whole training.
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps * parts > part * steps.max()) & (steps * parts <= (part + 1) * steps.max())


# %% covariance_of_ranks loses 14.7
# The covariance of the ranks is not divided by their deviations.
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return float((a * b).mean()) if below > 0 else 0.0


# %% medians_within loses 14.7
# Subtracts the median of the variation instead of its mean.
# -     means = {name: numbers[names == name].mean() for name in set(variants)}
# +     means = {name: np.median(numbers[names == name]) for name in set(variants)}


# %% ends_where_the_last_ends loses 14.8
# The steps go on to the end of the longest run.
# -     end = min(curve["steps"][-1] for curve in curves)
# +     end = max(curve["steps"][-1] for curve in curves)


# %% starts_at_the_first loses 14.8
# The steps begin where the first run has its first value.
# -     start = max(curve["steps"][0] for curve in curves)
# +     start = min(curve["steps"][0] for curve in curves)


# %% whole_parts loses 14.6
# Divides the steps as whole numbers, so that the last steps are in no part.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps > part * (total // parts)) & (steps <= (part + 1) * (total // parts))


# %% seeds_counted_over_all_variants loses 14.4
# A seed that another variation has had, too, is left out.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         mine = results.setdefault(run["variant"], {})
# +         if not any(run["seed"] in other for other in results.values()):
# +             mine[run["seed"]] = run["return"]
# -     means = {variant: np.mean(list(found.values())) for variant, found in results.items()}
# +     results = {variant: found for variant, found in results.items() if found}
# +     means = {variant: np.mean(list(found.values())) for variant, found in results.items()}
# +     means.setdefault(baseline, 0.0)
# +     results.setdefault(baseline, {0: 0.0})


# %% order_for_ranks loses 14.7
# Takes what argsort gives for the ranks: it is the order of the trainings.
# says: this
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    return float(np.corrcoef(np.argsort(first), np.argsort(second))[0, 1])


# %% neighbours_only loses 14.7
# Groups only neighbours of the same variation, though they come in any order.
# says: this
def within_variants(numbers, variants):
    numbers, found, begin = np.asarray(numbers, dtype=float), [], 0
    for end in range(1, len(numbers) + 1):
        if end == len(numbers) or variants[end] != variants[begin]:
            found += list(numbers[begin:end] - numbers[begin:end].mean())
            begin = end
    return np.round(found, 9)


# %% sorted_by_variant loses 14.7
# The answer is in the order of the variations, not of the numbers.
# says: this
def within_variants(numbers, variants):
    numbers, names, found = np.asarray(numbers, dtype=float), np.array(variants), []
    for name in sorted(set(variants)):
        found += list(numbers[names == name] - numbers[names == name].mean())
    return np.round(found, 9)


# %% exact_comparison loses 14.5
# Leaves the tolerance out: equal differences count only if they are equal to the last bit.
# says: this
# -     return float(np.mean(differences >= observed - 1e-9))
# +     return float(np.mean(differences >= observed))


# %% sums_compared loses 14.5
# Compares sums where means are asked for: the larger group has the larger sum.
# says: this
# -     observed = abs(np.mean(first) - np.mean(second))
# +     observed = abs(np.sum(first) - np.sum(second))
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     differences = abs(totals - (together.sum() - totals)) + 0 * m


# %% random_deals loses 14.5
# Deals at random some thousand times, but every way is to be counted exactly once.
# says: multiple of
# -     ways = np.array(list(combinations(range(n + m), n)))
# +     rng = np.random.default_rng(0)
# +     ways = np.array([rng.permutation(n + m)[:n] for _ in range(2000)])


# %% average_of_one_run loses 14.8
# A group is averaged, but each run is to keep its own row.
# says: this
# -         found[name] = np.array(reached)
# +         found[name] = np.mean(reached, axis=0)


# %% borders_belong_to_the_next loses 14.6
# What was logged on the border of two parts counts for the later one, not for the earlier one.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps * parts >= part * total) & (steps * parts < (part + 1) * total)


# %% number_of_the_post_evaluation loses 14.3
# Gives the number of the post-evaluation where its steps are asked for.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# +     for when, mean in reversed(list(enumerate(means))):


# %% every_episode_reaches_the_goal loses 14.3
# Asks every episode to reach the goal, not their mean.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# +     for when, mean in zip(steps[::-1], np.min(returns, axis=1)[::-1], strict=True):


# %% gain_over_the_best loses 14.4
# The gain is that over the best variation, not over the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(means[variant] - max(means.values())),


# %% rows_by_name loses 14.4
# The rows are in the order of the names, not of the means.
# says: this
# -     for variant in sorted(means, key=means.get, reverse=True):
# +     for variant in sorted(means):


# %% nan_counts loses 14.6
# What is NaN is not left out.
# says: this
# -         these = values[inside & ~np.isnan(values)]
# +         these = values[inside]


# %% first_third loses 14.6
# Looks for signs in the first third instead of the last.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], total, 3)[0]


# %% ranks_turned_around loses 14.7
# One of the two is ranked from the largest number on, so the sign is wrong.
# says: this
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return -float((a * b).sum() / below) if below > 0 else 0.0


# %% formula_without_ties loses 14.7
# Takes the short formula with squared differences of the ranks, which is wrong with equal numbers.
# says: this
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     n = len(a)
# +     return float(1 - 6 * ((a - b) ** 2).sum() / (n * (n**2 - 1))) if below > 0 else 0.0


# %% evenly_spaced_logarithms loses 14.8
# The logarithms of the steps are evenly spaced, not the steps.
# says: this
# -     steps = np.linspace(start, end, points)
# +     steps = np.geomspace(start, end, points)


# %% all_ways_of_halves loses 14.5
# Deals out two halves whatever the sizes of the two lists are.
# says: this
# -     n, m = len(first), len(second)
# -     observed = abs(np.mean(first) - np.mean(second))
# +     n, m = len(first), len(second)
# +     observed = abs(np.mean(first) - np.mean(second))
# +     n, m = (n + m) // 2, n + m - (n + m) // 2


# %% variations_folder_in_the_record loses 14.1
# The record holds the folder of the variation, and not that of the training.
# says: which is that of the whole variation
# -                 {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# +                 {"variant": name, "seed": seed, "return": result, "folder": f"{folder}/{name}"}


# %% time_of_day_for_steps loses 14.2
# Takes the time of day at which a value was logged for its steps.
# says: this
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.wall_time for entry in entries]),


# %% last_of_the_episodes loses 14.3
# Takes the mean over the post-evaluations of the last episode, not over the last post-evaluation.
# says: a row of returns is a post-evaluation
# -         "last": float(means[-1]),
# +         "last": float(np.mean(returns, axis=0)[-1]),


# %% repeated_runs_counted loses 14.4
# Counts runs that were repeated with the same seed.
# says: Several runs with the same seed count as one
# -                 "runs": len(values),
# +                 "runs": sum(run["variant"] == variant for run in runs),


# %% one_way_less_in_the_sum loses 14.5
# Leaves out the way in which it really was.
# says: this
# -     return float(np.mean(differences >= observed - 1e-9))
# +     return float((np.sum(differences >= observed - 1e-9) - 1) / len(differences))


# %% last_value_for_the_mean loses 14.6
# A sign looks at the last value, not at the mean of the last third.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = logged["values"][-1] if len(logged["values"]) else None


# %% limit_gives_a_sign loses 14.6
# A mean that equals the limit gives a sign.
# says: equals the limit gives no sign
# -         if late is not None and (late > limit if side == "above" else late < limit):
# +         if late is not None and (late >= limit if side == "above" else late <= limit):


# %% argsort_for_ranks loses 14.7
# Takes the order of the numbers for their ranks.
# says: np.argsort says where the smallest number stands
# -         ranks = smaller + (equal + 1) / 2
# +         ranks = np.argsort(numbers) + 1.0 + 0 * (smaller + equal)


# %% divided_by_the_deviation loses 14.7
# The numbers of a variation are divided by their deviation, too.
# says: subtract only
def within_variants(numbers, variants, _within=within_variants):
    found, names = _within(numbers, variants), np.array(variants)
    sizes = {name: np.std(np.asarray(numbers)[names == name]) for name in set(variants)}
    by = [sizes[name] if sizes[name] > 1e-12 else 1.0 for name in variants]
    return np.round(found / np.array(by), 9)


# %% from_the_first_value_to_the_last_end loses 14.8
# The steps begin where the first of all runs has a value, and end where the last one ends.
# says: this|others have ended before
# -     start = max(curve["steps"][0] for curve in curves)
# -     end = min(curve["steps"][-1] for curve in curves)
# +     start = min(curve["steps"][0] for curve in curves)
# +     end = max(curve["steps"][-1] for curve in curves)


# %% one_entry_for_each_step loses 14.2
# Of several entries of the same step only the last one is kept.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries = {e.step: e for e in log.Scalars(name) if not np.isnan(e.value)}.values()


# %% parts_of_equally_many_entries loses 14.6
# Cuts the entries into parts of equally many: the steps do not decide.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# -         if part == 0:
# -             inside |= steps == 0
# -         these = values[inside & ~np.isnan(values)]
# +         these = np.array_split(values[~np.isnan(values)], parts)[part]


# %% one_deviation_for_all loses 14.4
# All variations get the same deviation, pooled from all of their runs.
# says: this
_table_14 = table_of


def table_of(runs, baseline):
    rows = _table_14(runs, baseline)
    free = [max(row["runs"] - 1, 0) for row in rows]
    squares = [(row["deviation"] or 0) ** 2 * n for row, n in zip(rows, free, strict=True)]
    pooled = float(np.sqrt(sum(squares) / max(sum(free), 1)))
    return [{**row, "deviation": pooled if row["runs"] > 1 else None} for row in rows]


# %% negative_values_left_out loses 14.2
# Values below 0 are left out.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries = [entry for entry in log.Scalars(name) if entry.value >= 0]


# %% indicator_with_nan_left_out loses 14.2
# An indicator with a NaN somewhere is left out as a whole.
# says: this|Only its two NaN are left out
# -     for name in log.Tags()["scalars"]:
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +     for name in log.Tags()["scalars"]:
# +         if any(np.isnan(entry.value) for entry in log.Scalars(name)):
# +             continue
# +         entries = log.Scalars(name)


# %% steps_with_nan_left_out_everywhere loses 14.2
# A step at which one indicator is NaN is left out of all indicators.
# says: this
# -     for name in log.Tags()["scalars"]:
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +     names = log.Tags()["scalars"]
# +     bad = {e.step for name in names for e in log.Scalars(name) if np.isnan(e.value)}
# +     for name in names:
# +         entries = [entry for entry in log.Scalars(name) if entry.step not in bad]


# %% names_without_groups loses 14.2
# The names are cut at the slash: what stands before it is left out.
# says: this
# -         indicators[name] = {
# +         indicators[name.split("/")[-1]] = {


# %% nan_of_the_values_only loses 14.2
# NaN is left out of the values, but its steps stay.
# says: this|the two whose value is NaN are to be left out
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.step for entry in log.Scalars(name)]),


# %% first_of_each_step loses 14.2
# Of several entries of the same step only the first one is kept.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries, seen = [], set()
# +         for entry in log.Scalars(name):
# +             if not np.isnan(entry.value) and entry.step not in seen:
# +                 seen.add(entry.step)
# +                 entries.append(entry)


# %% steps_of_the_first_indicator loses 14.2
# All indicators get the steps of the first one.
# says: this
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([e.step for e in log.Scalars(log.Tags()["scalars"][0])]),


# %% average_of_one_is_zero loses 14.3
# With a single post-evaluation the average is 0, not its mean return.
# says: this
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float(area / widths.sum()) if len(means) > 1 else 0.0,


# %% average_by_steps_as_weights loses 14.3
# The means are weighted by their own steps, not by the steps between them.
# says: this
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float(np.average(means, weights=steps) if len(means) > 1 else means[0]),


# %% best_without_the_last loses 14.3
# The best is looked for before the last post-evaluation only.
# says: this
# -         "best": float(means.max()),
# +         "best": float(means[:-1].max() if len(means) > 1 else means[0]),


# %% solved_if_the_last_is loses 14.3
# Gives the first time that the goal was reached if the last post-evaluation reaches it, too.
# says: this
# -     return {
# -         "last": float(means[-1]),
# +     if solved is not None:
# +         solved = int(steps[np.argmax(means >= goal)])
# +     return {
# +         "last": float(means[-1]),


# %% solved_is_minus_one loses 14.3
# Gives -1 where the goal was never reached for good: None is asked for.
# says: this
# -         "solved": solved,
# +         "solved": -1 if solved is None else solved,


# %% median_of_the_last_one loses 14.3
# The last is the median of the last post-evaluation, not its mean.
# says: this
# -         "last": float(means[-1]),
# +         "last": float(np.median(returns[-1])),


# %% solved_steps_since_the_start loses 14.3
# Gives the steps since the first post-evaluation, not those since the start of the training.
# says: this
# -         solved = int(when)
# +         solved = int(when) - int(steps[0])


# %% runs_of_the_whole_table loses 14.4
# The runs are all those of the table, not those of the variation.
# says: this
# -                 "runs": len(values),
# +                 "runs": sum(map(len, results.values())),


# %% deviation_zero_for_one loses 14.4
# The deviation of a single run is 0, not None.
# says: this|single run is 0 instead of None
# -                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
# +                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else 0.0,


# %% gain_over_the_next_row loses 14.4
# The gain is that over the next row of the table, not over the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(
# +                     means[variant] - max([m for m in means.values() if m < means[variant]] or [0])
# +                 ),


# %% best_result_of_a_seed loses 14.4
# Of several results with the same variant and seed the highest one counts.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         own = results.setdefault(run["variant"], {})
# +         own[run["seed"]] = max(own.get(run["seed"], -np.inf), run["return"])


# %% mean_result_of_a_seed loses 14.4
# Of several results with the same variant and seed the mean counts.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         own = [r for r in runs if r["variant"] == run["variant"]]
# +         mean = np.mean([r["return"] for r in own if r["seed"] == run["seed"]])
# +         results.setdefault(run["variant"], {})[run["seed"]] = mean


# %% baseline_first loses 14.4
# The baseline has the first row, whatever its mean.
# says: this
# -     for variant in sorted(means, key=means.get, reverse=True):
# +     for variant in sorted(means, key=lambda v: (v == baseline, means[v]), reverse=True):


# %% equal_returns_count_once loses 14.4
# Runs with the same return count once, whatever their seeds.
# says: this
# -         values = list(results[variant].values())
# +         values = list(dict.fromkeys(results[variant].values()))


# %% last_of_the_part loses 14.6
# The last value of a part is taken, not the mean.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         means.append(float(these[-1]) if len(these) else None)


# %% median_of_the_part loses 14.6
# The median of a part is taken, not the mean.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         means.append(float(np.median(these)) if len(these) else None)


# %% nan_spoils_the_part loses 14.6
# A part with a NaN gives None: only the NaN itself does not count.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         spoiled = np.isnan(values[inside]).any()
# +         means.append(float(these.mean()) if len(these) and not spoiled else None)


# %% gaps_left_out loses 14.6
# Parts that hold nothing are left out of the list.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         if len(these):
# +             means.append(float(these.mean()))


# %% gap_keeps_the_last_mean loses 14.6
# A part that holds nothing gets the mean of the part before it.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         means.append(float(these.mean()) if len(these) else means[-1] if means else None)


# %% nan_is_zero_in_the_mean loses 14.6
# NaN counts as 0 in the mean of a part.
# says: this
# -         these = values[inside & ~np.isnan(values)]
# +         these = np.nan_to_num(values[inside])


# %% all_until_then loses 14.6
# A part holds all that was logged until its end, not from its own beginning on.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = steps * parts <= (part + 1) * total


# %% missing_is_a_sign loses 14.6
# An indicator that was not logged in the last third counts as 0.
# says: this
# -         if late is not None and (late > limit if side == "above" else late < limit):
# +         late = late or 0.0
# +         if late > limit if side == "above" else late < limit:


# %% second_third loses 14.6
# A sign looks at the second third, not at the last one.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], total, 3)[1]


# %% last_half loses 14.6
# A sign looks at the last half of the training, not at the last third.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], total, 2)[-1]


# %% end_of_the_log loses 14.6
# The last third is that of what was logged, not that of the training.
# says: this|the last third holds nothing
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], max(logged["steps"]), 3)[-1]


# %% any_value_gives_a_sign loses 14.6
# A single value of the last third beyond the limit gives a sign: its mean is asked for.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         steps, values = np.asarray(logged["steps"]), np.asarray(logged["values"])
# +         values = values[3 * steps > 2 * total]
# +         late = (max(values) if side == "above" else min(values)) if len(values) else None


# %% steps_of_training_twice loses 14.8
# The steps are added up once more, though they are counted from the start already.
# says: this
# -         "steps": found.steps + found.lengths.sum(axis=1).cumsum(),
# +         "steps": found.steps.cumsum() + found.lengths.sum(axis=1).cumsum(),


# %% best_of_all_at_once loses 14.8
# The best of the whole training stands everywhere, also before it was reached.
# says: this
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": np.full(len(found.steps), found.returns.mean(axis=1).max()),


# %% number_of_the_generation loses 14.8
# The steps of evolution are the numbers of its generations.
# says: this
# -         return {"steps": stat[:, 0], "best": stat[:, 2]}
# +         return {"steps": np.arange(1, len(stat) + 1), "best": stat[:, 2]}


# %% best_run_of_each_group loses 14.8
# A group has the row of its best run only: each run has one.
# says: this
# -         found[name] = np.array(reached)
# +         found[name] = np.array(reached).max(axis=0)


# %% different_hands_only loses 14.5
# Counts ways that give the same numbers only once.
# says: this
# -     ways = np.array(list(combinations(range(n + m), n)))
# -     totals = together[ways].sum(axis=1)
# +     ways = np.array(sorted(set(combinations(sorted(together), n))))
# +     totals = ways.sum(axis=1)


# %% zero_is_nothing loses 14.6
# Takes a mean of exactly 0 for one that is missing.
# says: A mean of 0 is a number
# -         if late is not None and (late > limit if side == "above" else late < limit):
# +         if late and (late > limit if side == "above" else late < limit):


# %% infinite_left_out loses 14.2
# Leaves out infinite values, too, but only NaN are to be left out.
# says: only NaN
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries = [entry for entry in log.Scalars(name) if np.isfinite(entry.value)]


# %% settings_updated_in_one_dict loses 14.1
# One dict of settings is updated from variation to variation, so that those of one stay for the next.
# says: must not stay
from pathlib import Path

from botschool.rl.training import train


def train_variations(environment, variations, seeds, steps, folder, evaluations=8, episodes=5):
    results = []
    settings = {}
    for variant in variations:
        settings.update(variations[variant])
        where = Path(folder) / variant
        for s in seeds:
            trained = train(
                "ppo",
                environment,
                where,
                params=dict(settings),
                steps=steps,
                seed=s,
                evaluations=evaluations,
                episodes=episodes,
            )
            found = trained.evaluations().last
            results.append(
                {"variant": variant, "seed": s, "return": found, "folder": str(trained.path)}
            )
    return results


# %% solved_by_a_crossing loses 14.3
# Takes only a post-evaluation that follows one below the goal: a training that is at the goal from the first one on is solved, too.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# -         if mean < goal:
# -             break
# -         solved = int(when)
# +     for i in range(1, len(means)):
# +         if means[i - 1] < goal and (means[i:] >= goal).all():
# +             solved = int(steps[i])


# %% width_from_zero loses 14.3
# Divides the area by the last step, not by the width from the first to the last.
# says: this
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float(area / steps[-1]) if len(means) > 1 else float(means[0]),


# %% repetitions_in_the_gain loses 14.4
# The mean of the baseline that is subtracted counts repeated seeds, too.
# says: this
import numpy as np


def mean_return(runs, variant):
    return float(np.mean([run["return"] for run in runs if run["variant"] == variant]))


def table_of(runs, baseline):
    base = mean_return(runs, baseline)
    seen = set()
    counted = []
    for run in runs:
        key = (run["variant"], run["seed"])
        if key not in seen:
            seen.add(key)
            counted.append(run)
    rows = []
    for variant in dict.fromkeys(run["variant"] for run in counted):
        values = [run["return"] for run in counted if run["variant"] == variant]
        mean = mean_return(counted, variant)
        row = {"variant": variant, "runs": len(values), "mean": mean, "gain": mean - base}
        row["deviation"] = float(np.std(values, ddof=1)) if len(values) >= 2 else None
        rows.append(row)
    return sorted(rows, key=lambda row: row["mean"], reverse=True)


# %% pairs_are_swapped loses 14.5
# Exchanges the two results of each place only: all ways to deal the results out are asked for.
# says: this
from itertools import product

import numpy as np


def chance_of(first, second):
    a, b = list(first), list(second)
    real = abs(np.mean(a) - np.mean(b))
    pairs = min(len(a), len(b))
    hits = 0
    for swaps in product([False, True], repeat=pairs):
        x, y = a[:], b[:]
        for i, swap in enumerate(swaps):
            if swap:
                x[i], y[i] = b[i], a[i]
        if abs(np.mean(x) - np.mean(y)) >= real - 1e-9:
            hits += 1
    return hits / 2**pairs


# %% last_third_of_the_log loses 14.6
# The last third is that of what was logged, not of the training.
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         if len(logged["steps"]) == 0:
# +             continue
# +         late = phase_means(logged["steps"], logged["values"], logged["steps"][-1], 3)[-1]


# %% not_solved_at_step_0 loses 14.3
# Takes the step 0 for not solved.
# says: this
import numpy as np


def success_of(steps, returns, goal):
    means = [float(np.mean(r)) for r in returns]
    solved = None
    area = 0.0
    for i, m in enumerate(means):
        if m < goal:
            solved = None
        elif not solved:
            solved = int(steps[i])
        if i > 0:
            area += (steps[i] - steps[i - 1]) * (means[i - 1] + m) / 2
    average = means[0] if len(means) == 1 else float(area / (steps[-1] - steps[0]))
    return {"last": means[-1], "best": max(means), "average": average, "solved": solved}


# %% nothing_but_nan_is_missing loses 14.2
# Leaves out an indicator that holds nothing but NaN: it stays, with empty arrays.
# says: it stays, empty
# -         indicators[name] = {
# -             "steps": np.array([entry.step for entry in entries]),
# -             "values": np.array([entry.value for entry in entries]),
# -         }
# +         if not entries:
# +             continue
# +         indicators[name] = {
# +             "steps": np.array([entry.step for entry in entries]),
# +             "values": np.array([entry.value for entry in entries]),
# +         }


# %% folder_by_the_seed loses 14.1
# Makes the folder's number of the seed, not of the place among the trainings.
# says: this
# -             records.append(
# -                 {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# -             )
# +             path = Path(folder) / name / "ppo" / f"{environment}_{seed}"
# +             records.append(
# +                 {"variant": name, "seed": seed, "return": result, "folder": str(path)}
# +             )


# %% nan_of_all_indicators_so_far loses 14.2
# Leaves out, in each indicator, the steps of NaN in those before it.
# says: NaN at this step
import math

import numpy as np
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator


def read_indicators(folder):
    acc = EventAccumulator(str(folder), size_guidance={"scalars": 0})
    acc.Reload()
    bad = set()
    out = {}
    for tag in acc.Tags()["scalars"]:
        events = acc.Scalars(tag)
        for e in events:
            if math.isnan(e.value):
                bad.add(e.step)
        out[tag] = {
            "steps": np.array([e.step for e in events if e.step not in bad]),
            "values": np.array([e.value for e in events if e.step not in bad]),
        }
    return out


# %% ends_with_whole_pieces loses 14.3
# Weights both ends with a whole piece instead of half of it (np.gradient).
# says: this
import numpy as np


def first_for_good(steps, good):
    if not good[-1]:
        return None
    bad = np.flatnonzero(~good)
    return int(steps[bad[-1] + 1]) if bad.size else int(steps[0])


def success_of(steps, returns, goal):
    m = np.asarray(returns).mean(axis=1)
    if m.size > 1:
        average = np.average(m, weights=np.gradient(np.asarray(steps, dtype=float)))
    else:
        average = m[0]
    return {
        "last": float(m[-1]),
        "best": float(np.max(m)),
        "average": float(average),
        "solved": first_for_good(steps, m >= goal),
    }


# %% sorted_before_repetitions_are_left_out loses 14.4
# Sorts the runs first, so that of a repeated seed the lowest return counts, not the first.
# says: this
from statistics import mean, stdev


def table_of(runs, baseline):
    data = sorted((run["variant"], run["seed"], run["return"]) for run in runs)
    values = {}
    previous = None
    for variant, seed, result in data:
        if (variant, seed) != previous:
            values.setdefault(variant, []).append(float(result))
        previous = (variant, seed)
    table = []
    for variant, v in values.items():
        table.append(
            {
                "variant": variant,
                "runs": len(v),
                "mean": mean(v),
                "deviation": stdev(v) if len(v) > 1 else None,
                "gain": mean(v) - mean(values[baseline]),
            }
        )
    return sorted(table, key=lambda row: row["mean"], reverse=True)


# %% first_result_never_exchanged loses 14.5
# Leaves the first result in its group, which is right for groups of the same size only.
# says: this
# -     ways = np.array(list(combinations(range(n + m), n)))
# +     ways = np.array([(0, *rest) for rest in combinations(range(1, n + m), n - 1)])


# %% nan_for_nothing_but_nan loses 14.6
# Gives NaN instead of None for a part that holds nothing but NaN.
# says: nothing but NaN
# -         these = values[inside & ~np.isnan(values)]
# -         means.append(float(these.mean()) if len(these) else None)
# +         these = values[inside]
# +         means.append(float(np.nanmean(these)) if len(these) else None)


# %% last_sign_of_an_indicator loses 14.6
# Keeps the last sign of each indicator only.
# says: another one of the same
def warning_signs(indicators, total, signs):
    rules = {tag: (sign, side, limit) for sign, (tag, side, limit) in signs.items()}
    shown = set()
    for tag, log in indicators.items():
        if tag not in rules:
            continue
        sign, side, limit = rules[tag]
        mean = phase_means(log["steps"], log["values"], total)[2]
        if mean is None:
            continue
        if side == "above" and mean > limit:
            shown.add(sign)
        if side == "below" and mean < limit:
            shown.add(sign)
    return [sign for sign in signs if sign in shown]


# %% means_while_they_change loses 14.7
# Takes the means from the array that it is changing.
# says: this
import numpy as np


def within_variants(numbers, variants):
    x = np.array(numbers, dtype=float)
    names = np.array(variants)
    for i, name in enumerate(variants):
        x[i] -= x[names == name].mean()
    return x.round(9)


# %% best_so_far_of_each_episode loses 14.8
# Takes the best so far of each episode by itself, then their mean.
# says: this
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": np.maximum.accumulate(found.returns, axis=0).mean(axis=1),


# %% equal_steps_of_each_group loses 14.8
# Takes start and end of the runs of each group, not of all runs.
# says: this
import bisect

import numpy as np


def at_equal_steps(groups, points):
    result = {}
    for name, runs in groups.items():
        start = max(run["steps"][0] for run in runs)
        end = min(run["steps"][-1] for run in runs)
        steps = np.linspace(start, end, points)
        values = np.empty((len(runs), points))
        for i, run in enumerate(runs):
            for j, s in enumerate(steps):
                values[i, j] = run["best"][bisect.bisect_right(list(run["steps"]), s) - 1]
        result["steps"] = steps
        result[name] = values
    return result


# %% boundary_in_the_next_part loses 14.6
# What was logged exactly at the end of a part counts in the next part.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# -         if part == 0:
# -             inside |= steps == 0
# +         inside = np.minimum(steps * parts // total, parts - 1) == part
