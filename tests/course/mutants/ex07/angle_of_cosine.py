# loses: 7.1
# Computes the angle from its cosine alone, so that it is never negative.
def to_state(observation):
    observation = np.asarray(observation, dtype=float)
    return np.stack([np.arccos(observation[..., 0]), observation[..., 2]], axis=-1)
