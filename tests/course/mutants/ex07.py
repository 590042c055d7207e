"""Wrong solutions of exercise 7; building.py describes how a case is written."""


# %% angle_mirrored loses 7.1
# Cosine and sine are taken for each other.
# says: Cosine and sine are exchanged
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# +     angle = np.arctan2(observation[..., 0], observation[..., 1])


# %% angle_of_cosine loses 7.1
# Computes the angle from its cosine alone, so that it is never negative.
# says: Only the sign
def to_state(observation):
    observation = np.asarray(observation, dtype=float)
    return np.stack([np.arccos(observation[..., 0]), observation[..., 2]], axis=-1)


# %% recording_goes_on loses 7.2
# Goes on after the end of the episode.
def record(controller, seed, steps):
    env = gymnasium.make("Pendulum-v1")
    observations = [env.reset(seed=seed)[0]]
    for _ in range(steps):
        observations.append(env.step(controller(observations[-1]))[0])
    return to_state(np.array(observations))


# %% recording_unseeded loses 7.2
# The seed is not used.
# says: do not come from the seed
_record = record


def record(controller, seed, steps):
    return _record(controller, None, steps)


# %% recording_without_start loses 7.2
# The recording leaves out the state after the reset.
# says: one too few|one is missing
_record = record


def record(controller, seed, steps):
    return _record(controller, seed, steps)[1:]


# %% arrows_leap loses 7.3
# Arrows through the lowest point leap across the whole picture.
# says: whole turns of 2 pi
def arrows(before, after):
    return np.hstack([before, after - before])


# %% arrows_to_ends loses 7.3
# Gives where the arrows end instead of how far they go.
# says: Where the arrows end is returned
_arrows = arrows


def arrows(before, after):
    return np.hstack([before, before + _arrows(before, after)[:, 2:]])


# %% states_changed loses 7.3
# Computes the change in the array of the states, which the next arrow begins with.
def arrows(before, after):
    kept = before.copy()
    after -= before
    after[:, 0] = (after[:, 0] + np.pi) % (2 * np.pi) - np.pi
    return np.hstack([kept, after])


# %% controller_sees_the_past loses 7.4
# The controller is given the observation of the grid state before.
def next_states(controller, states):
    env = gymnasium.make("Pendulum-v1")
    observation, _ = env.reset(seed=0)
    following = []
    for state in states:
        env.unwrapped.state = np.array(state)
        observation, *_ = env.step(controller(observation))
        following.append(observation)
    return to_state(np.array(following))


# %% grid_without_end loses 7.4
# The grid leaves out its right and upper end.
# says: leaves out its upper ends
def grid(nangles, nvelocities):
    angles = np.linspace(-np.pi, np.pi, nangles, endpoint=False)
    velocities = np.linspace(-8, 8, nvelocities, endpoint=False)
    return np.stack([np.tile(angles, nvelocities), np.repeat(velocities, nangles)], axis=1)


# %% state_set_on_wrapper loses 7.4
# Sets the state on the outermost wrapper, where nobody reads it.
# -     env.reset()
# +     observation, _ = env.reset()
# -         env.unwrapped.state = np.array([angle, velocity])
# +         env.state = np.array([angle, velocity])


# %% keeps_best_so_far loses 7.5
# Keeps the best candidate so far instead of that of the generation.
# says: the best candidate so far
def evolve(algorithm, evaluate, generations, every):
    kept, parameters, history, record_fitness = [], [], [], -np.inf
    for generation in range(generations):
        candidates, _ = algorithm.ask()
        fitness = evaluate(candidates, generation)
        history.append(float(fitness.max()))
        if history[-1] > record_fitness:
            record_fitness, winner = history[-1], candidates[np.argmax(fitness)].copy()
        if generation % every == 0 or generation == generations - 1:
            kept.append(generation)
            parameters.append(winner)
        algorithm.tell(fitness)
    return {"generations": kept, "parameters": np.array(parameters), "history": history}


