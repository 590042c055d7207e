# loses: 5.1
# Lets the density vary by 80 %, instead of by 0.8.
_sizes = sizes


def sizes(parameters):
    size = _sizes(parameters)
    densities = 5 * (1 + 0.8 * np.tanh(parameters[53:]))
    return size | {"masses": size["lengths"] * size["thicknesses"] * densities}
