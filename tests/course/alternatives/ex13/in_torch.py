# Computes with torch tensors, and gives back what .numpy() and .item() make of them.
import torch


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    rewards, values, starts, last_values, dones = (
        torch.as_tensor(np.array(each, dtype=float))
        for each in (rewards, values, episode_starts, last_values, dones)
    )
    goes_on = 1 - torch.cat([starts[1:], dones[None]])
    surprises = rewards + gamma * goes_on * torch.cat([values[1:], last_values[None]]) - values
    result = surprises.clone()
    for t in range(len(rewards) - 2, -1, -1):
        result[t] += gamma * gae_lambda * goes_on[t] * result[t + 1]
    return result.numpy()


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    log_prob, old_log_prob, a = map(torch.from_numpy, (log_prob, old_log_prob, advantages))
    if a.numel() > 1:
        a = (a - a.mean()) / (a.std() + 1e-8)
    ratio = (log_prob - old_log_prob).exp()
    worse = torch.minimum(ratio * a, ratio.clamp(1 - clip_range, 1 + clip_range) * a)
    far = (ratio - 1).abs() > clip_range
    return {"loss": (-worse).mean().item(), "clip_fraction": far.double().mean().item()}


def value_loss(values, old_values, returns, clip_range_vf=None):
    values, old, returns = map(torch.from_numpy, (values, old_values, returns))
    if clip_range_vf is not None:
        values = old + torch.clamp(values - old, -clip_range_vf, clip_range_vf)
    return torch.nn.functional.mse_loss(returns, values).item()


def entropy_of_choices(scores):
    logarithms = torch.log_softmax(torch.from_numpy(scores), dim=1)
    return -(logarithms.exp() * logarithms).sum(dim=1).numpy()


def entropy_of_gaussians(log_deviation):
    return (0.5 + 0.5 * np.log(2 * torch.pi) + torch.tensor(log_deviation)).sum().item()


def approx_kl(log_prob, old_log_prob):
    log_ratio = torch.tensor(log_prob) - torch.tensor(old_log_prob)
    return float(torch.mean(torch.exp(log_ratio) - 1 - log_ratio))


def explained_variance(values, returns):
    values, returns = torch.tensor(values), torch.tensor(returns)
    return float(1 - (returns - values).var() / returns.var())


def hidden_activations(layers, observations):
    signal, found = torch.as_tensor(observations, dtype=torch.float64), []
    for weights, biases in layers:
        signal = torch.tanh(
            torch.nn.functional.linear(signal, *map(torch.tensor, (weights, biases)))
        )
        found.append(signal.numpy())
    return found


def responses(activations, observations):
    h, x = (torch.tensor(np.asarray(each, dtype=float)) for each in (activations, observations))
    moving = torch.outer(h.amax(0) > h.amin(0), x.amax(0) > x.amin(0))
    h, x = h - h.mean(0), x - x.mean(0)
    cosines = torch.einsum("ni,nj->ij", h, x) / torch.outer(h.norm(dim=0), x.norm(dim=0))
    return torch.where(moving, cosines, 0.0).numpy()
