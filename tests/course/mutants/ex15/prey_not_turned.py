# loses: 15.3
# Leaves the predators in the rows of the matrix of the prey.
def master(table):
    mean = table.mean(axis=(1, 3))
    return {"predators": mean, "prey": 1 - mean}
