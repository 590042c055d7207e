# loses: 7.7
# Draws each arrow from the next state to the one before.
_draw_portraits = draw_portraits


def draw_portraits(file, titles, fields, paths):
    back = [[np.hstack([a[:, :2] + a[:, 2:], -a[:, 2:]]) for a in each] for each in (fields, paths)]
    _draw_portraits(file, titles, *back)
