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
        f"Row {row} should be centre {sign} noiseStdDev * samples[{b}], so at [{row}, {i}] it "
        f"should be {centre[i]:.5g} {sign} {noise:g} * {samples[b, i]:.5g}."
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
            "The samples are divided by their lengths, but should be used as they are.": noise
            / lengths,
            "noiseStdDev is left out: the samples should be multiplied by it.": 1.0,
            "The samples are multiplied by the root of noiseStdDev instead of by noiseStdDev "
            "itself.": noise**0.5,
            "The samples are multiplied by the square of noiseStdDev instead of by noiseStdDev "
            "itself.": noise**2,
            "The samples are divided by noiseStdDev, but should be multiplied by it.": 1 / noise,
            "The candidates are half as far from the centre as they should be.": noise / 2,
        },
        middle={
            "": centre,
            "The centre is left out, but should be added to each row.": 0 * centre,
            "The centre is multiplied by noiseStdDev, too, but only the samples should be.": noise
            * centre,
        },
        sides={
            "": (1, -1),
            "Minus comes before plus, but the plus candidate should come first.": (-1, 1),
            "Both candidates of a sample are on the plus side, but row 2 b + 1 should be centre - "
            "noiseStdDev * samples[b].": (1, 1),
            "Both candidates of a sample are on the minus side, but row 2 b should be centre + "
            "noiseStdDev * samples[b].": (-1, -1),
            "The second candidate of a sample is the centre itself, but should be centre - "
            "noiseStdDev * samples[b].": (1, 0),
        },
        rows={
            "": lambda pair: np.stack(pair, axis=1),
            "The first candidates of all samples come before all second ones, but the two of a "
            "sample should be neighbours (rows 2 b and 2 b + 1).": np.vstack,
        },
    )


