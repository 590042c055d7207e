# loses: 5.3
# Takes the default angle of each segment for its angle against the ground.
_joints_of_outline = joints


def outline(parameters):
    size = sizes(parameters)
    headings = _joints_of_outline(parameters)["angles"]
    along = np.stack([np.cos(headings), np.sin(headings)], axis=1)
    across = np.stack([-np.sin(headings), np.cos(headings)], axis=1)
    ends = np.cumsum(size["lengths"][:, None] * along, axis=0)
    beginnings = np.vstack([[0.0, 0.0], ends[:-1]])
    side = size["thicknesses"][:, None] / 2 * across
    return np.stack([beginnings - side, ends - side, ends + side, beginnings + side], axis=1)
