# loses: 12.7
# Leaves the constant out: the gradients are right, but it is no density.
def gaussian_loss(means, log_deviation, actions):
    distance = (actions - means) / torch.exp(log_deviation)
    return (distance**2 / 2 + log_deviation).sum(dim=1).mean()
