# loses: 5.4
# Takes the length of the stretched chain for its width.
_describe = describe


def describe(parameters):
    found = _describe(parameters)
    return found | {"width": found["length"]}
