"""Mistakes of beginners in exercise 11; test_mistakes.py says what stands where."""

MISTAKES = [
    ("11.1", "tanh instead of the logistic function", "tanh where the logistic", "mutant tanh_for_logistic"),
    ("11.2", "the sum of the squares, not their mean", "a sum for a mean", "mutant loss_summed"),
    ("11.2", "means for the gradients of the biases", "a mean for a sum", "mutant mean_gradient_of_biases"),
    ("11.2", "the slope of the logistic function forgotten", "slope", "mutant slope_forgotten"),
    ("11.3", "gradients add up", "twice what was expected", "mutant gradients_add_up"),
    ("11.4", "the losses after each step", "one place too early", "mutant loss_after_the_step"),
    ("11.5", "never begins anew", "made were stuck, and should have been replaced", "mutant never_begins_anew"),
    ("11.6", "the deviation divides by n - 1", "n and n - 1 were mixed up", "mutant deviation_of_a_sample"),
    ("11.7", "the last patterns dropped", "must return 3 arrays", "mutant last_patterns_dropped"),
    ("11.9", "the two inputs exchanged", "Rows and columns are exchanged", "mutant inputs_exchanged"),
]  # fmt: skip
