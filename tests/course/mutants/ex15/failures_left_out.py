# loses: 15.3
# Averages over the chases in which the prey is caught only.
def master(table):
    caught = np.maximum((table > 0).sum(axis=(1, 3)), 1)
    mean = table.sum(axis=(1, 3)) / caught
    return {"predators": mean, "prey": 1 - mean.T}
