"""Compute what slips make of answers, and why right answers are right; for the grader."""

from functools import partial

import numpy as np

from botschool.grading import slips

# What is right, computed apart from any submission.


def around(centre, samples, noise):
    pairs = [(centre + noise * e, centre - noise * e) for e in samples]
    return np.array([each for pair in pairs for each in pair])


def ranked(fitness):
    order = sorted(range(len(fitness)), key=lambda i: (fitness[i], i))
    ranks = np.empty(len(fitness))
    ranks[order] = np.arange(len(fitness))
    return ranks / (len(fitness) - 1) - 0.5


def estimated(samples, utilities):
    return np.sum((utilities[0::2] - utilities[1::2])[:, None] * samples, axis=0) / len(utilities)


def decayed(gradient, centre, wdecay):
    return -gradient + 0.005 * (0, centre, np.sign(centre))[wdecay]


def adam_step(centre, d, m, v, t, stepsize):
    m, v = 0.9 * m + 0.1 * d, 0.999 * v + 0.001 * d**2
    corrected = np.sqrt(v / (1 - 0.999**t)) + 1e-8
    return centre - stepsize * m / (1 - 0.9**t) / corrected, m, v


def why_candidate(centre, samples, noise, row: int, i: int) -> str:
    sign, b = "-+"[row % 2 == 0], row // 2
    return (
        f"Row {row} is centre {sign} noiseStdDev * samples[{b}]: at [{row}, {i}], "
        f"{centre[i]:.5g} {sign} {noise:g} * {samples[b, i]:.5g}."
    )


def mistaken_candidates(centre, samples, noise) -> dict:
    """What slips make of the candidates: sentence -> array."""

    def made(length, middle, sides, rows):
        pair = [middle + sign * length * samples for sign in sides]
        return rows(pair).reshape(-1, len(centre))

    lengths = np.linalg.norm(samples, axis=1, keepdims=True)
    return slips(
        made,
        length={
            "": noise,
            "The samples are used as they are, not divided by their lengths.": noise / lengths,
            "noiseStdDev is left out.": 1.0,
            "noiseStdDev is a standard deviation: multiply by it, not by its root.": noise**0.5,
            "noiseStdDev is a standard deviation: multiply by it, not by its square.": noise**2,
            "Divide nothing by noiseStdDev: it multiplies the samples.": 1 / noise,
            "A candidate is noiseStdDev * sample away from the centre, not half of that.": noise
            / 2,
        },
        middle={
            "": centre,
            "The centre is left out: add it to each row.": 0 * centre,
            "noiseStdDev multiplies the samples alone, not the centre, too.": noise * centre,
        },
        sides={
            "": (1, -1),
            "Minus comes before plus.": (-1, 1),
            "Both candidates of a sample are on the plus side: subtract for row 2 b + 1.": (1, 1),
            "Both candidates of a sample are on the minus side: add for row 2 b.": (-1, -1),
            "Row 2 b + 1 is the centre itself: subtract noiseStdDev * samples[b] from it.": (1, 0),
        },
        rows={
            "": lambda pair: np.stack(pair, axis=1),
            "All plus come before all minus, but the two of a sample belong together.": np.vstack,
        },
    )


def why_ranked(fitness, i: int) -> str:
    n = len(fitness)
    rank = round((ranked(fitness)[i] + 0.5) * (n - 1))
    ends = " (the worst)" if rank == 0 else " (the best)" if rank == n - 1 else ""
    return (
        f"Candidate {i} with the fitness {fitness[i]:g} has the rank {rank}{ends} of 0 to {n - 1}, "
        f"so its utility is {rank} / {n - 1} - 0.5."
    )


def equals_exchanged(fitness, answer) -> dict:
    """A sentence, if candidates of equal fitness have each other's utilities; else nothing."""
    wanted, fitness = ranked(fitness), np.asarray(fitness, dtype=float)
    if np.shape(answer) != wanted.shape:
        return {}
    answer = np.asarray(answer, dtype=float)
    among = [fitness == value for value in np.unique(fitness)]
    if not all(np.allclose(np.sort(answer[equal]), np.sort(wanted[equal])) for equal in among):
        return {}
    text = "Candidates of equal fitness have the right ranks in another order: of equals, the one "
    return {text + "that comes first has the lower rank (np.argsort needs kind='stable').": answer}


