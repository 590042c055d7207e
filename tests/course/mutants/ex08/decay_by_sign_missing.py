# loses: 8.4
# Knows only one kind of decay.
def descent(gradient, centre, wdecay):
    return -gradient + (0.005 * centre if wdecay else 0)
