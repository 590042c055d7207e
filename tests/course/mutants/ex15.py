"""Wrong solutions of exercise 15; building.py describes how a case is written."""

# %% caught_or_not loses 15.1
# A predator that catches the prey has a fitness of 1, however long it takes.
_chase = chase


def chase(predator, prey, maxsteps=2000):
    found = _chase(predator, prey, maxsteps)
    return {**found, "fitness": float(found["caught"])}


# %% caught_when_done loses 15.1
# Takes every end of an episode for a catch.
_chase = chase


def chase(predator, prey, maxsteps=2000):
    return {**_chase(predator, prey, maxsteps), "caught": True}


# %% memory_goes_on loses 15.1
# Uses the networks of a chase again in the next one, with what they remember.
# says: from call to call
_robot = robot
_known = {}


def robot(genotype):
    key = genotype.tobytes()
    if key not in _known:
        _known[key] = _robot(genotype)
    return _known[key]


# %% minds_swapped loses 15.1
# Gives the predator what the prey senses, and the other way round.
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
# Keeps a window on the arena instead of the poses of each step.
# says: Keep a copy each time \(.copy\(\)\)
_chase = chase


def chase(predator, prey, maxsteps=2000):
    found = _chase(predator, prey, maxsteps)
    found["poses"] = np.tile(found["poses"][-1], (len(found["poses"]), 1, 1))
    return found


# %% fitness_of_the_prey loses 15.2
# Gives what the prey gets.
# says: 1 minus what was expected
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    return 1 - _tournament(predators, prey, maxsteps)


# %% individuals_together loses 15.2
# Puts both generations first, then both individuals.
# says: right, but their shape is
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    return _tournament(predators, prey, maxsteps).swapaxes(1, 2)


# %% only_contemporaries loses 15.2
# Lets only those of the same generation meet.
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    table = _tournament(predators, prey, maxsteps)
    same = np.arange(len(predators))[:, None] == np.arange(len(prey))
    return table * same[:, None, :, None]


# %% prey_outside loses 15.2
# Goes through the pairs prey by prey, but reads the fitness predator by predator.
# -     pairs = np.array([(i, j) for i in range(len(hunters)) for j in range(len(hunted))])
# +     pairs = np.array([(i, j) for j in range(len(hunted)) for i in range(len(hunters))])


# %% failures_left_out loses 15.3
# Averages over the chases in which the prey is caught only.
# -     mean = table.mean(axis=(1, 3))
# +     caught = np.maximum((table > 0).sum(axis=(1, 3)), 1)
# +     mean = table.sum(axis=(1, 3)) / caught


# %% prey_not_turned loses 15.3
# Leaves the predators in the rows of the matrix of the prey.
# says: transpose it
# -     return {"predators": mean, "prey": 1 - mean.T}
# +     return {"predators": mean, "prey": 1 - mean}


# %% prey_want_to_be_caught loses 15.3
# Gives the prey the fitness of the predators.
# says: 1 minus what was expected
# -     return {"predators": mean, "prey": 1 - mean.T}
# +     return {"predators": mean, "prey": mean.T}


# %% asks_the_tool loses 15.3, 15.5, 15.7
# Hands in the answers of the tool's own tournament.
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
# Counts the present competitors among the ancient and the future ones.
_profile = profile


def profile(matrix):
    count = len(matrix)
    ancient = [matrix[g, : g + 1].mean() for g in range(1, count)]
    future = [matrix[g, g:].mean() for g in range(count - 1)]
    return {**_profile(matrix), "ancient": ancient, "future": future}


# %% competitors_in_rows loses 15.4
# Takes the rows of the matrix for the competitors.
# says: 'future': are the two exchanged
_profile = profile


def profile(matrix):
    return _profile(np.transpose(matrix))


# %% against_the_first loses 15.5
# Compares each generation with the first one instead of its predecessor.
_progress = progress


def progress(matrix):
    gain = matrix[1:] - matrix[0]
    historical = np.array([row[:g].mean() for g, row in enumerate(gain, 1)])
    return {**_progress(matrix), "historical": historical, "global": gain.mean(axis=1)}


# %% draws_are_won loses 15.5
# Takes a draw for a match that was won.
# -     wins = matrix > matrix.T
# +     wins, count = matrix >= matrix.T, len(matrix)
# -         for c in range(len(matrix))
# +         for c in range(count)


# %% equal_is_not_better loses 15.5
# Counts only those who do better, and nothing for a draw.
# says: this
_progress = progress


def progress(matrix):
    cases = np.concatenate([row[:g] for g, row in enumerate(np.diff(matrix, axis=0), 1)])
    return {**_progress(matrix), "share": float(np.mean(cases > 0))}


