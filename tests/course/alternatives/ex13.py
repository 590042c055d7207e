"""Right solutions of exercise 13 in other styles; building.py describes how a case is written."""

# %% in_torch
# Computes with torch tensors, and gives back what .numpy() and .item() make of them.
import torch


def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    rewards, ended, cut, values = map(torch.tensor, (rewards, terminated, truncated, final_values))
    return torch.where(cut.bool() & ~ended.bool(), rewards + gamma * values, rewards).numpy()


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


# %% loops
# Loops over steps and environments, the math module, the direct sum of advantage estimation.
import math


def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    table = [[float(reward) for reward in row] for row in rewards]
    for t, row in enumerate(table):
        for env in range(len(row)):
            if truncated[t][env] and not terminated[t][env]:
                row[env] += gamma * final_values[t][env]
    return table


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    steps, envs = len(rewards), len(rewards[0])
    table = [[0.0] * envs for _ in range(steps)]
    for env in range(envs):
        for t in range(steps):
            weight = 1.0
            for later in range(t, steps):
                if later + 1 < steps:
                    ended, after = episode_starts[later + 1][env], values[later + 1][env]
                else:
                    ended, after = dones[env], last_values[env]
                surprise = rewards[later][env] - values[later][env]
                if not ended:
                    surprise += gamma * after
                table[t][env] += weight * surprise
                if ended:
                    break
                weight *= gamma * gae_lambda
    return table


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    n = len(advantages)
    numbers = list(advantages)
    if n > 1:
        mean = sum(numbers) / n
        deviation = math.sqrt(sum((a - mean) ** 2 for a in numbers) / (n - 1))
        numbers = [(a - mean) / (deviation + 1e-8) for a in numbers]
    total, clipped = 0.0, 0
    for new, old, a in zip(log_prob, old_log_prob, numbers, strict=False):
        ratio = math.exp(new - old)
        cut = max(1 - clip_range, min(1 + clip_range, ratio))
        total -= min(ratio * a, cut * a)
        clipped += abs(ratio - 1) > clip_range
    return {"loss": total / n, "clip_fraction": clipped / n}


def value_loss(values, old_values, returns, clip_range_vf=None):
    total = 0.0
    for now, before, wanted in zip(values, old_values, returns, strict=False):
        if clip_range_vf is not None:
            now = min(max(now, before - clip_range_vf), before + clip_range_vf)
        total += (now - wanted) ** 2
    return total / len(values)


def entropy_of_choices(scores):
    entropies = []
    for row in scores:
        powers = [math.exp(score - max(row)) for score in row]
        shares = [power / sum(powers) for power in powers]
        entropies.append(-sum(share * math.log(share) for share in shares if share > 0))
    return entropies


def entropy_of_gaussians(log_deviation):
    return sum(0.5 * math.log(2 * math.pi * math.e * math.exp(2 * each)) for each in log_deviation)


def approx_kl(log_prob, old_log_prob):
    total = 0.0
    for new, old in zip(log_prob, old_log_prob, strict=False):
        total += math.expm1(new - old) - (new - old)
    return total / len(log_prob)


def updates_made(divergences, target_kl):
    together = [each for epoch in divergences for each in epoch]
    if target_kl is None:
        return len(together)
    for number, divergence in enumerate(together):
        if divergence > 1.5 * target_kl:
            return number
    return len(together)


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    bonus = sum(entropies) / len(entropies)
    return policy_loss - ent_coef * bonus + vf_coef * value_loss


def explained_variance(values, returns):
    rest = [r - v for v, r in zip(np.ravel(values), np.ravel(returns), strict=False)]
    wanted = np.ravel(returns).tolist()

    def variance(numbers):
        mean = sum(numbers) / len(numbers)
        return sum((x - mean) ** 2 for x in numbers)

    return 1 - variance(rest) / variance(wanted)


def hidden_activations(layers, observations):
    rows, found = observations, []
    for weights, biases in layers:
        neurons = list(zip(weights, biases, strict=True))
        rows = [[math.tanh(sum(w * np.array(row)) + bias) for w, bias in neurons] for row in rows]
        found.append(rows)
    return found