# %% last_generation_missing loses 7.5
# Keeps every n-th generation, but not the last one.
# says: The last one is missing
_evolve = evolve


def evolve(algorithm, evaluate, generations, every):
    run = _evolve(algorithm, evaluate, generations, every)
    regular = [i for i, generation in enumerate(run["generations"]) if generation % every == 0]
    kept = [run["generations"][i] for i in regular]
    return {**run, "generations": kept, "parameters": run["parameters"][regular]}


# %% stages_not_copied loses 7.5
# Keeps views of an array that the algorithm uses again.
# says: keep a copy of a candidate \(.copy\(\)\)
# -             parameters.append(candidates[best].copy())
# +             parameters.append(candidates[best])


# %% middle_stage_is_late loses 7.6
# Takes the stage in the middle of the run, when the pendulum is up already.
def three_stages(seed):
    robot = Robot("Pendulum-v1")

    def evaluate(candidates, generation):
        return robot.evaluate(candidates, seed + generation, episodes=10)

    parameters = evolve(openai_es(robot, seed), evaluate, generations=600, every=300)["parameters"]
    return parameters[[0, 1, 2]]


# %% written_down loses 7.6
# Stages that were evolved elsewhere and written down, each seed with a little noise.
MIDDLE = """
    2 5 -5 5 2 4 1 -5 19 -4 -4 1 9 0 -11 7 7 1 -6 2 -4 -5 11 -4 8 -2 10 3 5 -2 1 2 -1 -2 10 -20
    -12 -6 -11 0 12 -1 -10 0 18 0 2 8 -1 25 5"""
LAST = """
    2 16 2 8 -1 15 3 -9 38 -3 -18 0 11 -6 -16 13 7 0 -7 -1 13 -1 11 0 8 -8 15 2 -1 5 0 9 9 -1 4
    -41 -26 -11 -8 7 10 -3 -23 -1 23 0 1 7 5 41 10"""


def three_stages(seed):
    tenths = [[0] * 51, MIDDLE.split(), LAST.split()]
    parameters = np.array(tenths, dtype=float) / 10
    return parameters + 0.001 * np.random.default_rng(seed).standard_normal(parameters.shape)


# %% arrows_end_at_their_states loses 7.7
# Puts the head of each arrow where its beginning belongs.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    exact = {"angles": "xy", "scale_units": "xy", "scale": 1, "pivot": "tip"}
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        axes.quiver(*field.T, color="gray", **exact)
        axes.quiver(*path.T, color="red", **exact)
        axes.set(title=title, xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)


# %% arrows_point_backwards loses 7.7
# Draws each arrow from the next state to the one before.
_draw_portraits = draw_portraits


def draw_portraits(file, titles, fields, paths):
    back = [[np.hstack([a[:, :2] + a[:, 2:], -a[:, 2:]]) for a in each] for each in (fields, paths)]
    _draw_portraits(file, titles, *back)


# %% arrows_without_scale loses 7.7
# Lets matplotlib choose how long the arrows are.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        axes.quiver(*field.T, color="gray")
        axes.quiver(*path.T, color="red")
        axes.set(title=title, xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)


# %% axes_follow_the_data loses 7.7
# The axes span what the arrows need.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        axes.quiver(*field.T)
        axes.quiver(*path.T, color="red")
        axes.set_title(title)
    figure.savefig(file, dpi=100)


# %% lines_without_heads loses 7.7
# Draws lines, which do not tell forwards from backwards.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        for arrows, colour in ((field, "gray"), (path, "red")):
            x, y, dx, dy = arrows.T
            axes.plot([x, x + dx], [y, y + dy], color=colour, linewidth=1)
        axes.set(title=title, xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)


# %% one_panel_for_all loses 7.7
# Draws all portraits into one panel.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    axes = figure.subplots()
    for field, path in zip(fields, paths, strict=True):
        axes.quiver(*field.T)
        axes.quiver(*path.T, color="red")
    axes.set(title=" / ".join(titles), xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)