def why_ranked(fitness, i: int) -> str:
    n = len(fitness)
    rank = round((ranked(fitness)[i] + 0.5) * (n - 1))
    ends = " (the worst)" if rank == 0 else " (the best)" if rank == n - 1 else ""
    return (
        f"Candidate {i} with the fitness {fitness[i]:g} should have the rank {rank}{ends}, so its "
        f"utility should be {rank} / {n - 1} - 0.5. (The ranks should go from 0 to {n - 1}; of "
        "equals, the one that comes first should get the lower rank.)"
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
    text = "Candidates of equal fitness have their ranks in another order, but of equals, the one "
    return {
        text + "that comes first should have the lower rank (np.argsort does so only with "
        "kind='stable').": answer
    }


def mistaken_utilities(fitness, answer=None) -> dict:
    """What slips make of the utilities: sentence -> array."""
    fitness, n = np.asarray(fitness, dtype=float), len(fitness)
    shared = [np.flatnonzero(np.sort(fitness) == each) for each in fitness]
    ranks = (n - 1) * (ranked(fitness) + 0.5)
    from_best = (n - 1) * (ranked(-fitness) + 0.5)
    equals = {
        f"Equals share their {word} rank, but the one that comes first should have the lower rank.":
        np.array([rank(each) for each in shared])
        for word, rank in (("mean", np.mean), ("lowest", np.min), ("highest", np.max))
    }  # fmt: skip
    spread = fitness - fitness.min()
    return {
        "All get 0 where all are equal, but each of equals should have a rank of its own.":
        0 * fitness if spread.max() == 0 else ranked(fitness),
        "All get 0, but the utilities should go from -0.5 (the worst) to 0.5 (the best).":
        0 * fitness,
        "The fitness is standardised, but only its ranks should count.":
        (fitness - fitness.mean()) / (fitness.std() or 1),
    } | slips(
        lambda rank, first, divisor, middle, scale: scale * ((rank + first) / divisor - middle),
        rank={
            "": ranks,
            **equals,
            "Of equals, the last one has the lowest rank, but the first one should have it.":
            (n - 1) * (ranked(fitness[::-1])[::-1] + 0.5),
            "The ranks are reversed: the best has 0, but should have n - 1.": n - 1 - ranks,
            "The ranks count from the best (0) to the worst, but the worst should have the rank 0.":
            from_best,
            "The order of the candidates, as np.argsort gives it, is taken for their ranks.":
            np.argsort(fitness, kind="stable"),
            "The utilities are sorted, but number i should be that of candidate i.":
            np.arange(n),
            "The fitness itself is scaled, but only its ranks should count.":
            (n - 1) * spread / (spread.max() or 1.0),
            "The fitness itself is used, but only its ranks should count.": fitness,
        },
        first={"": 0, "The ranks begin at 1, but the worst should have the rank 0.": 1},
        divisor={
            "": n - 1,
            "The ranks are divided by n instead of by the highest rank, n - 1.": n,
            "The ranks are divided by n + 1 instead of by the highest rank, n - 1.": n + 1,
            "The ranks are not divided, but should be divided by n - 1.": 1,
        },
        middle={
            "": 0.5,
            "The utilities are not centred: 0.5 should be subtracted.": 0,
            "1 is subtracted instead of 0.5.": 1,
            "The half of n - 1 is subtracted instead of 0.5.": (n - 1) / 2,
        },
        scale={
            "": 1,
            "The utilities are twice as large as they should be (-0.5 to 0.5).": 2,
            "The sign is reversed: the best should have 0.5, the worst -0.5.": -1,
        },
    ) | equals_exchanged(fitness, answer)  # fmt: skip


def why_gradient(samples, utilities, i: int) -> str:
    pairs = zip(utilities[0::2], utilities[1::2], samples[:, i], strict=True)
    parts = [f"({plus:.3g} - {minus:.3g}) * {e:.4g}" for plus, minus, e in pairs]
    more = " + ..." if len(parts) > 3 else ""
    return f"At [{i}] it should be ({' + '.join(parts[:3])}{more}) / {len(utilities)}."


def mistaken_gradient(samples, utilities, answer) -> dict:
    """What slips make of the gradient: sentence -> array."""
    many, n = samples.shape
    plus, minus = utilities[0::2], utilities[1::2]
    shapes = {
        (): "The gradient is a single number, but should have one for each parameter: add up over "
        "the samples only.",
        (many,): "The gradient has one number for each sample, but should have one for each "
        "parameter: add up over the samples.",
        (many, n): "There is a row for each sample, but the weighted samples should be added up.",
        (2 * many, n): "There is a row for each candidate, but the samples should be added up.",
    }
    shape = np.shape(answer)
    if shape != (n,) and shape in shapes:
        return {shapes[shape]: answer}
    return slips(
        lambda weights, divisor, vectors: weights @ vectors / divisor,
        weights={
            "": plus - minus,
            "The two utilities of a sample are added, but that of the minus side should be "
            "subtracted.": plus + minus,
            "The utilities of the minus candidates are left out, but should be subtracted.": plus,
            "The utilities of the plus candidates are left out, but should be added.": -minus,
            "The sign is wrong: the utility of the minus candidate should be subtracted from that "
            "of the plus candidate.": minus - plus,
            "The first half of the utilities is taken for plus and the second for minus, but "
            "utilities 2 b and 2 b + 1 belong to sample b.":
            utilities[:many] - utilities[many:],
            "The weights are only the signs of the differences, but should be the differences "
            "themselves.": np.sign(plus - minus),
            "The differences lose their signs, but the weight of a sample that points downhill "
            "should be negative.":
            np.abs(plus - minus),
            "Samples whose minus side won are left out, but should have a negative weight.":
            np.maximum(plus - minus, 0),
            "The weights are the squares of the differences, but should be the differences "
            "themselves.": (plus - minus) ** 2,
            "The weights are left out: each sample should be multiplied by its own.": np.ones(many),
        },
        divisor={
            "": 2 * many,
            "The sum is divided by samplesize instead of by the number of candidates, "
            "2 * samplesize.": many,
            "The sum is not divided, but should be divided by the number of candidates, "
            "2 * samplesize.": 1,
            "The sum is divided by 2 only instead of by 2 * samplesize.": 2,
            "The sum is divided by the number of parameters instead of by that of candidates.": n,
            "The sum is divided by twice the number of parameters instead of by twice that of "
            "samples.": 2 * n,
            "The sum is divided by 2 * samplesize - 1 instead of by 2 * samplesize.": 2 * many - 1,
            "The sum is divided by 4 * samplesize instead of by 2 * samplesize.": 4 * many,
            "The sum is divided by the root of 2 * samplesize instead of by 2 * samplesize itself.":
            (2 * many) ** 0.5,
        },
        vectors={
            "": samples,
            "The samples are divided by their lengths, but should be used as they are.":
            samples / np.linalg.norm(samples, axis=1, keepdims=True),
            "The samples come in reverse order, but weight b should multiply samples[b].":
            samples[::-1],
        },
    )  # fmt: skip


def why_descent(gradient, centre, wdecay, i: int) -> str:
    pull = ("", f" + 0.005 * {centre[i]:.5g}", f" + 0.005 * sign({centre[i]:.5g})")[wdecay]
    none = "" if wdecay else ", without a pull"
    return f"With wdecay {wdecay}, at [{i}] it should be -({gradient[i]:.5g}){pull}{none}."


def mistaken_descent(gradient, centre, wdecay) -> dict:
    """What slips make of the direction: sentence -> array."""
    pulls = {
        "The decay is left out, but wdecay 1 and 2 ask for one.": 0 * centre,
        "There is a pull in proportion to the centre, but with wdecay 0 there should be none.":
        centre,
        "There is a pull by the sign of the centre, but with wdecay 0 there should be none.":
        np.sign(centre),
        "The pull is that of the other wdecay: wdecay 1 should take the centre, wdecay 2 its sign.":
        (0, np.sign(centre), centre)[wdecay],
        "The pull takes the sign of the gradient, but should take the centre (wdecay 1) or its "
        "sign (wdecay 2).":
        np.sign(gradient),
        "The pull takes the gradient, but should take the centre (wdecay 1) or its sign "
        "(wdecay 2).":
        gradient,
        "The centre is divided by its length in the pull, but the centre itself (wdecay 1) or its "
        "sign (wdecay 2) is asked for.":
        centre / max(float(np.linalg.norm(centre)), 1e-300),
        "The pull takes |centre|, so that parameters below 0 go away from 0 instead of towards it.":
        np.abs(centre),
        "The pull takes the square of the centre, but should take the centre (wdecay 1) or its "
        "sign (wdecay 2).":
        centre**2,
        "A parameter that is 0 is pulled, too, but sign(0) is 0, so there should be no pull on it.":
        np.where(centre < 0, -1, 1),
        "The pull is the same for all parameters, but each should have a pull of its own.":
        centre.sum(),
        "The pull is multiplied by wdecay, but wdecay only says which kind of pull is asked for.":
        wdecay * centre,
        "Both kinds of pull are added up, but only that of this wdecay should be added.":
        centre + np.sign(centre),
    }  # fmt: skip
    return slips(
        lambda uphill, rate, pull: uphill + rate * pull,
        uphill={
            "": -gradient,
            "The gradient is added, but should be subtracted: Adam descends, fitness should rise.":
            gradient,
            "The gradient is left out, but should be subtracted.": 0 * gradient,
        },
        rate={
            "": 0.005,
            "The decay has the wrong sign: it pushes the centre away from 0 instead of towards it.":
            -0.005,
            "The factor 0.005 of the decay is left out.": 1,
            "The factor of the decay is 0.05, but should be 0.005.": 0.05,
            "The factor of the decay is 0.5, but should be 0.005.": 0.5,
            "The factor of the decay is 0.0005, but should be 0.005.": 0.0005,
            "The factor of the decay is 0.01, but should be 0.005.": 0.01,
            "The decay is half as strong as it should be.": 0.0025,
        },
        pull={"": (0 * centre, centre, np.sign(centre))[wdecay], **pulls},
    )  # fmt: skip


def why_mean(centre, d, m, v, t, stepsize, name: str, i: int) -> str:
    if name == "m":
        return f"At [{i}] it should be 0.9 * {m[i]:.5g} + 0.1 * {d[i]:.5g}."
    return f"At [{i}] it should be 0.999 * {v[i]:.5g} + 0.001 * ({d[i]:.5g})^2."


def why_step(centre, d, m, v, t, stepsize, i: int) -> str:
    _, m, v = adam_step(centre, d, m, v, t, stepsize)
    first, second = m[i] / (1 - 0.9**t), v[i] / (1 - 0.999**t)
    return (
        f"With t = {t}, at [{i}] the corrected m should be {m[i]:.5g} / (1 - 0.9^{t}) = "
        f"{first:.5g} and the corrected v {v[i]:.5g} / (1 - 0.999^{t}) = {second:.5g}; the new "
        f"centre should be {centre[i]:.5g} - {stepsize:g} * {first:.5g} / "
        f"(sqrt({second:.5g}) + 1e-8)."
    )


def mistaken_means(centre, d, m, v, t, stepsize) -> dict:
    """What slips make of the running means: {"m": sentence -> array, "v": ...}."""
    found = {}
    for name, old, new, keep in (("m", m, d, 0.9), ("v", v, d**2, 0.999)):
        other, what = (0.999, "d") if name == "m" else (0.9, "d squared")
        news = {
            "The absolute value of d is averaged instead of its square.": np.abs(d),
            "d itself is averaged instead of its square.": d,
            "All parameters get the mean of d squared instead of their own.": np.mean(new),
            "All parameters get the sum of d squared instead of their own.": np.sum(new),
            "The square of d - m is averaged instead of that of d.": (d - 0.9 * m - 0.1 * d) ** 2,
            "The square of m is averaged instead of that of d.": (0.9 * m + 0.1 * d) ** 2,
            "0.001 is squared, too, but should only multiply the square of d.": 0.001 * new,
        }
        if name == "m":
            news = {"d is subtracted in m, but should be added.": -d,
                    "The square of d is averaged in m instead of d itself.": d**2,
                    "The sign of d is averaged in m instead of d itself.": np.sign(d)}  # fmt: skip
        found[name] = {
            "m stands in the place of v, or v in that of m: return the centre, m, v.": 0.999 * v
            + 0.001 * d**2
            if name == "m"
            else 0.9 * m + 0.1 * d,
            (
                "The corrected value is returned, but only the step should use it."
                if t > 1
                else "Either the corrected value is returned (only the step should use it), or the "
                f"factor {1 - keep:.3g} of {what} is left out."
            ): (keep * old + (1 - keep) * new) / (1 - keep**t),
            f"The old {name} is returned instead of the new one.": old,
            **{
                f"The factors of {name} are {other:.4g} and {1 - other:.4g} instead of {keep} and "
                f"{1 - keep:.3g}.": other * old + (1 - other) * new
                for other in (0.5, 0.8, 0.95, 0.98, 0.99, 0.999, 0.9999)
                if other != keep
            },
            f"The factors of {name} are those of the other mean; they should be {keep} and "
            f"{1 - keep:.3g}.": other * old + (1 - other) * new,
        } | slips(
            lambda kept, share, new, old=old: kept * old + share * new,
            kept={
                "": keep,
                f"The old {name} is left out, but {keep} times the old one should stay.": 0,
                f"The old {name} is not multiplied by {keep}, but should be.": 1,
                f"The old {name} is multiplied by {1 - keep:.3g} instead of by {keep}.": 1 - keep,
            },
            share={
                "": 1 - keep,
                f"The factor {1 - keep:.3g} of {what} is left out.": 1,
                f"The factor of {what} is {keep} instead of {1 - keep:.3g}.": keep,
                f"The factor of {what} is {1 - other:.3g} instead of {1 - keep:.3g}.": 1 - other,
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
            "The correction of m and v by 1 - 0.9^t and 1 - 0.999^t is left out.": (1, 1),
            "The correction of m is left out: m should be divided by 1 - 0.9^t.": (1, second),
            "The correction of v is left out: v should be divided by 1 - 0.999^t.": (first, 1),
            "The correction takes t + 1 instead of t, but t counts from 1 already.": shares(t + 1),
            "The correction takes t - 1 instead of t.": shares(max(t - 1, 0.5)),
            "t is left out of the correction: the powers should be 0.9^t and 0.999^t.": shares(1),
            "v is corrected by 1 - 0.9^t instead of by 1 - 0.999^t.": (first, first),
            "m is corrected by 1 - 0.999^t instead of by 1 - 0.9^t.": (second, second),
            "The corrections are exchanged: m should be divided by 1 - 0.9^t, v by 1 - 0.999^t.":
            (second, first),
            "m and v are multiplied by 1 - 0.9^t and 1 - 0.999^t, but should be divided by them.":
            (1 / first, 1 / second),
            "m and v are divided by 0.9^t and 0.999^t instead of by 1 - 0.9^t and 1 - 0.999^t.":
            (0.9**t, 0.999**t),
            "0.9 and 0.999 are multiplied by t in the correction, but should be raised to the "
            "power t.":
            (1 - 0.9 * t, 1 - 0.999 * t),
        },
        mean={
            "": new_m,
            "The step is made with the old m instead of the new one.": m,
            "The step is made with d instead of its mean m.": d,
            "The step is made with the sign of m instead of m itself.": np.sign(new_m),
        },
        size={
            "": new_v,
            "The step is made with the old v instead of the new one.": v,
            "The step is made with the square of d instead of its mean v.": d**2,
            "The step is made with the mean of v over all parameters instead of each one's own v.":
            new_v.mean(),
        },
        root={
            "": np.sqrt,
            "v itself is taken instead of its root.": np.asarray,
            "The square of v is taken instead of its root.": np.square,
        },
        small={
            "": lambda root, value: root(value) + 1e-8,
            "1e-8 is added before the root is taken, but should be added to the root.":
            lambda root, value: root(value + 1e-8),
            "1e-8 is left out, but should be added to the root.": lambda root, value: root(value),
            "1e-6 is added to the root instead of 1e-8.": lambda root, value: root(value) + 1e-6,
            "The step is not divided by the root of v, but should be.": lambda root, value: 1.0,
            "The step is multiplied by the root of v, but should be divided by it.":
            lambda root, value: 1 / (root(value) + 1e-8),
        },
        length={
            "": stepsize,
            "The step goes the wrong way: it should be subtracted from the centre.": -stepsize,
            "stepsize is left out: the step should be multiplied by it.": 1.0,
            "The step is multiplied by the square of stepsize instead of by stepsize.":
            stepsize**2,
            "The step is divided by t, too, but stepsize should stay the same.": stepsize / t,
        },
    )  # fmt: skip
    # where nothing moves, many slips look alike
    return {text: each for text, each in found.items() if not np.allclose(each, centre, 1e-5)}


DRAWS = {
    "": lambda rng, seed, g, shape: rng.standard_normal(shape),
    "The samples stay the same in all generations, but should be drawn anew in each.":
    lambda rng, seed, g, shape: np.random.default_rng(seed).standard_normal(shape),
    "Each generation has a new generator from seed + g, but one from seed should draw all samples.":
    lambda rng, seed, g, shape: np.random.default_rng(seed + g).standard_normal(shape),
    "The samples are drawn with the shape (n, samplesize) and transposed instead of being drawn "
    "with the shape (samplesize, n).":
    lambda rng, seed, g, shape: rng.standard_normal(shape[::-1]).T,
    "The samples are uniform numbers, but should be Gaussian ones (standard_normal).":
    lambda rng, seed, g, shape: rng.uniform(-1, 1, shape),
    "Other numbers are drawn from rng before the samples of each generation, but nothing else "
    "should be drawn.":
    lambda rng, seed, g, shape: [rng.standard_normal(shape), rng.standard_normal(shape)][1],
}  # fmt: skip
"""How samples are drawn, by sentence."""

KEPT = {
    "": lambda f, before, after: np.mean(f),
    "The history holds the fitness of the best candidate instead of the mean.":
    lambda f, before, after: np.max(f),
    "The history holds the fitness of the worst candidate instead of the mean.":
    lambda f, before, after: np.min(f),
    "The history holds the median of the fitness instead of the mean.":
    lambda f, before, after: np.median(f),
    "The history holds the sum of the fitness instead of the mean.":
    lambda f, before, after: np.sum(f),
    "The history holds the fitness of the centre before the step instead of the mean of all "
    "candidates.":
    lambda f, before, after: before,
    "The history holds the fitness of the centre after the step instead of the mean of all "
    "candidates.":
    lambda f, before, after: after,
    "The history holds the mean of the plus candidates alone instead of that of all candidates.":
    lambda f, before, after: np.mean(f[0::2]),
    "The history holds 0 for every generation instead of the mean of the fitness (that of the "
    "utilities is always 0).":
    lambda f, before, after: 0.0,
    "The history holds the mean of the fitness with the wrong sign.":
    lambda f, before, after: -np.mean(f),
}  # fmt: skip
"""What a history keeps of a generation, by sentence."""

RETURNED = {
    "": lambda seen: seen[-1]["after"],
    "The last step is missing in the centre, but every generation should make one.":
    lambda seen: seen[-1]["before"],
    "The centre is the best of all candidates, but should be the one after the last step.":
    lambda seen: max(seen, key=lambda one: one["max"])["best"],
    "The centre is the best candidate of the last generation, but should be the one after the "
    "last step.":
    lambda seen: seen[-1]["best"],
    "The centre is the first one, but should be the one after the last step.":
    lambda seen: seen[0]["before"],
    "The centre is the one before the step of the generation with the best mean, but should be the "
    "one after the last step.":
    lambda seen: max(seen, key=lambda one: one["mean"])["before"],
    "The centre is the one after the step of the generation with the best mean, but should be the "
    "one after the last step.":
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
        options={"": {}, "wdecay is not handed on: the run is one with wdecay 0.": {"wdecay": 0}}
        | {
            f"{key} is not handed on: the run is one with the default, {default}.": {key: default}
            for key, default in defaults.items()
            if settings[key] != default
        },
        seeds={
            "": lambda seed, g: seed + g,
            "The seeds of evaluate begin with seed + 1, but should begin with seed.":
            lambda seed, g: seed + 1 + g,
            "All generations are evaluated with seed, but generation g should have seed + g.":
            lambda seed, g: seed,
            "Generation g is evaluated with the seed g, but should have the seed seed + g.":
            lambda seed, g: g,
            "Generation g is evaluated with the seed seed * g, but should have the seed seed + g.":
            lambda seed, g: seed * g,
        },
        kept=KEPT,
        returned=RETURNED,
        draw=DRAWS,
        time={
            "": lambda g: g + 1,
            "Adam's t is 1 in every generation, but should be generation + 1.": lambda g: 1,
            "Adam's t is 1 in the first two generations, but should be generation + 1.":
            lambda g: max(1, g),
            "Adam's t begins at 2, but should be generation + 1.": lambda g: g + 2,
            "Adam's t is the number of all generations, but should be generation + 1.":
            lambda g: generations,
        },
        keeps={
            "": (1, 1),
            "m and v begin with zeros in every generation, but should be those that adam returned.":
            (0, 0),
            "m begins with zeros in every generation, but should be the one that adam returned.":
            (0, 1),
            "v begins with zeros in every generation, but should be the one that adam returned.":
            (1, 0),
        },
        samples={
            "": 1.0,
            "The gradient is noiseStdDev times as long as it should be: it should be made from the "
            "samples as they were drawn.":
            settings["noiseStdDev"],
        },
        uphill={
            "": 1.0,
            "Each step goes against the gradient, so that fitness falls, but it should rise.": -1.0,
        },
        decays={
            "": False,
            "The weight decay takes the first centre instead of the present one.": True,
        },
    )  # fmt: skip


def why_drop(curve: np.ndarray, right: dict) -> str:
    high, low = float(curve[right["peak"]]), float(curve[right["bottom"]])
    if right["bottom"] == right["peak"]:
        return "The curve never falls, so drop, peak and bottom should be 0."
    return (
        f"The largest fall of the curve goes from {high:.6g} at [{right['peak']}] to {low:.6g} at "
        f"[{right['bottom']}]; max - min of the curve is {curve.max():.6g} - {curve.min():.6g}."
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
            "Only falls from one value to the next are looked at, but a fall may take many steps.":
            max(0.0, -np.diff(curve, prepend=curve[0]).min()),
            "Only the fall from the highest point to the end is taken, but falls that recover "
            "should count, too.":
            curve.max() - curve[-1],
            "The fall from the highest point of all is taken, but a larger one may come before.":
            curve.max() - curve[int(np.argmax(curve)) :].min(),
            "The whole height of the curve is taken, whether it rises or falls, but the largest "
            "fall is asked for.": span,
            "The falls are added up, but only the largest one should count.": falls.sum(),
            "The fall is measured anew after each rise, but should be measured from the highest "
            "value so far.": longest_run_down(curve),
            "The mean of the falls is taken, but the largest one should count.": falls.mean(),
            "The fall is measured from the first value, but should be measured from the highest "
            "value so far.":
            max(0.0, curve[0] - curve.min()),
            "The largest rise is taken instead of the largest fall.":
            (curve - np.minimum.accumulate(curve)).max(),
        },
        height={
            "": span,
            "The fall is not divided, but should be divided by max - min.": 1.0,
            "The fall is divided by the highest value instead of by max - min.": curve.max(),
            "The fall is divided by the height that it fell from instead of by max - min.": top,
            "The fall is divided by the absolute value of the height that it fell from instead of "
            "by max - min.":
            abs(top),
            "The fall is divided by the absolute value of the maximum instead of by max - min.":
            abs(curve.max()),
            "The fall is divided by the absolute value of the minimum instead of by max - min.":
            abs(curve.min()),
            "The fall is divided by the distance of the last value from the first one instead of "
            "by max - min.": abs(curve[-1] - curve[0]),
            "The fall is divided by max - the first value instead of by max - min.":
            curve.max() - curve[0],
            "The fall is divided by the last value - the first one instead of by max - min.":
            curve[-1] - curve[0],
            "The fall is divided by max + min instead of by max - min.": curve.max() + curve.min(),
            "The fall is divided by the standard deviation instead of by max - min.": curve.std(),
        },
        factor={
            "": 1.0,
            "The drop is in percent, but a share is asked for (0.2, not 20).": 100.0,
            "The sign is wrong: the drop of a curve that falls should be positive.": -1.0,
        },
    ) | {"The drop is rounded, but should be returned as it is.": round(right, places)}  # fmt: skip


