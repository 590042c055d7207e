"""Wrong solutions of exercise 4; building.py describes how a case is written."""


# %% sign_lost loses 4.1
# Returns the angles without their sign, as the cosine alone gives them, but they should go from -pi to pi.
# says: sign is lost|sign is wrong: negative values have lost theirs
def decode(observation):
    return {
        "angle1": float(np.arccos(np.clip(observation[0], -1, 1))),
        "angle2": float(np.arccos(np.clip(observation[2], -1, 1))),
        "speed1": float(observation[4]),
        "speed2": float(observation[5]),
    }


# %% speeds_swapped loses 4.1
# Returns the first speed as "speed2" and the second as "speed1" instead of the other way round.
# says: This is speed2|The two speeds
_decoded = decode


def decode(observation):
    state = _decoded(observation)
    return state | {"speed1": state["speed2"], "speed2": state["speed1"]}


# %% action_as_torque loses 4.2
# Returns the number of the action, but the actions 0, 1 and 2 should give a torque of -1, 0 and +1.
# says: one more than expected
def torque(action):
    return float(action)


# %% angle_from_the_ground loses 4.2
# Computes the second link's part from angle2 alone, but it should be computed from angle1 + angle2, this link's angle with straight down.
# says: counted from the first link
# -     return float(-np.cos(state["angle1"]) - np.cos(state["angle1"] + state["angle2"]))
# +     return float(-np.cos(state["angle1"]) - np.cos(state["angle2"]))


# %% rewarded_at_the_line loses 4.2
# Returns 1 instead of 0 above the line.
def reward(observation):
    return 1.0 if height(observation) > 1 else -1.0


# %% consecutive_seeds loses 4.3
# Runs seeds[0], seeds[0] + 1, ... instead of the seeds in the list.
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None):
    return _replicate(experiment_file, list(range(seeds[0], seeds[0] + len(seeds))), folder, steps)


# %% fitness_not_post_evaluated loses 4.3
# Returns the best fitness of each run instead of the best post-evaluated one.
# -     Path(folder).mkdir(parents=True, exist_ok=True)
# -     experiment = config.load(experiment_file)
# +     Path(folder).mkdir(parents=True, exist_ok=True)
# -         run = Run(experiment, seed)
# +         run = Run(config.load(experiment_file), seed)
# -         fitness[seed] = float(run.record.bestg_fitness)
# +         fitness[seed] = float(run.record.best_fitness)


# %% steps_ignored loses 4.3
# Runs the whole budget of the experiment file whatever steps is, but should end each run after so many steps.
# says: this
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None):
    return _replicate(experiment_file, seeds, folder)


# %% read_along_the_wrong_axis loses 4.4
# Reads the file as one column after another, but it holds one generation after another: six numbers for each.
# says: this
def read_stat(path):
    table = np.load(path).reshape(len(COLUMNS), -1)
    return dict(zip(COLUMNS, table, strict=True))


# %% equal_generations loses 4.5
# Compares the runs at equal generations instead of equal steps.
def curves(stats, column, budgets):
    chosen = np.linspace(0, min(len(stat["steps"]) for stat in stats) - 1, len(budgets))
    values = [stat[column][chosen.astype(int)] for stat in stats]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}


# %% generation_just_complete loses 4.5
# Leaves out a generation whose "steps" equal the budget, but it should count.
# -         stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
# +         stat[column][np.searchsorted(stat["steps"], budgets, side="left") - 1] for stat in stats


# %% population_deviation loses 4.5
# Divides by the number of runs instead of that number minus one.
# says: this
_curves = curves


def curves(stats, column, budgets):
    shrunk = np.sqrt((len(stats) - 1) / len(stats))
    band = _curves(stats, column, budgets)
    return {"mean": band["mean"], "deviation": band["deviation"] * shrunk}


# %% straight_lines loses 4.5
# Interpolates between two generations, but the value of the last generation that is complete at the budget is asked for.
# says: this
def curves(stats, column, budgets):
    values = [np.interp(budgets, stat["steps"], stat[column]) for stat in stats]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}


# %% best_episode loses 4.6
# Returns the highest return of the new episodes instead of their mean.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed, episodes).max())


