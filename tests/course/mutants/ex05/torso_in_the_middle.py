# loses: 5.3
# Puts the middle of the torso at (0, 0) instead of its beginning.
_outline = outline


def outline(parameters):
    corners = _outline(parameters)
    return corners - corners[0].mean(axis=0)
