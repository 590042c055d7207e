# loses: 13.5
# Ends the epoch, and begins the next one.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    return sum(_updates_made([epoch], target_kl) for epoch in divergences)