# %% judged_on_old_episodes loses 4.6
# Evaluates with seed + 100_000, in the episodes of the run's own post-evaluation, instead of with test_seed.
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(seed + 100_000, episodes).mean())


# %% robots_mixed_up loses 4.6
# Returns the value of bestS<seed>.npy as "bestg" and that of bestgS<seed>.npy as "best" instead of the other way round.
# says: this
_compare = compare


def compare(experiment_file, folder, seeds, episodes, test_seed):
    rows = _compare(experiment_file, folder, seeds, episodes, test_seed)
    return [row | {"best": row["bestg"], "bestg": row["best"]} for row in rows]


# %% clears_the_folder loses 4.3
# Deletes files of other runs in the folder, but they should stay.
# says: this
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None):
    for path in Path(folder).glob("*.*"):
        path.unlink()
    return _replicate(experiment_file, seeds, folder, steps)


# %% folder_must_be_new loses 4.3
# Fails if the folder exists already, but should use this folder.
# says: this
# -     Path(folder).mkdir(parents=True, exist_ok=True)
# +     Path(folder).mkdir(parents=True)


# %% always_statS1 loses 4.4
# Reads statS1.npy instead of the file that path names.
# says: this
def read_stat(path):
    if "saved" not in str(path):
        path = "statS1.npy"
    table = np.load(path).reshape(-1, len(COLUMNS))
    return {name: table[:, column] for column, name in enumerate(COLUMNS)}


# %% rising_budgets_only loses 4.5
# Never goes back to an earlier generation if a budget is smaller than the one before it, but the budgets come in any order.
# says: this
def curves(stats, column, budgets):
    values = []
    for stat in stats:
        place, row = 0, []
        for budget in budgets:
            while place + 1 < len(stat["steps"]) and stat["steps"][place + 1] <= budget:
                place += 1
            row.append(stat[column][place])
        values.append(row)
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}


# %% best_value_so_far loses 4.5
# Takes the highest value up to the budget instead of the value of the last complete generation.
# says: this
def curves(stats, column, budgets):
    stats = [stat | {column: np.maximum.accumulate(stat[column])} for stat in stats]
    values = [
        stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
    ]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}


# %% sorted_seeds loses 4.6
# Sorts the rows by their seed instead of keeping the order of the seeds given.
# says: this
# -     for seed in seeds:
# -         stat = read_stat(Path(folder) / f"statS{seed}.npy")
# +     for seed in sorted(seeds):
# +         stat = read_stat(Path(folder) / f"statS{seed}.npy")


# %% first_generation_promises loses 4.6
# Takes the value of the first generation for "promised", but the best post-evaluated fitness of the whole run is asked for.
# says: this
# -         row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
# +         row = {"seed": seed, "promised": float(stat["best post-evaluated"][0])}


# %% one_file_kept loses 4.4
# Returns the curves of the first file again in later calls, but each call should read its own file.
_read, _kept = read_stat, []


def read_stat(path):
    if not _kept:
        _kept.append(_read(path))
    return _kept[0]


# %% skips_what_is_there loses 4.3
# Skips a seed whose files are in the folder already, but it should run again and replace them.
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None):
    fitness = {}
    for seed in seeds:
        path = Path(folder) / f"statS{seed}.npy"
        if path.exists():
            fitness[seed] = float(np.load(path)[-4])
        else:
            fitness |= _replicate(experiment_file, [seed], folder, steps)
    return fitness


# %% fitness_of_earlier_calls loses 4.3
# Returns the seeds of earlier calls, too, but the dict should hold only the seeds of this call.
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None, fitness={}):  # noqa: B006
    fitness.update(_replicate(experiment_file, seeds, folder, steps))
    return fitness


# %% median_of_the_episodes loses 4.6
# Takes the median of the returns instead of their mean.
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(np.median(robot.evaluate(test_seed, episodes)))


# %% spread_of_the_mean loses 4.5
# Divides the standard deviation by the root of the number of runs, but the standard deviation itself is asked for.
_curves = curves


def curves(stats, column, budgets):
    band = _curves(stats, column, budgets)
    return band | {"deviation": band["deviation"] / np.sqrt(len(stats))}


