# loses: 8.7
# Compares only the highest point with the end, so that recovered falls are missed.
def stability(curve):
    curve = np.asarray(curve, dtype=float)
    peak, bottom, height = int(np.argmax(curve)), len(curve) - 1, np.ptp(curve)
    drop = float((curve[peak] - curve[-1]) / height) if height > 0 else 0.0
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    verdict = "severe regressions" if drop > 0.3 else verdict
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
