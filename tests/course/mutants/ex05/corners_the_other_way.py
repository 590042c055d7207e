# loses: 5.3
# Begins each segment at its left side.
_outline = outline


def outline(parameters):
    return _outline(parameters)[:, ::-1]