def mistaken_utilities(fitness, answer=None) -> dict:
    """What slips make of the utilities: sentence -> array."""
    fitness, n = np.asarray(fitness, dtype=float), len(fitness)
    shared = [np.flatnonzero(np.sort(fitness) == each) for each in fitness]
    ranks = (n - 1) * (ranked(fitness) + 0.5)
    from_best = (n - 1) * (ranked(-fitness) + 0.5)
    equals = {
        f"Equals share their {word} rank, but the one that comes first has the lower one.":
        np.array([rank(each) for each in shared])
        for word, rank in (("mean", np.mean), ("lowest", np.min), ("highest", np.max))
    }  # fmt: skip
    spread = fitness - fitness.min()
    return {
        "All get 0 where all are equal, but equals have ranks of their own.":
        0 * fitness if spread.max() == 0 else ranked(fitness),
        "All get 0.": 0 * fitness,
        "The fitness is standardised: its size is not to count, only its ranks.":
        (fitness - fitness.mean()) / (fitness.std() or 1),
    } | slips(
        lambda rank, first, divisor, middle, scale: scale * ((rank + first) / divisor - middle),
        rank={
            "": ranks,
            **equals,
            "Of equals the last has the lower rank, but the first is to have it.":
            (n - 1) * (ranked(fitness[::-1])[::-1] + 0.5),
            "The best gets the rank 0, but the best is to have n - 1.": n - 1 - ranks,
            "The best gets the rank 0, but the best is to have n - 1: fitness is sorted from the "
            "best to the worst.": from_best,
            "np.argsort gives the order of the candidates, not their ranks.":
            np.argsort(fitness, kind="stable"),
            "The utilities are sorted: number i is to be that of candidate i.":
            np.arange(n),
            "The fitness itself is scaled: its size is not to count, only its ranks.":
            (n - 1) * spread / (spread.max() or 1.0),
            "The fitness itself is used: only its ranks are to count.": fitness,
        },
        first={"": 0, "The ranks begin at 1, but the worst has the rank 0.": 1},
        divisor={
            "": n - 1,
            "The ranks are divided by n; divide by the highest rank, n - 1.": n,
            "The ranks are divided by n + 1; divide by the highest rank, n - 1.": n + 1,
            "The ranks are not divided by n - 1.": 1,
        },
        middle={
            "": 0.5,
            "The utilities are not centred: subtract 0.5.": 0,
            "Subtract 0.5, not 1.": 1,
            "Subtract 0.5, not the half of n - 1.": (n - 1) / 2,
        },
        scale={
            "": 1,
            "The utilities run from -1 to 1; they are to run from -0.5 to 0.5.": 2,
            "The sign is reversed: the best is to have 0.5, the worst -0.5.": -1,
        },
    ) | equals_exchanged(fitness, answer)  # fmt: skip


def why_gradient(samples, utilities, i: int) -> str:
    pairs = zip(utilities[0::2], utilities[1::2], samples[:, i], strict=True)
    parts = [f"({plus:.3g} - {minus:.3g}) * {e:.4g}" for plus, minus, e in pairs]
    more = " + ..." if len(parts) > 3 else ""
    return f"At [{i}] it is ({' + '.join(parts[:3])}{more}) / {len(utilities)}."


def mistaken_gradient(samples, utilities, answer) -> dict:
    """What slips make of the gradient: sentence -> array."""
    many, n = samples.shape
    plus, minus = utilities[0::2], utilities[1::2]
    shapes = {
        (): "All is added up to a single number: add up over the samples only, so that each "
        "parameter keeps a number of its own.",
        (many,): "The sum goes over the parameters: add up over the samples.",
        (many, n): "The weighted samples are not added up.",
        (2 * many, n): "The samples are not added up.",
    }
    shape = np.shape(answer)
    if shape != (n,) and shape in shapes:
        return {shapes[shape]: answer}
    return slips(
        lambda weights, divisor, vectors: weights @ vectors / divisor,
        weights={
            "": plus - minus,
            "The two utilities of a sample are added: the one of the minus side is to be "
            "subtracted.": plus + minus,
            "The utilities of the minus candidates are left out.": plus,
            "The utilities of the plus candidates are left out.": -minus,
            "The difference is the wrong way round: plus minus minus.": minus - plus,
            "The first half of the utilities is taken for plus: plus and minus alternate.":
            utilities[:many] - utilities[many:],
            "Only which side won counts here: weight by the difference.": np.sign(plus - minus),
            "The difference loses its sign: a sample that points downhill has a negative weight.":
            np.abs(plus - minus),
            "Samples whose minus side won are left out: they have a negative weight.":
            np.maximum(plus - minus, 0),
            "The weights are squared: weight by the difference itself.": (plus - minus) ** 2,
            "The weights are left out.": np.ones(many),
        },
        divisor={
            "": 2 * many,
            "The sum is divided by samplesize: divide by the number of candidates, twice as many.":
            many,
            "The sum is not divided: divide by the number of candidates, 2 * samplesize.": 1,
            "The sum is divided by 2 only: divide by 2 * samplesize.": 2,
            "The sum is divided by the number of parameters, not of candidates.": n,
            "The sum is divided by twice the number of parameters, not of samples.": 2 * n,
            "Divide by the number of candidates, 2 * samplesize, not by one less.": 2 * many - 1,
            "Divide by 2 * samplesize, not by 4 * samplesize.": 4 * many,
            "Divide by 2 * samplesize, not by its root.": (2 * many) ** 0.5,
        },
        vectors={
            "": samples,
            "The samples are used as they are, not divided by their lengths.":
            samples / np.linalg.norm(samples, axis=1, keepdims=True),
            "The samples come in reverse order.": samples[::-1],
        },
    )  # fmt: skip


