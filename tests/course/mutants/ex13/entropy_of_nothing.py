# loses: 13.4
# An action of probability 0 makes the entropy no number.
def entropy_of_choices(scores):
    with np.errstate(all="ignore"):
        powers = np.exp(scores - scores.max(axis=1, keepdims=True))
        shares = powers / powers.sum(axis=1, keepdims=True)
        return -(shares * np.log(shares)).sum(axis=1)
