"""Wrong solutions of exercise 6; building.py describes how a case is written."""


# %% forget_gate_without_one loses 6.1
# Leaves out the 1 that should be added to the forget gate's net input.
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget) + np.tanh(candidate) * logistic(enter)


# %% gates_in_another_order loses 6.1
# Takes gates[0] for the input gate and gates[1] for the forget gate, but gates[0] should be the forget gate and gates[1] the input gate.
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     enter, forget, leave, candidate = brain["gates"] @ z

# %% memory_overwritten loses 6.1
# Writes the new memory into the array `memory`, but the arrays given should stay as they are.
# says: in place
_think = think


def think(brain, observation, memory):
    action, after = _think(brain, observation, memory)
    memory[:] = after
    return action, memory


# %% counts_from_one loses 6.2
# Tells `remember` that the first step is number 1, but it should be number 0.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    def later(step, before, after):
        return remember(step + 1, before, after)

    return _episode(brain, start, cylinder, seed, later, maxsteps)


# %% cylinder_where_it_was loses 6.2
# Leaves the cylinder where the seed has put it, but it should be at the given place.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim")
    arena.reset(seed)
    return _episode(brain, start, arena.objects[0, :2], seed, remember, maxsteps)


# %% memory_after_the_step loses 6.2
# Records the memory after each step, not the one that the network was given.
# says: this
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    last = think(brain, recording["observations"][-1], recording["memories"][-1])[1]
    recording["memories"] = np.concatenate([recording["memories"][1:], last[None]])
    return recording


# %% poses_not_copied loses 6.2
# Gives the last pose in every row of poses, but the start and the pose after each step are asked for (arena.robots changes: copy it each time).
# says: this
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    recording["poses"] = np.tile(recording["poses"][-1], (len(recording["poses"]), 1))
    return recording


# %% remembers_always loses 6.2
# Keeps the new memory of `think` for the next step, whatever `remember` returns.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    return _episode(brain, start, cylinder, seed, keep, maxsteps)


# %% start_missing loses 6.2
# Leaves the start out of poses, but it should be their first row.
# says: this
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    return {**recording, "poses": recording["poses"][1:]}


# %% heading_slowest loses 6.3
# Goes through all places with one heading, then with the next, but the heading should change fastest.
# says: this
_grid = grid


def grid(places, headings):
    starts = _grid(places, headings)
    return starts[np.argsort(starts[:, 2], kind="stable")]


# %% whole_turn_twice loses 6.3
# Divides the whole turn so that the last heading is 2 pi, but 2 pi is 0 again and should be left out.
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.linspace(0, 2 * np.pi, headings)


# %% nothing_has_no_mean loses 6.4
# Gives NaN where no step belongs to the search or to the steps near the cylinder, but 0 is asked for.
# says: this
def mean(values):
    return float(np.sum(values)) / len(values) if len(values) else float("nan")


# %% search_with_the_find loses 6.4
# Makes the search one step too long, but it should end before the first step with a reward.
# says: this
_describe = describe


def describe(poses, rewards, cylinder):
    search = _describe(poses, rewards, cylinder)["search"] + 1
    early = _describe(poses[: search + 1], np.zeros(min(search, len(rewards))), cylinder)
    late = _describe(poses, rewards, cylinder)
    return {**early, "pace": late["pace"], "side": late["side"]}


# %% side_before_the_step loses 6.4
# Takes the side from the pose before the step, not from that after it.
_describe = describe


def describe(poses, rewards, cylinder):
    away = np.asarray(cylinder) - poses[:-1, :2]
    bearing = np.arctan2(away[:, 1], away[:, 0]) - poses[:-1, 2]
    told = _describe(poses, rewards, cylinder)
    return {**told, "side": mean(np.sin(bearing[rewards > 0]))}


# %% speed_without_sign loses 6.4
# Takes for the speed how far the robot moves in any direction, but the way along its heading is asked for, negative when it drives backwards.
_describe = describe


def describe(poses, rewards, cylinder):
    told = _describe(poses, rewards, cylinder)
    moved = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    return {**told, "speed": mean(moved[: told["search"]])}


# %% turning_leaps loses 6.4
# Takes the change of the heading as it is, but the short way around is asked for.
_describe = describe


def describe(poses, rewards, cylinder):
    told = _describe(poses, rewards, cylinder)
    return {**told, "turning": mean(np.diff(poses[:, 2])[: told["search"]])}


# %% wall_includes_its_limit loses 6.4
# Counts a robot exactly 72.5 mm from a wall as near it, but only nearer ones should count.
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": mean(to_wall[:search] <= 72.5),


