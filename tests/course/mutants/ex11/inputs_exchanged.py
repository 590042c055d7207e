# loses: 11.9
# The first input goes up, the second to the right.
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return _feature_maps(network, low, high, n).transpose(0, 2, 1)
