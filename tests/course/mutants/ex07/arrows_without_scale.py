# loses: 7.7
# Lets matplotlib choose how long the arrows are.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False)[0]
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        axes.quiver(*field.T, color="gray")
        axes.quiver(*path.T, color="red")
        axes.set(title=title, xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)