def why_descent(gradient, centre, wdecay, i: int) -> str:
    pull = ("", f" + 0.005 * {centre[i]:.5g}", f" + 0.005 * sign({centre[i]:.5g})")[wdecay]
    none = "" if wdecay else ": there is no pull"
    return f"With wdecay {wdecay}, at [{i}] it is -({gradient[i]:.5g}){pull}{none}."


def mistaken_descent(gradient, centre, wdecay) -> dict:
    """What slips make of the direction: sentence -> array."""
    pulls = {
        "The decay is left out.": 0 * centre,
        "wdecay 0 asks for no decay, but there is one.": centre,
        "wdecay 0 asks for no decay, but there is one by the signs.": np.sign(centre),
        "The decay of the other kind (wdecay) is taken.": (0, np.sign(centre), centre)[wdecay],
        "The sign of the gradient is taken: the pull is by the sign of the centre.":
        np.sign(gradient),
        "The gradient is pulled: the pull is in proportion to the centre.": gradient,
        "The centre is divided by its length: the pull is in proportion to the centre itself.":
        centre / max(float(np.linalg.norm(centre)), 1e-300),
        "The pull takes |centre|: parameters below 0 go away from 0.": np.abs(centre),
        "The pull takes the square of the centre: wdecay 1 is in proportion to it.": centre**2,
        "The sign of 0 is 0: a parameter that is 0 is not pulled.": np.where(centre < 0, -1, 1),
        "The pull is the same for all: each parameter has a pull of its own.": centre.sum(),
        "The pull grows with wdecay, a number of a kind.": wdecay * centre,
        "Both pulls are added up: each wdecay has one of its own.": centre + np.sign(centre),
    }  # fmt: skip
    return slips(
        lambda uphill, rate, pull: uphill + rate * pull,
        uphill={
            "": -gradient,
            "The gradient has the wrong sign: Adam descends, but fitness is to rise.": gradient,
            "The gradient is left out.": 0 * gradient,
        },
        rate={
            "": 0.005,
            "The decay has the wrong sign: it pushes the centre away from 0.": -0.005,
            "The factor 0.005 of the decay is left out.": 1,
            "The factor of the decay is 0.005, not 0.05.": 0.05,
            "The factor of the decay is 0.005, not 0.5.": 0.5,
            "The factor of the decay is 0.005, not 0.0005.": 0.0005,
            "The factor of the decay is 0.005, not 0.01.": 0.01,
            "The decay is half as strong as it should be.": 0.0025,
        },
        pull={"": (0 * centre, centre, np.sign(centre))[wdecay], **pulls},
    )  # fmt: skip


def why_mean(centre, d, m, v, t, stepsize, name: str, i: int) -> str:
    if name == "m":
        return f"At [{i}] it is 0.9 * {m[i]:.5g} + 0.1 * {d[i]:.5g}."
    return f"At [{i}] it is 0.999 * {v[i]:.5g} + 0.001 * ({d[i]:.5g})^2."


def why_step(centre, d, m, v, t, stepsize, i: int) -> str:
    _, m, v = adam_step(centre, d, m, v, t, stepsize)
    first, second = m[i] / (1 - 0.9**t), v[i] / (1 - 0.999**t)
    return (
        f"With t = {t}, at [{i}] the corrected m is {m[i]:.5g} / (1 - 0.9^{t}) = {first:.5g} and "
        f"the corrected v is {v[i]:.5g} / (1 - 0.999^{t}) = {second:.5g}; the new centre is "
        f"{centre[i]:.5g} - {stepsize:g} * {first:.5g} / (sqrt({second:.5g}) + 1e-8)."
    )


