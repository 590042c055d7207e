"""Compute what slips make of answers; for the grader."""

import itertools

import numpy as np

from botschool.grading import slips


def mistaken_fitness(expected: dict, maxsteps: int) -> dict:
    """What mistakes make of the fitness of a chase."""
    steps = len(expected["poses"]) - 1
    return {
        "The steps are one fewer than the poses: the start is no step.": 1 - (steps + 1) / maxsteps,
        "The step in which the prey is caught counts, too.": 1 - (steps - 1) / maxsteps,
        "This is the prey's fitness, 1 minus the predator's.": 1 - expected["fitness"],
        "This is t / T, not 1 - t / T.": steps / maxsteps,
        "This is the number of steps.": steps,
        "Whoever catches the prey gets 1 here, however long it takes.": float(expected["caught"]),
        "The steps are divided by 2000, not by `maxsteps`.": 1 - steps / 2000,
    }


def mistaken_tables(table: np.ndarray) -> dict:
    """What comes out if the numbers of `play` are read with the axes in another order."""
    names, found = "GnHm", {"This is the prey's fitness, 1 minus the predator's.": 1 - table}
    pairs = table.reshape(table.shape[0] * table.shape[1], -1)
    by_prey = "The pairs go through the prey first, but their fitness is read predator by predator."
    found[by_prey] = pairs.T.reshape(table.shape)
    for order in itertools.permutations(range(4)):
        read = table.reshape([table.shape[axis] for axis in order])
        said = ", ".join(names[axis] for axis in order)
        for made in (read.transpose(np.argsort(order)), read):
            found.setdefault(
                f"The numbers of `play` are read as if the pairs went through the axes ({said}).",
                made,
            )
    return found


def mistaken_profile(matrix: np.ndarray) -> dict:
    """What mistakes make of a profile."""
    count = len(matrix)
    before, after = range(1, count), range(count - 1)
    return {
        "present": {
            "This is the last row of the matrix: each generation has a present of its own.": (
                matrix[-1]
            ),
            "This is the first row of the matrix: each generation has a present of its own.": (
                matrix[0]
            ),
            "These are the means of the columns, over all generations.": matrix.mean(axis=0),
            "This is the other diagonal: the present of the first generation is the first.": (
                np.diag(matrix[:, ::-1])
            ),
        },
        "ancient": {
            "Only the generation just before counts, not all ancient ones.": [
                matrix[g, g - 1] for g in before
            ],
            "Only the very first generation counts, not all ancient ones.": matrix[1:, 0],
            "The present competitors count as ancient ones, too.": [
                matrix[g, : g + 1].mean() for g in before
            ],
            "These are sums over the ancient competitors, not means.": [
                matrix[g, :g].sum() for g in before
            ],
            "The mean goes down a column: competitors are the columns of a row.": [
                matrix[:g, g].mean() for g in before
            ],
        },
        "future": {
            "Only the next generation counts, not all future ones.": [
                matrix[g, g + 1] for g in after
            ],
            "Only the very last generation counts, not all future ones.": matrix[:-1, -1],
            "The present competitors count as future ones, too.": [
                matrix[g, g:].mean() for g in after
            ],
            "The last generation is left out of the future.": [
                matrix[g, g + 1 : -1].mean() if g + 2 < count else np.nan for g in after
            ],
            "These are sums over the future competitors, not means.": [
                matrix[g, g + 1 :].sum() for g in after
            ],
            "The mean goes down a column: competitors are the columns of a row.": [
                matrix[g + 1 :, g].mean() for g in after
            ],
        },
    }


