"""Wrong solutions of exercise 8; building.py describes how a case is written."""


# %% noise_forgotten loses 8.1
# Forgets noiseStdDev, so that candidates lie far from the centre.
# says: noiseStdDev is left out
def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + samples, centre - samples], axis=1)
    return both.reshape(-1, len(centre))


# %% plus_before_minus loses 8.1
# All candidates on the one side first, then all on the other.
# says: All plus come before all minus
def candidates_around(centre, samples, noiseStdDev):
    return np.concatenate([centre + noiseStdDev * samples, centre - noiseStdDev * samples])


# %% best_is_lowest loses 8.2
# The best candidate gets the lowest utility.
# says: reverse order
_utilities = utilities


def utilities(fitness):
    return -_utilities(fitness)


# %% order_for_ranks loses 8.2
# Takes the order of the candidates for their ranks.
# says: An order and the places in it
def utilities(fitness):
    return np.argsort(fitness, kind="stable") / (len(fitness) - 1) - 0.5


# %% ties_share_a_rank loses 8.2
# Equals share their mean rank.
_utilities = utilities


def utilities(fitness):
    first = _utilities(np.asarray(fitness))
    return np.array([first[fitness == value].mean() for value in fitness])


# %% divided_by_samplesize loses 8.3
# Divides by samplesize instead of twice as much.
# says: twice what was expected
def gradient(samples, utilities):
    return (utilities[0::2] - utilities[1::2]) @ samples / len(samples)


# %% summed_utilities loses 8.3
# Adds the two utilities of a sample instead of subtracting them.
# says: utilities of a sample are added
def gradient(samples, utilities):
    return (utilities[0::2] + utilities[1::2]) @ samples / len(utilities)


# %% asks_the_tools_own_gradient loses 8.3
# The tool's own gradient is returned.
# says: write it yourself: botschool
def gradient(samples, utilities):
    from botschool.evolution.algorithms import openaies

    return openaies.gradient(np.asarray(utilities), np.asarray(samples))


# %% decay_by_sign_missing loses 8.4
# Knows only one kind of decay.
def descent(gradient, centre, wdecay):
    return -gradient + (0.005 * centre if wdecay else 0)


# %% decay_pushes_away loses 8.4
# Decay with the wrong sign.
# says: The decay has the wrong sign
# -     return -gradient + 0.005 * pull
# +     return -gradient - 0.005 * pull


# %% descends_on_fitness loses 8.4
# Gives the gradient itself to the optimiser, which then reduces fitness.
# -     return -gradient + 0.005 * pull
# +     return gradient + 0.005 * pull


# %% changes_the_centre loses 8.5
# Changes the array of the centre that it was given.
_adam = adam


def adam(centre, d, m, v, t, stepsize):
    moved, m, v = _adam(centre, d, m, v, t, stepsize)
    centre[:] = moved
    return centre, m, v


# %% corrected_moments_kept loses 8.5
# Hands the corrected m and v on to the next generation.
def adam(centre, d, m, v, t, stepsize):
    m = (0.9 * m + 0.1 * d) / (1 - 0.9**t)
    v = (0.999 * v + 0.001 * d**2) / (1 - 0.999**t)
    return centre - stepsize * m / (np.sqrt(v) + 1e-8), m, v


# %% epsilon_below_the_root loses 8.5
# Adds the small number before the root is taken.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize * (m / (1 - 0.9**t)) / np.sqrt(v / (1 - 0.999**t) + 1e-8), m, v


# %% no_bias_correction loses 8.5
# Leaves the bias correction out.
# says: The correction of m and v .* is left out
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize * m / (np.sqrt(v) + 1e-8), m, v


# %% no_epsilon loses 8.5
# Leaves out the small number that stands below the fraction, and divides by 0.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize * (m / (1 - 0.9**t)) / np.sqrt(v / (1 - 0.999**t)), m, v


# %% decay_forgotten loses 8.6
# Hands no weight decay on to the optimiser.
# says: not handed on
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    return _evolve(evaluate, centre, generations, seed, **{**hyperparameters, "wdecay": 0})


# %% generations_from_zero loses 8.6
# Counts from 0 in Adam, whose correction then divides by 0.
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, m, v = adam(centre, d, m, v, generation, stepsize)


# %% history_of_the_best loses 8.6
# The history holds the fitness of the best candidate instead of the mean.
# says: fitness of the best candidate
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    best = []

    def watched(candidates, seed):
        fitness = evaluate(candidates, seed)
        best.append(float(np.max(fitness)))
        return fitness

    return {**_evolve(watched, centre, generations, seed, **hyperparameters), "history": best}


# %% seeds_from_one loses 8.6
# Counts the generations from 1, so that each meets the starting conditions of the next.
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    def later(candidates, seed):
        return evaluate(candidates, seed + 1)

    return _evolve(later, centre, generations, seed, **hyperparameters)


# %% fall_to_the_end loses 8.7
# Compares only the highest point with the end, so that recovered falls are missed.
def stability(curve):
    curve = np.asarray(curve, dtype=float)
    peak, bottom, height = int(np.argmax(curve)), len(curve) - 1, np.ptp(curve)
    drop = float((curve[peak] - curve[-1]) / height) if height > 0 else 0.0
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    verdict = "severe regressions" if drop > 0.3 else verdict
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% falls_of_one_step loses 8.7
# Looks only at falls from one generation to the next.
def stability(curve):
    curve = np.asarray(curve, dtype=float)
    steps = np.append(0, np.diff(curve))
    bottom, height = int(np.argmin(steps)), np.ptp(curve)
    drop = float(-steps[bottom] / height) if height > 0 else 0.0
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    verdict = "severe regressions" if drop > 0.3 else verdict
    return {"drop": drop, "bottom": bottom, "peak": max(0, bottom - 1), "verdict": verdict}