def mistaken_means(centre, d, m, v, t, stepsize) -> dict:
    """What slips make of the running means: {"m": sentence -> array, "v": ...}."""
    found = {}
    for name, old, new, keep in (("m", m, d, 0.9), ("v", v, d**2, 0.999)):
        other, what = (0.999, "d") if name == "m" else (0.9, "d squared")
        news = {
            "The size of d is averaged, not its square.": np.abs(d),
            "d is averaged, not its square.": d,
            "v is a mean for each parameter: do not average d squared over all.": np.mean(new),
            "v is a mean for each parameter: do not add d squared up over all.": np.sum(new),
            "The square of d - m is averaged, not that of d.": (d - 0.9 * m - 0.1 * d) ** 2,
            "The square of m is averaged, not that of d.": (0.9 * m + 0.1 * d) ** 2,
            "0.001 multiplies the square: it is squared itself here.": 0.001 * new,
        }
        if name == "m":
            news = {"d has the wrong sign in m.": -d, "m averages d, not its square.": d**2,
                    "m averages d, not its sign.": np.sign(d)}  # fmt: skip
        found[name] = {
            "m and v are exchanged: return the centre, m and v in this order.": 0.999 * v
            + 0.001 * d**2
            if name == "m"
            else 0.9 * m + 0.1 * d,
            (
                "The corrected value is returned: correct it for this step only."
                if t > 1
                else f"Either the corrected value is returned, or the factor {1 - keep:.3g} of "
                f"{what} is left out."
            ): (keep * old + (1 - keep) * new) / (1 - keep**t),
            f"The old {name} is returned: return the new one.": old,
            **{
                f"The new {name} is {keep} times the old one, not {other:.4g} times.": other * old
                + (1 - other) * new
                for other in (0.5, 0.8, 0.95, 0.98, 0.99, 0.999, 0.9999)
                if other != keep
            },
            "0.9 belongs to m and 0.999 to v: they are exchanged.": other * old + (1 - other) * new,
        } | slips(
            lambda kept, share, new, old=old: kept * old + share * new,
            kept={
                "": keep,
                f"The old {name} is left out: {keep} times it stays.": 0,
                f"The old {name} is to be multiplied by {keep}.": 1,
                f"{keep} and {1 - keep:.3g} are exchanged.": 1 - keep,
            },
            share={
                "": 1 - keep,
                f"The factor {1 - keep:.3g} of {what} is left out.": 1,
                f"The factor of {what} is {1 - keep:.3g}, not {keep}.": keep,
                f"The factor of {what} is {1 - keep:.3g}, not {1 - other:.3g}.": 1 - other,
            },
            new={"": new, **news},
        )
    return found


def mistaken_step(centre, d, m, v, t, stepsize) -> dict:
    """What slips make of the new centre: sentence -> array."""
    new_m, new_v = adam_step(centre, d, m, v, t, stepsize)[1:]

    def made(length, mean, size, shares, root, small):
        return centre - length * (mean / shares[0]) / small(root, size / shares[1])

    def shares(t):
        return 1 - 0.9**t, 1 - 0.999**t

    first, second = shares(t)
    found = slips(
        made,
        shares={
            "": (first, second),
            "The correction of m and v for the first steps is left out.": (1, 1),
            "The correction of m is left out: divide it by 1 - 0.9^t.": (1, second),
            "The correction of v is left out: divide it by 1 - 0.999^t.": (first, 1),
            "t counts from 1 already: correct with t, not with t + 1.": shares(t + 1),
            "Correct with t, not with t - 1.": shares(max(t - 1, 0.5)),
            "t is left out of the correction: the powers are 0.9^t and 0.999^t.": shares(1),
            "m is corrected by 1 - 0.9^t, v by 1 - 0.999^t: both have 0.9 here.": (first, first),
            "m is corrected by 1 - 0.9^t, v by 1 - 0.999^t: both have 0.999 here.":
            (second, second),
            "The two corrections are exchanged: 0.9 belongs to m, 0.999 to v.": (second, first),
            "Divide by the shares 1 - 0.9^t and 1 - 0.999^t, do not multiply.":
            (1 / first, 1 / second),
            "The shares are 1 - 0.9^t and 1 - 0.999^t: the 1 - is left out.": (0.9**t, 0.999**t),
            "The shares are 1 - 0.9^t and 1 - 0.999^t: multiplied by t here, not raised to it.":
            (1 - 0.9 * t, 1 - 0.999 * t),
        },
        mean={
            "": new_m,
            "The step is made with the old m.": m,
            "The step goes along d: it goes along its mean m.": d,
            "The step goes by the sign of m alone.": np.sign(new_m),
        },
        size={
            "": new_v,
            "The step is made with the old v.": v,
            "The step is divided by the size of d, not by the root of its mean square.": d**2,
            "The root is to be taken of each parameter's v, not of their mean.": new_v.mean(),
        },
        root={
            "": np.sqrt,
            "The root of v is left out.": np.asarray,
            "v is squared where its root is asked for.": np.square,
        },
        small={
            "": lambda root, value: root(value) + 1e-8,
            "1e-8 is added inside the root: add it after the root is taken.":
            lambda root, value: root(value + 1e-8),
            "1e-8 is left out.": lambda root, value: root(value),
            "1e-8 is too large here.": lambda root, value: root(value) + 1e-6,
            "The division by the root of v is left out.": lambda root, value: 1.0,
            "The step is multiplied by the root of v: divide by it.":
            lambda root, value: 1 / (root(value) + 1e-8),
        },
        length={
            "": stepsize,
            "The step goes the wrong way.": -stepsize,
            "stepsize is left out.": 1.0,
            "stepsize is squared.": stepsize**2,
            "The step is divided by t: stepsize stays the same.": stepsize / t,
        },
    )  # fmt: skip
    # where nothing moves, many slips look alike
    return {text: each for text, each in found.items() if not np.allclose(each, centre, 1e-5)}