# %% next_generation loses 4.5
# Takes the first generation that ends at or after the budget instead of the last one that is complete by then.
# -     values = [
# -         stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
# -     ]
# +     places = [np.searchsorted(stat["steps"], budgets) for stat in stats]
# +     values = [s[column][np.minimum(p, len(s[column]) - 1)] for s, p in zip(stats, places)]


# %% last_generation_missing loses 4.4
# Leaves out the last generation, but all generations are asked for.
# -     table = np.load(path).reshape(-1, len(COLUMNS))
# +     table = np.load(path).reshape(-1, len(COLUMNS))[:-1]


# %% either_side_of_the_line loses 4.2
# Returns 0 for a free end more than 1 below the nail, too, but only a free end above the line should give 0.
# -     return 0.0 if height(observation) > 1 else -1.0
# +     return 0.0 if abs(height(observation)) > 1 else -1.0


# %% uses_up_the_seeds loses 4.3
# Empties the list `seeds` that it is given, but should leave it as it is.
# -     for seed in seeds:
# -         run = Run(experiment, seed)
# +     while seeds:
# +         seed = seeds.pop(0)
# +         run = Run(experiment, seed)


# %% rewarded_on_the_line loses 4.2
# Returns 0 for a free end exactly on the line, but only a free end above the line should give 0.
# says: this
# -     return 0.0 if height(observation) > 1 else -1.0
# +     c1, s1, c2, s2 = observation[:4]
# +     return 0.0 if -c1 - (c1 * c2 - s1 * s2) >= 1 else -1.0


# %% arc_tangent_of_the_ratio loses 4.1
# Returns angles from -pi/2 to pi/2 only, as the arc tangent of sine / cosine gives them, but angles from -pi to pi are asked for.
# says: this
# -         "angle1": float(np.arctan2(sin1, cos1)),
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle1": float(np.arctan(sin1 / cos1)),
# +         "angle2": float(np.arctan(sin2 / cos2)),


# %% nearest_generation loses 4.5
# Takes the generation nearest to the budget, even if it is not complete by then, but the last complete one is asked for.
# says: this
def curves(stats, column, budgets):
    values = [
        [stat[column][np.argmin(np.abs(stat["steps"] - budget))] for budget in budgets]
        for stat in stats
    ]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}


# %% best_fitness_promises loses 4.6
# Takes the best fitness of the run for "promised" instead of its best post-evaluated fitness.
# says: this
# -         row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
# +         row = {"seed": seed, "promised": float(stat["best fitness"][-1])}


# %% episodes_of_the_run loses 4.6
# Evaluates with the seed of the run instead of test_seed.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(seed, episodes).mean())


# %% angles_in_degrees loses 4.1
# Returns the angles in degrees instead of radians.
# says: this
# -         "angle1": float(np.arctan2(sin1, cos1)),
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle1": float(np.degrees(np.arctan2(sin1, cos1))),
# +         "angle2": float(np.degrees(np.arctan2(sin2, cos2))),


# %% arc_sine loses 4.1
# Returns angles from -pi/2 to pi/2 only, as the sine alone gives them, but angles from -pi to pi are asked for.
# says: this
# -         "angle1": float(np.arctan2(sin1, cos1)),
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle1": float(np.arcsin(sin1)),
# +         "angle2": float(np.arcsin(sin2)),


# %% second_angle_from_straight_down loses 4.1
# Returns angle1 + angle2, counted from straight down, as "angle2", but angle2 should be counted from the first link.
# says: this
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle2": float(np.arctan2(sin1, cos1) + np.arctan2(sin2, cos2)),


# %% line_at_the_nail loses 4.2
# Returns 0 for every free end above the nail, but only a free end above the line, at height 1, should give 0.
# says: this
# -     return 0.0 if height(observation) > 1 else -1.0
# +     return 0.0 if height(observation) > 0 else -1.0


# %% rows_for_columns loses 4.4
# Takes row i of the table for COLUMNS[i] instead of column i.
# says: this
# -     return {name: table[:, column] for column, name in enumerate(COLUMNS)}
# +     return {name: table[column] for column, name in enumerate(COLUMNS)}


