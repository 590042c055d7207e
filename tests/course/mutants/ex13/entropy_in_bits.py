# loses: 13.4
# Takes the logarithm to the base 2.
_entropy_of_choices = entropy_of_choices


def entropy_of_choices(scores):
    return _entropy_of_choices(scores) / np.log(2)
