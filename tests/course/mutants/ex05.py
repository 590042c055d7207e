"""Wrong solutions of exercise 5; building.py describes how a case is written."""


# %% cut_off_instead_of_tanh loses 5.1
# Cuts the parameters of lengths and thicknesses off at -1 and 1 instead of putting them through tanh.
# says: this
# -     scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(SEGMENTS, 2))
# +     scales = 1 + 0.9 * np.clip(parameters[:22], -1, 1).reshape(SEGMENTS, 2)

# %% density_scaled_like_sizes loses 5.1
# Lets the density vary by 80 % (that is by 4) instead of by 0.8.
# says: this
_sizes = sizes


def sizes(parameters):
    size = _sizes(parameters)
    densities = 5 * (1 + 0.8 * np.tanh(parameters[53:]))
    return size | {"masses": size["lengths"] * size["thicknesses"] * densities}


# %% lengths_before_thicknesses loses 5.1
# Takes the first eleven parameters for the lengths and the next eleven for the thicknesses, but they should take turns.
# says: this
# -     scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(SEGMENTS, 2))
# -     lengths, thicknesses = 0.8 * scales[:, 0], 0.2 * scales[:, 1]
# +     scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(2, SEGMENTS))
# +     lengths, thicknesses = 0.8 * scales[0], 0.2 * scales[1]


# %% asks_the_simulator loses 5.1, 5.2, 5.3
# Lets the course's own decode (botschool.envs.morphology) take the body apart, but your code should do it.
def sizes(parameters):
    from botschool.envs.morphology import decode

    body = decode(parameters)
    masses = body.lengths * body.thicknesses * body.densities
    return {"lengths": body.lengths, "thicknesses": body.thicknesses, "masses": masses}


def joints(parameters):
    from botschool.envs.morphology import decode

    body = decode(parameters)
    return {"angles": body.angles, "lower": body.limits[:, 0], "upper": body.limits[:, 1]}


def outline(parameters):
    from botschool.envs import morphology

    return morphology.decode(parameters).corners()


# %% angles_not_cut_off loses 5.2
# Scales the parameters of the default angles without cutting them off at -1 and 1.
# says: this
_joints = joints


def joints(parameters):
    return _joints(parameters) | {"angles": 3 * np.pi / 4 * parameters[42:53]}


# %% limits_against_the_segment loses 5.2
# Counts the limits from the segment before instead of from the default angle.
_joints = joints


def joints(parameters):
    found = _joints(parameters)
    rest = found["angles"][1:]
    return found | {"lower": rest + found["lower"], "upper": rest + found["upper"]}


# %% limits_as_they_come loses 5.2
# Takes the first limit of each joint for the lower one and the second for the upper one, but the smaller one should be the lower one.
# says: this
_joints = joints


def joints(parameters):
    limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
    return _joints(parameters) | {"lower": limits[:, 0], "upper": limits[:, 1]}


# %% angles_against_the_ground loses 5.3
# Takes the default angle of each segment for its heading, but it should be added to the heading of the segment before.
# says: this
_joints_of_outline = joints


def outline(parameters):
    size = sizes(parameters)
    headings = _joints_of_outline(parameters)["angles"]
    along = np.stack([np.cos(headings), np.sin(headings)], axis=1)
    across = np.stack([-np.sin(headings), np.cos(headings)], axis=1)
    ends = np.cumsum(size["lengths"][:, None] * along, axis=0)
    beginnings = np.vstack([[0.0, 0.0], ends[:-1]])
    side = size["thicknesses"][:, None] / 2 * across
    return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)


# %% corners_the_other_way loses 5.3
# Gives the corners of each segment in the opposite order: beginning left, end left, end right, beginning right.
_outline = outline


def outline(parameters):
    return _outline(parameters)[:, ::-1]


# %% torso_in_the_middle loses 5.3
# Puts the middle of the torso at (0, 0) instead of its beginning.
_outline = outline


def outline(parameters):
    corners = _outline(parameters)
    return corners - corners[0].mean(axis=0)


# %% twice_as_thick loses 5.3
# Goes a whole thickness to each side, but half of it is asked for.
# says: this
# -     side = size["thicknesses"][:, None] / 2 * across
# +     side = size["thicknesses"][:, None] * across


# %% freedom_as_a_sum loses 5.4
# Adds up the freedom of the joints instead of taking the mean.
_describe = describe


def describe(parameters):
    found = _describe(parameters)
    return found | {"freedom": JOINTS * found["freedom"]}


# %% width_of_the_whole_chain loses 5.4
# Takes the length of all segments together for the width, but the width at rest is asked for.
_describe = describe


def describe(parameters):
    found = _describe(parameters)
    return found | {"width": found["length"]}


# %% fitness_not_post_evaluated loses 5.5
# Returns the genotype with the best fitness, but the one with the best post-evaluated fitness is asked for.
# -     Path(folder).mkdir(parents=True, exist_ok=True)
# -     experiment = config.load(experiment_file)
# +     Path(folder).mkdir(parents=True, exist_ok=True)
# -         run = Run(experiment, seed)
# +         run = Run(config.load(experiment_file), seed)
# -         walkers.append(run.record.bestg)
# +         walkers.append(run.record.best)


# %% nothing_saved loses 5.5
# Leaves no files of the runs in the folder, but they should be there.
import tempfile

_evolve_walkers = evolve_walkers


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    with tempfile.TemporaryDirectory(dir=".") as elsewhere:
        return _evolve_walkers(experiment_file, seeds, elsewhere, steps)


