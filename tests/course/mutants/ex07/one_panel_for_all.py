# loses: 7.7
# Draws all portraits into one panel.
def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    axes = figure.subplots()
    for field, path in zip(fields, paths, strict=True):
        axes.quiver(*field.T)
        axes.quiver(*path.T, color="red")
    axes.set(title=" / ".join(titles), xlim=(-np.pi, np.pi), ylim=(-8, 8))
    figure.savefig(file, dpi=100)
