# loses: 13.5
# Makes one more update with the batch that was too far.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    total = sum(map(len, divergences))
    return min(total, _updates_made(divergences, target_kl) + 1)