# %% paths_not_drawn loses 7.7
# Draws the field only.
_draw_portraits = draw_portraits


def draw_portraits(file, titles, fields, paths):
    _draw_portraits(file, titles, fields, [np.zeros((1, 4))] * len(titles))


# %% controller_asked_twice loses 7.2
# Asks the controller twice in each step.
# says: asked once in each step
# -         observation, _, terminated, truncated, _ = env.step(controller(observation))
# +         if np.all(np.isfinite(controller(observation))):
# +             observation, _, terminated, truncated, _ = env.step(controller(observation))


# %% velocities_wrap loses 7.3
# Lets velocities take the short way around, too.
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change = (change + np.pi) % (2 * np.pi) - np.pi


# %% keeps_what_beats_zero loses 7.5
# Looks for a fitness above 0, so that of negative ones the first candidate is kept.
# -         best = int(np.argmax(fitness))
# +         best, highest = 0, 0.0
# +         for number, value in enumerate(fitness):
# +             if value > highest:
# +                 best, highest = number, value


# %% evaluates_twice loses 7.5
# Evaluates the candidates a second time for the history.
# says: once for each
# -         history.append(float(fitness[best]))
# +         history.append(float(np.max(evaluate(candidates, generation))))


# %% middle_is_mixed loses 7.6
# Mixes the middle stage of the first and the last until its return fits.
# says: was never evaluated
_chosen = three_stages


def three_stages(seed):
    first, middle, last = _chosen(seed)
    return np.array([first, middle * 0.999 + last * 0.001, last])


# %% one_evolution_for_all_seeds loses 7.6
# All seeds give the stages of the evolution with seed 1.
# says: begins with the same candidates as with another seed
_chosen = three_stages


def three_stages(seed):
    return _chosen(1)


# %% sign_of_the_sine loses 7.1
# Gives arccos the sign of the sine, which is 0 when the pendulum hangs straight down.
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# -     return np.stack([angle, observation[..., 2]], axis=-1)
# +     angle = np.arccos(observation[..., 0]) * np.sign(observation[..., 1])
# +     return np.stack([angle, observation[..., 2]], axis=-1)


# %% record_without_seed_zero loses 7.2
# Takes the seed 0 for no seed at all.
# -     observation, _ = env.reset(seed=seed)
# -     observations = [observation]
# +     observation, _ = env.reset(seed=seed or None)
# +     observations = [observation]


# %% wraps_above_only loses 7.3
# Takes the short way only for changes above pi, not for those below -pi (as np.fmod does).
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = np.where(change[:, 0] > np.pi, change[:, 0] - 2 * np.pi, change[:, 0])


# %% subtracts_in_place loses 7.3
# Subtracts in the array of the states after.
# -     change = after - before
# +     change = after
# +     change -= before


# %% history_so_far loses 7.5
# The history holds the best fitness so far.
# -         history.append(float(fitness[best]))
# +         history.append(max([float(fitness[best]), *history]))


# %% square_grids_only loses 7.4
# Lays out as many velocities as angles.
# -     velocities = np.linspace(-8, 8, nvelocities)
# +     velocities = np.linspace(-8, 8, nangles)[:nvelocities]


# %% controller_asked_once loses 7.4
# Asks the controller once, and uses its action for all states.
# -     following = []
# -     for angle, velocity in states:
# +     following, action = [], None
# +     for angle, velocity in states:
# -         observation, *_ = env.step(controller(seen))
# +         action = controller(seen) if action is None else action
# +         observation, *_ = env.step(action)


# %% three_observations_are_one loses 7.1
# Takes three observations for a single one.
# -     observation = np.asarray(observation, dtype=float)
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# -     return np.stack([angle, observation[..., 2]], axis=-1)
# +     observation = np.asarray(observation, dtype=float)
# +     if len(observation) == 3:
# +         return np.array([np.arctan2(observation[1], observation[0]), observation[2]])
# +     return np.array([np.arctan2(observation[:, 1], observation[:, 0]), observation[:, 2]]).T


