# loses: 14.1
# Reports the episodes of the training itself instead of the last post-evaluation.
_train_variations = train_variations


def train_variations(*arguments, **options):
    records = _train_variations(*arguments, **options)
    for record in records:
        means = RunFolder(record["folder"]).log()["rollout/ep_rew_mean"]
        record["return"] = float(means[~np.isnan(means)][-1])
    return records
