"""Wrong solutions of exercise 7; building.py describes how a case is written."""


# %% angle_mirrored loses 7.1
# Gives np.arctan2(cosine, sine) as the angle instead of np.arctan2(sine, cosine).
# says: this
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# +     angle = np.arctan2(observation[..., 0], observation[..., 1])


# %% angle_of_cosine loses 7.1
# Gives an angle between 0 and pi, as np.arccos(cosine) does, but it should be negative where the sine is negative.
# says: this
def to_state(observation):
    observation = np.asarray(observation, dtype=float)
    return np.stack([np.arccos(observation[..., 0]), observation[..., 2]], axis=-1)


# %% recording_goes_on loses 7.2
# Goes on after the environment has ended the episode (truncated after 200 steps), but the recording should end there.
def record(controller, seed, steps):
    env = gymnasium.make("Pendulum-v1")
    observations = [env.reset(seed=seed)[0]]
    for _ in range(steps):
        observations.append(env.step(controller(observations[-1]))[0])
    return to_state(np.array(observations))


# %% recording_unseeded loses 7.2
# Starts from a state that does not come from the seed, but env.reset(seed=seed) should choose it.
# says: another answer: by chance
_record = record


def record(controller, seed, steps):
    return _record(controller, None, steps)


# %% recording_without_start loses 7.2
# Leaves out the state after the reset, but the recording should begin with it.
# says: this
_record = record


def record(controller, seed, steps):
    return _record(controller, seed, steps)[1:]


# %% arrows_leap loses 7.3
# Gives the plain difference of the angles even where it is beyond -pi or pi, but the short way around is asked for.
# says: this
def arrows(before, after):
    return np.hstack([before, after - before])


# %% arrows_to_ends loses 7.3
# Gives where each arrow ends (before plus change) instead of the change.
# says: this
_arrows = arrows


def arrows(before, after):
    return np.hstack([before, before + _arrows(before, after)[:, 2:]])


# %% states_changed loses 7.3
# Changes an array that it is given, but the arrays given should stay as they are.
def arrows(before, after):
    kept = before.copy()
    after -= before
    after[:, 0] = (after[:, 0] + np.pi) % (2 * np.pi) - np.pi
    return np.hstack([kept, after])


# %% controller_sees_the_past loses 7.4
# Gives the controller the observation that the last reset or step returned instead of that of the given state.
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
# Leaves out the upper ends pi and 8, but the angles and the velocities should include both of their ends.
# says: this
def grid(nangles, nvelocities):
    angles = np.linspace(-np.pi, np.pi, nangles, endpoint=False)
    velocities = np.linspace(-8, 8, nvelocities, endpoint=False)
    return np.stack([np.tile(angles, nvelocities), np.repeat(velocities, nangles)], axis=1)


# %% state_set_on_wrapper loses 7.4
# Lets the pendulum go on from where it is, but each step should start from the given state (see env.unwrapped.state).
# -     env.reset()
# +     observation, _ = env.reset()
# -         env.unwrapped.state = np.array([angle, velocity])
# +         env.state = np.array([angle, velocity])


# %% keeps_best_so_far loses 7.5
# Keeps the best candidate of all generations so far, but the best one of the kept generation alone is asked for.
# says: this
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
# Leaves out the last generation if its number is not a multiple of `every`, but the last one should always be kept.
# says: this
_evolve = evolve


def evolve(algorithm, evaluate, generations, every):
    run = _evolve(algorithm, evaluate, generations, every)
    regular = [i for i, generation in enumerate(run["generations"]) if generation % every == 0]
    kept = [run["generations"][i] for i in regular]
    return {**run, "generations": kept, "parameters": run["parameters"][regular]}


# %% stages_not_copied loses 7.5
# Returns rows of the last generation's candidates for all stages: the algorithm uses its array again, so a copy should be kept (.copy()).
# says: this
# -             parameters.append(candidates[best].copy())
# +             parameters.append(candidates[best])


