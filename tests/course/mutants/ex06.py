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

# %% one_after_the_logistic loses 6.1
# The 1 is added after the logistic function of the forget gate, not inside it.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * (logistic(forget) + 1) + np.tanh(candidate) * logistic(enter)


# %% one_for_the_input_gate loses 6.1
# The 1 is added for the input gate, not for the forget gate.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget) + np.tanh(candidate) * logistic(enter + 1)


# %% action_of_the_step_before loses 6.1
# The action is read from the outputs of the step before.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ memory[1] + brain["bias"])


# %% gates_and_units_mixed_up loses 6.1
# Takes each four rows in turn for the four gates of a unit, but a gate has its ten rows together.
# says: this
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     forget, enter, leave, candidate = (brain["gates"].reshape(40, 18) @ z).reshape(10, 4).T


# %% own_memory_for_all loses 6.1
# Goes on with a memory that it keeps itself, whatever memory is given.
# says: stays from call to call
_think, _own = think, []


def think(brain, observation, memory):
    answer = _think(brain, observation, _own[-1] if _own else memory)
    _own.append(answer[1])
    return answer


# %% end_missing loses 6.2
# The pose after the last step is not recorded.
# says: this
# -     return {"poses": np.array(poses), **{name: np.array(column) for name, column in columns}}
# +     return {"poses": np.array(poses[:-1]), **{name: np.array(column) for name, column in columns}}


# %% drives_on_after_a_collision loses 6.2
# A collision does not end the episode: it always has maxsteps steps.
# says: this
# -     while not arena.done:
# +     for _ in range(maxsteps):


# %% one_step_too_few loses 6.2
# The episode ends one step before maxsteps.
# says: this
# -     while not arena.done:
# +     while not arena.done and len(steps) < maxsteps - 1:


# %% heading_where_it_was loses 6.2
# Puts the robot at x and y of the start, but leaves its heading.
# says: this
# -     arena.robots[0] = start
# +     arena.robots[0, :2] = start[:2]


# %% memory_of_the_last_episode loses 6.2
# Goes on with the memory of the episode before instead of 0.
# says: stays from call to call
# -     memory = np.zeros((2, UNITS))
# -     poses, steps = [arena.robots[0].copy()], []
# +     memory = _LAST[-1]
# +     poses, steps = [arena.robots[0].copy()], []
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory = remember(len(steps) - 1, memory, after)
# +         _LAST.append(memory)
_LAST = [np.zeros((2, UNITS))]


# %% return_so_far loses 6.2
# Records the return so far, not the reward of each step.
# says: this
# -     return {"poses": np.array(poses), **{name: np.array(column) for name, column in columns}}
# +     recording = {name: np.array(column) for name, column in columns}
# +     recording["rewards"] = np.cumsum(recording["rewards"])
# +     return {"poses": np.array(poses), **recording}


# %% sees_after_the_step loses 6.2
# Records what the arena senses after each step, not what the network was given.
# says: this
# -         steps.append((observation, memory, action, arena.step()))
# +         reward = arena.step()
# +         steps.append((arena.observation.copy(), memory, action, reward))


# %% y_before_x loses 6.3
# y changes faster than x.
# says: this
# -     return np.array([(x, y, angle) for y in ys for x in xs for angle in angles])
# +     return np.array([(x, y, angle) for x in xs for y in ys for angle in angles])


# %% headings_in_degrees loses 6.3
# The headings are in degrees.
# says: this
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.arange(headings) * 360 / headings


# %% whole_millimetres loses 6.3
# Cuts the fractions of x and y off.
# says: this
# -     ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
# +     ys, xs = (np.linspace(a, b, places).astype(int) for a, b in ((270, 350), (150, 250)))


# %% from_minus_pi loses 6.3
# The headings begin at minus pi, not at 0.
# says: this
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.arange(headings) * 2 * np.pi / headings - np.pi


# %% search_is_all_without_reward loses 6.4
# Counts all steps without a reward as search, also those after the robot has found the cylinder.
# says: this
# -         "search": search,
# +         "search": int((~near).sum()),