# %% budgets_sorted loses 4.5
# Returns the values in the order of rising budgets instead of the order of the budgets given.
# says: this
# -     values = [
# -         stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
# -     ]
# +     budgets = np.sort(budgets)
# +     values = [
# +         stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
# +     ]


# %% test_seed_and_seed loses 4.6
# Adds the seed of the run to test_seed, but the robots of all runs should meet the episodes of test_seed.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed + seed, episodes).mean())


# %% height_from_the_lowest_point loses 4.2
# Measures the height from the lowest point that the arm reaches instead of from the nail.
# says: this
# -     return float(-np.cos(state["angle1"]) - np.cos(state["angle1"] + state["angle2"]))
# +     return float(2 - np.cos(state["angle1"]) - np.cos(state["angle1"] + state["angle2"]))


# %% one_for_success loses 4.2
# Returns 1 above the line and 0 otherwise, but 0 and -1 are asked for.
# says: this
# -     return 0.0 if height(observation) > 1 else -1.0
# +     return 1.0 if height(observation) > 1 else 0.0


# %% other_episodes_for_each_robot loses 4.6
# Evaluates "bestg" with test_seed + 1, but both robots should meet the episodes of test_seed.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed + (kind == "bestg"), episodes).mean())


# %% second_angle_put_back loses 4.1
# Counts "angle2" from straight down (between -pi and pi), but it should be counted from the first link.
# says: this
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle2": float(np.arctan2(sin1 * cos2 + cos1 * sin2, cos1 * cos2 - sin1 * sin2)),


# %% average_fitness_of_the_end loses 4.3
# Returns the average fitness of the last generation instead of the best post-evaluated fitness.
# says: this
# -         fitness[seed] = float(run.record.bestg_fitness)
# +         fitness[seed] = float(np.load(Path(folder) / f"statS{seed}.npy")[-2])


# %% best_of_the_runs_so_far loses 4.3
# Returns the best of this run and those before it for each seed, but each run's own value is asked for.
# says: this
# -     fitness = {}
# +     fitness, best = {}, -np.inf
# -         fitness[seed] = float(run.record.bestg_fitness)
# +         best = max(best, float(run.record.bestg_fitness))
# +         fitness[seed] = best


# %% angles_in_turns loses 4.1
# Returns the angles in turns, but radians are asked for.
# says: this
# -         "angle1": float(np.arctan2(sin1, cos1)),
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle1": float(np.arctan2(sin1, cos1) / (2 * np.pi)),
# +         "angle2": float(np.arctan2(sin2, cos2) / (2 * np.pi)),


# %% from_straight_up loses 4.1
# Counts the first angle from straight up instead of from straight down.
# says: this
# -         "angle1": float(np.arctan2(sin1, cos1)),
# +         "angle1": float(np.arctan2(-sin1, -cos1)),


# %% second_minus_first loses 4.1
# Subtracts the first angle from the second, but the second is counted from the first link already.
# says: this
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle2": float(np.arctan2(sin2, cos2) - np.arctan2(sin1, cos1)),


# %% speed_sum loses 4.1
# Adds the first speed to the second, but the second alone is asked for.
# says: this
# -         "speed2": speed2,
# +         "speed2": speed1 + speed2,


# %% first_angle_rounded loses 4.1
# Rounds the first angle to two places, but the exact angle is asked for.
# says: this
# -         "angle1": float(np.arctan2(sin1, cos1)),
# +         "angle1": round(float(np.arctan2(sin1, cos1)), 2),


# %% first_angle_twice loses 4.1
# Returns the first angle as "angle2", too, but the second angle is asked for.
# says: this
# -         "angle2": float(np.arctan2(sin2, cos2)),
# +         "angle2": float(np.arctan2(sin1, cos1)),


# %% cosines_before_sines loses 4.1
# Reads the observation as cos1, cos2, sin1, sin2 instead of cos1, sin1, cos2, sin2.
# says: this
# -     cos1, sin1, cos2, sin2, speed1, speed2 = (float(value) for value in observation)
# +     cos1, cos2, sin1, sin2, speed1, speed2 = (float(value) for value in observation)


# %% average_promises loses 4.6
# Takes the average fitness of the last generation for "promised" instead of the best post-evaluated fitness.
# says: this
# -         row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
# +         row = {"seed": seed, "promised": float(stat["average"][-1])}