# %% middle_stage_is_late loses 7.6
# Takes the best of generation 300 as the middle stage, but one with a mean return at least 100 above the first one's and 100 below the last one's is asked for.
def three_stages(seed):
    robot = Robot("Pendulum-v1")

    def evaluate(candidates, generation):
        return robot.evaluate(candidates, seed + generation, episodes=10)

    parameters = evolve(openai_es(robot, seed), evaluate, generations=600, every=300)["parameters"]
    return parameters[[0, 1, 2]]


# %% written_down loses 7.6
# Returns fixed parameters with a little noise from the seed, but the stages should be evolved anew from each seed.
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
# Draws each arrow with its head in its own state, but it should begin there and end in the next state.
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
# Draws each arrow from the next state back to its own state, but its head should be in the next state.
_draw_portraits = draw_portraits


def draw_portraits(file, titles, fields, paths):
    back = [[np.hstack([a[:, :2] + a[:, 2:], -a[:, 2:]]) for a in each] for each in (fields, paths)]
    _draw_portraits(file, titles, *back)


# %% arrows_without_scale loses 7.7
# Lets matplotlib choose the lengths and directions of the arrows, but each should end exactly in the next state.
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
# Lets the axes span what the arrows need instead of exactly -pi to pi and -8 to 8.
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
# Draws lines without heads, but each arrow should have its head at the next state.
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
# Draws all portraits into one panel instead of one panel for each.
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
# Leaves out the arrows of paths, but they should be drawn above those of fields.
_draw_portraits = draw_portraits


def draw_portraits(file, titles, fields, paths):
    _draw_portraits(file, titles, fields, [np.zeros((1, 4))] * len(titles))


# %% controller_asked_twice loses 7.2
# Asks the controller twice in each step, but it should be asked once.
# says: this
# -         observation, _, terminated, truncated, _ = env.step(controller(observation))
# +         if np.all(np.isfinite(controller(observation))):
# +             observation, _, terminated, truncated, _ = env.step(controller(observation))


# %% velocities_wrap loses 7.3
# Puts the changes of the velocities between -pi and pi, too, but only angles have a short way around.
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change = (change + np.pi) % (2 * np.pi) - np.pi


# %% keeps_what_beats_zero loses 7.5
# Keeps the first candidate if no fitness is above 0, but the one with the highest fitness is asked for, even if that is negative.
# -         best = int(np.argmax(fitness))
# +         best, highest = 0, 0.0
# +         for number, value in enumerate(fitness):
# +             if value > highest:
# +                 best, highest = number, value


# %% evaluates_twice loses 7.5
# Calls evaluate twice in each generation, but one call is asked for.
# says: this
# -         history.append(float(fitness[best]))
# +         history.append(float(np.max(evaluate(candidates, generation))))


# %% middle_is_mixed loses 7.6
# Mixes the middle stage with the last one, but candidates should be returned as they were evaluated.
# says: as they were evaluated
_chosen = three_stages


def three_stages(seed):
    first, middle, last = _chosen(seed)
    return np.array([first, middle * 0.999 + last * 0.001, last])


# %% one_evolution_for_all_seeds loses 7.6
# Returns the stages of seed 1 for every seed, but another seed should give another evolution.
# says: begin with other candidates
_chosen = three_stages


def three_stages(seed):
    return _chosen(1)


# %% sign_of_the_sine loses 7.1
# Gives the angle 0 straight down (cosine -1, sine 0), but it should be pi or -pi there.
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# -     return np.stack([angle, observation[..., 2]], axis=-1)
# +     angle = np.arccos(observation[..., 0]) * np.sign(observation[..., 1])
# +     return np.stack([angle, observation[..., 2]], axis=-1)


# %% record_without_seed_zero loses 7.2
# Resets the environment without a seed if the seed is 0, but 0 is a seed like any other.
# -     observation, _ = env.reset(seed=seed)
# -     observations = [observation]
# +     observation, _ = env.reset(seed=seed or None)
# +     observations = [observation]


