# loses: 7.7
# Draws the field only.
_draw_portraits = draw_portraits


def draw_portraits(file, titles, fields, paths):
    _draw_portraits(file, titles, fields, [np.zeros((1, 4))] * len(titles))
