# loses: 14.2
# Numbers the entries instead of giving their steps.
_read_indicators = read_indicators


def read_indicators(folder):
    indicators = _read_indicators(folder)
    for logged in indicators.values():
        logged["steps"] = np.arange(len(logged["values"]))
    return indicators
