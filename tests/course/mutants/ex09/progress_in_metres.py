# loses: 9.1, 9.3, 9.4, 9.5, 9.6
# Forgets to divide by the duration of a step.
def progress(distance):
    return distance[:-1] - distance[1:]