DRAWS = {
    "": lambda rng, seed, g, shape: rng.standard_normal(shape),
    "The samples are to be drawn anew in each generation: here they stay the same.":
    lambda rng, seed, g, shape: np.random.default_rng(seed).standard_normal(shape),
    "Make the generator rng once, before the loop: here each generation has a new one.":
    lambda rng, seed, g, shape: np.random.default_rng(seed + g).standard_normal(shape),
    "Draw an array of the shape (samplesize, n), not (n, samplesize).":
    lambda rng, seed, g, shape: rng.standard_normal(shape[::-1]).T,
    "The samples are Gaussian numbers (standard_normal), not uniform ones.":
    lambda rng, seed, g, shape: rng.uniform(-1, 1, shape),
    "Draw nothing but the samples of a generation from rng: more is drawn before them.":
    lambda rng, seed, g, shape: [rng.standard_normal(shape), rng.standard_normal(shape)][1],
}  # fmt: skip
"""How samples are drawn, by sentence."""

KEPT = {
    "": lambda f, before, after: np.mean(f),
    "It is the fitness of the best candidate, but the mean is asked for.":
    lambda f, before, after: np.max(f),
    "It is the fitness of the worst candidate, but the mean is asked for.":
    lambda f, before, after: np.min(f),
    "It is the median of the fitness, but the mean is asked for.":
    lambda f, before, after: np.median(f),
    "It is the sum of the fitness, but the mean is asked for.": lambda f, before, after: np.sum(f),
    "It is the fitness of the centre before the step; the mean of all candidates is asked for.":
    lambda f, before, after: before,
    "It is the fitness of the centre after the step; the mean of all candidates is asked for.":
    lambda f, before, after: after,
    "The mean goes over the plus candidates only.": lambda f, before, after: np.mean(f[0::2]),
    "It is 0 in every generation; the mean of the fitness is asked for, not of the utilities.":
    lambda f, before, after: 0.0,
    "It is the mean of minus the fitness.": lambda f, before, after: -np.mean(f),
}  # fmt: skip
"""What a history keeps of a generation, by sentence."""

RETURNED = {
    "": lambda seen: seen[-1]["after"],
    "The last step is missing in it: every generation makes one.": lambda seen: seen[-1]["before"],
    "This is the best of all candidates; the centre after the last generation is asked for.":
    lambda seen: max(seen, key=lambda one: one["max"])["best"],
    "This is the best candidate of the last generation; the centre after it is asked for.":
    lambda seen: seen[-1]["best"],
    "This is the first centre of all.": lambda seen: seen[0]["before"],
    "This is the centre of the generation with the best mean; the last one is asked for.":
    lambda seen: max(seen, key=lambda one: one["mean"])["before"],
    "This is the centre after the generation with the best mean; the last one is asked for.":
    lambda seen: max(seen, key=lambda one: one["mean"])["after"],
}  # fmt: skip
"""What a run returns, by sentence."""


def run_again(
    evaluate, start, generations, seed, settings, slip=None, options=None, draw=DRAWS[""],
    seeds=lambda seed, g: seed + g, time=lambda g: g + 1, keeps=(1, 1), kept=KEPT[""],
    returned=RETURNED[""], samples=1.0, uphill=1.0, decays=False, looks=True,
) -> tuple[list, np.ndarray]:  # fmt: skip
    """The history and the centre of a run, or what slips make of them."""
    samplesize, noise, stepsize, wdecay = (settings | (options or {})).values()
    rng, centre, history, seen = np.random.default_rng(seed), start, [], []
    m, v = np.zeros(len(start)), np.zeros(len(start))
    for g in range(generations):
        e = samples * draw(rng, seed, g, (samplesize, len(start)))
        candidates = around(centre, e, noise / samples)
        fitness, before = evaluate(candidates, seeds(seed, g)), centre
        d = uphill * estimated(e, ranked(fitness))
        d = decayed(d, start if decays else centre, wdecay)
        centre, m, v = adam_step(centre, d, keeps[0] * m, keeps[1] * v, time(g), stepsize)
        ends = [evaluate(each[None], seed + g)[0] if looks else 0 for each in (before, centre)]
        history.append(kept(fitness, *ends))
        best = candidates[np.argmax(fitness)]
        seen.append({"max": max(fitness), "mean": np.mean(fitness), "best": best,
                     "before": before, "after": centre})  # fmt: skip
    return history, returned(seen) if seen else centre


