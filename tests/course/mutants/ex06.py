"""Wrong solutions of exercise 6; building.py describes how a case is written."""


# %% forget_gate_without_one loses 6.1
# The 1 that opens the forget gate is left out.
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget) + np.tanh(candidate) * logistic(enter)


# %% gates_in_another_order loses 6.1
# The input gate is taken for the forget gate.
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     enter, forget, leave, candidate = brain["gates"] @ z

# %% memory_overwritten loses 6.1
# The new memory is written into the array of the old one.
# says: in place
_think = think


def think(brain, observation, memory):
    action, after = _think(brain, observation, memory)
    memory[:] = after
    return action, memory


# %% counts_from_one loses 6.2
# Tells `remember` that the first step is number 1.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    def later(step, before, after):
        return remember(step + 1, before, after)

    return _episode(brain, start, cylinder, seed, later, maxsteps)


# %% cylinder_where_it_was loses 6.2
# Leaves the cylinder where the seed has put it.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim")
    arena.reset(seed)
    return _episode(brain, start, arena.objects[0, :2], seed, remember, maxsteps)


# %% memory_after_the_step loses 6.2
# Records the memory after each step, not the one that the network was given.
# says: one place too early
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    last = think(brain, recording["observations"][-1], recording["memories"][-1])[1]
    recording["memories"] = np.concatenate([recording["memories"][1:], last[None]])
    return recording


# %% poses_not_copied loses 6.2
# Keeps a window on the arena instead of the pose of each step.
# says: Keep a copy each time \(.copy\(\)\)
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    recording["poses"] = np.tile(recording["poses"][-1], (len(recording["poses"]), 1))
    return recording


# %% remembers_always loses 6.2
# Does not ask what is to be remembered.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    return _episode(brain, start, cylinder, seed, keep, maxsteps)


# %% start_missing loses 6.2
# Keeps no pose of the start.
# says: The first one is missing
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    return {**recording, "poses": recording["poses"][1:]}


# %% heading_slowest loses 6.3
# Goes through all places with one heading, then with the next.
# says: in another order
_grid = grid


def grid(places, headings):
    starts = _grid(places, headings)
    return starts[np.argsort(starts[:, 2], kind="stable")]


# %% whole_turn_twice loses 6.3
# Has the headings 0 and 2 pi, which are the same.
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.linspace(0, 2 * np.pi, headings)


# %% nothing_has_no_mean loses 6.4
# Gives NaN where no step belongs to the search or to the time near the cylinder.
# says: NaN
def mean(values):
    return float(np.sum(values)) / len(values) if len(values) else float("nan")


# %% search_with_the_find loses 6.4
# Counts the first step near the cylinder as part of the search.
# says: one more than expected
_describe = describe


def describe(poses, rewards, cylinder):
    search = _describe(poses, rewards, cylinder)["search"] + 1
    early = _describe(poses[: search + 1], np.zeros(min(search, len(rewards))), cylinder)
    late = _describe(poses, rewards, cylinder)
    return {**early, "pace": late["pace"], "side": late["side"]}


# %% side_before_the_step loses 6.4
# Looks for the cylinder from where the robot was before the step.
_describe = describe


def describe(poses, rewards, cylinder):
    away = np.asarray(cylinder) - poses[:-1, :2]
    bearing = np.arctan2(away[:, 1], away[:, 0]) - poses[:-1, 2]
    told = _describe(poses, rewards, cylinder)
    return {**told, "side": mean(np.sin(bearing[rewards > 0]))}


# %% speed_without_sign loses 6.4
# Measures how far the robot moves, be it forwards or backwards.
_describe = describe


def describe(poses, rewards, cylinder):
    told = _describe(poses, rewards, cylinder)
    moved = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    return {**told, "speed": mean(moved[: told["search"]])}


# %% turning_leaps loses 6.4
# A heading that goes beyond the whole turn counts as a turn back.
_describe = describe


def describe(poses, rewards, cylinder):
    told = _describe(poses, rewards, cylinder)
    return {**told, "turning": mean(np.diff(poses[:, 2])[: told["search"]])}


