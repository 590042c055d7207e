"""Wrong solutions of exercise 15; building.py describes how a case is written."""

# %% caught_or_not loses 15.1
# Gives the predator a fitness of 1 for every catch, however long it takes, but 1 - T / maxsteps is asked for.
_chase = chase


def chase(predator, prey, maxsteps=2000):
    found = _chase(predator, prey, maxsteps)
    return {**found, "fitness": float(found["caught"])}


# %% caught_when_done loses 15.1
# Gives True for "caught" even if the time is up and the prey was not caught.
_chase = chase


def chase(predator, prey, maxsteps=2000):
    return {**_chase(predator, prey, maxsteps), "caught": True}


# %% memory_goes_on loses 15.1
# Begins a chase with what the networks remember from an earlier one, but each chase should begin with new networks.
# says: from call to call
_robot = robot
_known = {}


def robot(genotype):
    key = genotype.tobytes()
    if key not in _known:
        _known[key] = _robot(genotype)
    return _known[key]


# %% minds_swapped loses 15.1
# Gives the predator's network what the prey senses, and the prey's network what the predator senses.
def chase(predator, prey, maxsteps=2000):
    arena = arenas.make("predprey", max_steps=maxsteps)
    networks = robot(predator), robot(prey)
    poses, fitness = [arena.robots.copy()], 0.0
    while not arena.done:
        for k, network in enumerate(networks):
            network.observation = arena.observation[24 * (1 - k) :][:24]
        arena.action = np.concatenate([network.step() for network in networks])
        fitness += arena.step()
        poses.append(arena.robots.copy())
    return {"poses": np.array(poses), "caught": arena.terminated, "fitness": fitness}


# %% poses_not_copied loses 15.1
# Gives the last poses for every step, but those at the start and after each step are asked for (arena.robots changes: copy it each time).
# says: this
_chase = chase


def chase(predator, prey, maxsteps=2000):
    found = _chase(predator, prey, maxsteps)
    found["poses"] = np.tile(found["poses"][-1], (len(found["poses"]), 1, 1))
    return found


# %% fitness_of_the_prey loses 15.2
# Gives the prey's fitness instead of the predator's.
# says: this
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    return 1 - _tournament(predators, prey, maxsteps)


# %% individuals_together loses 15.2
# Puts the axes in the order (G, H, n, m), but (G, n, H, m) is asked for.
# says: this
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    return _tournament(predators, prey, maxsteps).swapaxes(1, 2)


# %% only_contemporaries loses 15.2
# Gives 0 for predators and prey of different generations, but the fitness of all pairs is asked for.
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    table = _tournament(predators, prey, maxsteps)
    same = np.arange(len(predators))[:, None] == np.arange(len(prey))
    return table * same[:, None, :, None]


# %% prey_outside loses 15.2
# Fills the table predator by predator with results in the order prey by prey, so that they belong to other pairs.
# -     pairs = np.array([(i, j) for i in range(len(hunters)) for j in range(len(hunted))])
# +     pairs = np.array([(i, j) for j in range(len(hunted)) for i in range(len(hunters))])


# %% failures_left_out loses 15.3
# Leaves chases with a fitness of 0 out of the mean, but all chases count.
# -     mean = table.mean(axis=(1, 3))
# +     caught = np.maximum((table > 0).sum(axis=(1, 3)), 1)
# +     mean = table.sum(axis=(1, 3)) / caught


# %% prey_not_turned loses 15.3
# Leaves the generations of predators in the rows of the prey's matrix, but its rows should be the generations of prey.
# says: this
# -     return {"predators": mean, "prey": 1 - mean.T}
# +     return {"predators": mean, "prey": 1 - mean}


# %% prey_want_to_be_caught loses 15.3
# Gives the predators' fitness in the prey's matrix, but 1 minus that is asked for.
# says: this
# -     return {"predators": mean, "prey": 1 - mean.T}
# +     return {"predators": mean, "prey": mean.T}


# %% asks_the_tool loses 15.3, 15.5, 15.7
# Gives the answers of botschool.analysis.tournament instead of those that the task describes.
from botschool.analysis import tournament as tool


def master(table):
    predators, prey = tool.summarised(table.swapaxes(1, 2), seed=0)
    return {"predators": predators.mean, "prey": prey.mean}


def progress(matrix):
    historical, everywhere = tool.historical_progress(matrix), tool.global_progress(matrix)
    return {"historical": historical, "global": everywhere, "share": float(historical > 0)}


def interval(table, measure, rng, resamples=300):
    predators, _ = tool.summarised(table.swapaxes(1, 2), seed=int(rng.integers(1000)))
    samples = [measure(sample[:, None, :, None]) for sample in predators.samples[:resamples]]
    return tool.interval(np.array(samples))


# %% ancient_with_the_present loses 15.4
# Counts the present competitors among both the ancient and the future ones, but they belong to neither.
_profile = profile


def profile(matrix):
    count = len(matrix)
    ancient = [matrix[g, : g + 1].mean() for g in range(1, count)]
    future = [matrix[g, g:].mean() for g in range(count - 1)]
    return {**_profile(matrix), "ancient": ancient, "future": future}


# %% competitors_in_rows loses 15.4
# Averages over column g for generation g, but its competitors are in row g.
# says: this
_profile = profile


def profile(matrix):
    return _profile(np.transpose(matrix))


# %% against_the_first loses 15.5
# Compares each generation with the first one for "historical" and "global", but a comparison with its predecessor is asked for.
_progress = progress


def progress(matrix):
    gain = matrix[1:] - matrix[0]
    historical = np.array([row[:g].mean() for g, row in enumerate(gain, 1)])
    return {**_progress(matrix), "historical": historical, "global": gain.mean(axis=1)}


# %% draws_are_won loses 15.5
# Counts a draw as a match that was won, but nobody wins a draw.
# -     wins = matrix > matrix.T
# +     wins, count = matrix >= matrix.T, len(matrix)
# -         for c in range(len(matrix))
# +         for c in range(count)


