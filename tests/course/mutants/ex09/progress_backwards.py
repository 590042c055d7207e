# loses: 9.1
# Progress is positive when the robot goes away.
def progress(distance):
    return (distance[1:] - distance[:-1]) / 0.0165
