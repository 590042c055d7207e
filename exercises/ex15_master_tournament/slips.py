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
    return mistaken_meetings(table) | found


def mistaken_meetings(table: np.ndarray) -> dict:
    """What comes out if others meet than those whose place it is; table: [g, i, h, j]."""
    rows, n, columns, m = table.shape
    both = range(min(rows, columns))
    of_predators, of_prey, alone = (0 * table for _ in range(3))
    for k in both:
        of_predators[k] = table[k, :, k][:, None]
        of_prey[:, :, k] = table[k, :, k]
        alone[k, :, k] = table[k, :, k]
    made = {
        "The prey of generation 0 are met in all generations of prey.": table[:, :, [0] * columns],
        "The prey of the last generation are met in all generations of prey.":
        table[:, :, [-1] * columns],
        "The predators of generation 0 stand for all generations of predators.": table[[0] * rows],
        "The predators of the last generation stand for all generations of predators.":
        table[[-1] * rows],
        "The generations of the prey stand in the opposite order.": table[:, :, ::-1],
        "The generations of the predators stand in the opposite order.": table[::-1],
        "The first predator of each generation stands for all of them.": table[:, [0] * n],
        "The first prey of each generation stands for all of them.": table[..., [0] * m],
        "Only predators and prey of the same generation meet; the rest is 0.": alone,
    }  # fmt: skip
    if rows <= columns:
        made["The predators of generation g meet the prey of g in all places: in [g, i, h, j] they "
             "meet those of h."] = of_predators  # fmt: skip
    if columns <= rows:
        made["The prey of generation h meet the predators of h in all places: in [g, i, h, j] they "
             "meet those of g."] = of_prey  # fmt: skip
    if rows == columns:
        made["The generations of predators and prey are exchanged: g comes first, then i, h and "
             "j."] = table.transpose(2, 1, 0, 3)  # fmt: skip
    if n == m:
        made["The places i and j of the two robots are exchanged: i is the predator."] = (
            table.transpose(0, 3, 2, 1)
        )
    if rows == columns and n == m:
        made["Predators and prey are exchanged in the table: the predators come first."] = (
            table.transpose(2, 3, 0, 1)
        )
    return {text: each for text, each in made.items() if each.shape == table.shape}


def mistaken_means(table: np.ndarray) -> dict:
    """What mistakes make of the mean fitness of two generations; highest is best for predators."""
    n, m = table.shape[1], table.shape[3]
    hunters, hunted = table.mean(axis=3), table.mean(axis=1)
    middle = table.mean(axis=(1, 3))
    made = {
        "The sum over the individuals is not divided by the number of prey.": middle * m,
        "The sum over the individuals is not divided by the number of predators.": middle * n,
        "This is the sum over all pairs of individuals, not the mean.": middle * n * m,
        "The sum over all pairs is divided by n + m: there are n x m pairs.":
        middle * n * m / (n + m),
        "Only the first individual of each generation counts.": table[:, 0, :, 0],
        "Only the last individual of each generation counts.": table[:, -1, :, -1],
        "Only the first predator of each generation counts.": hunters[:, 0],
        "Only the first prey of each generation counts.": hunted[..., 0],
        "This is the mean over the predators of the best (highest) number, not of all.":
        table.max(axis=3).mean(axis=1),
        "Only the best predator of each generation counts, but the mean over all is asked for.":
        hunters.max(axis=1),
        "Only the best prey of each generation counts, but the mean over all is asked for.":
        hunted.min(axis=2),
        "Only the worst predator of each generation counts, but the mean over all is asked for.":
        hunters.min(axis=1),
        "Only the worst prey of each generation counts, but the mean over all is asked for.":
        hunted.max(axis=2),
        "Against each prey only the best predator counts, but the mean over all is asked for.":
        table.max(axis=1).mean(axis=2),
        "Against each predator only the best prey counts, but the mean over all is asked for.":
        table.min(axis=3).mean(axis=1),
        "This is the highest number of all pairs of individuals, not the mean.":
        table.max(axis=(1, 3)),
        "This is the lowest number of all pairs of individuals, not the mean.":
        table.min(axis=(1, 3)),
        "This is the median of all pairs of individuals, not the mean.":
        np.median(table, axis=(1, 3)),
        "The root is taken of the mean of the squares: take the mean.":
        np.sqrt((table**2).mean(axis=(1, 3))),
        "This is the median over the predators of their means: take the mean over all.":
        np.median(hunters, axis=1),
        "This is the median over the prey of their means: take the mean over all.":
        np.median(hunted, axis=2),
        "This is the share of chases in which the prey is caught, not the mean fitness.":
        (table > 0).mean(axis=(1, 3)),
        "Chases without a catch are left out of the mean: they count with 0.":
        table.sum(axis=(1, 3)) / np.maximum((table > 0).sum(axis=(1, 3)), 1),
        "Each predator meets only the prey with its own number: all pairs count.":
        table[:, range(min(n, m)), :, range(min(n, m))].mean(axis=0),
    }  # fmt: skip
    for axes in itertools.combinations(range(4), 2):
        names = " and ".join("GnHm"[axis] for axis in axes)
        if axes != (1, 3):
            made[f"The mean is taken over {names}: the individuals are n and m."] = table.mean(
                axis=axes
            )
    return made