# %% equal_is_not_better loses 15.5
# Counts a case in which both do equally well as 0 in "share", but it should count half.
# says: this
_progress = progress


def progress(matrix):
    cases = np.concatenate([row[:g] for g, row in enumerate(np.diff(matrix, axis=0), 1)])
    return {**_progress(matrix), "share": float(np.mean(cases > 0))}


# %% one_way_round loses 15.5
# Counts only cycles in which a beats b, b beats c and c beats a (a < b < c), but those the other way round count, too.
# -     wins = matrix > matrix.T
# +     wins, count = matrix > matrix.T, len(matrix)
# -         (wins[a, b] and wins[b, c] and wins[c, a]) or (wins[b, a] and wins[c, b] and wins[a, c])
# -         for c in range(len(matrix))
# +         wins[a, b] and wins[b, c] and wins[c, a]
# +         for c in range(count)


# %% present_is_ancient loses 15.5
# Counts the present competitors among the ancient ones, but only those with k < g are ancient.
_progress = progress


def progress(matrix):
    cases = [row[: g + 1] for g, row in enumerate(np.diff(matrix, axis=0), 1)]
    better = np.concatenate(cases)
    share = float(np.mean((better > 0) + 0.5 * (better == 0)))
    historical = np.array([row.mean() for row in cases])
    return {**_progress(matrix), "historical": historical, "share": share}


# %% first_competitors_only loses 15.6
# Takes only generation 0 of the side that is held still, but the mean over all its generations is asked for.
_red_queen = red_queen


def red_queen(matrix):
    first = matrix[0, 0]
    return {**_red_queen(matrix), "own": matrix[1:, 0] - first, "others": matrix[0, 1:] - first}


# %% sides_mistaken loses 15.6
# Gives the part of the others as "own", and the own part as "others".
# says: this
_red_queen = red_queen


def red_queen(matrix):
    parts = _red_queen(matrix)
    return {**parts, "own": parts["others"], "others": parts["own"]}


# %% steps_added_up loses 15.6
# Adds up the gains from each generation to the next against competitors of those two times, but a comparison with generation 0 against all competitors is asked for.
_red_queen = red_queen


def red_queen(matrix):
    before, after = np.diag(matrix)[:-1], np.diag(matrix)[1:]
    own = np.cumsum((np.diag(matrix, -1) - before + after - np.diag(matrix, 1)) / 2)
    parts = _red_queen(matrix)
    return {**parts, "own": own, "others": parts["change"] - own}


# %% the_rest_is_theirs loses 15.6
# Takes the change minus the own part as "others", but the two parts need not add up to the change.
_red_queen = red_queen


def red_queen(matrix):
    parts = _red_queen(matrix)
    return {**parts, "others": parts["change"] - parts["own"]}


# %% bell_shaped loses 15.7
# Gives the mean of the measures plus and minus 1.96 standard deviations, but their 2.5 % and 97.5 % quantiles are asked for.
_interval = interval


def interval(table, measure, rng, resamples=300):
    kept = []

    def keeping(resample):
        kept.append(measure(resample))
        return kept[-1]

    _interval(table, keeping, rng, resamples)
    return np.mean(kept) - 1.96 * np.std(kept), np.mean(kept) + 1.96 * np.std(kept)


# %% the_same_for_all loses 15.7
# Draws only n predators and m prey in each resample, the same for all generations, but the sizes (G, n) and (H, m) are asked for.
def interval(table, measure, rng, resamples=300):
    measures = []
    for _ in range(resamples):
        own, met = (
            rng.integers(table.shape[1], size=table.shape[1]),
            rng.integers(table.shape[3], size=table.shape[3]),
        )
        measures.append(measure(table[:, own][..., met]))
    return tuple(np.quantile(measures, [0.025, 0.975]))


# %% without_replacement loses 15.7
# Draws without replacement, so that each resample holds all individuals in another order, but drawing with replacement is asked for.
class _Shuffled:
    def __init__(self, rng):
        self._rng = rng

    def integers(self, high, size):
        return self._rng.permuted(np.tile(np.arange(high), (size[0], 1)), axis=1)


_interval = interval


def interval(table, measure, rng, resamples=300):
    return _interval(table, measure, _Shuffled(rng), resamples)


# %% after_the_step loses 15.8
# Measures "wall" and "distance" at the end of each step instead of its beginning.
_describe = describe


def describe(poses):
    after = poses[1:, :, :2]
    return {
        **_describe(poses),
        "wall": (np.minimum(after, 3000 - after).min(axis=-1) < 300).mean(axis=0),
        "distance": float(np.linalg.norm(after[:, 0] - after[:, 1], axis=1).mean()),
    }


# %% facing_a_right_angle loses 15.8
# Counts the other robot as faced if it is less than 90 degrees to the left or right, but less than 45 degrees is asked for.
_describe = describe


def describe(poses):
    before = poses[:-1]
    away = before[:, ::-1, :2] - before[..., :2]
    ahead = away[..., 0] * np.cos(before[..., 2]) + away[..., 1] * np.sin(before[..., 2])
    return {**_describe(poses), "facing": (ahead > 0).mean(axis=0)}


# %% per_step loses 15.8
# Gives the speed in mm per step instead of mm per second.
# says: this
_describe = describe


def describe(poses):
    found = _describe(poses)
    return {**found, "speed": found["speed"] / 10}


# %% rest_is_backwards loses 15.8
# Counts a step without movement along the heading as backwards, but the movement should be below 0.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    heading, moved = before[..., 2], poses[1:, :, :2] - before[..., :2]
    forward = moved[..., 0] * np.cos(heading) + moved[..., 1] * np.sin(heading)
    found["backwards"] = (forward <= 0).mean(axis=0)
    return found


# %% turning_leaps loses 15.8
# Takes the plain difference of two headings, so that from 359 to 1 degree counts as 358 degrees, but the short way around is asked for.
_describe = describe