# %% divides_by_rounding loses 6.5
# Gives 1 or -1 in a column of equal values whose standard deviation is a rounding error instead of exactly 0, but 0 is asked for.
def standardise(table):
    deviation = table.std(axis=0)
    return (table - table.mean(axis=0)) / np.where(deviation == 0, 1.0, deviation)


# %% nearest_relative loses 6.5
# Takes the distance of the two nearest robots for that of two families, but the mean over all pairs of robots is asked for.
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
# Numbers the families in the opposite order, but the family of the first robot should be 0.
_families = families


def families(table, threshold):
    labels = _families(table, threshold)
    return [max(labels) - label for label in labels]


# %% sample_deviation loses 6.5
# Divides by n - 1 in the standard deviation, but n is asked for (ddof=0).
# says: this
# -     deviation = table.std(axis=0)
# +     deviation = table.std(axis=0, ddof=1)


# %% scales_as_they_are loses 6.5
# Compares the descriptors as they are, but they should be standardised first.
_families = families


def families(table, threshold):
    global standardise
    proper, standardise = standardise, lambda table: np.asarray(table)
    try:
        return _families(table, threshold)
    finally:
        standardise = proper


# %% merges_at_the_threshold loses 6.5
# Merges families exactly as far apart as the threshold, but they should be nearer than it.
# -         if min(apart) >= threshold:
# +         if min(apart) > threshold:


# %% freezes_a_step_late loses 6.6
# Lets the memory change once more in step `since`, but it should stay the same from that step on.
def freeze(since):
    return lambda step, before, after: after if step <= since else before


# %% frozen_is_forgotten loses 6.6
# Empties the memory from step `since` on, but it should stay as it was before that step.
# says: this
def freeze(since):
    return lambda step, before, after: after if step < since else np.zeros_like(after)


# %% total_not_mean loses 6.6
# Adds the returns of all episodes, but their mean is asked for.
# says: this
_memory_test = memory_test


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    returns = _memory_test(brain, starts, cylinder, seed, since, maxsteps)
    return {name: value * len(starts) for name, value in returns.items()}


# %% memory_goes_on loses 6.7
# Hands the new memory on from one reaction to the next, but each reaction should have the memory given for it.
def reactions(brain, observation, memories):
    actions, memory = [], memories[0]
    for _ in memories:
        action, memory = think(brain, observation, memory)
        actions.append(action)
    return np.array(actions)


# %% only_cells loses 6.7
# Uses only the cells of each memory, but should use its outputs, too.
_reactions = reactions


def reactions(brain, observation, memories):
    memories = np.array(memories)
    memories[:, 1] = 0
    return _reactions(brain, observation, memories)


# %% outputs_without_tanh loses 6.1
# Leaves out tanh of the new cells in the outputs.
# says: this
# -     outputs = np.tanh(cells) * logistic(leave)
# +     outputs = cells * logistic(leave)


# %% candidate_by_logistic loses 6.1
# Puts the candidate through the logistic function instead of tanh.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget + 1) + logistic(candidate) * logistic(enter)


# %% cells_for_outputs loses 6.1
# Puts the old cells into z instead of the outputs of the step before.
# says: this
# -     z = np.concatenate([observation, memory[1]])
# +     z = np.concatenate([observation, memory[0]])


# %% rows_of_memory_exchanged loses 6.1
# Puts the outputs before the cells in the new memory, but the cells should come first.
# says: this
# -     return action, np.stack([cells, outputs])
# +     return action, np.stack([outputs, cells])


# %% outputs_before_observation loses 6.1
# Puts the outputs of the step before in front of the observation in z, but they should come behind it.
# says: this
# -     z = np.concatenate([observation, memory[1]])
# +     z = np.concatenate([memory[1], observation])


# %% action_without_tanh loses 6.1
# Leaves out tanh of the action.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = brain["readout"] @ outputs + brain["bias"]


# %% action_of_the_cells loses 6.1
# Reads the action from the new cells instead of the new outputs.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ cells + brain["bias"])


# %% old_cells_kept_whole loses 6.1
# Leaves out the forget gate, so that the old cells are kept whole.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] + np.tanh(candidate) * logistic(enter)


# %% shows_the_old_cells loses 6.1
# Computes the new outputs from the old cells instead of the new ones.
# -     outputs = np.tanh(cells) * logistic(leave)
# +     outputs = np.tanh(memory[0]) * logistic(leave)


# %% input_gate_is_the_rest loses 6.1
# Takes 1 minus the forget gate for the input gate, which should have weights of its own.
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     kept = logistic(forget + 1)
# +     cells = memory[0] * kept + np.tanh(candidate) * (1 - kept)


# %% readout_without_bias loses 6.1
# Leaves out the bias of the two wheels.
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ outputs)


# %% five_hundred_steps_always loses 6.2
# Lets the episode last up to 500 steps, whatever maxsteps is.
# -     arena = arenas.make("discrim", max_steps=maxsteps)
# +     arena = arenas.make("discrim", max_steps=500)


