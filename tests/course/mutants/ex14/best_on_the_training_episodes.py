# loses: 14.8
# Takes the best fitness of evolution, measured on the episodes that it was selected by.
_curve_of = curve_of


def curve_of(place):
    if str(place).endswith(".npy"):
        stat = read_stat(place)
        return {"steps": stat[:, 0], "best": stat[:, 1]}
    return _curve_of(place)