def describe(poses):
    turning = np.abs(np.diff(poses[..., 2], axis=0)).mean(axis=0) / 0.1
    return {**_describe(poses), "turning": turning}


# %% two_walls_only loses 15.8
# Leaves out the upper and the right wall, but all four walls count.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    found["wall"] = (before[..., :2].min(axis=-1) < 300).mean(axis=0)
    return found


# %% wall_after_the_step loses 15.8
# Measures "wall" at the end of each step instead of its beginning.
_describe = describe


def describe(poses):
    found, _before = _describe(poses), poses[:-1]
    after = poses[1:]
    to_wall = np.minimum(after[..., :2], 3000 - after[..., :2]).min(axis=-1)
    found["wall"] = (to_wall < 300).mean(axis=0)
    return found


# %% wall_includes_its_limit loses 15.8
# Counts a robot exactly 300 mm from a wall as near, but nearer than 300 mm is asked for.
# says: this
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
    found["wall"] = (to_wall <= 300).mean(axis=0)
    return found


# %% quantiles_of_ninety loses 15.7
# Takes the quantiles 0.05 and 0.95, which hold 90 % of the measures, but 0.025 and 0.975 are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.quantile(measures, [0.05, 0.95])


# %% predators_alone_are_drawn loses 15.7
# Resamples only the predators and leaves the prey as they are, but both should be drawn anew.
# says: this
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         measures.append(measure(drawn))


# %% prey_drawn_first loses 15.7
# Draws the prey before the predators, but the predators should be drawn first.
# says: this
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunted, hunters = rng.integers(m, size=(columns, m)), rng.integers(n, size=(rows, n))


# %% smallest_and_largest loses 15.7
# Returns the smallest and the largest measure instead of the quantiles.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.min(measures), np.max(measures)


# %% last_individual_never_drawn loses 15.7
# Never draws the last of several individuals, but all should be drawn: rng.integers(n) gives numbers from 0 to n - 1.
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters = rng.integers(max(n - 1, 1), size=(rows, n))
# +         hunted = rng.integers(max(m - 1, 1), size=(columns, m))


# %% last_pose_missing loses 15.1
# Leaves out the poses after the last step, but those at the start and after each of the T steps are asked for.
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     return {"poses": np.array(poses[:-1]), "caught": arena.terminated, "fitness": float(fitness)}


# %% two_thousand_steps_always loses 15.1
# Lets a chase last up to 2000 steps, but at most maxsteps steps are asked for.
# -     arena = arenas.make("predprey", max_steps=maxsteps)
# +     arena = arenas.make("predprey", max_steps=2000)


# %% one_prey_a_generation loses 15.2
# Gives the result against the first prey of a generation for all its prey, but each of them should play.
# -     pairs = np.array([(i, j) for i in range(len(hunters)) for j in range(len(hunted))])
# +     m = len(prey[0])
# +     pairs = np.array([(i, j // m * m) for i in range(len(hunters)) for j in range(len(hunted))])


# %% two_thousand_in_the_tournament loses 15.2
# Lets the tournament's chases last up to 2000 steps, but at most maxsteps steps are asked for.
# -     fitness = play(hunters, hunted, pairs, maxsteps)
# +     fitness = play(hunters, hunted, pairs, 2000)


# %% best_individuals loses 15.3
# Counts only the best predator of a generation against each prey, but the mean over all individuals is asked for.
# says: this
# -     mean = table.mean(axis=(1, 3))
# +     mean = table.max(axis=1).mean(axis=2)


# %% mean_of_the_first_only loses 15.3
# Counts only the first prey of each generation, but the mean over all individuals is asked for.
# says: this
# -     mean = table.mean(axis=(1, 3))
# +     mean = table.mean(axis=1)[:, :, 0]


# %% future_and_ancient_swapped loses 15.4
# Gives the means over future competitors as "ancient", and those over ancient ones as "future".
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array([matrix[g, :g].mean() for g in range(1, count)]),


# %% last_generation_only loses 15.4
# Counts only the generation just before as ancient, but all earlier ones are ancient.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, g - 1] for g in range(1, count)]),


# %% global_without_the_present loses 15.5
# Leaves the competitors of generation g out of "global", but those of all generations are asked for.
# says: this
# -         "global": gain.mean(axis=1),
# +         "global": np.array([np.delete(row, g).mean() for g, row in enumerate(gain, 1)]),


# %% share_of_the_means loses 15.5
# Counts for "share" the generations whose mean gain is above 0 (a mean of 0 counts nothing), but single cases should be counted.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean([row.mean() > 0 for row in ancient])),


# %% every_triple_twice loses 15.5
# Gives twice the share of the cycles, but each cycle should count once.
# says: this
# -     return float(np.mean(triples)) if triples else 0.0
# +     return 2 * float(np.mean(triples)) if triples else 0.0


# %% no_group_is_a_cycle loses 15.5
# Gives 1 if there is no group of three generations, but 0 is asked for.
# -     return float(np.mean(triples)) if triples else 0.0
# +     return float(np.mean(triples)) if triples else 1.0


# %% change_from_generation_to_generation loses 15.6
# Gives the change from each generation to the next, but that since the first generation is asked for.
# says: this
# -         "change": np.diag(matrix)[1:] - matrix[0, 0],
# +         "change": np.diff(np.diag(matrix)),


# %% own_against_the_present loses 15.6
# Takes only the competitors of generation g for "own", but the mean over those of all generations is asked for.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.diag(matrix[1:, 1:]) - matrix[0, 1:],


# %% one_draw_for_both_sides loses 15.7
# Takes the numbers that were drawn for the predators for the prey, too, but the prey should have numbers of their own.
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunted[: len(hunters), : hunters.shape[1]] = hunters[: len(hunted), : hunted.shape[1]] % m


# %% three_hundred_always loses 15.7
# Draws 300 resamples, whatever `resamples` is.
# -     for _ in range(resamples):
# +     for _ in range(300):