# %% seed_not_used loses 6.2
# Resets the arena with the seed 0 in every episode, but should reset it with `seed`.
# -     arena.reset(seed)
# +     arena.reset(0)


# %% sensed_before_it_was_moved loses 6.2
# Takes the first observation from the places where the seed has put robot and cylinder, not from the given places.
# -     arena.robots[0] = start
# -     arena.objects[0, :2] = cylinder
# -     arena.sense()
# +     arena.robots[0] = start
# +     arena.objects[0, :2] = cylinder


# %% upper_end_left_out loses 6.3
# Leaves out the upper ends of x and y, but both ends should be included.
# says: this
# -     ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
# +     steps = np.arange(places) / places
# +     ys, xs = 270 + 80 * steps, 150 + 100 * steps


# %% never_near_searches_nothing loses 6.4
# Gives a search of 0 steps if there is no reward, but all steps should belong to the search then.
# says: this
# -     search = int(near.argmax()) if near.any() else len(rewards)
# +     search = int(near.argmax())


# %% pace_forwards loses 6.4
# Takes for the pace the way along the heading, with its sign, but the length of the way is asked for.
# says: this
# -         "pace": mean(np.hypot(*moved[near].T)),
# +         "pace": mean(forward[near]),


# %% wall_of_the_whole_episode loses 6.4
# Takes "wall" over the whole episode, not over the search alone.
# says: this
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": mean(to_wall < 72.5),


# %% side_in_the_arena loses 6.4
# Takes the sine of the direction of the cylinder without subtracting the heading.
# says: this
# -     bearing = np.arctan2(away[:, 1], away[:, 0]) - after[:, 2]
# +     bearing = np.arctan2(away[:, 1], away[:, 0])


# %% farthest_relative loses 6.5
# Takes the distance of the two most different robots for that of two families, but the mean over all pairs of robots is asked for.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         apart = [distance[np.ix_(groups[i], groups[j])].max() for i, j in pairs]


# %% city_blocks loses 6.5
# Takes the sum of the absolute differences for the distance of two robots, but the length of the difference is asked for.
# says: this
# -     distance = np.linalg.norm(rows[:, None] - rows[None], axis=2)
# +     distance = np.abs(rows[:, None] - rows[None]).sum(axis=2)


# %% frozen_from_the_first_episode loses 6.6
# Keeps the frozen memory of the first episode for the later ones, but each episode should freeze its own.
def freeze(since):
    kept = []

    def remember(step, before, after):
        if step < since:
            return after
        kept.append(before)
        return kept[0]

    return remember


# %% one_seed_for_all_starts loses 6.6
# Gives all episodes the same seed, but that from starts[i] should have `seed + i`.
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# -             for i, start in enumerate(starts)
# +             episode(brain, start, cylinder, seed, remember, maxsteps)
# +             for start in starts


# %% last_reward_for_the_return loses 6.6
# Takes the reward of the last step for the return, but the sum of all rewards is asked for.
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.mean([each["rewards"][-1] for each in episodes]))


# %% forgets_the_cells_alone loses 6.6
# Sets only the cells to 0, but the outputs should be 0, too.
def forget(step, before, after):
    return np.stack([np.zeros_like(after[0]), after[1]])


# %% memories_are_averaged loses 6.7
# Reacts with the mean of all memories each time, but each reaction should have the memory given for it.
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     mean_memory = np.mean(memories, axis=0)
# +     return np.array([think(brain, observation, mean_memory)[0] for memory in memories])

# %% one_after_the_logistic loses 6.1
# Adds the 1 after the logistic function of the forget gate, but it should be added inside.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * (logistic(forget) + 1) + np.tanh(candidate) * logistic(enter)


# %% one_for_the_input_gate loses 6.1
# Adds the 1 to the net input of the input gate instead of the forget gate.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget) + np.tanh(candidate) * logistic(enter + 1)


# %% action_of_the_step_before loses 6.1
# Reads the action from the outputs of the step before instead of the new ones.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ memory[1] + brain["bias"])


# %% gates_and_units_mixed_up loses 6.1
# Takes each four of the 40 rows in turn for the four gates of one unit, but each gate has its ten rows together.
# says: this
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     forget, enter, leave, candidate = (brain["gates"].reshape(40, 18) @ z).reshape(10, 4).T


# %% own_memory_for_all loses 6.1
# Goes on with the memory of the call before, whatever `memory` is given.
# says: stays from call to call
_think, _own = think, []


def think(brain, observation, memory):
    answer = _think(brain, observation, _own[-1] if _own else memory)
    _own.append(answer[1])
    return answer