def mistaken_runs(evaluate, start, generations, seed, settings) -> dict:
    """What slips make of a run: sentence -> (history, centre)."""
    defaults = {"noiseStdDev": 0.02, "samplesize": 20, "stepsize": 0.01}
    return slips(
        partial(run_again, evaluate, start, generations, seed, settings),
        most=2 if generations < 2 else 1,
        options={"": {}, "The weight decay (wdecay) is not handed on.": {"wdecay": 0}}
        | {
            f"{key} is not handed on: the default is taken.": {key: default}
            for key, default in defaults.items()
            if settings[key] != default
        },
        seeds={
            "": lambda seed, g: seed + g,
            "The seeds begin with seed + 1, but the first generation's is seed.":
            lambda seed, g: seed + 1 + g,
            "All generations are evaluated with seed: generation g is to have seed + g.":
            lambda seed, g: seed,
            "The generations are evaluated with g: generation g is to have seed + g.":
            lambda seed, g: g,
            "The generations are evaluated with seed * g: generation g is to have seed + g.":
            lambda seed, g: seed * g,
        },
        kept=KEPT,
        returned=RETURNED,
        draw=DRAWS,
        time={
            "": lambda g: g + 1,
            "Adam's t is 1 in every generation: it is generation + 1.": lambda g: 1,
            "Adam's t is 1 in the first two generations: it is generation + 1.":
            lambda g: max(1, g),
            "Adam's t begins at 2: it is generation + 1.": lambda g: g + 2,
            "Adam's t is the number of all generations: it is generation + 1.":
            lambda g: generations,
        },
        keeps={
            "": (1, 1),
            "m and v begin anew in every generation: hand on those that adam returns.": (0, 0),
            "m begins anew in every generation: hand on the one that adam returns.": (0, 1),
            "v begins anew in every generation: hand on the one that adam returns.": (1, 0),
        },
        samples={
            "": 1.0,
            "gradient gets samples times noiseStdDev: it takes them as they were drawn.":
            settings["noiseStdDev"],
        },
        uphill={
            "": 1.0,
            "The run goes downhill: each step is to lead the opposite way.": -1.0,
        },
        decays={"": False, "The first centre is pulled, not the present one.": True},
    )  # fmt: skip


def why_drop(curve: np.ndarray, right: dict) -> str:
    high, low = float(curve[right["peak"]]), float(curve[right["bottom"]])
    if right["bottom"] == right["peak"]:
        return "The curve never falls: the drop is 0.0."
    return (
        f"Its largest fall is from {high:.6g} at [{right['peak']}] to {low:.6g} at "
        f"[{right['bottom']}]; its height is {curve.max():.6g} - {curve.min():.6g}."
    )


def longest_run_down(curve: np.ndarray) -> float:
    """The largest fall without a rise on the way."""
    largest, start = 0.0, 0
    for i in range(1, len(curve)):
        start = i if curve[i] > curve[i - 1] else start
        largest = max(largest, float(curve[start] - curve[i]))
    return largest


