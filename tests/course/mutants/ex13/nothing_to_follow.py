# loses: 13.7
# Divides by 0 where something never changes.
def responses(activations, observations):
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    with np.errstate(all="ignore"):
        return (h / np.sqrt((h**2).sum(0))).T @ (x / np.sqrt((x**2).sum(0)))
