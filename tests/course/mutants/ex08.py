"""Wrong solutions of exercise 8; building.py describes how a case is written."""


# %% noise_forgotten loses 8.1
# Leaves out the factor noiseStdDev: adds samples[b] itself to the centre, and subtracts it, instead of noiseStdDev * samples[b].
# says: this
def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + samples, centre - samples], axis=1)
    return both.reshape(-1, len(centre))


# %% plus_before_minus loses 8.1
# Returns all plus candidates first and then all minus candidates, but the two candidates of a sample should be neighbours (rows 2 b and 2 b + 1).
# says: this
def candidates_around(centre, samples, noiseStdDev):
    return np.concatenate([centre + noiseStdDev * samples, centre - noiseStdDev * samples])


# %% best_is_lowest loses 8.2
# Gives the best candidate the utility -0.5 and the worst 0.5 instead of the other way round.
# says: this
_utilities = utilities


def utilities(fitness):
    return -_utilities(fitness)


# %% order_for_ranks loses 8.2
# Takes the order of the candidates (as np.argsort gives it) for their ranks, but number i should come from the rank of candidate i.
# says: this
def utilities(fitness):
    return np.argsort(fitness, kind="stable") / (len(fitness) - 1) - 0.5


# %% ties_share_a_rank loses 8.2
# Gives equal candidates the mean of their ranks, but of equals, the one that comes first should get the lower rank.
_utilities = utilities


def utilities(fitness):
    first = _utilities(np.asarray(fitness))
    return np.array([first[fitness == value].mean() for value in fitness])


# %% divided_by_samplesize loses 8.3
# Divides the sum by samplesize instead of by 2 * samplesize, so the gradient is twice as long as it should be.
# says: this
def gradient(samples, utilities):
    return (utilities[0::2] - utilities[1::2]) @ samples / len(samples)


# %% summed_utilities loses 8.3
# Adds the two utilities of a sample, but the utility of its minus candidate should be subtracted from that of its plus candidate.
# says: this
def gradient(samples, utilities):
    return (utilities[0::2] + utilities[1::2]) @ samples / len(utilities)


# %% asks_the_tools_own_gradient loses 8.3
# Uses the tool's own OpenAI-ES (botschool.evolution.algorithms.openaies), but the gradient should be computed by your own code.
# says: write it yourself: botschool
def gradient(samples, utilities):
    from botschool.evolution.algorithms import openaies

    return openaies.gradient(np.asarray(utilities), np.asarray(samples))


# %% decay_by_sign_missing loses 8.4
# Adds 0.005 * centre for wdecay 2, too, but wdecay 2 asks for 0.005 * sign(centre).
def descent(gradient, centre, wdecay):
    return -gradient + (0.005 * centre if wdecay else 0)


# %% decay_pushes_away loses 8.4
# Subtracts the pull instead of adding it, so that the decay would push parameters away from 0 instead of towards it.
# says: this
# -     return -gradient + 0.005 * pull
# +     return -gradient - 0.005 * pull


# %% descends_on_fitness loses 8.4
# Adds the gradient instead of subtracting it, so that the optimiser would reduce the fitness.
# -     return -gradient + 0.005 * pull
# +     return gradient + 0.005 * pull


# %% changes_the_centre loses 8.5
# Changes the array `centre` that it is given, but the arguments should stay as they are.
_adam = adam


def adam(centre, d, m, v, t, stepsize):
    moved, m, v = _adam(centre, d, m, v, t, stepsize)
    centre[:] = moved
    return centre, m, v


# %% corrected_moments_kept loses 8.5
# Returns the corrected m and v, but the m and v before the bias correction should be returned: only the step uses the corrected ones.
def adam(centre, d, m, v, t, stepsize):
    m = (0.9 * m + 0.1 * d) / (1 - 0.9**t)
    v = (0.999 * v + 0.001 * d**2) / (1 - 0.999**t)
    return centre - stepsize * m / (np.sqrt(v) + 1e-8), m, v


# %% epsilon_below_the_root loses 8.5
# Adds 1e-8 before the root is taken, but it should be added to the root.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize * (m / (1 - 0.9**t)) / np.sqrt(v / (1 - 0.999**t) + 1e-8), m, v


# %% no_bias_correction loses 8.5
# Leaves out the bias correction, but for the step, m should be divided by 1 - 0.9^t and v by 1 - 0.999^t.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize * m / (np.sqrt(v) + 1e-8), m, v


# %% no_epsilon loses 8.5
# Leaves out the 1e-8 that should be added to the root below the fraction, so that it may divide by 0.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize * (m / (1 - 0.9**t)) / np.sqrt(v / (1 - 0.999**t)), m, v


# %% decay_forgotten loses 8.6
# Evolves without weight decay, whatever wdecay is, but `descent` should get the wdecay that evolve is given.
# says: this
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    return _evolve(evaluate, centre, generations, seed, **{**hyperparameters, "wdecay": 0})


# %% generations_from_zero loses 8.6
# Gets NaN in the first step, as from adam with t = 0, but t should be generation + 1, so 1 in the first step.
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, m, v = adam(centre, d, m, v, generation, stepsize)


# %% history_of_the_best loses 8.6
# Keeps the fitness of the best candidate in the history instead of the mean fitness of all candidates.
# says: this
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    best = []

    def watched(candidates, seed):
        fitness = evaluate(candidates, seed)
        best.append(float(np.max(fitness)))
        return fitness

    return {**_evolve(watched, centre, generations, seed, **hyperparameters), "history": best}


# %% seeds_from_one loses 8.6
# Counts the generations from 1 for the seed of evaluate: begins with seed + 1 instead of seed. Only the t of adam should count from 1.
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    def later(candidates, seed):
        return evaluate(candidates, seed + 1)

    return _evolve(later, centre, generations, seed, **hyperparameters)


# %% fall_to_the_end loses 8.7
# Measures only the fall from the highest point of the whole curve to its end, but the largest fall anywhere is asked for, even if the curve recovers.
def stability(curve):
    curve = np.asarray(curve, dtype=float)
    peak, bottom, height = int(np.argmax(curve)), len(curve) - 1, np.ptp(curve)
    drop = float((curve[peak] - curve[-1]) / height) if height > 0 else 0.0
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    verdict = "severe regressions" if drop > 0.3 else verdict
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% falls_of_one_step loses 8.7
# Looks only at falls from one value to the next, but a fall should be measured from the highest value so far.
def stability(curve):
    curve = np.asarray(curve, dtype=float)
    steps = np.append(0, np.diff(curve))
    bottom, height = int(np.argmin(steps)), np.ptp(curve)
    drop = float(-steps[bottom] / height) if height > 0 else 0.0
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    verdict = "severe regressions" if drop > 0.3 else verdict
    return {"drop": drop, "bottom": bottom, "peak": max(0, bottom - 1), "verdict": verdict}


