# loses: 9.1
# A robot may lean back as far as it likes.
_alive_bonus = alive_bonus


def alive_bonus(robot, height, pitch, touching):
    return _alive_bonus(robot, height, np.maximum(pitch, 0), touching)