def mistaken_progress(matrix: np.ndarray) -> dict:
    """What mistakes make of progress."""
    count, gain = len(matrix), np.diff(matrix, axis=0)
    across, first = np.diff(matrix, axis=1).T, matrix[1:] - matrix[0]
    later = range(1, count)

    def ancient(these: np.ndarray) -> list:
        return [row[:g] for g, row in enumerate(these, 1)]

    def means(these: list) -> list:
        return [np.mean(row) for row in these]

    def share(cases, draw: float = 0.5) -> float:
        cases = np.concatenate([np.ravel(each) for each in cases])
        return float(np.mean((cases > 0) + draw * (cases == 0)))

    columns = "Neighbouring columns are compared: a generation is a row of the matrix."
    compared = "Each generation is compared with the first one, not with its predecessor."
    turned = "Each predecessor is compared with the generation after it: the signs are reversed."
    present = "The present competitors count as ancient ones, too: k < g."
    earlier = (
        "One ancient competitor is left out, that of the predecessor's time: k = g - 1 counts."
    )
    shares = {
        "A draw counts half: here it counts fully.": share(ancient(gain), 1),
        "A draw counts half: here it counts nothing.": share(ancient(gain), 0),
        "All competitors count, not the ancient ones alone.": share([gain]),
        "Generations are counted by the mean of their cases: count each case.": share(
            [means(ancient(gain))]
        ),
        "This is the mean over generations of their shares: all cases count alike.": np.mean(
            [share([row]) for row in ancient(gain)]
        ),
        columns: share(ancient(across)),
        compared: share(ancient(first)),
        turned: share(ancient(-gain)),
        present: share([row[: g + 1] for g, row in enumerate(gain, 1)]),
    }
    historical = {
        columns: means(ancient(across)),
        compared: means(ancient(first)),
        turned: means(ancient(-gain)),
        present: [gain[g - 1, : g + 1].mean() for g in later],
        "The sums are divided by G, the number of all generations, not by g.": [
            gain[g - 1, :g].sum() / count for g in later
        ],
        "These are sums over the ancient competitors, not means.": [
            gain[g - 1, :g].sum() for g in later
        ],
        "These are the gains on the competitors just before: take the mean over all k < g.": [
            gain[g - 1, g - 1] for g in later
        ],
        "The ancient competitors of the predecessor are taken for it: both meet the same k < g.": [
            matrix[g, :g].mean() - (matrix[g - 1, : g - 1].mean() if g > 1 else 0) for g in later
        ],
    }
    if count > 2:
        historical[earlier] = [gain[g - 1, : max(g - 1, 1)].mean() for g in later]
    return {
        "share": shares,
        "historical": historical,
        "global": {
            columns: across.mean(axis=1),
            compared: first.mean(axis=1),
            turned: -gain.mean(axis=1),
            "The sums are divided by G - 1, not by G.": gain.sum(axis=1) / (count - 1),
            "These are sums over the competitors, not means.": gain.sum(axis=1),
            "The mean is taken along the other axis: see axis=.": gain.mean(axis=0)[1:],
        },
    }


def mistaken_cycles(matrix: np.ndarray) -> dict:
    """What mistakes make of the share of cycles."""
    count, wins = len(matrix), matrix > matrix.T

    def found(wins: np.ndarray, both: bool = True) -> list[bool]:
        ways = [lambda a, b, c: wins[a, b] and wins[b, c] and wins[c, a]]
        ways += [lambda a, b, c: wins[b, a] and wins[c, b] and wins[a, c]] if both else []
        return [any(w(*abc) for w in ways) for abc in itertools.combinations(range(count), 3)]

    right = found(wins)
    if not right:
        return {"Without a group of three the share is 0.": 1}
    neighbours = [
        way for way, (a, _, c) in zip(right, itertools.combinations(range(count), 3), strict=True)
        if c - a == 2
    ]  # fmt: skip
    one_way = "Only cycles of one direction are found: there are two ways around."
    return {
        one_way: np.mean(found(wins, False)),
        "A draw counts as a match that was won.": np.mean(found(matrix >= matrix.T)),
        "A match is won above one half here: compare it with the return match.": np.mean(
            found(matrix > 0.5)
        ),
        "This is the number of cycles, not their share.": sum(right),
        "Only three neighbouring generations are looked at.": np.mean(neighbours),
        "The cycles are divided by the number of ordered triples, not by that of groups.": sum(
            right
        )
        / count**3,
        "The cycles are divided by the number of ordered groups, six for each group.": np.mean(
            right
        )
        / 6,
        "Each cycle counts three times, once for each generation that it begins with.": 3
        * np.mean(right),
        "Each cycle counts twice.": 2 * np.mean(right),
        "The cycles are divided by the number of generations.": sum(right) / count,
    }