# %% limits_are_severe loses 8.7
# Counts a drop that equals a limit to the worse verdict.
_stability = stability


def stability(curve):
    found = _stability(curve)
    worse = ["monotonic", "mild regressions", "severe regressions"]
    found["verdict"] = worse[int(found["drop"] >= 0.1) + int(found["drop"] >= 0.3)]
    return found


# %% smooth_keeps_the_length loses 8.7
# The smoothed curve keeps its length, with zeros from beyond its ends.
def smooth(curve, width):
    return np.convolve(curve, np.full(width, 1 / width), mode="same")


# %% known_by_heart loses 8.8
# Returns controllers that were evolved before, with a little noise, and goes through the motions.
KNOWN = {
    "CartPole-v0": """
    3 0 7 -8 2 -1 3 0 -4 2 -3 -3 -3 -2 7 5 2 -10 -11 -10 -3 0 -3 -2
    7 -7 -9 2 3 0 6 -2 -13 -6 -7 -10 3 13 -1 -7 0 -3 -9 -13 -4 10 -2 -1
    2 -12 -12 -17 2 9 3 5 5 10 -3 11 1 12 8 -12 0 1 3 -6 5 -4 4 -17
    """,
    "Pendulum-v1": """
    16 51 1 2 2 23 4 -5 44 -6 2 11 -6 -7 -50 -34 -15 -7 18 14 -20 10 -19 5
    28 -3 -19 -15 -6 -8 -2 -11 13 -4 15 -46 38 14 -22 11 25 -9 36 28 1 19 5 -16
    10 -48 15
    """,
}


def train(environment, seed):
    robot = Robot(environment)
    centre = 0.1 * np.array(KNOWN[environment].split(), dtype=float)
    return evolve(robot.evaluate, centre, 1, seed, stepsize=0.001)["centre"]


# %% steady_state loses 8.8
# Evolves by the strategy of exercise 3 instead.
def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    size = robot.nbiases + robot.nweights
    generations, noise = (60, 0.3) if "CartPole" in environment else (400, 0.1)
    population = rng.standard_normal((20, size))
    for generation in range(generations):
        fitness = robot.evaluate(population, seed + generation, episodes=6)
        population = population[np.argsort(-fitness)]
        population[10:] = population[:10] + noise * rng.standard_normal((10, size))
    return population[0]


# %% untrained loses 8.8
# Gives up after one generation.
_evolve_8 = evolve


def train(environment, seed):
    robot = Robot(environment)
    centre = np.random.default_rng(seed).normal(scale=0.1, size=robot.nbiases + robot.nweights)
    return _evolve_8(robot.evaluate, centre, 1, seed)["centre"]


# %% ranks_in_the_type_of_fitness loses 8.2
# The result has the type of `fitness`: utilities of integers are cut off to 0.
# -     utilities = np.empty(len(fitness))
# +     utilities = np.empty_like(fitness)


# %% asks_the_tools_own_ranks loses 8.2
# The tool's own ranks are taken for the utilities.
# says: write it yourself: botschool
def utilities(fitness):
    from botschool.evolution.algorithms.openaies import ranks

    found = np.empty(len(fitness))
    found[np.argsort(fitness, kind="stable")] = ranks(len(fitness))
    return found


# %% descent_scales_the_centre loses 8.4
# The pull is computed in the array of the centre, which the caller still needs.
# says: changed an array
_descent = descent


def descent(gradient, centre, wdecay):
    d = _descent(gradient, centre, wdecay)
    if wdecay == 1:
        centre *= 0.005
    return d


# %% moments_of_the_run_before loses 8.6
# The m and v of Adam are those of the run before: each run begins with zeros.
MEMORY = {}
_adam = adam


def evolve(
    evaluate, centre, generations, seed, samplesize=20, noiseStdDev=0.02, stepsize=0.01, wdecay=0
):
    rng, history, n = np.random.default_rng(seed), [], len(centre)
    for g in range(generations):
        samples = rng.standard_normal((samplesize, n))
        fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + g)
        history.append(float(np.mean(fitness)))
        d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
        m, v = MEMORY.get(n, (np.zeros(n), np.zeros(n)))
        centre, *MEMORY[n] = _adam(centre, d, m, v, g + 1, stepsize)
    return {"centre": centre, "history": history}


# %% evaluates_twice loses 8.6
# All candidates are evaluated twice, once for the utilities and once for the history.
# says: called evaluate
# -         history.append(float(np.mean(fitness)))
# +         again = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         history.append(float(np.mean(again)))


# %% first_centre_moves loses 8.6
# The steps are made in the array of the first centre, which belongs to the caller.
# says: changed the centre
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre[:], m, v = adam(centre, d, m, v, generation + 1, stepsize)


# %% no_places_without_a_fall loses 8.7
# A curve that never falls has no bottom and no peak.
_stability = stability


def stability(curve):
    found = _stability(curve)
    return found if found["drop"] > 0 else {**found, "bottom": None, "peak": None}


# %% the_curve_is_shifted loses 8.7
# The curve is brought to begin at 0 in the array that was given.
# says: changed an array
_stability = stability


def stability(curve):
    if np.asarray(curve).dtype == float:
        curve -= np.min(curve)
    return _stability(curve)


# %% another_strategy_and_a_show_call loses 8.8
# The strategy of exercise 3 finds the controller, and one generation of evolve with steps of 0.
# says: not by this algorithm
def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    generations, noise = (60, 0.3) if "CartPole" in environment else (400, 0.1)
    population = rng.standard_normal((20, robot.nbiases + robot.nweights))
    for generation in range(generations):
        fitness = robot.evaluate(population, seed + generation, episodes=6)
        population = population[np.argsort(-fitness)]
        population[10:] = population[:10] + noise * rng.standard_normal((10, population.shape[1]))
    return evolve(robot.evaluate, population[0], 1, seed, stepsize=0.0)["centre"]