# %% kept_with_the_middle loses 7.6
# The middle stage is the one in the middle of the generations, whatever its return.
# -     middle = int(np.argmin(np.abs(fitness[: best + 1] - halfway)))
# +     middle = (best + 1) // 2


# %% seed_of_the_algorithm_fixed loses 7.6
# The algorithm has seed 1 always.
# says: must follow from the seed
# -     parameters = evolve(openai_es(robot, seed), evaluate, generations=600, every=5)["parameters"]
# +     parameters = evolve(openai_es(robot, 1), evaluate, generations=600, every=5)["parameters"]


# %% three_runs loses 7.6
# Takes the stages from three evolutions with other seeds.
# says: evaluated first
# -     return parameters[[0, middle, best]]
# +     other = evolve(openai_es(robot, seed + 1), evaluate, generations=1, every=5)["parameters"]
# +     return np.stack([other[0], parameters[middle], parameters[best]])


# %% second_generation loses 7.6
# The first stage is the best of generation 5.
# says: evaluated first
# -     return parameters[[0, middle, best]]
# +     return parameters[[1, max(middle, 2), best]]


# %% path_below_the_field loses 7.7
# Draws the paths first, so that the field covers them.
# says: to lie above the field
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)


# %% first_field_everywhere loses 7.7
# Draws the first field into all panels.
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# +         axes.quiver(*fields[0].T, color="#a8b4c0", width=0.0035, **exact)


# %% wider_axes loses 7.7
# The axes leave a margin.
# says: exactly -pi
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-3.5, 3.5), ylim=(-9, 9))


# %% titles_forgotten loses 7.7
# The titles are never written.
# says: above panel
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))


# %% first_title_everywhere loses 7.7
# Each panel has the first title.
# says: above panel
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=titles[0], xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))


# %% first_observation_decides loses 7.2
# The controller is asked with the first observation in every step.
# says: this
# -     observations = [observation]
# -     for _ in range(steps):
# -         observation, _, terminated, truncated, _ = env.step(controller(observation))
# +     observations, first = [observation], observation
# +     for _ in range(steps):
# +         observation, _, terminated, truncated, _ = env.step(controller(first))


# %% velocities_first loses 7.4
# All velocities of an angle come first, but all angles of a velocity are asked for.
# says: this
# -     return np.stack([np.tile(angles, nvelocities), np.repeat(velocities, nangles)], axis=1)
# +     return np.stack([np.repeat(angles, nvelocities), np.tile(velocities, nangles)], axis=1)


# %% observation_of_the_step_before loses 7.4
# The controller sees what the environment observed last, not the state it was put into.
# says: this
# -     env.reset()
# -     following = []
# +     seen, _ = env.reset(seed=1)
# +     following = []
# -         seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
# -         observation, *_ = env.step(controller(seen))
# +         observation, *_ = env.step(controller(seen))
# +         seen = observation


# %% set_to_the_first_state_only loses 7.4
# The pendulum is put into the first state only, and then goes on from there.
# says: this
# -         env.unwrapped.state = np.array([angle, velocity])
# +         if not following:
# +             env.unwrapped.state = np.array([angle, velocity])


# %% last_state_missing loses 7.2
# The recording ends with the state before the last step, not with the one after it.
# says: this
# -         observation, _, terminated, truncated, _ = env.step(controller(observation))
# -         observations.append(observation)
# -         if terminated or truncated:
# -             break
# -     return to_state(np.array(observations))
# +         observation, _, terminated, truncated, _ = env.step(controller(observation))
# +         observations.append(observation)
# +         if terminated or truncated:
# +             break
# +     return to_state(np.array(observations[:-1]))


# %% velocities_up_to_one loses 7.4
# The velocities go from -1 to 1 instead of from -8 to 8.
# says: this
# -     velocities = np.linspace(-8, 8, nvelocities)
# +     velocities = np.linspace(-1, 1, nvelocities)