def mistaken_drops(curve: np.ndarray, drop) -> dict:
    """What slips make of the drop: sentence -> number."""
    curve = np.asarray(curve, dtype=float)
    falls, span = np.maximum.accumulate(curve) - curve, max(float(np.ptp(curve)), 1e-300)
    top, right = curve[: int(np.argmax(falls)) + 1].max(), falls.max() / span
    places = min(4, max(1, len(str(drop).partition(".")[2])))
    return slips(
        lambda fall, height, factor: factor * fall / (height or 1.0),
        fall={
            "": falls.max(),
            "Only falls from one value to the next are looked at: a fall may take many.":
            max(0.0, -np.diff(curve, prepend=curve[0]).min()),
            "Only the end is compared with the highest point: falls that recover count, too.":
            curve.max() - curve[-1],
            "The fall from the highest point of all is taken: there may be a larger one before.":
            curve.max() - curve[int(np.argmax(curve)) :].min(),
            "This is the whole height, whether the curve rises or falls.": span,
            "The falls are added up: the largest one counts.": falls.sum(),
            "The fall begins anew after each rise in yours: a small rise on the way is a part of "
            "it, measure from the highest value so far.": longest_run_down(curve),
            "The mean of the falls is taken: the largest one counts.": falls.mean(),
            "The fall is measured from the first value, not from the highest one before.":
            max(0.0, curve[0] - curve.min()),
            "The rises are taken for falls.": (curve - np.minimum.accumulate(curve)).max(),
        },
        height={
            "": span,
            "The drop is to be a share of the curve's whole range.": 1.0,
            "The fall is divided by the highest value: divide by max - min.": curve.max(),
            "The fall is divided by the height that it fell from: divide by max - min.": top,
            "The fall is divided by the size of the height that it fell from: divide by max - min.":
            abs(top),
            "The fall is divided by the size of the highest value: divide by max - min.":
            abs(curve.max()),
            "The fall is divided by the size of the lowest value: divide by max - min.":
            abs(curve.min()),
            "The fall is divided by the size of the last value - the first one: divide by "
            "max - min.": abs(curve[-1] - curve[0]),
            "The fall is divided by max - the first value: divide by max - min.":
            curve.max() - curve[0],
            "The fall is divided by the last value - the first one: divide by max - min.":
            curve[-1] - curve[0],
            "The fall is divided by max + min: divide by max - min.": curve.max() + curve.min(),
            "The fall is divided by the standard deviation: divide by max - min.": curve.std(),
        },
        factor={
            "": 1.0,
            "It is a share of 100 (percent), but a share of 1 is asked for.": 100.0,
            "A fall is a positive drop: the sign is wrong.": -1.0,
        },
    ) | {"It is rounded: return it as it is.": round(right, places)}  # fmt: skip


def mistaken_places(curve: np.ndarray) -> dict:
    """What slips make of the two indices: sentence -> {"peak": index, "bottom": index}."""
    falls = np.maximum.accumulate(curve) - curve
    bottom = int(np.argmax(falls))
    peak, last = int(np.argmax(curve[: bottom + 1])), len(curve) - 1
    later = last - int(np.argmax(falls[::-1])) if falls.any() else 0
    return {
        "The peak is the highest value up to the bottom, not of the whole curve.":
        {"peak": int(np.argmax(curve)), "bottom": bottom},
        "The bottom is where the fall is largest, not where the curve is lowest.":
        {"peak": int(np.argmax(curve[: np.argmin(curve) + 1])), "bottom": int(np.argmin(curve))},
        "The bottom is the end of the largest fall, not where the curve is lowest.":
        {"peak": peak, "bottom": int(np.argmin(curve))},
        "The bottom is where the largest fall ends, not the lowest value after the peak of all.":
        {"peak": int(np.argmax(curve)),
         "bottom": int(np.argmax(curve) + np.argmin(curve[int(np.argmax(curve)) :]))},
        "Of equal heights before the fall the first one is the peak, not the last one.":
        {"peak": bottom - int(np.argmax(curve[bottom::-1])), "bottom": bottom},
        "Of equal falls the first one counts, not the last one.":
        {"peak": peak, "bottom": last - int(np.argmax(falls[::-1]))},
        "Of equal falls the first one counts, with its peak, not the last one.":
        {"peak": int(np.argmax(curve[: later + 1])), "bottom": later},
        "Peak and bottom are exchanged.": {"peak": bottom, "bottom": peak},
        "Indices count from 0.": {"peak": peak + 1, "bottom": bottom + 1},
        "Peak and bottom are indices, not the values there.":
        {"peak": curve[peak], "bottom": curve[bottom]},
        "The peak is the place before the bottom only if the fall takes one step.":
        {"peak": max(0, bottom - 1), "bottom": bottom},
    }  # fmt: skip


MISTAKEN_VERDICTS = {
    "The drop is rounded to one digit before it is compared; compare it as it is.":
    lambda drop: (round(drop, 1) > 0.1) + (round(drop, 1) > 0.3),
    "The drop is rounded to a whole number before it is compared; compare it as it is.":
    lambda drop: (round(drop) > 0.1) + (round(drop) > 0.3),
    "Exactly 0.1 and 0.3 still have the better verdict: compare with `<=`.":
    lambda drop: (drop >= 0.1) + (drop >= 0.3),
    "Exactly 0.1 is still monotonic: compare with `<=`.":
    lambda drop: (drop >= 0.1) + (drop > 0.3),
    "Exactly 0.3 is still mild: compare with `<=`.": lambda drop: (drop > 0.1) + (drop >= 0.3),
    "The verdicts are in the wrong order: small drops are monotonic.":
    lambda drop: 2 - (drop > 0.1) - (drop > 0.3),
    "The limits are shares, 0.1 and 0.3, not 10 and 30.": lambda drop: 0,
    "Only a drop of 0 is monotonic in yours: at most 0.1 is.":
    lambda drop: (drop > 0) + (drop > 0.3),
    "There is no mild verdict in yours: more than 0.1 and at most 0.3.":
    lambda drop: 2 * (drop > 0.1),
    "There is no severe verdict in yours: more than 0.3.": lambda drop: int(drop > 0.1),
}  # fmt: skip
"""What mistakes make of a drop: a place in VERDICTS, by sentence."""


