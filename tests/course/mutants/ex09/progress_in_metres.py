# loses: 9.1
# Forgets to divide by the duration of a step.
def progress(distance, duration):
    return distance[:-1] - distance[1:]