# %% state_of_the_wrapper loses 7.4
# The state is set on the wrapper; the environment below it starts from the reset.
# says: this
# -     env.reset()
# -     following = []
# +     following = []
# -         env.unwrapped.state = np.array([angle, velocity])
# +         env.reset(seed=0)
# +         env.state = np.array([angle, velocity])


# %% tells_minus_the_fitness loses 7.5
# Tells the algorithm minus the fitness, as if it were a loss.
# says: told minus the fitness
# -         algorithm.tell(fitness)
# +         algorithm.tell(-fitness)


# %% generations_from_one loses 7.5
# Counts the generations from 1 when it decides which to keep.
# says: counted from 1
# -         if generation % every == 0 or generation == generations - 1:
# +         if (generation + 1) % every == 0 or generation == generations - 1:


# %% angles_without_end loses 7.4
# The angles leave out their upper end.
# says: The angles leave out
# -     angles = np.linspace(-np.pi, np.pi, nangles)
# +     angles = np.linspace(-np.pi, np.pi, nangles, endpoint=False)


# %% stages_in_reverse loses 7.6
# Returns the last stage first.
# says: order of the evolution
# -     return parameters[[0, middle, best]]
# +     return parameters[[best, middle, 0]]


# %% observation_of_another_reset loses 7.4
# The controller sees what the environment observed last, at first that of a reset without a seed.
# says: what the step before led to
# -     env.reset()
# -     following = []
# +     observation, _ = env.reset()
# +     following = []
# -         seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
# -         observation, *_ = env.step(controller(seen))
# +         observation, *_ = env.step(controller(observation))


# %% columns_for_rows loses 7.1
# Takes the rows of many observations for cosines, sines and velocities.
# says: unpacked along its first axis
# -     observation = np.asarray(observation, dtype=float)
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# -     return np.stack([angle, observation[..., 2]], axis=-1)
# +     cosine, sine, velocity = observation
# +     return np.array([np.arctan2(sine, cosine), velocity])


# %% next_states_for_the_changes loses 7.7
# Gives quiver the next states where it wants the changes.
# says: as long as the numbers of the next state
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         field, path = (np.hstack([a[:, :2], a[:, :2] + a[:, 2:]]) for a in (field, path))
# +         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# +         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)


# %% velocities_downwards loses 7.7
# The axis of the velocities points down.
# says: the velocities are to grow upwards
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(8, -8))


# %% middle_of_the_arrow_in_its_state loses 7.7
# Puts the middle of each arrow into its state.
# says: Their middle is in their state
# -     exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
# +     exact = {"angles": "xy", "scale_units": "xy", "scale": 1, "pivot": "mid"}


# %% length_of_its_own loses 7.7
# Lets matplotlib choose the length of the arrows.
# says: Each arrow is as long as its change
# -     exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
# +     exact = {"angles": "xy"}


# %% angles_upwards loses 7.7
# Exchanges angles and velocities.
# says: Angles and velocities are exchanged
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.quiver(*field[:, [1, 0, 3, 2]].T, color="#a8b4c0", width=0.0035, **exact)
# +         axes.quiver(*path[:, [1, 0, 3, 2]].T, color="#d55e00", width=0.005, **exact)
# +         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-8, 8), ylim=(-np.pi, np.pi))


# %% turns_from_zero loses 7.3
# Puts the changes of the angle between 0 and 2 pi.
# says: lie between 0 and 2 pi
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = change[:, 0] % (2 * np.pi)


# %% half_turns loses 7.3
# Takes pi for a whole turn.
# says: a whole turn is 2 pi
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = (change[:, 0] + np.pi / 2) % np.pi - np.pi / 2


# %% changes_cut_off loses 7.3
# Cuts off changes beyond -pi and pi.
# says: are cut off there
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = np.clip(change[:, 0], -np.pi, np.pi)


