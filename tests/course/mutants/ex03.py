"""Wrong solutions of exercise 3; building.py describes how a case is written."""


# %% clones loses 3.1
# Gives all individuals the same weights, but each individual should have random weights of its own.
# says: this
def initial_population(popsize, nbiases, nweights, seed):
    weights = 0.1 * np.random.default_rng(seed).standard_normal(nweights)
    return np.tile(np.concatenate([np.zeros(nbiases), weights]), (popsize, 1))


# %% seed_ignored loses 3.1
# Ignores the seed: the same seed gives another population in each call, but it should give the same one.
# says: this
def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng()
    weights = 0.1 * rng.standard_normal((popsize, nweights))
    return np.hstack([np.zeros((popsize, nbiases)), weights])


# %% ten_times_as_large loses 3.1
# Draws weights with standard deviation 1 instead of 0.1.
# says: this
def initial_population(popsize, nbiases, nweights, seed):
    weights = np.random.default_rng(seed).standard_normal((popsize, nweights))
    return np.hstack([np.zeros((popsize, nbiases)), weights])


# %% uniform_weights loses 3.1
# Draws weights and biases from a uniform distribution, but the weights should be Gaussian and the biases 0.
def initial_population(popsize, nbiases, nweights, seed):
    limit = 0.1 * np.sqrt(3)
    return np.random.default_rng(seed).uniform(-limit, limit, (popsize, nbiases + nweights))


# %% ranks_instead_of_numbers loses 3.2
# Returns the place of each individual in the ranking, but the numbers of the individuals, the best first, are asked for.
# says: this
def rank(fitness):
    return np.argsort(np.argsort(-np.asarray(fitness), kind="stable"), kind="stable")


def next_population(population, fitness, mutrate, rng):
    order = np.argsort(-fitness, kind="stable")
    half = len(order) // 2
    following = population.copy()
    noise = rng.standard_normal((half, population.shape[1]))
    following[order[half:]] = population[order[:half]] + mutrate * noise
    return following


def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    best, best_fitness, history = population[0], -np.inf, []
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        winner = int(np.argmax(fitness))
        history.append(float(fitness[winner]))
        if fitness[winner] > best_fitness:
            best, best_fitness = population[winner].copy(), float(fitness[winner])
        population = next_population(population, fitness, mutrate, rng)
    return {"best": best, "fitness": best_fitness, "history": history, "population": population}


def train(environment, seed):
    robot = Robot(environment)
    population = initial_population(40, robot.nbiases, robot.nweights, seed)
    generations, mutrate = (40, 0.1) if "CartPole" in environment else (1000, 0.4)
    population = evolve(robot.evaluate, population, generations, mutrate, seed)["population"]
    return population[np.argmax(robot.evaluate(population, seed + 10_000, episodes=20))]


# %% unstable_ranking loses 3.2
# Puts the one with the higher number first if two individuals are equal, but the one with the lower number should come first.
def rank(fitness):
    return np.argsort(fitness, kind="stable")[::-1]


# %% worst_first loses 3.2
# Puts the worst individual first, but the best should come first.
# says: this
def rank(fitness):
    return np.argsort(fitness, kind="stable")


# %% asks_the_tool loses 3.3
# Uses the tool's own steady-state strategy (SSS), but selection and mutation should be your own code.
def next_population(population, fitness, mutrate, rng):
    from botschool.evolution.algorithms.sss import SSS, SSSConfig

    config = SSSConfig(popsize=len(population), mutrate=mutrate)
    algorithm = SSS(config, lambda i: population[i], int(rng.integers(2**31)))
    algorithm.tell(np.asarray(fitness))
    return algorithm.population


# %% colon_missing loses 3.3
# A colon is missing.
# says: expected ':'[\s\S]*next_population cannot be read
# - ) -> np.ndarray:
# -     """Return the population after selection and mutation, as a new array of the same shape.
# + ) -> np.ndarray
# +     """Return the population after selection and mutation, as a new array of the same shape.


# %% copies_of_the_best loses 3.3
# Makes all mutated copies from the best individual, but each individual of the better half should be copied once.
# -     half = len(population) // 2
# -     best, worst = ranking[:half], ranking[half:]
# +     half = len(population) // 2
# -     following[worst] = population[best] + mutrate * noise
# +     following[ranking[half:]] = population[ranking[0]] + mutrate * noise


# %% everyone_mutates loses 3.3
# Adds noise to the better half, too, but only the copies should get noise.
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    following = population.copy()
    following[ranking[half:]] = population[ranking[:half]]
    return following + mutrate * rng.standard_normal(population.shape)