# %% limits_are_severe loses 8.7
# Gives a drop of exactly 0.1 or 0.3 the worse verdict instead of the better one.
_stability = stability


def stability(curve):
    found = _stability(curve)
    worse = ["monotonic", "mild regressions", "severe regressions"]
    found["verdict"] = worse[int(found["drop"] >= 0.1) + int(found["drop"] >= 0.3)]
    return found


# %% smooth_keeps_the_length loses 8.7
# Returns as many numbers as the curve has, with zeros for neighbours beyond its ends, but only whole windows should count: len(curve) - width + 1.
def smooth(curve, width):
    return np.convolve(curve, np.full(width, 1 / width), mode="same")


# %% known_by_heart loses 8.8
# Returns parameters that were written down and then hardly moved, but train should evolve them from random first weights.
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
# Evolves by the strategy of exercise 3 instead of by OpenAI-ES.
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
# Evolves for one generation only, but many are needed to reach the goal.
_evolve_8 = evolve


def train(environment, seed):
    robot = Robot(environment)
    centre = np.random.default_rng(seed).normal(scale=0.1, size=robot.nbiases + robot.nweights)
    return _evolve_8(robot.evaluate, centre, 1, seed)["centre"]


# %% ranks_in_the_type_of_fitness loses 8.2
# Returns whole numbers if the fitness values are whole numbers, so that all utilities become 0, but fractions are asked for.
# -     utilities = np.empty(len(fitness))
# +     utilities = np.empty_like(fitness)


# %% asks_the_tools_own_ranks loses 8.2
# Uses the tool's own OpenAI-ES (botschool.evolution.algorithms.openaies), but the utilities should be computed by your own code.
# says: write it yourself: botschool
def utilities(fitness):
    from botschool.evolution.algorithms.openaies import ranks

    found = np.empty(len(fitness))
    found[np.argsort(fitness, kind="stable")] = ranks(len(fitness))
    return found


# %% descent_scales_the_centre loses 8.4
# Changes the array `centre` that it is given if wdecay is 1, but the arguments should stay as they are.
_descent = descent


def descent(gradient, centre, wdecay):
    d = _descent(gradient, centre, wdecay)
    if wdecay == 1:
        centre *= 0.005
    return d


# %% moments_of_the_run_before loses 8.6
# Goes on with the m and v of an earlier call of evolve, but each call should begin with m and v of zeros.
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
# Calls evaluate twice in each generation, but one call is asked for: both the utilities and the history should use what it returns.
# says: this
# -         history.append(float(np.mean(fitness)))
# +         again = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         history.append(float(np.mean(again)))


# %% first_centre_moves loses 8.6
# Changes the array `centre` that it is given, but the first centre should stay as it is.
# says: this
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre[:], m, v = adam(centre, d, m, v, generation + 1, stepsize)


# %% no_places_without_a_fall loses 8.7
# Returns None as bottom and peak of a curve that never falls instead of 0.
_stability = stability


def stability(curve):
    found = _stability(curve)
    return found if found["drop"] > 0 else {**found, "bottom": None, "peak": None}


# %% the_curve_is_shifted loses 8.7
# Changes the array `curve` that it is given, but it should stay as it is.
_stability = stability


def stability(curve):
    if np.asarray(curve).dtype == float:
        curve -= np.min(curve)
    return _stability(curve)


# %% another_strategy_and_a_show_call loses 8.8
# Finds the controller by the strategy of exercise 3 and calls evolve for one generation with steps of 0, but OpenAI-ES should find it.
# says: the first centre reaches the goal already
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
# Finds the controller by the strategy of exercise 3 and hardly moves it by OpenAI-ES with tiny steps, but OpenAI-ES should find it.
# says: the first centre reaches the goal already
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
# Moves the centre to the best candidate so far instead of along the estimated gradient.
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
# Evolves in the same way for every seed, but another seed should give another evolution.
# says: another seed should give another first centre
_train = train


def train(environment, seed):
    return _train(environment, 1)


# %% remembered_run loses 8.8
# Keeps the centre of the first training and returns it for every seed, but each call should evolve a new one.
# says: something stays from call to call
FOUND = {}
_train = train


def train(environment, seed):
    if environment not in FOUND:
        FOUND[environment] = _train(environment, seed)
    return FOUND[environment]


# %% seeds_of_its_own loses 8.8
# Draws random numbers that do not follow from the seed, so that no training can be repeated, but the seed should decide about all of them.
_train = train


def train(environment, seed):
    return _train(environment, int(np.random.default_rng().integers(1 << 30)))


# %% one_side_only loses 8.1
# Puts both candidates of a sample on the plus side, but row 2 b + 1 should be centre - noiseStdDev * samples[b].
# says: this
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     candidates[1::2] = centre + noiseStdDev * samples


# %% centre_scaled loses 8.1
# Multiplies noiseStdDev * samples[b] by the centre, too, before it is added or subtracted; noiseStdDev * samples[b] alone is asked for.
# says: this
# -     candidates[0::2] = centre + noiseStdDev * samples
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     candidates[0::2] = centre * (1 + noiseStdDev * samples)
# +     candidates[1::2] = centre * (1 - noiseStdDev * samples)


# %% ranks_from_zero_to_one loses 8.2
# Returns utilities from 0 to 1 instead of from -0.5 to 0.5.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     utilities[np.argsort(fitness, kind="stable")] = np.linspace(0, 1, len(fitness))


# %% standardised_fitness loses 8.2
# Standardises the fitness (mean 0, standard deviation 1) instead of ranking it.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     fitness = np.asarray(fitness, dtype=float)
# +     utilities[:] = (fitness - fitness.mean()) / (fitness.std() + 1e-8)


# %% later_equals_lower loses 8.2
# Gives equal candidates their ranks in reverse order, but of equals, the one that comes first should get the lower rank.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     order = np.argsort(np.asarray(fitness)[::-1], kind="stable")
# +     utilities[::-1][order] = np.linspace(-0.5, 0.5, len(fitness))


# %% halves_for_pairs loses 8.3
# Takes the first half of the utilities for plus and the second half for minus, but plus and minus alternate: utilities 2 b and 2 b + 1 belong to sample b.
# says: this
# -     weights = utilities[0::2] - utilities[1::2]
# +     half = len(utilities) // 2
# +     weights = utilities[:half] - utilities[half:]


# %% decay_ten_times_as_strong loses 8.4
# Takes 0.05 as the factor of the pull instead of 0.005.
# says: this
# -     return -gradient + 0.005 * pull
# +     return -gradient + 0.05 * pull


# %% kinds_of_decay_exchanged loses 8.4
# Exchanges the two kinds of decay, but wdecay 1 should pull by 0.005 * centre and wdecay 2 by 0.005 * sign(centre).
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 2: centre, 1: np.sign(centre)}[wdecay]


