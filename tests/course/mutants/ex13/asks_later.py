# loses: 13.4, 13.5, 13.6
# Imports the libraries' answers only when it needs them.
def entropy_of_gaussians(log_deviation):
    import torch

    normal = torch.distributions.Normal(0.0, torch.tensor(log_deviation).exp())
    return float(normal.entropy().sum())


def updates_made(divergences, target_kl):
    from botschool.rl.reference import updates_made

    return updates_made([[(2 * each) ** 0.5 for each in some] for some in divergences], target_kl)


def explained_variance(values, returns):
    from stable_baselines3.common.utils import explained_variance

    return float(explained_variance(np.ravel(values), np.ravel(returns)))
