"""Compute what slips make of answers; for the grader."""

import itertools

import numpy as np

from botschool.grading import slips


def mistaken_fitness(expected: dict, maxsteps: int) -> dict:
    """What mistakes make of the fitness of a chase."""
    steps = len(expected["poses"]) - 1
    return {
        "One step too many is counted: the steps should be one fewer than the poses.": 1
        - (steps + 1) / maxsteps,
        "One step too few is counted: the step in which the prey is caught should count, too.": 1
        - (steps - 1) / maxsteps,
        "This is the prey's fitness, 1 minus the predator's, but the predator's is asked for.": 1
        - expected["fitness"],
        "This is T / maxsteps instead of 1 - T / maxsteps.": steps / maxsteps,
        "This is the number of steps instead of the fitness.": steps,
        "The predator gets 1 for every catch, but 1 - T / maxsteps is asked for.": float(
            expected["caught"]
        ),
        "The steps are divided by 2000 instead of `maxsteps`.": 1 - steps / 2000,
    }


def mistaken_tables(table: np.ndarray) -> dict:
    """What comes out if the numbers of `play` are read with the axes in another order."""
    names, found = "GnHm", {"This is the prey's fitness, 1 minus the predator's.": 1 - table}
    pairs = table.reshape(table.shape[0] * table.shape[1], -1)
    by_prey = (
        "The fitness stands at the places of other pairs, as if a list prey by prey were "
        "read predator by predator."
    )
    found[by_prey] = pairs.T.reshape(table.shape)
    for order in itertools.permutations(range(4)):
        read = table.reshape([table.shape[axis] for axis in order])
        said = ", ".join(names[axis] for axis in order)
        for made in (read.transpose(np.argsort(order)), read):
            found.setdefault(
                f"The fitness stands at the places of other pairs, as if the order (G, n, H, m) "
                f"were read as ({said}).",
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
        "The prey of generation 0 play in all places h, but in place h those of generation h "
        "should play.":
        table[:, :, [0] * columns],
        "The prey of the last generation play in all places h, but in place h those of generation "
        "h should play.":
        table[:, :, [-1] * columns],
        "The predators of generation 0 play in all places g, but in place g those of generation g "
        "should play.":
        table[[0] * rows],
        "The predators of the last generation play in all places g, but in place g those of "
        "generation g should play.":
        table[[-1] * rows],
        "The generations of prey stand in the opposite order.": table[:, :, ::-1],
        "The generations of predators stand in the opposite order.": table[::-1],
        "The first predator of each generation plays in all places i, but each predator should "
        "play.":
        table[:, [0] * n],
        "The first prey of each generation plays in all places j, but each prey should play.":
        table[..., [0] * m],
        "Only predators and prey of the same generation meet (the rest is 0), but all should meet.":
        alone,
    }  # fmt: skip
    if rows <= columns:
        made["The predators of generation g meet the prey of g in all places, but in [g, i, h, j] "
             "they should meet those of h."] = of_predators  # fmt: skip
    if columns <= rows:
        made["The prey of generation h meet the predators of h in all places, but in [g, i, h, j] "
             "they should meet those of g."] = of_prey  # fmt: skip
    if rows == columns:
        made["The generations of predators and prey are exchanged: "
             "the order should be g, i, h, j."] = table.transpose(2, 1, 0, 3)  # fmt: skip
    if n == m:
        made["The places i and j of the two robots are exchanged: i should be the predator."] = (
            table.transpose(0, 3, 2, 1)
        )
    if rows == columns and n == m:
        made["Predators and prey are exchanged in the table: the predators should come first."] = (
            table.transpose(2, 3, 0, 1)
        )
    return {text: each for text, each in made.items() if each.shape == table.shape}


