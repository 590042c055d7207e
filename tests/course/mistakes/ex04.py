"""Mistakes of beginners in exercise 4; test_mistakes.py says what stands where."""

MISTAKES = [
    ("4.1", "angles from the cosine alone", "sign: that of negative values is lost", "mutant sign_lost"),
    ("4.1", "the two speeds exchanged", "This is speed2: are the two exchanged", "mutant speeds_swapped"),
    ("4.2", "the number of the action for the torque", "one more than expected", "mutant action_as_torque"),
    ("4.2", "the second angle counted from straight down", "counted from the first link",
     "mutant angle_from_the_ground"),
    ("4.3", "runs the whole budget of the file", r"holds \d+ generations, but the run that was asked",
     "mutant steps_ignored"),
    ("4.4", "the file read along the wrong axis", "lie one after another in the file",
     "mutant read_along_the_wrong_axis"),
    ("4.5", "divides by n", "n and n - 1 were mixed up", "mutant population_deviation"),
    ("4.5", "straight lines between generations", "no straight lines", "mutant straight_lines"),
    ("4.6", "the best episode instead of the mean", "of the best episode, but the mean", "mutant best_episode"),
    ("4.6", "the two robots exchanged", "returned as 'bestg': are the two exchanged", "mutant robots_mixed_up"),
]  # fmt: skip