# %% means_of_all_without_reward loses 6.4
# Speed and turning are means over all steps without a reward, not over the search.
# says: this
# -         "speed": mean(forward[:search]),
# -         "turning": mean(turned[:search]),
# +         "speed": mean(forward[~near]),
# +         "turning": mean(turned[~near]),


# %% turning_without_sign loses 6.4
# The turning has lost its sign: left and right no longer cancel out.
# says: this
# -         "turning": mean(turned[:search]),
# +         "turning": mean(np.abs(turned[:search])),


# %% turning_from_zero_on loses 6.4
# The turning lies between 0 and 2 pi: a turn to the right becomes a long one to the left.
# says: this
# -     turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
# +     turned = (after[:, 2] - before[:, 2]) % (2 * np.pi)


# %% turning_in_degrees loses 6.4
# The turning is in degrees.
# says: this
# -         "turning": mean(turned[:search]),
# +         "turning": mean(np.degrees(turned[:search])),


# %% two_walls_only loses 6.4
# Looks only at the left and the lower wall.
# says: this
# -     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
# +     to_wall = before[:, :2].min(axis=1)


# %% corners_only loses 6.4
# Counts a step as near a wall only if two walls are near.
# says: this
# -     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
# +     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).max(axis=1)


# %% steps_at_the_wall loses 6.4
# Counts the steps near a wall: their share is asked for.
# says: this
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": float(np.sum(to_wall[:search] < 72.5)),


# %% walls_after_the_step loses 6.4
# Looks for walls at the end of each step, not at its beginning.
# says: this
# -     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
# +     to_wall = np.minimum(after[:, :2], 400 - after[:, :2]).min(axis=1)


# %% pace_of_all_after_the_search loses 6.4
# The pace is a mean over all steps after the search, also those without a reward.
# says: this
# -         "pace": mean(np.hypot(*moved[near].T)),
# +         "pace": mean(np.hypot(*moved[search:].T)),


# %% sine_of_the_mean loses 6.4
# The side is the sine of the mean angle, not the mean of the sines.
# says: this
# -         "side": mean(np.sin(bearing[near])),
# +         "side": float(np.sin(mean(bearing[near]))),


# %% one_scale_for_all_columns loses 6.5
# Takes mean and deviation of the whole table, not of each column.
# says: this
def standardise(table):
    return (table - table.mean()) / table.std()


# %% distance_of_the_means loses 6.5
# The distance of two families is that of their means, not the mean distance of their robots.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         centres = [rows[group].mean(axis=0) for group in groups]
# +         apart = [np.linalg.norm(centres[i] - centres[j]) for i, j in pairs]


# %% joins_the_first_that_is_near loses 6.5
# Goes through the robots once: each joins the first family that is near, not the nearest ones.
# says: this
def families(table, threshold):
    rows, groups = standardise(table), []
    for robot, row in enumerate(rows):
        for group in groups:
            if np.linalg.norm(rows[group] - row, axis=1).mean() < threshold:
                group.append(robot)
                break
        else:
            groups.append([robot])
    return [next(k for k, group in enumerate(groups) if i in group) for i in range(len(rows))]


# %% largest_family_first loses 6.5
# The largest family has number 0, not that of the first robot.
# says: this
# -     groups.sort(key=min)
# +     groups.sort(key=lambda group: (-len(group), min(group)))


