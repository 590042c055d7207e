# loses: 6.6
# Lets the memory change once more in step `since`.
def freeze(since):
    return lambda step, before, after: after if step <= since else before
