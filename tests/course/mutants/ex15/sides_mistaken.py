# loses: 15.6
# Takes its own part for that of the others.
_red_queen = red_queen


def red_queen(matrix):
    parts = _red_queen(matrix)
    return {**parts, "own": parts["others"], "others": parts["own"]}