SUMMARIES = {
    "": np.mean,
    "These are sums, not means.": np.sum,
    "The best number is taken, not the mean.": np.max,
    "The worst number is taken, not the mean.": np.min,
    "The median is taken, not the mean.": np.median,
    "The root is taken of the mean of the squares: take the mean.":
    lambda row: np.sqrt(np.mean(np.square(row))),
    "The mean of the squares is taken: take the mean.": lambda row: np.mean(np.square(row)),
}  # fmt: skip
"""What is made of a row of numbers whose mean is asked for."""


def of_each(rows, summary) -> np.ndarray:
    """Summaries of rows that may have different lengths; NaN of an empty one."""
    return np.array([summary(row) if len(row) else np.nan for row in rows])


def summed(these, kept, summary) -> np.ndarray:
    """Summaries of the parts of rows; kept: generation (from 1 on) -> the part of its row."""
    return of_each([row[kept(g)] for g, row in enumerate(these, 1)], summary)


def mistaken_profile(matrix: np.ndarray) -> dict:
    """What mistakes make of a profile."""
    count = len(matrix)

    def before(kept):
        """Rows of the matrix, for "ancient"; kept: generation -> the part of its row."""
        return lambda these: [these[g][kept(g)] for g in range(1, count)]

    def after(kept):
        return lambda these: [these[g][kept(g)] for g in range(count - 1)]

    def made(matrices, parts, summary):
        return of_each(parts(matrices), summary)

    matrices = {
        "": matrix,
        "The mean goes down a column: competitors are the columns of a row.": matrix.T,
        "This is the fitness of the other side, 1 minus that of the matrix.": 1 - matrix,
    }
    by_all = {
        f"The sums are divided by {what} in each generation: divide by the number of its own "
        "competitors.": lambda row, by=by: np.sum(row) / by
        for what, by in (("G", count), ("G - 1", count - 1))
    }
    by_more = "The sums are divided by one more than the number of competitors."
    by_all[by_more] = lambda row: np.sum(row) / (len(row) + 1)
    no_zeros = "Competitors against whom the fitness is 0 are left out of the mean."
    by_all[no_zeros] = lambda row: np.sum(row) / max(1, np.count_nonzero(row))
    return {
        "present": {
            "This is the last row of the matrix: each generation has a present of its own.": (
                matrix[-1]
            ),
            "This is the first row of the matrix: each generation has a present of its own.": (
                matrix[0]
            ),
            "These are the means of the columns, over all generations.": matrix.mean(axis=0),
            "These are the means of the rows, over all competitors.": matrix.mean(axis=1),
            "This is the first column of the matrix: each generation has a present of its own.": (
                matrix[:, 0]
            ),
            "This is the last column of the matrix: each generation has a present of its own.": (
                matrix[:, -1]
            ),
            "This is the other diagonal: the present of the first generation is the first.": (
                np.diag(matrix[:, ::-1])
            ),
            "This is the fitness of the other side, 1 minus that of the matrix.": (
                1 - np.diag(matrix)
            ),
            "The present of a generation is averaged with that of all before it.": (
                np.cumsum(np.diag(matrix)) / np.arange(1, count + 1)
            ),
        },
        "ancient": slips(
            made,
            matrices=matrices,
            parts={
                "": before(lambda g: slice(g)),
                "Only the generation just before counts, not all ancient ones.":
                before(lambda g: slice(g - 1, g)),
                "Only the very first generation counts, not all ancient ones.":
                before(lambda g: slice(1)),
                "The present competitors count as ancient ones, too.":
                before(lambda g: slice(g + 1)),
                "All competitors count, not the ancient ones alone.":
                before(lambda g: slice(None)),
                "All competitors but the present ones count, not the ancient ones alone.":
                before(lambda g: [k for k in range(count) if k != g]),
                "The first generation of competitors is left out: it is ancient, too.":
                before(lambda g: slice(1, g)),
                "The last generation of ancient competitors is left out.":
                before(lambda g: slice(max(g - 1, 1))),
                "The two generations just before count, not all ancient ones.":
                before(lambda g: slice(max(g - 2, 0), g)),
            },
            summary=SUMMARIES | by_all,
        ),
        "future": slips(
            made,
            matrices=matrices,
            parts={
                "": after(lambda g: slice(g + 1, None)),
                "Only the next generation counts, not all future ones.":
                after(lambda g: slice(g + 1, g + 2)),
                "Only the very last generation counts, not all future ones.":
                after(lambda g: slice(-1, None)),
                "The present competitors count as future ones, too.":
                after(lambda g: slice(g, None)),
                "The last generation is left out of the future.":
                after(lambda g: slice(g + 1, max(count - 1, g + 2))),
                "All competitors count, not the future ones alone.":
                after(lambda g: slice(None)),
                "All competitors but the present ones count, not the future ones alone.":
                after(lambda g: [k for k in range(count) if k != g]),
                "The next generation is left out: it is in the future, too.":
                after(lambda g: slice(min(g + 2, count - 1), None)),
                "The next two generations count, not all future ones.":
                after(lambda g: slice(g + 1, g + 3)),
            },
            summary=SUMMARIES | by_all,
        ),
    }  # fmt: skip