# %% signed_turning loses 15.8
# Keeps the sign of the turning, so that turns to the left and to the right cancel out, but it should be left out.
# says: this
# -         "turning": np.abs(turned).mean(axis=0) / 0.1,
# +         "turning": turned.mean(axis=0) / 0.1,


# %% speed_of_the_whole_way loses 15.8
# Gives the speed along the straight line from the start to the end, but the mean of the speeds of all steps is asked for.
# -         "speed": np.linalg.norm(moved, axis=-1).mean(axis=0) / 0.1,
# +         "speed": np.linalg.norm(moved.mean(axis=0), axis=-1) / 0.1,
# %% prey_first loses 15.1
# Puts the prey's wheels first in the action, but the predator's wheels should come first.
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.concatenate(wheels[::-1])
# %% start_pose_missing loses 15.1
# Leaves out the poses at the start, but those at the start and after each of the T steps are asked for.
# -     poses, fitness = [arena.robots.copy()], 0.0
# +     poses, fitness = [], 0.0
# %% generations_of_both_first loses 15.2
# Reshapes the list of results to (G, H, n, m), but its order is that of (G, n, H, m), the shape that is asked for.
# -     return fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     return fitness.reshape(len(predators), len(prey), len(predators[0]), len(prey[0]))
# %% divided_by_the_predators_only loses 15.3
# Divides the sum over all pairs by n, the number of predators, instead of n times m.
# -     mean = table.mean(axis=(1, 3))
# +     mean = table.sum(axis=(1, 3)) / table.shape[1]
# %% wins_above_one_half loses 15.5
# Takes a match as won by a if f(a, b) is above 0.5, but f(a, b) should be compared with f(b, a).
# -     wins = matrix > matrix.T
# +     wins = matrix > 0.5
# %% others_of_rows loses 15.6
# Averages over the competitors for "others", but the mean over the generations of the side is asked for.
# -         "others": (matrix[:, 1:] - matrix[:, :1]).mean(axis=0),
# +         "others": (matrix[:, 1:] - matrix[:, :1]).mean(axis=1)[1:],
# %% drawn_once_for_all_resamples loses 15.7
# Takes the same drawn individuals in all resamples, but they should be drawn anew for each resample.
# -     for _ in range(resamples):
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +     hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +     for _ in range(resamples):
# %% heading_after loses 15.8
# Takes the heading at the end of each step instead of that at its beginning (so that "turning" is 0).
# -     heading = before[..., 2]
# +     heading = after[..., 2]
# %% facing_to_the_left loses 15.8
# Counts the other robot as faced only if it is to the left of the heading, but the right counts, too.
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (
# +             (ahead > np.cos(np.pi / 4) * apart)
# +             & (to_other[..., 1] * np.cos(heading) > to_other[..., 0] * np.sin(heading))
# +         ).mean(axis=0),
# %% angle_not_wrapped_in_facing loses 15.8
# Takes the plain difference of direction and heading for "facing", so that 350 degrees do not count as -10, but the short way around is asked for.
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (
# +             np.abs(np.arctan2(to_other[..., 1], to_other[..., 0]) - heading) < np.pi / 4
# +         ).mean(axis=0),
# %% next_generation_only loses 15.4
# Counts only the generation just after as future, but all later ones are future.
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array([matrix[g, g + 1] for g in range(count - 1)]),
# %% fitness_of_the_prey_in_a_chase loses 15.1
# Gives the prey's fitness, 1 minus the predator's, but the predator's is asked for.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": 1 - float(fitness)}
# %% both_sense_as_the_predator loses 15.1
# Gives both networks what the predator senses, but the prey's network should get the last 24 numbers of arena.observation.
# says: this
# -             network.observation = observation
# +             network.observation = arena.observation[:24]
# %% start_counted_as_a_step loses 15.1
# Counts one step too many for the fitness of a catch: T steps have T + 1 poses, and 1 - T / maxsteps is asked for.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     fitness = 1 - len(poses) / maxsteps if arena.terminated else 0.0
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# %% caught_if_paid loses 15.1
# Gives False for "caught" if the prey is caught in the very last step; such a catch is worth 0, but it is a catch.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     return {"poses": np.array(poses), "caught": fitness > 0, "fitness": float(fitness)}
# %% left_for_right loses 15.1
# Exchanges the left and the right wheel of both robots, but the left one should come first in the action.
# says: this
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.concatenate([pair[::-1] for pair in wheels])
# %% headings_in_degrees loses 15.1
# Gives the headings in degrees instead of rad.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.array(poses)
# +     poses[..., 2] = np.degrees(poses[..., 2])
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}
# %% robots_before_steps loses 15.1
# Puts the robots on the first axis of "poses" and the steps on the second, but the shape (T + 1, 2, 3) is asked for.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.swapaxes(poses, 0, 1)
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}
# %% each_has_its_own_prey loses 15.2
# Gives the result of predator i against prey i of a generation for all prey of that generation, but each pair should play.
# says: this
# -     pairs = np.array([(i, j) for i in range(len(hunters)) for j in range(len(hunted))])
# +     n, m = len(predators[0]), len(prey[0])
# +     pairs = np.array([(i, j // m * m + min(i % n, m - 1)) for i in range(len(hunters))
# +                       for j in range(len(hunted))])
# %% one_predator_a_generation loses 15.2
# Gives the results of the first predator of a generation for all its predators, but each of them should play.
# says: this
# -     return fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     table = fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     table[:] = table[:, :1]
# +     return table
# %% median_for_mean loses 15.3
# Takes the median over the individuals instead of the mean.
# says: this
# -     mean = table.mean(axis=(1, 3))
# +     mean = np.median(table, axis=(1, 3))
# %% present_among_the_ancient loses 15.4
# Counts the present competitors among the ancient ones, but only those of earlier generations are ancient.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, :g + 1].mean() for g in range(1, count)]),
# %% present_in_the_future loses 15.4
# Counts the present competitors among the future ones, but only those of later generations are future.
# says: this
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array([matrix[g, g:].mean() for g in range(count - 1)]),
# %% ancient_down_a_column loses 15.4
# Averages over column g for "ancient", but the competitors of generation g are in row g.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[:g, g].mean() for g in range(1, count)]),
# %% divided_by_all_generations loses 15.4
# Divides the sum over ancient competitors by G, but the number of ancient generations is asked for.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, :g].sum() / count for g in range(1, count)]),
# %% very_last_generation_left_out loses 15.4
# Leaves the very last generation out of the future ones (unless it is the only one), but all later generations are future.
# says: this
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array(
# +             [matrix[g, g + 1 : max(count - 1, g + 2)].mean() for g in range(count - 1)]
# +         ),
# %% present_of_all_times loses 15.4
# Gives the mean over the competitors of all times as "present", but only those of its own generation are asked for.
# says: this
# -         "present": np.diag(matrix).copy(),
# +         "present": matrix.mean(axis=1),
# %% ancient_to_the_predecessor loses 15.5
# Leaves generation g - 1 out of the ancient competitors (unless it is the only one), but all k < g count.
# says: this
# -     ancient = [row[:g] for g, row in enumerate(gain, 1)]
# +     ancient = [row[:max(g - 1, 1)] for g, row in enumerate(gain, 1)]
# %% draws_left_out loses 15.5
# Leaves cases in which both do equally well out of "share" (and gives 0 if all are such cases), but they should count half.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.sum(cases > 0) / max(np.sum(cases != 0), 1)),
# %% draws_count_fully loses 15.5
# Counts a case in which both do equally well fully in "share", but it should count half.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean(cases >= 0)),
# %% share_of_all_competitors loses 15.5
# Counts the cases with all competitors for "share", but only those with ancient competitors are asked for.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean((gain > 0) + 0.5 * (gain == 0))),
# %% share_of_shares loses 15.5
# Takes the mean of the shares of the single generations as "share", but all cases should count alike.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean([np.mean((row > 0) + 0.5 * (row == 0)) for row in ancient])),
# %% neighbouring_columns loses 15.5
# Compares neighbouring columns of the matrix instead of neighbouring rows.
# says: this
# -     gain = np.diff(matrix, axis=0)
# +     gain = np.diff(matrix, axis=1).T
# %% compared_with_the_first loses 15.5
# Compares each generation with the first one instead of its predecessor.
# says: this
# -     gain = np.diff(matrix, axis=0)
# +     gain = matrix[1:] - matrix[0]
# %% global_by_one_less loses 15.5
# Divides global progress by G - 1 instead of G.
# says: this
# -         "global": gain.mean(axis=1),
# +         "global": gain.sum(axis=1) / len(gain),
# %% global_over_the_generations loses 15.5
# Gives the mean over the generations for each competitor as "global", but the mean over the competitors for each generation is asked for.
# says: this
# -         "global": gain.mean(axis=1),
# +         "global": gain.mean(axis=0)[1:],
# %% cycles_of_neighbours loses 15.5
# Counts only groups of three neighbouring generations, but all groups of three are asked for.
# says: this
# -         for c in range(len(matrix))
# -         for b in range(c)
# -         for a in range(b)
# +         for c in range(2, len(matrix))
# +         for b in [c - 1]
# +         for a in [c - 2]
# %% divided_by_ordered_triples loses 15.5
# Divides the number of cycles by G ** 3 instead of the number of groups of three.
# says: this
# -     return float(np.mean(triples)) if triples else 0.0
# +     return float(np.sum(triples)) / len(matrix) ** 3
# %% own_against_those_of_its_time loses 15.6
# Adds up for "own" the gains of each generation on its predecessor against competitors of its own time, but a comparison with generation 0 against all competitors is asked for.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.cumsum([matrix[g, g] - matrix[g - 1, g] for g in range(1, len(matrix))]),
# %% own_against_the_ancient loses 15.6
# Takes only the ancient competitors for "own", but the mean over those of all generations is asked for.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.array([(matrix[g, :g] - matrix[0, :g]).mean() for g in range(1, len(matrix))]),
# %% own_without_the_first_competitors loses 15.6
# Leaves the competitors of generation 0 out of "own", but the mean over those of all generations is asked for.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": (matrix[1:, 1:] - matrix[0, 1:]).mean(axis=1),
# %% change_as_a_share loses 15.6
# Divides the change by f(0, 0), but the difference alone is asked for.
# says: this
# -         "change": np.diag(matrix)[1:] - matrix[0, 0],
# +         "change": np.diag(matrix)[1:] / matrix[0, 0] - 1,
# %% generations_are_drawn loses 15.7
# Draws whole generations instead of the individuals of each generation.
# says: this
# -         drawn = table[np.arange(rows)[:, None], hunters]
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         a, b = rng.integers(rows, size=rows), rng.integers(columns, size=columns)
# +         measures.append(measure(table[a][:, :, b]))
# %% percentile_of_shares loses 15.7
# Takes the quantiles 0.00025 and 0.00975, but 0.025 and 0.975 are asked for (np.percentile takes per cent: 2.5 and 97.5).
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.percentile(measures, [0.025, 0.975])
# %% first_row_for_all_generations loses 15.7
# Gives all generations the individuals that were drawn for the first one, but each generation should have its own.
# says: this
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters[:], hunted[:] = hunters[0], hunted[0]
# %% prey_alone_are_drawn loses 15.7
# Resamples only the prey and leaves the predators as they are, but both should be drawn anew.
# says: this
# -         drawn = table[np.arange(rows)[:, None], hunters]
# +         drawn = table
# %% one_resample_fewer loses 15.7
# Draws one resample fewer than `resamples`.
# says: this
# -     for _ in range(resamples):
# +     for _ in range(resamples - 1):
# %% entries_are_drawn loses 15.7
# Draws single entries of the table instead of individuals.
# says: this
# -         drawn = table[np.arange(rows)[:, None], hunters]
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         flat = table.reshape(-1)
# +         measures.append(measure(flat[rng.integers(flat.size, size=table.shape)]))
# %% resamples_of_resamples loses 15.7
# Draws each resample from the one before it instead of the table.
# says: this
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         table = drawn[:, :, np.arange(columns)[:, None], hunted]
# +         measures.append(measure(table))
# %% high_before_low loses 15.7
# Returns the upper end before the lower one, but (low, high) is asked for.
# says: this
# -     return float(low), float(high)
# +     return float(high), float(low)
# %% mirrored_at_the_measure loses 15.7
# Mirrors the interval at the measure of the given table, but the quantiles themselves are asked for.
# says: this
# -     return float(low), float(high)
# +     middle = measure(table)
# +     return float(2 * middle - high), float(2 * middle - low)
# %% same_prey_for_all_resamples loses 15.7
# Takes the same drawn prey in all resamples, but they should be drawn anew for each resample.
# says: this
# -     measures = []
# +     measures = []
# +     always = rng.integers(m, size=(columns, m))
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], always]))
# %% entries_for_quantiles loses 15.7
# Takes two entries of the sorted measures as low and high, but np.quantile is asked for, which interpolates between entries.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     measures.sort()
# +     low, high = measures[int(0.025 * resamples)], measures[int(0.975 * resamples)]
# %% standard_errors_ddof_1 loses 15.7
# Gives the mean of the measures plus and minus 1.96 standard errors (ddof=1), but their 2.5 % and 97.5 % quantiles are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     error = np.std(measures, ddof=1) / np.sqrt(resamples)
# +     low, high = np.mean(measures) - 1.96 * error, np.mean(measures) + 1.96 * error
# %% standard_errors loses 15.7
# Gives the mean of the measures plus and minus 1.96 standard errors, but their 2.5 % and 97.5 % quantiles are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     error = np.std(measures) / np.sqrt(resamples)
# +     low, high = np.mean(measures) - 1.96 * error, np.mean(measures) + 1.96 * error
# %% middle_half loses 15.7
# Takes the quantiles 0.25 and 0.75, which hold half of the measures, but 0.025 and 0.975 are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.quantile(measures, [0.25, 0.75])
# %% bell_shaped_ddof_1 loses 15.7
# Gives the mean of the measures plus and minus 1.96 standard deviations (ddof=1), but their 2.5 % and 97.5 % quantiles are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.mean(measures) + np.array([-1.96, 1.96]) * np.std(measures, ddof=1)
# %% measures_the_table_itself loses 15.7
# Measures the given table each time instead of the table of those who were drawn.
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         measures.append(measure(table))
# %% speed_by_the_poses loses 15.8
# Divides by the number of poses for "speed", but the number of steps is one smaller.
# says: this
# -         "speed": np.linalg.norm(moved, axis=-1).mean(axis=0) / 0.1,
# +         "speed": np.linalg.norm(moved, axis=-1).sum(axis=0) / len(poses) / 0.1,
# %% sign_left_out_at_the_end loses 15.8
# Leaves out the sign of the mean turning, so that turns to the left and to the right cancel out; it should be left out in each step.
# says: this
# -         "turning": np.abs(turned).mean(axis=0) / 0.1,
# +         "turning": np.abs(turned.mean(axis=0)) / 0.1,
# %% faced_by_the_other loses 15.8
# Exchanges the two robots in "facing", but the predator should come first.
# says: this
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0)[::-1],
# %% walls_of_all_poses loses 15.8
# Counts all poses for "wall", the last one included, but no step begins at the last one.
# says: this
# -     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
# +     to_wall = np.minimum(poses[..., :2], 3000 - poses[..., :2]).min(axis=-1)
# %% distance_of_all_poses loses 15.8
# Averages the distance over all poses, the last one included, but no step begins at the last one.
# says: this
# -         "distance": float(apart[:, 0].mean()),
# +         "distance": float(np.linalg.norm(poses[:, 0, :2] - poses[:, 1, :2], axis=-1).mean()),
# %% distance_of_the_rims loses 15.8
# Subtracts the radii of both robots from the distance, but that of their centres is asked for.
# says: this
# -         "distance": float(apart[:, 0].mean()),
# +         "distance": float(apart[:, 0].mean()) - 170,
# %% middle_for_the_corner loses 15.8
# Measures "wall" as if 0 were in the middle of the arena, but it is at the lower left corner.
# says: this
# -     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
# +     to_wall = (1500 - np.abs(before[..., :2])).min(axis=-1)
# %% turning_in_degrees loses 15.8
# Gives the turning in degrees per second instead of rad per second.
# says: this
# -         "turning": np.abs(turned).mean(axis=0) / 0.1,
# +         "turning": np.degrees(np.abs(turned)).mean(axis=0) / 0.1,
# %% facing_45_degrees_in_all loses 15.8
# Counts the other robot as faced within 22.5 degrees to each side, but 45 degrees to each side are asked for.
# says: this
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (ahead > np.cos(np.pi / 8) * apart).mean(axis=0),
# %% facing_at_the_end loses 15.8
# Measures "facing" at the end of each step instead of its beginning.
# says: this
# -     to_other = before[:, ::-1, :2] - before[..., :2]
# -     apart = np.linalg.norm(to_other, axis=-1)
# -     ahead = to_other[..., 0] * np.cos(heading) + to_other[..., 1] * np.sin(heading)
# +     to_other = after[:, ::-1, :2] - after[..., :2]
# +     apart = np.linalg.norm(to_other, axis=-1)
# +     ahead = to_other[..., 0] * np.cos(after[..., 2]) + to_other[..., 1] * np.sin(after[..., 2])
# %% headings_wrapped_in_place loses 15.8
# Changes the headings in the array of poses that it is given, but that should stay as it is.
# says: changed its argument
# -     before, after = poses[:-1], poses[1:]
# +     poses[..., 2] %= 2 * np.pi
# +     before, after = poses[:-1], poses[1:]
# %% left_wheels_first loses 15.1
# Puts the left wheels of both robots first in the action, then the right ones, but the predator's two wheels should come first.
# says: this
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.stack(wheels, axis=1).ravel()
# %% start_always_counted_as_a_step loses 15.1
# Gives 1 - (T + 1) / maxsteps as the fitness of every chase, but T is one fewer than the poses, and without a catch the fitness is 0.
# says: one fewer than the poses
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     fitness = 1 - len(poses) / maxsteps
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# %% observed_once loses 15.1
# Gives the networks what they sense at the start in every step instead of what they sense in that step.
# says: this
# -     while not arena.done:
# +     seen = np.split(arena.observation.copy(), 2)
# +     while not arena.done:
# -         for network, observation in zip(networks, np.split(arena.observation, 2), strict=True):
# +         for network, observation in zip(networks, seen, strict=True):
# %% prey_drawn_from_n loses 15.7
# Draws the prey's numbers below n, but a generation of prey has m individuals.
# says: this
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(n, size=(columns, m))
# %% sides_exchanged_in_play loses 15.2
# Lets the predators play as prey, and the prey as predators, but the predators should come first in play.
# says: this
# -     fitness = play(hunters, hunted, pairs, maxsteps)
# +     fitness = play(hunted, hunters, pairs[:, ::-1], maxsteps)
# %% a_generation_twice_in_a_group loses 15.5
# Counts groups that hold a generation more than once, too, but the three generations of a group should be different.
# says: this
# -         for b in range(c)
# -         for a in range(b)
# +         for b in range(c + 1)
# +         for a in range(b + 1)
# %% two_matches_make_a_cycle loses 15.5
# Counts a group as a cycle by its matches of a with b and of b with c alone, but that of c with a decides, too.
# says: this
# -         (wins[a, b] and wins[b, c] and wins[c, a]) or (wins[b, a] and wins[c, b] and wins[a, c])
# +         (wins[a, b] and wins[b, c]) or (wins[b, a] and wins[c, b])
# %% movement_to_the_other_is_forwards loses 15.8
# Counts movement away from the other robot as backwards, but movement against the robot's own heading is asked for.
# says: this
# -     forward = moved[..., 0] * np.cos(heading) + moved[..., 1] * np.sin(heading)
# +     other = before[:, ::-1, :2] - before[..., :2]
# +     forward = (moved * other).sum(axis=-1)
# %% cosine_of_45_rad loses 15.8
# Counts the other robot as faced within 58 degrees to each side instead of 45. (np.cos takes rad: np.cos(45) is the cosine of about 58 degrees.)
# says: this
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (ahead > np.cos(45) * apart).mean(axis=0),


