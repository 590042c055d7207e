# loses: 4.1
# The two speeds are mixed up.
_decoded = decode


def decode(observation):
    state = _decoded(observation)
    return state | {"speed1": state["speed2"], "speed2": state["speed1"]}
