# loses: 14.6
# Takes an indicator that equals its limit for a warning sign.
def warning_signs(indicators, total, signs):
    found = []
    for name, (indicator, side, limit) in signs.items():
        if indicator in indicators:
            logged = indicators[indicator]
            late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
            if late is not None and (late >= limit if side == "above" else late <= limit):
                found.append(name)
    return found
