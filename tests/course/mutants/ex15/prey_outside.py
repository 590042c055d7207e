# loses: 15.2
# Goes through the pairs prey by prey, but reads the fitness predator by predator.
def tournament(predators, prey, maxsteps=2000):
    hunters, hunted = np.concatenate(predators), np.concatenate(prey)
    pairs = np.array([(i, j) for j in range(len(hunted)) for i in range(len(hunters))])
    fitness = play(hunters, hunted, pairs, maxsteps)
    return fitness.reshape(len(predators), len(predators[0]), len(prey), len(prey[0]))
