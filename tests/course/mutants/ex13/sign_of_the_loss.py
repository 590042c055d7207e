# loses: 13.2
# Makes the surrogate small instead of large.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": -found["loss"]}