def mistaken_means(table: np.ndarray) -> dict:
    """What mistakes make of the mean fitness of two generations; highest is best for predators."""
    n, m = table.shape[1], table.shape[3]
    hunters, hunted = table.mean(axis=3), table.mean(axis=1)
    middle = table.mean(axis=(1, 3))
    made = {
        "The sum over all pairs is divided by n alone, but it should be divided by m, the number "
        "of prey, too.":
        middle * m,
        "The sum over all pairs is divided by m alone, but it should be divided by n, the number "
        "of predators, too.":
        middle * n,
        "This is the sum over all pairs of individuals instead of the mean.": middle * n * m,
        "The sum over all pairs is divided by n + m instead of n times m.":
        middle * n * m / (n + m),
        "Only the first individual of each generation counts here, but the mean over all is asked "
        "for.":
        table[:, 0, :, 0],
        "Only the last individual of each generation counts here, but the mean over all is asked "
        "for.":
        table[:, -1, :, -1],
        "Only the first predator of each generation counts here, but the mean over all is asked "
        "for.":
        hunters[:, 0],
        "Only the first prey of each generation counts here, but the mean over all is asked for.":
        hunted[..., 0],
        "For each predator only its highest number counts here, but the mean over all is asked "
        "for.":
        table.max(axis=3).mean(axis=1),
        "Only the best predator of each generation counts here, but the mean over all is asked "
        "for.":
        hunters.max(axis=1),
        "Only the best prey of each generation counts here, but the mean over all is asked for.":
        hunted.min(axis=2),
        "Only the worst predator of each generation counts here, but the mean over all is asked "
        "for.":
        hunters.min(axis=1),
        "Only the worst prey of each generation counts here, but the mean over all is asked for.":
        hunted.max(axis=2),
        "Against each prey only the best predator counts here, but the mean over all is asked for.":
        table.max(axis=1).mean(axis=2),
        "Against each predator only the best prey counts here, but the mean over all is asked for.":
        table.min(axis=3).mean(axis=1),
        "This is the highest number of all pairs of individuals instead of the mean.":
        table.max(axis=(1, 3)),
        "This is the lowest number of all pairs of individuals instead of the mean.":
        table.min(axis=(1, 3)),
        "This is the median of all pairs of individuals instead of the mean.":
        np.median(table, axis=(1, 3)),
        "This is the root of the mean of the squares instead of the mean.":
        np.sqrt((table**2).mean(axis=(1, 3))),
        "This is the median over the predators of their means instead of the mean over all.":
        np.median(hunters, axis=1),
        "This is the median over the prey of their means instead of the mean over all.":
        np.median(hunted, axis=2),
        "This is the share of chases with a fitness above 0 instead of the mean fitness.":
        (table > 0).mean(axis=(1, 3)),
        "Chases with a fitness of 0 are left out of the mean, but all chases should count.":
        table.sum(axis=(1, 3)) / np.maximum((table > 0).sum(axis=(1, 3)), 1),
        "Only pairs of a predator and a prey with the same number count here, but all pairs "
        "should.":
        table[:, range(min(n, m)), :, range(min(n, m))].mean(axis=0),
    }  # fmt: skip
    for axes in itertools.combinations(range(4), 2):
        names = " and ".join("GnHm"[axis] for axis in axes)
        if axes != (1, 3):
            made[f"The mean is taken over {names}, but it should be taken over n and m."] = (
                table.mean(axis=axes)
            )
    return made


