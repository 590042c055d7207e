"""Wrong solutions of exercise 14; building.py describes how a case is written."""

# %% numbers_made_up loses 14.1
# Trains for fewer steps than asked for: each training should have all `steps` steps.
_train_variations = train_variations


def train_variations(environment, variations, seeds, steps, *arguments, **options):
    records = _train_variations(environment, variations, seeds, steps // 3, *arguments, **options)
    for record in records:
        config = RunFolder(record["folder"]).config
        config.write_text(config.read_text().replace(f"steps: {steps // 3}", f"steps: {steps}"))
    return records


# %% params_forgotten loses 14.1
# Trains every variation with the default hyperparameters instead of its own params.
# says: this
_train_variations = train_variations


def train_variations(environment, variations, *arguments, **options):
    return _train_variations(environment, {name: {} for name in variations}, *arguments, **options)


# %% same_seed loses 14.1
# Trains with the first seed every time instead of with each of the seeds.
# says: this
_train_variations = train_variations


def train_variations(environment, variations, seeds, *arguments, **options):
    records = _train_variations(environment, variations, [seeds[0]] * len(seeds), *arguments)
    count = len(seeds)
    return [{**record, "seed": seeds[i % count]} for i, record in enumerate(records)]


# %% training_episodes loses 14.1
# Takes the mean return of the training's own episodes as "return" instead of that of the last post-evaluation.
_train_variations = train_variations


def train_variations(*arguments, **options):
    records = _train_variations(*arguments, **options)
    for record in records:
        means = RunFolder(record["folder"]).log()["rollout/ep_rew_mean"]
        record["return"] = float(means[~np.isnan(means)][-1])
    return records


# %% nan_stays loses 14.2
# Replaces NaN by 0, but these entries should be left out.
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
# Numbers the entries 0, 1, 2, ... in "steps" instead of giving the steps at which they were logged.
_read_indicators = read_indicators


def read_indicators(folder):
    indicators = _read_indicators(folder)
    for logged in indicators.values():
        logged["steps"] = np.arange(len(logged["values"]))
    return indicators


# %% thinned_log loses 14.2
# Keeps at most 10 000 values of an indicator, but all are asked for: size_guidance={"scalars": 0} keeps them.
# -     log = EventAccumulator(folder, size_guidance={"scalars": 0})
# +     log = EventAccumulator(folder)


# %% best_episode loses 14.3
# Takes the return of the best episode as "best", but the best mean return of a post-evaluation is asked for.
# says: this
_success_of = success_of


def success_of(steps, returns, goal):
    return {**_success_of(steps, returns, goal), "best": float(np.max(returns))}


# %% best_is_at_least_zero loses 14.3
# Gives 0 as "best" if all mean returns are negative, but the highest of them is asked for.
# -         "best": float(means.max()),
# +         "best": max(0.0, float(means.max())),


# %% more_than_the_goal loses 14.3
# Counts the goal as reached only by mean returns above it, but one that equals the goal reaches it, too.
_success_of = success_of


def success_of(steps, returns, goal):
    return _success_of(steps, returns, goal + 1e-9)


# %% plain_average loses 14.3
# Takes the plain mean of all post-evaluations as "average" instead of the area under the curve, divided by its width.
# says: this
_success_of = success_of


def success_of(steps, returns, goal):
    return {**_success_of(steps, returns, goal), "average": float(np.mean(returns))}


# %% solved_once loses 14.3
# Takes the first post-evaluation that reaches the goal, even if the goal is lost again, but from there on all should reach it.
_success_of = success_of


def success_of(steps, returns, goal):
    reached = np.flatnonzero(np.mean(returns, axis=1) >= goal)
    solved = int(steps[reached[0]]) if len(reached) else None
    return {**_success_of(steps, returns, goal), "solved": solved}


# %% gain_over_the_worst loses 14.4
# Subtracts the lowest mean for "gain" instead of the mean of the baseline.
# says: this
_table_of = table_of


def table_of(runs, baseline):
    rows = _table_of(runs, baseline)
    return [{**row, "gain": row["mean"] - rows[-1]["mean"]} for row in rows]


# %% no_deviation_is_none loses 14.4
# Gives None for a deviation of 0, but only a single run should have None.
_table_of = table_of


def table_of(runs, baseline):
    return [{**row, "deviation": row["deviation"] or None} for row in _table_of(runs, baseline)]


# %% population_deviation loses 14.4
# Divides by the number of runs for "deviation", but it should divide by runs - 1 (ddof=1).
# says: this
_table_of = table_of


def table_of(runs, baseline):
    rows = _table_of(runs, baseline)
    for row in rows:
        if row["deviation"] is not None:
            row["deviation"] *= np.sqrt((row["runs"] - 1) / row["runs"])
    return rows


# %% seeds_counted_twice loses 14.4
# Counts every run, but of several with the same variant and seed only the first one should count.
_table_of = table_of


def table_of(runs, baseline):
    return _table_of([{**run, "seed": i} for i, run in enumerate(runs)], baseline)


# %% equal_ones_left_out loses 14.5
# Counts only differences greater than the real one, but equal ones should count, too.
# says: this
def chance_of(first, second):
    together, n = np.array([*first, *second], dtype=float), len(first)
    observed, hits = abs(np.mean(first) - np.mean(second)), []
    for chosen in combinations(range(len(together)), n):
        others = [i for i in range(len(together)) if i not in chosen]
        difference = abs(together[list(chosen)].mean() - together[others].mean())
        hits.append(difference > observed + 1e-9)
    return float(np.mean(hits))


# %% one_sided loses 14.5
# Counts only differences in the direction of the real one, but both directions should count.
# says: this
def chance_of(first, second):
    together, n = np.array([*first, *second], dtype=float), len(first)
    observed, hits = np.mean(first) - np.mean(second), []
    for chosen in combinations(range(len(together)), n):
        others = [i for i in range(len(together)) if i not in chosen]
        difference = together[list(chosen)].mean() - together[others].mean()
        hits.append(difference * np.sign(observed) >= abs(observed) - 1e-9)
    return float(np.mean(hits))


# %% empty_is_zero loses 14.6
# Gives 0 for a part that holds nothing, but None is asked for.
_phase_means = phase_means


def phase_means(steps, values, total, parts=3):
    return [mean or 0.0 for mean in _phase_means(steps, values, total, parts)]


# %% entries_for_steps loses 14.6
# Divides the entries, NaN included, into parts of equally many, but their steps should decide to which part they belong.
def phase_means(steps, values, total, parts=3):
    found = [part[~np.isnan(part)] for part in np.array_split(np.asarray(values), parts)]
    return [float(part.mean()) if len(part) else None for part in found]


# %% limit_is_a_sign loses 14.6
# Gives a sign if the mean equals the limit, but it should be above or below it.
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
# Gives NaN for a part in which only NaN was logged, but None is asked for.
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
# Subtracts the mean of all trainings instead of that of the variant.
# says: this
def within_variants(numbers, variants):
    return np.round(np.asarray(numbers) - np.mean(numbers), 9)


# %% no_shared_ranks loses 14.7
# Gives equal numbers different ranks, but they should share the mean of their ranks.
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    ranks = [np.argsort(np.argsort(numbers, kind="stable")) for numbers in (first, second)]
    return float(np.corrcoef(*ranks)[0, 1])


# %% values_for_ranks loses 14.7
# Correlates the numbers themselves instead of their ranks.
# says: this
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    return float(np.corrcoef(first, second)[0, 1])


# %% best_on_the_training_episodes loses 14.8
# Takes column 1 of the stat file as "best", but the best post-evaluation so far is in column 2 (the third one).
_curve_of = curve_of


def curve_of(place):
    if str(place).endswith(".npy"):
        stat = read_stat(place)
        return {"steps": stat[:, 0], "best": stat[:, 1]}
    return _curve_of(place)


# %% best_so_far_from_zero loses 14.8
# Gives 0 as "best" while all mean returns are negative, but the highest of them so far is asked for.
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": np.maximum.accumulate(found.returns.mean(axis=1).clip(min=0)),


# %% before_the_step loses 14.8
# Takes the last value before each step even if there is one at the step itself, but that one should be taken then.
# -             last = np.searchsorted(curve["steps"], steps, side="right") - 1
# +             last = np.maximum(np.searchsorted(curve["steps"], steps, side="left") - 1, 0)


# %% looks_ahead loses 14.8
# Interpolates linearly between the values, but the last value at or before each step is asked for.
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
# Leaves the steps of the post-evaluations out of the "steps" of a training, but they should be included.
_curve_of = curve_of


def curve_of(place):
    curve = _curve_of(place)
    if not str(place).endswith(".npy"):
        curve["steps"] = RunFolder(place).evaluations().steps
    return curve


# %% last_run_of_each_variation loses 14.1
# Returns only the dict of the last seed for each variation, but a dict for each training is asked for.
# -             records.append(
# -                 {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# -             )
# -     return records
# +         records.append(
# +             {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# +         )
# +     return records


# %% one_folder_for_all loses 14.1
# Puts the trainings of all variations into one folder, but each variation should have its own, folder/name.
# -             run = train("ppo", environment, Path(folder) / name, params=params, steps=steps,
# +             run = train("ppo", environment, Path(folder), params=params, steps=steps,


# %% best_post_evaluation loses 14.1
# Reports the best post-evaluation instead of the last one.
# -             result = run.evaluations().last
# +             result = float(run.evaluations().returns.mean(axis=1).max())


# %% eight_evaluations_always loses 14.1
# Post-evaluates with 5 episodes although another number is asked for: `train` should be given `evaluations` and `episodes`.
_train_variations = train_variations


def train_variations(environment, variations, seeds, steps, folder, evaluations=8, episodes=5):
    return _train_variations(environment, variations, seeds, steps, folder)


# %% train_indicators_only loses 14.2
# Leaves out the indicators whose names do not begin with "train/", but all are asked for.
# -     for name in log.Tags()["scalars"]:
# +     for name in [each for each in log.Tags()["scalars"] if each.startswith("train/")]:


# %% area_by_left_edges loses 14.3
# Multiplies each width by the mean return at its left end for "average" instead of by the mean of both ends.
# says: this
# -     area = np.sum(widths * (means[:-1] + means[1:]) / 2)
# +     area = np.sum(widths * means[:-1])


# %% area_from_zero loses 14.3
# Counts the steps before the first post-evaluation in "average", too, but the area should begin at the first one.
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float((area + steps[0] * means[0]) / steps[-1]),


# %% solved_by_the_best_episode loses 14.3
# Counts the goal as reached if the best episode reaches it, but the mean return should reach it.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# +     for when, mean in zip(steps[::-1], np.max(returns, axis=1)[::-1], strict=True):


# %% never_solved_is_zero loses 14.3
# Gives 0 as "solved" if the goal is not reached for good, but None is asked for.
# -         "solved": solved,
# +         "solved": solved or 0,


# %% last_result_counts loses 14.4
# Takes the last of several runs with the same variant and seed, but the first one should count.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         results.setdefault(run["variant"], {})[run["seed"]] = run["return"]


# %% lowest_first loses 14.4
# Begins with the row of the lowest mean, but the highest mean should come first.
# says: this
# -     for variant in sorted(means, key=means.get, reverse=True):
# +     for variant in sorted(means, key=means.get):


# %% gain_in_percent loses 14.4
# Divides the gain by the mean of the baseline, but the difference of the means is asked for.
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float((means[variant] - means[baseline]) / abs(means[baseline])),


# %% halves_only loses 14.5
# Chooses as many results for the first group as the shorter list has, but divides their sum by len(first): it should choose len(first).
# -     n, m = len(first), len(second)
# -     observed = abs(np.mean(first) - np.mean(second))
# -     ways = np.array(list(combinations(range(n + m), n)))
# +     n, m = len(first), len(second)
# +     observed = abs(np.mean(first) - np.mean(second))
# +     ways = np.array(list(combinations(range(n + m), min(n, m))))


# %% without_the_real_way loses 14.5
# Leaves the way in which it really was out of all ways, but it should be one of them.
# -     return float(np.mean(differences >= observed - 1e-9))
# +     return float(np.mean(differences[1:] >= observed - 1e-9))


# %% medians_for_means loses 14.5
# Compares the medians of the two groups instead of their means.
# -     observed = abs(np.mean(first) - np.mean(second))
# +     observed = abs(np.median(first) - np.median(second))
# -     totals = together[ways].sum(axis=1)
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     rest = [[i for i in range(n + m) if i not in way] for way in ways.tolist()]
# +     medians = np.median(together[ways], axis=1)
# +     differences = abs(medians - np.median(together[np.array(rest, dtype=int)], axis=1))


# %% step_0_left_out loses 14.6
# Leaves out what was logged at step 0, but it belongs to the first part.
# says: this
# -         if part == 0:
# -             inside |= steps == 0


# %% border_in_both loses 14.6
# Counts what was logged at the border of two parts in both, but it belongs to the earlier one only.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps * parts >= part * total) & (steps * parts <= (part + 1) * total)


# %% three_parts_always loses 14.6
# Divides the training into three parts every time instead of into `parts` parts.
# says: this
# -     means = []
# -     for part in range(parts):
# +     means, parts = [], 3
# +     for part in range(parts):


# %% signs_in_the_order_of_their_names loses 14.6
# Sorts the signs by their names, but they should come in the order of `signs`.
_warning_signs = warning_signs


def warning_signs(indicators, total, signs):
    return sorted(_warning_signs(indicators, total, signs))


# %% equal_numbers_share_the_lowest_rank loses 14.7
# Gives equal numbers the lowest of their ranks instead of the mean of their ranks.
# says: this
# -         ranks = smaller + (equal + 1) / 2
# +         ranks = smaller + (equal > 0)


# %% correlation_without_sign loses 14.7
# Leaves out the sign of the correlation, but it can be negative, too.
# says: this
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return abs(float((a * b).sum() / below)) if below > 0 else 0.0


# %% one_when_all_are_equal loses 14.7
# Gives 1 if all numbers of one array are equal, but 0 is asked for.
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return float((a * b).sum() / below) if below > 0 else 1.0


# %% last_value_for_best loses 14.8
# Gives the mean return of each post-evaluation as "best", but the best one so far is asked for.
# says: this
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": found.returns.mean(axis=1),


# %% post_evaluation_not_included loses 14.8
# Counts the steps of a post-evaluation only from the next one on, but its own "steps" should include them.
# says: this
# -         "steps": found.steps + found.lengths.sum(axis=1).cumsum(),
# +         "steps": found.steps + found.lengths.sum(axis=1).cumsum() - found.lengths.sum(axis=1),


# %% each_group_has_its_own_steps loses 14.8
# Takes the first and the last step from the last group only, but the runs of all groups should decide.
# -     curves = [curve for group in groups.values() for curve in group]
# +     curves = [*groups.values()][-1]


# %% steps_shared_by_the_seeds loses 14.1
# Divides `steps` by the number of seeds, but each training should have all `steps` steps.
# -             run = train("ppo", environment, Path(folder) / name, params=params, steps=steps,
# +             run = train("ppo", environment, Path(folder) / name, params=params, steps=steps // len(seeds),


# %% settings_kept_from_the_last_variation loses 14.1
# Keeps settings of earlier variations for the next one, but each should have only its own.
# -     for name, params in variations.items():
# -         for seed in seeds:
# +     params = {}
# +     for name, own in variations.items():
# +         params = {**params, **own}
# +         for seed in seeds:


# %% steps_from_zero loses 14.2
# Subtracts the first step of an indicator from its steps, but the steps as they were logged are asked for.
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.step - entries[0].step for entry in entries]),