# %% prey_reshaped loses 15.3
# Gives the prey's matrix the right shape, but with its numbers in another order: it is reshaped where it should be transposed.
# says: reshaped where it should be transposed
# -     return {"predators": mean, "prey": 1 - mean.T}
# +     return {"predators": mean, "prey": (1 - mean).reshape(mean.shape[::-1])}


# %% own_part_of_the_historical_progress loses 15.6
# Adds up the historical progress for "own", but the gains on the competitors of all generations are asked for.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.cumsum(progress(matrix)["historical"]),


# %% networks_anew_in_each_step loses 15.1
# Takes the networks' memory away before each step, but they should keep it for the whole chase.
# says: this
# -         for network, observation in zip(networks, np.split(arena.observation, 2), strict=True):
# +         networks = robot(predator), robot(prey)
# +         for network, observation in zip(networks, np.split(arena.observation, 2), strict=True):


# %% action_of_the_step_before loses 15.1
# Carries out each action one step late (both robots stand still in the first step), but it should be set before arena.step().
# says: this
# -         arena.action = np.concatenate(wheels)
# -         fitness += arena.step()
# +         fitness += arena.step()
# +         arena.action = np.concatenate(wheels)


# %% steps_left_for_the_fitness loses 15.1
# Gives the number of steps that are left as the fitness, but their share of maxsteps is asked for.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     left = maxsteps - len(poses) + 1
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(left)}


