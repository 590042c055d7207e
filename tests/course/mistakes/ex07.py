"""Mistakes of beginners in exercise 7; test_mistakes.py says what stands where."""

MISTAKES = [
    ("7.1", "the angle from the cosine alone", "Right but for the sign", "mutant angle_of_cosine"),
    ("7.1", "cosine and sine exchanged", "Cosine and sine are exchanged", "mutant angle_mirrored"),
    ("7.2", "the seed is not used", "do not come from the seed", "mutant recording_unseeded"),
    ("7.2", "the state after the reset forgotten", "one too few|one is missing", "mutant recording_without_start"),
    ("7.3", "where the arrows end", "Where the arrows end is returned", "mutant arrows_to_ends"),
    ("7.3", "the long way around", "whole turns of 2 pi", "mutant arrows_leap"),
    ("7.4", "the grid without its end", "leaves out its upper ends", "mutant grid_without_end"),
    ("7.5", "candidates not copied", r"keep a copy of a candidate \(.copy\(\)\)", "mutant stages_not_copied"),
    ("7.5", "the best candidate so far", "the best candidate so far", "mutant keeps_best_so_far"),
    ("7.5", "the last generation forgotten", "The last one is missing", "mutant last_generation_missing"),
]  # fmt: skip