# %% decays_exchanged_in_adam loses 8.5
# Exchanges the factors of m and v, but 0.9 and 0.1 belong to m, 0.999 and 0.001 to v.
# says: this
# -     m = 0.9 * m + 0.1 * d
# -     v = 0.999 * v + 0.001 * d**2
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     m = 0.999 * m + 0.001 * d
# +     v = 0.9 * v + 0.1 * d**2
# +     step = (m / (1 - 0.999**t)) / (np.sqrt(v / (1 - 0.9**t)) + 1e-8)


# %% adam_climbs loses 8.5
# Adds the step to the centre instead of subtracting it.
# says: this
# -     return centre - stepsize * step, m, v
# +     return centre + stepsize * step, m, v


# %% one_seed_for_all_generations loses 8.6
# Gives evaluate the same seed in all generations, but generation g should have seed + g.
# -         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed)


# %% samples_drawn_once loses 8.6
# Uses the same samples in all generations, but each generation should draw new ones from rng.
# -     for generation in range(generations):
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +     samples = rng.standard_normal((samplesize, len(centre)))
# +     for generation in range(generations):


# %% median_in_the_history loses 8.6
# Keeps the median fitness of the candidates in the history instead of the mean.
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(np.median(fitness)))


# %% divided_at_the_ends loses 8.7
# Takes means over fewer than width neighbours at the ends, so that the curve keeps its length, but only whole windows should count.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     window = np.ones(width)
# +     counts = np.convolve(np.ones(len(curve)), window, mode="same")
# +     return np.convolve(curve, window, mode="same") / counts


# %% fall_by_the_height loses 8.7
# Divides the fall by the value at the peak instead of by max - min of the whole curve.
# says: this
# -     height = curve.max() - curve.min()
# +     height = curve[peak]


# %% last_bottom loses 8.7
# Takes the last of equal falls for the bottom (also of falls of 0, in a curve that never falls), but the first one is asked for.
# says: this
# -     bottom = int(np.argmax(falls))
# +     bottom = len(falls) - 1 - int(np.argmax(falls[::-1]))


# %% last_peak loses 8.7
# Takes the last of equal heights before the fall for the peak, but the first one is asked for.
# says: this
# -     peak = int(np.argmax(curve[: bottom + 1]))
# +     peak = bottom - int(np.argmax(curve[: bottom + 1][::-1]))


