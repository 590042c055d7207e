# loses: 12.2
# All actions are equally probable, whatever the policy says.
def choose(probabilities, rng):
    return int(rng.random() * len(probabilities))