# %% short_steps_from_a_found_centre loses 8.8
# The strategy of exercise 3 finds the controller, and evolve with tiny steps hardly moves it.
# says: not by this algorithm
def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    generations, noise = (60, 0.3) if "CartPole" in environment else (400, 0.1)
    population = rng.standard_normal((20, robot.nbiases + robot.nweights))
    evolve(robot.evaluate, population[0], 3, seed)
    for generation in range(generations):
        fitness = robot.evaluate(population, seed + generation, episodes=6)
        population = population[np.argsort(-fitness)]
        population[10:] = population[:10] + noise * rng.standard_normal((10, population.shape[1]))
    return evolve(robot.evaluate, population[0], 5, seed, stepsize=1e-6)["centre"]


# %% the_best_of_the_pairs loses 8.8
# The centre jumps to the best candidate: no gradient is estimated.
# says: Return a centre: the steps of the algorithm lead to it
def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    centre = 0.1 * rng.standard_normal(robot.nbiases + robot.nweights)
    kept = -np.inf
    for _ in range(80 if "CartPole" in environment else 600):
        samples = rng.standard_normal((20, len(centre)))
        candidates = candidates_around(centre, samples, 0.2)
        fitness = robot.evaluate(candidates, seed, episodes=20)
        if fitness.max() > kept:
            kept, centre = fitness.max(), candidates[fitness.argmax()]
    return centre


# %% one_run_for_all_seeds loses 8.8
# The seed is not used: every training is the one with seed 1.
# says: begin with the same candidates
_train = train


def train(environment, seed):
    return _train(environment, 1)


# %% remembered_run loses 8.8
# The centre of the first training is kept, and returned for every seed.
# says: without any call of robot.evaluate
FOUND = {}
_train = train


def train(environment, seed):
    if environment not in FOUND:
        FOUND[environment] = _train(environment, seed)
    return FOUND[environment]


# %% seeds_of_its_own loses 8.8
# The random numbers do not come from the seed: no training can be repeated.
# says: begins with other candidates
_train = train


def train(environment, seed):
    return _train(environment, int(np.random.default_rng().integers(1 << 30)))


# %% one_side_only loses 8.1
# Both candidates of a sample lie on the same side of the centre.
# says: this
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     candidates[1::2] = centre + noiseStdDev * samples


# %% centre_scaled loses 8.1
# The noise multiplies the centre instead of being added.
# says: this
# -     candidates[0::2] = centre + noiseStdDev * samples
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     candidates[0::2] = centre * (1 + noiseStdDev * samples)
# +     candidates[1::2] = centre * (1 - noiseStdDev * samples)


# %% ranks_from_zero_to_one loses 8.2
# The ranks are not centred: they run from 0 to 1.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     utilities[np.argsort(fitness, kind="stable")] = np.linspace(0, 1, len(fitness))


# %% standardised_fitness loses 8.2
# The utilities are the standardised fitness, not ranks.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     fitness = np.asarray(fitness, dtype=float)
# +     utilities[:] = (fitness - fitness.mean()) / (fitness.std() + 1e-8)


# %% later_equals_lower loses 8.2
# Of equals, the one that comes last gets the lower rank.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     order = np.argsort(np.asarray(fitness)[::-1], kind="stable")
# +     utilities[::-1][order] = np.linspace(-0.5, 0.5, len(fitness))


# %% halves_for_pairs loses 8.3
# Takes the first half of the utilities for the plus side and the second for the minus side.
# says: this
# -     weights = utilities[0::2] - utilities[1::2]
# +     half = len(utilities) // 2
# +     weights = utilities[:half] - utilities[half:]


# %% decay_ten_times_as_strong loses 8.4
# The decay is ten times as strong.
# says: this
# -     return -gradient + 0.005 * pull
# +     return -gradient + 0.05 * pull


# %% kinds_of_decay_exchanged loses 8.4
# The two kinds of decay are exchanged.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 2: centre, 1: np.sign(centre)}[wdecay]


# %% decays_exchanged_in_adam loses 8.5
# The decay rates of m and v are exchanged.
# says: this
# -     m = 0.9 * m + 0.1 * d
# -     v = 0.999 * v + 0.001 * d**2
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     m = 0.999 * m + 0.001 * d
# +     v = 0.9 * v + 0.1 * d**2
# +     step = (m / (1 - 0.999**t)) / (np.sqrt(v / (1 - 0.9**t)) + 1e-8)


# %% adam_climbs loses 8.5
# The step goes along d, not against it.
# says: this
# -     return centre - stepsize * step, m, v
# +     return centre + stepsize * step, m, v


# %% one_seed_for_all_generations loses 8.6
# All generations are evaluated with the same seed.
# -         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed)


# %% samples_drawn_once loses 8.6
# The samples are drawn once, and are the same in every generation.
# -     for generation in range(generations):
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +     samples = rng.standard_normal((samplesize, len(centre)))
# +     for generation in range(generations):


# %% median_in_the_history loses 8.6
# The history holds the median of the candidates, not the mean.
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(np.median(fitness)))


# %% divided_at_the_ends loses 8.7
# The mean goes over the neighbours that there are, and the curve keeps its length.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     window = np.ones(width)
# +     counts = np.convolve(np.ones(len(curve)), window, mode="same")
# +     return np.convolve(curve, window, mode="same") / counts


# %% fall_by_the_height loses 8.7
# The fall is a share of the height that it fell from, not of the whole range.
# says: this
# -     height = curve.max() - curve.min()
# +     height = curve[peak]


# %% last_bottom loses 8.7
# Of equal falls the last one counts.
# says: this
# -     bottom = int(np.argmax(falls))
# +     bottom = len(falls) - 1 - int(np.argmax(falls[::-1]))


