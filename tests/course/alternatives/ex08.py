"""Right solutions of exercise 8 in other styles; building.py describes how a case is written."""


# %% keeps_the_best_centre
# Classes and closures of its own; stops when the centre itself, evaluated now and then, is good.
class Adam:
    def __init__(self, n):
        self.m, self.v, self.t = np.zeros(n), np.zeros(n), 0

    def step(self, centre, d, stepsize):
        self.t += 1
        centre, self.m, self.v = adam(centre, d, self.m, self.v, self.t, stepsize)
        return centre


def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + noiseStdDev * samples, centre - noiseStdDev * samples])
    return both.transpose(1, 0, 2).reshape(-1, len(centre))


def utilities(fitness):
    fitness = np.asarray(fitness)
    order = sorted(range(len(fitness)), key=fitness.__getitem__)
    result = dict(zip(order, np.linspace(-0.5, 0.5, len(fitness)), strict=False))
    return np.array([result[i] for i in range(len(fitness))])


def gradient(samples, utilities):
    weights = np.array(utilities[::2]) - np.array(utilities[1::2])
    return sum(weight * e for weight, e in zip(weights, samples, strict=True)) / len(utilities)


def descent(gradient, centre, wdecay):
    return [0, centre, np.sign(centre)][wdecay] * np.float64(0.005) - gradient


def evolve(
    evaluate, centre, generations, seed, samplesize=20, noiseStdDev=0.02, stepsize=0.01, wdecay=0
):
    rng, optimiser = np.random.default_rng(seed), Adam(len(centre))
    history = np.zeros(generations)
    for g in range(generations):
        e = rng.standard_normal((samplesize, len(centre)))
        fitness = evaluate(candidates_around(centre, e, noiseStdDev), seed + g)
        history[g] = np.mean(fitness)
        d = descent(gradient(e, utilities(fitness)), centre, wdecay)
        centre = optimiser.step(centre, d, stepsize)
    return {"centre": centre, "history": history, "generations": generations}


def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    centre = 0.1 * rng.standard_normal(robot.nbiases + robot.nweights)
    goal = 200 if environment == "CartPole-v0" else -180
    for stretch in range(40):
        run = evolve(
            lambda candidates, s: robot.evaluate(candidates, s, episodes=5), centre, 40,
            seed + 1000 * stretch, samplesize=25, noiseStdDev=0.25, stepsize=0.05,
        )  # fmt: skip
        centre = run["centre"]
        if robot.evaluate(centre[None], seed + 77, episodes=50)[0] >= goal:
            break
    return centre


# %% lists_and_loops
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
    """Small generations, a few candidates after another."""
    robot = Robot(environment)
    rng = np.random.default_rng([seed, 7])
    centre = (0.1 * rng.standard_normal(robot.nbiases + robot.nweights)).tolist()

    def evaluate(candidates, s):
        parts = [np.array(candidates[i : i + 5]) for i in range(0, len(candidates), 5)]
        return [fitness for part in parts for fitness in robot.evaluate(part, s, episodes=10)]

    many = 90 if environment.startswith("Cart") else 700
    return list(evolve(evaluate, np.array(centre), many, seed, 15, 0.2, 0.05)["centre"])


# %% one_side_after_the_other
# Other functions: repeat, sorting twice, einsum; a training that evaluates one side after the other.
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

    def evaluate(candidates, s):
        fitness = np.empty(len(candidates))
        for side in (1, 0):
            fitness[side::2] = robot.evaluate(candidates[side::2], s, 10)
        return fitness

    many = 70 if "CartPole" in environment else 500
    return evolve(evaluate, centre, many, seed, noiseStdDev=0.2, stepsize=0.05)["centre"]


# %% single_precision
# Single precision in every function but the whole algorithm; trains with weight decay.
def candidates_around(centre, samples, noiseStdDev):
    centre, samples = np.float32(centre), np.float32(samples)
    signs = np.array([noiseStdDev, -noiseStdDev], dtype=np.float32)[None, :, None]
    return (centre + signs * samples[:, None, :]).reshape(-1, len(centre))


def utilities(fitness):
    ranks = np.lexsort((np.arange(len(fitness)), fitness)).argsort()
    return (ranks / np.float32(len(fitness) - 1) - 0.5).astype(np.float32)


def gradient(samples, utilities):
    weights = np.float32(utilities).reshape(-1, 2) @ np.float32([1, -1])
    return (np.float32(samples).T @ weights) / np.float32(2 * len(samples))


def descent(gradient, centre, wdecay):
    pulls = np.float32([np.zeros(len(centre)), centre, np.sign(centre)])
    return np.float32(0.005) * pulls[wdecay] - np.float32(gradient)


def evolve(evaluate, centre, generations, seed, **settings):
    keys = ("samplesize", "noiseStdDev", "stepsize", "wdecay")
    samplesize, noise, stepsize, wdecay = (
        settings.get(key, default) for key, default in zip(keys, (20, 0.02, 0.01, 0), strict=True)
    )
    rng, n = np.random.default_rng(seed), len(centre)
    m = v = np.zeros(n)
    means = []
    for g in range(generations):
        e = rng.standard_normal((samplesize, n))
        pairs = np.stack([centre + noise * e, centre - noise * e], axis=1).reshape(-1, n)
        fitness = evaluate(pairs, seed + g)
        means += [np.mean(fitness)]
        u = np.argsort(np.argsort(fitness, kind="stable"), kind="stable") / (2 * samplesize - 1)
        d = -((u[::2] - u[1::2]) @ e) / (2 * samplesize)
        d += [0, 0.005 * centre, 0.005 * np.sign(centre)][wdecay]
        centre, m, v = adam(centre, d, m, v, g + 1, stepsize)
    return dict(history=means, centre=centre)