# %% end_missing loses 6.2
# Leaves the pose after the last step out of poses.
# says: this
# -     return {"poses": np.array(poses), **{name: np.array(column) for name, column in columns}}
# +     return {"poses": np.array(poses[:-1]), **{name: np.array(column) for name, column in columns}}


# %% drives_on_after_a_collision loses 6.2
# Goes on to maxsteps after a collision, but the episode should end with it.
# says: this
# -     while not arena.done:
# +     for _ in range(maxsteps):


# %% one_step_too_few loses 6.2
# Ends the episode one step before maxsteps.
# says: this
# -     while not arena.done:
# +     while not arena.done and len(steps) < maxsteps - 1:


# %% heading_where_it_was loses 6.2
# Puts the robot at x and y of the start, but leaves the heading that the seed has given it.
# says: this
# -     arena.robots[0] = start
# +     arena.robots[0, :2] = start[:2]


# %% memory_of_the_last_episode loses 6.2
# Begins with the memory that the episode before has left, but it should begin with 0.
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
# Lets y change faster than x, but x should change faster than y.
# says: this
# -     return np.array([(x, y, angle) for y in ys for x in xs for angle in angles])
# +     return np.array([(x, y, angle) for x in xs for y in ys for angle in angles])


# %% headings_in_degrees loses 6.3
# Gives the headings in degrees instead of radians.
# says: this
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.arange(headings) * 360 / headings


# %% whole_millimetres loses 6.3
# Cuts the fractions of x and y off, but they should be kept.
# says: this
# -     ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
# +     ys, xs = (np.linspace(a, b, places).astype(int) for a, b in ((270, 350), (150, 250)))


# %% from_minus_pi loses 6.3
# Begins the headings at minus pi instead of 0.
# says: this
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.arange(headings) * 2 * np.pi / headings - np.pi


# %% search_is_all_without_reward loses 6.4
# Counts all steps without a reward as search, but the search should end at the first reward.
# says: this
# -         "search": search,
# +         "search": int((~near).sum()),


# %% means_of_all_without_reward loses 6.4
# Takes speed and turning over all steps without a reward, not over the search alone.
# says: this
# -         "speed": mean(forward[:search]),
# -         "turning": mean(turned[:search]),
# +         "speed": mean(forward[~near]),
# +         "turning": mean(turned[~near]),


# %% turning_without_sign loses 6.4
# Takes the absolute value of the turning in each step, but turns to the right should be negative.
# says: this
# -         "turning": mean(turned[:search]),
# +         "turning": mean(np.abs(turned[:search])),


# %% turning_from_zero_on loses 6.4
# Takes a turn to the right for a long one to the left, from 0 to 2 pi, but the short way around is asked for.
# says: this
# -     turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
# +     turned = (after[:, 2] - before[:, 2]) % (2 * np.pi)


# %% turning_in_degrees loses 6.4
# Gives the turning in degrees instead of radians.
# says: this
# -         "turning": mean(turned[:search]),
# +         "turning": mean(np.degrees(turned[:search])),


# %% two_walls_only loses 6.4
# Looks only at the left and the lower wall, but should look at all four.
# says: this
# -     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
# +     to_wall = before[:, :2].min(axis=1)


# %% corners_only loses 6.4
# Counts a step as near a wall only if two walls are near, but one should be enough.
# says: this
# -     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
# +     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).max(axis=1)


# %% steps_at_the_wall loses 6.4
# Counts the steps near a wall, but their share of the search is asked for.
# says: this
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": float(np.sum(to_wall[:search] < 72.5)),


# %% walls_after_the_step loses 6.4
# Looks for walls at the end of each step, not at its beginning.
# says: this
# -     to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
# +     to_wall = np.minimum(after[:, :2], 400 - after[:, :2]).min(axis=1)


# %% pace_of_all_after_the_search loses 6.4
# Takes the pace over all steps after the search, not only over those with a reward.
# says: this
# -         "pace": mean(np.hypot(*moved[near].T)),
# +         "pace": mean(np.hypot(*moved[search:].T)),


# %% sine_of_the_mean loses 6.4
# Takes the sine of the mean angle for the side, but the mean of the sines is asked for.
# says: this
# -         "side": mean(np.sin(bearing[near])),
# +         "side": float(np.sin(mean(bearing[near]))),


# %% one_scale_for_all_columns loses 6.5
# Takes the mean and the standard deviation of the whole table instead of each column.
# says: this
def standardise(table):
    return (table - table.mean()) / table.std()


# %% distance_of_the_means loses 6.5
# Takes the distance of the mean rows of two families, but the mean distance over all pairs of their robots is asked for.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         centres = [rows[group].mean(axis=0) for group in groups]
# +         apart = [np.linalg.norm(centres[i] - centres[j]) for i, j in pairs]