def responses(activations, observations):
    found = np.zeros((activations.shape[1], observations.shape[1]))
    for i in range(found.shape[0]):
        for j in range(found.shape[1]):
            h, x = activations[:, i], observations[:, j]
            if h.max() > h.min() and x.max() > x.min():
                found[i, j] = np.corrcoef(h, x)[0, 1]
    return found


# %% other_formulas
# Other formulas that mean the same: returns by recursion, cases instead of a minimum, covariances.
def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    ends = np.vstack([episode_starts[1:], [dones]]).astype(bool)
    targets = np.empty_like(values)  # of TD(lambda): r + gamma ((1 - lambda) V + lambda target)
    beyond = after = np.asarray(last_values)
    for t in range(len(rewards) - 1, -1, -1):
        mixed = (1 - gae_lambda) * after + gae_lambda * beyond
        targets[t] = rewards[t] + gamma * np.where(ends[t], 0.0, mixed)
        beyond, after = targets[t], values[t]
    return targets - values


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    a = np.array(advantages)
    if a.size != 1:
        a = (a - np.mean(a)) / (1e-8 + np.sqrt(np.var(a) * a.size / (a.size - 1)))
    ratio = np.exp(log_prob) / np.exp(old_log_prob)
    gains = np.where(
        a > 0, a * np.minimum(ratio, 1 + clip_range), a * np.maximum(ratio, 1 - clip_range)
    )
    inside = (ratio >= 1 - clip_range) & (ratio <= 1 + clip_range)
    return {"loss": -np.average(gains), "clip_fraction": 1 - inside.mean()}


def value_loss(values, old_values, returns, clip_range_vf=None):
    limit = np.inf if clip_range_vf is None else clip_range_vf
    errors = returns - np.clip(values, old_values - limit, old_values + limit)
    return errors @ errors / errors.size


def entropy_of_choices(scores):
    below = np.logaddexp.reduce(scores, axis=1)
    shares = np.exp(scores - below[:, None])
    return below - np.sum(shares * scores, axis=1)


def entropy_of_gaussians(log_deviation):
    return np.log(np.sqrt(2 * np.pi * np.e) * np.exp(log_deviation)).sum()


def approx_kl(log_prob, old_log_prob):
    ratio = np.exp(log_prob - old_log_prob)
    return np.mean((ratio - 1) - np.log(ratio))


def updates_made(divergences, target_kl):
    flat = np.concatenate(divergences)
    stops = np.flatnonzero(flat > 1.5 * target_kl) if target_kl is not None else []
    return int(stops[0]) if len(stops) else flat.size


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    return np.dot([1, vf_coef, -ent_coef], [policy_loss, value_loss, np.average(entropies)])


def explained_variance(values, returns):
    return 1 - (np.std(returns - values) / np.std(returns)) ** 2


def hidden_activations(layers, observations):
    found = [observations]
    for weights, biases in layers:
        found.append(np.tanh(np.einsum("kj,nj->nk", weights, found[-1]) + biases[None, :]))
    return found[1:]


def responses(activations, observations):
    def standard(table):
        table = np.array(table, dtype=float)
        still = (table == table[0]).all(axis=0)
        deviation = np.where(still, 1.0, table.std(axis=0))
        return np.where(still, 0.0, (table - table.mean(axis=0)) / deviation)

    return np.mean(standard(activations)[:, :, None] * standard(observations)[:, None], axis=0)