# %% old_m loses 8.5
# Makes the step with the m of the generation before instead of the new m.
# says: this
def adam(centre, d, m, v, t, stepsize):
    new_m = 0.9 * m + 0.1 * d
    new_v = 0.999 * v + 0.001 * d**2
    step = (m / (1 - 0.9**t)) / (np.sqrt(new_v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * step, new_m, new_v


# %% one_size_for_all loses 8.5
# Takes the mean of d squared over all parameters for v, but each parameter should have a v from its own d.
# says: this
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * np.mean(d**2)
    step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * step, m, v


# %% epsilon_before_correction loses 8.5
# Adds 1e-8 to the root of v before the bias correction instead of to the root of the corrected v.
# says: this
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    rate = stepsize * np.sqrt(1 - 0.999**t) / (1 - 0.9**t)
    return centre - rate * m / (np.sqrt(v) + 1e-8), m, v


# %% clipped_step loses 8.5
# Limits the step of each parameter to stepsize, but Adam's step should not be limited.
# says: this
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * np.clip(step, -1, 1), m, v


# %% sizes_for_squares loses 8.5
# Takes the absolute value of d in v instead of the square of d.
# says: this
# -     v = 0.999 * v + 0.001 * d**2
# +     v = 0.999 * v + 0.001 * np.abs(d)


# %% correction_multiplied loses 8.5
# Multiplies m by 1 - 0.9^t and v by 1 - 0.999^t for the bias correction instead of dividing by them.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m * (1 - 0.9**t)) / (np.sqrt(v * (1 - 0.999**t)) + 1e-8)


# %% d_for_m loses 8.5
# Makes the step with d itself instead of with the corrected m.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = d / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)


# %% same_share_for_both loses 8.5
# Divides v by 1 - 0.9^t for the bias correction instead of by 1 - 0.999^t.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.9**t)) + 1e-8)


# %% gradient_of_the_scaled loses 8.6
# Makes the gradient noiseStdDev times as long as it should be: `gradient` should get the samples as rng draws them, not multiplied by noiseStdDev.
# says: this
# -         samples = rng.standard_normal((samplesize, len(centre)))
# -         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         samples = rng.normal(0, noiseStdDev, (samplesize, len(centre)))
# +         fitness = evaluate(candidates_around(centre, samples, 1), seed + generation)


# %% returns_the_best loses 8.6
# Returns the centre after the generation with the best mean fitness instead of the centre after the last generation.
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
# Keeps the fitness of the centre in the history, from another call of evaluate, instead of the mean fitness of the candidates.
# says: this
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(evaluate(centre[None], seed + generation)[0]))


# %% decays_the_start loses 8.6
# Computes the weight decay from the first centre in all generations instead of from the present centre.
# says: this
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         d = descent(gradient(samples, utilities(fitness)), start, wdecay)
# -     m, v, history = np.zeros(len(centre)), np.zeros(len(centre)), []
# +     m, v, history, start = np.zeros(len(centre)), np.zeros(len(centre)), [], centre


# %% rng_of_each_generation loses 8.6
# Makes a new generator from seed + g in each generation g, but one generator from seed should draw all samples.
# says: this
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +         samples = np.random.default_rng(seed + generation).standard_normal((samplesize, len(centre)))


# %% m_forgotten loses 8.6
# Begins each generation with m and v of zeros instead of with those that adam returned in the generation before.
# says: this
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, _, _ = adam(centre, d, m, v, generation + 1, stepsize)


# %% range_until_then loses 8.7
# Divides each fall by max - min of the curve up to there instead of by max - min of the whole curve.
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
# Begins with 0 as the highest value so far, so that a negative curve seems to fall from 0, but it should begin with the first value of the curve.
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
# Smooths the curve (means of two neighbours) before it looks for falls, but the curve should be judged as it is given.
# says: this
# -     curve = np.asarray(curve, dtype=float)
# +     curve = smooth(np.asarray(curve, dtype=float), 2)


# %% height_from_the_start loses 8.7
# Divides the fall by max - the first value instead of by max - min.
# says: this
# -     height = curve.max() - curve.min()
# +     height = curve.max() - curve[0]


# %% bottom_is_the_lowest loses 8.7
# Takes the place of the lowest value for the bottom, but the place of the largest fall is asked for.
# says: this
# -     bottom = int(np.argmax(falls))
# +     bottom = int(np.argmin(curve))


# %% peak_of_a_rise loses 8.7
# Returns the last index as bottom and peak of a curve that never falls instead of 0.
# says: this
# -     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
# +     if drop == 0:
# +         bottom = peak = len(curve) - 1
# +     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% stacked_last loses 8.1
# Mixes the numbers of both candidates of a sample within each row (as np.stack with axis=-1 and a reshape do), but each row should be one candidate.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + noiseStdDev * samples, centre - noiseStdDev * samples], axis=-1)
    return both.reshape(-1, len(centre))


# %% minus_of_the_next loses 8.1
# Subtracts the sample before, samples[b - 1], in row 2 b + 1 instead of samples[b].
# says: this
def candidates_around(centre, samples, noiseStdDev):
    rows = []
    for b in range(len(samples)):
        rows.append(centre + noiseStdDev * samples[b])
        rows.append(centre - noiseStdDev * samples[b - 1])
    return np.array(rows)


# %% scaled_samples_in_place loses 8.1
# Changes the array `samples` that it is given, but the arguments should stay as they are.
# says: changed
def candidates_around(centre, samples, noiseStdDev):
    samples *= noiseStdDev
    out = np.repeat(samples, 2, axis=0)
    out[1::2] *= -1
    return centre + out


# %% variance_for_deviation loses 8.1
# Multiplies the samples by the square root of noiseStdDev instead of by noiseStdDev itself, the standard deviation.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    out = np.repeat(np.sqrt(noiseStdDev) * samples, 2, axis=0)
    out[1::2] *= -1
    return centre + out


# %% around_zero loses 8.1
# Returns minus the plus candidate as the minus candidate (mirrored at 0, not at the centre), but row 2 b + 1 should be centre - noiseStdDev * samples[b].
# says: this
def candidates_around(centre, samples, noiseStdDev):
    out = np.empty((2 * len(samples), len(centre)))
    out[0::2] = centre + noiseStdDev * samples
    out[1::2] = -out[0::2]
    return out


# %% same_rank_for_equals loses 8.2
# Gives all equal candidates the lowest of their ranks, but only the first of them should get it, and the others higher ones in their order.
# says: this
def utilities(fitness):
    fitness = np.asarray(fitness)
    ranks = np.searchsorted(np.sort(fitness), fitness)
    return ranks / (len(fitness) - 1) - 0.5


# %% rank_by_dictionary loses 8.2
# Gives all equal candidates the highest of their ranks, but only the last of them should get it, and the others lower ones in their order.
# says: this
def utilities(fitness):
    rank = {value: i for i, value in enumerate(sorted(fitness))}
    return np.array([rank[value] for value in fitness]) / (len(fitness) - 1) - 0.5


# %% whole_fitness loses 8.2
# Cuts the fitness off to whole numbers before ranking it, but it should be ranked as it is.
# says: this
def utilities(fitness):
    order = np.argsort(np.asarray(fitness).astype(int), kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    return u


# %% sorts_the_argument loses 8.2
# Changes the array `fitness` that it is given, but it should stay as it is.
def utilities(fitness):
    order = np.argsort(fitness, kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    fitness.sort()
    return u


# %% best_half_only loses 8.2
# Sets the utilities of the worse half to 0, but they should be negative, down to -0.5 for the worst.
# says: this
def utilities(fitness):
    order = np.argsort(fitness, kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    return np.maximum(u, 0)


# %% all_equal_zero loses 8.2
# Returns zeros if all candidates have the same fitness, but equals should have different ranks, too, in their order.
def utilities(fitness):
    fitness = np.asarray(fitness)
    if fitness.max() == fitness.min():
        return np.zeros(len(fitness))
    order = np.argsort(fitness, kind="stable")
    u = np.empty(len(order))
    u[order] = np.linspace(-0.5, 0.5, len(order))
    return u


# %% signs_of_the_differences loses 8.3
# Weights each sample by the sign of the difference of its two utilities instead of by the difference itself.
# says: this
def gradient(samples, utilities):
    return np.sign(utilities[0::2] - utilities[1::2]) @ samples / len(utilities)


# %% over_parameters loses 8.3
# Divides the sum by twice the number of parameters instead of by 2 * samplesize.
# says: this
def gradient(samples, utilities):
    return (utilities[0::2] - utilities[1::2]) @ samples / (2 * samples.shape[1])


# %% plus_only loses 8.3
# Leaves out the utilities of the minus candidates and divides by samplesize, but utilities[2 b] - utilities[2 b + 1] and 2 * samplesize are asked for.
# says: this
def gradient(samples, utilities):
    return 2 * utilities[0::2] @ samples / len(utilities)


# %% winners_only loses 8.3
# Leaves out the samples whose minus candidate did better, but they should count with their negative weights.
# says: this
def gradient(samples, utilities):
    weights = utilities[0::2] - utilities[1::2]
    return np.maximum(weights, 0) @ samples / len(utilities)


# %% unit_length loses 8.3
# Returns a gradient of length 1, but the length should be as the formula gives it.
# says: this
def gradient(samples, utilities):
    g = (utilities[0::2] - utilities[1::2]) @ samples / len(utilities)
    return g / np.linalg.norm(g)


# %% zero_counts_as_positive loses 8.4
# Adds 0.005 where the centre is 0 (wdecay 2), but there should be no pull on a parameter that is 0.
# says: this
def descent(gradient, centre, wdecay):
    if wdecay == 0:
        return -gradient
    if wdecay == 1:
        return -gradient + 0.005 * centre
    return -gradient + np.where(centre < 0, -0.005, 0.005)


# %% negates_in_place loses 8.4
# Changes the array `gradient` that it is given, but the arguments should stay as they are.
def descent(gradient, centre, wdecay):
    gradient *= -1
    if wdecay == 1:
        gradient += 0.005 * centre
    elif wdecay == 2:
        gradient += 0.005 * np.sign(centre)
    return gradient


# %% returns_the_gradient_itself loses 8.4
# Adds 0.005 * wdecay * centre, but wdecay only says which kind of pull is asked for: with wdecay 2 it should be 0.005 * sign(centre).
# says: this
def descent(gradient, centre, wdecay):
    return -gradient + 0.005 * wdecay * centre


# %% size_for_sign loses 8.4
# Adds 0.005 times the absolute value of the centre for wdecay 2 instead of 0.005 * sign(centre).
# says: this
def descent(gradient, centre, wdecay):
    return -gradient + 0.005 * {0: 0 * centre, 1: centre, 2: np.abs(centre)}[wdecay]


# %% counts_its_own_steps loses 8.5
# Takes the number of its own calls for t instead of the argument t.
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
# Makes a generation even if generations is 0, but then it should return the first centre and an empty history.
# -     for generation in range(generations):
# +     for generation in range(max(generations, 1)):


# %% truncated_smooth loses 8.7
# Cuts the means of whole numbers off to whole numbers, but their fractions should stay.
# says: this
def smooth(curve, width):
    curve = np.asarray(curve)
    out = np.zeros_like(curve[width - 1 :])
    for i in range(len(out)):
        out[i] = curve[i : i + width].mean()
    return out


# %% cumulated_sum_loses_first loses 8.7
# Leaves out the first mean, that of the first width numbers: there should be len(curve) - width + 1 means.
# says: this
def smooth(curve, width):
    sums = np.cumsum(curve, dtype=float)
    return (sums[width:] - sums[:-width]) / width


# %% rounded_drop loses 8.7
# Moves the limits of the verdicts to about 0.15 and 0.35 (rounding the drop to one digit does so) instead of deciding at exactly 0.1 and 0.3.
# says: this
# -     if drop <= 0.1:
# +     if round(drop, 1) <= 0.1:
# -     elif drop <= 0.3:
# +     elif round(drop, 1) <= 0.3:


# %% flat_within_a_thousandth loses 8.7
# Returns the drop 0 for a curve that is almost flat but falls; only a curve that never falls should have the drop 0.
# -     drop = float(falls[bottom] / height) if height > 0 else 0.0
# +     drop = float(falls[bottom] / height) if height > 1e-3 else 0.0


# %% start_without_seed loses 8.8
# Starts from the same centre for every seed, but the first weights should be drawn from the seed.
# says: another seed should give another first centre
# -     weights = 0.1 * np.random.default_rng(seed).standard_normal(robot.nweights)
# +     weights = 0.1 * np.random.default_rng(0).standard_normal(robot.nweights)


# %% best_candidate loses 8.8
# Returns the best candidate of all instead of a centre.
# says: a centre to which your evolve has led
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
# Moves the centre to the best candidate of each generation instead of along the estimated gradient.
# -     run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
# -     return run["centre"]
# +     rng, best = np.random.default_rng(seed), -np.inf
# +     for g in range(generations):
# +         candidates = candidates_around(centre, rng.standard_normal((20, len(centre))), 0.2)
# +         found = evaluate(candidates, seed + g)
# +         centre = candidates[np.argmax(found)]
# +     return centre


# %% unstable_in_evolve loses 8.6
# Ranks candidates of equal fitness in another order, but of equals, the one that comes first should get the lower rank, as in `utilities`.
# says: this
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         u = np.argsort(np.argsort(fitness)) / (2 * samplesize - 1) - 0.5
# +         d = descent(gradient(samples, u), centre, wdecay)


# %% decay_of_one_kind loses 8.6
# Uses the decay of wdecay 1 for wdecay 2, too, but `descent` should get the wdecay that evolve is given.
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         d = descent(gradient(samples, utilities(fitness)), centre, int(bool(wdecay)))


# %% last_generation_left_out loses 8.6
# Leaves out the step of the last generation, but the centre after that step should be returned.
# says: this
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         if generation < generations - 1:
# +             centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)


# %% default_noise loses 8.6
# Uses the noiseStdDev 0.02, whatever is asked for, but candidates_around should get the noiseStdDev that evolve is given.
# says: this
# -         fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
# +         fitness = evaluate(candidates_around(centre, samples, 0.02), seed + generation)


# %% history_of_one_side loses 8.6
# Keeps the mean fitness of the plus candidates alone in the history instead of that of all candidates.
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(np.mean(fitness[0::2])))


# %% rounded_history loses 8.6
# Rounds the numbers of the history to three decimal places, but they should not be rounded.
# -         history.append(float(np.mean(fitness)))
# +         history.append(round(float(np.mean(fitness)), 3))


# %% median_filter loses 8.7
# Takes the median of the neighbours instead of their mean.
def smooth(curve, width):
    return np.array([np.median(curve[i : i + width]) for i in range(len(curve) - width + 1)])


# %% percent loses 8.7
# Returns the drop in percent, but a share is asked for (0.2, not 20).
# says: this
# -     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
# +     return {"drop": 100 * drop, "bottom": bottom, "peak": peak, "verdict": verdict}


# %% drop_of_two_places loses 8.7
# Rounds the drop to two decimal places, but it should not be rounded.
# says: this
# -     drop = float(falls[bottom] / height) if height > 0 else 0.0
# +     drop = round(float(falls[bottom] / height), 2) if height > 0 else 0.0


# %% short_verdict loses 8.7
# Shortens the verdicts to 'mild' and 'severe' instead of 'mild regressions' and 'severe regressions'.
# says: this
# -     verdict = "severe regressions"
# +     verdict = "severe"
# -         verdict = "mild regressions"
# +         verdict = "mild"


# %% width_too_narrow loses 8.7
# Divides the sums by width + 1 instead of by width.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     return np.convolve(curve, np.full(width, 1 / (width + 1)), mode="valid")


# %% shrinks_the_gradient loses 8.4
# Computes the pull from the gradient (wdecay 1) and its sign (wdecay 2) instead of from the centre and its sign.
def descent(gradient, centre, wdecay):
    pull = {0: np.zeros(len(centre)), 1: gradient, 2: np.sign(gradient)}[wdecay]
    return -gradient + 0.005 * pull


# %% best_plus_side loses 8.8
# Returns the best plus candidate of the last generation instead of a centre.
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
# Uses the same samples for every seed, but the samples should follow from the seed, as the first weights do.
# says: another seed should give other samples
# -     run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
# +     run = evolve(evaluate, centre, generations, 7, noiseStdDev=0.2, stepsize=0.05)


# %% from_nothing loses 8.8
# Starts from zeros for every seed, but the first weights should be drawn from the seed.
# says: another seed should give another first centre
# -     centre = np.concatenate([np.zeros(robot.nbiases), weights])
# +     centre = np.zeros(robot.nbiases + robot.nweights)


# %% pendulum_ends_early loses 8.8
# Evolves Pendulum for 80 generations only, but it needs more.
# -     generations = 80 if "CartPole" in environment else 600
# +     generations = 80


# %% minus_first_and_scaled_centre loses 8.1
# Multiplies the centre by noiseStdDev, too, and puts the minus candidate first; only the samples should be multiplied, and the plus candidate should come first.
# says: this
def candidates_around(centre, samples, noiseStdDev):
    rows = []
    for e in samples:
        rows += [noiseStdDev * (centre - e), noiseStdDev * (centre + e)]
    return np.array(rows)


# %% ranks_begin_at_one loses 8.2
# Counts the ranks from 1, but the worst candidate should have the rank 0.
# says: this
def utilities(fitness):
    ranks = np.argsort(np.argsort(fitness, kind="stable"), kind="stable") + 1
    return ranks / (len(fitness) - 1) - 0.5


# %% divided_by_their_number loses 8.2
# Divides the ranks by n instead of by the highest rank, n - 1.
# says: this
def utilities(fitness):
    return np.argsort(np.argsort(fitness, kind="stable"), kind="stable") / len(fitness) - 0.5


# %% from_minus_one_to_one loses 8.2
# Returns utilities from -1 to 1 instead of from -0.5 to 0.5, so all are twice as large as they should be.
# says: this
def utilities(fitness):
    ranks = np.argsort(np.argsort(fitness, kind="stable"), kind="stable")
    return 2 * ranks / (len(fitness) - 1) - 1


# %% scaled_fitness loses 8.2
# Scales the fitness itself to the range from -0.5 to 0.5, but only the ranks should count.
# says: this
def utilities(fitness):
    span = np.ptp(fitness) or 1.0
    return (np.asarray(fitness) - np.min(fitness)) / span - 0.5


# %% sorted_from_the_best loses 8.2
# Ranks the candidates from the best to the worst, but the worst should have the rank 0 and the best the rank n - 1.
# says: this
def utilities(fitness):
    ranks = np.empty(len(fitness))
    ranks[np.argsort(-np.asarray(fitness), kind="stable")] = np.arange(len(fitness))
    return ranks / (len(fitness) - 1) - 0.5


# %% added_and_by_samplesize loses 8.3
# Adds the two utilities of a sample instead of subtracting the second from the first, and divides by samplesize instead of by 2 * samplesize.
# says: this
def gradient(samples, utilities):
    return (utilities[0::2] + utilities[1::2]) @ samples / len(samples)


# %% square_and_size_for_decay loses 8.4
# Takes the square of the centre (wdecay 1) and its absolute value (wdecay 2) for the pull instead of the centre and its sign.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 1: centre**2, 2: np.abs(centre)}[wdecay]


# %% only_m_corrected loses 8.5
# Leaves out the bias correction of v, but v should be divided by 1 - 0.999^t for the step.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v) + 1e-8)


# %% corrects_with_the_next_t loses 8.5
# Corrects with t + 1 instead of with t, but t counts from 1 already.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9 ** (t + 1))) / (np.sqrt(v / (1 - 0.999 ** (t + 1))) + 1e-8)


# %% square_of_the_length loses 8.5
# Takes the sum of d squared over all parameters for v, but each parameter should have a v from its own d.
# says: this
# -     v = 0.999 * v + 0.001 * d**2
# +     v = 0.999 * v + 0.001 * np.sum(d**2)


# %% shares_not_raised loses 8.5
# Multiplies 0.9 and 0.999 by t in the bias correction instead of taking their powers, 0.9^t and 0.999^t.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9 * t)) / (np.sqrt(np.abs(v / (1 - 0.999 * t))) + 1e-8)


# %% twice_the_first_generation loses 8.6
# Gives adam the t 1 in the first two generations, then 2, 3 and so on, but t should be generation + 1.
# says: this
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, m, v = adam(centre, d, m, v, max(1, generation), stepsize)


# %% best_candidate_of_all loses 8.6
# Returns the best candidate of all generations, but the centre after the last generation is asked for.
# says: this
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
# Keeps the fitness of the centre after the step in the history instead of the mean fitness of the candidates.
# says: this
# -         history.append(float(np.mean(fitness)))
# -         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
# +         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         history.append(float(evaluate(centre[None, :], seed + generation)[0]))


# %% one_window_too_few loses 8.7
# Leaves out the last mean, that of the last width numbers: there should be len(curve) - width + 1 means.
# says: this
def smooth(curve, width):
    return [float(np.mean(curve[i : i + width])) for i in range(len(curve) - width)]


# %% peak_of_the_whole_curve loses 8.7
# Takes the highest value of the whole curve for the peak instead of the highest value up to the bottom.
# says: this
# -     peak = int(np.argmax(curve[: bottom + 1]))
# +     peak = int(np.argmax(curve))


# %% returns_the_dict_of_evolve loses 8.8
# Returns the whole dict of evolve, but only its centre is asked for.
# says: returned a dict with the keys
# -     return run["centre"]
# +     return run

# %% samples_of_length_one loses 8.1
# Divides each sample by its length, but the samples should be used as they are.
# says: this
# -     candidates[0::2] = centre + noiseStdDev * samples
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     samples = samples / np.linalg.norm(samples, axis=1, keepdims=True)
# +     candidates[0::2] = centre + noiseStdDev * samples
# +     candidates[1::2] = centre - noiseStdDev * samples

# %% sorted_utilities loses 8.2
# Returns the utilities in rising order from -0.5 to 0.5, but number i should be the utility of candidate i.
# says: this
# -     utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
# +     utilities[np.arange(len(fitness))] = np.linspace(-0.5, 0.5, len(fitness))

# %% one_number_for_all loses 8.3
# Adds everything up to a single number, but the gradient should have one number for each parameter: add up over the samples only.
# says: this
# -     return weights @ samples / len(utilities)
# +     return np.sum(weights[:, None] * samples) / len(utilities)

# %% sign_of_the_gradient loses 8.4
# Takes the sign of the gradient for the pull of wdecay 2 instead of the sign of the centre.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(gradient)}[wdecay]

# %% centre_of_length_one loses 8.4
# Divides the centre by its length for the pull of wdecay 1, but 0.005 * centre is asked for.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     length = np.linalg.norm(centre)
# +     pull = {0: np.zeros(len(centre)), 1: centre / length, 2: np.sign(centre)}[wdecay]

# %% noise_in_the_samples loses 8.6
# Multiplies the samples by noiseStdDev before candidates_around does so, too, but the samples should be used as rng draws them.
# says: this
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +         samples = noiseStdDev * rng.standard_normal((samplesize, len(centre)))

# %% one_neighbour_more loses 8.7
# Takes width + 1 numbers for each mean (but for the last, at the end of the curve) instead of width.
# says: this
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     places = range(len(curve) - width + 1)
# +     return np.array([np.mean(curve[i : i + width + 1]) for i in places])

# %% size_of_the_peak loses 8.7
# Divides the fall by the absolute value of the peak instead of by max - min of the whole curve.
# says: this
# -     height = curve.max() - curve.min()
# +     height = abs(curve[peak])

# %% severe_from_a_half loses 8.7
# Calls drops between 0.3 and about 0.5 'mild regressions', but every drop of more than 0.3 should be 'severe regressions'.
# says: this
# -     elif drop <= 0.3:
# +     elif drop <= 0.5:

# %% returns_the_first_centre loses 8.8
# Returns the first centre, where the evolution begins, instead of the one to which it leads.
# says: a centre to which your evolve has led
# -     return run["centre"]
# +     return centre

# %% minimises_fitness loses 8.8
# Moves the centre to where fitness is lower (as with the fitness negated), but fitness should rise.
# -         return robot.evaluate(candidates, seed, episodes=10)
# +         return -robot.evaluate(candidates, seed, episodes=10)


# %% last_fall_with_its_peak loses 8.7
# Takes the last of equal falls, with its peak, but the first one is asked for.
# says: this
# -     bottom = int(np.argmax(falls))
# +     bottom = len(falls) - 1 - int(np.argmax(falls[::-1])) if falls.any() else 0


# %% mean_of_three_centres loses 8.8
# Returns the mean of the centres of three evolutions, but one of these centres is asked for.
# -     run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
# -     return run["centre"]
# +     noise = {"noiseStdDev": 0.2, "stepsize": 0.05}
# +     runs = [evolve(evaluate, centre, generations, seed + k, **noise) for k in range(3)]
# +     return np.mean([run["centre"] for run in runs], axis=0)


# %% equals_share_a_rank loses 8.2
# Gives equal candidates the same rank, so that there are only as many ranks as different values, but each candidate should have a rank of its own.
# says: this
def utilities(fitness):
    values = sorted({float(each) for each in fitness})
    highest = max(len(values) - 1, 1)
    return np.array([values.index(float(each)) / highest - 0.5 for each in fitness])


# %% sign_of_the_whole_centre loses 8.4
# Divides the centre by its length for the pull of wdecay 2 instead of taking the sign of each element.
# says: this
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     sign = centre / max(np.linalg.norm(centre), 1e-300)
# +     pull = {0: np.zeros(len(centre)), 1: centre, 2: sign}[wdecay]


# %% ends_of_a_window_count_half loses 8.7
# Counts the two ends of each window half, as the trapezoid rule does, but all numbers of a window should count alike.
# says: this
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     weights = np.ones(width)
# +     weights[[0, -1]] = 0.5 if width > 1 else 1
# +     return np.convolve(curve, weights / weights.sum(), mode="valid")


# %% power_of_the_difference loses 8.5
# Divides by (1 - 0.9)^t and (1 - 0.999)^t for the bias correction instead of by 1 - 0.9^t and 1 - 0.999^t.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9) ** t) / (np.sqrt(v / (1 - 0.999) ** t) + 1e-8)


# %% pairs_that_overlap loses 8.3
# Weights sample b by utilities[b] - utilities[b + 1] instead of by utilities[2 b] - utilities[2 b + 1].
# says: this
# -     weights = utilities[0::2] - utilities[1::2]
# +     weights = utilities[: len(samples)] - utilities[1 : len(samples) + 1]


# %% unstable_order_of_equals loses 8.2
# Gives equal candidates their ranks in another order (as np.argsort without kind='stable' may do), but of equals, the one that comes first should get the lower rank.
def utilities(fitness):
    fitness = np.asarray(fitness, dtype=float)
    order = np.argsort(fitness)
    ranks = np.argsort(order)
    return ranks / (len(fitness) - 1) - 0.5


# %% divided_by_size loses 8.3
# Divides the sum by the number of elements of samples (samplesize * n) instead of by the number of candidates, 2 * samplesize.
# says: this
# -     return weights @ samples / len(utilities)
# +     return weights @ samples / samples.size


# %% decays_added_up loses 8.4
# Adds both pulls for wdecay 2, 0.005 * centre and 0.005 * sign(centre), but only the second is asked for.
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
# Divides the root of v by 1 - 0.999^t, but v should be divided by it before the root is taken.
# says: this
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v) / (1 - 0.999**t) + 1e-8)


# %% pairs_around_the_last_candidate loses 8.1
# Puts each pair around the last candidate of the pair before instead of around the centre.
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


# %% zero_counts_as_negative loses 8.4
# Subtracts 0.005 where the centre is 0 (wdecay 2), but there should be no pull on a parameter that is 0.
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.where(centre > 0, 1.0, -1.0)}[wdecay]