# %% joins_the_first_that_is_near loses 6.5
# Puts each robot in turn into the first family that is near, but the two nearest families should be merged, again and again.
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
# Gives the number 0 to the largest family, but the family of the first robot should have it.
# says: this
# -     groups.sort(key=min)
# +     groups.sort(key=lambda group: (-len(group), min(group)))


# %% families_weigh_alike loses 6.5
# Averages the distances of two merged families whatever their sizes, but the mean over all pairs of robots is asked for.
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
# Goes on counting seeds from one kind of memory to the next, but all three should have the same seeds.
# says: this
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# +             episode(brain, start, cylinder, seed + i + len(starts) * len(returns), remember, maxsteps)


# %% reward_of_a_step loses 6.6
# Takes the mean reward of a step instead of the return of an episode.
# says: this
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.mean([each["rewards"].mean() for each in episodes]))


# %% sight_left_out loses 6.7
# Shows the network zeros instead of the observation.
# says: this
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     return np.array([think(brain, 0 * observation, memory)[0] for memory in memories])


# %% maxsteps_not_handed_on loses 6.6
# Lets the episodes last up to 500 steps, whatever maxsteps is.
# says: this
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# +             episode(brain, start, cylinder, seed + i, remember)


# %% frozen_from_step_100 loses 6.6
# Freezes the memory from step 100 on, whatever `since` is.
# says: this
# -     ways = {"keep": keep, "forget": forget, "freeze": freeze(since)}
# +     ways = {"keep": keep, "forget": forget, "freeze": freeze(100)}


# %% bias_after_tanh loses 6.1
# Adds the bias of the wheels after tanh, but it should be added inside.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ outputs) + brain["bias"]


# %% output_gate_sees_new_cells loses 6.1
# Shows the output gate tanh of the new cells instead of the outputs of the step before.
# says: this
def think(brain, observation, memory):
    z = np.concatenate([observation, memory[1]])
    Wf, Wi, Wo, Wc = brain["gates"]
    c = memory[0] * logistic(Wf @ z + 1) + np.tanh(Wc @ z) * logistic(Wi @ z)
    z2 = np.concatenate([observation, np.tanh(c)])
    h = np.tanh(c) * logistic(Wo @ z2)
    return np.tanh(brain["readout"] @ h + brain["bias"]), np.stack([c, h])


# %% rows_exchanged_throughout loses 6.1
# Takes row 0 of the memory for the outputs and row 1 for the cells, but row 0 should be the cells and row 1 the outputs.
# says: this
def think(brain, observation, memory):
    h, c = memory
    z = np.concatenate([observation, h])
    Wf, Wi, Wo, Wc = brain["gates"]
    c = c * logistic(Wf @ z + 1) + np.tanh(Wc @ z) * logistic(Wi @ z)
    h = np.tanh(c) * logistic(Wo @ z)
    return np.tanh(brain["readout"] @ h + brain["bias"]), np.stack([h, c])


# %% keeps_what_is_not_taken loses 6.1
# Multiplies the old cells by 1 minus the input gate instead of the forget gate.
# says: this
def think(brain, observation, memory):
    z = np.concatenate([observation, memory[1]])
    _, i, o = (logistic(brain["gates"][k] @ z + (k == 0)) for k in range(3))
    g = np.tanh(brain["gates"][3] @ z)
    c = memory[0] * (1 - i) + g * i
    h = np.tanh(c) * o
    return np.tanh(brain["readout"] @ h + brain["bias"]), np.stack([c, h])


# %% headings_floored loses 6.3
# Cuts off the fraction of the step between headings, but they should divide the whole turn evenly.
# says: this
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = np.arange(headings) * (2 * np.pi // headings)


# %% near_is_all_after_the_search loses 6.4
# Counts all steps after the search as near the cylinder, but only those with a reward should count.
# says: this
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
# Takes speed, turning and wall over all steps without a reward, not over the search alone.
# says: this
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
# Takes the short way around for changes below -pi only, but it is asked for above pi, too.
# says: this
# -     turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
# +     turned = after[:, 2] - before[:, 2]
# +     turned = np.where(turned < -np.pi, turned + 2 * np.pi, turned)


# %% hops_between_rewards loses 6.4
# Takes for the pace the way from one place with a reward to the next such place, but the way in each step is asked for.
# says: this
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
# says: this
# -     deviation = table.std(axis=0)
# -     alike = np.ptp(table, axis=0) == 0  # their deviation may be a rounding error
# -     return np.where(alike, 0.0, (table - table.mean(axis=0)) / np.where(alike, 1.0, deviation))
# +     deviation = table.std(axis=1, keepdims=True)
# +     alike = np.ptp(table, axis=1, keepdims=True) == 0
# +     return np.where(alike, 0.0, (table - table.mean(axis=1, keepdims=True)) / np.where(alike, 1.0, deviation))


# %% deviation_and_a_bit loses 6.5
# Divides by the standard deviation plus 0.01 instead of the standard deviation.
# says: this
def standardise(table):
    return (table - table.mean(axis=0)) / (table.std(axis=0) + 0.01)


# %% first_pair_that_is_near loses 6.5
# Merges the first pair nearer than the threshold, but the two nearest families should be merged.
# says: this
# -         i, j = pairs[int(np.argmin(apart))]
# +         i, j = next(p for p, a in zip(pairs, apart) if a < threshold)


# %% keeps_the_new_memory_for_good loses 6.6
# Keeps the memory after step `since` of the first episode, but the memory before step `since` of each episode is asked for.
# says: this
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
# Takes the median of the returns instead of the mean.
# says: this
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.median([each["rewards"].sum() for each in episodes]))


