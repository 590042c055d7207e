# loses: 13.2
# Takes the clipped product always, instead of the smaller one of the two.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    ratio = np.exp(log_prob - old_log_prob)
    cut = np.log(np.clip(ratio, 1 - clip_range, 1 + clip_range))
    loss = _policy_loss(cut, 0 * cut, advantages, clip_range)["loss"]
    return {"loss": loss, "clip_fraction": float((abs(ratio - 1) > clip_range).mean())}
