# loses: 12.2
# Lays the probabilities on the ruler from the last to the first.
def choose(probabilities, rng):
    beyond = np.cumsum(np.asarray(probabilities)[::-1]) > rng.random()
    return len(probabilities) - 1 - int(np.argmax(beyond))
