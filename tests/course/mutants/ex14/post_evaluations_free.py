# loses: 14.8
# Forgets the steps of the post-evaluations, which evolution has to pay for.
_curve_of = curve_of


def curve_of(place):
    curve = _curve_of(place)
    if not str(place).endswith(".npy"):
        curve["steps"] = RunFolder(place).evaluations().steps
    return curve