# %% one_way_round loses 15.5
# Knows cycles in one direction only.
# -     wins = matrix > matrix.T
# +     wins, count = matrix > matrix.T, len(matrix)
# -         (wins[a, b] and wins[b, c] and wins[c, a]) or (wins[b, a] and wins[c, b] and wins[a, c])
# -         for c in range(len(matrix))
# +         wins[a, b] and wins[b, c] and wins[c, a]
# +         for c in range(count)


# %% present_is_ancient loses 15.5
# Counts the competitors of the present among the ancient ones.
_progress = progress


def progress(matrix):
    cases = [row[: g + 1] for g, row in enumerate(np.diff(matrix, axis=0), 1)]
    better = np.concatenate(cases)
    share = float(np.mean((better > 0) + 0.5 * (better == 0)))
    historical = np.array([row.mean() for row in cases])
    return {**_progress(matrix), "historical": historical, "share": share}


# %% first_competitors_only loses 15.6
# Holds the other side still in the first generation alone.
_red_queen = red_queen


def red_queen(matrix):
    first = matrix[0, 0]
    return {**_red_queen(matrix), "own": matrix[1:, 0] - first, "others": matrix[0, 1:] - first}


# %% sides_mistaken loses 15.6
# Takes its own part for that of the others.
# says: 'others': are the two exchanged
_red_queen = red_queen


def red_queen(matrix):
    parts = _red_queen(matrix)
    return {**parts, "own": parts["others"], "others": parts["own"]}


# %% steps_added_up loses 15.6
# Adds up what each generation gains on the competitors of its own time.
_red_queen = red_queen


def red_queen(matrix):
    before, after = np.diag(matrix)[:-1], np.diag(matrix)[1:]
    own = np.cumsum((np.diag(matrix, -1) - before + after - np.diag(matrix, 1)) / 2)
    parts = _red_queen(matrix)
    return {**parts, "own": own, "others": parts["change"] - own}


# %% the_rest_is_theirs loses 15.6
# Takes for the part of the others what is missing to the change.
_red_queen = red_queen


def red_queen(matrix):
    parts = _red_queen(matrix)
    return {**parts, "others": parts["change"] - parts["own"]}


# %% bell_shaped loses 15.7
# A bell-shaped distribution is assumed: mean and 1.96 standard deviations.
_interval = interval


def interval(table, measure, rng, resamples=300):
    kept = []

    def keeping(resample):
        kept.append(measure(resample))
        return kept[-1]

    _interval(table, keeping, rng, resamples)
    return np.mean(kept) - 1.96 * np.std(kept), np.mean(kept) + 1.96 * np.std(kept)


# %% the_same_for_all loses 15.7
# The same individuals are drawn for all generations.
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
# The individuals are drawn without replacement: the same ones in another order.
class _Shuffled:
    def __init__(self, rng):
        self._rng = rng

    def integers(self, high, size):
        return self._rng.permuted(np.tile(np.arange(high), (size[0], 1)), axis=1)


_interval = interval


def interval(table, measure, rng, resamples=300):
    return _interval(table, measure, _Shuffled(rng), resamples)


# %% after_the_step loses 15.8
# Looks at walls and at the distance after each step instead of before it.
_describe = describe


def describe(poses):
    after = poses[1:, :, :2]
    return {
        **_describe(poses),
        "wall": (np.minimum(after, 3000 - after).min(axis=-1) < 300).mean(axis=0),
        "distance": float(np.linalg.norm(after[:, 0] - after[:, 1], axis=1).mean()),
    }


# %% facing_a_right_angle loses 15.8
# Counts the other robot as faced when it is anywhere in front.
_describe = describe


def describe(poses):
    before = poses[:-1]
    away = before[:, ::-1, :2] - before[..., :2]
    ahead = away[..., 0] * np.cos(before[..., 2]) + away[..., 1] * np.sin(before[..., 2])
    return {**_describe(poses), "facing": (ahead > 0).mean(axis=0)}


# %% per_step loses 15.8
# Measures speed by step and not by second.
# says: 0\.1 times what was expected
_describe = describe


def describe(poses):
    found = _describe(poses)
    return {**found, "speed": found["speed"] / 10}


# %% rest_is_backwards loses 15.8
# Takes standing still for driving backwards.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    heading, moved = before[..., 2], poses[1:, :, :2] - before[..., :2]
    forward = moved[..., 0] * np.cos(heading) + moved[..., 1] * np.sin(heading)
    found["backwards"] = (forward <= 0).mean(axis=0)
    return found


# %% turning_leaps loses 15.8
# Takes a step from 359 to 1 degree for nearly a whole turn.
_describe = describe


def describe(poses):
    turning = np.abs(np.diff(poses[..., 2], axis=0)).mean(axis=0) / 0.1
    return {**_describe(poses), "turning": turning}