# %% families_weigh_alike loses 6.5
# When two families merge, their distances are averaged whatever their sizes.
# says: this
def families(table, threshold):
    rows = standardise(table)
    apart = np.linalg.norm(rows[:, None] - rows[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    groups = [[robot] for robot in range(len(rows))]
    while len(groups) > 1 and apart.min() < threshold:
        i, j = sorted(np.unravel_index(apart.argmin(), apart.shape))
        apart[i] = apart[:, i] = (apart[i] + apart[j]) / 2
        apart[i, i] = np.inf
        apart = np.delete(np.delete(apart, j, 0), j, 1)
        groups[i] += groups.pop(j)
    groups.sort(key=min)
    return [next(k for k, group in enumerate(groups) if i in group) for i in range(len(rows))]


# %% freezes_a_step_early loses 6.6
# Freezes the memory one step too early.
# says: this
# -     return lambda step, before, after: after if step < since else before
# +     return lambda step, before, after: after if step < since - 1 else before


# %% seeds_run_on loses 6.6
# Goes on counting seeds from one kind of memory to the next, but all three have the same seeds.
# says: this
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# +             episode(brain, start, cylinder, seed + i + len(starts) * len(returns), remember, maxsteps)


# %% reward_of_a_step loses 6.6
# Takes the mean reward of a step, not the return of an episode.
# says: this
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.mean([each["rewards"].mean() for each in episodes]))


# %% sight_left_out loses 6.7
# Shows the network no observation, only the memories.
# says: this
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     return np.array([think(brain, 0 * observation, memory)[0] for memory in memories])


# %% maxsteps_not_handed_on loses 6.6
# Does not hand maxsteps on: the episodes last up to 500 steps.
# says: this
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# +             episode(brain, start, cylinder, seed + i, remember)


# %% frozen_from_step_100 loses 6.6
# Freezes the memory from step 100 on, whatever `since` is.
# says: this
# -     ways = {"keep": keep, "forget": forget, "freeze": freeze(since)}
# +     ways = {"keep": keep, "forget": forget, "freeze": freeze(100)}


# %% bias_after_tanh loses 6.1
# The bias of the wheels is added after tanh.
# says: added after tanh
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ outputs) + brain["bias"]


# %% output_gate_sees_new_cells loses 6.1
# The output gate sees tanh of the new cells instead of the outputs of the step before.
# says: all gates see the same z
def think(brain, observation, memory):
    z = np.concatenate([observation, memory[1]])
    Wf, Wi, Wo, Wc = brain["gates"]
    c = memory[0] * logistic(Wf @ z + 1) + np.tanh(Wc @ z) * logistic(Wi @ z)
    z2 = np.concatenate([observation, np.tanh(c)])
    h = np.tanh(c) * logistic(Wo @ z2)
    return np.tanh(brain["readout"] @ h + brain["bias"]), np.stack([c, h])


# %% rows_exchanged_throughout loses 6.1
# Takes row 0 of the memory for the outputs and row 1 for the cells, old and new.
# says: Cells and outputs are exchanged
def think(brain, observation, memory):
    h, c = memory
    z = np.concatenate([observation, h])
    Wf, Wi, Wo, Wc = brain["gates"]
    c = c * logistic(Wf @ z + 1) + np.tanh(Wc @ z) * logistic(Wi @ z)
    h = np.tanh(c) * logistic(Wo @ z)
    return np.tanh(brain["readout"] @ h + brain["bias"]), np.stack([h, c])


# %% keeps_what_is_not_taken loses 6.1
# Keeps 1 minus the input gate of the old cells: the forget gate is not used.
# says: 1 minus the input gate
def think(brain, observation, memory):
    z = np.concatenate([observation, memory[1]])
    _, i, o = (logistic(brain["gates"][k] @ z + (k == 0)) for k in range(3))
    g = np.tanh(brain["gates"][3] @ z)
    c = memory[0] * (1 - i) + g * i
    h = np.tanh(c) * o
    return np.tanh(brain["readout"] @ h + brain["bias"]), np.stack([c, h])