def mistaken_parts(matrix: np.ndarray) -> dict:
    """What mistakes make of the change and its two parts."""
    rows, columns = matrix[1:] - matrix[0], matrix[:, 1:] - matrix[:, :1]
    present, later = np.diag(matrix), range(1, len(matrix))
    other_axis = "The mean is taken along the other axis: see axis=."
    return {
        "change": {
            "Each generation is compared with the one before it, not with the first.": np.diff(
                present
            ),
            "The sign is turned around: later minus first is asked for.": -(
                present[1:] - present[0]
            ),
            "The first competitors stay the same here: f(g, g) meets those of its own time.": (
                matrix[1:, 0] - matrix[0, 0]
            ),
            "The first generation stays the same here: f(g, g) is that of generation g.": (
                matrix[0, 1:] - matrix[0, 0]
            ),
            "Each is compared with f(0, g), not with f(0, 0).": present[1:] - matrix[0, 1:],
            "Each is compared with f(g, 0), not with f(0, 0).": present[1:] - matrix[1:, 0],
            "This is the fitness itself: f(0, 0) is not taken away.": present[1:],
            "These are the two parts added up: take the change from the diagonal.": (
                rows.mean(axis=1) + columns.mean(axis=0)
            ),
        },
        "own": {
            other_axis: rows.mean(axis=0)[1:],
            "Each generation is compared with the one before it, not with the first.": np.diff(
                matrix, axis=0
            ).mean(axis=1),
            "The competitors of the first generation alone hold still: take the mean over all.": (
                rows[:, 0]
            ),
            "The competitors change with the generation: the very same ones are asked for.": (
                present[1:] - matrix[0, 1:]
            ),
            "Only the ancient competitors count: take the mean over all.": [
                rows[g - 1, :g].mean() for g in later
            ],
            "Columns are compared here: the side's own generations are the rows.": columns.mean(
                axis=1
            )[1:],
            "The sign is turned around: later minus first is asked for.": -rows.mean(axis=1),
            "These are sums over the competitors, not means.": rows.sum(axis=1),
        },
        "others": {
            other_axis: columns.mean(axis=1)[1:],
            "Each generation is compared with the one before it, not with the first.": np.diff(
                matrix, axis=1
            ).mean(axis=0),
            "The first generation of the side alone holds still: take the mean over all.": (
                columns[0]
            ),
            "The sign is turned around: what competitors leave to the side is asked for.": (
                -columns.mean(axis=0)
            ),
            "Rows are compared here: the competitors are the columns.": rows.mean(axis=0)[1:],
            "This is the change minus the own part: compare competitors.": (
                present[1:] - present[0] - rows.mean(axis=1)
            ),
            "Only the generation's own row is compared: take the mean over all generations.": [
                matrix[g, g] - matrix[g, 0] for g in later
            ],
            "These are sums over the generations, not means.": columns.sum(axis=0),
        },
    }


Draws = tuple[np.ndarray, np.ndarray]
"""The individuals drawn in a resample, of both sides."""


