# loses: 5.3
# Goes a whole thickness to each side.
def outline(parameters):
    size = sizes(parameters)
    headings = np.cumsum(joints(parameters)["angles"])
    along = np.stack([np.cos(headings), np.sin(headings)], axis=1)
    across = np.stack([-np.sin(headings), np.cos(headings)], axis=1)
    ends = np.cumsum(size["lengths"][:, None] * along, axis=0)
    beginnings = np.vstack([[0.0, 0.0], ends[:-1]])
    side = size["thicknesses"][:, None] * across
    return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
