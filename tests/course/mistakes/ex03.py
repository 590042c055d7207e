"""Mistakes of beginners in exercise 3; test_mistakes.py says what stands where."""

MISTAKES = [
    ("3.1", "all individuals are the same random one", "some weights are equal", "mutant clones"),
    ("3.1", "ignores the seed", "other numbers when called again", "mutant seed_ignored"),
    ("3.1", "standard deviation 1 instead of 0.1", "have standard deviation 1.0",
     "def initial_population(popsize, nbiases, nweights, seed):\n"
     "    weights = np.random.default_rng(seed).standard_normal((popsize, nweights))\n"
     "    return np.hstack([np.zeros((popsize, nbiases)), weights])\n"),
    ("3.2", "the worst comes first", "reverse order",
     "def rank(fitness):\n    return np.argsort(fitness, kind='stable')\n"),
    ("3.2", "the place of each instead of the order", "argsort", "mutant ranks_instead_of_numbers"),
    ("3.3", "changes the population it was given", "changed the population that it was given",
     "mutant in_place"),
    ("3.3", "a colon is missing", r"expected ':'[\s\S]*next_population cannot be read",
     (") -> np.ndarray:\n    \"\"\"The population after", ") -> np.ndarray\n    \"\"\"The population after")),
    ("3.4", "the best of the last generation", "the last of 12 values, but the largest",
     "mutant best_of_the_last_generation"),
    ("3.4", "the generator is made anew in each generation", "is the same noise added again",
     "mutant same_noise_each_generation"),
    ("3.6", "divides by n", "n and n - 1 were mixed up", "mutant population_deviation"),
]  # fmt: skip