# %% mean_promises loses 4.6
# Takes the mean of "best post-evaluated" over all generations for "promised" instead of its last value.
# says: this
# -         row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
# +         row = {"seed": seed, "promised": float(stat["best post-evaluated"].mean())}


# %% first_episode_only loses 4.6
# Takes the return of the first new episode alone instead of the mean of all.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed, episodes)[0])


# %% last_episode_only loses 4.6
# Takes the return of the last new episode alone instead of the mean of all.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed, episodes)[-1])


# %% ten_episodes_always loses 4.6
# Evaluates in 10 episodes whatever the argument episodes is.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed, 10).mean())


# %% robots_of_the_first_seed loses 4.6
# Evaluates the robots of the first seed for all seeds, but each seed has robots of its own.
# says: this
# -             robot = SavedRobot(experiment_file, np.load(Path(folder) / f"{kind}S{seed}.npy"))
# +             robot = SavedRobot(experiment_file, np.load(Path(folder) / f"{kind}S{seeds[0]}.npy"))


# %% best_for_both loses 4.6
# Evaluates bestS<seed>.npy for "bestg", too, but bestgS<seed>.npy is asked for.
# says: this
# -             robot = SavedRobot(experiment_file, np.load(Path(folder) / f"{kind}S{seed}.npy"))
# +             robot = SavedRobot(experiment_file, np.load(Path(folder) / f"bestS{seed}.npy"))


# %% seed_for_each_episode loses 4.6
# Evaluates each episode alone, with the seeds test_seed, test_seed + 1, ..., but evaluate should be called once, with test_seed and episodes.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(np.mean([robot.evaluate(test_seed + i, 1)[0] for i in range(episodes)]))


# %% test_seed_plus_one loses 4.6
# Evaluates both robots with test_seed + 1 instead of test_seed.
# says: this
# -             row[kind] = float(robot.evaluate(test_seed, episodes).mean())
# +             row[kind] = float(robot.evaluate(test_seed + 1, episodes).mean())


# %% one_generation_too_early loses 4.5
# Takes the generation before the last one that is complete at the budget, but the last complete one is asked for.
# says: this
# -         stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
# +         stat[column][np.maximum(np.searchsorted(stat["steps"], budgets, side="right") - 2, 0)] for stat in stats


# %% arcsine_mirrored loses 4.1
# Returns angles from -pi/2 to 3 pi/2, but they should go from -pi to pi.
# says: this
def decode(observation):
    def angle(c, s):
        a = np.arcsin(np.clip(s, -1.0, 1.0))
        if c < 0:
            a = np.pi - a
        return float(a)

    c1, s1, c2, s2, w1, w2 = [float(v) for v in observation]
    return {"angle1": angle(c1, s1), "angle2": angle(c2, s2), "speed1": w1, "speed2": w2}


# %% how_far_to_the_side loses 4.2
# Returns how far the free end is to the side of the nail instead of how high it is above it.
# says: this
def height(observation: np.ndarray) -> float:
    cos1, sin1, cos2, sin2 = (float(x) for x in observation[:4])
    elbow = complex(cos1, sin1)
    tip = elbow + elbow * complex(cos2, sin2)
    return tip.imag


# %% turned_back_by_half loses 4.2
# Changes angle1 + angle2 by pi where it lies beyond -pi or pi, but only a whole turn (2 pi) leaves its cosine as it is.
# says: this
def height(observation: np.ndarray) -> float:
    arm = decode(observation)
    first = arm["angle1"]
    second = first + arm["angle2"]
    if second > np.pi:
        second -= np.pi
    elif second < -np.pi:
        second += np.pi
    h = 0.0
    for angle in (first, second):
        h -= np.cos(angle)
    return float(h)


# %% first_run_decides loses 4.5
# Looks up the generation of a budget in the first run and takes it for all runs, but each run has steps of its own.
# says: this
def curves(stats: list[dict], column: str, budgets: np.ndarray) -> dict:
    budgets = np.asarray(budgets)
    generation = np.array([np.count_nonzero(stats[0]["steps"] <= b) - 1 for b in budgets])
    values = np.vstack(
        [stat[column][np.minimum(generation, len(stat[column]) - 1)] for stat in stats]
    )
    return {"mean": values.mean(axis=0), "deviation": values.std(axis=0, ddof=1)}


