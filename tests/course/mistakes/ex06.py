"""Mistakes of beginners in exercise 6; test_mistakes.py says what stands where."""

MISTAKES = [
    ("6.1", "writes into the old memory", r"Keep a copy each time \(.copy\(\)\)", "mutant memory_overwritten"),
    ("6.2", "poses not copied", r"Keep a copy each time \(.copy\(\)\)", "mutant poses_not_copied"),
    ("6.2", "no pose of the start", "The first one is missing", "mutant start_missing"),
    ("6.2", "the memory after the step", "one place too early", "mutant memory_after_the_step"),
    ("6.3", "the wrong number varies fastest", "in another order", "mutant heading_slowest"),
    ("6.4", "one step too many in the search", "one more than expected", "mutant search_with_the_find"),
    ("6.4", "the mean of nothing", "NaN", "mutant nothing_has_no_mean"),
    ("6.5", "divides by n - 1", "n and n - 1 were mixed up", "mutant sample_deviation"),
    ("6.6", "the sum of the returns", "a sum|the sum", "mutant total_not_mean"),
    ("6.6", "empties the memory instead of freezing it", "All of it is 0", "mutant frozen_is_forgotten"),
]  # fmt: skip
