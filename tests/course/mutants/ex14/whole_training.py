# loses: 14.6
# Looks for signs in the whole training instead of its last third.
def warning_signs(indicators, total, signs):
    found = []
    for name, (indicator, side, limit) in signs.items():
        if indicator in indicators:
            mean = np.nanmean(indicators[indicator]["values"])
            if mean > limit if side == "above" else mean < limit:
                found.append(name)
    return found