# %% matrices_of_discounts
# Advantages by a matrix of discounts for each environment; the loss by cases of the sign.
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    cut = (np.asarray(truncated) == 1) & (np.asarray(terminated) == 0)
    return np.where(cut, rewards + gamma * np.asarray(final_values), rewards)


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    ends = np.vstack([episode_starts[1:], np.reshape(dones, (1, -1))])
    after = np.vstack([values[1:], np.reshape(last_values, (1, -1))])
    errors = rewards + gamma * (1 - ends) * after - values
    steps, result = len(errors), np.empty(np.shape(errors))
    for env in range(np.shape(errors)[1]):
        weights = np.eye(steps)
        for t in range(steps):
            for k in range(t + 1, steps):
                weights[t, k] = weights[t, k - 1] * gamma * gae_lambda * (1 - ends[k - 1, env])
        result[:, env] = weights @ errors[:, env]
    return result


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    if np.size(advantages) > 1:
        centred = advantages - np.mean(advantages)
        advantages = centred / (np.sqrt(np.sum(centred**2) / (len(centred) - 1)) + 1e-8)
    ratio = np.exp(np.subtract(log_prob, old_log_prob))
    good = np.minimum(ratio, 1 + clip_range) * advantages
    bad = np.maximum(ratio, 1 - clip_range) * advantages
    far = np.logical_or(ratio > 1 + clip_range, ratio < 1 - clip_range)
    return {"loss": -np.where(advantages > 0, good, bad).mean(), "clip_fraction": far.mean()}


# %% single_precision
# Single precision where six digits are asked for; broadcasts for the updates.
def value_loss(values, old_values, returns, clip_range_vf=None):
    if clip_range_vf is None:
        return np.square(np.float64(values) - returns).mean()
    moved = np.minimum(np.maximum(values - old_values, -clip_range_vf), clip_range_vf)
    return float(np.dot(returns - old_values - moved, returns - old_values - moved) / len(returns))


def entropy_of_gaussians(log_deviation):
    return np.log(np.sqrt(2 * np.pi * np.e) * np.exp(np.float64(log_deviation))).sum()


def updates_made(divergences, target_kl):
    flat = [each for epoch in divergences for each in epoch]
    if target_kl is None:
        return len(flat)
    return next((i for i, each in enumerate(flat) if each > target_kl * 1.5), len(flat))


def approx_kl(log_prob, old_log_prob):
    log_ratio = np.subtract(log_prob, old_log_prob)
    return np.expm1(log_ratio).mean() - log_ratio.mean()


# %% sums_by_hand
# Sums by hand for entropy and variance, einsum for the layers, the mean of all losses.
def entropy_of_choices(scores):
    scores = np.float64(scores)
    found = []
    for row in scores:
        powers = np.exp(row - max(row))
        p = powers / sum(powers)
        found.append(-sum(x * np.log(x) for x in p if x > 0))
    return np.array(found)


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    bonus = ent_coef * sum(entropies) / len(entropies)
    return policy_loss + value_loss * vf_coef - bonus


def explained_variance(values, returns):
    errors = np.ravel(returns) - np.ravel(values)
    spread = np.ravel(returns) - np.mean(returns)
    unexplained = np.sum(errors**2) - np.sum(errors) ** 2 / errors.size
    return 1 - unexplained / np.sum(spread**2)


def hidden_activations(layers, observations):
    found = [np.asarray(observations, dtype=float)]
    for weights, biases in layers:
        found.append(np.tanh(np.einsum("ij,nj->ni", weights, found[-1]) + biases))
    return found[1:]


def learn(ppo, steps, seed):
    chance = np.random.RandomState(seed % 2**32)

    def study(rollout):
        h, many = ppo.hyperparameters, rollout.values.size
        over = rollout.ended != 0
        begun = np.concatenate([[np.zeros(len(over[0]))], over[:-1]]).astype(float)
        arrays = rollout.rewards, rollout.values, begun, rollout.last_values, over[-1] * 1.0
        rollout.advantages[...] = advantages(*arrays, h.gamma, h.gae_lambda)
        rollout.returns[...] = rollout.advantages + rollout.values
        for _ in range(h.n_epochs):
            order = list(range(many))
            chance.shuffle(order)
            for first in range(0, many, h.batch_size):
                part = ppo.minibatch(order[first : first + h.batch_size])
                now = ppo.loss(part)
                far = approx_kl(now.log_probs, part.log_probs)
                if updates_made([[far]], h.target_kl) == 0:
                    return
                ppo.step(now.gradient)

    while ppo.steps < steps:
        study(ppo.collect())


