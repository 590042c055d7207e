"""Mistakes of beginners in exercise 8; test_mistakes.py says what stands where."""

MISTAKES = [
    ("8.1", "noiseStdDev forgotten", "noiseStdDev is left out", "mutant noise_forgotten"),
    ("8.1", "all plus, then all minus", "All plus come before all minus", "mutant plus_before_minus"),
    ("8.2", "the order for the ranks", "An order and the places in it", "mutant order_for_ranks"),
    ("8.2", "the best gets the lowest utility", "reverse order", "mutant best_is_lowest"),
    ("8.3", "divides by samplesize", "twice what was expected", "mutant divided_by_samplesize"),
    ("8.3", "adds the two utilities", "utilities of a sample are added", "mutant summed_utilities"),
    ("8.4", "the decay pushes away from 0", "The decay has the wrong sign", "mutant decay_pushes_away"),
    ("8.5", "no bias correction", "The correction of m and v .* is left out", "mutant no_bias_correction"),
    ("8.6", "the best instead of the mean in the history", "fitness of the best candidate",
     "mutant history_of_the_best"),
    ("8.6", "no weight decay handed on", "not handed on", "mutant decay_forgotten"),
]  # fmt: skip
