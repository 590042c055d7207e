# loses: 13.2
# Takes the advantages as they are.
def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    ratio = np.exp(log_prob - old_log_prob)
    clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
    loss = -np.minimum(ratio * advantages, clipped * advantages).mean()
    return {"loss": float(loss), "clip_fraction": float((abs(ratio - 1) > clip_range).mean())}
