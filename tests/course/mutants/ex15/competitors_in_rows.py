# loses: 15.4
# Takes the rows of the matrix for the competitors.
_profile = profile


def profile(matrix):
    return _profile(np.transpose(matrix))
