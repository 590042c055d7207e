"""How the simulated student does each laboratory: a module labNN with these names.

PREDICTIONS: field -> answer; HONEST: three students with predictions (and a rule) of their own;
PARTS: how many times smaller the budgets of the proofs are; MEASURE: the functions of measure.py;
SHOWN, DRAWN: which conditions the figure shows, and the measure with the names of both axes;
conclusions(place, data): the answers after the table.
Optional: `prepare(place)`, what the student does between `start` and `run`; `mark(data)`, code that
marks the result in the figure.
"""

from botschool.labs.measuring import permutation_test

WHY = "Because a reward for standing is earned without any risk of falling over while moving on."


def which(a, b, labels):
    """The answer which of two groups has the larger mean, and the p of the permutation test."""
    p = permutation_test(a, b)
    return (labels[int(a.mean() < b.mean())] if p < 0.05 else "my runs cannot tell"), f"{p:.4f}"