# %% times_for_steps loses 14.2
# Gives the values after a NaN the steps of earlier entries, but each value should keep its own step.
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.step for entry in log.Scalars(name)][: len(entries)]),


# %% area_by_right_edges loses 14.3
# Multiplies each width by the mean return at its right end for "average" instead of by the mean of both ends.
# -     area = np.sum(widths * (means[:-1] + means[1:]) / 2)
# +     area = np.sum(widths * means[1:])


# %% solved_at_the_last_failure loses 14.3
# Gives the steps of the last post-evaluation below the goal instead of those of the next one.
# -         if mean < goal:
# -             break
# -         solved = int(when)
# +         if mean < goal:
# +             solved = int(when) if solved is not None else None
# +             break
# +         solved = int(when)


# %% deviation_of_the_mean loses 14.4
# Gives the standard error of the mean instead of the standard deviation.
# -                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
# +                 "deviation": float(np.std(values, ddof=1) / len(values) ** 0.5) if len(values) > 1 else None,


# %% sums_for_means loses 14.5
# Compares the difference of the sums in each way with the real difference of the means, but means should be compared with means.
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     differences = abs(totals - (together.sum() - totals))


# %% total_of_the_last_step loses 14.6
# Divides the steps up to the last entry into parts instead of all `total` steps of the training.
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps * parts > part * steps.max()) & (steps * parts <= (part + 1) * steps.max())