# %% poses_without_headings loses 15.1
# Leaves the headings out of "poses", but x, y and heading of each robot are asked for.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.array(poses)[..., :2]
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}


# %% prey_first_in_the_poses loses 15.1
# Puts the prey first in "poses", but the predator should come first.
# says: this|The prey stands first in the poses
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.array(poses)[:, ::-1].copy()
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}


# %% networks_step_twice loses 15.1
# Lets each network make two steps in each step of the arena, but one is asked for.
# says: this
# -             wheels.append(network.step().copy())
# +             network.step()
# +             wheels.append(network.step().copy())


# %% prey_stands_still loses 15.1
# Lets the prey stand still with its wheels at 0, but they should get what the prey's network gives.
# says: this
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.concatenate([wheels[0], 0 * wheels[1]])


# %% half_of_the_resamples loses 15.7
# Draws half as many resamples as are asked for.
# says: this
# -     for _ in range(resamples):
# +     for _ in range(resamples // 2):


# %% pairs_by_generations loses 15.2
# Fills the places [g, i, h, j] with results in the order g, h, i, j, so that they belong to other pairs.
# says: this
import numpy as np

from botschool.course.coevolution import play


def tournament(predators, prey, maxsteps=2000):
    G, n = len(predators), len(predators[0])
    H, m = len(prey), len(prey[0])
    pairs = []
    for g in range(G):
        for h in range(H):
            for i in range(n):
                for j in range(m):
                    pairs.append((g * n + i, h * m + j))
    scores = play(np.vstack(predators), np.vstack(prey), np.array(pairs), maxsteps)
    return np.reshape(scores, (G, n, H, m))


