# loses: 9.2
# A Humanoid's electricity costs no more than that of others.
_electricity = electricity


def electricity(robot, actions, speeds):
    return _electricity("Hopper", actions, speeds)