# %% covariance_of_ranks loses 14.7
# Gives the covariance of the ranks instead of their correlation.
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return float((a * b).mean()) if below > 0 else 0.0


# %% medians_within loses 14.7
# Subtracts the median of the variation instead of its mean.
# -     means = {name: numbers[names == name].mean() for name in set(variants)}
# +     means = {name: np.median(numbers[names == name]) for name in set(variants)}


# %% starts_at_the_first loses 14.8
# Begins the steps at the smallest first step of a run, but they should begin at the largest.
# -     start = max(curve["steps"][0] for curve in curves)
# +     start = min(curve["steps"][0] for curve in curves)


# %% whole_parts loses 14.6
# Rounds total / parts down to a whole number, so that parts may be too short and the last steps in none.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps > part * (total // parts)) & (steps <= (part + 1) * (total // parts))


# %% seeds_counted_over_all_variants loses 14.4
# Leaves out a run if another variation already has its seed, but only runs with the same variant and seed should count once.
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
# Takes the positions that np.argsort gives for ranks, but a rank is the place of a number in the sorted order.
# says: this
def rank_correlation(first, second):
    if np.ptp(first) == 0 or np.ptp(second) == 0:
        return 0.0
    return float(np.corrcoef(np.argsort(first), np.argsort(second))[0, 1])


