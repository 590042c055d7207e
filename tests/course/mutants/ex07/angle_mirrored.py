# loses: 7.1
# Cosine and sine are taken for each other.
def to_state(observation):
    observation = np.asarray(observation, dtype=float)
    angle = np.arctan2(observation[..., 0], observation[..., 1])
    return np.stack([angle, observation[..., 2]], axis=-1)