# %% in_place loses 3.3
# Changes the array `population` that it is given, but should return a new array.
# says: this
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    noise = rng.standard_normal((half, population.shape[1]))
    population[ranking[half:]] = population[ranking[:half]] + mutrate * noise
    return population


# %% one_noise_for_all loses 3.3
# Adds the same noise to all copies, but each copy should get random numbers of its own.
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    following = population.copy()
    noise = rng.standard_normal(population.shape[1])
    following[ranking[half:]] = population[ranking[:half]] + mutrate * noise
    return following


# %% best_of_the_last_generation loses 3.4
# Returns the best of the last generation and its fitness, but the best of all generations is asked for.
# says: this
def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    history = []
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        winner = rank(fitness)[0]
        best = population[winner].copy()
        history.append(float(fitness[winner]))
        population = next_population(population, fitness, mutrate, rng)
    return {"best": best, "fitness": history[-1], "history": history, "population": population}


# %% same_noise_each_generation loses 3.4
# Adds the same noise in each generation, but each generation should get new random numbers from one generator, made before the loop.
# says: this
def evolve(evaluate, population, generations, mutrate, seed):
    best, best_fitness, history = population[0], -np.inf, []
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        winner = rank(fitness)[0]
        history.append(float(fitness[winner]))
        if fitness[winner] > best_fitness:
            best, best_fitness = population[winner].copy(), float(fitness[winner])
        population = next_population(population, fitness, mutrate, np.random.default_rng(seed))
    return {"best": best, "fitness": best_fitness, "history": history, "population": population}