# %% half_as_far loses 8.1
# Puts the candidates half as far from the centre as noiseStdDev * samples[b].
# -     candidates[0::2] = centre + noiseStdDev * samples
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     candidates[0::2] = centre + noiseStdDev * samples / 2
# +     candidates[1::2] = centre - noiseStdDev * samples / 2


# %% square_of_the_noise loses 8.1
# Multiplies the samples by the square of noiseStdDev instead of by noiseStdDev itself.
# -     candidates[0::2] = centre + noiseStdDev * samples
# -     candidates[1::2] = centre - noiseStdDev * samples
# +     candidates[0::2] = centre + noiseStdDev**2 * samples
# +     candidates[1::2] = centre - noiseStdDev**2 * samples


# %% nothing_but_zeros loses 8.2
# Returns zeros for all candidates, but the utilities should go from -0.5 (the worst) to 0.5 (the best).
def utilities(fitness):
    return np.zeros(len(fitness))


# %% ranks_not_divided loses 8.2
# Leaves out the division of the ranks by n - 1.
def utilities(fitness):
    return np.argsort(np.argsort(fitness, kind="stable")) - 0.5


# %% one_subtracted loses 8.2
# Subtracts 1 from the divided ranks instead of 0.5.
def utilities(fitness):
    return np.argsort(np.argsort(fitness, kind="stable")) / (len(fitness) - 1) - 1