# %% neighbours_only loses 14.7
# Subtracts the mean of neighbours with the same variant, but the mean of all numbers of the variant is asked for.
# says: this
def within_variants(numbers, variants):
    numbers, found, begin = np.asarray(numbers, dtype=float), [], 0
    for end in range(1, len(numbers) + 1):
        if end == len(numbers) or variants[end] != variants[begin]:
            found += list(numbers[begin:end] - numbers[begin:end].mean())
            begin = end
    return np.round(found, 9)


# %% sorted_by_variant loses 14.7
# Sorts the answer by variant, but it should be in the order of `numbers`.
# says: this
def within_variants(numbers, variants):
    numbers, names, found = np.asarray(numbers, dtype=float), np.array(variants), []
    for name in sorted(set(variants)):
        found += list(numbers[names == name] - numbers[names == name].mean())
    return np.round(found, 9)


# %% exact_comparison loses 14.5
# Leaves out some differences that equal the real one up to rounding, but those smaller by up to 1e-9 should count, too.
# says: this
# -     return float(np.mean(differences >= observed - 1e-9))
# +     return float(np.mean(differences >= observed))


# %% sums_compared loses 14.5
# Compares the sums of the two groups instead of their means.
# says: this
# -     observed = abs(np.mean(first) - np.mean(second))
# +     observed = abs(np.sum(first) - np.sum(second))
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     differences = abs(totals - (together.sum() - totals)) + 0 * m


# %% random_deals loses 14.5
# Deals the results out at random many times, but every way should be counted exactly once.
# says: this
# -     ways = np.array(list(combinations(range(n + m), n)))
# +     rng = np.random.default_rng(0)
# +     ways = np.array([rng.permutation(n + m)[:n] for _ in range(2000)])


# %% average_of_one_run loses 14.8
# Averages over the runs of a group, but each run should have a row of its own.
# says: this
# -         found[name] = np.array(reached)
# +         found[name] = np.mean(reached, axis=0)


# %% borders_belong_to_the_next loses 14.6
# Counts what was logged at the end of a part in the next one, and at `total` in none, but it belongs to the part that ends there.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = (steps * parts >= part * total) & (steps * parts < (part + 1) * total)


# %% number_of_the_post_evaluation loses 14.3
# Gives the number of the post-evaluation as "solved" instead of its steps.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# +     for when, mean in reversed(list(enumerate(means))):


# %% every_episode_reaches_the_goal loses 14.3
# Counts the goal as reached only if every episode reaches it, but it is enough if the mean return does.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# +     for when, mean in zip(steps[::-1], np.min(returns, axis=1)[::-1], strict=True):


# %% gain_over_the_best loses 14.4
# Subtracts the highest mean for "gain" instead of the mean of the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(means[variant] - max(means.values())),


# %% rows_by_name loses 14.4
# Sorts the rows by the names of the variations, but the highest mean should come first.
# says: this
# -     for variant in sorted(means, key=means.get, reverse=True):
# +     for variant in sorted(means):


# %% nan_counts loses 14.6
# Counts NaN in the mean of a part, so that the mean is NaN, but NaN should not count.
# says: this
# -         these = values[inside & ~np.isnan(values)]
# +         these = values[inside]


# %% first_third loses 14.6
# Looks for signs in the first third instead of the last.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], total, 3)[0]


# %% ranks_turned_around loses 14.7
# Gives the correlation with the wrong sign: the smallest number should have rank 1 in both arrays.
# says: this
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     return -float((a * b).sum() / below) if below > 0 else 0.0


# %% formula_without_ties loses 14.7
# Uses the short formula with the squared differences of the ranks, but it is wrong if there are equal numbers.
# says: this
# -     return float((a * b).sum() / below) if below > 0 else 0.0
# +     n = len(a)
# +     return float(1 - 6 * ((a - b) ** 2).sum() / (n * (n**2 - 1))) if below > 0 else 0.0


# %% evenly_spaced_logarithms loses 14.8
# Spaces the logarithms of the steps evenly instead of the steps themselves.
# says: this
# -     steps = np.linspace(start, end, points)
# +     steps = np.geomspace(start, end, points)


