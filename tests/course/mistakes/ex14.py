"""Mistakes of beginners in exercise 14; test_mistakes.py says what stands where."""

MISTAKES = [
    ("14.1", "the variations' settings forgotten", r"has params \{\} instead of", "mutant params_forgotten"),
    ("14.1", "the same seed again", r"has seed \d+ instead of", "mutant same_seed"),
    ("14.3", "the best episode", "It is the best episode", "mutant best_episode"),
    ("14.3", "a plain average at uneven steps", "unequally far apart", "mutant plain_average"),
    ("14.4", "the deviation divides by n", r"ddof=1", "mutant population_deviation"),
    ("14.4", "the gain over the worst", "over the worst variation", "mutant gain_over_the_worst"),
    ("14.5", "equal differences left out", "equal ones count, too", "mutant equal_ones_left_out"),
    ("14.5", "one direction only", "in one direction", "mutant one_sided"),
    ("14.7", "the numbers instead of their ranks", "not their ranks", "mutant values_for_ranks"),
    ("14.7", "the mean of all trainings", "not that of the variant", "mutant mean_of_all"),
]  # fmt: skip