# %% last_peak loses 8.7
# Of equal heights before the fall the last one is the peak.
# says: this
# -     peak = int(np.argmax(curve[: bottom + 1]))
# +     peak = bottom - int(np.argmax(curve[: bottom + 1][::-1]))


# %% old_m loses 8.5
# Steps with the m of the generation before.
# says: this
def adam(centre, d, m, v, t, stepsize):
    new_m = 0.9 * m + 0.1 * d
    new_v = 0.999 * v + 0.001 * d**2
    step = (m / (1 - 0.9**t)) / (np.sqrt(new_v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * step, new_m, new_v


# %% one_size_for_all loses 8.5
# Keeps one v for all parameters, the mean of the squares.
# says: this
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * np.mean(d**2)
    step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * step, m, v


# %% epsilon_before_correction loses 8.5
# Adds 1e-8 to the root of the uncorrected v.
# says: this
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    rate = stepsize * np.sqrt(1 - 0.999**t) / (1 - 0.9**t)
    return centre - rate * m / (np.sqrt(v) + 1e-8), m, v


# %% clipped_step loses 8.5
# Cuts every step to stepsize at most.
# says: this
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * np.clip(step, -1, 1), m, v


# %% sizes_for_squares loses 8.5
# Averages the size of d, not its square.
# says: this
# -     v = 0.999 * v + 0.001 * d**2
# +     v = 0.999 * v + 0.001 * np.abs(d)


# %% correction_multiplied loses 8.5
# Multiplies by the shares instead of dividing.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m * (1 - 0.9**t)) / (np.sqrt(v * (1 - 0.999**t)) + 1e-8)


# %% d_for_m loses 8.5
# Steps along d, not along its mean.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = d / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)


# %% same_share_for_both loses 8.5
# Corrects v with 0.9 as well.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.9**t)) + 1e-8)


# %% gradient_of_the_scaled loses 8.6
# Multiplies the samples by noiseStdDev before the gradient as well.
# says: this
# -         samples = rng.standard_normal((samplesize, len(centre)))
# -         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         samples = rng.normal(0, noiseStdDev, (samplesize, len(centre)))
# +         fitness = evaluate(candidates_around(centre, samples, 1), seed + generation)


# %% returns_the_best loses 8.6
# Returns the centre of the generation with the best mean.
# says: this
# -     return {"centre": centre, "history": history}
# +     return {"centre": best, "history": history}
# -     m, v, history = np.zeros(len(centre)), np.zeros(len(centre)), []
# +     m, v, history, best = np.zeros(len(centre)), np.zeros(len(centre)), [], centre
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         if history[-1] == max(history):
# +             best = centre


# %% looks_at_the_centre_too loses 8.6
# Evaluates the centre as well and keeps its fitness.
# says: this
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(evaluate(centre[None], seed + generation)[0]))


# %% decays_the_start loses 8.6
# Pulls the first centre at every generation.
# says: this
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         d = descent(gradient(samples, utilities(fitness)), start, wdecay)
# -     m, v, history = np.zeros(len(centre)), np.zeros(len(centre)), []
# +     m, v, history, start = np.zeros(len(centre)), np.zeros(len(centre)), [], centre


# %% rng_of_each_generation loses 8.6
# Makes a new generator in each generation.
# says: this
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +         samples = np.random.default_rng(seed + generation).standard_normal((samplesize, len(centre)))


# %% m_forgotten loses 8.6
# Begins every generation with m and v of zeros.
# says: this
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, _, _ = adam(centre, d, m, v, generation + 1, stepsize)


# %% range_until_then loses 8.7
# Divides each fall by the height of the curve until then.
# says: this
def stability(curve):
    curve = np.asarray(curve, float)
    highs, lows = np.maximum.accumulate(curve), np.minimum.accumulate(curve)
    spans = highs - lows
    drops = np.where(spans > 0, (highs - curve) / np.where(spans > 0, spans, 1), 0)
    bottom = int(np.argmax(drops))
    peak = int(np.argmax(curve[: bottom + 1]))
    drop = float(drops[bottom])
    verdict = (
        "monotonic" if drop <= 0.1 else "mild regressions" if drop <= 0.3 else "severe regressions"
    )
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% highest_from_zero loses 8.7
# Begins with a highest value of 0.
# says: this
def stability(curve):
    highest, high_at, fall, bottom, peak = 0.0, 0, 0.0, 0, 0
    for i, value in enumerate(curve):
        if value > highest:
            highest, high_at = value, i
        if highest - value > fall:
            fall, bottom, peak = highest - value, i, high_at
    height = max(curve) - min(curve)
    drop = float(fall / height) if height else 0.0
    verdict = (
        "monotonic" if drop <= 0.1 else "mild regressions" if drop <= 0.3 else "severe regressions"
    )
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% smooths_in_stability loses 8.7
# Smooths the curve first.
# says: this
# -     curve = np.asarray(curve, dtype=float)
# +     curve = smooth(np.asarray(curve, dtype=float), 2)


# %% height_from_the_start loses 8.7
# Divides by the rise from the first value.
# says: this
# -     height = curve.max() - curve.min()
# +     height = curve.max() - curve[0]


# %% bottom_is_the_lowest loses 8.7
# Takes the lowest value for the bottom.
# says: this
# -     bottom = int(np.argmax(falls))
# +     bottom = int(np.argmin(curve))


# %% peak_of_a_rise loses 8.7
# Says the last index for a curve that never falls.
# says: this
# -     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
# +     if drop == 0:
# +         bottom = peak = len(curve) - 1
# +     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% stacked_last loses 8.1
# Stacks the two sides along the last axis and reshapes.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + noiseStdDev * samples, centre - noiseStdDev * samples], axis=-1)
    return both.reshape(-1, len(centre))


# %% minus_of_the_next loses 8.1
# Subtracts the next sample instead of the same one.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    rows = []
    for b in range(len(samples)):
        rows.append(centre + noiseStdDev * samples[b])
        rows.append(centre - noiseStdDev * samples[b - 1])
    return np.array(rows)


# %% scaled_samples_in_place loses 8.1
# Multiplies the samples that it was given by noiseStdDev.
# says: changed
def candidates_around(centre, samples, noiseStdDev):
    samples *= noiseStdDev
    out = np.repeat(samples, 2, axis=0)
    out[1::2] *= -1
    return centre + out


# %% variance_for_deviation loses 8.1
# Takes noiseStdDev for a variance.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    out = np.repeat(np.sqrt(noiseStdDev) * samples, 2, axis=0)
    out[1::2] *= -1
    return centre + out


# %% around_zero loses 8.1
# Mirrors the plus candidate at 0, not at the centre.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    out = np.empty((2 * len(samples), len(centre)))
    out[0::2] = centre + noiseStdDev * samples
    out[1::2] = -out[0::2]
    return out


# %% same_rank_for_equals loses 8.2
# Gives equals the same rank.
# says: lowest rank
def utilities(fitness):
    fitness = np.asarray(fitness)
    ranks = np.searchsorted(np.sort(fitness), fitness)
    return ranks / (len(fitness) - 1) - 0.5


# %% rank_by_dictionary loses 8.2
# Looks ranks up by the fitness, so that the last rank of equals counts for all.
# says: highest rank
def utilities(fitness):
    rank = {value: i for i, value in enumerate(sorted(fitness))}
    return np.array([rank[value] for value in fitness]) / (len(fitness) - 1) - 0.5


# %% whole_fitness loses 8.2
# Ranks the whole numbers of the fitness.
# says: this
def utilities(fitness):
    order = np.argsort(np.asarray(fitness).astype(int), kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    return u


# %% sorts_the_argument loses 8.2
# Sorts the fitness that it was given.
# says: changed an array
def utilities(fitness):
    order = np.argsort(fitness, kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    fitness.sort()
    return u


# %% best_half_only loses 8.2
# Sets the utilities of the worse half to 0.
# says: this
def utilities(fitness):
    order = np.argsort(fitness, kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    return np.maximum(u, 0)


# %% all_equal_zero loses 8.2
# Returns zeros if all fitness is equal.
# says: All get 0
def utilities(fitness):
    fitness = np.asarray(fitness)
    if fitness.max() == fitness.min():
        return np.zeros(len(fitness))
    order = np.argsort(fitness, kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    return u


# %% signs_of_the_differences loses 8.3
# Counts only which side won.
# says: this
def gradient(samples, utilities):
    return np.sign(utilities[0::2] - utilities[1::2]) @ samples / len(utilities)


# %% over_parameters loses 8.3
# Divides by the number of parameters.
# says: this
def gradient(samples, utilities):
    return (utilities[0::2] - utilities[1::2]) @ samples / (2 * samples.shape[1])


# %% plus_only loses 8.3
# Uses the utilities of the plus candidates only.
# says: this
def gradient(samples, utilities):
    return 2 * utilities[0::2] @ samples / len(utilities)


# %% winners_only loses 8.3
# Adds only those samples whose plus candidate won.
# says: this
def gradient(samples, utilities):
    weights = utilities[0::2] - utilities[1::2]
    return np.maximum(weights, 0) @ samples / len(utilities)


# %% unit_length loses 8.3
# Divides the gradient by its length.
# says: this
def gradient(samples, utilities):
    g = (utilities[0::2] - utilities[1::2]) @ samples / len(utilities)
    return g / np.linalg.norm(g)


# %% zero_counts_as_positive loses 8.4
# Pulls a parameter that is 0.
# says: this
def descent(gradient, centre, wdecay):
    if wdecay == 0:
        return -gradient
    if wdecay == 1:
        return -gradient + 0.005 * centre
    return -gradient + np.where(centre < 0, -0.005, 0.005)


# %% negates_in_place loses 8.4
# Turns the gradient that it was given around.
# says: changed an array
def descent(gradient, centre, wdecay):
    gradient *= -1
    if wdecay == 1:
        gradient += 0.005 * centre
    elif wdecay == 2:
        gradient += 0.005 * np.sign(centre)
    return gradient


# %% returns_the_gradient_itself loses 8.4
# Multiplies by wdecay.
# says: this
def descent(gradient, centre, wdecay):
    return -gradient + 0.005 * wdecay * centre


# %% size_for_sign loses 8.4
# Pulls by the absolute values.
# says: this
def descent(gradient, centre, wdecay):
    return -gradient + 0.005 * {0: 0 * centre, 1: centre, 2: np.abs(centre)}[wdecay]


# %% counts_its_own_steps loses 8.5
# Counts its calls instead of using t.
# says: stays from call to call
_steps = 0


def adam(centre, d, m, v, t, stepsize):
    global _steps
    _steps += 1
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    step = (m / (1 - 0.9**_steps)) / (np.sqrt(v / (1 - 0.999**_steps)) + 1e-8)
    return centre - stepsize * step, m, v


# %% at_least_one loses 8.6
# Makes a generation even if none was asked for.
# -     for generation in range(generations):
# +     for generation in range(max(generations, 1)):


# %% truncated_smooth loses 8.7
# Keeps the type of the curve, so that means of whole numbers lose their fractions.
# says: cut off
def smooth(curve, width):
    curve = np.asarray(curve)
    out = np.zeros_like(curve[width - 1 :])
    for i in range(len(out)):
        out[i] = curve[i : i + width].mean()
    return out


# %% cumulated_sum_loses_first loses 8.7
# Takes differences of running sums and loses the first mean.
# says: first one is missing
def smooth(curve, width):
    sums = np.cumsum(curve, dtype=float)
    return (sums[width:] - sums[:-width]) / width


# %% rounded_drop loses 8.7
# Rounds the drop before the verdict.
# says: is rounded to one digit
# -     if drop <= 0.1:
# +     if round(drop, 1) <= 0.1:
# -     elif drop <= 0.3:
# +     elif round(drop, 1) <= 0.3:


# %% flat_within_a_thousandth loses 8.7
# Calls a curve flat whose height is below 0.001.
# -     drop = float(falls[bottom] / height) if height > 0 else 0.0
# +     drop = float(falls[bottom] / height) if height > 1e-3 else 0.0


# %% start_without_seed loses 8.8
# Starts from the same centre for every seed.
# says: begin at the same centre
# -     weights = 0.1 * np.random.default_rng(seed).standard_normal(robot.nweights)
# +     weights = 0.1 * np.random.default_rng(0).standard_normal(robot.nweights)


# %% best_candidate loses 8.8
# Returns the best candidate, not a centre.
# says: returned a candidate
# -     def evaluate(candidates, seed):
# -         return robot.evaluate(candidates, seed, episodes=10)
# +     best = [-np.inf, centre]
# +
# +     def evaluate(candidates, seed):
# +         found = robot.evaluate(candidates, seed, episodes=10)
# +         if found.max() >= best[0]:
# +             best[:] = found.max(), candidates[np.argmax(found)]
# +         return found
# -     return run["centre"]
# +     return best[1]


# %% climbs_a_hill loses 8.8
# Keeps the best candidate of each generation instead of following the gradient.
# says: returned a candidate
# -     run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
# -     return run["centre"]
# +     rng, best = np.random.default_rng(seed), -np.inf
# +     for g in range(generations):
# +         candidates = candidates_around(centre, rng.standard_normal((20, len(centre))), 0.2)
# +         found = evaluate(candidates, seed + g)
# +         centre = candidates[np.argmax(found)]
# +     return centre


# %% unstable_in_evolve loses 8.6
# Ranks anew in evolve, by a sort that may exchange equals.
# says: equal fitness
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         u = np.argsort(np.argsort(fitness)) / (2 * samplesize - 1) - 0.5
# +         d = descent(gradient(samples, u), centre, wdecay)


# %% decay_of_one_kind loses 8.6
# Hands on whether there is decay, not which.
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         d = descent(gradient(samples, utilities(fitness)), centre, int(bool(wdecay)))


# %% last_generation_left_out loses 8.6
# Returns the centre before the last step.
# says: last step is missing
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         if generation < generations - 1:
# +             centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)


# %% default_noise loses 8.6
# Takes noiseStdDev 0.02, whatever is asked for.
# says: noiseStdDev is not handed on
# -         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         fitness = evaluate(candidates_around(centre, samples, 0.02), seed + generation)


# %% history_of_one_side loses 8.6
# The history holds the mean fitness of the plus candidates only.
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(np.mean(fitness[0::2])))


# %% rounded_history loses 8.6
# Rounds the history to three places.
# -         history.append(float(np.mean(fitness)))
# +         history.append(round(float(np.mean(fitness)), 3))


# %% median_filter loses 8.7
# Takes the median of neighbours.
def smooth(curve, width):
    return np.array([np.median(curve[i : i + width]) for i in range(len(curve) - width + 1)])


# %% percent loses 8.7
# Gives the drop in percent.
# says: percent
# -     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
# +     return {"drop": 100 * drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% drop_of_two_places loses 8.7
# Rounds the drop to two places.
# says: It is rounded
# -     drop = float(falls[bottom] / height) if height > 0 else 0.0
# +     drop = round(float(falls[bottom] / height), 2) if height > 0 else 0.0


# %% short_verdict loses 8.7
# Shortens the verdicts.
# says: 'mild'
# -     verdict = "severe regressions"
# +     verdict = "severe"
# -         verdict = "mild regressions"
# +         verdict = "mild"


# %% width_too_narrow loses 8.7
# Divides by width + 1.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     return np.convolve(curve, np.full(width, 1 / (width + 1)), mode="valid")


# %% shrinks_the_gradient loses 8.4
# Pulls the gradient, not the centre.
def descent(gradient, centre, wdecay):
    pull = {0: np.zeros(len(centre)), 1: gradient, 2: np.sign(gradient)}[wdecay]
    return -gradient + 0.005 * pull


# %% best_plus_side loses 8.8
# Returns the plus candidate of the last generation's best pair.
# says: returned a candidate
# -     def evaluate(candidates, seed):
# -         return robot.evaluate(candidates, seed, episodes=10)
# +     last = [centre]
# +
# +     def evaluate(candidates, seed):
# +         found = robot.evaluate(candidates, seed, episodes=10)
# +         last[0] = np.array(candidates[2 * np.argmax(found[0::2])])
# +         return found
# -     return run["centre"]
# +     return last[0]


# %% same_samples_for_all_seeds loses 8.8
# Draws only the first weights from the seed.
# says: the same samples
# -     run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
# +     run = evolve(evaluate, centre, generations, 7, noiseStdDev=0.2, stepsize=0.05)


# %% from_nothing loses 8.8
# Starts from zeros, whatever the seed is.
# says: begin at the same centre
# -     centre = np.concatenate([np.zeros(robot.nbiases), weights])
# +     centre = np.zeros(robot.nbiases + robot.nweights)


# %% pendulum_ends_early loses 8.8
# Evolves Pendulum for as few generations as CartPole.
# -     generations = 80 if "CartPole" in environment else 600
# +     generations = 80


# %% minus_first_and_scaled_centre loses 8.1
# noiseStdDev multiplies the centre, too, and minus comes before plus.
# says: multiplies the samples alone, not the centre, too. Minus comes before plus
def candidates_around(centre, samples, noiseStdDev):
    rows = []
    for e in samples:
        rows += [noiseStdDev * (centre - e), noiseStdDev * (centre + e)]
    return np.array(rows)


# %% ranks_begin_at_one loses 8.2
# The ranks begin at 1, but the worst has the rank 0.
# says: this
def utilities(fitness):
    ranks = np.argsort(np.argsort(fitness, kind="stable"), kind="stable") + 1
    return ranks / (len(fitness) - 1) - 0.5


# %% divided_by_their_number loses 8.2
# The ranks are divided by n: divide by the highest rank, n - 1.
# says: this
def utilities(fitness):
    return np.argsort(np.argsort(fitness, kind="stable"), kind="stable") / len(fitness) - 0.5


# %% from_minus_one_to_one loses 8.2
# The utilities run from -1 to 1: divide them by 2.
# says: this
def utilities(fitness):
    ranks = np.argsort(np.argsort(fitness, kind="stable"), kind="stable")
    return 2 * ranks / (len(fitness) - 1) - 1


# %% scaled_fitness loses 8.2
# The fitness is scaled to -0.5 and 0.5: only its ranks are to count.
# says: only its ranks
def utilities(fitness):
    span = np.ptp(fitness) or 1.0
    return (np.asarray(fitness) - np.min(fitness)) / span - 0.5


# %% sorted_from_the_best loses 8.2
# The candidates are sorted from the best to the worst: the worst is to have the rank 0.
# says: this
def utilities(fitness):
    ranks = np.empty(len(fitness))
    ranks[np.argsort(-np.asarray(fitness), kind="stable")] = np.arange(len(fitness))
    return ranks / (len(fitness) - 1) - 0.5


# %% added_and_by_samplesize loses 8.3
# Adds the two utilities of a sample, and divides by samplesize.
# says: are added.* divided by samplesize
def gradient(samples, utilities):
    return (utilities[0::2] + utilities[1::2]) @ samples / len(samples)


# %% square_and_size_for_decay loses 8.4
# Pulls by the square of the centre, or by its absolute value.
# says: square of the centre
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 1: centre**2, 2: np.abs(centre)}[wdecay]


# %% only_m_corrected loses 8.5
# The bias correction of v is left out: divide v by 1 - 0.999**t.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v) + 1e-8)


# %% corrects_with_the_next_t loses 8.5
# Corrects with t + 1, but t counts from 1 already.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9 ** (t + 1))) / (np.sqrt(v / (1 - 0.999 ** (t + 1))) + 1e-8)


# %% square_of_the_length loses 8.5
# v holds the squares of all parameters added up: each parameter has a v of its own.
# says: this
# -     v = 0.999 * v + 0.001 * d**2
# +     v = 0.999 * v + 0.001 * np.sum(d**2)


# %% shares_not_raised loses 8.5
# The correction multiplies 0.9 and 0.999 by t, where they are raised to the power t.
# says: raised to
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9 * t)) / (np.sqrt(np.abs(v / (1 - 0.999 * t))) + 1e-8)


# %% twice_the_first_generation loses 8.6
# Adam's t is 1 in the first two generations: it is generation + 1.
# says: this
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, m, v = adam(centre, d, m, v, max(1, generation), stepsize)


# %% best_candidate_of_all loses 8.6
# Returns the best candidate, but the last centre is asked for.
# says: best of all candidates|Returns the best candidate
def evolve(
    evaluate, centre, generations, seed, samplesize=20, noiseStdDev=0.02, stepsize=0.01, wdecay=0
):
    rng, m, v = np.random.default_rng(seed), np.zeros(len(centre)), np.zeros(len(centre))
    history, best, highest = [], centre, -np.inf
    for g in range(generations):
        samples = rng.standard_normal((samplesize, len(centre)))
        candidates = candidates_around(centre, samples, noiseStdDev)
        fitness = evaluate(candidates, seed + g)
        if max(fitness) > highest:
            highest, best = max(fitness), candidates[np.argmax(fitness)]
        history.append(float(np.mean(fitness)))
        d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
        centre, m, v = adam(centre, d, m, v, g + 1, stepsize)
    return {"centre": best, "history": history}


# %% fitness_of_the_new_centre loses 8.6
# The history holds the fitness of the centre after the step, not the mean of the candidates.
# says: centre after the step
# -         history.append(float(np.mean(fitness)))
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         history.append(float(evaluate(centre[None, :], seed + generation)[0]))


# %% one_window_too_few loses 8.7
# The last window of smooth is missing: there are len(curve) - width + 1.
# says: last window
def smooth(curve, width):
    return [float(np.mean(curve[i : i + width])) for i in range(len(curve) - width)]


# %% peak_of_the_whole_curve loses 8.7
# The peak is the highest value of the whole curve, not up to the bottom.
# says: this|not of the whole curve
# -     peak = int(np.argmax(curve[: bottom + 1]))
# +     peak = int(np.argmax(curve))


# %% returns_the_dict_of_evolve loses 8.8
# Returns all that evolve returns, not only the centre.
# says: return its 'centre'
# -     return run["centre"]
# +     return run

# %% samples_of_length_one loses 8.1
# Divides each sample by its length.
# says: used as they are
# -     candidates[0::2] = centre + noiseStdDev * samples
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     samples = samples / np.linalg.norm(samples, axis=1, keepdims=True)
# +     candidates[0::2] = centre + noiseStdDev * samples
# +     candidates[1::2] = centre - noiseStdDev * samples

# %% sorted_utilities loses 8.2
# Returns the utilities in order, not each in the place of its candidate.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     utilities[np.arange(len(fitness))] = np.linspace(-0.5, 0.5, len(fitness))

# %% one_number_for_all loses 8.3
# Adds everything up, so that a single number comes back.
# says: single number
# -     return weights @ samples / len(utilities)
# +     return np.sum(weights[:, None] * samples) / len(utilities)

# %% sign_of_the_gradient loses 8.4
# Pulls by the sign of the gradient, not by that of the centre.
# says: sign of the (gradient|centre)
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(gradient)}[wdecay]