# %% all_ways_of_halves loses 14.5
# Deals the results out to two halves, but the groups should have the sizes of the two lists.
# says: this
# -     n, m = len(first), len(second)
# -     observed = abs(np.mean(first) - np.mean(second))
# +     n, m = len(first), len(second)
# +     observed = abs(np.mean(first) - np.mean(second))
# +     n, m = (n + m) // 2, n + m - (n + m) // 2


# %% variations_folder_in_the_record loses 14.1
# Gives the folder of the whole variation as "folder" instead of that of the training, str(run.path).
# says: this
# -                 {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# +                 {"variant": name, "seed": seed, "return": result, "folder": f"{folder}/{name}"}


# %% time_of_day_for_steps loses 14.2
# Gives the times at which the values were logged (wall_time) as "steps" instead of their steps.
# says: this
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.wall_time for entry in entries]),


# %% last_of_the_episodes loses 14.3
# Takes the mean of the last column of `returns` as "last" instead of that of the last row: a row is a post-evaluation.
# says: this
# -         "last": float(means[-1]),
# +         "last": float(np.mean(returns, axis=0)[-1]),


# %% repeated_runs_counted loses 14.4
# Counts every run of a variation in "runs", but several with the same seed should count as one.
# says: this
# -                 "runs": len(values),
# +                 "runs": sum(run["variant"] == variant for run in runs),


# %% one_way_less_in_the_sum loses 14.5
# Divides by the number of all ways, but does not count the way in which it really was: it should count, too.
# says: this
# -     return float(np.mean(differences >= observed - 1e-9))
# +     return float((np.sum(differences >= observed - 1e-9) - 1) / len(differences))


# %% last_value_for_the_mean loses 14.6
# Compares the last value with the limit instead of the mean of the last third.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = logged["values"][-1] if len(logged["values"]) else None


# %% argsort_for_ranks loses 14.7
# Correlates positions as np.argsort gives them: these say where the smallest number stands, and so on, but are not ranks.
# says: this
# -         ranks = smaller + (equal + 1) / 2
# +         ranks = np.argsort(numbers) + 1.0 + 0 * (smaller + equal)


# %% divided_by_the_deviation loses 14.7
# Divides by the standard deviation of the variation, too, but only its mean should be subtracted.
# says: this
def within_variants(numbers, variants, _within=within_variants):
    found, names = _within(numbers, variants), np.array(variants)
    sizes = {name: np.std(np.asarray(numbers)[names == name]) for name in set(variants)}
    by = [sizes[name] if sizes[name] > 1e-12 else 1.0 for name in variants]
    return np.round(found / np.array(by), 9)


# %% from_the_first_value_to_the_last_end loses 14.8
# Takes the smallest first step and the largest last step of all runs, but the largest first and the smallest last are asked for.
# says: this
# -     start = max(curve["steps"][0] for curve in curves)
# -     end = min(curve["steps"][-1] for curve in curves)
# +     start = min(curve["steps"][0] for curve in curves)
# +     end = max(curve["steps"][-1] for curve in curves)


# %% one_entry_for_each_step loses 14.2
# Keeps only the last of several entries with the same step, but all of them should stay.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries = {e.step: e for e in log.Scalars(name) if not np.isnan(e.value)}.values()


# %% parts_of_equally_many_entries loses 14.6
# Divides the entries without NaN into parts of equally many, but their steps should decide to which part they belong.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# -         if part == 0:
# -             inside |= steps == 0
# -         these = values[inside & ~np.isnan(values)]
# +         these = np.array_split(values[~np.isnan(values)], parts)[part]


# %% one_deviation_for_all loses 14.4
# Gives all variations the same deviation, computed from the runs of all, but each should have its own.
# says: this
_table_14 = table_of


def table_of(runs, baseline):
    rows = _table_14(runs, baseline)
    free = [max(row["runs"] - 1, 0) for row in rows]
    squares = [(row["deviation"] or 0) ** 2 * n for row, n in zip(rows, free, strict=True)]
    pooled = float(np.sqrt(sum(squares) / max(sum(free), 1)))
    return [{**row, "deviation": pooled if row["runs"] > 1 else None} for row in rows]


# %% negative_values_left_out loses 14.2
# Leaves out values below 0, but only NaN should be left out.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries = [entry for entry in log.Scalars(name) if entry.value >= 0]


# %% indicator_with_nan_left_out loses 14.2
# Leaves out an indicator as a whole if one of its values is NaN, but only such entries should be left out.
# says: this
# -     for name in log.Tags()["scalars"]:
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +     for name in log.Tags()["scalars"]:
# +         if any(np.isnan(entry.value) for entry in log.Scalars(name)):
# +             continue
# +         entries = log.Scalars(name)


# %% steps_with_nan_left_out_everywhere loses 14.2
# Leaves a step out of all indicators if one of them is NaN there, but only the entry that is NaN should be left out.
# says: this
# -     for name in log.Tags()["scalars"]:
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +     names = log.Tags()["scalars"]
# +     bad = {e.step for name in names for e in log.Scalars(name) if np.isnan(e.value)}
# +     for name in names:
# +         entries = [entry for entry in log.Scalars(name) if entry.step not in bad]


# %% names_without_groups loses 14.2
# Leaves out the part of a name before the slash, but whole names such as "train/loss" are asked for.
# says: this
# -         indicators[name] = {
# +         indicators[name.split("/")[-1]] = {


# %% nan_of_the_values_only loses 14.2
# Leaves NaN out of "values" but keeps its step in "steps": both should be left out.
# says: this
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([entry.step for entry in log.Scalars(name)]),


# %% first_of_each_step loses 14.2
# Keeps only the first of several entries with the same step, but all of them should stay.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries, seen = [], set()
# +         for entry in log.Scalars(name):
# +             if not np.isnan(entry.value) and entry.step not in seen:
# +                 seen.add(entry.step)
# +                 entries.append(entry)


