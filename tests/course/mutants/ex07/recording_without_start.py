# loses: 7.2
# The recording leaves out the state after the reset.
_record = record


def record(controller, seed, steps):
    return _record(controller, seed, steps)[1:]
