"""Mistakes of beginners in exercise 2; test_mistakes.py says what stands where."""

MISTAKES = [
    ("2.1", "also draws the biases", "b1 must be all zeros", "mutant random_biases"),
    ("2.1", "0.1 is taken for the variance", r"standard deviation 0\.3", "mutant variance_for_deviation"),
    ("2.2", "the biases are left out", "The biases are left out", "mutant biases_forgotten"),
    ("2.2", "no tanh at the outputs", "tanh is left out at the outputs", "mutant linear_outputs"),
    ("2.2", "multiplies from the wrong side", "transpose one|exchange the two sides",
     "def forward(network, observation):\n"
     "    hidden = np.tanh(observation @ network['W1'] + network['b1'])\n"
     "    return np.tanh(hidden @ network['W2'] + network['b2'])\n"),
    ("2.4", "hands the outputs on as they are", "stretch them to the space's limits", "mutant raw_outputs"),
    ("2.5", "goes on after the end", "the episode was over after 10 steps", "mutant never_stops"),
    ("2.5", "does not hand the seed to reset", "do not come from the seed", "mutant reset_without_seed"),
    ("2.6", "the sum of the returns", "It is the sum of the returns", "mutant sum_of_returns"),
    ("2.8", "renames a function it calls", "fitnes' is not defined. Did you mean",
     "def random_search(environment_id, nnetworks, nhiddens, seed):\n"
     "    return fitnes(environment_id, parameters(4, nhiddens, 2, seed), range(10))\n"),
]  # fmt: skip
