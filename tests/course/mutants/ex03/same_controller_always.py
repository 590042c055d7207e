# loses: 3.7
# Ignores the seed: a controller evolved once, as if it had been pasted into the file.
_evolve_and_choose = train


def train(environment, seed):
    return _evolve_and_choose(environment, 1)