# %% steps_of_the_first_indicator loses 14.2
# Gives all indicators the steps of the first one, but each should have its own.
# says: this
# -             "steps": np.array([entry.step for entry in entries]),
# +             "steps": np.array([e.step for e in log.Scalars(log.Tags()["scalars"][0])]),


# %% average_of_one_is_zero loses 14.3
# Gives 0 as "average" if there is only one post-evaluation, but its mean return is asked for.
# says: this
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float(area / widths.sum()) if len(means) > 1 else 0.0,


# %% average_by_steps_as_weights loses 14.3
# Weights the mean returns by their steps for "average" instead of taking the area under the curve, divided by its width.
# says: this
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float(np.average(means, weights=steps) if len(means) > 1 else means[0]),


# %% best_without_the_last loses 14.3
# Leaves the last post-evaluation out of "best", but it should count, too.
# says: this
# -         "best": float(means.max()),
# +         "best": float(means[:-1].max() if len(means) > 1 else means[0]),


# %% solved_if_the_last_is loses 14.3
# Takes the first post-evaluation that reaches the goal if the last one does, but those in between should reach it, too.
# says: this
# -     return {
# -         "last": float(means[-1]),
# +     if solved is not None:
# +         solved = int(steps[np.argmax(means >= goal)])
# +     return {
# +         "last": float(means[-1]),


# %% solved_is_minus_one loses 14.3
# Gives -1 as "solved" if the goal is not reached for good, but None is asked for.
# says: this
# -         "solved": solved,
# +         "solved": -1 if solved is None else solved,


# %% median_of_the_last_one loses 14.3
# Takes the median of the last post-evaluation as "last" instead of its mean.
# says: this
# -         "last": float(means[-1]),
# +         "last": float(np.median(returns[-1])),


# %% solved_steps_since_the_start loses 14.3
# Counts the steps of "solved" from the first post-evaluation instead of from the start of the training.
# says: this
# -         solved = int(when)
# +         solved = int(when) - int(steps[0])


# %% runs_of_the_whole_table loses 14.4
# Counts the runs of all variations in "runs" instead of those of the row's variation.
# says: this
# -                 "runs": len(values),
# +                 "runs": sum(map(len, results.values())),


# %% deviation_zero_for_one loses 14.4
# Gives 0 as the deviation of a single run, but None is asked for.
# says: this
# -                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
# +                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else 0.0,


# %% gain_over_the_next_row loses 14.4
# Subtracts the mean of the next row for "gain" instead of the mean of the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(
# +                     means[variant] - max([m for m in means.values() if m < means[variant]] or [0])
# +                 ),


# %% best_result_of_a_seed loses 14.4
# Takes the highest of several returns with the same variant and seed, but the first one should count.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         own = results.setdefault(run["variant"], {})
# +         own[run["seed"]] = max(own.get(run["seed"], -np.inf), run["return"])


# %% mean_result_of_a_seed loses 14.4
# Takes the mean of several returns with the same variant and seed, but only the first one should count.
# says: this
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +         own = [r for r in runs if r["variant"] == run["variant"]]
# +         mean = np.mean([r["return"] for r in own if r["seed"] == run["seed"]])
# +         results.setdefault(run["variant"], {})[run["seed"]] = mean


# %% baseline_first loses 14.4
# Begins with the row of the baseline, whatever its mean, but the highest mean should come first.
# says: this
# -     for variant in sorted(means, key=means.get, reverse=True):
# +     for variant in sorted(means, key=lambda v: (v == baseline, means[v]), reverse=True):


# %% equal_returns_count_once loses 14.4
# Counts runs of a variation with the same return only once, but runs with different seeds should all count.
# says: this
# -         values = list(results[variant].values())
# +         values = list(dict.fromkeys(results[variant].values()))


# %% last_of_the_part loses 14.6
# Takes the last value of a part instead of the mean.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         means.append(float(these[-1]) if len(these) else None)


# %% median_of_the_part loses 14.6
# Takes the median of a part instead of the mean.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         means.append(float(np.median(these)) if len(these) else None)


# %% nan_spoils_the_part loses 14.6
# Gives None for a part with a NaN in it, but the mean of its other values is asked for.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         spoiled = np.isnan(values[inside]).any()
# +         means.append(float(these.mean()) if len(these) and not spoiled else None)


# %% gaps_left_out loses 14.6
# Leaves parts that hold nothing out of the list, but None should stand in their place.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         if len(these):
# +             means.append(float(these.mean()))


# %% gap_keeps_the_last_mean loses 14.6
# Gives a part that holds nothing the mean of the part before it, but None is asked for.
# says: this
# -         means.append(float(these.mean()) if len(these) else None)
# +         means.append(float(these.mean()) if len(these) else means[-1] if means else None)


# %% nan_is_zero_in_the_mean loses 14.6
# Counts NaN as 0 in the mean of a part, but NaN should not count.
# says: this
# -         these = values[inside & ~np.isnan(values)]
# +         these = np.nan_to_num(values[inside])


# %% all_until_then loses 14.6
# Takes all that was logged until the end of a part, but only what was logged within the part should count.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# +         inside = steps * parts <= (part + 1) * total


# %% missing_is_a_sign loses 14.6
# Takes 0 for an indicator that was not logged in the last third, but it should give no sign.
# says: this
# -         if late is not None and (late > limit if side == "above" else late < limit):
# +         late = late or 0.0
# +         if late > limit if side == "above" else late < limit:


# %% second_third loses 14.6
# Looks for signs in the second third instead of the last.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], total, 3)[1]