# %% two_walls_only loses 15.8
# Forgets the walls above and to the right.
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    found["wall"] = (before[..., :2].min(axis=-1) < 300).mean(axis=0)
    return found


# %% wall_after_the_step loses 15.8
# Looks at the wall at the end of each step.
_describe = describe


def describe(poses):
    found, _before = _describe(poses), poses[:-1]
    after = poses[1:]
    to_wall = np.minimum(after[..., :2], 3000 - after[..., :2]).min(axis=-1)
    found["wall"] = (to_wall < 300).mean(axis=0)
    return found


# %% wall_includes_its_limit loses 15.8
# Counts a robot exactly 300 mm from a wall as near.
# says: this
_describe = describe


def describe(poses):
    found, before = _describe(poses), poses[:-1]
    to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
    found["wall"] = (to_wall <= 300).mean(axis=0)
    return found


# %% quantiles_of_ninety loses 15.7
# The quantiles are those of 90 %, 0.05 and 0.95.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.quantile(measures, [0.05, 0.95])


# %% predators_alone_are_drawn loses 15.7
# Only the predators are drawn anew; the prey stay as they are.
# says: this
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         measures.append(measure(drawn))


# %% prey_drawn_first loses 15.7
# The prey are drawn before the predators, which gives other individuals.
# says: this
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunted, hunters = rng.integers(m, size=(columns, m)), rng.integers(n, size=(rows, n))


# %% smallest_and_largest loses 15.7
# The smallest and the largest measure are returned instead of the quantiles.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.min(measures), np.max(measures)


# %% last_individual_never_drawn loses 15.7
# The last individual of a generation is never drawn.
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters = rng.integers(max(n - 1, 1), size=(rows, n))
# +         hunted = rng.integers(max(m - 1, 1), size=(columns, m))


# %% last_pose_missing loses 15.1
# The poses after the last step are missing.
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     return {"poses": np.array(poses[:-1]), "caught": arena.terminated, "fitness": float(fitness)}


# %% two_thousand_steps_always loses 15.1
# A chase lasts up to 2000 steps, whatever is asked for.
# -     arena = arenas.make("predprey", max_steps=maxsteps)
# +     arena = arenas.make("predprey", max_steps=2000)


# %% one_prey_a_generation loses 15.2
# Only the first prey of each generation plays, and its result stands for all.
# -     pairs = np.array([(i, j) for i in range(len(hunters)) for j in range(len(hunted))])
# +     m = len(prey[0])
# +     pairs = np.array([(i, j // m * m) for i in range(len(hunters)) for j in range(len(hunted))])


# %% two_thousand_in_the_tournament loses 15.2
# The tournament's chases last up to 2000 steps, whatever is asked for.
# -     fitness = play(hunters, hunted, pairs, maxsteps)
# +     fitness = play(hunters, hunted, pairs, 2000)


# %% best_individuals loses 15.3
# Each generation counts by its best individual, not by the mean.
# says: this
# -     mean = table.mean(axis=(1, 3))
# +     mean = table.max(axis=1).mean(axis=2)


# %% mean_of_the_first_only loses 15.3
# Averages over the predators, and takes the first prey for all.
# says: this
# -     mean = table.mean(axis=(1, 3))
# +     mean = table.mean(axis=1)[:, :, 0]


# %% future_and_ancient_swapped loses 15.4
# Ancient and future competitors are exchanged.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array([matrix[g, :g].mean() for g in range(1, count)]),


# %% last_generation_only loses 15.4
# The ancient are only those of the generation before.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, g - 1] for g in range(1, count)]),


# %% global_without_the_present loses 15.5
# Global progress leaves out the competitors of the same generation.
# says: this
# -         "global": gain.mean(axis=1),
# +         "global": np.array([np.delete(row, g).mean() for g, row in enumerate(gain, 1)]),


# %% share_of_the_means loses 15.5
# The share counts generations whose mean progress is positive, not the single cases.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean([row.mean() > 0 for row in ancient])),


# %% every_triple_twice loses 15.5
# The cycles are counted in both directions, but divided by the groups of one order only.
# says: this
# -     return float(np.mean(triples)) if triples else 0.0
# +     return 2 * float(np.mean(triples)) if triples else 0.0


# %% no_group_is_a_cycle loses 15.5
# Without a group of three the share is 1, not 0.
# -     return float(np.mean(triples)) if triples else 0.0
# +     return float(np.mean(triples)) if triples else 1.0


# %% change_from_generation_to_generation loses 15.6
# The change is that from each generation to the next one, not that since the first.
# says: this
# -         "change": np.diag(matrix)[1:] - matrix[0, 0],
# +         "change": np.diff(np.diag(matrix)),


# %% own_against_the_present loses 15.6
# Its own part is that against the competitors of its own time only.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.diag(matrix[1:, 1:]) - matrix[0, 1:],