SUMMARIES = {
    "": np.mean,
    "These are sums instead of means.": np.sum,
    "The highest number is taken instead of the mean.": np.max,
    "The lowest number is taken instead of the mean.": np.min,
    "The median is taken instead of the mean.": np.median,
    "This is the root of the mean of the squares instead of the mean.":
    lambda row: np.sqrt(np.mean(np.square(row))),
    "The mean of the squares is taken instead of the mean.": lambda row: np.mean(np.square(row)),
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
        "Column g is read for generation g, but its competitors stand in row g.": matrix.T,
        "This is the fitness of the other side, 1 minus that of the matrix, but the side's own is "
        "asked for.": 1 - matrix,
    }
    by_all = {
        f"The sums are divided by {what} in each generation instead of the number of competitors "
        "in them.": lambda row, by=by: np.sum(row) / by
        for what, by in (("G", count), ("G - 1", count - 1))
    }
    by_more = "The sums are divided by one more than the number of competitors in them."
    by_all[by_more] = lambda row: np.sum(row) / (len(row) + 1)
    no_zeros = (
        "Competitors against whom the fitness is 0 are left out of the mean, but they should count."
    )
    by_all[no_zeros] = lambda row: np.sum(row) / max(1, np.count_nonzero(row))
    return {
        "present": {
            "This is the last row of the matrix instead of the diagonal.": (
                matrix[-1]
            ),
            "This is the first row of the matrix instead of the diagonal.": (
                matrix[0]
            ),
            "These are the means of the columns instead of the diagonal.": matrix.mean(axis=0),
            "These are the means of the rows instead of the diagonal.": matrix.mean(axis=1),
            "This is the first column of the matrix instead of the diagonal.": (
                matrix[:, 0]
            ),
            "This is the last column of the matrix instead of the diagonal.": (
                matrix[:, -1]
            ),
            "This is the diagonal that begins at the upper right, but it should begin at the upper "
            "left.":
            (
                np.diag(matrix[:, ::-1])
            ),
            "This is the fitness of the other side, 1 minus that of the matrix, but the side's own "
            "is asked for.":
            (
                1 - np.diag(matrix)
            ),
            "The present of a generation is averaged with that of all before it, but its own is "
            "asked for.":
            (
                np.cumsum(np.diag(matrix)) / np.arange(1, count + 1)
            ),
        },
        "ancient": slips(
            made,
            matrices=matrices,
            parts={
                "": before(lambda g: slice(g)),
                "Only the generation just before counts here, but all ancient ones should.":
                before(lambda g: slice(g - 1, g)),
                "Only the very first generation counts here, but all ancient ones should.":
                before(lambda g: slice(1)),
                "The present competitors are counted among the ancient ones, but they should be "
                "left out.":
                before(lambda g: slice(g + 1)),
                "All competitors are counted, but only the ancient ones should be.":
                before(lambda g: slice(None)),
                "All competitors but the present ones are counted, but only the ancient ones "
                "should be.":
                before(lambda g: [k for k in range(count) if k != g]),
                "The first generation of competitors is left out, but it is ancient, too.":
                before(lambda g: slice(1, g)),
                "The last generation of ancient competitors is left out, but it should count, too.":
                before(lambda g: slice(max(g - 1, 1))),
                "Only the two generations just before count here, but all ancient ones should.":
                before(lambda g: slice(max(g - 2, 0), g)),
            },
            summary=SUMMARIES | by_all,
        ),
        "future": slips(
            made,
            matrices=matrices,
            parts={
                "": after(lambda g: slice(g + 1, None)),
                "Only the next generation counts here, but all future ones should.":
                after(lambda g: slice(g + 1, g + 2)),
                "Only the very last generation counts here, but all future ones should.":
                after(lambda g: slice(-1, None)),
                "The present competitors are counted among the future ones, but they should be "
                "left out.":
                after(lambda g: slice(g, None)),
                "The last generation is left out of the future, but it should count, too.":
                after(lambda g: slice(g + 1, max(count - 1, g + 2))),
                "All competitors are counted, but only the future ones should be.":
                after(lambda g: slice(None)),
                "All competitors but the present ones are counted, but only the future ones should "
                "be.":
                after(lambda g: [k for k in range(count) if k != g]),
                "The next generation is left out, but it is in the future, too.":
                after(lambda g: slice(min(g + 2, count - 1), None)),
                "Only the next two generations count here, but all future ones should.":
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
        "Neighbouring columns of the matrix are compared instead of neighbouring rows.":
        np.diff(matrix, axis=1).T,
        "Each generation is compared with the first one instead of its predecessor.":
        matrix[1:] - matrix[0],
        "The generation's fitness is subtracted from that of its predecessor, but it should be the "
        "other way round.":
        -gain,
        "The amounts of the differences are taken, but they should stay negative where a "
        "generation is worse.":
        np.abs(gain),
        "This is a generation's own fitness, but that of its predecessor should be subtracted.":
        matrix[1:],
        "The fitness is divided by that of the predecessor, but that should be subtracted.":
        matrix[1:] / np.where(matrix[:-1], matrix[:-1], np.nan),
        "Each generation is compared with the mean of all before it instead of its predecessor.":
        np.array([matrix[g] - matrix[:g].mean(axis=0) for g in later]),
    }  # fmt: skip
    kept = {
        "": lambda g: slice(g),
        "The present competitors are counted among the ancient ones, but only those with k < g "
        "should be.":
        lambda g: slice(g + 1),
        "All competitors are counted, but only the ancient ones should be.": lambda g: slice(None),
        "Only the competitors of generation g - 1 count here, but all with k < g should.":
        lambda g: slice(g - 1, g),
        "Only the present competitors count here, but those with k < g should.":
        lambda g: slice(g, g + 1),
        "The future competitors are taken instead of the ancient ones.":
        lambda g: slice(g + 1, None),
        "Only the very first generation of competitors counts here, but all with k < g should.":
        lambda g: slice(1),
        "The first generation of competitors is left out, but it is ancient, too.":
        lambda g: slice(min(1, g - 1), g),
    }  # fmt: skip
    if count > 2:
        kept["The competitors of generation g - 1 are "
             "left out, but they are ancient, too."] = lambda g: slice(max(g - 1, 1))  # fmt: skip

    def shared(these, kept, draw, counted) -> float:
        rows = [row[kept(g)] for g, row in enumerate(these, 1) if len(row[kept(g)])]
        return counted(rows, draw) if rows else np.nan

    def cases(rows, draw):
        return np.mean(draw(np.concatenate([np.ravel(row) for row in rows])))

    by_all = "The sums are divided by G, the number of all generations, instead of g."
    historical = slips(
        summed,
        these=compared,
        kept=kept,
        summary=SUMMARIES
        | {
            by_all: lambda row: np.sum(row) / count,
            "The sums are divided by G - 1 instead of g.": lambda row: np.sum(row) / (count - 1),
            "The sums are divided by g + 1 instead of g.": lambda row: np.sum(row) / (len(row) + 1),
        },
    )
    historical["A generation and its predecessor each have their own ancient competitors here, but "
               "both should have those of the generation."] = [
        matrix[g, :g].mean() - (matrix[g - 1, : g - 1].mean() if g > 1 else 0) for g in later
    ]  # fmt: skip
    everybody = {"": lambda g: slice(None)} | {
        "The present competitors are left out, but all competitors should count.":
        lambda g: [k for k in range(count) if k != g],
        "Only the ancient competitors count here, but all should.": lambda g: slice(g),
        "Only the ancient and the present competitors count here, but all should.":
        lambda g: slice(g + 1),
        "Only the future competitors count here, but all should.": lambda g: slice(g + 1, None),
        "Only the present competitors count here, but all should.": lambda g: slice(g, g + 1),
        "The first generation of competitors is left out, but all competitors should count.":
        lambda g: slice(1, None),
        "The last generation of competitors is left out, but all competitors should count.":
        lambda g: slice(-1),
    }  # fmt: skip
    on_all = slips(
        summed,
        these=compared,
        kept=everybody,
        summary=SUMMARIES
        | {
            "The sums are divided by G - 1 instead of G.": lambda row: np.sum(row) / (count - 1),
            "The sums are divided by G, though not all competitors are in them.": (
                lambda row: np.sum(row) / count
            ),
        },
    )
    on_all[
        "The mean is taken over the generations for each competitor, but the mean over the "
        "competitors for each generation is asked for."
    ] = gain.mean(axis=0)[1:]
    shares = slips(
        shared,
        these=compared,
        kept=kept,
        draw={
            "": lambda row: (row > 0) + 0.5 * (row == 0),
            "A case in which both do equally well counts fully, but it should count half.":
            lambda row: row >= 0,
            "A case in which both do equally well counts nothing, but it should count half.":
            lambda row: row > 0,
            "Cases in which both do equally well are left out, but each should count half.":
            lambda row: row[row != 0] > 0 if (row != 0).any() else row,
        },
        counted={
            "": cases,
            "The generations with a positive mean gain are counted, but single cases should be "
            "counted.":
            lambda rows, draw: np.mean(draw(of_each(rows, np.mean))),
            "This is the mean of the shares of the generations, but all cases should count alike.":
            lambda rows, draw: np.mean([np.mean(draw(row)) for row in rows]),
            "This is the number of cases instead of their share.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows),
            "The number of cases is divided by that of all places of the matrix, but it should be "
            "divided by that of the cases that are looked at.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows) / count**2,
            "The number of cases is divided by G (G - 1), but it should be divided by that of the "
            "cases that are looked at.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows) / (count * (count - 1)),
            "The number of cases is divided by G - 1, but it should be divided by that of the "
            "cases that are looked at.":
            lambda rows, draw: sum(np.sum(draw(row)) for row in rows) / (count - 1),
            "The share is given in per cent, but a number from 0 to 1 is asked for.":
            lambda rows, draw: 100 * cases(rows, draw),
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
        return {"This is 1, but if there is no group of three the share should be 0.": 1}
    neighbours = [
        way for way, (a, _, c) in zip(right, itertools.combinations(range(count), 3), strict=True)
        if c - a == 2
    ]  # fmt: skip
    one_way = (
        "Only cycles in one direction are counted, but those the other way round should count, too."
    )

    inside = [np.ix_(abc, abc) for abc in itertools.combinations(range(count), 3)]
    two_won, two_lost = (
        np.array([table[each].sum(axis=1).max() == 2 for each in inside])
        for table in (wins, wins.T)
    )
    drawn = [(wins | wins.T)[each].sum() < 6 for each in inside]
    each_one = "each should have won one match and lost the other."
    return {
        one_way: np.mean(found(wins, False)),
        f"Groups with draws count here if nobody has won both matches, but {each_one}": np.mean(
            ~two_won
        ),
        f"Groups with draws count here if nobody has lost both matches, but {each_one}": np.mean(
            ~two_lost
        ),
        f"Groups with draws count here if nobody has won or lost both matches, "
        f"but {each_one}": np.mean(~(two_won | two_lost)),
        "Groups with a draw are left out of the number of groups, but the share of all groups is "
        "asked for.": (sum(right) / max(len(drawn) - sum(drawn), 1)),
        "The number of cycles is divided by G ** 3 / 6 instead of the number of groups of three.": 6
        * sum(right)
        / count**3,
        "The number of cycles is divided by that of pairs instead of that of groups of three.": (
            sum(right) / (count * (count - 1) / 2)
        ),
        "This is the share of the groups that are no cycles, but "
        "that of the cycles is asked for.": 1 - np.mean(right),
        "A draw is counted as a match that was won, but nobody wins a draw.": np.mean(
            found(matrix >= matrix.T)
        ),
        "A match counts as won if its number is above one half, but it should be above that of the "
        "return match.": np.mean(found(matrix > 0.5)),
        "f(a, b) is compared with 1 - f(b, a), but it should be compared with f(b, a).": (
            np.mean(found(matrix > 1 - matrix.T))
        ),
        "This is the number of cycles instead of their share.": sum(right),
        "Only groups of three neighbouring generations are looked at, but all groups of three "
        "should be.": np.mean(neighbours),
        "The number of cycles is divided by G ** 3 instead of the number of groups of three.": sum(
            right
        )
        / count**3,
        "The number of cycles is divided by six times the number of groups instead of that number "
        "itself.": np.mean(right) / 6,
        "Each cycle is counted three times, but it should be counted once.": 3 * np.mean(right),
        "Each cycle is counted twice, but it should be counted once.": 2 * np.mean(right),
        "The number of cycles is divided by that of generations instead of that of groups of "
        "three.": sum(right) / count,
    }


def mistaken_parts(matrix: np.ndarray) -> dict:
    """What mistakes make of the change and its two parts."""
    rows, columns = matrix[1:] - matrix[0], matrix[:, 1:] - matrix[:, :1]
    present, later, count = np.diag(matrix), range(1, len(matrix)), len(matrix)
    other_axis = (
        "The mean is taken over the later generations, but it should be taken over the "
        "generations of the side that is held still."
    )
    one_before = "Each generation is compared with the one before it instead of the first one."
    last = "Each generation is compared with the last one instead of the first one."
    itself = "The fitness for generation 0 is not subtracted, but it should be."
    summaries = SUMMARIES | {
        "The sums are divided by G - 1 instead of G.": lambda row: np.sum(row) / (count - 1)
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
            "The signs are reversed: later minus first is asked for.": -rows,
            "Columns are compared here, but the side's own generations are the rows.": columns.T,
            "The amounts of the differences are taken, but they can be negative.": np.abs(rows),
        },
        kept=with_parts(
            "Only the competitors of the first generation count here, but the mean over all is "
            "asked for.",
            "Only the competitors of generation g count for generation g, but the mean over all is "
            "asked for.",
            "Only the competitors before generation g count for generation g, but the mean over "
            "all is asked for.",
            "Only the competitors up to generation g count for generation g, but the mean over all "
            "is asked for.",
            "Only the competitors of the last generation count here, but the mean over all is "
            "asked for.",
            "The competitors of generation g are left out for generation g, but the mean over all "
            "is asked for.",
            "The competitors of the first generation are left out, but the mean over all is asked "
            "for.",
            "The competitors of the last generation are left out, but the mean over all is asked "
            "for.",
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
            "The signs are reversed: what the later competitors leave minus what the first ones "
            "leave is asked for.":
            -columns.T,
            "Rows are compared here, but the competitors are the columns.": rows,
            "The amounts of the differences are taken, but they can be negative.":
            np.abs(columns.T),
        },
        kept=with_parts(
            "Only the first generation of the side counts here, but the mean over all is asked "
            "for.",
            "Only generation g of the side counts for competitors of generation g, but the mean "
            "over all is asked for.",
            "Only the side's generations before g count for competitors of generation g, but the "
            "mean over all is asked for.",
            "Only the side's generations up to g count for competitors of generation g, but the "
            "mean over all is asked for.",
            "Only the last generation of the side counts here, but the mean over all is asked for.",
            "Generation g of the side is left out for competitors of generation g, but the mean "
            "over all is asked for.",
            "The first generation of the side is left out, but the mean over all is asked for.",
            "The last generation of the side is left out, but the mean over all is asked for.",
        ),
        summary=summaries,
    )  # fmt: skip
    mean_own, mean_others = rows.mean(axis=1), columns.mean(axis=0)
    added = (
        "Gains from each generation to the next are added up, but a comparison with the first "
        "generation is asked for, with the other side held still."
    )
    return {
        "change": {
            one_before: np.diff(present),
            "The signs are reversed: later minus first is asked for.": -(present[1:] - present[0]),
            "This is f(g, 0) - f(0, 0) instead of f(g, g) - f(0, 0).": (
                matrix[1:, 0] - matrix[0, 0]
            ),
            "This is f(0, g) - f(0, 0) instead of f(g, g) - f(0, 0).": (
                matrix[0, 1:] - matrix[0, 0]
            ),
            "This is f(g, g) - f(0, g) instead of f(g, g) - f(0, 0).": present[1:] - matrix[0, 1:],
            "This is f(g, g) - f(g, 0) instead of f(g, g) - f(0, 0).": present[1:] - matrix[1:, 0],
            "This is f(g, g) instead of f(g, g) - f(0, 0).": present[1:],
            "These are the two parts added up, but f(g, g) - f(0, 0) is asked for.": (
                mean_own + mean_others
            ),
            "The means of the rows are compared with that of the first one, but the diagonal "
            "should be.": (mean_own),
            last: present[:-1] - present[-1],
            "The amounts of the changes are taken, but they can be negative.": np.abs(
                present[1:] - present[0]
            ),
            "Each change is divided by f(0, 0), but the difference itself is asked for.": (
                present[1:] - present[0]
            )
            / (present[0] or np.nan),
        },
        "own": own
        | {
            other_axis: rows.mean(axis=0)[1:],
            "This is the change minus the part of the others, but the two parts need not add up to "
            "the change.": (present[1:] - present[0] - mean_others),
            added: np.cumsum([matrix[g, g] - matrix[g - 1, g] for g in later]),
            "This is the part of the others instead of the own one.": mean_others,
        },
        "others": others
        | {
            other_axis: columns.mean(axis=1)[1:],
            "This is the change minus the own part, but the two parts need not add up to the "
            "change.": (present[1:] - present[0] - mean_own),
            added: np.cumsum([matrix[g - 1, g] - matrix[g - 1, g - 1] for g in later]),
            "This is the own part instead of that of the others.": mean_own,
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
        "The last individual of a generation is never drawn, but it should be: rng.integers(n) "
        "gives numbers from 0 to n - 1.": (never_the_last),
        "The prey are drawn before the predators, but the predators "
        "should be drawn first.": prey_first,
        "Only the predators are drawn anew (the prey stay as they are), "
        "but both should be.": predators_only,
        "Only the prey are drawn anew (the predators stay as they are), "
        "but both should be.": prey_only,
        "The predators in the table stay as they are, but those that are drawn "
        "should stand there.": prey_only_though_both_drawn,
        "The same individuals are drawn for all generations, "
        "but each should have its own.": one_for_all_generations,
        "All generations get the individuals that were drawn for the first one, but each should "
        "get its own.": (first_row_for_all_generations),
        "All generations of predators get the individuals that were drawn for the first one, but "
        "each should get its own.": (first_predators_for_all),
        "All generations of prey get the individuals that were drawn for the first one, but each "
        "should get its own.": (first_prey_for_all),
        "The same predators are drawn for all generations, "
        "but each should have its own.": one_predators_for_all,
        "The same prey are drawn for all generations, but each "
        "should have its own.": one_prey_for_all,
        "The numbers are drawn with the sizes (n, G) and (m, H), but with (G, n) for predators and "
        "(H, m) for prey is asked for.": turned_shapes,
        "The first individual of a generation is never drawn, but it should be: numbers begin with "
        "0.": never_the_first,
        "The prey in the table stay as they are, but those that are drawn "
        "should stand there.": predators_only_though_both_drawn,
        "Only every second draw of predators and prey makes a resample, "
        "but each draw should.": once_more_before,
    }
    if rows == columns > 1:
        ways["The predators and prey of one generation are drawn before those of the next, but all "
             "predators should be drawn first."] = one_by_one  # fmt: skip
    made = {text: measures_of(table, weights, seed, resamples, draw) for text, draw in ways.items()}
    rng, before = np.random.default_rng(seed), table
    following, switched, half = [], [], []
    for _ in range(resamples):
        before = resampled(before, drawn_right(rng, table.shape))
        following.append((weights * before).sum())
    rng = np.random.default_rng(seed)
    firm = drawn_right(rng, table.shape)
    made["All resamples have the same individuals, but these should be drawn anew for each."] = (
        np.full(resamples, (weights * resampled(table, firm)).sum())
    )
    rng = np.random.default_rng(seed)
    for _ in range(resamples):
        own, met = drawn_right(rng, table.shape)
        if n == m and rows == columns:
            switched.append((weights * resampled(table, (met, own))).sum())
            half.append((weights * resampled(table, (own, own))).sum())
    made["Each resample is drawn from the one before it instead of the table."] = np.array(
        following
    )
    if switched:
        made[
            "The predators get the numbers that were drawn for the prey, and the prey those for "
            "the predators."
        ] = np.array(switched)
        made[
            "The prey get the numbers that were drawn for the predators, but they should get "
            "their own."
        ] = np.array(half)
    several = "There is one resample fewer than asked for."
    right = measures_of(table, weights, seed, resamples + 1)
    made[several] = right[: resamples - 1]
    made["There is one resample more than asked for."] = right
    if resamples != 300:
        made["There are 300 resamples, whatever `resamples` is."] = measures_of(
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

    bell = "This is the mean plus and minus 1.96 standard deviations, but quantiles are asked for."
    ends = {
        "": at(*ENDS),
        "These are the quantiles 0.05 and 0.95, which hold 90 % of the measures, but 0.025 and "
        "0.975 are asked for.": at(0.05, 0.95),
        "These are the quantiles 0.00025 and 0.00975, but 0.025 and 0.975 are asked for "
        "(np.percentile takes per cent, so 2.5 and 97.5).": at(0.00025, 0.00975),
        "Low and high are exchanged: low should come first.": at(*ENDS[::-1]),
        "These are the smallest and the largest of the measures, but quantiles are asked for.": at(
            0, 1
        ),
        bell: spread(1.96),
        "This is the mean plus and minus 1.96 standard deviations (ddof=1), but quantiles are "
        "asked for.": spread(1.96, 1),
        "This is the mean plus and minus twice the standard deviation, but quantiles are asked "
        "for.": (spread(2)),
        "This is the mean plus and minus the standard deviation, "
        "but quantiles are asked for.": spread(1),
        "This is the mean plus and minus 1.96 standard errors of it, "
        "but quantiles are asked for.": (error),
        "This is the measure of the table plus and minus 1.96 standard deviations, but quantiles "
        "of the measures are asked for.": around,
        "The interval is mirrored at the measure of the table, but the quantiles themselves are "
        "asked for.": lambda values: 2 * middle - np.quantile(values, ENDS[::-1]),
        "The measure of the table is subtracted, but the quantiles themselves are asked for.": (
            lambda values: np.quantile(values, ENDS) - middle
        ),
        "Low and high are entries of the sorted measures, but np.quantile is asked for, which "
        "interpolates between entries.": (
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
    return {
        f"These are the quantiles {ends} of the measures, but 0.025 and 0.975 are asked for.": got
    }


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
    ends = "This is measured at the end of each step instead of its beginning."
    quarter = np.pi / 4
    shown = {
        "turning": {
            "": 10 * abs(short),
            "The difference of two headings is taken as it is, but the short way around is asked "
            "for.": 10 * abs(turned),
            "Turns to the left and to the right cancel out, but the sign of each should be left "
            "out.": 10 * short,
            "This is the turning per step instead of per second.": abs(short),
            "The turning is 0, but it should be the difference of the headings of poses[t] and "
            "poses[t + 1].": (0 * short),
            "The turning is in degrees per second instead of rad per second.": np.degrees(
                10 * abs(short)
            ),
            "A turn to the right counts as a long one to the left, but the short way around is "
            "asked for.": 10 * (turned % (2 * np.pi)),
            "The turn of a step is multiplied by 0.1 s, but it should be divided by it.": 0.1
            * abs(short),
            "Only differences below -pi are taken the short way around, but those above pi should "
            "be, too.": 10 * abs(np.where(turned < -np.pi, turned + 2 * np.pi, turned)),
            "Only differences above pi are taken the short way around, but those below -pi should "
            "be, too.": 10 * abs(np.where(turned > np.pi, turned - 2 * np.pi, turned)),
            "The heading itself is taken instead of its change.": 10 * abs(before[..., 2]),
            "Differences of headings beyond pi count as 0, but the short way "
            "around is asked for.": 10 * np.where(abs(turned) > np.pi, 0, abs(turned)),
            "The turns of both robots are exchanged: the predator's should come first.": 10
            * abs(short)[:, ::-1],
        },
        "speed": {
            "": 10 * np.linalg.norm(moved, axis=2),
            "This is the speed in mm per step instead of mm per second.": np.linalg.norm(
                moved, axis=2
            ),
            "The ways in x and y are added up, but the straight way is asked for.": 10
            * abs(moved).sum(axis=2),
            "The way of a step is multiplied by 0.1 s, but it should be divided by it.": 0.1
            * np.linalg.norm(moved, axis=2),
            "Only the movement along the heading counts here, but how far the robot moves is asked "
            "for.": 10 * along(moved, before[..., 2]),
            "Only the amount of the movement along the heading counts here, but how far the robot "
            "moves is asked for.": 10 * abs(along(moved, before[..., 2])),
            "The square root is left out of the distance.": 10 * (moved**2).sum(axis=2),
            "The change of the heading is counted in the distance, but only x and y should be.": 10
            * np.linalg.norm(after - before, axis=2),
            "Only the movement in x is counted, but that in y should be, too.": 10
            * abs(moved[..., 0]),
            "Only the movement in y is counted, but that in x should be, too.": 10
            * abs(moved[..., 1]),
            "The speeds of both robots are exchanged: the predator's should come first.": 10
            * np.linalg.norm(moved, axis=2)[:, ::-1],
            "The movement relative to the other robot is taken, but that in the arena is asked "
            "for.": 10 * np.linalg.norm(moved - moved[:, ::-1], axis=2),
        },
        "backwards": {
            "": along(moved, before[..., 2]) < 0,
            "The heading at the end of each step is taken instead of that at its beginning.": along(
                moved, after[..., 2]
            )
            < 0,
            "Sine and cosine are exchanged: cos should go with x, and sin with y.": (
                moved[..., 0] * np.sin(before[..., 2]) + moved[..., 1] * np.cos(before[..., 2]) < 0
            ),
            "This is the share of steps forwards, but that of steps backwards is asked for.": along(
                moved, before[..., 2]
            )
            > 0,
            "This is the share of steps in which x becomes smaller, but movement against the "
            "heading is asked for.": (moved[..., 0] < 0),
            "This is the share of steps in which y becomes smaller, but movement against the "
            "heading is asked for.": (moved[..., 1] < 0),
            "The part in y is subtracted from the part in x, but it should be added.": (
                moved[..., 0] * np.cos(before[..., 2]) - moved[..., 1] * np.sin(before[..., 2]) < 0
            ),
            "A step without movement along the heading is counted as backwards, but the movement "
            "should be below 0.": (along(moved, before[..., 2]) <= 0),
            "The heading of the other robot is taken instead of the robot's own.": (
                along(moved, before[:, ::-1, 2]) < 0
            ),
            "The predator's heading is taken for both robots, but each should have its own.": (
                along(moved, before[:, :1, 2]) < 0
            ),
            "The angle between movement and heading is taken as it is, but the short way around is "
            "asked for.": (
                abs(np.arctan2(moved[..., 1], moved[..., 0]) - before[..., 2]) > np.pi / 2
            ),
        },
        "facing": {
            "": abs(bearing) < quarter,
            "The angle to the other robot is taken as it is, but the short way around is asked "
            "for: 350 degrees to the left are 10 to the right.": abs(mixed) < quarter,
            "The other robot counts only if it is to the left of the heading, but the right should "
            "count, too.": (bearing > 0) & (bearing < quarter),
            "The other robot counts only if it is to the right of the heading, but the left should "
            "count, too.": (bearing < 0) & (bearing > -quarter),
            "The other robot counts as faced within 90 degrees to each side, but within 45 is "
            "asked for.": abs(bearing) < 2 * quarter,
            "45 degrees in all are taken, 22.5 to each side, "
            "but 45 to each side are asked for.": abs(bearing) < quarter / 2,
            "The other robot counts as faced in every step, as if an angle in rad were compared "
            "with 45, but 45 degrees are pi / 4.": abs(bearing) < 45,
            "The other robot counts as faced within about 58 degrees, the angle of np.cos(45), but "
            "within 45 degrees is asked for (pi / 4).": np.cos(bearing) > np.cos(45),
            "The direction from the other robot to this one is taken, but it should be the other "
            "way round.": abs(bearing) > 3 * quarter,
            "The direction to the other robot is taken as it is, but the heading should be "
            "subtracted from it.": abs(raw + before[..., 2]) < quarter,
            "Sine and cosine are exchanged: cos should go with x, and sin with y.": abs(
                np.angle(np.exp(1j * (raw + 2 * before[..., 2] - np.pi / 2)))
            )
            < quarter,
            "The heading at the end of each step is taken instead of that at its beginning.": abs(
                bearings(late)[1]
            )
            < quarter,
            "The heading of the other robot is taken instead of the robot's own.": abs(
                bearings(np.concatenate([before[..., :2], before[:, ::-1, 2:]], axis=2))[1]
            )
            < quarter,
            ends: abs(bearings(after)[1]) < quarter,
            "The predator's heading is taken for both robots, but each should have its own.": abs(
                np.angle(np.exp(1j * (raw + before[..., 2] - before[:, :1, 2])))
            )
            < quarter,
        },
        "wall": {
            "": to_wall < 300,
            "The robot's radius is subtracted, but the distance of its centre is asked for.": (
                to_wall - 85 < 300
            ),
            "Only steps near two walls, in x and in y, count here, but near one wall should be "
            "enough.": (nearer.max(axis=2) < 300),
            "The arena is taken for 400 mm wide, but it is 3000 mm wide.": (
                np.minimum(before[..., :2], 400 - before[..., :2]).min(axis=2) < 300
            ),
            "The distance to the nearest corner counts here, but "
            "that to the nearest wall should.": (np.linalg.norm(nearer, axis=2) < 300),
            "This is the distance to the nearest wall, but the share of steps with less than 300 "
            "mm is asked for.": to_wall,
            "Steps far from all walls are counted, but those near a wall should be.": to_wall
            >= 300,
            ends: np.minimum(after[..., :2], 3000 - after[..., :2]).min(axis=2) < 300,
            "Only the left and the lower wall count here, but all four should.": before[
                ..., :2
            ].min(axis=2)
            < 300,
            "Only the right and the upper wall count here, but all four should.": before[
                ..., :2
            ].max(axis=2)
            > 2700,
            "Only the left and the right wall count here, but all four should.": nearer[..., 0]
            < 300,
            "Only the upper and the lower wall count here, but all four should.": nearer[..., 1]
            < 300,
        },
    }
    over_steps = {
        "": lambda v: v.mean(axis=0),
        "The steps are added up, but they should be averaged.": lambda v: v.sum(axis=0),
        "The median of the steps is taken instead of the mean.": lambda v: np.median(v, axis=0),
        "The largest number of the steps is taken instead of the mean.": lambda v: v.max(axis=0),
        "This is the root of the mean of the squares instead of the mean.":
        lambda v: np.sqrt((v**2).mean(axis=0)),
        "The sum is divided by the number of poses, but the number of steps is one smaller.":
        lambda v: v.sum(axis=0) / (len(v) + 1),
        "The first step is left out, but it should count, too.":
        lambda v: v[1:].mean(axis=0) if len(v) > 1 else 0 * v[0],
        "The last step is left out, but it should count, too.":
        lambda v: v[:-1].mean(axis=0) if len(v) > 1 else 0 * v[0],
        "Both robots have the mean over both, but each should have a number of its own.":
        lambda v: np.full(2, v.mean()),
        "This is a single number, the mean over both robots, but each should have a number of its "
        "own.":
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
            f"The other robot counts as faced within {angle} degrees to each side, but within 45 "
            "is asked for.": bearing < np.radians(angle)
            for angle in (15, 20, 30, 40, 50, 60, 75, 120)
        },
        "wall": {
            f"Walls count within {limit} mm here, but they should count within 300 mm.": to_wall
            < limit
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
            "A step without movement along the heading is counted as backwards, but the movement "
            "should be below 0.": (dx * np.cos(heading) + dy * np.sin(heading) <= 0).mean(axis=0)
        },
        "facing": {},
        "wall": {
            "A robot exactly 300 mm from a wall counts as near, but it should be nearer than 300 "
            "mm.": (to_wall <= 300).mean(axis=0)
        },
    }


def mistaken_distances(poses: np.ndarray) -> dict:
    """What mistakes make of the mean distance of both robots."""
    between = poses[:, 0, :2] - poses[:, 1, :2]
    apart = np.linalg.norm(between, axis=1)
    every = np.linalg.norm(poses[:, 0] - poses[:, 1], axis=1)
    return {
        "This is measured at the end of each step instead of its beginning.": apart[1:].mean(),
        "The pose after the last step is counted, too, but no step begins there.": apart.mean(),
        "This is the distance at the start alone instead of the mean.": apart[0],
        "This is the distance at the end alone instead of the mean.": apart[-1],
        "The smallest distance is taken instead of the mean.": apart[:-1].min(),
        "The largest distance is taken instead of the mean.": apart[:-1].max(),
        "The median of the distances is taken instead of the mean.": np.median(apart[:-1]),
        "The distances are added up, but they should be averaged.": apart[:-1].sum(),
        "The square root is left out of the distance.": (between[:-1] ** 2).sum(axis=1).mean(),
        "This is the root of the mean of the squared distances "
        "instead of the mean distance.": np.sqrt((between[:-1] ** 2).sum(axis=1).mean()),
        "The distances in x and y are added up, but the straight distance is asked for.": (
            abs(between[:-1]).sum(axis=1).mean()
        ),
        "Only the distance in x is counted, but that in y should be, too.": abs(
            between[:-1, 0]
        ).mean(),
        "Only the distance in y is counted, but that in x should be, too.": abs(
            between[:-1, 1]
        ).mean(),
        "The difference of the headings is counted in the distance, "
        "but only x and y should be.": every[:-1].mean(),
        "The robots' radii are subtracted, but the distance of their centres is asked for.": (
            apart[:-1].mean() - 170
        ),
        "This is the distance of the mean places instead of the mean of the distances.": (
            np.linalg.norm(between[:-1].mean(axis=0))
        ),
        "The distance is given for both robots, but one number is asked for.": np.full(
            2, apart[:-1].mean()
        ),
    }
