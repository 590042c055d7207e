# loses: 7.7
# Puts the head of each arrow where its beginning belongs.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    exact = {"angles": "xy", "scale_units": "xy", "scale": 1, "pivot": "tip"}
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        axes.quiver(*field.T, color="gray", **exact)
        axes.quiver(*path.T, color="red", **exact)
        axes.set(title=title, xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)