# %% draws_do_not_count loses 15.5
# Leaves cases in which both do equally well out of "share" (and gives 0.5 if all are such cases), but they should count half.
# says: this
import numpy as np


def progress(matrix):
    G = len(matrix)
    historical, overall = [], []
    better = worse = 0
    for g in range(1, G):
        difference = matrix[g] - matrix[g - 1]
        historical.append(np.mean(difference[:g]))
        overall.append(np.mean(difference))
        for k in range(g):
            if difference[k] > 0:
                better += 1
            elif difference[k] < 0:
                worse += 1
    share = better / (better + worse) if better + worse else 0.5
    return {"historical": np.array(historical), "global": np.array(overall), "share": share}


# %% unwrapped_between_robots loses 15.8
# Unwraps the headings from robot to robot instead of from step to step (np.unwrap needs axis=0).
# says: this
# -     turned = (after[..., 2] - heading + np.pi) % (2 * np.pi) - np.pi
# +     turned = np.diff(np.unwrap(poses[..., 2]), axis=0)


# %% draws_for_a_cycle loses 15.5
# Treats a draw as a lost match in the search for cycles, but in a draw nobody wins or loses.
# says: this
from itertools import combinations


def cycles(matrix):
    def beats(x, y):
        return bool(matrix[x, y] > matrix[y, x])

    groups = list(combinations(range(len(matrix)), 3))
    if not groups:
        return 0.0
    around = 0
    for a, b, c in groups:
        if beats(a, b) == beats(b, c) == beats(c, a):
            around += 1
    return around / len(groups)


