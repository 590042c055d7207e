# loses: 15.6
# Takes for the part of the others what is missing to the change.
_red_queen = red_queen


def red_queen(matrix):
    parts = _red_queen(matrix)
    return {**parts, "others": parts["change"] - parts["own"]}