# %% headings_floored loses 6.3
# Divides the whole turn with `//`, which cuts the fraction off.
# says: fraction of the step between headings is cut off
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.arange(headings) * (2 * np.pi // headings)


# %% near_is_all_after_the_search loses 6.4
# Counts all steps after the search as near the cylinder, for pace and side.
# says: All steps after the search count
def describe(poses, rewards, cylinder):
    n = len(rewards)
    hits = np.flatnonzero(rewards)
    search = int(hits[0]) if len(hits) else n
    p, q = poses[:-1], poses[1:]
    d = q - p
    fwd = d[:, 0] * np.cos(p[:, 2]) + d[:, 1] * np.sin(p[:, 2])
    turn = np.arctan2(np.sin(d[:, 2]), np.cos(d[:, 2]))
    wall = np.minimum.reduce([p[:, 0], p[:, 1], 400 - p[:, 0], 400 - p[:, 1]]) < 72.5
    pace = np.hypot(d[:, 0], d[:, 1])
    side = np.sin(np.arctan2(cylinder[1] - q[:, 1], cylinder[0] - q[:, 0]) - q[:, 2])
    return {
        "search": search,
        "speed": mean(fwd[:search]),
        "turning": mean(turn[:search]),
        "wall": mean(wall[:search]),
        "pace": mean(pace[search:]),
        "side": mean(side[search:]),
    }


# %% search_goes_on_after_the_find loses 6.4
# Speed, turning and wall count all steps without a reward.
# says: the search ends at the first reward
def describe(poses, rewards, cylinder):
    near = rewards == 1
    far = ~near
    search = int(np.argmax(near)) if near.any() else len(rewards)
    d = np.diff(poses, axis=0)
    th = poses[:-1, 2]
    fwd = d[:, 0] * np.cos(th) + d[:, 1] * np.sin(th)
    turn = (d[:, 2] + np.pi) % (2 * np.pi) - np.pi
    x, y = poses[:-1, 0], poses[:-1, 1]
    wall = (x < 72.5) | (x > 327.5) | (y < 72.5) | (y > 327.5)
    pace = np.sqrt(d[:, 0] ** 2 + d[:, 1] ** 2)
    q = poses[1:]
    side = np.sin(np.arctan2(cylinder[1] - q[:, 1], cylinder[0] - q[:, 0]) - q[:, 2])
    return {
        "search": search,
        "speed": mean(fwd[far]),
        "turning": mean(turn[far]),
        "wall": mean(wall[far]),
        "pace": mean(pace[near]),
        "side": mean(side[near]),
    }


# %% short_way_on_one_side loses 6.4
# Takes the short way around in one direction only.
# says: Only one direction is taken the short way
# -     turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
# +     turned = after[:, 2] - before[:, 2]
# +     turned = np.where(turned < -np.pi, turned + 2 * np.pi, turned)


# %% hops_between_rewards loses 6.4
# Measures from one place with a reward to the next such place.
# says: from one place with a reward to the next
def describe(poses, rewards, cylinder):
    near = rewards > 0
    search = int(near.argmax()) if near.any() else len(rewards)
    p, q = poses[:-1], poses[1:]
    d = q - p
    f = d[:, 0] * np.cos(p[:, 2]) + d[:, 1] * np.sin(p[:, 2])
    t = (d[:, 2] + np.pi) % (2 * np.pi) - np.pi
    w = np.minimum(p[:, :2], 400 - p[:, :2]).min(1) < 72.5
    side = np.sin(np.arctan2(cylinder[1] - q[:, 1], cylinder[0] - q[:, 0]) - q[:, 2])
    spots = q[near]
    return {
        "search": search,
        "speed": mean(f[:search]),
        "turning": mean(t[:search]),
        "wall": mean(w[:search]),
        "pace": mean(np.hypot(*np.diff(spots[:, :2], axis=0).T)),
        "side": mean(side[near]),
    }


# %% scales_of_rows loses 6.5
# Brings each row to one scale instead of each column.
# says: not that of each column
# -     deviation = table.std(axis=0)
# -     alike = np.ptp(table, axis=0) == 0  # their deviation may be a rounding error
# -     return np.where(alike, 0.0, (table - table.mean(axis=0)) / np.where(alike, 1.0, deviation))
# +     deviation = table.std(axis=1, keepdims=True)
# +     alike = np.ptp(table, axis=1, keepdims=True) == 0
# +     return np.where(alike, 0.0, (table - table.mean(axis=1, keepdims=True)) / np.where(alike, 1.0, deviation))


# %% deviation_and_a_bit loses 6.5
# Adds 0.01 to the standard deviation.
# says: Your code divides by
def standardise(table):
    return (table - table.mean(axis=0)) / (table.std(axis=0) + 0.01)


# %% first_pair_that_is_near loses 6.5
# Merges the first pair nearer than the threshold, not the two nearest families.
# says: not the two nearest
# -         i, j = pairs[int(np.argmin(apart))]
# +         i, j = next(p for p, a in zip(pairs, apart) if a < threshold)


# %% keeps_the_new_memory_for_good loses 6.6
# Keeps the memory after step `since` of the first episode.
# says: it stays what `before` is
def freeze(since):
    kept = []

    def frozen(step, before, after):
        if step < since:
            return after
        if not kept:
            kept.append(after)
        return kept[0]

    return frozen


# %% median_of_the_returns loses 6.6
# Takes the median of the returns.
# says: The median of the returns
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.median([each["rewards"].sum() for each in episodes]))


