# loses: 12.1
# One sum for all steps, instead of one for each.
def softmax(scores):
    powers = np.exp(np.asarray(scores, dtype=np.float64) - np.max(scores))
    return powers / powers.sum()
