# loses: 12.2
# Takes the most probable action, so that nothing new is ever tried.
def choose(probabilities, rng):
    rng.random()
    return int(np.argmax(probabilities))