# %% wraps_above_only loses 7.3
# Leaves changes of the angle below -pi as they are (as np.fmod would, unlike %), but they should take the short way around, as those above pi do.
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = np.where(change[:, 0] > np.pi, change[:, 0] - 2 * np.pi, change[:, 0])


# %% subtracts_in_place loses 7.3
# Writes the changes into the array `after`, but the arrays given should stay as they are.
# -     change = after - before
# +     change = after
# +     change -= before


# %% history_so_far loses 7.5
# Puts the highest fitness so far into the history, but the highest one of each generation alone is asked for.
# -         history.append(float(fitness[best]))
# +         history.append(max([float(fitness[best]), *history]))


# %% square_grids_only loses 7.4
# Spaces the velocities as if there were nangles of them, but nvelocities from -8 to 8 are asked for.
# -     velocities = np.linspace(-8, 8, nvelocities)
# +     velocities = np.linspace(-8, 8, nangles)[:nvelocities]


# %% controller_asked_once loses 7.4
# Uses the action for the first state in all states, but the controller should choose one in each state.
# -     following = []
# -     for angle, velocity in states:
# +     following, action = [], None
# +     for angle, velocity in states:
# -         observation, *_ = env.step(controller(seen))
# +         action = controller(seen) if action is None else action
# +         observation, *_ = env.step(action)


# %% three_observations_are_one loses 7.1
# Treats three observations, shape (3, 3), as a single one, but angle and velocity of each are asked for.
# -     observation = np.asarray(observation, dtype=float)
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# -     return np.stack([angle, observation[..., 2]], axis=-1)
# +     observation = np.asarray(observation, dtype=float)
# +     if len(observation) == 3:
# +         return np.array([np.arctan2(observation[1], observation[0]), observation[2]])
# +     return np.array([np.arctan2(observation[:, 1], observation[:, 0]), observation[:, 2]]).T


# %% kept_with_the_middle loses 7.6
# Takes the middle one of the stages kept, whatever its return, but that should be at least 100 above the first one's and 100 below the last one's.
# -     middle = int(np.argmin(np.abs(fitness[: best + 1] - halfway)))
# +     middle = (best + 1) // 2


# %% seed_of_the_algorithm_fixed loses 7.6
# Gives the algorithm seed 1 for every seed, so that all evolutions begin alike, but everything random should follow from the seed.
# says: begin with other candidates
# -     parameters = evolve(openai_es(robot, seed), evaluate, generations=600, every=5)["parameters"]
# +     parameters = evolve(openai_es(robot, 1), evaluate, generations=600, every=5)["parameters"]


# %% three_runs loses 7.6
# Takes the first stage from another evolution, with seed + 1, but all three should come from one evolution.
# says: evaluated first
# -     return parameters[[0, middle, best]]
# +     other = evolve(openai_es(robot, seed + 1), evaluate, generations=1, every=5)["parameters"]
# +     return np.stack([other[0], parameters[middle], parameters[best]])


# %% second_generation loses 7.6
# Takes the best of generation 5 as the first stage, but the best of generation 0 is asked for.
# says: evaluated first
# -     return parameters[[0, middle, best]]
# +     return parameters[[1, max(middle, 2), best]]


# %% path_below_the_field loses 7.7
# Draws the field over the paths, but the paths should lie above the field.
# says: should lie above
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)


# %% first_field_everywhere loses 7.7
# Draws fields[0] into every panel instead of fields[i] into panel i.
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# +         axes.quiver(*fields[0].T, color="#a8b4c0", width=0.0035, **exact)


# %% wider_axes loses 7.7
# Lets the axes go beyond -pi to pi and -8 to 8, but each panel should show exactly these.
# says: panels end at -pi
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-3.5, 3.5), ylim=(-9, 9))


# %% titles_forgotten loses 7.7
# Leaves out the titles, but titles[i] should stand above panel i.
# says: belongs to panel i
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))


# %% first_title_everywhere loses 7.7
# Writes titles[0] above every panel instead of titles[i] above panel i.
# says: belongs to panel i
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=titles[0], xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))