# %% one_draw_for_both_sides loses 15.7
# The individuals drawn of the predators are those drawn of the prey.
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunted[: len(hunters), : hunters.shape[1]] = hunters[: len(hunted), : hunted.shape[1]] % m


# %% three_hundred_always loses 15.7
# Draws 300 times, whatever is asked for.
# -     for _ in range(resamples):
# +     for _ in range(300):


# %% signed_turning loses 15.8
# Turns to the left and to the right cancel out.
# says: this
# -         "turning": np.abs(turned).mean(axis=0) / 0.1,
# +         "turning": turned.mean(axis=0) / 0.1,


# %% speed_of_the_whole_way loses 15.8
# The speed is that of the straight line from the start to the end.
# -         "speed": np.linalg.norm(moved, axis=-1).mean(axis=0) / 0.1,
# +         "speed": np.linalg.norm(moved.mean(axis=0), axis=-1) / 0.1,
# %% prey_first loses 15.1
# Writes the wheels of the prey before those of the predator.
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.concatenate(wheels[::-1])
# %% start_pose_missing loses 15.1
# The poses at the start are missing; those after each step are there.
# -     poses, fitness = [arena.robots.copy()], 0.0
# +     poses, fitness = [], 0.0
# %% generations_of_both_first loses 15.2
# Reads the table as if the generations of both sides came first, then the individuals.
# -     return fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     return fitness.reshape(len(predators), len(prey), len(predators[0]), len(prey[0]))
# %% divided_by_the_predators_only loses 15.3
# The sum over individuals is divided by the predators only.
# -     mean = table.mean(axis=(1, 3))
# +     mean = table.sum(axis=(1, 3)) / table.shape[1]
# %% wins_above_one_half loses 15.5
# A match counts as won above one half, not above the return match.
# -     wins = matrix > matrix.T
# +     wins = matrix > 0.5
# %% others_of_rows loses 15.6
# The part of the others is the mean over competitors instead of over the side's own generations.
# -         "others": (matrix[:, 1:] - matrix[:, :1]).mean(axis=0),
# +         "others": (matrix[:, 1:] - matrix[:, :1]).mean(axis=1)[1:],
# %% drawn_once_for_all_resamples loses 15.7
# The individuals are drawn once, before the resamples, so that all resamples are the same.
# -     for _ in range(resamples):
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +     hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +     for _ in range(resamples):
# %% heading_after loses 15.8
# Takes the heading at the end of a step for its direction.
# -     heading = before[..., 2]
# +     heading = after[..., 2]
# %% facing_to_the_left loses 15.8
# Counts the other robot as faced only if it is to the left of the heading.
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (
# +             (ahead > np.cos(np.pi / 4) * apart)
# +             & (to_other[..., 1] * np.cos(heading) > to_other[..., 0] * np.sin(heading))
# +         ).mean(axis=0),
# %% angle_not_wrapped_in_facing loses 15.8
# The angle to the other robot is not wrapped, so that 350 degrees do not count as 10.
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (
# +             np.abs(np.arctan2(to_other[..., 1], to_other[..., 0]) - heading) < np.pi / 4
# +         ).mean(axis=0),
# %% next_generation_only loses 15.4
# The future competitors are those of the next generation only.
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array([matrix[g, g + 1] for g in range(count - 1)]),
# %% fitness_of_the_prey_in_a_chase loses 15.1
# The fitness of a chase is the prey's, 1 minus the predator's.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": 1 - float(fitness)}
# %% both_sense_as_the_predator loses 15.1
# Both networks get what the predator senses, the first 24 numbers.
# says: this
# -             network.observation = observation
# +             network.observation = arena.observation[:24]
# %% start_counted_as_a_step loses 15.1
# The fitness counts the poses for the steps, which are one fewer.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     fitness = 1 - len(poses) / maxsteps if arena.terminated else 0.0
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# %% caught_if_paid loses 15.1
# Takes a fitness above 0 for a catch: a catch in the very last step is worth 0, too.
# says: worth 0
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     return {"poses": np.array(poses), "caught": fitness > 0, "fitness": float(fitness)}
# %% left_for_right loses 15.1
# The left wheel gets the action of the right one, and the other way round.
# says: this
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.concatenate([pair[::-1] for pair in wheels])
# %% headings_in_degrees loses 15.1
# The headings of the poses are in degrees, not in rad.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.array(poses)
# +     poses[..., 2] = np.degrees(poses[..., 2])
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}
# %% robots_before_steps loses 15.1
# The poses have the robots on the first axis, and the steps on the second one.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.swapaxes(poses, 0, 1)
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}
# %% each_has_its_own_prey loses 15.2
# Each predator meets one prey of a generation only, that of its own number, and its result stands for all.
# says: this
# -     pairs = np.array([(i, j) for i in range(len(hunters)) for j in range(len(hunted))])
# +     n, m = len(predators[0]), len(prey[0])
# +     pairs = np.array([(i, j // m * m + min(i % n, m - 1)) for i in range(len(hunters))
# +                       for j in range(len(hunted))])
# %% one_predator_a_generation loses 15.2
# Only the first predator of each generation plays, and its result stands for all.
# says: this
# -     return fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     table = fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
# +     table[:] = table[:, :1]
# +     return table
# %% median_for_mean loses 15.3
# This is the median over the individuals, not the mean.
# says: this
# -     mean = table.mean(axis=(1, 3))
# +     mean = np.median(table, axis=(1, 3))
# %% present_among_the_ancient loses 15.4
# The present competitors count among the ancient ones.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, :g + 1].mean() for g in range(1, count)]),
# %% present_in_the_future loses 15.4
# The present competitors count among the future ones.
# says: this
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array([matrix[g, g:].mean() for g in range(count - 1)]),
# %% ancient_down_a_column loses 15.4
# The mean over ancient competitors goes down a column: competitors are the columns of a row.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[:g, g].mean() for g in range(1, count)]),
# %% divided_by_all_generations loses 15.4
# The sum over ancient competitors is divided by the number of all generations, not by that of the ancient ones.
# says: this
# -         "ancient": np.array([matrix[g, :g].mean() for g in range(1, count)]),
# +         "ancient": np.array([matrix[g, :g].sum() / count for g in range(1, count)]),
# %% very_last_generation_left_out loses 15.4
# The very last generation is left out of the future.
# says: this
# -         "future": np.array([matrix[g, g + 1 :].mean() for g in range(count - 1)]),
# +         "future": np.array(
# +             [matrix[g, g + 1 : max(count - 1, g + 2)].mean() for g in range(count - 1)]
# +         ),
# %% present_of_all_times loses 15.4
# The present is the mean over the competitors of all times.
# says: this
# -         "present": np.diag(matrix).copy(),
# +         "present": matrix.mean(axis=1),
# %% ancient_to_the_predecessor loses 15.5
# The ancient competitors of generation g are those before g - 1: the last one of them is left out.
# says: this
# -     ancient = [row[:g] for g, row in enumerate(gain, 1)]
# +     ancient = [row[:max(g - 1, 1)] for g, row in enumerate(gain, 1)]
# %% draws_left_out loses 15.5
# Cases in which both do equally well are left out of the share: they count half.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.sum(cases > 0) / max(np.sum(cases != 0), 1)),
# %% draws_count_fully loses 15.5
# Cases in which both do equally well count fully in the share: they count half.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean(cases >= 0)),
# %% share_of_all_competitors loses 15.5
# The share counts all competitors, not the ancient ones alone.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean((gain > 0) + 0.5 * (gain == 0))),
# %% share_of_shares loses 15.5
# The share is the mean of the shares of the generations: all cases count alike.
# says: this
# -         "share": float(np.mean((cases > 0) + 0.5 * (cases == 0))),
# +         "share": float(np.mean([np.mean((row > 0) + 0.5 * (row == 0)) for row in ancient])),
# %% neighbouring_columns loses 15.5
# Neighbouring columns are compared: a generation is a row, its competitors are the columns.
# says: this
# -     gain = np.diff(matrix, axis=0)
# +     gain = np.diff(matrix, axis=1).T
# %% compared_with_the_first loses 15.5
# Each generation is compared with the first one, not with its predecessor.
# says: this
# -     gain = np.diff(matrix, axis=0)
# +     gain = matrix[1:] - matrix[0]
# %% global_by_one_less loses 15.5
# Global progress is divided by G - 1, not by G.
# says: this
# -         "global": gain.mean(axis=1),
# +         "global": gain.sum(axis=1) / len(gain),
# %% global_over_the_generations loses 15.5
# Global progress is the mean over generations for each competitor: take that over competitors for each generation.
# says: this
# -         "global": gain.mean(axis=1),
# +         "global": gain.mean(axis=0)[1:],
# %% cycles_of_neighbours loses 15.5
# Only groups of three neighbouring generations are looked at.
# says: this
# -         for c in range(len(matrix))
# -         for b in range(c)
# -         for a in range(b)
# +         for c in range(2, len(matrix))
# +         for b in [c - 1]
# +         for a in [c - 2]
# %% divided_by_ordered_triples loses 15.5
# The number of cycles is divided by that of all ordered triples, not by that of the groups of three.
# says: this
# -     return float(np.mean(triples)) if triples else 0.0
# +     return float(np.sum(triples)) / len(matrix) ** 3
# %% own_against_those_of_its_time loses 15.6
# Its own part adds up what each generation gains on its predecessor against the competitors of its own time.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.cumsum([matrix[g, g] - matrix[g - 1, g] for g in range(1, len(matrix))]),
# %% own_against_the_ancient loses 15.6
# Its own part is the mean over the ancient competitors only, not over those of all generations.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.array([(matrix[g, :g] - matrix[0, :g]).mean() for g in range(1, len(matrix))]),
# %% own_without_the_first_competitors loses 15.6
# Its own part leaves out the competitors of the first generation.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": (matrix[1:, 1:] - matrix[0, 1:]).mean(axis=1),
# %% change_as_a_share loses 15.6
# The change is divided by the first fitness.
# says: this
# -         "change": np.diag(matrix)[1:] - matrix[0, 0],
# +         "change": np.diag(matrix)[1:] / matrix[0, 0] - 1,
# %% generations_are_drawn loses 15.7
# Whole generations are drawn, not the individuals of each generation.
# says: this
# -         drawn = table[np.arange(rows)[:, None], hunters]
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         a, b = rng.integers(rows, size=rows), rng.integers(columns, size=columns)
# +         measures.append(measure(table[a][:, :, b]))
# %% percentile_of_shares loses 15.7
# np.percentile takes per cent: 2.5 and 97.5, not 0.025 and 0.975.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.percentile(measures, [0.025, 0.975])
# %% first_row_for_all_generations loses 15.7
# All generations get the individuals that were drawn for the first one.
# says: this
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters[:], hunted[:] = hunters[0], hunted[0]
# %% prey_alone_are_drawn loses 15.7
# Only the prey are drawn anew; the predators stay as they are.
# says: this
# -         drawn = table[np.arange(rows)[:, None], hunters]
# +         drawn = table
# %% one_resample_fewer loses 15.7
# There is one resample fewer than asked for.
# says: this
# -     for _ in range(resamples):
# +     for _ in range(resamples - 1):
# %% entries_are_drawn loses 15.7
# Single entries of the table are drawn, not individuals.
# says: this
# -         drawn = table[np.arange(rows)[:, None], hunters]
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         flat = table.reshape(-1)
# +         measures.append(measure(flat[rng.integers(flat.size, size=table.shape)]))
# %% resamples_of_resamples loses 15.7
# Each resample is drawn from the one before it, not from the table.
# says: this
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         table = drawn[:, :, np.arange(columns)[:, None], hunted]
# +         measures.append(measure(table))
# %% high_before_low loses 15.7
# Low and high are exchanged.
# says: this
# -     return float(low), float(high)
# +     return float(high), float(low)
# %% mirrored_at_the_measure loses 15.7
# The interval is mirrored at the measure of the table: the quantiles themselves are asked for.
# says: this
# -     return float(low), float(high)
# +     middle = measure(table)
# +     return float(2 * middle - high), float(2 * middle - low)
# %% same_prey_for_all_resamples loses 15.7
# The prey are drawn once, before the resamples, so that all resamples have the same.
# says: this
# -     measures = []
# +     measures = []
# +     always = rng.integers(m, size=(columns, m))
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], always]))
# %% entries_for_quantiles loses 15.7
# Low and high are entries of the sorted measures; np.quantile goes on between two of them.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     measures.sort()
# +     low, high = measures[int(0.025 * resamples)], measures[int(0.975 * resamples)]
# %% standard_errors_ddof_1 loses 15.7
# This is the mean plus and minus 1.96 standard errors (ddof=1), which tells how sure the mean is: quantiles are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     error = np.std(measures, ddof=1) / np.sqrt(resamples)
# +     low, high = np.mean(measures) - 1.96 * error, np.mean(measures) + 1.96 * error
# %% standard_errors loses 15.7
# This is the mean plus and minus 1.96 standard errors, which tells how sure the mean is: quantiles are asked for.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     error = np.std(measures) / np.sqrt(resamples)
# +     low, high = np.mean(measures) - 1.96 * error, np.mean(measures) + 1.96 * error
# %% middle_half loses 15.7
# Half of the measures lie between these two, not 95 %.
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.quantile(measures, [0.25, 0.75])
# %% bell_shaped_ddof_1 loses 15.7
# A bell-shaped distribution is assumed: mean and 1.96 standard deviations (ddof=1).
# says: this
# -     low, high = np.quantile(measures, [0.025, 0.975])
# +     low, high = np.mean(measures) + np.array([-1.96, 1.96]) * np.std(measures, ddof=1)
# %% measures_the_table_itself loses 15.7
# The table itself is measured each time, not the resample.
# -         measures.append(measure(drawn[:, :, np.arange(columns)[:, None], hunted]))
# +         measures.append(measure(table))
# %% speed_by_the_poses loses 15.8
# The way is divided by the number of poses, which are one more than the steps.
# says: this
# -         "speed": np.linalg.norm(moved, axis=-1).mean(axis=0) / 0.1,
# +         "speed": np.linalg.norm(moved, axis=-1).sum(axis=0) / len(poses) / 0.1,
# %% sign_left_out_at_the_end loses 15.8
# Turns to the left and to the right cancel out: the sign is left out after the mean, not before it.
# says: this
# -         "turning": np.abs(turned).mean(axis=0) / 0.1,
# +         "turning": np.abs(turned.mean(axis=0)) / 0.1,
# %% faced_by_the_other loses 15.8
# The two robots are exchanged in facing.
# says: this
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0)[::-1],
# %% walls_of_all_poses loses 15.8
# Walls are counted for all poses, the last one included: a step begins at each of them but the last.
# says: this
# -     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
# +     to_wall = np.minimum(poses[..., :2], 3000 - poses[..., :2]).min(axis=-1)
# %% distance_of_all_poses loses 15.8
# The distance is the mean over all poses, the last one included: no step begins there.
# says: this
# -         "distance": float(apart[:, 0].mean()),
# +         "distance": float(np.linalg.norm(poses[:, 0, :2] - poses[:, 1, :2], axis=-1).mean()),
# %% distance_of_the_rims loses 15.8
# The distance is that between the rims of the robots, not between their centres.
# says: this
# -         "distance": float(apart[:, 0].mean()),
# +         "distance": float(apart[:, 0].mean()) - 170,
# %% middle_for_the_corner loses 15.8
# The walls are looked for as if 0 were in the middle of the arena.
# says: this
# -     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
# +     to_wall = (1500 - np.abs(before[..., :2])).min(axis=-1)
# %% turning_in_degrees loses 15.8
# The turning is in degrees per second, not in rad.
# says: this
# -         "turning": np.abs(turned).mean(axis=0) / 0.1,
# +         "turning": np.degrees(np.abs(turned)).mean(axis=0) / 0.1,
# %% facing_45_degrees_in_all loses 15.8
# The other robot counts as faced within 22.5 degrees to each side, 45 in all.
# says: this
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (ahead > np.cos(np.pi / 8) * apart).mean(axis=0),
# %% facing_at_the_end loses 15.8
# Facing is that at the end of each step, not at its beginning.
# says: this
# -     to_other = before[:, ::-1, :2] - before[..., :2]
# -     apart = np.linalg.norm(to_other, axis=-1)
# -     ahead = to_other[..., 0] * np.cos(heading) + to_other[..., 1] * np.sin(heading)
# +     to_other = after[:, ::-1, :2] - after[..., :2]
# +     apart = np.linalg.norm(to_other, axis=-1)
# +     ahead = to_other[..., 0] * np.cos(after[..., 2]) + to_other[..., 1] * np.sin(after[..., 2])
# %% headings_wrapped_in_place loses 15.8
# Wraps the headings in the caller's own array of poses.
# says: changed its argument
# -     before, after = poses[:-1], poses[1:]
# +     poses[..., 2] %= 2 * np.pi
# +     before, after = poses[:-1], poses[1:]
# %% left_wheels_first loses 15.1
# The action holds the left wheels of both robots, then the right ones: the predator's two wheels come first.
# says: this
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.stack(wheels, axis=1).ravel()
# %% start_always_counted_as_a_step loses 15.1
# The fitness comes from the number of poses, which is one more than the steps.
# says: one fewer than the poses
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     fitness = 1 - len(poses) / maxsteps
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# %% observed_once loses 15.1
# The networks sense the start in every step: what they sense is read once, before the loop.
# says: this
# -     while not arena.done:
# +     seen = np.split(arena.observation.copy(), 2)
# +     while not arena.done:
# -         for network, observation in zip(networks, np.split(arena.observation, 2), strict=True):
# +         for network, observation in zip(networks, seen, strict=True):
# %% prey_drawn_from_n loses 15.7
# The prey are drawn among n individuals, the number of the predators: a generation of prey has m.
# says: this
# -         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))
# +         hunters, hunted = rng.integers(n, size=(rows, n)), rng.integers(n, size=(columns, m))
# %% sides_exchanged_in_play loses 15.2
# The predators play as prey, and the prey as predators.
# says: this
# -     fitness = play(hunters, hunted, pairs, maxsteps)
# +     fitness = play(hunted, hunters, pairs[:, ::-1], maxsteps)
# %% a_generation_twice_in_a_group loses 15.5
# A group may hold a generation twice here: it has three different ones.
# says: this
# -         for b in range(c)
# -         for a in range(b)
# +         for b in range(c + 1)
# +         for a in range(b + 1)
# %% two_matches_make_a_cycle loses 15.5
# Two matches are looked at here: a cycle needs three, of each generation with each other.
# says: this
# -         (wins[a, b] and wins[b, c] and wins[c, a]) or (wins[b, a] and wins[c, b] and wins[a, c])
# +         (wins[a, b] and wins[b, c]) or (wins[b, a] and wins[c, b])
# %% movement_to_the_other_is_forwards loses 15.8
# Backwards is taken as away from the other robot: it is against the robot's own heading.
# says: this
# -     forward = moved[..., 0] * np.cos(heading) + moved[..., 1] * np.sin(heading)
# +     other = before[:, ::-1, :2] - before[..., :2]
# +     forward = (moved * other).sum(axis=-1)
# %% cosine_of_45_rad loses 15.8
# np.cos takes rad: 45 degrees are not 45 rad.
# says: this
# -         "facing": (ahead > np.cos(np.pi / 4) * apart).mean(axis=0),
# +         "facing": (ahead > np.cos(45) * apart).mean(axis=0),


