# loses: 9.2
# Braking is paid for: the absolute value is missing.
def electricity(robot, actions, speeds):
    cost = 2.0 * (actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
    return -cost * (4.25 if robot == "Humanoid" else 1.0)