# %% reads_the_old_outputs loses 6.7
# Reads the actions from the given outputs without a step of the network.
# says: `think` is not called
def reactions(brain, observation, memories):
    h = memories[:, 1]
    return np.tanh(h @ brain["readout"].T + brain["bias"])


# %% grid_reshaped loses 6.3
# The table of meshgrid is reshaped to rows, which mixes x, y and heading.
# says: reshaped to rows of three
# -     return np.array([(x, y, angle) for y in ys for x in xs for angle in angles])
# +     return np.array(np.meshgrid(xs, ys, angles)).reshape(-1, 3)


# %% memories_reshaped loses 6.7
# The memories are reshaped to cells and outputs, which mixes those of different memories.
# says: mixes those of different memories
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     parts = np.moveaxis(np.asarray(memories).reshape(2, len(memories), -1), 0, 1)
# +     return np.array([think(brain, observation, memory)[0] for memory in parts])


# %% one_memory_for_all_episodes loses 6.2
# All episodes change one memory in place: it does not begin at 0, and its rows are all the last.
# says: something that stays from call to call
# -     memory = np.zeros((2, UNITS))
# +     memory = SHARED
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory[:] = remember(len(steps) - 1, memory, after)
SHARED = np.zeros((2, 10))


# %% memory_changed_in_place loses 6.2
# The memory is changed in place, so that all recorded memories are the last one.
# says: this
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory[:] = remember(len(steps) - 1, memory, after)


# %% reset_without_the_seed loses 6.2
# The arena is reset without the seed, so the noise is another one.
# says: this
# -     arena.reset(seed)
# +     arena.reset()


# %% start_kept_for_all_poses loses 6.2
# Each recorded pose is the start: the robot moves, but its poses are not looked at.
# says: this
# -         poses.append(arena.robots[0].copy())
# +         poses.append(np.array(start, dtype=float))


# %% sensed_before_the_cylinder loses 6.2
# The first observation is renewed after the robot is placed, but before the cylinder is.
# -     arena.objects[0, :2] = cylinder
# -     arena.sense()
# +     arena.sense()
# +     arena.objects[0, :2] = cylinder


# %% last_family_is_taken loses 6.5
# Whatever pair is nearest, the last family in the list is merged into the first one of the pair.
# says: this
# -         groups[i] += groups.pop(j)
# +         groups[i] += groups.pop()


# %% last_family_left_out loses 6.5
# The last family in the list takes part in no merger.
# says: this
# -     while len(groups) > 1:
# +     while len(groups) > 2:
# -         pairs = [(i, j) for j in range(len(groups)) for i in range(j)]
# +         pairs = [(i, j) for j in range(len(groups) - 1) for i in range(j)]


# %% last_robot_of_a_family loses 6.5
# The distance of two families counts only the robot that joined the one of them last.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         apart = [distance[np.ix_(groups[i], groups[j])][-1].mean() for i, j in pairs]


# %% ends_when_the_farthest_are_far loses 6.5
# Merging ends when the two farthest families are not nearer than the threshold.
# says: this
# -         if min(apart) >= threshold:
# +         if max(apart) >= threshold:


# %% all_from_the_first_start loses 6.6
# All episodes begin at the first start.
# says: this
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# +             episode(brain, starts[0], cylinder, seed + i, remember, maxsteps)


# %% forgets_and_returns_nothing loses 6.6
# Empties the array that `forget` is given, and returns None instead of a memory.
# says: this
def forget(step, before, after):
    after[:] = 0


# %% memory_of_the_reaction_before loses 6.7
# Each reaction has the memory of the one before in the list; the first one has the last memory.
# says: this
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     return np.array([think(brain, observation, memories[i - 1])[0] for i in range(len(memories))])


