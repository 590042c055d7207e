"""Mistakes of beginners in exercise 9; test_mistakes.py says what stands where."""

MISTAKES = [
    ("9.1", "progress is positive when the robot goes away", "sign: it is turned around", "mutant progress_backwards"),
    ("9.1", "the duration of a step forgotten", "duration of a step is left out", "mutant progress_in_metres"),
    ("9.1", "the fallen get 0", "The fallen get 0", "mutant fallen_get_nothing"),
    ("9.2", "sums over the joints instead of means", "a sum for a mean", "mutant electricity_of_sums"),
    ("9.2", "no absolute value", "Braking is paid for", "mutant electricity_with_sign"),
    ("9.2", "a Humanoid pays like the others", "Humanoid costs more", "mutant humanoid_pays_like_others"),
    ("9.2", "upper limits only", "lower limits count, too", "mutant upper_limits_only"),
    ("9.3", "the sum as a further component", r"does not have: \['reward'\]", "mutant components_with_the_sum"),
    ("9.4", "joints at their limits cost all robots", "cost this robot nothing", "mutant limits_for_all"),
    ("9.5", "the effort is a mean", "not their mean", "mutant mean_effort"),
]  # fmt: skip
