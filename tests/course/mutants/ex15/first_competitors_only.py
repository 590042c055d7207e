# loses: 15.6
# Holds the other side still in the first generation alone.
_red_queen = red_queen


def red_queen(matrix):
    first = matrix[0, 0]
    return {**_red_queen(matrix), "own": matrix[1:, 0] - first, "others": matrix[0, 1:] - first}