# %% reads_the_old_outputs loses 6.7
# Reads the actions from the given outputs, but a step of the network with each memory is asked for.
# says: this
def reactions(brain, observation, memories):
    h = memories[:, 1]
    return np.tanh(h @ brain["readout"].T + brain["bias"])


# %% grid_reshaped loses 6.3
# Reshapes all x, y and headings to rows of three, which mixes them up, but a row should hold x, y, heading.
# says: this
# -     return np.array([(x, y, angle) for y in ys for x in xs for angle in angles])
# +     return np.array(np.meshgrid(xs, ys, angles)).reshape(-1, 3)


# %% memories_reshaped loses 6.7
# Reshapes the memories to cells and outputs, which mixes those of different memories.
# says: this
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     parts = np.moveaxis(np.asarray(memories).reshape(2, len(memories), -1), 0, 1)
# +     return np.array([think(brain, observation, memory)[0] for memory in parts])


# %% one_memory_for_all_episodes loses 6.2
# Begins with the memory that the episode before has left, not with 0, and gives the last memory in every row of memories (copy it).
# says: stays from call to call
# -     memory = np.zeros((2, UNITS))
# +     memory = SHARED
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory[:] = remember(len(steps) - 1, memory, after)
SHARED = np.zeros((2, 10))


# %% memory_changed_in_place loses 6.2
# Gives the last memory in every row of memories, but the memory that the network was given in each step is asked for.
# says: this
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory[:] = remember(len(steps) - 1, memory, after)


# %% reset_without_the_seed loses 6.2
# Resets the arena without `seed`, so that the sensors have another noise.
# says: this
# -     arena.reset(seed)
# +     arena.reset()


# %% start_kept_for_all_poses loses 6.2
# Gives the start in every row of poses, but the robot's pose after each step is asked for.
# says: this
# -         poses.append(arena.robots[0].copy())
# +         poses.append(np.array(start, dtype=float))


# %% sensed_before_the_cylinder loses 6.2
# Takes the first observation with the cylinder where the seed has put it, not at the given place.
# -     arena.objects[0, :2] = cylinder
# -     arena.sense()
# +     arena.sense()
# +     arena.objects[0, :2] = cylinder


# %% last_family_is_taken loses 6.5
# Merges the last family in the list into the first one of the nearest pair, but the two of the pair should be merged.
# says: this
# -         groups[i] += groups.pop(j)
# +         groups[i] += groups.pop()


# %% last_family_left_out loses 6.5
# Leaves the last family in the list out of all mergers, but it should take part in them.
# says: this
# -     while len(groups) > 1:
# +     while len(groups) > 2:
# -         pairs = [(i, j) for j in range(len(groups)) for i in range(j)]
# +         pairs = [(i, j) for j in range(len(groups) - 1) for i in range(j)]


# %% last_robot_of_a_family loses 6.5
# Takes the mean distance of only the last robot in one of two families to those of the other, but the mean over all pairs is asked for.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         apart = [distance[np.ix_(groups[i], groups[j])][-1].mean() for i, j in pairs]


# %% ends_when_the_farthest_are_far loses 6.5
# Ends merging when the two farthest families are not nearer than the threshold, but the two nearest should decide.
# says: this
# -         if min(apart) >= threshold:
# +         if max(apart) >= threshold:


# %% all_from_the_first_start loses 6.6
# Begins all episodes at the first start, but episode i should begin at starts[i].
# says: this
# -             episode(brain, start, cylinder, seed + i, remember, maxsteps)
# +             episode(brain, starts[0], cylinder, seed + i, remember, maxsteps)


# %% forgets_and_returns_nothing loses 6.6
# Returns None, but `forget` should return a memory of zeros.
# says: this
def forget(step, before, after):
    after[:] = 0