def drawn_right(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    return rng.integers(n, size=(rows, n)), rng.integers(m, size=(columns, m))


def never_the_last(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    own = rng.integers(max(n - 1, 1), size=(rows, n))
    return own, rng.integers(max(m - 1, 1), size=(columns, m))


def prey_first(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    met = rng.integers(m, size=(columns, m))
    return rng.integers(n, size=(rows, n)), met


def predators_only(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    return rng.integers(n, size=(rows, n)), np.tile(np.arange(m), (columns, 1))


def prey_only(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    return np.tile(np.arange(n), (rows, 1)), rng.integers(m, size=(columns, m))


def prey_only_though_both_drawn(rng: np.random.Generator, shape: tuple) -> Draws:
    _, met = drawn_right(rng, shape)
    return np.tile(np.arange(shape[1]), (shape[0], 1)), met


def one_for_all_generations(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    own, met = rng.integers(n, size=n), rng.integers(m, size=m)
    return np.tile(own, (rows, 1)), np.tile(met, (columns, 1))


def first_row_for_all_generations(rng: np.random.Generator, shape: tuple) -> Draws:
    own, met = drawn_right(rng, shape)
    return np.tile(own[0], (len(own), 1)), np.tile(met[0], (len(met), 1))


def one_by_one(rng: np.random.Generator, shape: tuple) -> Draws:
    """Draws predators and prey of generation 0, then those of generation 1, and so on."""
    rows, n, _, m = shape
    both = [(rng.integers(n, size=n), rng.integers(m, size=m)) for _ in range(rows)]
    return np.array([own for own, _ in both]), np.array([met for _, met in both])


def once_more_before(rng: np.random.Generator, shape: tuple) -> Draws:
    drawn_right(rng, shape)
    return drawn_right(rng, shape)


def resampled(table: np.ndarray, draws: Draws) -> np.ndarray:
    """Return the table of those who were drawn."""
    (own, met), (rows, _, columns, _) = draws, table.shape
    return table[np.arange(rows)[:, None], own][:, :, np.arange(columns)[:, None], met]


def measures_of(table, weights, seed, resamples, draw=drawn_right) -> np.ndarray:
    """The measures; draw: how the individuals of a resample are drawn."""
    rng = np.random.default_rng(seed)
    return np.array(
        [(weights * resampled(table, draw(rng, table.shape))).sum() for _ in range(resamples)]
    )


def mistaken_draws(table, weights, seed, resamples) -> dict:
    """The measures if individuals are drawn in a wrong way."""
    rows, n, columns, m = table.shape
    ways = {
        "The last individual of a generation is never drawn: see the end of integers.": (
            never_the_last
        ),
        "The prey are drawn before the predators, which gives other individuals.": prey_first,
        "Only the predators are drawn anew; the prey stay as they are.": predators_only,
        "Only the prey are drawn anew; the predators stay as they are.": prey_only,
        "The predators are drawn, but stay as they are in the table.": prey_only_though_both_drawn,
        "The same individuals are drawn for all generations.": one_for_all_generations,
        "All generations get the individuals that were drawn for the first one.": (
            first_row_for_all_generations
        ),
        "Each resample draws twice, and uses the second draw only.": once_more_before,
    }
    if rows == columns > 1:
        ways["The predators and the prey of a generation are drawn together, not all predators "
             "first."] = one_by_one  # fmt: skip
    made = {text: measures_of(table, weights, seed, resamples, draw) for text, draw in ways.items()}
    rng, before = np.random.default_rng(seed), table
    following, switched, half = [], [], []
    for _ in range(resamples):
        before = resampled(before, drawn_right(rng, table.shape))
        following.append((weights * before).sum())
    rng = np.random.default_rng(seed)
    firm = drawn_right(rng, table.shape)
    made["The individuals are drawn once, before the resamples."] = np.full(
        resamples, (weights * resampled(table, firm)).sum()
    )
    rng = np.random.default_rng(seed)
    for _ in range(resamples):
        own, met = drawn_right(rng, table.shape)
        if n == m and rows == columns:
            switched.append((weights * resampled(table, (met, own))).sum())
            half.append((weights * resampled(table, (own, own))).sum())
    made["Each resample is drawn from the one before it, not from the table."] = np.array(following)
    if switched:
        made["The predators get the numbers that were drawn for the prey, and the prey theirs."] = (
            np.array(switched)
        )
        made["The prey get the numbers that were drawn for the predators."] = np.array(half)
    several = "There is one resample fewer than asked for."
    right = measures_of(table, weights, seed, resamples + 1)
    made[several] = right[: resamples - 1]
    made["There is one resample more than asked for."] = right
    if resamples != 300:
        made["There are always 300 resamples, whatever is asked for."] = measures_of(
            table, weights, seed, 300
        )
    return {"": right[:resamples], **made}


def mistaken_intervals(table, weights, seed, resamples) -> dict:
    """The intervals if individuals are drawn in a wrong way, or the ends are others, or both."""
    middle = float((weights * table).sum())

    def spread(width: float, ddof: int = 0):
        def ends(values: np.ndarray) -> np.ndarray:
            return values.mean() + np.array([-width, width]) * values.std(ddof=ddof)

        return ends

    def error(values: np.ndarray) -> np.ndarray:
        return values.mean() + np.array([-1.96, 1.96]) * values.std() / np.sqrt(len(values))

    def around(values: np.ndarray) -> np.ndarray:
        return middle + np.array([-1.96, 1.96]) * values.std()

    def at(*shares: float):
        return lambda values: np.quantile(values, shares)

    bell = "A bell-shaped distribution is assumed: quantiles are asked for."
    ends = {
        "": at(*ENDS),
        "These are the quantiles 0.05 and 0.95, which hold 90 %: 95 % are asked for.": at(
            0.05, 0.95
        ),
        "np.percentile takes per cent, not shares: these are 0.025 and 0.975 per cent.": at(
            0.00025, 0.00975
        ),
        "Low and high are exchanged.": at(*ENDS[::-1]),
        "These are the smallest and the largest of the measures, not quantiles.": at(0, 1),
        bell: spread(1.96),
        "A bell-shaped distribution (ddof=1) is assumed: quantiles are asked for.": spread(1.96, 1),
        "This is the mean plus and minus twice the standard deviation: quantiles are asked for.": (
            spread(2)
        ),
        "This is the mean plus and minus the standard deviation: quantiles are asked for.": spread(
            1
        ),
        "These are standard errors, which tell how sure the mean is: quantiles are asked for.": (
            error
        ),
        "This is the measure of the table plus and minus 1.96 standard deviations: quantiles of "
        "the measures are asked for.": around,
        "The interval is mirrored at the measure of the table: the quantiles themselves are asked "
        "for.": lambda values: 2 * middle - np.quantile(values, ENDS[::-1]),
        "The measure of the table is taken away: the quantiles themselves are asked for.": (
            lambda values: np.quantile(values, ENDS) - middle
        ),
        "Low and high are entries of the sorted measures: np.quantile goes on between two.": (
            lambda values: np.sort(values)[[int(share * len(values)) for share in ENDS]]
        ),
    }

    return slips(
        lambda values, of: of(values),
        values=mistaken_draws(table, weights, seed, resamples),
        of=ends,
    )


ENDS = (0.025, 0.975)


OTHER_ENDS = (0, 0.0025, 0.005, 0.01, 0.02, 0.05, 0.1, 0.16, 0.2, 0.25, 0.5)
"""Quantiles that are taken for an end by mistake, and as far from the other side."""


def mistaken_ends(values: list[float], got: np.ndarray) -> dict:
    """What other quantiles make of the interval, if both ends are quantiles of the measures."""
    shares = sorted({*ENDS, *OTHER_ENDS, *(1 - share for share in OTHER_ENDS)})
    found = [
        [share for share in shares if np.isclose(np.quantile(values, share), end, rtol=1e-9)]
        for end in got
    ]
    if not all(found):
        return {}
    ends = " and ".join(f"{shares[0]:g}" for shares in found)
    return {f"These are the quantiles {ends} of the measures, not 0.025 and 0.975.": got}


def mistaken_descriptions(poses: np.ndarray) -> dict:
    """What mistakes make of a description."""
    before, after = poses[:-1], poses[1:]

    def along(step: np.ndarray, heading: np.ndarray) -> np.ndarray:
        return step[..., 0] * np.cos(heading) + step[..., 1] * np.sin(heading)

    def bearings(these: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Angles of the other robot from the heading: as subtracted, and the short way around."""
        to_other = (these[:, ::-1] - these)[..., :2]
        raw = np.arctan2(to_other[..., 1], to_other[..., 0]) - these[..., 2]
        return raw, (raw + np.pi) % (2 * np.pi) - np.pi

    moved = after[..., :2] - before[..., :2]
    turned = after[..., 2] - before[..., 2]
    short = (turned + np.pi) % (2 * np.pi) - np.pi
    raw, bearing = bearings(before)
    mixed = np.where(abs(raw) > np.pi, 9, raw)
    late = np.concatenate([before[..., :2], after[..., 2:]], axis=2)
    ends = "This looks at the end of each step, not at its beginning."
    quarter = np.pi / 4
    shown = {
        "turning": {
            "The difference of two headings is not taken the short way around.": 10 * abs(turned),
            "Turns to the left and to the right cancel out: the sign is to be left out.": 10
            * short,
            "This is the turning of a step, not that of a second.": abs(short),
            "No step turns: the heading of poses[t] is to be compared with that of poses[t + 1].": (
                0 * short
            ),
        },
        "speed": {
            "This is the speed of a step, not that of a second.": np.linalg.norm(moved, axis=2),
            "The distance is counted as steps in x and y added up, not as the straight way.": 10
            * abs(moved).sum(axis=2),
        },
        "backwards": {
            "The movement is taken along the heading at the end of the step, not at its "
            "beginning.": along(moved, after[..., 2]) < 0,
            "Sine and cosine are exchanged: cos belongs to x, and sin to y.": (
                moved[..., 0] * np.sin(before[..., 2]) + moved[..., 1] * np.cos(before[..., 2]) < 0
            ),
            "This is the share of steps forwards.": along(moved, before[..., 2]) > 0,
            "This is the share of steps in which x becomes smaller: the heading is left out.": (
                moved[..., 0] < 0
            ),
        },
        "facing": {
            "The angle to the other robot is not taken the short way around: 350 degrees to the "
            "left are 10 to the right.": abs(mixed) < quarter,
            "The other robot counts only if it is on the left of the heading.": (bearing > 0)
            & (bearing < quarter),
            "The other robot counts only if it is on the right of the heading.": (bearing < 0)
            & (bearing > -quarter),
            "The other robot counts as faced within 90 degrees, not 45.": abs(bearing)
            < 2 * quarter,
            "45 degrees in all are taken: 22.5 to each side, not 45.": abs(bearing) < quarter / 2,
            "45 is compared with an angle in rad.": abs(bearing) < 45,
            "np.cos takes rad: 45 degrees are not 45 rad.": np.cos(bearing) > np.cos(45),
            "The direction leads from the other robot to this one: it is the wrong way round.": abs(
                bearing
            )
            > 3 * quarter,
            "The direction to the other robot is taken without the heading.": abs(
                raw + before[..., 2]
            )
            < quarter,
            "Sine and cosine are exchanged: cos belongs to x, and sin to y.": abs(
                np.angle(np.exp(1j * (raw + 2 * before[..., 2] - np.pi / 2)))
            )
            < quarter,
            "This takes the heading at the end of each step, not at its beginning.": abs(
                bearings(late)[1]
            )
            < quarter,
            "The other robot's heading is taken, not its own.": abs(
                bearings(np.concatenate([before[..., :2], before[:, ::-1, 2:]], axis=2))[1]
            )
            < quarter,
            ends: abs(bearings(after)[1]) < quarter,
        },
        "wall": {
            ends: np.minimum(after[..., :2], 3000 - after[..., :2]).min(axis=2) < 300,
            "Only the walls on the left and below count.": before[..., :2].min(axis=2) < 300,
            "Only the walls on the left and on the right count.": (
                np.minimum(before[..., 0], 3000 - before[..., 0]) < 300
            ),
            "Only the walls above and below count.": (
                np.minimum(before[..., 1], 3000 - before[..., 1]) < 300
            ),
        },
    }
    return {
        name: {text: np.mean(values, axis=0) for text, values in these.items()}
        for name, these in shown.items()
    }
