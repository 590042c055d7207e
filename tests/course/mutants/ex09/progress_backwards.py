# loses: 9.1
# Progress is positive when the robot goes away.
def progress(distance, duration):
    return (distance[1:] - distance[:-1]) / duration
