# loses: 11.9
# The grid stops one step before its upper end.
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return _feature_maps(network, low, high - (high - low) / n, n)
