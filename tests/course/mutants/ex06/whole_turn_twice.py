# loses: 6.3
# Has the headings 0 and 2 pi, which are the same.
def grid(places, headings):
    angles = np.linspace(0, 2 * np.pi, headings)
    ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
    return np.array([(x, y, angle) for y in ys for x in xs for angle in angles])