# %% angles_from_zero loses 7.4
# The angles of the grid go from 0 to 2 pi.
# says: The angles go from 0 to 2 pi
# -     angles = np.linspace(-np.pi, np.pi, nangles)
# +     angles = np.linspace(0, 2 * np.pi, nangles)


# %% rows_after_the_end loses 7.2
# Rows of zeros are left over where the episode ends before the steps are used up.
# says: the environment ends the episode after
_record_7 = record


def record(controller, seed, steps):
    found = _record_7(controller, seed, steps)
    return np.concatenate([found, np.zeros((steps + 1 - len(found), 2))])


# %% arccos_times_the_sign loses 7.1
# The angle is the arccos of the cosine times the sign of the sine, which is 0 straight down.
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# +     angle = np.arccos(np.clip(observation[..., 0], -1, 1)) * np.sign(observation[..., 1])


# %% the_old_velocity_moves_the_angle loses 7.4
# The angle moves with the velocity before the step, the pendulum's with the one after it.
# says: this
_next_states_7 = next_states


def next_states(controller, states):
    following = _next_states_7(controller, states)
    angle = states[:, 0] + 0.05 * states[:, 1]
    following[:, 0] = np.arctan2(np.sin(angle), np.cos(angle))
    return following


# %% amount_of_the_short_way loses 7.3
# A change beyond half a turn becomes 2 pi minus its amount, and loses its sign.
# says: becomes 2 pi minus its amount
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     amount = np.abs(change[:, 0])
# +     change[:, 0] = np.where(amount > np.pi, 2 * np.pi - amount, change[:, 0])


# %% remainder_of_the_other_sign loses 7.3
# Takes the short way only for changes below -pi, not for those above pi.
# says: this
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = np.fmod(change[:, 0] - np.pi, 2 * np.pi) + np.pi


# %% arrows_begin_in_the_next_state loses 7.3
# The arrows begin in the states after, not in those before.
# says: this
# -     return np.hstack([before, change])
# +     return np.hstack([after, change])


# %% angles_cut_off loses 7.4
# Angles beyond pi and -pi are cut off there, but a turn goes on at the other side.
# says: this
# -         observation, *_ = env.step(controller(seen))
# -         following.append(observation)
# -     return to_state(np.array(following))
# +         env.step(controller(seen))
# +         following.append(env.unwrapped.state)
# +     return np.clip(np.array(following), [-np.pi, -8], [np.pi, 8])


# %% angles_of_the_environment loses 7.4
# Returns the angles as the environment holds them: they are not brought back to [-pi, pi].
# says: this
# -         observation, *_ = env.step(controller(seen))
# -         following.append(observation)
# -     return to_state(np.array(following))
# +         env.step(controller(seen))
# +         following.append(env.unwrapped.state)
# +     return np.array(following)


# %% velocities_without_limit loses 7.4
# The velocities are not limited to [-8, 8], as those of Pendulum-v1 are.
# says: this
def next_states(controller, states):
    following = []
    for angle, velocity in states:
        seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
        torque = np.clip(controller(seen), -2, 2)[0]
        velocity = velocity + (15 * np.sin(angle) + 3 * torque) * 0.05
        following.append([(angle + velocity * 0.05 + np.pi) % (2 * np.pi) - np.pi, velocity])
    return np.array(following)


# %% resets_with_the_next_seed loses 7.2
# The environment is reset with seed + 1 instead of the seed.
# says: this
# -     observation, _ = env.reset(seed=seed)
# +     observation, _ = env.reset(seed=seed + 1)


# %% angle_of_the_sine_alone loses 7.1
# The angle is arcsin of the sine, which knows half of the circle only.
# says: arcsin\(sine\)
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# +     angle = np.arcsin(observation[..., 1])


# %% panels_in_a_column loses 7.7
# The panels stand one below the other.
# says: one below the other
# -     panels = figure.subplots(1, len(titles), squeeze=False, sharey=True)[0]
# +     panels = figure.subplots(len(titles), 1, squeeze=False, sharey=True)[:, 0]


