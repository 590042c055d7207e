# loses: 9.1, 9.3, 9.4, 9.5, 9.6
# Progress is positive when the robot goes away.
def progress(distance):
    return (distance[1:] - distance[:-1]) / 0.0165