# %% one_dict_for_all_rows loses 4.6
# Returns the numbers of the last seed in every row, but each row should be a new dict with the numbers of its own seed.
# says: this
def compare(
    experiment_file: str, folder: str, seeds: list[int], episodes: int, test_seed: int
) -> list[dict]:
    def worth(name):
        robot = SavedRobot(experiment_file, np.load(Path(folder, name)))
        returns = robot.evaluate(test_seed, episodes)
        return float(sum(returns) / len(returns))

    table = []
    row = {}
    for seed in seeds:
        row["seed"] = seed
        row["promised"] = float(max(read_stat(f"{folder}/statS{seed}.npy")["best post-evaluated"]))
        row["best"] = worth(f"bestS{seed}.npy")
        row["bestg"] = worth(f"bestgS{seed}.npy")
        table.append(row)
    return table


# %% angles_unwrapped_together loses 4.1
# Brings the second angle within pi of the first by whole turns, as np.unwrap does, but both should go from -pi to pi.
# says: this
def decode(observation: np.ndarray) -> dict:
    numbers = np.asarray(observation, dtype=float)
    # no jumps from pi to -pi
    angles = np.unwrap(np.arctan2(numbers[1:4:2], numbers[0:4:2]))
    return {
        "angle1": float(angles[0]),
        "angle2": float(angles[1]),
        "speed1": float(numbers[4]),
        "speed2": float(numbers[5]),
    }


# %% sign_of_the_other_link loses 4.1
# Takes the sign of the second angle from the sine of the first, but it should come from the sine of the second.
# says: this
import math


def decode(observation: np.ndarray) -> dict:
    c1, s1, c2, _, v1, v2 = map(float, observation)
    theta1 = math.acos(max(-1.0, min(1.0, c1)))
    if s1 < 0:
        theta1 = -theta1
    theta2 = math.acos(max(-1.0, min(1.0, c2)))
    if s1 < 0:
        theta2 = -theta2
    return {"angle1": theta1, "angle2": theta2, "speed1": v1, "speed2": v2}


# %% whole_table_as_integers loses 4.4
# Makes integers of all numbers in the file, but their fractions should stay.
# says: this
# -     table = np.load(path).reshape(-1, len(COLUMNS))
# +     table = np.load(path).astype(int).reshape(-1, len(COLUMNS))


# %% fitness_of_the_first_generation loses 4.3
# Returns the best post-evaluated fitness of the first generation, but that of the whole run is asked for.
# says: this
def run_replications(
    experiment_file: str, seeds: list[int], folder: str, steps: int | None = None
) -> dict:
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    answer = dict.fromkeys(seeds)
    for seed in answer:
        evolve(Run(config.load(experiment_file), seed), out, steps)
        numbers = np.load(out / f"statS{seed}.npy")
        answer[seed] = float(numbers[COLUMNS.index("best post-evaluated")])
    return answer


# %% best_of_the_stat_file loses 4.6
# Takes the best fitness in the stat file for "best", but the mean return of bestS<seed>.npy in the episodes of test_seed is asked for.
# says: this
# -         for kind in ("best", "bestg"):
# +         row["best"] = float(stat["best fitness"][-1])
# +         for kind in ("bestg",):


# %% end_of_the_first_link loses 4.2
# Returns the height of the first link's end, but the height of the free end is asked for.
# -     return float(-np.cos(state["angle1"]) - np.cos(state["angle1"] + state["angle2"]))
# +     return float(-np.cos(state["angle1"]))


# %% best_of_the_last_generation loses 4.3
# Returns the best fitness of the last generation instead of the best post-evaluated fitness.
# -         fitness[seed] = float(run.record.bestg_fitness)
# +         fitness[seed] = float(np.load(Path(folder) / f"statS{seed}.npy")[-3])


# %% all_numbers_of_the_file loses 4.4
# Returns all numbers of the file under each name, but those of one column are asked for.
# -     return {name: table[:, column] for column, name in enumerate(COLUMNS)}
# +     return {name: table.ravel() for column, name in enumerate(COLUMNS)}