# %% first_arrow_of_a_path_only loses 7.7
# Draws only the first arrow of each path.
# says: nothing of them is seen
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         axes.quiver(*path[:1].T, color="#d55e00", width=0.005, **exact)


# %% arrows_five_times_as_long loses 7.7
# The arrows are five times as long as their changes.
# says: 5 times as long as their change
# -     exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
# +     exact = {"angles": "xy", "scale_units": "xy", "scale": 0.2}


# %% ends_with_the_episode loses 7.4
# Stops when the environment says that the time is up, and leaves out the states that are left.
# says: this
# -         observation, *_ = env.step(controller(seen))
# -         following.append(observation)
# +         observation, _, terminated, truncated, _ = env.step(controller(seen))
# +         following.append(observation)
# +         if terminated or truncated:
# +             break


# %% the_best_of_all_since loses 7.5
# Keeps the best candidate of all generations since the last one kept, not that of the generation itself.
# says: this
def evolve(algorithm, evaluate, generations, every):
    result = {"generations": [], "parameters": [], "history": []}
    champion, highest = None, -np.inf
    for g in range(generations):
        candidates, _ = algorithm.ask()
        fitness = np.asarray(evaluate(candidates, g))
        i = fitness.argmax()
        result["history"].append(float(fitness[i]))
        if champion is None or fitness[i] > highest:
            champion, highest = candidates[i].copy(), fitness[i]
        if g % every == 0 or g == generations - 1:
            result["generations"].append(g)
            result["parameters"].append(champion)
            champion, highest = None, -np.inf
        algorithm.tell(fitness)
    result["parameters"] = np.array(result["parameters"])
    return result


# %% limits_of_the_last_panel loses 7.7
# Only the last panel gets the limits of its x axis: the loop is over when they are set.
# says: whatever is drawn
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=title, xlabel="angle (0 is upright)", ylim=(-8, 8))
# -     panels[0].set_ylabel("velocity (rad/s)")
# +     panels[0].set_ylabel("velocity (rad/s)")
# +     axes.set_xlim(-np.pi, np.pi)


# %% gravity_of_9_81 loses 7.2
# Makes the pendulum with g=9.81: its own default is 10.
# says: this
# -     env = gymnasium.make("Pendulum-v1")
# -     observation, _ = env.reset(seed=seed)
# +     env = gymnasium.make("Pendulum-v1", g=9.81)
# +     observation, _ = env.reset(seed=seed)


# %% stages_by_linspace loses 7.5
# Spreads the kept generations evenly instead of keeping 0, every, 2 every, ...
# says: this
import numpy as np


def evolve(algorithm, evaluate, generations, every):
    nstages = (generations - 1) // every + 1
    wanted = set(np.linspace(0, generations - 1, nstages).round().astype(int).tolist())
    wanted |= {0, generations - 1}
    stages, history = {}, []
    for g in range(generations):
        population = algorithm.ask()[0]
        scores = list(evaluate(population, g))
        top = max(scores)
        history.append(float(top))
        if g in wanted:
            stages[g] = np.array(population[scores.index(top)])
        algorithm.tell(np.array(scores))
    return {
        "generations": list(stages),
        "parameters": np.array(list(stages.values())),
        "history": history,
    }


# %% motor_without_limit loses 7.4
# The motor gives as much as the controller asks for, not 2 at most.
# says: this
def next_states(controller, states):
    following = []
    for angle, velocity in states:
        seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
        torque = float(controller(seen)[0])
        velocity = np.clip(velocity + (15.0 * np.sin(angle) + 3.0 * torque) * 0.05, -8, 8)
        angle = angle + velocity * 0.05
        following.append([np.cos(angle), np.sin(angle), velocity])
    return to_state(np.array(following))


# %% state_at_the_end_lost loses 7.2
# The loop ends before the state after the last step of an episode is appended.
# says: this
# -         observations.append(observation)
# -         if terminated or truncated:
# -             break
# +         if terminated or truncated:
# +             break
# +         observations.append(observation)