def mistaken_places(curve: np.ndarray) -> dict:
    """What slips make of the two indices: sentence -> {"peak": index, "bottom": index}."""
    falls = np.maximum.accumulate(curve) - curve
    bottom = int(np.argmax(falls))
    peak, last = int(np.argmax(curve[: bottom + 1])), len(curve) - 1
    later = last - int(np.argmax(falls[::-1])) if falls.any() else 0
    return {
        "The peak is the highest value of the whole curve, but should be that up to the bottom.":
        {"peak": int(np.argmax(curve)), "bottom": bottom},
        "The fall to the lowest value is taken instead of the largest fall.":
        {"peak": int(np.argmax(curve[: np.argmin(curve) + 1])), "bottom": int(np.argmin(curve))},
        "The bottom is where the curve is lowest, but should be where the largest fall ends.":
        {"peak": peak, "bottom": int(np.argmin(curve))},
        "The fall from the highest value of all is taken instead of the largest fall.":
        {"peak": int(np.argmax(curve)),
         "bottom": int(np.argmax(curve) + np.argmin(curve[int(np.argmax(curve)) :]))},
        "The peak is the last of equal heights before the fall, but should be the first one.":
        {"peak": bottom - int(np.argmax(curve[bottom::-1])), "bottom": bottom},
        "The bottom is that of the last of equal falls, but should be that of the first one.":
        {"peak": peak, "bottom": last - int(np.argmax(falls[::-1]))},
        "The last of equal falls is taken, with its peak, instead of the first one.":
        {"peak": int(np.argmax(curve[: later + 1])), "bottom": later},
        "The bottom stands in the place of the peak, or the peak in that of the bottom.":
        {"peak": bottom, "bottom": peak},
        "The index is one too large: indices should count from 0.":
        {"peak": peak + 1, "bottom": bottom + 1},
        "The value of the curve is returned, but its index is asked for.":
        {"peak": curve[peak], "bottom": curve[bottom]},
        "The peak is the place just before the bottom, but should be that of the highest value up "
        "to the bottom.":
        {"peak": max(0, bottom - 1), "bottom": bottom},
    }  # fmt: skip