# %% last_half loses 14.6
# Looks for signs in the last half of the training instead of its last third.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], total, 2)[-1]


# %% end_of_the_log loses 14.6
# Takes the last third of the steps up to the last entry, but the last third of all `total` steps is asked for.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         late = phase_means(logged["steps"], logged["values"], max(logged["steps"]), 3)[-1]


# %% any_value_gives_a_sign loses 14.6
# Gives a sign if a single value of the last third is beyond the limit, but the mean of the last third should be.
# says: this
# -         late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
# +         steps, values = np.asarray(logged["steps"]), np.asarray(logged["values"])
# +         values = values[3 * steps > 2 * total]
# +         late = (max(values) if side == "above" else min(values)) if len(values) else None


# %% steps_of_training_twice loses 14.8
# Adds up the training steps of all post-evaluations so far, but these already count from the start of the training.
# says: this
# -         "steps": found.steps + found.lengths.sum(axis=1).cumsum(),
# +         "steps": found.steps.cumsum() + found.lengths.sum(axis=1).cumsum(),


# %% best_of_all_at_once loses 14.8
# Gives the best of the whole training everywhere as "best", but the best so far is asked for.
# says: this
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": np.full(len(found.steps), found.returns.mean(axis=1).max()),


# %% number_of_the_generation loses 14.8
# Numbers the generations 1, 2, 3, ... in "steps" instead of taking column 0 of the stat file.
# says: this
# -         return {"steps": stat[:, 0], "best": stat[:, 2]}
# +         return {"steps": np.arange(1, len(stat) + 1), "best": stat[:, 2]}


# %% best_run_of_each_group loses 14.8
# Takes the best value of a group's runs at each step, but each run should have a row of its own.
# says: this
# -         found[name] = np.array(reached)
# +         found[name] = np.array(reached).max(axis=0)


# %% different_hands_only loses 14.5
# Counts ways that give a group the same numbers only once, but every way should count.
# says: this
# -     ways = np.array(list(combinations(range(n + m), n)))
# -     totals = together[ways].sum(axis=1)
# +     ways = np.array(sorted(set(combinations(sorted(together), n))))
# +     totals = ways.sum(axis=1)


# %% zero_is_nothing loses 14.6
# Gives no sign if the mean is exactly 0, but 0 is a number like any other.
# says: this
# -         if late is not None and (late > limit if side == "above" else late < limit):
# +         if late and (late > limit if side == "above" else late < limit):


# %% infinite_left_out loses 14.2
# Leaves out infinite values, too, but only NaN should be left out.
# says: this
# -         entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
# +         entries = [entry for entry in log.Scalars(name) if np.isfinite(entry.value)]


# %% solved_by_a_crossing loses 14.3
# Gives None as "solved" if all post-evaluations reach the goal, but the steps of the first one are asked for.
# says: this
# -     for when, mean in zip(steps[::-1], means[::-1], strict=True):
# -         if mean < goal:
# -             break
# -         solved = int(when)
# +     for i in range(1, len(means)):
# +         if means[i - 1] < goal and (means[i:] >= goal).all():
# +             solved = int(steps[i])


# %% width_from_zero loses 14.3
# Divides the area by the last step instead of the width from the first post-evaluation to the last.
# says: this
# -         "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
# +         "average": float(area / steps[-1]) if len(means) > 1 else float(means[0]),


# %% repetitions_in_the_gain loses 14.4
# Counts repeated seeds in the baseline's mean for "gain", but only the first run with each seed should count.
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
# Exchanges only results at the same place of both lists, but all ways to deal the results out should count.
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


# %% not_solved_at_step_0 loses 14.3
# Passes over step 0, but if the goal is reached from step 0 on, "solved" should be 0.
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
# Leaves out an indicator that holds only NaN, but it should stay, with two empty arrays.
# says: this
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
# Ends the name of the folder with the seed, but the folder that `train` has made is asked for: str(run.path).
# says: this
# -             records.append(
# -                 {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
# -             )
# +             path = Path(folder) / name / "ppo" / f"{environment}_{seed}"
# +             records.append(
# +                 {"variant": name, "seed": seed, "return": result, "folder": str(path)}
# +             )


# %% nan_of_all_indicators_so_far loses 14.2
# Leaves a step out of an indicator if an earlier indicator is NaN there, but only the entry that is NaN should be left out.
# says: this
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
# Weights the first and the last mean return with the whole width beside them, but half of it is asked for.
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
# Takes the lowest of several returns with the same variant and seed, but the first one should count.
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
# Leaves the first result in its group in all ways, but it should be dealt out, too: the two groups may differ in size.
# says: this
# -     ways = np.array(list(combinations(range(n + m), n)))
# +     ways = np.array([(0, *rest) for rest in combinations(range(1, n + m), n - 1)])


# %% last_sign_of_an_indicator loses 14.6
# Gives only the last of the signs of the same indicator, but each sign should count for itself.
# says: this
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
# Subtracts means of numbers that are partly changed already, but the means of the given numbers are asked for.
# says: this
import numpy as np


def within_variants(numbers, variants):
    x = np.array(numbers, dtype=float)
    names = np.array(variants)
    for i, name in enumerate(variants):
        x[i] -= x[names == name].mean()
    return x.round(9)


# %% best_so_far_of_each_episode loses 14.8
# Takes the best so far of each episode and then the mean, but the best mean of a post-evaluation so far is asked for.
# says: this
# -         "best": np.maximum.accumulate(found.returns.mean(axis=1)),
# +         "best": np.maximum.accumulate(found.returns, axis=0).mean(axis=1),


