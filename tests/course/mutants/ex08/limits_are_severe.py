# loses: 8.7
# Counts a drop that equals a limit to the worse verdict.
_stability = stability


def stability(curve):
    found = _stability(curve)
    worse = ["monotonic", "mild regressions", "severe regressions"]
    found["verdict"] = worse[int(found["drop"] >= 0.1) + int(found["drop"] >= 0.3)]
    return found