MISTAKEN_VERDICTS = {
    "Drops just above 0.1 and 0.3 get the better verdict, as if rounded to one digit, but the "
    "limits should be exactly 0.1 and 0.3.":
    lambda drop: (round(drop, 1) > 0.1) + (round(drop, 1) > 0.3),
    "Drops up to about 0.5 are monotonic and larger ones severe, as if rounded to a whole number, "
    "but the limits should be 0.1 and 0.3.":
    lambda drop: (round(drop) > 0.1) + (round(drop) > 0.3),
    "Drops of exactly 0.1 and 0.3 get the worse verdict, but should get the better one.":
    lambda drop: (drop >= 0.1) + (drop >= 0.3),
    "A drop of exactly 0.1 gets the worse verdict, but should be monotonic.":
    lambda drop: (drop >= 0.1) + (drop > 0.3),
    "A drop of exactly 0.3 gets the worse verdict, but should be mild.":
    lambda drop: (drop > 0.1) + (drop >= 0.3),
    "The verdicts are in the wrong order: small drops are severe, but should be monotonic.":
    lambda drop: 2 - (drop > 0.1) - (drop > 0.3),
    "Every curve is called monotonic here, but only drops of at most 0.1 should be.":
    lambda drop: 0,
    "Only a drop of 0 is monotonic here, but drops of at most 0.1 should be.":
    lambda drop: (drop > 0) + (drop > 0.3),
    "All drops of more than 0.1 are severe here, but those of at most 0.3 should be mild.":
    lambda drop: 2 * (drop > 0.1),
    "All drops of more than 0.1 are mild here, but those of more than 0.3 should be severe.":
    lambda drop: int(drop > 0.1),
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
                f"The verdict is no worse than {one} up to the drop {max(below):.3g} and at least "
                f"{other} from the drop {min(above):.3g} on, but should change at {limit}."
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
        return "While train ran, robot.evaluate was never called, but fitness should come from it."
    if not generations:
        return (
            "robot.evaluate never got two pairs of candidates in a row, c + s e and c - s e, "
            "around one centre c, but should get the pairs that evolve makes."
        )
    pairs, noise = len(generations[0][1]), float(np.median([np.std(e) for _, e, _ in generations]))
    size = f"with a noiseStdDev of about {noise:.2g}"
    if len(generations) < 2:
        return (
            f"train evaluated pairs of candidates around one centre only ({pairs} of them), {size}."
        )
    told = f"train evaluated pairs of candidates around {len(generations)} centres, {size}."
    centres = np.array([middle for middle, _, _ in generations])
    if np.allclose(centre, centres[0], 1e-6, 1e-9):
        return f"{told} It returned the first centre of these, but should return a later one."
    sides = [c + sign * e for c, e, _ in generations for sign in (1, -1)]
    if any((np.abs(side - centre).max(axis=1) < 1e-5).any() for side in sides):
        return f"{told} It returned one of these candidates, but a centre is asked for."
    step = float(np.median(np.abs(np.diff(centres, axis=0)).max(axis=1)))
    far = float(np.abs(centres - centre).max(axis=1).min())
    if step and far > 3 * step:
        return (
            f"{told} What it returned is none of their centres, but should be one: it differs from "
            f"the nearest one by up to {far:.2g} in a parameter, and a step changes a parameter by "
            f"up to about {step:.2g}."
        )
    if share < -0.6:
        return (
            f"{told} The centre moves against their gradients, to where fitness is lower, but "
            "fitness should rise."
        )
    flat = np.mean([np.ptp(fitness) == 0 for _, _, fitness in generations])
    if flat > 0.3:
        return f"{told} In {flat:.0%} of these generations, all candidates have the same fitness."
    told += f" One step changes the parameter that it moves most by about {step:.2g}."
    biases, weights = centres[0][:nbiases], centres[0][nbiases:]
    if not np.allclose(biases, 0, atol=1e-6):
        told += " The biases of the first centre are not 0, but should be."
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
    told += (
        f" The mean fitness is {first:.4g} in the first {some} and {last:.4g} in the last {some}."
    )
    if last >= goal:
        return f"{told} So the last candidates reach the goal; the returned centre should, too."
    return f"{told} HINTS.md names values that are enough for both problems."
