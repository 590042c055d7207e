# loses: 15.4
# Counts the present competitors among the ancient and the future ones.
_profile = profile


def profile(matrix):
    count = len(matrix)
    ancient = [matrix[g, : g + 1].mean() for g in range(1, count)]
    future = [matrix[g, g:].mean() for g in range(count - 1)]
    return {**_profile(matrix), "ancient": ancient, "future": future}