# %% middle_rank_subtracted loses 8.2
# Subtracts the half of n - 1 instead of 0.5 after the division.
def utilities(fitness):
    n = len(fitness)
    return np.argsort(np.argsort(fitness, kind="stable")) / (n - 1) - (n - 1) / 2


# %% ranks_around_zero loses 8.2
# Subtracts the half of n - 1 from the ranks without dividing them by n - 1.
def utilities(fitness):
    n = len(fitness)
    return np.argsort(np.argsort(fitness, kind="stable")) - (n - 1) / 2


# %% divided_by_parameters loses 8.3
# Divides the sum by the number of parameters instead of by 2 * samplesize.
# -     return weights @ samples / len(utilities)
# +     return weights @ samples / samples.shape[1]


# %% one_candidate_less loses 8.3
# Divides the sum by 2 * samplesize - 1 instead of by 2 * samplesize.
# -     return weights @ samples / len(utilities)
# +     return weights @ samples / (len(utilities) - 1)


# %% root_of_the_number loses 8.3
# Divides the sum by the root of 2 * samplesize instead of by 2 * samplesize itself.
# -     return weights @ samples / len(utilities)
# +     return weights @ samples / len(utilities) ** 0.5


# %% weights_without_signs loses 8.3
# Takes the absolute values of the differences of utilities, but the weight of a sample that points downhill should be negative.
# -     weights = utilities[0::2] - utilities[1::2]
# +     weights = np.abs(utilities[0::2] - utilities[1::2])