def why_verdicts(drops: list[float], places: list[int]) -> str:
    """Where a submission's verdicts change, which are right at other limits; "" if nowhere."""
    told = []
    for number, (limit, one, other) in enumerate(
        ((0.1, "monotonic", "mild"), (0.3, "mild", "severe")), 1
    ):
        below = [drop for drop, place in zip(drops, places, strict=True) if place < number]
        above = [drop for drop, place in zip(drops, places, strict=True) if place >= number]
        if not below or not above or max(below) > min(above):
            return ""
        if not max(below) <= limit <= min(above):
            told.append(
                f"In yours, {one} becomes {other} between the drops {max(below):.3g} and "
                f"{min(above):.3g}: the limit is {limit}."
            )
    return " ".join(told)


def why_untrained(
    rows: np.ndarray,
    generations: list[tuple],
    centre: np.ndarray,
    share: float,
    calls,
    nbiases,
    goal: float,
) -> str:
    """What is known about a training that does not reach the goal.

    share: how well the gradients explain the way to the centre, from -1 to 1. calls: the seed and
    the episodes of each call of robot.evaluate.
    """
    if not len(rows):
        return "While it ran, robot.evaluate was never called."
    if not generations:
        return (
            "Among all that robot.evaluate was given there are no two pairs in a row, c + s e and "
            "c - s e, around one centre c: evolve makes such pairs."
        )
    pairs, noise = len(generations[0][1]), float(np.median([np.std(e) for _, e, _ in generations]))
    size = f"with a noiseStdDev of about {noise:.2g}"
    if len(generations) < 2:
        return f"It evaluated pairs of candidates around one centre only: {pairs} of them, {size}."
    told = f"It evaluated pairs of candidates around {len(generations)} centres, {size}."
    centres = np.array([middle for middle, _, _ in generations])
    if np.allclose(centre, centres[0], 1e-6, 1e-9):
        return f"{told} It returned the first centre of these, where the search begins."
    sides = [c + sign * e for c, e, _ in generations for sign in (1, -1)]
    if any((np.abs(side - centre).max(axis=1) < 1e-5).any() for side in sides):
        return f"{told} It returned one of these candidates, but a centre is asked for."
    step = float(np.median(np.abs(np.diff(centres, axis=0)).max(axis=1)))
    far = float(np.abs(centres - centre).max(axis=1).min())
    if step and far > 3 * step:
        return (
            f"{told} What it returned is none of their centres: from the nearest one it differs by "
            f"up to {far:.2g} in a parameter, but a step changes one by about {step:.2g}."
        )
    if share < -0.6:
        return (
            f"{told} Its centre moves against their gradients, to where fitness is lower, but "
            "fitness is to rise."
        )
    flat = np.mean([np.ptp(fitness) == 0 for _, _, fitness in generations])
    if flat > 0.3:
        return f"{told} In {flat:.0%} of these generations all candidates have the same fitness."
    told += f" One step changes the parameter that it moves most by about {step:.2g}."
    biases, weights = centres[0][:nbiases], centres[0][nbiases:]
    if not np.allclose(biases, 0, atol=1e-6):
        told += " The biases of the first centre are not 0."
    if not 0.05 < np.std(weights) < 0.2:
        told += (
            f" The weights of the first centre have the standard deviation {np.std(weights):.2g}, "
            "but 0.1 is asked for."
        )
    seeds, episodes = np.reshape(calls, (-1, 2)).T
    if len(seeds) > 1 and np.ptp(seeds) == 0:
        told += f" All calls of robot.evaluate had the seed {seeds[0]:.0f}, so the same episodes."
    if len(episodes) and episodes.max() < 3:
        many = "episode" if episodes.max() == 1 else "episodes"
        told += f" Fitness is the mean of {episodes.max():.0f} {many} only."
    few = max(1, min(10, len(generations) // 2))
    first, last = (
        np.mean([np.mean(fitness) for _, _, fitness in part])
        for part in (generations[:few], generations[-few:])
    )
    some = f"{few} generations" if few > 1 else "generation"
    told += f" The mean fitness of the first {some} is {first:.4g}, that of the last {last:.4g}."
    if last >= goal:
        return f"{told} So the last candidates reach the goal, but what train returned does not."
    return f"{told} HINTS.md names values that are enough for both problems."
