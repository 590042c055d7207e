"""Mistakes of beginners in exercise 15; test_mistakes.py says what stands where."""

MISTAKES = [
    ("15.1", "poses not copied", r"Keep a copy each time \(.copy\(\)\)", "mutant poses_not_copied"),
    ("15.1", "what a network remembers goes on", "something kept from call to call", "mutant memory_goes_on"),
    ("15.2", "the fitness of the prey", "1 minus what was expected", "mutant fitness_of_the_prey"),
    ("15.2", "axes in another order", "right, but their shape is", "mutant individuals_together"),
    ("15.3", "the matrix of the prey not transposed", "transpose it", "mutant prey_not_turned"),
    ("15.3", "the prey want to be caught", "1 minus what was expected", "mutant prey_want_to_be_caught"),
    ("15.4", "ancient and future exchanged", "'future': are the two exchanged", "mutant competitors_in_rows"),
    ("15.5", "only those who do better count", "equal", "mutant equal_is_not_better"),
    ("15.6", "own part and that of the others exchanged", "'others': are the two exchanged", "mutant sides_mistaken"),
    ("15.8", "speed by step instead of by second", r"0\.1 times what was expected", "mutant per_step"),
]  # fmt: skip