# %% squared_weights loses 8.3
# Takes the squares of the differences of utilities as weights instead of the differences.
# -     weights = utilities[0::2] - utilities[1::2]
# +     weights = (utilities[0::2] - utilities[1::2]) ** 2


# %% weights_of_one loses 8.3
# Gives all samples the same weight instead of the difference of their utilities.
# -     weights = utilities[0::2] - utilities[1::2]
# +     weights = np.ones(len(samples))


# %% samples_backwards loses 8.3
# Takes the samples in reverse order, but weight b should multiply samples[b].
# -     return weights @ samples / len(utilities)
# +     return weights @ samples[::-1] / len(utilities)


# %% a_row_for_each_sample loses 8.3
# Returns a row for each sample, but the weighted samples should be added up.
# -     return weights @ samples / len(utilities)
# +     return weights[:, None] * samples / len(utilities)


# %% a_number_for_each_sample loses 8.3
# Adds up over the parameters, but over the samples is asked for: one number for each parameter.
# -     return weights @ samples / len(utilities)
# +     return (weights[:, None] * samples).sum(axis=1) / len(utilities)


# %% pull_without_decay loses 8.4
# Adds 0.005 * centre for wdecay 0, too, but there should be no pull.
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: centre, 1: centre, 2: np.sign(centre)}[wdecay]


