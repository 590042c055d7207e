# loses: 9.2
# Adds the costs of the joints up instead of taking their mean.
_electricity = electricity


def electricity(robot, actions, speeds):
    return _electricity(robot, actions, speeds) * actions.shape[1]
