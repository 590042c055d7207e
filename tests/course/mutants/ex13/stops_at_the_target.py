# loses: 13.5
# Stops at the target itself instead of one and a half times as much.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    return _updates_made(divergences, None if target_kl is None else target_kl / 1.5)