def train(environment, seed):
    robot = Robot(environment)
    first = np.append(
        np.zeros(robot.nbiases), np.random.default_rng(seed).normal(0, 0.1, robot.nweights)
    )
    long = environment == "Pendulum-v1"
    found = evolve(
        lambda candidates, s: robot.evaluate(candidates, s, 10), first, 700 if long else 120, seed,
        noiseStdDev=0.25, stepsize=0.06, wdecay=1,
    )  # fmt: skip
    return found["centre"].astype(np.float32)


# %% shrinking_steps_and_the_best_centre
# Several evolutions one after another with shorter steps, and the best centre of their ends.
def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    centre = 0.1 * rng.normal(size=robot.nbiases + robot.nweights)
    best, kept = -np.inf, centre
    for part, stepsize in enumerate((0.1, 0.08, 0.06, 0.04)):
        many = 30 if environment[0] == "C" else 150
        run = evolve(lambda rows, s: robot.evaluate(rows, s, 10), centre, many, seed + 999 * part,
                     24, 0.2, stepsize)  # fmt: skip
        centre = run["centre"]
        fitness = robot.evaluate(centre[None], seed + 5, 40)[0]
        if fitness >= best:
            best, kept = fitness, centre
    return kept


# %% starts_again_if_it_must
# Up to three evolutions from other starts.
def train(environment, seed):
    robot = Robot(environment)
    size, goal = robot.nbiases + robot.nweights, {"CartPole-v0": 198, "Pendulum-v1": -300}
    found = []
    for attempt in range(3):
        rng = np.random.default_rng((seed, attempt))
        centre = np.zeros(size)
        centre[robot.nbiases :] = rng.normal(scale=0.1, size=robot.nweights)
        centre = evolve(lambda rows, s: robot.evaluate(rows, s, episodes=8), centre,
                        120 if "Cart" in environment else 600, seed + attempt,
                        noiseStdDev=0.2, stepsize=0.06)["centre"]  # fmt: skip
        found.append((robot.evaluate(centre[None], seed + 5, episodes=60)[0], centre))
        if found[-1][0] > goal[environment]:
            break
    return max(found, key=lambda one: one[0])[1]


# %% generators_and_views
# Generators, partitions and views; a training that looks at its first centre before it begins.
def candidates_around(centre, samples, noiseStdDev):
    return np.vstack([centre + sign * noiseStdDev * e for e in samples for sign in (1, -1)])


def utilities(fitness):
    pairs = sorted((value, i) for i, value in enumerate(np.asarray(fitness).tolist()))
    places = {i: rank for rank, (_, i) in enumerate(pairs)}
    return np.fromiter((places[i] / (len(pairs) - 1) - 0.5 for i in range(len(pairs))), float)


def gradient(samples, utilities):
    plus, minus = np.asarray(utilities).reshape(-1, 2).T
    return np.tensordot(plus - minus, samples, 1) / (2 * len(samples))


def descent(gradient, centre, wdecay):
    match wdecay:
        case 1:
            return 0.005 * centre - gradient
        case 2:
            return 0.005 * ((centre > 0) * 1.0 - (centre < 0)) - gradient
        case _:
            return -gradient


def smooth(curve, width):
    return np.lib.stride_tricks.sliding_window_view(np.asarray(curve, float), width).mean(axis=1)


def stability(curve):
    curve = np.asarray(curve, dtype=float)
    falls = np.append(0, np.maximum.accumulate(curve)[:-1] - curve[1:])
    bottom = falls.argmax()
    peak = curve.tolist().index(max(curve[: bottom + 1]))
    height = np.ptp(curve)
    drop = falls[bottom] / height if height else 0.0
    verdict = next(
        word
        for limit, word in (
            (0.1, "monotonic"),
            (0.3, "mild regressions"),
            (2, "severe regressions"),
        )
        if drop <= limit
    )
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}


def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed + 11)
    centre = np.concatenate([np.zeros(robot.nbiases), rng.normal(0, 0.1, robot.nweights)])
    robot.evaluate(centre[None], seed, episodes=2)
    run = evolve(
        robot.evaluate, centre, 90 if "Cart" in environment else 600, seed,
        samplesize=18, noiseStdDev=0.22, stepsize=0.05,
    )  # fmt: skip
    return np.float32(run["centre"])


# %% first_look_at_all_pairs_alone
# Evaluates pair after pair, and keeps the best centre of several evolutions, one after another.
def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    centre = np.zeros(robot.nbiases + robot.nweights)
    centre[robot.nbiases :] = 0.1 * rng.standard_normal(robot.nweights)
    found = [(-np.inf, 0, centre)]

    def evaluate(candidates, s):
        pairs = [robot.evaluate(candidates[i : i + 2], s, 10) for i in range(0, 32, 2)]
        return np.concatenate(pairs)

    for stretch in range(2 if "Cart" in environment else 12):
        centre = evolve(evaluate, centre, 50, seed + 50 * stretch, 16, 0.2, 0.05)["centre"]
        found.append((robot.evaluate(centre[None], seed, 50)[0], stretch, centre))
    return max(found)[2]