# %% first_observation_decides loses 7.2
# Gives the controller the first observation in every step instead of the latest one.
# says: this
# -     observations = [observation]
# -     for _ in range(steps):
# -         observation, _, terminated, truncated, _ = env.step(controller(observation))
# +     observations, first = [observation], observation
# +     for _ in range(steps):
# +         observation, _, terminated, truncated, _ = env.step(controller(first))


# %% velocities_first loses 7.4
# Puts all velocities with the first angle first, then all with the second, but all angles with the first velocity should come first.
# says: this
# -     return np.stack([np.tile(angles, nvelocities), np.repeat(velocities, nangles)], axis=1)
# +     return np.stack([np.repeat(angles, nvelocities), np.tile(velocities, nangles)], axis=1)


# %% observation_of_the_step_before loses 7.4
# Gives the controller what the environment observed before the state was set instead of the observation of that state.
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
# Starts only the first step from a given state and goes on from there, but each step should start from its own given state.
# says: this
# -         env.unwrapped.state = np.array([angle, velocity])
# +         if not following:
# +             env.unwrapped.state = np.array([angle, velocity])


# %% last_state_missing loses 7.2
# Leaves out the state after the last step, but the recording should end with it.
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
# Lets the velocities go from -1 to 1 instead of from -8 to 8.
# says: this
# -     velocities = np.linspace(-8, 8, nvelocities)
# +     velocities = np.linspace(-1, 1, nvelocities)


# %% state_of_the_wrapper loses 7.4
# Starts each step from the state of a reset instead of the given state (see env.unwrapped.state).
# says: this
# -     env.reset()
# -     following = []
# +     following = []
# -         env.unwrapped.state = np.array([angle, velocity])
# +         env.reset(seed=0)
# +         env.state = np.array([angle, velocity])


# %% tells_minus_the_fitness loses 7.5
# Tells the algorithm minus the fitness, but the fitness itself is asked for.
# says: this
# -         algorithm.tell(fitness)
# +         algorithm.tell(-fitness)


# %% generations_from_one loses 7.5
# Keeps the generations every - 1, 2 * every - 1, ... instead of 0, every, 2 * every, ...
# says: this
# -         if generation % every == 0 or generation == generations - 1:
# +         if (generation + 1) % every == 0 or generation == generations - 1:


# %% angles_without_end loses 7.4
# Leaves out the upper end pi of the angles, but both ends should be included.
# says: this
# -     angles = np.linspace(-np.pi, np.pi, nangles)
# +     angles = np.linspace(-np.pi, np.pi, nangles, endpoint=False)


# %% stages_in_reverse loses 7.6
# Returns the last stage first and the first one last, but they should be in the order of the evolution.
# says: evaluated first
# -     return parameters[[0, middle, best]]
# +     return parameters[[best, middle, 0]]


# %% observation_of_another_reset loses 7.4
# Gives the controller the observation of the last step (at first that of the reset) instead of that of the given state.
# says: another answer: by chance
# -     env.reset()
# -     following = []
# +     observation, _ = env.reset()
# +     following = []
# -         seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
# -         observation, *_ = env.step(controller(seen))
# +         observation, *_ = env.step(controller(observation))


# %% columns_for_rows loses 7.1
# Takes the rows of an array of shape (n, 3) for cosines, sines and velocities, but these are its columns.
# says: this
# -     observation = np.asarray(observation, dtype=float)
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# -     return np.stack([angle, observation[..., 2]], axis=-1)
# +     cosine, sine, velocity = observation
# +     return np.array([np.arctan2(sine, cosine), velocity])


# %% next_states_for_the_changes loses 7.7
# Draws each arrow as long as the numbers of the next state, but it should be as long as its change.
# says: but covers
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         field, path = (np.hstack([a[:, :2], a[:, :2] + a[:, 2:]]) for a in (field, path))
# +         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# +         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)