def mistaken_progress(matrix: np.ndarray) -> dict:
    """What mistakes make of progress."""
    count, gain = len(matrix), np.diff(matrix, axis=0)
    later = range(1, count)
    compared = {
        "": gain,
        "Neighbouring columns are compared: a generation is a row of the matrix.":
        np.diff(matrix, axis=1).T,
        "Each generation is compared with the first one, not with its predecessor.":
        matrix[1:] - matrix[0],
        "Each predecessor is compared with the generation after it: the signs are reversed.": -gain,
        "The amounts of the differences are taken: a generation may be worse, too.": np.abs(gain),
        "A generation's own fitness is taken: subtract that of its predecessor.": matrix[1:],
        "The fitness is divided by that of the predecessor: subtract it.":
        matrix[1:] / np.where(matrix[:-1], matrix[:-1], np.nan),
        "Each generation is compared with the mean of all before it, not with its predecessor.":
        np.array([matrix[g] - matrix[:g].mean(axis=0) for g in later]),
    }  # fmt: skip
    kept = {
        "": lambda g: slice(g),
        "The present competitors count as ancient ones, too: k < g.": lambda g: slice(g + 1),
        "All competitors count, not the ancient ones alone.": lambda g: slice(None),
        "These are the gains on the competitors just before: all k < g count.":
        lambda g: slice(g - 1, g),
        "These are the gains on the present competitors: those with k < g count.":
        lambda g: slice(g, g + 1),
        "The future competitors are taken, not the ancient ones.": lambda g: slice(g + 1, None),
        "Only the very first generation of competitors counts: all k < g count.":
        lambda g: slice(1),
        "The first generation of competitors is left out: k = 0 is ancient, too.":
        lambda g: slice(min(1, g - 1), g),
    }  # fmt: skip
    if count > 2:
        kept["One ancient competitor is left out, that of the predecessor's time: k = g - 1 "
             "counts."] = lambda g: slice(max(g - 1, 1))  # fmt: skip

    def shared(these, kept, draw, counted) -> float:
        rows = [row[kept(g)] for g, row in enumerate(these, 1) if len(row[kept(g)])]
        return counted(rows, draw) if rows else np.nan

    def cases(rows, draw):
        return np.mean(draw(np.concatenate([np.ravel(row) for row in rows])))

    by_all = "The sums are divided by G, the number of all generations, not by g."
    historical = slips(
        summed,
        these=compared,
        kept=kept,
        summary=SUMMARIES
        | {
            by_all: lambda row: np.sum(row) / count,
            "The sums are divided by G - 1, not by g.": lambda row: np.sum(row) / (count - 1),
            "The sums are divided by g + 1, not by g.": lambda row: np.sum(row) / (len(row) + 1),
        },
    )
    historical["The ancient competitors of the predecessor are taken for it: both meet the same "
               "k < g."] = [
        matrix[g, :g].mean() - (matrix[g - 1, : g - 1].mean() if g > 1 else 0) for g in later
    ]  # fmt: skip
    everybody = {"": lambda g: slice(None)} | {
        "The present competitors are left out: all k count.":
        lambda g: [k for k in range(count) if k != g],
        "Only the ancient competitors count: all k count.": lambda g: slice(g),
        "Only the ancient and the present competitors count: all k count.":
        lambda g: slice(g + 1),
        "Only the future competitors count: all k count.": lambda g: slice(g + 1, None),
        "These are the gains on the present competitors: all k count.": lambda g: slice(g, g + 1),
        "The first generation of competitors is left out: all k count.": lambda g: slice(1, None),
        "The last generation of competitors is left out: all k count.": lambda g: slice(-1),
    }  # fmt: skip
    on_all = slips(
        summed,
        these=compared,
        kept=everybody,
        summary=SUMMARIES
        | {
            "The sums are divided by G - 1, not by G.": lambda row: np.sum(row) / (count - 1),
            "The sums are divided by G, though not all k are in them.": (
                lambda row: np.sum(row) / count
            ),
        },
    )
    on_all["The mean is taken along the other axis: see axis=."] = gain.mean(axis=0)[1:]
    shares = slips(
        shared,
        these=compared,
        kept=kept,
        draw={
            "": lambda row: (row > 0) + 0.5 * (row == 0),
            "A draw counts half: here it counts fully.": lambda row: row >= 0,
            "A draw counts half: here it counts nothing.": lambda row: row > 0,
            "Draws are left out of the cases: each counts half.":
            lambda row: row[row != 0] > 0 if (row != 0).any() else row,
        },
        counted={
            "": cases,
            "Generations are counted by the mean of their cases: count each case.":
            lambda rows, draw: np.mean(draw(of_each(rows, np.mean))),
            "This is the mean over generations of their shares: all cases count alike.":
            lambda rows, draw: np.mean([np.mean(draw(row)) for row in rows]),
            "This is the number of cases, not their share.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows),
            "The cases are divided by all places of the matrix: divide by the cases that are "
            "looked at.": lambda rows, draw: sum(np.sum(draw(row)) for row in rows) / count**2,
            "The cases are divided by G (G - 1): divide by the cases that are looked at.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows) / (count * (count - 1)),
            "The cases are divided by the number of generations: divide by that of the cases.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows) / (count - 1),
            "The share is given in per cent.": lambda rows, draw: 100 * cases(rows, draw),
        },
        most=1,  # pairs of slips fit shares of few cases by chance
    )  # fmt: skip
    return {"share": shares, "historical": historical, "global": on_all}


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

    inside = [np.ix_(abc, abc) for abc in itertools.combinations(range(count), 3)]
    two_won, two_lost = (
        np.array([table[each].sum(axis=1).max() == 2 for each in inside])
        for table in (wins, wins.T)
    )
    drawn = [(wins | wins.T)[each].sum() < 6 for each in inside]
    each_one = "each of the three must have won one match and lost the other."
    return {
        one_way: np.mean(found(wins, False)),
        f"Groups with draws count if nobody has won both matches: {each_one}": np.mean(~two_won),
        f"Groups with draws count if nobody has lost both matches: {each_one}": np.mean(~two_lost),
        f"Groups with draws count if nobody has won or lost both matches: {each_one}": np.mean(
            ~(two_won | two_lost)
        ),
        "Groups with a draw are left out of all groups: the share is that of all groups.": (
            sum(right) / max(len(drawn) - sum(drawn), 1)
        ),
        "The cycles are divided by G ** 3 / 6, which also counts groups that hold a generation "
        "twice.": 6 * sum(right) / count**3,
        "The cycles are divided by the number of pairs, not by that of groups of three.": (
            sum(right) / (count * (count - 1) / 2)
        ),
        "This is the share of the groups that are no cycles.": 1 - np.mean(right),
        "A draw counts as a match that was won.": np.mean(found(matrix >= matrix.T)),
        "A match is won above one half here: compare it with the return match.": np.mean(
            found(matrix > 0.5)
        ),
        "A match is compared with 1 minus the return match, but both numbers are predators'.": (
            np.mean(found(matrix > 1 - matrix.T))
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
    present, later, count = np.diag(matrix), range(1, len(matrix)), len(matrix)
    other_axis = "The mean is taken along the other axis: see axis=."
    one_before = "Each generation is compared with the one before it, not with the first."
    last = "Each generation is compared with the last one, not with the first."
    itself = "The first generation is not taken away."
    summaries = SUMMARIES | {
        "The sums are divided by G - 1, not by G.": lambda row: np.sum(row) / (count - 1)
    }

    def with_parts(*sentences: str) -> dict:
        """Sentence -> which numbers of the row of generation g are kept; "" for all of them."""
        parts = (
            lambda g: slice(1),
            lambda g: slice(g, g + 1),
            lambda g: slice(g),
            lambda g: slice(g + 1),
            lambda g: slice(-1, None),
            lambda g: [k for k in range(count) if k != g],
            lambda g: slice(1, None),
            lambda g: slice(-1),
        )
        return {"": lambda g: slice(None), **dict(zip(sentences, parts, strict=True))}

    own = slips(
        summed,
        these={
            "": rows,
            one_before: np.diff(matrix, axis=0),
            last: matrix[:-1] - matrix[-1],
            itself: matrix[1:],
            "The sign is turned around: later minus first is asked for.": -rows,
            "Columns are compared here: the side's own generations are the rows.": columns.T,
            "The amounts of the differences are taken.": np.abs(rows),
        },
        kept=with_parts(
            "The competitors of the first generation alone hold still: take the mean over all.",
            "The competitors change with the generation: the very same ones are asked for.",
            "Only the ancient competitors count: take the mean over all.",
            "Only the ancient and the present competitors count: take the mean over all.",
            "The competitors of the last generation alone hold still: take the mean over all.",
            "The present competitors are left out: take the mean over all.",
            "The first competitors are left out: take the mean over all.",
            "The last competitors are left out: take the mean over all.",
        ),
        summary=summaries,
    )  # fmt: skip
    others = slips(
        summed,
        these={
            "": columns.T,
            one_before: np.diff(matrix, axis=1).T,
            last: (matrix[:, :-1] - matrix[:, -1:]).T,
            itself: matrix[:, 1:].T,
            "The sign is turned around: what competitors leave to the side is asked for.":
            -columns.T,
            "Rows are compared here: the competitors are the columns.": rows,
            "The amounts of the differences are taken.": np.abs(columns.T),
        },
        kept=with_parts(
            "The first generation of the side alone holds still: take the mean over all.",
            "Only the generation's own row is compared: take the mean over all generations.",
            "Only the generations before count: take the mean over all.",
            "Only the generations up to this one count: take the mean over all.",
            "The last generation of the side alone holds still: take the mean over all.",
            "The generation's own row is left out: take the mean over all.",
            "The first generation of the side is left out: take the mean over all.",
            "The last generation of the side is left out: take the mean over all.",
        ),
        summary=summaries,
    )  # fmt: skip
    mean_own, mean_others = rows.mean(axis=1), columns.mean(axis=0)
    added = (
        "What is gained from one generation to the next is added up: compare with the first "
        "generation, and hold the other side still."
    )
    return {
        "change": {
            one_before: np.diff(present),
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
                mean_own + mean_others
            ),
            "These are the means of the rows, compared with the first: take the diagonal.": (
                mean_own
            ),
            last: present[:-1] - present[-1],
            "The amounts of the changes are taken.": np.abs(present[1:] - present[0]),
            "Each is divided by f(0, 0).": (present[1:] - present[0]) / (present[0] or np.nan),
        },
        "own": own
        | {
            other_axis: rows.mean(axis=0)[1:],
            "This is the change minus the part of the others: compare the side's rows.": (
                present[1:] - present[0] - mean_others
            ),
            added: np.cumsum([matrix[g, g] - matrix[g - 1, g] for g in later]),
            "Own and others are exchanged.": mean_others,
        },
        "others": others
        | {
            other_axis: columns.mean(axis=1)[1:],
            "This is the change minus the own part: compare competitors.": (
                present[1:] - present[0] - mean_own
            ),
            added: np.cumsum([matrix[g - 1, g] - matrix[g - 1, g - 1] for g in later]),
            "Own and others are exchanged.": mean_own,
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


def first_predators_for_all(rng: np.random.Generator, shape: tuple) -> Draws:
    own, met = drawn_right(rng, shape)
    return np.tile(own[0], (len(own), 1)), met


def first_prey_for_all(rng: np.random.Generator, shape: tuple) -> Draws:
    own, met = drawn_right(rng, shape)
    return own, np.tile(met[0], (len(met), 1))


def one_predators_for_all(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    own = rng.integers(n, size=n)
    return np.tile(own, (rows, 1)), rng.integers(m, size=(columns, m))


def one_prey_for_all(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    own = rng.integers(n, size=(rows, n))
    return own, np.tile(rng.integers(m, size=m), (columns, 1))


def turned_shapes(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    return rng.integers(n, size=(n, rows)).T, rng.integers(m, size=(m, columns)).T


def never_the_first(rng: np.random.Generator, shape: tuple) -> Draws:
    rows, n, columns, m = shape
    own = rng.integers(min(1, n - 1), n, size=(rows, n))
    return own, rng.integers(min(1, m - 1), m, size=(columns, m))


def predators_only_though_both_drawn(rng: np.random.Generator, shape: tuple) -> Draws:
    own, _ = drawn_right(rng, shape)
    return own, np.tile(np.arange(shape[3]), (shape[2], 1))


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
        "All generations of predators get the individuals that were drawn for the first one.": (
            first_predators_for_all
        ),
        "All generations of prey get the individuals that were drawn for the first one.": (
            first_prey_for_all
        ),
        "The same predators are drawn for all generations.": one_predators_for_all,
        "The same prey are drawn for all generations.": one_prey_for_all,
        "The numbers are drawn generation by generation down the columns: the size is (G, n) for "
        "predators and (H, m) for prey.": turned_shapes,
        "The first individual of a generation is never drawn: count from 0.": never_the_first,
        "The prey are drawn, but stay as they are in the table.": predators_only_though_both_drawn,
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

    nearer = np.minimum(before[..., :2], 3000 - before[..., :2])
    to_wall = nearer.min(axis=2)
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
            "": 10 * abs(short),
            "The difference of two headings is not taken the short way around.": 10 * abs(turned),
            "Turns to the left and to the right cancel out: the sign is to be left out.": 10
            * short,
            "This is the turning of a step, not that of a second.": abs(short),
            "This is 0, as if no step turned: the headings of poses[t] and poses[t + 1] differ.": (
                0 * short
            ),
            "The turning is in degrees, not in rad.": np.degrees(10 * abs(short)),
            "A turn to the right becomes a long one to the left: take the short way around.": 10
            * (turned % (2 * np.pi)),
            "A step lasts 0.1 s: divide by it, do not multiply with it.": 0.1 * abs(short),
            "Only one direction is taken the short way around: a heading may leap by 2 pi or by "
            "-2 pi.": 10 * abs(np.where(turned < -np.pi, turned + 2 * np.pi, turned)),
            "Only one direction is taken the short way around: it may leap by -2 pi or by 2 pi.": 10
            * abs(np.where(turned > np.pi, turned - 2 * np.pi, turned)),
            "The heading itself is taken, not its change.": 10 * abs(before[..., 2]),
            "Leaps of the heading count as 0: take the short way around.": 10
            * np.where(abs(turned) > np.pi, 0, abs(turned)),
            "The turns of both robots are exchanged: the predator comes first.": 10
            * abs(short)[:, ::-1],
        },
        "speed": {
            "": 10 * np.linalg.norm(moved, axis=2),
            "This is the speed of a step, not that of a second.": np.linalg.norm(moved, axis=2),
            "The distance is counted as steps in x and y added up, not as the straight way.": 10
            * abs(moved).sum(axis=2),
            "A step lasts 0.1 s: divide by it, do not multiply with it.": 0.1
            * np.linalg.norm(moved, axis=2),
            "Only the movement along the heading counts here: take how far the robot moves.": 10
            * along(moved, before[..., 2]),
            "Only the amount of the movement along the heading counts here: take how far the robot "
            "moves.": 10 * abs(along(moved, before[..., 2])),
            "The square root is left out.": 10 * (moved**2).sum(axis=2),
            "The change of the heading is counted in the distance.": 10
            * np.linalg.norm(after - before, axis=2),
            "Only the movement in x is counted.": 10 * abs(moved[..., 0]),
            "Only the movement in y is counted.": 10 * abs(moved[..., 1]),
            "The speeds of both robots are exchanged: the predator comes first.": 10
            * np.linalg.norm(moved, axis=2)[:, ::-1],
            "The way from one robot to the other is counted in the distance.": 10
            * np.linalg.norm(moved - moved[:, ::-1], axis=2),
        },
        "backwards": {
            "": along(moved, before[..., 2]) < 0,
            "The movement is taken along the heading at the end of the step, not at its "
            "beginning.": along(moved, after[..., 2]) < 0,
            "Sine and cosine are exchanged: cos belongs to x, and sin to y.": (
                moved[..., 0] * np.sin(before[..., 2]) + moved[..., 1] * np.cos(before[..., 2]) < 0
            ),
            "This is the share of steps forwards.": along(moved, before[..., 2]) > 0,
            "This is the share of steps in which x becomes smaller: the heading is left out.": (
                moved[..., 0] < 0
            ),
            "This is the share of steps in which y becomes smaller: the heading is left out.": (
                moved[..., 1] < 0
            ),
            "The two parts are to be added: one is subtracted here.": (
                moved[..., 0] * np.cos(before[..., 2]) - moved[..., 1] * np.sin(before[..., 2]) < 0
            ),
            "A step without a movement along the heading is not backwards: it has to be below 0.": (
                along(moved, before[..., 2]) <= 0
            ),
            "The heading of the other robot is taken.": (along(moved, before[:, ::-1, 2]) < 0),
            "The predator's heading is taken for both robots.": (
                along(moved, before[:, :1, 2]) < 0
            ),
            "Movement and heading are compared, but not the short way around.": (
                abs(np.arctan2(moved[..., 1], moved[..., 0]) - before[..., 2]) > np.pi / 2
            ),
        },
        "facing": {
            "": abs(bearing) < quarter,
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
            "The predator's heading is taken for both robots.": abs(
                np.angle(np.exp(1j * (raw + before[..., 2] - before[:, :1, 2])))
            )
            < quarter,
        },
        "wall": {
            "": to_wall < 300,
            "The robot's radius is subtracted: the distance is that of its centre.": (
                to_wall - 85 < 300
            ),
            "Both x and y have to be near a wall here: one of them is enough.": (
                nearer.max(axis=2) < 300
            ),
            "The arena is taken for 400 mm wide: it is 3000 mm.": (
                np.minimum(before[..., :2], 400 - before[..., :2]).min(axis=2) < 300
            ),
            "The distance to the nearest corner counts here: it is that to a wall.": (
                np.linalg.norm(nearer, axis=2) < 300
            ),
            "This is the distance to the nearest wall: how often is it below 300 mm?": to_wall,
            "These are the steps far from all walls.": to_wall >= 300,
            ends: np.minimum(after[..., :2], 3000 - after[..., :2]).min(axis=2) < 300,
            "Only the walls on the left and below count.": before[..., :2].min(axis=2) < 300,
            "Only the walls on the right and above count.": before[..., :2].max(axis=2) > 2700,
            "Only the walls on the left and on the right count.": nearer[..., 0] < 300,
            "Only the walls above and below count.": nearer[..., 1] < 300,
        },
    }
    over_steps = {
        "": lambda v: v.mean(axis=0),
        "The steps are added up, not averaged.": lambda v: v.sum(axis=0),
        "The median of the steps is taken, not the mean.": lambda v: np.median(v, axis=0),
        "The largest number of the steps is taken, not the mean.": lambda v: v.max(axis=0),
        "The root is taken of the mean of the squares: take the mean.":
        lambda v: np.sqrt((v**2).mean(axis=0)),
        "The sum is divided by the number of poses: there is one step fewer.":
        lambda v: v.sum(axis=0) / (len(v) + 1),
        "The first step is left out.": lambda v: v[1:].mean(axis=0) if len(v) > 1 else 0 * v[0],
        "The last step is left out.": lambda v: v[:-1].mean(axis=0) if len(v) > 1 else 0 * v[0],
        "This is the mean over both robots: each has a number of its own.":
        lambda v: np.full(2, v.mean()),
        "This is the share of the robots that do it: each has a number of its own.":
        lambda v: v.mean(),
    }  # fmt: skip

    def told(values: np.ndarray, over) -> np.ndarray:
        return over(np.asarray(values, dtype=float))

    for name, these in other_limits(poses).items():
        shown[name] |= these
    found = {name: slips(told, values=these, over=over_steps) for name, these in shown.items()}
    return {**found, "distance": mistaken_distances(poses)}


def other_limits(poses: np.ndarray) -> dict:
    """What other limits make of "facing" and "wall"."""
    before = poses[:-1]
    to_other = (before[:, ::-1] - before)[..., :2]
    bearing = np.arctan2(to_other[..., 1], to_other[..., 0]) - before[..., 2]
    bearing = abs((bearing + np.pi) % (2 * np.pi) - np.pi)
    to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=2)
    return {
        "facing": {
            f"The other robot counts as faced within {angle} degrees, not 45.": bearing
            < np.radians(angle)
            for angle in (15, 20, 30, 40, 50, 60, 75, 120)
        },
        "wall": {
            f"Walls count within {limit} mm here, not within 300 mm.": to_wall < limit
            for limit in (85, 100, 150, 170, 200, 250, 350, 400, 450, 500, 600, 1000)
        },
    }


def mistaken_at_limits(poses: np.ndarray) -> dict:
    """What mistakes make of a description that differ only at a limit."""
    before, after = poses[:-1], poses[1:]
    heading, (dx, dy) = before[..., 2], np.moveaxis(after[..., :2] - before[..., :2], 2, 0)
    to_wall = np.minimum(before[..., :2], 3000 - before[..., :2]).min(axis=2)
    return {
        "backwards": {
            "A step without a movement along the heading is not backwards: it has to be below 0.": (
                dx * np.cos(heading) + dy * np.sin(heading) <= 0
            ).mean(axis=0)
        },
        "facing": {},
        "wall": {
            "A robot exactly 300 mm from a wall counts as near: it has to be nearer than 300 mm.": (
                to_wall <= 300
            ).mean(axis=0)
        },
    }


def mistaken_distances(poses: np.ndarray) -> dict:
    """What mistakes make of the mean distance of both robots."""
    between = poses[:, 0, :2] - poses[:, 1, :2]
    apart = np.linalg.norm(between, axis=1)
    every = np.linalg.norm(poses[:, 0] - poses[:, 1], axis=1)
    return {
        "This looks at the end of each step, not at its beginning.": apart[1:].mean(),
        "The pose after the last step counts, too: no step begins there.": apart.mean(),
        "This is the distance at the start alone: take the mean.": apart[0],
        "This is the distance at the end alone: take the mean.": apart[-1],
        "The smallest distance is taken, not the mean.": apart[:-1].min(),
        "The largest distance is taken, not the mean.": apart[:-1].max(),
        "The median of the distances is taken, not the mean.": np.median(apart[:-1]),
        "The distances are added up, not averaged.": apart[:-1].sum(),
        "The square root is left out.": (between[:-1] ** 2).sum(axis=1).mean(),
        "The root is taken of the mean of the squares: take the mean of the distances.": np.sqrt(
            (between[:-1] ** 2).sum(axis=1).mean()
        ),
        "The distances in x and y are added up, not the straight way.": (
            abs(between[:-1]).sum(axis=1).mean()
        ),
        "Only the distance in x is counted.": abs(between[:-1, 0]).mean(),
        "Only the distance in y is counted.": abs(between[:-1, 1]).mean(),
        "The difference of the headings is counted in the distance.": every[:-1].mean(),
        "The robots' radii are subtracted: the distance is that of their centres.": (
            apart[:-1].mean() - 170
        ),
        "This is the distance of the mean places: take the distance in each step first.": (
            np.linalg.norm(between[:-1].mean(axis=0))
        ),
        "The distance is given for both robots, but one number is asked for.": np.full(
            2, apart[:-1].mean()
        ),
    }
