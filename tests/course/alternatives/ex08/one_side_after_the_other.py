# Other functions: repeat, sorting twice, einsum; a training that looks at all on one side first.
def candidates_around(centre, samples, noiseStdDev):
    signs = np.tile([1.0, -1.0], len(samples))[:, None]
    return centre + noiseStdDev * signs * np.repeat(samples, 2, axis=0)


def utilities(fitness):
    ranks = np.argsort(np.argsort(np.asarray(fitness), kind="mergesort"), kind="mergesort")
    return np.float64(ranks) / (np.size(fitness) - 1) - 0.5


def gradient(samples, utilities):
    pairs = np.reshape(utilities, (-1, 2))
    return np.einsum("b,bn->n", pairs[:, 0] - pairs[:, 1], samples) / pairs.size


def descent(gradient, centre, wdecay):
    d = np.negative(gradient)
    if wdecay == 1:
        return d + centre / 200
    if wdecay == 2:
        return d + np.where(centre > 0, 0.005, np.where(centre < 0, -0.005, 0.0))
    return d


def adam(centre, d, m, v, t, stepsize):
    m = m + 0.1 * (d - m)
    v = v + 0.001 * (np.square(d) - v)
    rate = stepsize * np.sqrt(1 - 0.999**t) / (1 - 0.9**t)
    return centre - rate * m / (np.sqrt(v) + 1e-8 * np.sqrt(1 - 0.999**t)), m, v


def smooth(curve, width):
    sums = np.concatenate([[0.0], np.cumsum(curve)])
    return (sums[width:] - sums[:-width]) / width


def stability(curve):
    curve = np.array(curve, dtype=float)
    if np.ptp(curve) == 0:
        return {"drop": 0.0, "bottom": 0, "peak": 0, "verdict": "monotonic"}
    heights = (curve - curve.min()) / np.ptp(curve)
    falls = np.array([heights[: i + 1].max() - heights[i] for i in range(len(heights))])
    bottom = falls.argmax()
    drop = falls.max()
    verdict = "monotonic" if drop <= 0.1 else "mild regressions"
    if drop > 0.3:
        verdict = "severe regressions"
    peak = np.argmax(heights[: bottom + 1])
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    centre = np.concatenate([np.zeros(robot.nbiases), 0.1 * rng.standard_normal(robot.nweights)])
    m, v = np.zeros_like(centre), np.zeros_like(centre)
    for g in range(70 if "CartPole" in environment else 500):
        e = rng.standard_normal((20, len(centre)))
        fitness = robot.evaluate(np.vstack([centre + 0.2 * e, centre - 0.2 * e]), seed + g, 10)
        ranks = utilities(fitness)
        d = -(ranks[:20] - ranks[20:]) @ e / 40
        centre, m, v = adam(centre, d, m, v, g + 1, 0.05)
    return centre