# %% velocities_downwards loses 7.7
# Lets the velocities grow downwards, but they should grow upwards.
# says: but covers
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(8, -8))


# %% middle_of_the_arrow_in_its_state loses 7.7
# Puts the middle of each arrow into its state, but it should begin there.
# says: but covers
# -     exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
# +     exact = {"angles": "xy", "scale_units": "xy", "scale": 1, "pivot": "mid"}


# %% length_of_its_own loses 7.7
# Lets matplotlib choose the lengths of the arrows, but each should end exactly in the next state.
# says: but covers
# -     exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
# +     exact = {"angles": "xy"}


# %% angles_upwards loses 7.7
# Draws the angles upwards and the velocities from left to right instead of the other way round.
# says: but covers
# -         axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.quiver(*field[:, [1, 0, 3, 2]].T, color="#a8b4c0", width=0.0035, **exact)
# +         axes.quiver(*path[:, [1, 0, 3, 2]].T, color="#d55e00", width=0.005, **exact)
# +         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-8, 8), ylim=(-np.pi, np.pi))


# %% turns_from_zero loses 7.3
# Puts the changes of the angle between 0 and 2 pi instead of between -pi and pi.
# says: this
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = change[:, 0] % (2 * np.pi)


# %% half_turns loses 7.3
# Puts the changes of the angle between -pi / 2 and pi / 2, as if a whole turn were pi, but it is 2 pi.
# says: this
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = (change[:, 0] + np.pi / 2) % np.pi - np.pi / 2


# %% changes_cut_off loses 7.3
# Cuts off the changes of the angle at -pi and pi instead of taking the short way around.
# says: this
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = np.clip(change[:, 0], -np.pi, np.pi)


# %% angles_from_zero loses 7.4
# Lets the angles of the grid go from 0 to 2 pi instead of from -pi to pi.
# says: this
# -     angles = np.linspace(-np.pi, np.pi, nangles)
# +     angles = np.linspace(0, 2 * np.pi, nangles)


# %% rows_after_the_end loses 7.2
# Adds rows of zeros if the episode ends before `steps` steps, but only the states of the episode are asked for.
# says: this
_record_7 = record


def record(controller, seed, steps):
    found = _record_7(controller, seed, steps)
    return np.concatenate([found, np.zeros((steps + 1 - len(found), 2))])


# %% the_old_velocity_moves_the_angle loses 7.4
# Moves the angle with the velocity before the step, but Pendulum-v1 moves it with the velocity after the step.
# says: this
_next_states_7 = next_states


def next_states(controller, states):
    following = _next_states_7(controller, states)
    angle = states[:, 0] + 0.05 * states[:, 1]
    following[:, 0] = np.arctan2(np.sin(angle), np.cos(angle))
    return following


# %% amount_of_the_short_way loses 7.3
# Replaces a change of the angle beyond -pi or pi by 2 pi minus its amount, but for one above pi the short way around is negative.
# says: this
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     amount = np.abs(change[:, 0])
# +     change[:, 0] = np.where(amount > np.pi, 2 * np.pi - amount, change[:, 0])


# %% remainder_of_the_other_sign loses 7.3
# Leaves changes of the angle above pi as they are, but they should take the short way around, as those below -pi do.
# says: this
# -     change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
# +     change[:, 0] = np.fmod(change[:, 0] - np.pi, 2 * np.pi) + np.pi


# %% arrows_begin_in_the_next_state loses 7.3
# Begins the arrows in the states `after` instead of the states `before`.
# says: this
# -     return np.hstack([before, change])
# +     return np.hstack([after, change])


# %% angles_cut_off loses 7.4
# Cuts off the angles at -pi and pi, but 2 pi should be subtracted from an angle above pi, and added to one below -pi.
# says: this
# -         observation, *_ = env.step(controller(seen))
# -         following.append(observation)
# -     return to_state(np.array(following))
# +         env.step(controller(seen))
# +         following.append(env.unwrapped.state)
# +     return np.clip(np.array(following), [-np.pi, -8], [np.pi, 8])