# %% corners_count_twice loses 6.4
# A step in a corner, near two walls, counts twice: it is one step near a wall.
# says: this
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": sum(
# +             mean(gap[:search] < 72.5)
# +             for gap in (
# +                 before[:, 0],
# +                 before[:, 1],
# +                 400 - before[:, 0],
# +                 400 - before[:, 1],
# +             )
# +         ),


# %% reactions_without_the_one loses 6.7
# Computes the step anew, without the 1 that is added for the forget gate: use think.
# says: this
def reactions(brain, observation, memories):
    memories = np.asarray(memories)
    cells, outputs = memories[:, 0], memories[:, 1]
    z = np.hstack([np.tile(observation, (len(memories), 1)), outputs])
    f, i, o, c = (z @ gate.T for gate in brain["gates"])
    cells = cells * logistic(f) + logistic(i) * np.tanh(c)
    outputs = logistic(o) * np.tanh(cells)
    return np.tanh(outputs @ brain["readout"].T + brain["bias"])


# %% frozen_in_one_step_only loses 6.6
# Holds the memory in step `since` only, not from then on.
# says: this
# -     return lambda step, before, after: after if step < since else before
# +     return lambda step, before, after: before if step == since else after


# %% central_differences_of_poses loses 6.4
# Takes central differences (np.gradient) for the movement of a step.
# says: this
def describe(poses, rewards, cylinder):
    x, y, heading = poses.T
    dx, dy = np.gradient(x)[:-1], np.gradient(y)[:-1]
    turn = np.gradient(np.unwrap(heading))[:-1]
    theta = heading[:-1]
    found = np.flatnonzero(rewards)
    search = int(found[0]) if found.size else len(rewards)
    gap = np.min([x, y, 400 - x, 400 - y], axis=0)[:-1]
    towards = np.arctan2(cylinder[1] - y[1:], cylinder[0] - x[1:])
    return {
        "search": search,
        "speed": mean((dx * np.cos(theta) + dy * np.sin(theta))[:search]),
        "turning": mean(turn[:search]),
        "wall": mean(gap[:search] < 72.5),
        "pace": mean(np.sqrt(dx**2 + dy**2)[found]),
        "side": mean(np.sin(towards - heading[1:])[found]),
    }


# %% inconsistency_for_distance loses 6.5
# Calls fcluster without criterion="distance": the threshold is compared with something else.
# says: this
def families(table, threshold):
    from scipy.cluster.hierarchy import fcluster, linkage

    if len(table) < 2:
        return [0] * len(table)
    tree = linkage(standardise(table), method="average")
    labels = fcluster(tree, np.nextafter(threshold, -np.inf))
    order = list(dict.fromkeys(labels))
    return [order.index(label) for label in labels]


# %% square_distances_for_linkage loses 6.5
# Gives linkage the square matrix of distances, whose rows it takes for positions: it needs the condensed form.
# says: this
def families(table, threshold):
    from scipy.cluster.hierarchy import fcluster, linkage
    from scipy.spatial.distance import cdist

    rows = standardise(table)
    if len(rows) < 2:
        return [0] * len(rows)
    distances = cdist(rows, rows)
    tree = linkage(distances, "average")
    labels = fcluster(tree, np.nextafter(threshold, -np.inf), criterion="distance")
    names = {}
    return [names.setdefault(label, len(names)) for label in labels]


# %% x_repeated_and_tiled_the_other_way loses 6.3
# Exchanges repeat and tile for x, so that some starts come twice and others never.
# says: this
def grid(places, headings):
    x = np.linspace(150, 250, places)
    y = np.linspace(270, 350, places)
    turn = np.linspace(0, 2 * np.pi, headings, endpoint=False)
    return np.column_stack(
        [
            np.repeat(np.tile(x, headings), places),
            np.repeat(y, places * headings),
            np.tile(turn, places * places),
        ]
    )


# %% forgets_what_it_should_keep loses 6.1
# Takes the forget gate for the share that is forgotten: 1 minus it multiplies the old cells.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * (1 - logistic(forget + 1)) + np.tanh(candidate) * logistic(enter)
