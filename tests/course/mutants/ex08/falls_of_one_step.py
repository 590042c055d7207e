# loses: 8.7
# Looks only at falls from one generation to the next.
def stability(curve):
    curve = np.asarray(curve, dtype=float)
    steps = np.append(0, np.diff(curve))
    bottom, height = int(np.argmin(steps)), np.ptp(curve)
    drop = float(-steps[bottom] / height) if height > 0 else 0.0
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    verdict = "severe regressions" if drop > 0.3 else verdict
    return {"drop": drop, "bottom": bottom, "peak": max(0, bottom - 1), "verdict": verdict}
