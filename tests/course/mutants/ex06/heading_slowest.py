# loses: 6.3
# Goes through all places with one heading, then with the next.
_grid = grid


def grid(places, headings):
    starts = _grid(places, headings)
    return starts[np.argsort(starts[:, 2], kind="stable")]
