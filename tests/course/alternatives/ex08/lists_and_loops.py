# Lists and loops over single numbers, where the solution has arrays.
import math


def candidates_around(centre, samples, noiseStdDev):
    candidates = []
    for sample in samples:
        for s in (noiseStdDev, -noiseStdDev):
            candidates.append([centre[i] + s * sample[i] for i in range(len(centre))])
    return candidates


def utilities(fitness):
    n = len(fitness)
    result = []
    for i in range(n):
        rank = 0
        for j in range(n):
            if fitness[j] < fitness[i] or (fitness[j] == fitness[i] and j < i):
                rank += 1
        result.append(rank / (n - 1) - 0.5)
    return result


def gradient(samples, utilities):
    g = [0.0] * len(samples[0])
    for b, sample in enumerate(samples):
        for i, e in enumerate(sample):
            g[i] += (utilities[2 * b] - utilities[2 * b + 1]) * e / (2 * len(samples))
    return g


def descent(gradient, centre, wdecay):
    d = []
    for g, c in zip(gradient, centre, strict=False):
        if wdecay == 1:
            d.append(-g + 0.005 * c)
        elif wdecay == 2 and c != 0:
            d.append(-g + math.copysign(0.005, c))
        else:
            d.append(-g)
    return d


def adam(centre, d, m, v, t, stepsize):
    moved, ms, vs = [], [], []
    for c, di, mi, vi in zip(centre, d, m, v, strict=False):
        ms.append(0.9 * mi + (1 - 0.9) * di)
        vs.append(0.999 * vi + (1 - 0.999) * di * di)
        size = math.sqrt(vs[-1] / (1 - math.pow(0.999, t))) + 1e-8
        moved.append(c - stepsize * ms[-1] / (1 - math.pow(0.9, t)) / size)
    return moved, ms, vs


def evolve(
    evaluate, centre, generations, seed, samplesize=20, noiseStdDev=0.02, stepsize=0.01, wdecay=0
):
    rng, n = np.random.default_rng(seed), len(centre)
    m, v, history = [0.0] * n, [0.0] * n, []
    for g in range(generations):
        samples = rng.standard_normal((samplesize, n))
        fitness = evaluate(np.array(candidates_around(centre, samples, noiseStdDev)), seed + g)
        history.append(sum(fitness) / len(fitness))
        d = descent(gradient(samples, utilities(list(fitness))), centre, wdecay)
        centre, m, v = adam(centre, d, m, v, g + 1, stepsize)
    return {"centre": centre, "history": history}


def smooth(curve, width):
    return [sum(curve[i : i + width]) / width for i in range(len(curve) - width + 1)]


def stability(curve):
    top, peak, bottom, fall, at = curve[0], 0, 0, 0.0, 0
    for i, value in enumerate(curve):
        if value > top:
            top, at = value, i
        if top - value > fall:
            fall, bottom, peak = top - value, i, at
    height = max(curve) - min(curve)
    drop = fall / height if height else 0.0
    words = ["monotonic", "mild regressions", "severe regressions"]
    verdict = words[int(drop > 0.1) + int(drop > 0.3)]
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


def train(environment, seed):
    """Small generations of arrays, one candidate after another."""
    robot = Robot(environment)
    rng = np.random.default_rng([seed, 7])
    n = robot.nbiases + robot.nweights
    centre, m, v = 0.1 * rng.standard_normal(n), np.zeros(n), np.zeros(n)
    for g in range(90 if environment.startswith("Cart") else 700):
        samples = rng.standard_normal((15, n))
        scores = []
        for e in samples:
            for c in (centre + 0.2 * e, centre - 0.2 * e):
                scores.append(robot.evaluate(c[None, :], seed + g, episodes=10)[0])
        d = -np.array(gradient(samples, utilities(scores)))
        centre, m, v = (np.array(each) for each in adam(centre, d, m, v, g + 1, 0.05))
    return centre.tolist()
