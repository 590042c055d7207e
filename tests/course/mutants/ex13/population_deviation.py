# loses: 13.2
# The deviation divides by N.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    n = len(advantages)
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": found["loss"] * np.sqrt(n / max(1, n - 1))}
