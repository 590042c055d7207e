# loses: 7.2
# The seed is not used.
_record = record


def record(controller, seed, steps):
    return _record(controller, None, steps)