# %% one_array_for_all_predators loses 15.2
# Gives the results of the very last predator for all predators, but each should have its own. (If you fill one array again and again, keep a copy each time.)
# says: this
import numpy as np

from botschool.course.coevolution import play


def tournament(predators, prey, maxsteps=2000):
    everybody = np.vstack(prey)
    H, m = len(prey), len(prey[0])
    row = np.zeros((H, m))
    table = []
    for group in predators:
        against = []
        for i in range(len(group)):
            pairs = np.array([(i, j) for j in range(H * m)])
            row[:] = np.reshape(play(group, everybody, pairs, maxsteps), (H, m))
            against.append(row)
        table.append(against)
    return np.array(table)


# %% one_minus_in_the_view loses 15.3
# Gives 1 minus the mean also in the predators' matrix, but only the prey's should have it. (An array and its transpose .T share their numbers.)
# says: this
import numpy as np


def master(table):
    G, n, H, m = table.shape
    predators = table.transpose(0, 2, 1, 3).reshape(G, H, n * m).mean(axis=2)
    prey = predators.T
    prey *= -1
    prey += 1
    return {"predators": predators, "prey": prey}


# %% future_backwards loses 15.4
# Gives "future" from generation G - 2 down to 0, but it should begin with generation 0.
# says: this
import numpy as np


def before(matrix):
    return np.array([np.mean(row[:g]) for g, row in enumerate(matrix) if g > 0])


def profile(matrix):
    matrix = np.asarray(matrix)
    return {
        "ancient": before(matrix),
        "present": np.array([matrix[g, g] for g in range(len(matrix))]),
        "future": before(np.flip(matrix)),
    }


# %% share_of_generation_means loses 15.5
# Counts for "share" the generations whose mean gain is above 0 (a mean of 0 counts half), but single cases should be counted.
# says: this
# -     cases = np.concatenate(ancient)
# +     cases = np.array([row.mean() for row in ancient])


# %% one_direction_for_facing loses 15.8
# Takes the direction from predator to prey for both robots, but the prey's should lead to the predator.
# says: this
import numpy as np


def wrap(angle):
    return np.arctan2(np.sin(angle), np.cos(angle))


def describe(poses):
    start, end = poses[:-1], poses[1:]
    line = start[:, 1, :2] - start[:, 0, :2]
    bearing = np.arctan2(line[:, 1], line[:, 0])
    found = {key: np.zeros(2) for key in ("speed", "turning", "backwards", "facing", "wall")}
    for k in range(2):
        x, y, heading = start[:, k].T
        dx, dy, turn = (end[:, k] - start[:, k]).T
        found["speed"][k] = np.mean(np.hypot(dx, dy)) * 10
        found["turning"][k] = np.mean(np.abs(wrap(turn))) * 10
        found["backwards"][k] = np.mean(dx * np.cos(heading) + dy * np.sin(heading) < 0)
        found["facing"][k] = np.mean(np.abs(wrap(bearing - heading)) < np.pi / 4)
        found["wall"][k] = np.mean(np.min([x, y, 3000 - x, 3000 - y], axis=0) < 300)
    found["distance"] = float(np.mean(np.hypot(*line.T)))
    return found


# %% walls_of_x_and_y_apart loses 15.8
# Counts a step with only x or only y near a wall half in "wall", but it should count fully.
# says: this
# -     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
# +     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2])
# -         "wall": (to_wall < 300).mean(axis=0),
# +         "wall": (to_wall < 300).mean(axis=(0, 2)),


# %% means_until_that_generation loses 15.6
# Takes the means over generations 0 to g, but those over all generations are asked for.
# says: this
import numpy as np


def red_queen(matrix):
    G = matrix.shape[0]
    change, own, others = [], [], []
    for g in range(1, G):
        change.append(matrix[g, g] - matrix[0, 0])
        own.append(np.mean([matrix[g, k] - matrix[0, k] for k in range(g + 1)]))
        others.append(np.mean([matrix[k, g] - matrix[k, 0] for k in range(g + 1)]))
    return {"change": np.array(change), "own": np.array(own), "others": np.array(others)}


# %% read_by_generations_then_transposed loses 15.2
# Reads the list of results in the order g, h, i, j instead of g, i, h, j: the shape is right, but numbers belong to other pairs.
# says: this
# -     return fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     shape = len(predators), len(prey), len(predators[0]), len(prey[0])
# +     return fitness.reshape(shape).transpose(0, 2, 1, 3)