# %% wall_includes_its_limit loses 6.4
# A robot exactly 72.5 mm from a wall counts as near it.
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": mean(to_wall[:search] <= 72.5),


# %% divides_by_rounding loses 6.5
# Asks whether the deviation is exactly 0, which rounding prevents.
def standardise(table):
    deviation = table.std(axis=0)
    return (table - table.mean(axis=0)) / np.where(deviation == 0, 1.0, deviation)


# %% nearest_relative loses 6.5
# A family is as near as its nearest robot.
def families(table, threshold):
    rows = standardise(table)
    labels = np.arange(len(rows))
    for i in range(len(rows)):
        for j in range(i):
            if np.linalg.norm(rows[i] - rows[j]) < threshold:
                labels[labels == labels[i]] = labels[j]
    names = list(dict.fromkeys(labels.tolist()))
    return [names.index(label) for label in labels]


# %% numbered_backwards loses 6.5
# The family of the first robot has the highest number.
_families = families


def families(table, threshold):
    labels = _families(table, threshold)
    return [max(labels) - label for label in labels]


# %% sample_deviation loses 6.5
# Divides by n - 1 in the standard deviation.
# says: n and n - 1 were mixed up
# -     deviation = table.std(axis=0)
# +     deviation = table.std(axis=0, ddof=1)


# %% scales_as_they_are loses 6.5
# Compares steps, millimetres and radians.
_families = families


def families(table, threshold):
    global standardise
    proper, standardise = standardise, lambda table: np.asarray(table)
    try:
        return _families(table, threshold)
    finally:
        standardise = proper


# %% merges_at_the_threshold loses 6.5
# Families exactly as far apart as the threshold are merged.
# -         if min(apart) >= threshold:
# +         if min(apart) > threshold:


# %% freezes_a_step_late loses 6.6
# Lets the memory change once more in step `since`.
def freeze(since):
    return lambda step, before, after: after if step <= since else before


# %% frozen_is_forgotten loses 6.6
# Empties the memory instead of freezing it.
# says: All values are 0
def freeze(since):
    return lambda step, before, after: after if step < since else np.zeros_like(after)


# %% total_not_mean loses 6.6
# Adds the returns of all episodes.
# says: a sum|the sum
_memory_test = memory_test


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    returns = _memory_test(brain, starts, cylinder, seed, since, maxsteps)
    return {name: value * len(starts) for name, value in returns.items()}


# %% memory_goes_on loses 6.7
# Carries the memory on from one reaction to the next.
def reactions(brain, observation, memories):
    actions, memory = [], memories[0]
    for _ in memories:
        action, memory = think(brain, observation, memory)
        actions.append(action)
    return np.array(actions)


# %% only_cells loses 6.7
# Shows the network the cells, but not the outputs of the step before.
_reactions = reactions


def reactions(brain, observation, memories):
    memories = np.array(memories)
    memories[:, 1] = 0
    return _reactions(brain, observation, memories)


# %% outputs_without_tanh loses 6.1
# The new cells go to the outputs without tanh.
# says: this
# -     outputs = np.tanh(cells) * logistic(leave)
# +     outputs = cells * logistic(leave)


# %% candidate_by_logistic loses 6.1
# The candidate goes through the logistic function instead of tanh.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget + 1) + logistic(candidate) * logistic(enter)


# %% cells_for_outputs loses 6.1
# The network sees its cells instead of its outputs of the step before.
# says: this
# -     z = np.concatenate([observation, memory[1]])
# +     z = np.concatenate([observation, memory[0]])


# %% rows_of_memory_exchanged loses 6.1
# The rows of the new memory are exchanged: the outputs stand before the cells.
# says: this
# -     return action, np.stack([cells, outputs])
# +     return action, np.stack([outputs, cells])


# %% outputs_before_observation loses 6.1
# The outputs of the step before stand in front of the observation instead of behind it.
# says: this
# -     z = np.concatenate([observation, memory[1]])
# +     z = np.concatenate([memory[1], observation])


# %% action_without_tanh loses 6.1
# The action is not put through tanh.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = brain["readout"] @ outputs + brain["bias"]


# %% action_of_the_cells loses 6.1
# The action is read from the cells instead of the outputs.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ cells + brain["bias"])