# %% memory_of_the_reaction_before loses 6.7
# Uses memories[i - 1] for reaction i, and the last memory for the first one, but should use memories[i].
# says: this
# -     return np.array([think(brain, observation, memory)[0] for memory in memories])
# +     return np.array([think(brain, observation, memories[i - 1])[0] for i in range(len(memories))])


# %% corners_count_twice loses 6.4
# Counts a step near two walls twice, but it should count once.
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
# Leaves out the 1 that `think` adds to the forget gate's net input.
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
# Holds the memory in step `since` only, but it should stay the same from that step on.
# says: this
# -     return lambda step, before, after: after if step < since else before
# +     return lambda step, before, after: before if step == since else after


# %% central_differences_of_poses loses 6.4
# Takes central differences, as np.gradient does, for the movement of a step, but the way from poses[t] to poses[t + 1] is asked for.
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
# Compares the threshold with the inconsistency of a merger, as fcluster does by default, but the distance is asked for (criterion="distance").
def families(table, threshold):
    from scipy.cluster.hierarchy import fcluster, linkage

    if len(table) < 2:
        return [0] * len(table)
    tree = linkage(standardise(table), method="average")
    labels = fcluster(tree, np.nextafter(threshold, -np.inf))
    order = list(dict.fromkeys(labels))
    return [order.index(label) for label in labels]


# %% square_distances_for_linkage loses 6.5
# Takes the rows of the square matrix of distances for positions, as linkage does, but the distances themselves are asked for (condensed form).
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
# Puts the values of x in a wrong order, so that some starts come twice and others never.
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
# Multiplies the old cells by 1 minus the forget gate instead of the forget gate.
# says: this
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * (1 - logistic(forget + 1)) + np.tanh(candidate) * logistic(enter)


# %% new_cells_through_tanh loses 6.1
# Puts tanh of the new cells into the new memory, but the new cells themselves are asked for.
# says: this
# -     return action, np.stack([cells, outputs])
# +     return action, np.stack([np.tanh(cells), outputs])


# %% one_for_all_gates loses 6.1
# Adds the 1 to the net inputs of all gates, but it belongs to the forget gate alone.
# says: this
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     forget, enter, leave, candidate = brain["gates"] @ z + 1
# -     cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
# +     cells = memory[0] * logistic(forget) + np.tanh(candidate) * logistic(enter)


# %% one_for_the_three_gates loses 6.1
# Adds the 1 to the forget, the input and the output gate, but it belongs to the forget gate alone.
# says: this
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     forget, enter, leave, candidate = brain["gates"] @ z
# +     enter, leave = enter + 1, leave + 1


# %% gates_by_tanh loses 6.1
# Puts the three gates through tanh instead of the logistic function.
# says: this
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     forget, enter, leave, candidate = brain["gates"] @ z
# +     logistic = np.tanh


# %% output_gate_inside_tanh loses 6.1
# Multiplies the new cells by the output gate inside tanh, but tanh(new cells) should be multiplied by it.
# says: this
# -     outputs = np.tanh(cells) * logistic(leave)
# +     outputs = np.tanh(cells * logistic(leave))


# %% order_of_other_lstms loses 6.1
# Takes gates[2] for the candidate and gates[3] for the output gate, but gates[2] should be the output gate and gates[3] the candidate.
# says: this
# -     forget, enter, leave, candidate = brain["gates"] @ z
# +     forget, enter, candidate, leave = brain["gates"] @ z


# %% action_of_tanh_of_the_cells loses 6.1
# Reads the action from tanh of the new cells, without the output gate.
# says: this
# -     action = np.tanh(brain["readout"] @ outputs + brain["bias"])
# +     action = np.tanh(brain["readout"] @ np.tanh(cells) + brain["bias"])


# %% placed_before_the_reset loses 6.2
# Puts robot and cylinder at the given places before the arena is reset, but the reset moves them: it should come first.
# says: this
# -     arena.reset(seed)
# -     arena.robots[0] = start
# -     arena.objects[0, :2] = cylinder
# -     arena.sense()
# +     arena.robots[0] = start
# +     arena.objects[0, :2] = cylinder
# +     arena.reset(seed)
# +     arena.sense()


# %% ends_when_it_is_found loses 6.2
# Ends the episode with the first reward, but it should go on to maxsteps or a collision.
# says: this
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory = remember(len(steps) - 1, memory, after)
# +         if steps[-1][-1] > 0:
# +             break


# %% thinks_without_memory loses 6.2
# Gives `think` an empty memory in each step, not what `remember` has returned.
# says: this
# -         action, after = think(brain, observation, memory)
# +         action, after = think(brain, observation, np.zeros((2, UNITS)))


# %% before_is_the_first_memory loses 6.2
# Gives `remember` the memory at the beginning of the episode as `before`, not that before the step.
# says: this
# -         memory = remember(len(steps) - 1, memory, after)
# +         memory = remember(len(steps) - 1, np.zeros((2, UNITS)), after)


