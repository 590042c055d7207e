# loses: 13.2
# Counts as clipped what is far from 0 in the logarithm.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "clip_fraction": float((abs(log_prob - old_log_prob) > clip_range).mean())}
