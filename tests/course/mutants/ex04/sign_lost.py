# loses: 4.1
# The angles come from the cosine alone, so their sign is lost.
def decode(observation):
    return {
        "angle1": float(np.arccos(np.clip(observation[0], -1, 1))),
        "angle2": float(np.arccos(np.clip(observation[2], -1, 1))),
        "speed1": float(observation[4]),
        "speed2": float(observation[5]),
    }
