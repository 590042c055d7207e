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