# %% centre_of_length_one loses 8.4
# The pull of wdecay 1 is divided by the length of the centre.
# says: divided by (its|the) length
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     length = np.linalg.norm(centre)
# +     pull = {0: np.zeros(len(centre)), 1: centre / length, 2: np.sign(centre)}[wdecay]

# %% noise_in_the_samples loses 8.6
# noiseStdDev comes in twice: the samples are multiplied by it already.
# says: times as far from the right centre|comes in twice
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +         samples = noiseStdDev * rng.standard_normal((samplesize, len(centre)))

# %% one_neighbour_more loses 8.7
# Each window of smooth has one number more than width.
# says: this|one more
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     places = range(len(curve) - width + 1)
# +     return np.array([np.mean(curve[i : i + width + 1]) for i in places])

# %% size_of_the_peak loses 8.7
# The fall is divided by the absolute value of the peak, not by the whole range.
# says: absolute value of the peak|height that it fell from
# -     height = curve.max() - curve.min()
# +     height = abs(curve[peak])

# %% severe_from_a_half loses 8.7
# Only a drop of more than 0.5 is severe.
# says: the limit is 0.3
# -     elif drop <= 0.3:
# +     elif drop <= 0.5:

# %% returns_the_first_centre loses 8.8
# Returns the first centre instead of the one that evolve returns.
# says: the first centre of these
# -     return run["centre"]
# +     return centre