# %% angles_of_the_environment loses 7.4
# Returns some angles below -pi or above pi, as env.unwrapped.state holds them, but all should be in [-pi, pi].
# says: this
# -         observation, *_ = env.step(controller(seen))
# -         following.append(observation)
# -     return to_state(np.array(following))
# +         env.step(controller(seen))
# +         following.append(env.unwrapped.state)
# +     return np.array(following)


# %% velocities_without_limit loses 7.4
# Lets the velocities go beyond -8 and 8, but Pendulum-v1 limits them to [-8, 8].
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
# Resets the environment with seed + 1 instead of seed.
# says: this
# -     observation, _ = env.reset(seed=seed)
# +     observation, _ = env.reset(seed=seed + 1)


# %% angle_of_the_sine_alone loses 7.1
# Gives np.arcsin(sine) as the angle, but this is always between -pi / 2 and pi / 2: the cosine should count, too.
# says: this
# -     angle = np.arctan2(observation[..., 1], observation[..., 0])
# +     angle = np.arcsin(observation[..., 1])


# %% panels_in_a_column loses 7.7
# Puts the panels one below the other instead of side by side.
# says: whatever is drawn
# -     panels = figure.subplots(1, len(titles), squeeze=False, sharey=True)[0]
# +     panels = figure.subplots(len(titles), 1, squeeze=False, sharey=True)[:, 0]


# %% first_arrow_of_a_path_only loses 7.7
# Draws only the first arrow of each path, but all of them are asked for.
# says: hardly seen
# -         axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
# +         axes.quiver(*path[:1].T, color="#d55e00", width=0.005, **exact)


# %% arrows_five_times_as_long loses 7.7
# Draws each arrow five times as long as its change, but it should end exactly in the next state.
# says: but covers
# -     exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
# +     exact = {"angles": "xy", "scale_units": "xy", "scale": 0.2}


# %% ends_with_the_episode loses 7.4
# Stops after 200 states, when the environment ends the episode, but the next state of each given state is asked for.
# says: this
# -         observation, *_ = env.step(controller(seen))
# -         following.append(observation)
# +         observation, _, terminated, truncated, _ = env.step(controller(seen))
# +         following.append(observation)
# +         if terminated or truncated:
# +             break


# %% the_best_of_all_since loses 7.5
# Keeps the best candidate since the last generation kept, but the best one of the kept generation alone is asked for.
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
# Sets the limits of the angles in the last panel only, but each panel should show exactly -pi to pi.
# says: whatever is drawn
# -         axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
# +         axes.set(title=title, xlabel="angle (0 is upright)", ylim=(-8, 8))
# -     panels[0].set_ylabel("velocity (rad/s)")
# +     panels[0].set_ylabel("velocity (rad/s)")
# +     axes.set_xlim(-np.pi, np.pi)


# %% gravity_of_9_81 loses 7.2
# Uses the gravity 9.81 instead of 10, the default of Pendulum-v1.
# says: this
# -     env = gymnasium.make("Pendulum-v1")
# -     observation, _ = env.reset(seed=seed)
# +     env = gymnasium.make("Pendulum-v1", g=9.81)
# +     observation, _ = env.reset(seed=seed)


# %% stages_by_linspace loses 7.5
# Spreads the kept generations evenly instead of keeping 0, every, 2 * every, ... and the last one.
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
# Lets the motor give more than 2 units of torque, but Pendulum-v1 limits it to [-2, 2].
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
# Leaves out the state after the step that ends the episode, but it belongs to the recording.
# says: this
# -         observations.append(observation)
# -         if terminated or truncated:
# -             break
# +         if terminated or truncated:
# +             break
# +         observations.append(observation)
# %% width_for_four_panels loses 7.7
# Makes the picture 1200 pixels wide whatever the number of panels, but each panel should be at least 300 pixels wide.
# says: needs at least 2100 x 300
# -     figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
# +     figure = Figure(figsize=(12, 4), layout="constrained")
