# loses: 6.5
# The family of the first robot has the highest number.
_families = families


def families(table, threshold):
    labels = _families(table, threshold)
    return [max(labels) - label for label in labels]
