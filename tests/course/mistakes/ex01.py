"""Mistakes of beginners in exercise 1; test_mistakes.py says what stands where."""

MISTAKES = [
    ("1.1", "choices are taken to begin with 0", "first returned 0|first is 0", "mutant describe_first_choice"),
    ("1.2", "goes on when the time limit is over", "the episode was over after 200 steps", "mutant goes_on_after_the_end"),
    ("1.2", "the observation of reset forgotten", "The first one is missing", "mutant observation_of_reset_missing"),
    ("1.2", "the two ends treated as one", "as the old `done` was", "mutant one_kind_of_end"),
    ("1.2", "the action space not seeded", "do not come from the seed", "mutant unseeded_actions"),
    ("1.3", "the limits of the observation space", "compare with 2.4 metres and 12 degrees", "mutant limits_of_the_space"),
    ("1.4", "arctan of the quotient", "see np.arctan2", "mutant arctan_of_the_quotient"),
    ("1.4", "the torque not cut", "The torque is not cut", "mutant torque_not_cut"),
    ("1.6", "the deviation divides by n", "n and n - 1 were mixed up", "mutant deviation_divides_by_n"),
    ("1.6", "the mean reward of a step", "mean of .* a step|reward of a step", "mutant mean_reward_of_a_step"),
]  # fmt: skip
