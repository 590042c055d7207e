# loses: 5.4
# Adds up the freedom of the joints instead of taking the mean.
_describe = describe


def describe(parameters):
    found = _describe(parameters)
    return found | {"freedom": JOINTS * found["freedom"]}