# %% equal_steps_of_each_group loses 14.8
# Takes the first and the last step from the runs of each group, but those of all groups together should decide.
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
# Counts what was logged at the border of two parts in the later one, but it belongs to the earlier one.
# says: this
# -         inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
# -         if part == 0:
# -             inside |= steps == 0
# +         inside = np.minimum(steps * parts // total, parts - 1) == part
# %% repetitions_by_their_return loses 14.4
# Takes runs with the same return for repetitions, but runs with the same variant and seed are repetitions, whatever they return.
# -     results = {}
# -     for run in runs:
# -         results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
# +     results = {}
# +     for run in runs:
# +         results.setdefault(run["variant"], {}).setdefault(run["return"], run["return"])
# %% rest_by_value loses 14.5
# Leaves results out of the second group if the first one holds an equal result, but equal results should be told apart by their places.
# -     ways = np.array(list(combinations(range(n + m), n)))
# -     totals = together[ways].sum(axis=1)
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# -     return float(np.mean(differences >= observed - 1e-9))
# +     hits = []
# +     for group in combinations(together.tolist(), n):
# +         rest = [value for value in together.tolist() if value not in group]
# +         hits.append(bool(rest) and abs(np.mean(group) - np.mean(rest)) >= observed - 1e-9)
# +     return float(np.mean(hits))
# %% variant_by_variant loses 14.7
# Returns the numbers variant by variant, but they should stay in the order of the trainings.
# -     means = {name: numbers[names == name].mean() for name in set(variants)}
# -     return np.round(numbers - np.array([means[name] for name in variants]), 9)
# +     parts = [numbers[names == name] for name in dict.fromkeys(variants)]
# +     return np.round(np.concatenate([part - part.mean() for part in parts]), 9)
# %% first_minus_second loses 14.5
# Takes the first mean minus the second with its sign, in each way and in the real one, but differences in both directions should count.
# -     observed = abs(np.mean(first) - np.mean(second))
# +     observed = np.mean(first) - np.mean(second)
# -     differences = abs(totals / n - (together.sum() - totals) / m)
# +     differences = totals / n - (together.sum() - totals) / m
# %% this_evaluation_only loses 14.8
# Adds only the steps of this post-evaluation to "steps", but those of all post-evaluations until then should be added.
# -         "steps": found.steps + found.lengths.sum(axis=1).cumsum(),
# +         "steps": found.steps + found.lengths.sum(axis=1),


# %% mean_of_all_post_evaluations loses 14.1
# Reports the mean of all post-evaluations as "return", but that of the last one is asked for.
# says: this
# -             result = run.evaluations().last
# +             result = float(run.evaluations().returns.mean())


# %% first_post_evaluation loses 14.1
# Reports the first post-evaluation as "return", but the last one is asked for.
# says: this
# -             result = run.evaluations().last
# +             result = float(run.evaluations().returns[0].mean())


# %% last_episode loses 14.1
# Reports the return of the last episode, but the mean of the last post-evaluation is asked for.
# says: this
# -             result = run.evaluations().last
# +             result = float(run.evaluations().returns[-1, -1])


# %% range_for_deviation loses 14.4
# Gives the highest return minus the lowest for "deviation", but the standard deviation is asked for.
# says: this
# -                 "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
# +                 "deviation": float(np.ptp(values)) if len(values) > 1 else None,


# %% gain_over_the_first loses 14.4
# Subtracts the mean of the first variation in `runs` for "gain" instead of the mean of the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(means[variant] - [*means.values()][0]),


# %% gain_over_all loses 14.4
# Subtracts the mean of all variations' means for "gain" instead of the mean of the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(means[variant] - np.mean([*means.values()])),


# %% gain_as_a_quotient loses 14.4
# Divides the mean by that of the baseline for "gain", but their difference is asked for.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(means[variant] / means[baseline]),


# %% gain_without_sign loses 14.4
# Gives "gain" without its sign, but it should be negative if a variation is worse than the baseline.
# says: this
# -                 "gain": float(means[variant] - means[baseline]),
# +                 "gain": float(abs(means[variant] - means[baseline])),


# %% equal_numbers_share_the_highest_rank loses 14.7
# Gives equal numbers the highest of their ranks instead of the mean of their ranks.
# says: this
# -         ranks = smaller + (equal + 1) / 2
# +         ranks = smaller + equal


# %% no_gap_after_equal_numbers loses 14.7
# Gives the next rank to the number after equal ones, as if these were one, but each should count.
# says: this
# -         ranks = smaller + (equal + 1) / 2
# +         ranks = np.unique(numbers, return_inverse=True)[1]


# %% next_value loses 14.8
# Takes the next value after each step, but the last one at or before it is asked for.
# says: this
# -             last = np.searchsorted(curve["steps"], steps, side="right") - 1
# +             last = np.searchsorted(curve["steps"], steps, side="right")
# +             last = np.minimum(last, len(curve["steps"]) - 1)


# %% nearest_value loses 14.8
# Takes the value nearest to each step, but the last one at or before it is asked for.
# says: this
# -             last = np.searchsorted(curve["steps"], steps, side="right") - 1
# +             last = abs(steps[:, None] - curve["steps"]).argmin(axis=1)


# %% end_left_out loses 14.8
# Leaves out the end itself, but it should be the last of the steps.
# says: this
# -     steps = np.linspace(start, end, points)
# +     steps = np.linspace(start, end, points, endpoint=False)


# %% steps_from_zero_on loses 14.8
# Begins the steps at 0, but they should begin at the largest first step of a run.
# says: this
# -     steps = np.linspace(start, end, points)
# +     steps = np.linspace(0, end, points)


# %% whole_steps_only loses 14.8
# Rounds the steps to whole numbers, but they should keep their fractions.
# says: this
# -     steps = np.linspace(start, end, points)
# +     steps = np.linspace(start, end, points).round()