# %% lucky_climber loses 3.5
# Keeps a variation only if its fitness is higher than any met before, but the better of the two individuals of each generation should be kept.
def hill_climb(evaluate, start, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    best, highest, history = start, -np.inf, []
    population = np.array([start, start])
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        history.append(float(fitness.max()))
        if fitness.max() > highest:
            best, highest = population[fitness.argmax()].copy(), float(fitness.max())
        population = np.array([best, best + mutrate * rng.standard_normal(len(start))])
    return {"best": best, "fitness": highest, "history": history, "population": population}


# %% population_deviation loses 3.6
# Divides by the number of replications instead of that number minus one.
# says: this
# -     histories = np.array([run["history"] for run in runs])
# -     many = len(seeds) > 1
# +     histories = np.array([run["history"] for run in runs])
# -         "deviation": histories.std(axis=0, ddof=1) if many else np.zeros(histories.shape[1]),
# +         "deviation": histories.std(axis=0),


# %% least_squares loses 3.7
# Computes the parameters from rules made by hand without calling robot.evaluate, but they should be evolved.
def train(environment, seed):
    rng, fits = np.random.default_rng(2), []
    for _ in range(1 if environment == "CartPole-v0" else 1500):
        if environment == "CartPole-v0":
            seen = rng.normal(size=(600, 4)) * (1, 1, 0.2, 1)
            lean = seen[:, 2] + 0.5 * seen[:, 3]
            wanted = np.stack([-lean, lean], axis=1)
            hidden, biases = 0.1 * rng.normal(size=(10, 4)), np.zeros(10)
        else:
            angle, speed = rng.uniform((-np.pi, -8), (np.pi, 8), (600, 2)).T
            high = rng.random(600) < 0.4
            angle = np.where(high, rng.uniform(-1, 1, 600), angle)
            speed = np.where(high, rng.uniform(-3, 3, 600), speed)
            seen = np.stack([np.cos(angle), np.sin(angle), speed], axis=1)
            energy = speed**2 / 2 + 15 * (np.cos(angle) - 1)
            swing, hold = -2 * np.sign(speed) * np.sign(energy), -12 * angle - 3 * speed
            torque = np.where(np.abs(angle + speed / 4) < 0.6, hold, swing)
            wanted = np.clip(torque, -4, 4)[:, None]
            hidden, biases = rng.normal(size=(10, 3)) * (1.5, 3, 1), rng.normal(size=10)
        values = np.column_stack([np.tanh(seen @ hidden.T + biases), np.ones(600)])
        readout = np.linalg.lstsq(values, wanted, rcond=None)[0]
        error = np.mean((values @ readout - wanted) ** 2)
        parts = biases, readout[-1], hidden.ravel(), readout[:-1].T.ravel()
        fits.append((error, np.concatenate(parts)))
    parameters = min(fits, key=lambda fit: fit[0])[1]
    return parameters + 0.001 * np.random.default_rng(seed).standard_normal(len(parameters))


# %% nothing_learnt loses 3.7
# Returns a random controller without calling robot.evaluate, but the controller should be evolved.
def train(environment, seed):
    robot = Robot(environment)
    return initial_population(1, robot.nbiases, robot.nweights, seed)[0]


# %% same_controller_always loses 3.7
# Ignores the seed: every seed gives the same controller, but another seed should give a different one.
_evolve_and_choose = train


def train(environment, seed):
    return _evolve_and_choose(environment, 1)


# %% written_down loses 3.7
# Returns parameters that are written down in the file, plus a little noise, but they should be evolved in each call.
TENTHS = {
    "CartPole-v0": """
        1 2 -1 -2 1 2 -2 0 1 0 0 0 4 2 -3 -1 1 0 -3 -1 0 0 1 1 1 -1 0 -1 -3 0 -2 -3 -1 1 2
        1 -1 0 -2 0 2 2 3 1 0 -1 3 -3 -4 1 -1 -2 0 2 -4 2 1 0 -1 -3 3 -2 0 0 0 0 -2 0 -4 3
        1 3
    """,
    "Pendulum-v1": """
        -18 -20 -11 -66 -22 -5 22 18 22 -70 -10 -15 15 38 -11 10 14 32 41 32 63 -44 -17
        -30 -34 -6 2 -11 9 -2 -13 7 -18 10 -29 -26 -22 32 61 21 17 35 2 4 60 -23 -19 -8 5
        47 -51
    """,
}


def train(environment, seed):
    parameters = np.array(TENTHS[environment].split(), dtype=float) / 10
    return parameters + 0.001 * np.random.default_rng(seed).standard_normal(len(parameters))


# %% neighbours_share_individuals loses 3.1
# Draws individual i from seed + i, so neighbouring seeds share individuals, but two seeds should have none in common.
# says: this
def initial_population(popsize, nbiases, nweights, seed):
    rows = [np.random.default_rng(seed + i).standard_normal(nweights) for i in range(popsize)]
    return np.hstack([np.zeros((popsize, nbiases)), 0.1 * np.array(rows)])


# %% plain_argsort loses 3.2
# Ranks in rising order, as np.argsort does, so that the worst comes first.
# says: this
def rank(fitness):
    return np.argsort(fitness)


# %% argsort_without_stable loses 3.2
# Keeps the order of equals only if they are few, as np.argsort does without kind="stable", but the one with the lower number should always come first.
def rank(fitness):
    return np.argsort(-np.asarray(fitness))


# %% selects_by_a_threshold loses 3.3
# Keeps every individual whose fitness is at least the middle value. If some are equal, these can be more than half, but exactly half should stay.
# says: this
def next_population(population, fitness, mutrate, rng):
    middle = np.sort(fitness)[len(fitness) // 2]
    parents, following = population[fitness >= middle], population.copy()
    for place, i in enumerate(np.flatnonzero(fitness < middle)):
        following[i] = parents[place] + mutrate * rng.standard_normal(population.shape[1])
    return following


# %% best_fitness_begins_at_zero loses 3.4
# Begins with a best fitness of 0, so a negative fitness never becomes the best, but it should begin with a value that everybody beats.
# -     best, best_fitness, history = population[0], -np.inf, []
# +     best, best_fitness, history = population[0], 0, []


# %% own_mutation_rate loses 3.4
# Uses 0.1 as the mutation rate instead of the argument mutrate.
# -         population = next_population(population, fitness, mutrate, rng)
# +         population = next_population(population, fitness, 0.1, rng)


# %% loop_without_seed loses 3.4
# Ignores the seed when it makes the generator: the same arguments give another run each time, but they should give the same one.
# says: this
# -     rng = np.random.default_rng(seed)
# -     best, best_fitness, history = population[0], -np.inf, []
# +     rng = np.random.default_rng()
# +     best, best_fitness, history = population[0], -np.inf, []


# %% loop_with_one_seed loses 3.4
# Uses the same random numbers for every seed, but the generator should be made from the seed.
# says: this
# -     rng = np.random.default_rng(seed)
# -     best, best_fitness, history = population[0], -np.inf, []
# +     rng = np.random.default_rng(0)
# +     best, best_fitness, history = population[0], -np.inf, []


# %% climber_with_own_rate loses 3.5
# Uses 0.1 as the mutation rate instead of the argument mutrate.
# -     return evolve(evaluate, np.array([start, start]), generations, mutrate, seed)
# +     return evolve(evaluate, np.array([start, start]), generations, 0.1, seed)


# %% runs_each_twice loses 3.6
# Runs each experiment twice, but each should be run once.
# says: this
# -         "best": [run["fitness"] for run in runs],
# +         "best": [experiment(seed)["fitness"] for seed in seeds],


# %% one_run_and_noise loses 3.7
# Evolves with seed 1 whatever the seed is and adds a little noise to the result, but the whole evolution should follow from the seed.
# says: should return a candidate that it gave
_evolve_and_choose = train


def train(environment, seed):
    parameters = _evolve_and_choose(environment, 1)
    return parameters + 0.001 * np.random.default_rng(seed).standard_normal(len(parameters))


# %% one_run_and_its_relatives loses 3.7
# Evolves with seed 1 whatever the seed is and chooses among slightly changed copies, but the whole evolution should follow from the seed.
# says: another seed gives nearly the same parameters
_evolve_and_choose = train


def train(environment, seed):
    parameters, rng = _evolve_and_choose(environment, 1), np.random.default_rng(seed)
    near = parameters + 0.001 * rng.standard_normal((10, len(parameters)))
    return near[Robot(environment).evaluate(near, seed, episodes=100).argmax()]


# %% training_without_seed loses 3.7
# Ignores the seed: the same seed gives another controller in each call, but it should give the same one.
_evolve_and_choose = train


def train(environment, seed):
    return _evolve_and_choose(environment, int(np.random.default_rng().integers(10**6)))


# %% zero_is_no_seed loses 3.1
# Draws other numbers in each call with seed 0, but 0 is a seed like any other.
# -     rng = np.random.default_rng(seed)
# -     biases = np.zeros((popsize, nbiases))
# +     rng = np.random.default_rng(seed or None)
# +     biases = np.zeros((popsize, nbiases))


# %% loop_without_seed_zero loses 3.4
# Makes another run in each call with seed 0, but 0 is a seed like any other.
# -     rng = np.random.default_rng(seed)
# -     best, best_fitness, history = population[0], -np.inf, []
# +     rng = np.random.default_rng(seed or None)
# +     best, best_fitness, history = population[0], -np.inf, []


# %% zeros_do_not_mutate loses 3.3
# Adds no noise to parameters that are 0, but every parameter of a copy should get noise.
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[best] + mutrate * noise * (population[best] != 0)


# %% stops_when_solved loses 3.4
# Stops early once a high fitness is reached, but should always do all generations.
# -         population = next_population(population, fitness, mutrate, rng)
# +         population = next_population(population, fitness, mutrate, rng)
# +         if best_fitness >= 195:
# +             break


# %% begins_at_minus_2000 loses 3.4
# Begins with a best fitness of -2000, so a lower fitness never becomes the best, but it should begin with a value that everybody beats.
# -     best, best_fitness, history = population[0], -np.inf, []
# +     best, best_fitness, history = population[0], -2000.0, []


# %% rounded_ranks loses 3.2
# Takes values that differ only a little for equal, as after rounding, but the exact fitness should decide.
# -     return np.argsort(-np.asarray(fitness), kind="stable")
# +     return np.argsort(-np.round(fitness, 2), kind="stable")


# %% evolves_in_place loses 3.4
# Changes the array `population` that it is given, but should leave it as it is.
# -         population = next_population(population, fitness, mutrate, rng)
# +         population[:] = next_population(population, fitness, mutrate, rng)


# %% mutation_fades loses 3.4
# Makes the mutations smaller from generation to generation, but mutrate should stay the same.
# -         population = next_population(population, fitness, mutrate, rng)
# +         population = next_population(population, fitness, mutrate * 0.99**generation, rng)


# %% parents_by_lot loses 3.3
# Draws the parents of the copies at random, so some are copied twice and some never, but each of the better half should be copied once.
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[rng.choice(best, half)] + mutrate * noise


# %% climber_begins_apart loses 3.5
# Adds noise to the second individual at the start, but both should begin as copies of start.
# -     return evolve(evaluate, np.array([start, start]), generations, mutrate, seed)
# +     noise = mutrate * np.random.default_rng(seed).standard_normal(len(start))
# +     return evolve(evaluate, np.array([start, start + noise]), generations, mutrate, seed)


# %% sorted_replications loses 3.6
# Returns "best" in falling order instead of the order of the seeds.
# -         "best": [run["fitness"] for run in runs],
# +         "best": sorted((run["fitness"] for run in runs), reverse=True),


# %% running_maximum loses 3.4
# Records the highest fitness so far in the history instead of the highest fitness of each generation.
# -         history.append(float(fitness[winner]))
# -         if fitness[winner] > best_fitness:
# -             best, best_fitness = population[winner].copy(), float(fitness[winner])
# +         if fitness[winner] > best_fitness:
# +             best, best_fitness = population[winner].copy(), float(fitness[winner])
# +         history.append(best_fitness)


# %% one_generation_more loses 3.4
# Does one generation too many: it calls evaluate generations + 1 times.
# -     for generation in range(generations):
# -         fitness = evaluate(population, seed + generation)
# -         winner = rank(fitness)[0]
# +     for generation in range(generations + 1):
# +         fitness = evaluate(population, seed + generation)
# +         winner = rank(fitness)[0]


# %% history_kept loses 3.4
# Continues the history of earlier calls, but each call should begin with an empty history.
_evolve_anew = evolve


def evolve(evaluate, population, generations, mutrate, seed, history=[]):  # noqa: B006
    found = _evolve_anew(evaluate, population, generations, mutrate, seed)
    history += found["history"]
    return found | {"history": history}


# %% uses_up_the_seeds loses 3.6
# Empties the list `seeds` that it is given, but should leave it as it is.
# -     runs = [experiment(seed) for seed in seeds]
# -     histories = np.array([run["history"] for run in runs])
# -     many = len(seeds) > 1
# +     runs = []
# +     while seeds:
# +         runs.append(experiment(seeds.pop(0)))
# +     histories = np.array([run["history"] for run in runs])
# +     many = len(runs) > 1


# %% rate_of_a_variance loses 3.1
# Takes 0.1 for the variance of the weights, but it should be their standard deviation.
# says: this
# -     weights = 0.1 * rng.standard_normal((popsize, nweights))
# +     weights = np.sqrt(0.1) * rng.standard_normal((popsize, nweights))


# %% positive_weights loses 3.1
# Makes all weights positive, but about half of them should be negative.
# says: this
# -     weights = 0.1 * rng.standard_normal((popsize, nweights))
# +     weights = 0.1 * np.abs(rng.standard_normal((popsize, nweights)))


# %% cached_population loses 3.1
# Returns the same array again if it is called with the same arguments, but each call should make a new array.
# says: this
_made, _fresh = {}, initial_population


def initial_population(popsize, nbiases, nweights, seed):
    key = (popsize, nbiases, nweights, seed)
    if key not in _made:
        _made[key] = _fresh(*key)
    return _made[key]


# %% spread_by_size loses 3.1
# Divides the weights by the root of nweights, but their standard deviation should be 0.1 for any nweights.
# says: this
# -     weights = 0.1 * rng.standard_normal((popsize, nweights))
# +     weights = rng.standard_normal((popsize, nweights)) / np.sqrt(nweights)


# %% rate_as_probability loses 3.3
# Takes mutrate for the probability that a parameter changes, but it should be the standard deviation of the noise of every parameter.
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[best] + noise * (rng.random(noise.shape) < mutrate)


# %% rate_as_variance loses 3.3
# Takes mutrate for the variance of the noise, but it should be its standard deviation.
# says: this
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[best] + np.sqrt(mutrate) * noise


# %% clipped_parameters loses 3.3
# Limits all parameters to the range from -5 to 5, but nothing should limit them.
# -     return following
# +     return np.clip(following, -5, 5)


# %% best_is_a_view loses 3.4
# Returns what stands in the best individual's row after the last generation, but should return a copy of that individual as it was.
# says: this
# -     best, best_fitness, history = population[0], -np.inf, []
# +     population = population.copy()
# +     best, best_fitness, history = population[0], -np.inf, []
# -             best, best_fitness = population[winner].copy(), float(fitness[winner])
# -         population = next_population(population, fitness, mutrate, rng)
# +             best, best_fitness = population[winner], float(fitness[winner])
# +         population[:] = next_population(population, fitness, mutrate, rng)


# %% mean_history loses 3.4
# Records the mean fitness of each generation in the history instead of the highest.
# says: this
# -         history.append(float(fitness[winner]))
# +         history.append(float(np.mean(fitness)))


# %% population_before_the_last loses 3.4
# Returns the population of the last evaluation, but selection and mutation should follow this evaluation, too.
# says: this
# -         population = next_population(population, fitness, mutrate, rng)
# -     return {"best": best, "fitness": best_fitness, "history": history, "population": population}
# +         last = population
# +         population = next_population(population, fitness, mutrate, rng)
# +     return {"best": best, "fitness": best_fitness, "history": history, "population": last}


# %% best_put_back loses 3.4
# Puts the best individual of all generations into each new population, but it should hold only the better half and mutated copies.
# -         population = next_population(population, fitness, mutrate, rng)
# +         population = next_population(population, fitness, mutrate, rng)
# +         population[rank(fitness)[-1]] = best


# %% seed_of_each_generation loses 3.4
# Makes a new generator from seed + g in each generation, so neighbouring seeds share noise, but one generator should be made from seed before the loop.
# says: this
# -         fitness = evaluate(population, seed + generation)
# +         rng = np.random.default_rng(seed + generation)
# +         fitness = evaluate(population, seed + generation)


# %% running_best loses 3.6
# Uses the best fitness so far of each replication, but the highest fitness of each generation is asked for.
# says: this
# -     histories = np.array([run["history"] for run in runs])
# +     histories = np.maximum.accumulate([run["history"] for run in runs], axis=1)


# %% last_fitness loses 3.6
# Returns the last value of each "history" as "best" instead of the "fitness" of each run.
# says: this
# -         "best": [run["fitness"] for run in runs],
# +         "best": [run["history"][-1] for run in runs],


# %% medians loses 3.6
# Takes the median of the replications instead of their mean.
# says: this
# -         "mean": histories.mean(axis=0),
# +         "mean": np.median(histories, axis=0),


# %% seeds_counted loses 3.6
# Runs the experiment with seeds[0], seeds[0] + 1, ... instead of the seeds in the list.
# says: this
# -     runs = [experiment(seed) for seed in seeds]
# +     runs = [experiment(seeds[0] + i) for i in range(len(seeds))]


# %% best_after_selection loses 3.4
# Takes row 0 of the next population for the best individual, but the best of the population that was evaluated is asked for.
# says: this
# -         if fitness[winner] > best_fitness:
# -             best, best_fitness = population[winner].copy(), float(fitness[winner])
# -         population = next_population(population, fitness, mutrate, rng)
# +         population = next_population(population, fitness, mutrate, rng)
# +         if fitness[winner] > best_fitness:
# +             best, best_fitness = population[0].copy(), float(fitness[winner])


# %% mean_over_the_generations loses 3.6
# Takes mean and deviation over the generations of each run instead of over the replications.
# says: this
# -         "mean": histories.mean(axis=0),
# -         "deviation": histories.std(axis=0, ddof=1) if many else np.zeros(histories.shape[1]),
# +         "mean": histories.mean(axis=1),
# +         "deviation": histories.std(axis=1, ddof=1),


# %% values_in_order loses 3.2
# Returns the sorted fitness values instead of the numbers of the individuals.
# says: this
# -     return np.argsort(-np.asarray(fitness), kind="stable")
# +     return np.sort(fitness)[::-1]


# %% root_before_dividing loses 3.6
# Takes the root before it divides by the number of replications minus one, but should divide first.
# says: this
# -         "deviation": histories.std(axis=0, ddof=1) if many else np.zeros(histories.shape[1]),
# +         "deviation": histories.std(axis=0) * len(seeds) ** 0.5 / max(1, len(seeds) - 1),


# %% above_the_median loses 3.3
# Keeps every individual whose fitness is at least the median. If some are equal, these can be more than half, but exactly half should stay.
# says: but an array of shape
def next_population(population, fitness, mutrate, rng):
    good = population[fitness >= np.median(fitness)]
    return np.vstack([good, good + mutrate * rng.standard_normal(good.shape)])


# %% squared_rate loses 3.3
# Squares mutrate, but mutrate itself should be the standard deviation of the noise.
# says: this
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[best] + mutrate**2 * noise


# %% a_single_run_divides_by_zero loses 3.6
# Returns NaN as the deviation of a single replication instead of 0.
# says: this
# -         "deviation": histories.std(axis=0, ddof=1) if many else np.zeros(histories.shape[1]),
# +         "deviation": histories.std(axis=0, ddof=1) if many else np.full(histories.shape[1], np.nan),


# %% best_from_the_last_row loses 3.4
# Takes the last row of the next population for the best individual, but the best of the population that was evaluated is asked for.
# says: this
# -         if fitness[winner] > best_fitness:
# -             best, best_fitness = population[winner].copy(), float(fitness[winner])
# -         population = next_population(population, fitness, mutrate, rng)
# +         population = next_population(population, fitness, mutrate, rng)
# +         if fitness[winner] > best_fitness:
# +             best, best_fitness = population[-1].copy(), float(fitness[winner])


# %% evaluates_the_variation_alone loses 3.5
# Evaluates only the variation and keeps the old fitness of the solution, but both should be evaluated in each generation.
_hill_climb_3 = hill_climb


def hill_climb(evaluate, *arguments, **options):
    kept = []

    def of_one(rows, seed):
        kept.append(evaluate(rows[1:], seed)[0])
        return np.array([kept[0], kept[-1]])

    return _hill_climb_3(of_one, *arguments, **options)


# %% returns_the_worst_of_the_last loses 3.7
# Returns the worst candidate of the last evaluation instead of the best.
# says: should return a controller that reaches
# -     return run["population"][rank(fitness)[0]]
# +     return run["population"][np.argsort(fitness)[0]]


# %% places_by_value loses 3.2
# Repeats the number of the first of several equal individuals, but each individual should come once.
# says: this
# -     return np.argsort(-np.asarray(fitness), kind="stable")
# +     values = list(fitness)
# +     return np.array([values.index(value) for value in sorted(values, reverse=True)])


# %% best_of_the_mean_curve loses 3.6
# Returns the highest value of the mean curve as "best" of every run, but the "fitness" of each run is asked for.
# says: this
# -         "best": [run["fitness"] for run in runs],
# +         "best": [float(histories.mean(axis=0).max()) for run in runs],


# %% deviation_over_the_generations loses 3.6
# Takes the deviation over the generations of each run instead of over the replications.
# says: this
# -         "deviation": histories.std(axis=0, ddof=1) if many else np.zeros(histories.shape[1]),
# +         "deviation": histories.std(axis=1, ddof=1),


# %% mean_of_all_values loses 3.6
# Returns one mean of all replications and generations, but a mean for each generation is asked for.
# says: this
# -         "mean": histories.mean(axis=0),
# +         "mean": float(histories.mean()),


# %% best_of_all_runs loses 3.6
# Returns only the fitness of the best run as "best", but the fitness of each run is asked for.
# says: this
# -         "best": [run["fitness"] for run in runs],
# +         "best": max(run["fitness"] for run in runs),


# %% noise_times_parameters loses 3.3
# Multiplies the noise by the parameters, too, but it should be multiplied only by mutrate.
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[best] * (1 + mutrate * noise)


# %% worse_half_stays loses 3.3
# Keeps the worse half and replaces the better half instead of the other way round.
# says: this
# -     best, worst = ranking[:half], ranking[half:]
# +     worst, best = ranking[:half], ranking[half:]


# %% noise_without_rate loses 3.3
# Adds noise with standard deviation 1, but its standard deviation should be mutrate.
# says: this
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = population[best] + noise


# %% evaluates_with_one_seed loses 3.4
# Calls evaluate with the same seed in every generation, but seed + g is asked for in generation g.
# -         fitness = evaluate(population, seed + generation)
# +         fitness = evaluate(population, seed)


# %% lowest_of_each_generation loses 3.4
# Records the lowest fitness of each generation in the history instead of the highest.
# says: this
# -         history.append(float(fitness[winner]))
# +         history.append(float(np.min(fitness)))


# %% climber_begins_at_zero loses 3.5
# Begins with zeros as the second individual, but both individuals should begin as copies of start.
# says: what evaluate was given|the first population
# -     return evolve(evaluate, np.array([start, start]), generations, mutrate, seed)
# +     return evolve(evaluate, np.array([start, 0 * start]), generations, mutrate, seed)


# %% last_rows_overwritten loses 3.3
# Overwrites the second half of the rows instead of the rows of the worse individuals.
# says: this
# -     following[worst] = population[best] + mutrate * noise
# +     following[half:] = population[best] + mutrate * noise


# %% swapping_sort loses 3.2
# Changes the order of equal individuals, as sorting by exchanges does, but the one with the lower number should come first.
# says: order in which they stand
import numpy as np


def rank(fitness):
    values = list(fitness)
    numbers = list(range(len(values)))
    for place in range(len(values)):
        top = place
        for other in range(place + 1, len(values)):
            if values[other] > values[top]:
                top = other
        values[place], values[top] = values[top], values[place]
        numbers[place], numbers[top] = numbers[top], numbers[place]
    return np.array(numbers)


# %% equals_left_out loses 3.2
# Leaves out all but the first of several equal individuals, but every individual should be ranked.
# says: this
# -     return np.argsort(-np.asarray(fitness), kind="stable")
# +     _, places = np.unique(-np.asarray(fitness), return_index=True)
# +     return places


# %% copies_are_no_copies loses 3.3
# Returns each mutated copy twice instead of the better half and its mutated copies: only the copies should get noise.
# says: this
import numpy as np


def next_population(population, fitness, mutrate, rng):
    survivors = len(population) // 2
    parents = population[rank(fitness)[:survivors]]
    children = parents
    children += rng.normal(0.0, mutrate, size=children.shape)
    return np.concatenate([parents, children])


# %% better_than_the_last_generation loses 3.4
# Replaces the best if a generation is better than the one before it, but only a generation better than all before should replace it.
# says: this
# -         if fitness[winner] > best_fitness:
# +         if generation == 0 or history[-1] > history[-2]:


# %% start_varied_again loses 3.5
# Varies start in each generation instead of the solution that was kept.
# says: this
import numpy as np


def hill_climb(evaluate, start, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    pair = np.array([start, start], dtype=float)
    top, top_fitness, history = np.array(start), -np.inf, []
    for g in range(generations):
        left, right = evaluate(pair, seed + g)
        if right > left:
            current, value = pair[1], right
        else:
            current, value = pair[0], left
        history.append(float(value))
        if value > top_fitness:
            top, top_fitness = current.copy(), float(value)
        pair = np.array([current, start + mutrate * rng.standard_normal(len(start))])
    return {"best": top, "fitness": top_fitness, "history": history, "population": pair}


# %% relatives_of_one_founder loses 3.1
# Draws one individual and adds noise to it to make the others, but each individual should be drawn on its own.
import numpy as np


def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng(seed)
    founder = rng.normal(0.0, 0.1, nweights)
    rows = [founder]
    while len(rows) < popsize:
        rows.append(founder + rng.normal(0.0, 0.1, nweights))
    return np.pad(np.array(rows), ((0, 0), (nbiases, 0)))


# %% reciprocals_sorted loses 3.2
# Ranks by 1 / fitness, which gives a wrong order if the values have different signs, but the fitness itself should decide.
# says: this
# -     return np.argsort(-np.asarray(fitness), kind="stable")
# +     with np.errstate(divide="ignore"):
# +         return np.argsort(1.0 / np.asarray(fitness, dtype=float), kind="stable")


# %% neighbours_in_pairs loses 3.3
# Compares each individual only with its neighbour, but the better half of the whole population should stay.
# says: this
import numpy as np


def next_population(population, fitness, mutrate, rng):
    result = np.array(population, dtype=float)
    for first in range(0, len(population), 2):
        second = first + 1
        if fitness[first] >= fitness[second]:
            winner, loser = first, second
        else:
            winner, loser = second, first
        epsilon = rng.standard_normal(population.shape[1])
        result[loser] = population[winner] + mutrate * epsilon
    return result


# %% old_mean_twice loses 3.6
# Adds up squared distances from the mean of the earlier replications, but distances from the mean of all replications are asked for.
# says: this
import numpy as np


def replicate(experiment, seeds):
    mean, squares, best = 0.0, 0.0, []
    for count, seed in enumerate(seeds, start=1):
        run = experiment(seed)
        best.append(run["fitness"])
        distance = np.array(run["history"], dtype=float) - mean
        mean = mean + distance / count
        squares = squares + distance**2 if count > 1 else np.zeros(len(distance))
    deviation = np.sqrt(squares / max(len(seeds) - 1, 1))
    return {"mean": mean, "deviation": deviation, "best": best}


# %% integers_for_weights loses 3.1
# Returns an array of integers, all 0, but the weights should be floats with standard deviation 0.1.
# -     biases = np.zeros((popsize, nbiases))
# -     weights = 0.1 * rng.standard_normal((popsize, nweights))
# -     return np.hstack([biases, weights])
# +     population = np.full((popsize, nbiases + nweights), 0)
# +     population[:, nbiases:] = 0.1 * rng.standard_normal((popsize, nweights))
# +     return population


# %% limited_parameters loses 3.3
# Limits the parameters of the copies to the range from -1 to 1, but nothing should limit them.
# says: nothing should limit
# -     following[worst] = population[best] + mutrate * noise
# +     following[worst] = np.clip(population[best] + mutrate * noise, -1, 1)