# %% middles_of_parts loses 6.3
# Takes the middles of equal parts of the range for x and y, but both ends should belong to the grid.
# says: this
# -     ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
# +     middles = (np.arange(places) + 0.5) / places
# +     ys, xs = 270 + 80 * middles, 150 + 100 * middles


# %% headings_between_minus_pi_and_pi loses 6.3
# Brings the headings between -pi and pi, but they should grow from 0 to less than 2 pi.
# says: this
# -     angles = np.arange(headings) * 2 * np.pi / headings
# +     angles = (np.arange(headings) * 2 * np.pi / headings + np.pi) % (2 * np.pi) - np.pi


# %% middle_heading loses 6.4
# Takes the mean of the headings before and after the step for the speed, but the heading at the beginning of the step is asked for.
# says: this
# -     forward = moved[:, 0] * np.cos(before[:, 2]) + moved[:, 1] * np.sin(before[:, 2])
# +     middle = (before[:, 2] + after[:, 2]) / 2
# +     forward = moved[:, 0] * np.cos(middle) + moved[:, 1] * np.sin(middle)


# %% speed_from_start_to_find loses 6.4
# Divides the straight way of the whole search by its steps, but the mean way along the heading of each step is asked for.
# says: this
# -         "speed": mean(forward[:search]),
# +         "speed": float(np.hypot(*(poses[search] - poses[0])[:2])) / max(search, 1),


# %% sideways loses 6.4
# Takes for the speed how far the robot moves sideways, but the way along its heading is asked for.
# says: this
# -     forward = moved[:, 0] * np.cos(before[:, 2]) + moved[:, 1] * np.sin(before[:, 2])
# +     forward = moved[:, 1] * np.cos(before[:, 2]) - moved[:, 0] * np.sin(before[:, 2])


# %% means_over_all_steps loses 6.4
# Divides the sums by the number of all steps of the episode, but the means over the steps of the search, or near the cylinder, are asked for.
# says: this
_describe = describe


def describe(poses, rewards, cylinder):
    told, n = _describe(poses, rewards, cylinder), len(rewards)
    near = int((rewards > 0).sum())
    for key in ("speed", "turning", "wall"):
        told[key] *= told["search"] / n
    for key in ("pace", "side"):
        told[key] *= near / n
    return told


# %% remainder_keeps_its_sign loses 6.4
# Uses np.fmod, whose result keeps the sign, for the short way around, but `%` leads to it.
# says: this
# -     turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
# +     turned = np.fmod(after[:, 2] - before[:, 2] + np.pi, 2 * np.pi) - np.pi


# %% sensors_from_the_centre loses 6.4
# Counts walls within 45 mm of the centre, but 72.5 mm is asked for.
# says: this
# -         "wall": mean(to_wall[:search] < 72.5),
# +         "wall": mean(to_wall[:search] < 45),


# %% arctan_of_a_quotient loses 6.4
# Takes arctan(dy / dx) for the direction of the cylinder, which takes opposite directions for the same, but np.arctan2(dy, dx) is needed.
# says: this
# -     bearing = np.arctan2(away[:, 1], away[:, 0]) - after[:, 2]
# +     bearing = np.arctan(away[:, 1] / np.where(away[:, 0] == 0, 1e-9, away[:, 0])) - after[:, 2]


# %% angle_for_its_sine loses 6.4
# Gives the mean angle to the cylinder, the short way around, for the side, but the mean of its sine is asked for.
# says: this
# -         "side": mean(np.sin(bearing[near])),
# +         "side": mean((bearing[near] + np.pi) % (2 * np.pi) - np.pi),


# %% from_lowest_to_highest loses 6.5
# Brings each column between 0 and 1, but mean 0 and standard deviation 1 are asked for.
# says: this
# -     return np.where(alike, 0.0, (table - table.mean(axis=0)) / np.where(alike, 1.0, deviation))
# +     return np.where(alike, 0.0, (table - table.min(axis=0)) / np.where(alike, 1.0, np.ptp(table, axis=0)))


# %% median_over_pairs loses 6.5
# Takes the median over all pairs of robots for the distance of two families, but the mean is asked for.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         apart = [np.median(distance[np.ix_(groups[i], groups[j])]) for i, j in pairs]


# %% first_robots_stand_for_families loses 6.5
# Takes the distance of the first robots of two families, but the mean over all pairs is asked for.
# says: this
# -         apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
# +         apart = [distance[groups[i][0], groups[j][0]] for i, j in pairs]


# %% steps_for_returns loses 6.6
# Takes the number of steps of an episode for its return, but the sum of its rewards is asked for.
# says: this
# -         returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
# +         returns[name] = float(np.mean([len(each["rewards"]) for each in episodes]))