# %% prey_reshaped loses 15.3
# The matrix of the prey is reshaped: this does not exchange rows and columns.
# says: reshaped where it should be transposed
# -     return {"predators": mean, "prey": 1 - mean.T}
# +     return {"predators": mean, "prey": (1 - mean).reshape(mean.shape[::-1])}


# %% own_part_of_the_historical_progress loses 15.6
# Adds up the historical progress for the own part.
# says: this
# -         "own": (matrix[1:] - matrix[0]).mean(axis=1),
# +         "own": np.cumsum(progress(matrix)["historical"]),


# %% networks_anew_in_each_step loses 15.1
# The networks are made anew in each step, and so remember nothing.
# says: this
# -         for network, observation in zip(networks, np.split(arena.observation, 2), strict=True):
# +         networks = robot(predator), robot(prey)
# +         for network, observation in zip(networks, np.split(arena.observation, 2), strict=True):


# %% action_of_the_step_before loses 15.1
# The action of a step is done in the next one: the first step stands still.
# says: this
# -         arena.action = np.concatenate(wheels)
# -         fitness += arena.step()
# +         fitness += arena.step()
# +         arena.action = np.concatenate(wheels)


# %% steps_left_for_the_fitness loses 15.1
# The fitness is the number of steps left, not their share of all steps.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     left = maxsteps - len(poses) + 1
# +     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(left)}


