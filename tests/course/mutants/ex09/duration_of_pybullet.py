# loses: 9.1
# All steps are thought to last as long as PyBullet's.
def progress(distance, duration):
    return (distance[:-1] - distance[1:]) / 0.0165