# %% old_cells_kept_whole loses 6.1
# The forget gate is not applied: the old cells are kept whole.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] + np.tanh(candidate) * logistic(enter)


# %% shows_the_old_cells loses 6.1
# The outputs show the cells of the step before, not the new ones.
# -     outputs = np.tanh(cells) * logistic(leave)
# +     outputs = np.tanh(memory[0]) * logistic(leave)


# %% input_gate_is_the_rest loses 6.1
# The input gate is 1 minus the forget gate, not a gate of its own.
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     kept = logistic(forget + 1)
# +     cells = memory[0] * kept + np.tanh(candidate) * (1 - kept)


# %% readout_without_bias loses 6.1
# The bias of the two wheels is left out.
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ outputs)


# %% five_hundred_steps_always loses 6.2
# An episode lasts up to 500 steps, whatever is asked for.
# -     arena = arenas.make("discrim", max_steps=maxsteps)
# +     arena = arenas.make("discrim", max_steps=500)


# %% seed_not_used loses 6.2
# The arena is reset with the same seed in every episode.
# -     arena.reset(seed)
# +     arena.reset(0)


# %% sensed_before_it_was_moved loses 6.2
# The first observation is that of the place where the seed has put the robot.
# -     arena.robots[0] = start
# -     arena.objects[0, :2] = cylinder
# -     arena.sense()
# +     arena.robots[0] = start
# +     arena.objects[0, :2] = cylinder


# %% upper_end_left_out loses 6.3
# The last place of each row is left out of the range: the upper ends are missing.
# says: this
# -     ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
# +     steps = np.arange(places) / places
# +     ys, xs = 270 + 80 * steps, 150 + 100 * steps


# %% never_near_searches_nothing loses 6.4
# A robot that never gets near the cylinder has a search of 0 steps.
# says: search is 0, but
# -     search = int(near.argmax()) if near.any() else len(rewards)
# +     search = int(near.argmax())


# %% pace_forwards loses 6.4
# The pace counts the way forwards alone, with its sign.
# says: this
# -         "pace": mean(np.hypot(*moved[near].T)),
# +         "pace": mean(forward[near]),


# %% wall_of_the_whole_episode loses 6.4
# The time near a wall is that of the whole episode, not of the search.
# says: this
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": mean(to_wall < 72.5),


# %% side_in_the_arena loses 6.4
# The side is where the cylinder lies in the arena, not as the robot sees it.
# says: this
# -     bearing = np.arctan2(away[:, 1], away[:, 0]) - after[:, 2]
# +     bearing = np.arctan2(away[:, 1], away[:, 0])


# %% farthest_relative loses 6.5
# Two families are as far apart as their most different robots.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         apart = [distance[np.ix_(groups[i], groups[j])].max() for i, j in pairs]


# %% city_blocks loses 6.5
# The distance is the sum of the differences, not the straight line.
# says: this
# -     distance = np.linalg.norm(rows[:, None] - rows[None], axis=2)
# +     distance = np.abs(rows[:, None] - rows[None]).sum(axis=2)


# %% frozen_from_the_first_episode loses 6.6
# The frozen memory is that of the first episode: it is kept from one episode to the next.
def freeze(since):
    kept = []

    def remember(step, before, after):
        if step < since:
            return after
        kept.append(before)
        return kept[0]

    return remember


# %% one_seed_for_all_starts loses 6.6
# All episodes have the same seed.
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# -             for i, start in enumerate(starts)
# +             episode(brain, start, cylinder, seed, remember, maxsteps)
# +             for start in starts


# %% last_reward_for_the_return loses 6.6
# The return is the reward of the last step.
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.mean([each["rewards"][-1] for each in episodes]))


# %% forgets_the_cells_alone loses 6.6
# Only the cells are forgotten: the outputs of the step before stay.
def forget(step, before, after):
    return np.stack([np.zeros_like(after[0]), after[1]])


# %% memories_are_averaged loses 6.7
# Reacts with the mean of all memories.
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     mean_memory = np.mean(memories, axis=0)
# +     return np.array([think(brain, observation, mean_memory)[0] for memory in memories])