# %% poses_without_headings loses 15.1
# The poses have x and y only: the heading is left out.
# says: this
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.array(poses)[..., :2]
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}


# %% prey_first_in_the_poses loses 15.1
# The prey is the first robot in the poses: the predator comes first.
# says: this|The prey stands first in the poses
# -     return {"poses": np.array(poses), "caught": arena.terminated, "fitness": float(fitness)}
# +     poses = np.array(poses)[:, ::-1].copy()
# +     return {"poses": poses, "caught": arena.terminated, "fitness": float(fitness)}


# %% networks_step_twice loses 15.1
# Each network makes two steps in each step of the arena.
# says: this
# -             wheels.append(network.step().copy())
# +             network.step()
# +             wheels.append(network.step().copy())


# %% prey_stands_still loses 15.1
# Only the predator is moved: the prey's wheels are 0.
# says: this
# -         arena.action = np.concatenate(wheels)
# +         arena.action = np.concatenate([wheels[0], 0 * wheels[1]])


# %% half_of_the_resamples loses 15.7
# Half as many resamples are drawn as are asked for.
# says: this
# -     for _ in range(resamples):
# +     for _ in range(resamples // 2):


# %% pairs_by_generations loses 15.2
# The pairs are listed generation by generation on both sides, but the table is filled predator by predator.
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
# Draws are left out of the share: each counts half.
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
# Leaps of the heading are mended from robot to robot (np.unwrap without axis=0), not from step to step.
# says: this
# -     turned = (after[..., 2] - heading + np.pi) % (2 * np.pi) - np.pi
# +     turned = np.diff(np.unwrap(poses[..., 2]), axis=0)


# %% draws_for_a_cycle loses 15.5
# Three draws count as a cycle, but in a draw nobody wins.
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
# Fills one array for all predators, so that all have the results of the last one.
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
# Changes the transposed view in place, so that the predators' matrix is 1 minus itself, too.
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
# Gives the future competitors from the last generation to the first.
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
# Counts the generations with a mean above 0, not the cases.
# says: this
# -     cases = np.concatenate(ancient)
# +     cases = np.array([row.mean() for row in ancient])


# %% one_direction_for_facing loses 15.8
# Takes the direction from predator to prey for both robots.
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
# Counts x and y as a case each for the walls.
# says: this
# -     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=-1)
# +     to_wall = np.minimum(before[..., :2], 3000 - before[..., :2])
# -         "wall": (to_wall < 300).mean(axis=0),
# +         "wall": (to_wall < 300).mean(axis=(0, 2)),


# %% means_until_that_generation loses 15.6
# Takes the means over the generations up to g, not over all.
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
