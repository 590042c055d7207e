"""Mistakes of beginners in exercise 13; test_mistakes.py says what stands where."""

MISTAKES = [
    ("13.1", "gae_lambda forgotten", "gae_lambda is left out", "mutant lambda_forgotten"),
    ("13.1", "ends of episodes forgotten", r"Ends of episodes on the way .* are left out", "mutant ends_ignored"),
    ("13.1", "last_values forgotten", r"\(last_values\) is left out", "mutant last_value_forgotten"),
    ("13.2", "the advantages not normalised", "not normalised", "mutant not_normalised"),
    ("13.2", "the sign of the loss", "Right but for the sign", "mutant sign_of_the_loss"),
    ("13.3", "half the square", "half of what was expected", "mutant half_the_square"),
    ("13.3", "no clipping", "is not clipped", "mutant value_never_clipped"),
    ("13.4", "the logarithm to the base 2", "in bits", "mutant entropy_in_bits"),
    ("13.5", "one update too many", "one more than expected", "mutant stops_after_the_update"),
    ("13.6", "the entropy added", "The entropy is added", "mutant entropy_is_punished"),
]  # fmt: skip