# %% one_pull_for_all loses 8.4
# Takes the mean of the centre for the pull of all parameters, but each should have a pull of its own.
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: 0, 1: np.mean(centre), 2: np.sign(centre)}[wdecay]


# %% pull_in_size_alone loses 8.4
# Takes the absolute values of the centre for the pull of wdecay 1, so that parameters below 0 go away from 0.
# -     pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
# +     pull = {0: 0, 1: np.abs(centre), 2: np.sign(centre)}[wdecay]


# %% deviations_averaged loses 8.5
# Averages the square of d - m in v instead of the square of d.
# -     v = 0.999 * v + 0.001 * d**2
# +     v = 0.999 * v + 0.001 * (d - m) ** 2


# %% factor_squared loses 8.5
# Squares 0.001 * d in v, but 0.001 should multiply the square of d.
# -     v = 0.999 * v + 0.001 * d**2
# +     v = 0.999 * v + (0.001 * d) ** 2


# %% signs_averaged loses 8.5
# Averages the sign of d in m instead of d itself.
# -     m = 0.9 * m + 0.1 * d
# +     m = 0.9 * m + 0.1 * np.sign(d)


# %% step_by_the_sign loses 8.5
# Makes the step with the sign of m instead of the corrected m.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = np.sign(m) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)


# %% step_by_the_square loses 8.5
# Makes the step with the square of d instead of its mean v.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(d**2) + 1e-8)


# %% step_with_the_mean_of_v loses 8.5
# Makes the step with the mean of v over all parameters instead of each one's own v.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v.mean() / (1 - 0.999**t)) + 1e-8)


# %% corrections_exchanged loses 8.5
# Exchanges the corrections, but m should be divided by 1 - 0.9^t and v by 1 - 0.999^t.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.999**t)) / (np.sqrt(v / (1 - 0.9**t)) + 1e-8)


# %% powers_for_corrections loses 8.5
# Divides m by 0.9^t and v by 0.999^t instead of by 1 - 0.9^t and 1 - 0.999^t.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / 0.9**t) / (np.sqrt(v / 0.999**t) + 1e-8)


# %% epsilon_of_a_millionth loses 8.5
# Adds 1e-6 to the root instead of 1e-8.
# -     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
# +     step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-6)


# %% shrinking_stepsize loses 8.5
# Divides the step by t, too, but stepsize should stay the same.
# -     return centre - stepsize * step, m, v
# +     return centre - stepsize / t * step, m, v


# %% drawn_transposed loses 8.6
# Draws the samples with the shape (n, samplesize) and transposes them instead of drawing the shape (samplesize, n).
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +         samples = rng.standard_normal((len(centre), samplesize)).T


# %% uniform_samples loses 8.6
# Draws uniform numbers instead of Gaussian ones (standard_normal).
# -         samples = rng.standard_normal((samplesize, len(centre)))
# +         samples = rng.uniform(-1, 1, (samplesize, len(centre)))


# %% mean_of_the_utilities loses 8.6
# Keeps the mean of the utilities in the history, which is always 0, instead of the mean of the fitness.
# -         history.append(float(np.mean(fitness)))
# +         history.append(float(np.mean(utilities(fitness))))


# %% t_of_the_end loses 8.6
# Gives adam the number of all generations as t instead of generation + 1.
# -         centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
# +         centre, m, v = adam(centre, d, m, v, generations, stepsize)


# %% rises_for_falls loses 8.7
# Takes the largest rise instead of the largest fall.
# -     falls = np.maximum.accumulate(curve) - curve
# +     falls = curve - np.minimum.accumulate(curve)


# %% sum_of_the_falls loses 8.7
# Adds up the falls from value to value for the drop instead of taking the largest fall.
# -     drop = float(falls[bottom] / height) if height > 0 else 0.0
# +     drop = float(-np.minimum(np.diff(curve), 0).sum() / height) if height > 0 else 0.0


# %% divided_by_the_maximum loses 8.7
# Divides the fall by the highest value of the curve instead of by max - min.
# -     height = curve.max() - curve.min()
# +     height = np.abs(curve.max())


# %% divided_by_the_deviation loses 8.7
# Divides the fall by the standard deviation of the curve instead of by max - min.
# -     height = curve.max() - curve.min()
# +     height = curve.std()


# %% ends_for_the_height loses 8.7
# Divides the fall by the distance of the last value from the first one instead of by max - min.
# -     height = curve.max() - curve.min()
# +     height = np.abs(curve[-1] - curve[0])


# %% place_before_the_bottom loses 8.7
# Takes the place before the bottom for the peak instead of the place of the highest value up to the bottom.
# -     peak = int(np.argmax(curve[: bottom + 1]))
# +     peak = max(bottom - 1, 0)


# %% values_for_places loses 8.7
# Returns the heights at the peak and the bottom instead of their indices.
# -     return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
# +     return {"drop": drop, "bottom": curve[bottom], "peak": curve[peak], "verdict": verdict}


# %% verdicts_reversed loses 8.7
# Calls small drops severe and large ones monotonic instead of the other way round.
# -     verdict = "severe regressions"
# -     if drop <= 0.1:
# -         verdict = "monotonic"
# +     verdict = "monotonic"
# +     if drop <= 0.1:
# +         verdict = "severe regressions"


# %% windows_apart loses 8.7
# Takes windows that do not overlap, but each should begin one place after the one before.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     return np.convolve(curve, np.full(width, 1 / width), mode="valid")[::width]


# %% means_from_the_beginning loses 8.7
# Takes the mean of all numbers from the beginning on instead of that of the last width numbers.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     return (np.cumsum(curve) / np.arange(1, len(curve) + 1))[width - 1 :]


# %% divided_by_one_less loses 8.7
# Divides the sums by width - 1 instead of by width.
# -     return np.convolve(curve, np.full(width, 1 / width), mode="valid")
# +     return np.convolve(curve, np.full(width, 1 / max(width - 1, 1)), mode="valid")