# %% steps_ignored loses 5.5
# Ends the runs when the experiment file says, but they should end after `steps`.
_evolve_walkers = evolve_walkers


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    return _evolve_walkers(experiment_file, seeds, folder)


# %% body_at_the_very_end loses 5.6
# Takes the last 64 numbers of a genotype for the body, but 70 more numbers (means and deviations) follow the body.
# -     return genotype[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS]
# +     return genotype[-BODY:]
# -     chimera[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
# +     chimera[-BODY:] = body[-BODY:]


# %% no_copy loses 5.6
# Changes a genotype that it is given, but a new one should be made.
# says: work on a copy
def transplant(brain, body):
    brain[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
    return brain


# %% normalisation_of_the_body loses 5.6
# Takes the means and deviations from the body's genotype, too, but they belong to the brain.
# -     chimera[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
# +     chimera[-2 * OBSERVATIONS - BODY :] = body[-2 * OBSERVATIONS - BODY :]


# %% other_ground_for_each loses 5.7
# Evaluates each pair with a seed of its own, but all pairs should have the same seed.
def cross_evaluate(experiment_file, walkers, seed, episodes):
    n = len(walkers)
    matrix = np.zeros((n, n))
    for i, j in np.ndindex(n, n):
        robot = SavedRobot(experiment_file, transplant(walkers[i], walkers[j]))
        matrix[i, j] = robot.evaluate(seed + n * i + j, episodes).mean()
    return matrix


# %% rows_and_columns_exchanged loses 5.7
# Has a row for each body and a column for each brain, but it should be the other way round.
# says: this
_cross_evaluate = cross_evaluate


def cross_evaluate(experiment_file, walkers, seed, episodes):
    return _cross_evaluate(experiment_file, walkers, seed, episodes).T


# %% as_good_elsewhere loses 5.8
# Counts brains that do just as well in another body, but a brain should do better in its own body.
_loss = loss


def loss(matrix):
    at_home = np.sum(np.diagonal(matrix) >= matrix.max(axis=1))
    return {**_loss(matrix), "at home": int(at_home)}


# %% at_home_by_column loses 5.8
# Counts the bodies that do best with their own brain, but the brains that do best in their own body are asked for.
_loss = loss


def loss(matrix):
    return _loss(matrix) | {"at home": _loss(matrix.T)["at home"]}


# %% better_than_nothing loses 5.8
# Counts a brain only if its own return is above 0, too, but it should be compared with its other returns alone.
_loss = loss


def loss(matrix):
    others = matrix * (1 - np.eye(len(matrix)))
    at_home = np.sum(np.diagonal(matrix) > others.max(axis=1))
    return {**_loss(matrix), "at home": int(at_home)}


# %% brains_and_bodies_exchanged loses 5.8
# Gives the losses of the bodies as "brains" and those of the brains as "bodies".
# says: this
_loss = loss


def loss(matrix):
    found = _loss(matrix)
    return found | {"brains": found["bodies"], "bodies": found["brains"]}


# %% own_among_the_others loses 5.8
# Counts the diagonal among the others for "foreign", "brains" and "bodies", but it should be left out.
def loss(matrix):
    own = np.diagonal(matrix)
    return {
        "own": float(own.mean()),
        "foreign": float(matrix.mean()),
        "brains": own - matrix.mean(axis=1),
        "bodies": own - matrix.mean(axis=0),
        "at home": int(np.sum(own == matrix.max(axis=1))),
    }


# %% tanh_in_place loses 5.1
# Puts the given parameters themselves through tanh, but they should stay as they are.
# says: work on a copy
# -     scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(SEGMENTS, 2))
# +     np.tanh(parameters[:22], out=parameters[:22])
# +     scales = 1 + 0.9 * parameters[:22].reshape(SEGMENTS, 2)


# %% cut_off_in_place loses 5.2
# Cuts off the given parameters themselves, but they should stay as they are.
# says: work on a copy
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     np.clip(parameters[22:53], -1, 1, out=parameters[22:53])
# +     limits = np.pi / 2 * parameters[22:42].reshape(JOINTS, 2)


# %% half_of_the_thickness_forgotten loses 5.4
# Measures width and height along the middle line, but the corners of the segments should be measured.
# -     width, height = np.ptp(outline(parameters), axis=(0, 1))
# +     corners = outline(parameters)
# +     line = np.stack([corners[:, [0, 3]].mean(axis=1), corners[:, [1, 2]].mean(axis=1)])
# +     width, height = np.ptp(line, axis=(0, 1))


# %% rising_seeds loses 5.5
# Returns the walkers in the rising order of their seeds, but the order of `seeds` is asked for.
# -     for seed in seeds:
# -         run = Run(experiment, seed)
# +     for seed in sorted(seeds):
# +         run = Run(experiment, seed)


# %% body_swapped_in_the_table loses 5.7
# Changes the walkers that it is given, but they should stay as they are.
def cross_evaluate(experiment_file, walkers, seed, episodes):
    bodies = np.array([body_of(walker) for walker in walkers])
    matrix = np.zeros((len(walkers), len(walkers)))
    for i, walker in enumerate(walkers):
        for j, body in enumerate(bodies):
            walker[-134:-70] = body
            matrix[i, j] = SavedRobot(experiment_file, walker).evaluate(seed, episodes).mean()
    return matrix


# %% diagonal_filled_in_place loses 5.8
# Fills the diagonal of the given matrix itself with minus infinity, but the matrix should stay as it is.
# says: work on a copy
# -     others = np.where(np.eye(n, dtype=bool), -np.inf, matrix)
# -     return {
# +     answer = {
# -         "at home": int(np.sum(own > others.max(axis=1))),
# -     }
# +     }
# +     own = own.copy()
# +     np.fill_diagonal(matrix, -np.inf)
# +     return answer | {"at home": int(np.sum(own > matrix.max(axis=1)))}


# %% median_of_the_episodes loses 5.7
# Takes the median of the episodes instead of the mean.
# -                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes).mean()
# +                 np.median(
# +                     SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes)
# +                 )


# %% seed_zero_is_one loses 5.7
# Takes the seed 1 where 0 is given.
# -                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes).mean()
# +                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed or 1, episodes).mean()


# %% walkers_of_earlier_calls loses 5.5
# Returns the walkers of earlier calls, too, but only those of the given seeds are asked for.
_evolve_walkers = evolve_walkers


def evolve_walkers(experiment_file, seeds, folder, steps=None, found=[]):  # noqa: B006
    found += list(_evolve_walkers(experiment_file, seeds, folder, steps))
    return np.array(found)


# %% home_against_the_mean loses 5.8
# Counts a brain that does better at home than in the others on average, but it should do better than in each of them.
# -         "at home": int(np.sum(own > others.max(axis=1))),
# +         "at home": int(np.sum(own > (matrix.sum(axis=1) - own) / (n - 1))),


# %% best_of_the_foreign loses 5.8
# Subtracts the best of a brain's other returns instead of their mean for "brains".
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# +         "brains": own - others.max(axis=1),


# %% half_of_the_freedom loses 5.4
# Takes the mean of the upper limits for the freedom, but the lower ones should be subtracted first.
# -         "freedom": float(np.mean(angles["upper"] - angles["lower"])),
# +         "freedom": float(np.mean(angles["upper"])),


# %% uses_up_the_seeds loses 5.5
# Empties the list of seeds that it is given, but the list should stay as it is.
# -     for seed in seeds:
# -         run = Run(experiment, seed)
# +     while seeds:
# +         seed = seeds.pop(0)
# +         run = Run(experiment, seed)


# %% whole_joints_only loses 5.2
# Cuts the default angles off at -1 and 1 after scaling, but the parameters should be cut off before.
# -         "angles": 3 * np.pi / 4 * np.clip(parameters[42:53], -1, 1),
# +         "angles": np.clip(3 * np.pi / 4 * parameters[42:53], -1, 1),


# %% first_segment_missing loses 5.4
# Leaves the torso out of the mass, but all segments should count.
# -         "mass": float(size["masses"].sum()),
# +         "mass": float(size["masses"][1:].sum()),


# %% mirrored_matrix loses 5.7
# Gives the return of brain i in body j for brain j in body i, too (i < j), but each pair has its own return.
# says: this
def cross_evaluate(experiment_file, walkers, seed, episodes):
    n = len(walkers)
    found = np.zeros((n, n))
    for i in range(n):
        for j in range(i, n):
            one = SavedRobot(experiment_file, transplant(walkers[i], walkers[j]))
            found[i, j] = found[j, i] = one.evaluate(seed, episodes).mean()
    return found


# %% first_episode_only loses 5.7
# Counts the first episode only, but the mean over all episodes is asked for.
# says: this
# -                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes).mean()
# +                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes)[0]


# %% own_body_only loses 5.7
# Leaves each brain in its own body, but it should be evaluated in every body.
# says: this
# -                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes).mean()
# +                 SavedRobot(experiment_file, brain).evaluate(seed, episodes).mean()


# %% size_without_factor loses 5.1
# Adds 0.9 tanh p to the nominal size instead of multiplying the size by 1 + 0.9 tanh p.
# says: this
# -     lengths, thicknesses = 0.8 * scales[:, 0], 0.2 * scales[:, 1]
# +     lengths, thicknesses = scales[:, 0] - 0.2, scales[:, 1] - 0.8


# %% first_limits_then_others loses 5.2
# Takes the first ten parameters for one limit of each joint and the next ten for the other, but both stand side by side.
# says: this
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(2, JOINTS).T


# %% scales_of_angles_exchanged loses 5.2
# Scales the default angles by pi / 2 and the limits by 3 pi / 4, but it should be the other way round.
# says: this
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     limits = 3 * np.pi / 4 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# -         "angles": 3 * np.pi / 4 * np.clip(parameters[42:53], -1, 1),
# +         "angles": np.pi / 2 * np.clip(parameters[42:53], -1, 1),


# %% heading_of_the_one_before loses 5.3
# Leaves a segment's own angle out of its heading: each has the heading that the one before it should have.
# says: this
# -     headings = np.cumsum(joints(parameters)["angles"])
# +     headings = np.cumsum(joints(parameters)["angles"]) - joints(parameters)["angles"]


# %% flat_torso loses 5.3
# Takes 0 for the default angle of the torso, but it should count in all headings.
# says: this
# -     headings = np.cumsum(joints(parameters)["angles"])
# +     turns = joints(parameters)["angles"].copy()
# +     turns[0] = 0
# +     headings = np.cumsum(turns)


# %% freedom_of_the_amounts loses 5.4
# Adds the amounts of the two limits for the freedom, but both may lie on one side of the default angle.
# says: this
# -         "freedom": float(np.mean(angles["upper"] - angles["lower"])),
# +         "freedom": float(np.mean(np.abs(angles["upper"]) + np.abs(angles["lower"]))),


# %% length_as_a_distance loses 5.4
# Takes the distance from the first place to the last one for the length, but all lengths should be added up.
# says: this
# -         "length": float(size["lengths"].sum()),
# +         "length": float(np.linalg.norm(outline(parameters)[-1, 1:3].mean(axis=0))),


# %% foreign_among_all loses 5.8
# Counts the diagonal in the mean of the foreign returns, but it should be left out.
# says: this
# -         "foreign": float(foreign / (n * n - n)),
# +         "foreign": float(matrix.mean()),


# %% foreign_above_the_diagonal loses 5.8
# Counts only the places above the diagonal as foreign, but those below are foreign, too.
# says: this
# -         "foreign": float(foreign / (n * n - n)),
# +         "foreign": float(matrix[np.triu_indices(n, 1)].mean()),


# %% loss_as_a_share loses 5.8
# Divides the losses of brains and bodies by the own return, but the differences themselves are asked for.
# says: this
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# -         "bodies": own - (matrix.sum(axis=0) - own) / (n - 1),
# +         "brains": 1 - (matrix.sum(axis=1) - own) / (n - 1) / own,
# +         "bodies": 1 - (matrix.sum(axis=0) - own) / (n - 1) / own,

# %% factor_inside_tanh loses 5.1
# Takes tanh(0.9 p) for lengths and thicknesses instead of 0.9 tanh p.
# says: this
# -     scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(SEGMENTS, 2))
# +     scales = 1 + np.tanh(0.9 * parameters[:22].reshape(SEGMENTS, 2))


# %% first_body_kept loses 5.1
# Gives the answer for the first body for all others, too.
# says: in a new process gives the right answer
_sizes, _kept = sizes, {}


def sizes(parameters):
    if not _kept:
        _kept.update(_sizes(parameters))
    return _kept


# %% limits_cut_off_after_scaling loses 5.2
# Cuts the limits off at -1 and 1 after scaling, but the parameters should be cut off before.
# says: this
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     limits = np.clip(np.pi / 2 * parameters[22:42], -1, 1).reshape(JOINTS, 2)


# %% limits_to_both_sides loses 5.2
# Takes the amount of one limit downwards and that of the other upwards, but both can lie on one side.
# says: this
# -         "lower": limits.min(axis=1),
# -         "upper": limits.max(axis=1),
# +         "lower": -np.abs(limits[:, 0]),
# +         "upper": np.abs(limits[:, 1]),


# %% limits_sorted_in_place loses 5.2
# Sorts the two limits of each joint in the given parameters themselves, but these should stay as they are.
# says: work on a copy
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     parameters[22:42].reshape(JOINTS, 2).sort(axis=1)
# +     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)


# %% angles_in_degrees loses 5.2
# Gives the angles in degrees, but radians are asked for.
# says: this
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# -     return {
# -         "angles": 3 * np.pi / 4 * np.clip(parameters[42:53], -1, 1),
# +     limits = 90 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     return {
# +         "angles": 135 * np.clip(parameters[42:53], -1, 1),


# %% corners_row_by_row loses 5.3
# Gives the corners in the order beginning right, beginning left, end left, end right, but "beginning left" should come last.
# says: this
# -     return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
# +     return np.stack([beginnings - side, beginnings + side, ends + side, ends - side], axis=1)


# %% begins_with_the_one_before loses 5.3
# Lets each segment begin where the one before it begins, but it should begin where that one ends.
# says: this
# -     beginnings = np.vstack([[0.0, 0.0], ends[:-1]])
# +     beginnings = np.vstack([[0.0, 0.0], [0.0, 0.0], ends[:-2]])


# %% headings_cut_off loses 5.3
# Cuts the headings off at -pi and pi, but they are sums and may go beyond.
# says: this
# -     headings = np.cumsum(joints(parameters)["angles"])
# +     headings = np.clip(np.cumsum(joints(parameters)["angles"]), -np.pi, np.pi)


# %% all_as_thick_as_the_torso loses 5.3
# Draws all segments as thick as the torso, but each should have its own thickness.
# says: this
# -     side = size["thicknesses"][:, None] / 2 * across
# +     side = size["thicknesses"][0] / 2 * across


# %% width_of_the_two_ends loses 5.4
# Takes the way from the first place to the last one for width and height, but all corners should count.
# says: this
# -     width, height = np.ptp(outline(parameters), axis=(0, 1))
# +     width, height = np.abs(outline(parameters)[-1, 1:3].mean(axis=0))


# %% freedom_of_the_extremes loses 5.4
# Subtracts the lowest of all limits from the highest, but each joint should have its own difference.
# says: this
# -         "freedom": float(np.mean(angles["upper"] - angles["lower"])),
# +         "freedom": float(np.max(angles["upper"]) - np.min(angles["lower"])),


# %% length_without_torso loses 5.4
# Leaves the torso out of the length, but all segments should count.
# says: this
# -         "length": float(size["lengths"].sum()),
# +         "length": float(size["lengths"][1:].sum()),


# %% one_run_for_all loses 5.5
# Returns the walker of the first seed for all seeds, but each seed should have its own run.
# says: this
# -     for seed in seeds:
# -         run = Run(experiment, seed)
# +     for _ in seeds:
# +         run = Run(experiment, seeds[0])


# %% places_for_seeds loses 5.5
# Uses the seeds 0, 1, ... instead of those that are given.
# says: this
# -     for seed in seeds:
# +     for seed in range(len(seeds)):


# %% zero_is_no_seed loses 5.5
# Takes the seed 1 where the seed 0 is given.
# says: seed like any other
# -         run = Run(experiment, seed)
# +         run = Run(experiment, seed or 1)


# %% folder_above_missing loses 5.5
# Does not make the folders above the folder, but they should be made if they do not exist.
# says: this
# -     Path(folder).mkdir(parents=True, exist_ok=True)
# -     experiment = config.load(experiment_file)
# +     Path(folder).mkdir(exist_ok=True)
# +     experiment = config.load(experiment_file)


# %% a_folder_for_each_seed loses 5.5
# Leaves the files of each run in a folder of its own, but they should all be in the folder that is given.
# says: this
# -         evolve(run, Path(folder), steps)
# +         own = Path(folder) / str(seed)
# +         own.mkdir(exist_ok=True)
# +         evolve(run, own, steps)


# %% best_walker_first loses 5.5
# Returns the walkers with the best one first, but the order of `seeds` is asked for.
# says: this
# -         walkers.append(run.record.bestg)
# -     return np.array(walkers)
# +         walkers.append((-run.record.bestg_fitness, seed, run.record.bestg))
# +     return np.array([walker for _, _, walker in sorted(walkers)])


# %% three_walkers_at_most loses 5.7
# Makes a table of three rows and columns at most, but each walker should have a row and a column.
# says: this
# -                 for body in walkers
# -             ]
# -             for brain in walkers
# +                 for body in walkers[:3]
# +             ]
# +             for brain in walkers[:3]


# %% bodies_overwritten_one_by_one loses 5.7
# Gives the brains of later rows bodies that have been overwritten in earlier rows, but the walkers' own bodies are asked for.
# says: this
def cross_evaluate(experiment_file, walkers, seed, episodes):
    walkers, n = walkers.copy(), len(walkers)
    matrix = np.zeros((n, n))
    part = slice(-2 * OBSERVATIONS - BODY, -2 * OBSERVATIONS)
    for i, j in np.ndindex(n, n):
        walkers[i, part] = walkers[j, part]
        matrix[i, j] = SavedRobot(experiment_file, walkers[i]).evaluate(seed, episodes).mean()
    return matrix


# %% five_episodes_always loses 5.7
# Evaluates five episodes, however many are asked for.
# -                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes).mean()
# +                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, 5).mean()


# %% own_body_among_the_brains_others loses 5.8
# Counts the own body among a brain's others for "brains", but it should be left out.
# says: this
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# +         "brains": own - matrix.mean(axis=1),


# %% the_other_diagonal loses 5.8
# Takes the diagonal from the lower left to the upper right instead of the one from the upper left.
# says: this
# -     own = np.diagonal(matrix)
# +     own = np.diagonal(matrix[:, ::-1])


# %% share_at_home loses 5.8
# Returns the share of the brains that are at home instead of their number.
# says: this
# -         "at home": int(np.sum(own > others.max(axis=1))),
# +         "at home": float(np.mean(own > others.max(axis=1))),


# %% loss_of_brains_as_a_share loses 5.8
# Divides the loss of the brains by their own return, but the difference itself is asked for.
# says: this
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# +         "brains": 1 - (matrix.sum(axis=1) - own) / (n - 1) / own,


# %% densities_of_the_angles loses 5.1
# Takes the parameters of the default angles for the densities, whose own are at the places 53 to 63.
# says: this
def sizes(parameters):
    t = np.tanh(parameters)
    lengths = 0.8 + 0.72 * t[:22:2]
    thicknesses = 0.2 + 0.18 * t[1:22:2]
    densities = 5 + 0.8 * t[42:53]
    return {
        "lengths": lengths,
        "thicknesses": thicknesses,
        "masses": lengths * thicknesses * densities,
    }


# %% smaller_in_amount loses 5.2
# Takes the limit with the smaller amount for the lower one, but the more negative one should be the lower one.
# says: this
def joints(parameters):
    limits = (np.pi / 2 * np.clip(parameters[22:42], -1, 1)).reshape(10, 2)
    lower, upper = [], []
    for a, b in limits:
        if abs(a) < abs(b):
            lower.append(a)
            upper.append(b)
        else:
            lower.append(b)
            upper.append(a)
    return {
        "angles": 0.75 * np.pi * np.clip(parameters[42:53], -1, 1),
        "lower": np.array(lower),
        "upper": np.array(upper),
    }


# %% torso_without_angle loses 5.2
# Sets the default angle of the torso to 0, but it should come from its parameter.
# says: this
def joints(parameters):
    clipped = np.clip(parameters, -1, 1)
    pairs = np.sort(clipped[22:42].reshape(10, 2) * np.pi / 2, axis=1)
    angles = clipped[42:53] * 3 * np.pi / 4
    angles[0] = 0
    return {"angles": angles, "lower": pairs[:, 0], "upper": pairs[:, 1]}


# %% sorted_over_the_joints loses 5.2
# Sorts the limits from joint to joint instead of the two of each joint.
# says: this
def joints(parameters):
    clipped = np.clip(parameters, -1, 1)
    pairs = np.sort(clipped[22:42].reshape(10, 2) * np.pi / 2, axis=0)
    angles = clipped[42:53] * 3 * np.pi / 4
    return {"angles": angles, "lower": pairs[:, 0], "upper": pairs[:, 1]}


# %% next_from_the_left_corner loses 5.3
# Lets the next segment begin at the left corner of the end, but it should begin in the middle of the end.
# says: this
def outline(parameters):
    s = sizes(parameters)
    heads = np.cumsum(joints(parameters)["angles"])
    corners = np.zeros((11, 4, 2))
    pos = np.zeros(2)
    for i, h in enumerate(heads):
        d = np.array([np.cos(h), np.sin(h)]) * s["lengths"][i]
        n = np.array([-np.sin(h), np.cos(h)]) * s["thicknesses"][i] / 2
        corners[i] = [pos - n, pos + d - n, pos + d + n, pos + n]
        pos = pos + d + n
    return corners


# %% torso_angle_twice loses 5.3
# Counts the torso's angle twice from segment 1 on, and each other angle one segment too late.
# says: this
def outline(parameters):
    size, angle = sizes(parameters), joints(parameters)["angles"]
    x, y, h = 0.0, 0.0, angle[0]
    out = np.zeros((11, 4, 2))
    for k in range(11):
        long, t = size["lengths"][k], size["thicknesses"][k] / 2
        ex, ey = x + long * np.cos(h), y + long * np.sin(h)
        sx, sy = -t * np.sin(h), t * np.cos(h)
        out[k] = [[x - sx, y - sy], [ex - sx, ey - sy], [ex + sx, ey + sy], [x + sx, y + sy]]
        x, y = ex, ey
        h = h + angle[k]
    return out


# %% torso_begins_at_the_end loses 5.3
# Lets the torso begin where the last segment ends, but it should begin at (0, 0).
# says: this
# -     beginnings = np.vstack([[0.0, 0.0], ends[:-1]])
# +     beginnings = np.roll(ends, 1, axis=0)


# %% one_corner_of_each loses 5.4
# Measures width and height with the first corner of each segment only, but all four should count.
# says: this
# -     width, height = np.ptp(outline(parameters), axis=(0, 1))
# +     width, height = np.ptp(outline(parameters)[:, 0], axis=0)


# %% freedom_beyond_the_limits loses 5.4
# Takes the freedom from parameters that are not cut off at -1 and 1, but they should be.
# says: this
def describe(parameters):
    s, o = sizes(parameters), outline(parameters)
    x, y = o[:, :, 0], o[:, :, 1]
    raw = parameters[22:42].reshape(10, 2)
    return {
        "length": float(np.sum(s["lengths"])),
        "mass": float(np.sum(s["masses"])),
        "width": float(x.max() - x.min()),
        "height": float(y.max() - y.min()),
        "freedom": float(np.mean(abs(raw[:, 0] - raw[:, 1])) * np.pi / 2),
    }


# %% means_forgotten loses 5.6
# Lets 35 numbers follow the body, but 35 means and 35 deviations follow it.
# says: this
# -     return genotype[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS]
# +     return genotype[-OBSERVATIONS - BODY : -OBSERVATIONS]


# %% seed_of_the_row loses 5.7
# Evaluates each row with a seed of its own, but all pairs should have the same seed.
# says: this
def cross_evaluate(experiment_file, walkers, seed, episodes):
    n = len(walkers)
    m = np.zeros((n, n))
    for i in range(n):
        for j in range(n):
            robot = SavedRobot(experiment_file, transplant(walkers[i], walkers[j]))
            m[i, j] = np.mean(robot.evaluate(seed + i, episodes))
    return m


# %% nothing_on_the_diagonal loses 5.7
# Leaves 0 on the diagonal, but each brain should be evaluated in its own body, too.
# says: this
def cross_evaluate(experiment_file, walkers, seed, episodes):
    n = len(walkers)
    matrix = np.zeros((n, n))
    for i in range(n):
        for j in range(n):
            if i != j:
                matrix[i, j] = (
                    SavedRobot(experiment_file, transplant(walkers[i], walkers[j]))
                    .evaluate(seed, episodes)
                    .mean()
                )
    return matrix


# %% steps_shared loses 5.5
# Shares the steps among the runs, but each run should have all of them.
# says: this
# -         evolve(run, Path(folder), steps)
# +         evolve(run, Path(folder), steps // len(seeds) if steps else None)


# %% losses_column_by_column loses 5.8
# Subtracts each return from the own return of its column for "brains", but the own return of its row is asked for.
# says: this
def loss(matrix):
    n = len(matrix)
    d = np.diag(matrix)
    mask = ~np.eye(n, dtype=bool)
    diff = d - matrix
    return {
        "own": d.mean(),
        "foreign": matrix[mask].mean(),
        "brains": diff.sum(axis=1) / (n - 1),
        "bodies": diff.sum(axis=0) / (n - 1),
        "at home": int(np.all(d[:, None] >= matrix, axis=1).sum()),
    }


# %% torso_turns_on loses 5.2
# Cuts off the parameters of all default angles but the torso's, which should be cut off, too.
# -         "angles": 3 * np.pi / 4 * np.clip(parameters[42:53], -1, 1),
# +         "angles": 3 * np.pi / 4 * np.append(parameters[42], np.clip(parameters[43:53], -1, 1)),


# %% density_of_the_torso loses 5.1
# Takes the density of the torso for all segments, but each should have its own.
# says: this
# -     densities = 5 + 0.8 * np.tanh(parameters[53:])
# +     densities = 5 + 0.8 * np.tanh(parameters[53])


# %% across_the_torso loses 5.3
# Takes the direction across the torso for all segments, but each should have its own.
# says: this
# -     side = size["thicknesses"][:, None] / 2 * across
# +     side = size["thicknesses"][:, None] / 2 * across[0]


# %% middle_as_a_fifth_corner loses 5.3
# Adds the middle of each segment as a fifth corner, but only its four corners are asked for.
# says: this
# -     return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
# +     return np.stack(
# +         [beginnings - side, ends - side, ends + side, beginnings + side, (beginnings + ends) / 2],
# +         axis=1,
# +     )


# %% body_at_the_front loses 5.6
# Puts the foreign body into the first 64 places, but the network stands there.
# says: this
# -     chimera[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
# +     chimera[:BODY] = body_of(body)


# %% home_against_all_foreign loses 5.8
# Compares each brain with the best of all foreign places, but it should be compared with those of its own row.
# says: this
# -         "at home": int(np.sum(own > others.max(axis=1))),
# +         "at home": int(np.sum(own > others.max())),


# %% home_against_the_next loses 5.8
# Compares each brain with the next body only, but it should be compared with each of the others.
# says: this
# -         "at home": int(np.sum(own > others.max(axis=1))),
# +         "at home": int(np.sum(own > np.roll(matrix, -1, axis=1).diagonal())),


# %% lengths_without_tanh loses 5.1
# Leaves tanh out in the lengths: uses the parameters themselves.
# says: this
# -     lengths, thicknesses = 0.8 * scales[:, 0], 0.2 * scales[:, 1]
# +     lengths, thicknesses = 0.8 + 0.72 * parameters[:22:2], 0.2 * scales[:, 1]


# %% old_robots_in_the_folder loses 5.5
# Returns the old walker of a seed whose file is in the folder already, but it should be run with the steps that are given.
# says: or a file\.|files that were there before
# -         run = Run(experiment, seed)
# -         evolve(run, Path(folder), steps)
# -         walkers.append(run.record.bestg)
# +         saved = Path(folder) / f"bestgS{seed}.npy"
# +         if not saved.exists():
# +             evolve(Run(experiment, seed), Path(folder), steps)
# +         walkers.append(np.load(saved))


# %% all_files_of_the_folder loses 5.5
# Returns the walkers of all files in the folder, ordered by name, but those of `seeds` in their order are asked for.
# says: this
def evolve_walkers(
    experiment_file: str, seeds: list[int], folder: str, steps: int | None = None
) -> np.ndarray:
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for seed in seeds:
        evolve(Run(config.load(experiment_file), seed), target, steps)
    return np.array([np.load(file) for file in sorted(target.glob("bestgS*.npy"))])


# %% tanh_of_two_exponentials loses 5.1
# Gives NaN for very large parameters, where tanh is 1 or -1. (The quotient of two infinite exponentials is NaN.)
# says: this
def sizes(parameters: np.ndarray) -> dict:
    def squash(p):
        return (np.exp(p) - np.exp(-p)) / (np.exp(p) + np.exp(-p))

    p = np.asarray(parameters, dtype=float)
    lengths = 0.8 * (1 + 0.9 * squash(p[0:22:2]))
    thicknesses = 0.2 * (1 + 0.9 * squash(p[1:22:2]))
    densities = 5 + 0.8 * squash(p[53:64])
    masses = lengths * thicknesses * densities
    return {"lengths": lengths, "thicknesses": thicknesses, "masses": masses}


# %% limits_overwritten loses 5.2
# Gives the smaller limit of a joint as both limits if the larger one comes first.
# says: this
def joints(parameters: np.ndarray) -> dict:
    def cut(part):
        return np.clip(part, -1, 1)

    lower = np.pi / 2 * cut(parameters[22:42:2])
    upper = np.pi / 2 * cut(parameters[23:42:2])
    wrong = lower > upper
    lower[wrong] = upper[wrong]
    upper[wrong] = lower[wrong]
    return {"angles": 3 * np.pi / 4 * cut(parameters[42:53]), "lower": lower, "upper": upper}


# %% corners_in_two_rows loses 5.4
# Takes the first half of all corners' numbers for x and the second for y, but x and y stand side by side.
# says: this
# -     width, height = np.ptp(outline(parameters), axis=(0, 1))
# +     x, y = outline(parameters).reshape(2, -1)
# +     width, height = x.max() - x.min(), y.max() - y.min()


# %% body_counted_from_the_front loses 5.6
# Takes the body from behind a network of ten hidden neurons, but the network can have another size.
# says: this
# -     return genotype[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS]
# +     hidden, outputs = 10, 10
# +     network = OBSERVATIONS * hidden + hidden * outputs + hidden + outputs
# +     return genotype[network : network + BODY]


# %% one_plus_tanh_times_factor loses 5.1
# Takes 0.9 (1 + tanh p) instead of 1 + 0.9 tanh p for lengths and thicknesses.
# -     scales = 1 + 0.9 * np.tanh(parameters[:22].reshape(SEGMENTS, 2))
# +     scales = 0.9 * (1 + np.tanh(parameters[:22].reshape(SEGMENTS, 2)))


# %% densities_vary_like_lengths loses 5.1
# Lets the density vary by 90 %, as the sizes do, but it should vary by 0.8.
# -     densities = 5 + 0.8 * np.tanh(parameters[53:])
# +     densities = 5 * (1 + 0.9 * np.tanh(parameters[53:]))


# %% round_rods loses 5.1
# Takes the segments for round rods, but a mass should be length x thickness x density.
# -         "masses": lengths * thicknesses * densities,
# +         "masses": lengths * np.pi * (thicknesses / 2) ** 2 * densities,


# %% nothing_cut_off loses 5.2
# Scales the parameters of angles and limits without cutting them off at -1 and 1.
# -     limits = np.pi / 2 * np.clip(parameters[22:42], -1, 1).reshape(JOINTS, 2)
# +     limits = np.pi / 2 * parameters[22:42].reshape(JOINTS, 2)
# -         "angles": 3 * np.pi / 4 * np.clip(parameters[42:53], -1, 1),
# +         "angles": 3 * np.pi / 4 * parameters[42:53],


# %% limits_around_zero loses 5.2
# Takes minus the upper limit for the lower one, but each limit has a parameter of its own.
# -         "lower": limits.min(axis=1),
# +         "lower": -limits.max(axis=1),


# %% one_list_of_corners loses 5.3
# Gives all 44 corners in one list, but the four corners of each segment belong together.
# -     return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
# +     corners = np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
# +     return corners.reshape(-1, 2)


# %% closed_rectangles loses 5.3
# Repeats the first corner of each segment at the end, but each of the four should be there once.
# -     return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
# +     corners = [beginnings - side, ends - side, ends + side, beginnings + side]
# +     return np.stack([*corners, corners[0]], axis=1)


# %% across_the_ground loses 5.3
# Goes straight up and down to the corners, but the direction across a segment turns with it.
# -     across = np.stack([-np.sin(headings), np.cos(headings)], axis=1)
# +     across = np.stack([0 * headings, 1 + 0 * headings], axis=1)


# %% headings_from_the_last loses 5.3
# Adds the default angles up from the last segment on, but it should be done from the torso on.
# -     headings = np.cumsum(joints(parameters)["angles"])
# +     headings = np.cumsum(joints(parameters)["angles"][::-1])[::-1]


# %% angles_as_degrees loses 5.3
# Takes the default angles for degrees, but they are radians.
# -     headings = np.cumsum(joints(parameters)["angles"])
# +     headings = np.radians(np.cumsum(joints(parameters)["angles"]))


# %% width_from_zero loses 5.4
# Takes the largest coordinates for width and height, but the smallest should be subtracted.
# -     width, height = np.ptp(outline(parameters), axis=(0, 1))
# +     width, height = outline(parameters).max(axis=(0, 1))


# %% widest_segment loses 5.4
# Takes the largest width and height of a single segment, but those of the whole body are asked for.
# -     width, height = np.ptp(outline(parameters), axis=(0, 1))
# +     width, height = np.ptp(outline(parameters), axis=1).max(axis=0)


# %% best_of_all_runs loses 5.5
# Returns the walker of the last run only, but each run should have a row.
# -         walkers.append(run.record.bestg)
# -     return np.array(walkers)
# +         walkers = run.record.bestg
# +     return np.array(walkers)


# %% next_seeds loses 5.5
# Counts on from the first seed, but each seed of the list should be used.
# -     for seed in seeds:
# -         run = Run(experiment, seed)
# +     for seed in range(seeds[0], seeds[0] + len(seeds)):
# +         run = Run(experiment, seed)


# %% bodies_of_the_walkers loses 5.5
# Returns the bodies alone, but the whole genotypes are asked for.
# -     return np.array(walkers)
# +     return np.array(walkers)[:, -134:-70]


# %% body_added_to_the_own loses 5.6
# Puts the foreign body behind the brain's own, but it should take its place.
# -     chimera[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
# -     return chimera
# +     return np.concatenate([brain[: -2 * OBSERVATIONS], body_of(body), brain[-2 * OBSERVATIONS :]])


# %% without_normalisation loses 5.6
# Leaves means and deviations out, but those of the brain should follow the body.
# -     chimera[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
# -     return chimera
# +     return np.concatenate([brain[: -2 * OBSERVATIONS - BODY], body_of(body)])


# %% one_episode_always loses 5.7
# Evaluates one episode, however many are asked for.
# -                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, episodes).mean()
# +                 SavedRobot(experiment_file, transplant(brain, body)).evaluate(seed, 1).mean()


# %% minus_the_own loses 5.7
# Subtracts the return in the own body, but the returns themselves are asked for.
_cross_evaluate = cross_evaluate


def cross_evaluate(experiment_file, walkers, seed, episodes):
    matrix = _cross_evaluate(experiment_file, walkers, seed, episodes)
    return matrix - np.diagonal(matrix)[:, None]


# %% others_divided_by_all loses 5.8
# Divides the sum of a brain's or body's others by n instead of n - 1.
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# -         "bodies": own - (matrix.sum(axis=0) - own) / (n - 1),
# +         "brains": own - (matrix.sum(axis=1) - own) / n,
# +         "bodies": own - (matrix.sum(axis=0) - own) / n,


# %% all_foreign_for_each loses 5.8
# Subtracts the mean of all foreign places instead of that of the row or column.
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# -         "bodies": own - (matrix.sum(axis=0) - own) / (n - 1),
# +         "brains": own - foreign / (n * n - n),
# +         "bodies": own - foreign / (n * n - n),


# %% foreign_minus_own loses 5.8
# Subtracts the own return from the mean of the others, but it should be the other way round.
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# -         "bodies": own - (matrix.sum(axis=0) - own) / (n - 1),
# +         "brains": (matrix.sum(axis=1) - own) / (n - 1) - own,
# +         "bodies": (matrix.sum(axis=0) - own) / (n - 1) - own,


# %% home_against_any loses 5.8
# Counts a brain that beats at least one of its others, but it should beat each of them.
# -     others = np.where(np.eye(n, dtype=bool), -np.inf, matrix)
# +     others = np.where(np.eye(n, dtype=bool), np.inf, matrix)
# -         "at home": int(np.sum(own > others.max(axis=1))),
# +         "at home": int(np.sum(own > others.min(axis=1))),


# %% pairs_counted loses 5.8
# Counts pairs in which a brain does worse than in its own body, but brains should be counted.
# -         "at home": int(np.sum(own > others.max(axis=1))),
# +         "at home": int(np.sum(own[:, None] > matrix)),


# %% average_losses loses 5.8
# Gives the mean of all losses, but one number for each brain and each body is asked for.
# -         "brains": own - (matrix.sum(axis=1) - own) / (n - 1),
# -         "bodies": own - (matrix.sum(axis=0) - own) / (n - 1),
# +         "brains": float(np.mean(own - (matrix.sum(axis=1) - own) / (n - 1))),
# +         "bodies": float(np.mean(own - (matrix.sum(axis=0) - own) / (n - 1))),
