# loses: 15.3
# Gives the prey the fitness of the predators.
def master(table):
    mean = table.mean(axis=(1, 3))
    return {"predators": mean, "prey": mean.T}
