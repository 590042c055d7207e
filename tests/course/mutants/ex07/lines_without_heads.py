# loses: 7.7
# Draws lines, which do not tell forwards from backwards.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        for arrows, colour in ((field, "gray"), (path, "red")):
            x, y, dx, dy = arrows.T
            axes.plot([x, x + dx], [y, y + dy], color=colour, linewidth=1)
        axes.set(title=title, xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)
