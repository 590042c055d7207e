# loses: 4.2
# Takes the number of the action for the torque.
def torque(action):
    return float(action)
