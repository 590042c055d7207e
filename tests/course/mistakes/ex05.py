"""Mistakes of beginners in exercise 5; test_mistakes.py says what stands where."""

MISTAKES = [
    ("5.1", "cuts sizes off instead of tanh", "sizes use tanh", "mutant cut_off_instead_of_tanh"),
    ("5.1", "all lengths, then all thicknesses", "take turns", "mutant lengths_before_thicknesses"),
    ("5.1", "the density varies by 80 %", "varies by 0.8, not", "mutant density_scaled_like_sizes"),
    ("5.2", "angles not cut off", "to be cut off at -1 and 1", "mutant angles_not_cut_off"),
    ("5.2", "the first limit for the lower one", "smaller one of the two", "mutant limits_as_they_come"),
    ("5.3", "a whole thickness to each side", "half of its thickness to each side", "mutant twice_as_thick"),
    ("5.3", "angles against the ground", "not that to the ground", "mutant angles_against_the_ground"),
    ("5.6", "the brain's own genotype changed", "work on a copy", "mutant no_copy"),
    ("5.7", "rows and columns exchanged", "transpose it", "mutant rows_and_columns_exchanged"),
    ("5.8", "brains and bodies exchanged", "'bodies': are the two exchanged", "mutant brains_and_bodies_exchanged"),
]  # fmt: skip
