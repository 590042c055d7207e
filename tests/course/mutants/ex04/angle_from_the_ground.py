# loses: 4.2
# Takes the second angle as if it were counted from straight down.
def height(observation):
    state = decode(observation)
    return float(-np.cos(state["angle1"]) - np.cos(state["angle2"]))
