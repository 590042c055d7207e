# Loops over steps and environments, the math module, the direct sum of advantage estimation.
import math


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