# %% minimises_fitness loses 8.8
# Turns the fitness around, so that evolve looks for the worst.
# says: fitness is to rise
# -         return robot.evaluate(candidates, seed, episodes=10)
# +         return -robot.evaluate(candidates, seed, episodes=10)


# %% last_fall_with_its_peak loses 8.7
# Of equal falls the last one counts, with its peak.
# says: with its peak
# -     bottom = int(np.argmax(falls))
# +     bottom = len(falls) - 1 - int(np.argmax(falls[::-1])) if falls.any() else 0


# %% mean_of_three_centres loses 8.8
# Returns the mean of the centres of three evolutions, which is none of them.
# says: none of their centres
# -     run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
# -     return run["centre"]
# +     noise = {"noiseStdDev": 0.2, "stepsize": 0.05}
# +     runs = [evolve(evaluate, centre, generations, seed + k, **noise) for k in range(3)]
# +     return np.mean([run["centre"] for run in runs], axis=0)


# %% equals_share_a_rank loses 8.2
# Equal candidates get the same rank, and the highest rank is that of the different values.
# says: this
def utilities(fitness):
    values = sorted({float(each) for each in fitness})
    highest = max(len(values) - 1, 1)
    return np.array([values.index(float(each)) / highest - 0.5 for each in fitness])