# %% other_formulas_again
# Loops, where and matrices.
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return np.where(
        (np.asarray(truncated) == 1) & (np.asarray(terminated) == 0),
        rewards + gamma * np.asarray(final_values),
        rewards,
    )


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    steps, envs = np.shape(rewards)
    out = np.zeros((steps, envs))
    for e in range(envs):
        for t in range(steps):
            weight = 1.0
            for k in range(t, steps):
                n = 1.0 - (episode_starts[k + 1][e] if k + 1 < steps else dones[e])
                v = values[k + 1][e] if k + 1 < steps else last_values[e]
                out[t, e] += weight * (rewards[k][e] + gamma * n * v - values[k][e])
                if n == 0:
                    break
                weight *= gamma * gae_lambda
    return out


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    a = np.array(advantages, dtype=float)
    n = len(a)
    if n > 1:
        a = a - a.sum() / n
        a = a / (np.sqrt((a**2).sum() / (n - 1)) + 1e-8)
    r = np.exp(np.subtract(log_prob, old_log_prob))
    total, far = 0.0, 0
    for ri, ai in zip(r, a):
        total += min(ri * ai, max(1 - clip_range, min(1 + clip_range, ri)) * ai)
        far += abs(ri - 1) > clip_range
    return {"loss": -total / n, "clip_fraction": far / n}


def value_loss(values, old_values, returns, clip_range_vf=None):
    v = np.asarray(values, dtype=float)
    if clip_range_vf is not None:
        v = np.minimum(np.maximum(v, old_values - clip_range_vf), old_values + clip_range_vf)
    return float(((v - returns) ** 2).sum() / len(v))


def entropy_of_choices(scores):
    s = np.asarray(scores, dtype=float)
    z = np.logaddexp.reduce(s, axis=1)
    p = np.exp(s - z[:, None])
    return z - np.where(p > 0, p * s, 0).sum(axis=1)


def entropy_of_gaussians(log_deviation):
    return 0.5 * len(log_deviation) * np.log(2 * np.pi * np.e) + sum(log_deviation)


def approx_kl(log_prob, old_log_prob):
    d = np.subtract(log_prob, old_log_prob)
    return np.mean(np.expm1(d) - d)


def updates_made(divergences, target_kl):
    flat = [d for epoch in divergences for d in epoch]
    if target_kl is None:
        return len(flat)
    return next((i for i, d in enumerate(flat) if d > 1.5 * target_kl), len(flat))


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    return policy_loss + vf_coef * value_loss - ent_coef * sum(entropies) / len(entropies)


def explained_variance(values, returns):
    e = np.ravel(returns) - np.ravel(values)
    r = np.ravel(returns)
    return 1 - ((e - e.mean()) ** 2).sum() / ((r - r.mean()) ** 2).sum()


def responses(activations, observations):
    out = np.zeros((activations.shape[1], observations.shape[1]))
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            h, x = activations[:, i], observations[:, j]
            if h.max() > h.min() and x.max() > x.min():
                h, x = h - h.mean(), x - x.mean()
                out[i, j] = (h @ x) / np.sqrt((h @ h) * (x @ x))
    return out


def learn(ppo, steps, seed):
    h, rng = ppo.hyperparameters, np.random.default_rng(seed)
    while ppo.steps < steps:
        r = ppo.collect()
        n = 1.0 * (np.asarray(r.ended) == 0)
        following, a = r.last_values, np.zeros_like(r.last_values)
        for t in reversed(range(len(r.rewards))):
            a = (
                r.rewards[t]
                + h.gamma * n[t] * following
                - r.values[t]
                + h.gamma * h.gae_lambda * n[t] * a
            )
            r.advantages[t] = a
            following = r.values[t]
        r.returns[...] = r.advantages + r.values
        stop = False
        for _ in range(h.n_epochs):
            order = np.arange(n.size)
            rng.shuffle(order)
            for begin in range(0, n.size, h.batch_size):
                batch = ppo.minibatch(order[begin : begin + h.batch_size])
                loss = ppo.loss(batch)
                if (
                    h.target_kl is not None
                    and approx_kl(loss.log_probs, batch.log_probs) > 1.5 * h.target_kl
                ):
                    stop = True
                    break
                ppo.step(loss.gradient)
            if stop:
                break
