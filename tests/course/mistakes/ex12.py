"""Mistakes of beginners in exercise 12; test_mistakes.py says what stands where."""

MISTAKES = [
    ("12.1", "one sum over all steps", "each row has its own", "mutant softmax_over_everything"),
    ("12.1", "powers of large scores", "np.exp of a large number|infinity minus infinity", "mutant softmax_overflows"),
    ("12.2", "always the most probable action", "always the most probable action", "mutant most_probable_action"),
    ("12.3", "the last reward left out", "one less than expected", "mutant last_reward_missing"),
    ("12.3", "what is observed after the action", "one place too early", "mutant records_the_next_observation"),
    ("12.4", "all episodes are kept", "All episodes are kept", "mutant keeps_everything"),
    ("12.5", "the sum instead of the mean", "a sum for a mean", "mutant summed_surprise"),
    ("12.5", "goes through NumPy", "No gradient arrives|element 0 of tensors does not require grad",
     "mutant gradient_cut_off"),
    ("12.6", "gradients never set to zero", "zero_grad", "mutant gradients_pile_up"),
    ("12.7", "the logarithm of the variance", "logarithm of the variance", "mutant variance_for_deviation"),
]  # fmt: skip