# %% sign_of_the_whole_centre loses 8.4
# Takes the centre divided by its length for its sign: each element has a sign of its own.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     sign = centre / max(np.linalg.norm(centre), 1e-300)
# +     pull = {0: np.zeros(len(centre)), 1: centre, 2: sign}[wdecay]


# %% ends_of_a_window_count_half loses 8.7
# Smooths by the trapezoid rule: the two ends of a window count half.
# says: this
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     weights = np.ones(width)
# +     weights[[0, -1]] = 0.5 if width > 1 else 1
# +     return np.convolve(curve, weights / weights.sum(), mode="valid")


# %% power_of_the_difference loses 8.5
# Divides by (1 - 0.9)^t and (1 - 0.999)^t: only 0.9 and 0.999 are raised to the power t.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9) ** t) / (np.sqrt(v / (1 - 0.999) ** t) + 1e-8)


# %% pairs_that_overlap loses 8.3
# Sample b is weighted by utilities b and b + 1, but its two are those at 2 b and 2 b + 1.
# says: this
# -     weights = utilities[0::2] - utilities[1::2]
# +     weights = utilities[: len(samples)] - utilities[1 : len(samples) + 1]


# %% unstable_order_of_equals loses 8.2
# Ranks with an argsort that is not stable: of equals, the first does not always have the lower rank.
# says: in another order
def utilities(fitness):
    fitness = np.asarray(fitness, dtype=float)
    order = np.argsort(fitness)
    ranks = np.argsort(order)
    return ranks / (len(fitness) - 1) - 0.5


# %% divided_by_size loses 8.3
# Divides by the number of elements in samples (samples.size), not by that of the candidates.
# says: this
# -     return weights @ samples / len(utilities)
# +     return weights @ samples / samples.size


# %% decays_added_up loses 8.4
# With wdecay 2, both pulls act: that in proportion to the centre belongs to wdecay 1 alone.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# -     return -gradient + 0.005 * pull
# +     d = -gradient
# +     if wdecay >= 1:
# +         d = d + 0.005 * centre
# +     if wdecay >= 2:
# +         d = d + 0.005 * np.sign(centre)
# +     return d


# %% correction_after_the_root loses 8.5
# The bias correction divides the root of v: correct v first, and take the root then.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v) / (1 - 0.999**t) + 1e-8)


# %% pairs_around_the_last_candidate loses 8.1
# Lays each pair around the last candidate of the pair before, not around the centre.
# says: this
import numpy as np


def candidates_around(centre, samples, noiseStdDev):
    place = np.array(centre, dtype=float)
    rows = []
    for e in samples:
        leg = noiseStdDev * e
        place = place + leg
        rows.append(place)
        place = place - 2 * leg
        rows.append(place)
    return np.array(rows)
