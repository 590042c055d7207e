"""Compute what slips make of answers, and why right answers are right; for the grader."""

from collections.abc import Callable
from functools import partial
from itertools import permutations

import numpy as np

from botschool.grading import slips

UNITS = 10
GATES = ("forget", "input", "output", "candidate")


def squash(x: np.ndarray) -> np.ndarray:
    return 0.5 + 0.5 * np.tanh(0.5 * x)


def answer_of(brain: dict, observation: np.ndarray, memory: np.ndarray) -> tuple:
    known = np.append(observation, memory[1])
    net = np.einsum("gui,i->gu", brain["gates"], known)
    cells = squash(net[0] + 1) * memory[0] + squash(net[1]) * np.tanh(net[3])
    outputs = squash(net[2]) * np.tanh(cells)
    wheels = np.tanh(brain["bias"] + brain["readout"] @ outputs)
    return wheels, np.array([cells, outputs])


@np.errstate(all="ignore")
def mistaken(brain: dict, observation: np.ndarray, memory: np.ndarray) -> dict[str, tuple]:
    """What mistakes make of a step: a sentence -> (action, new memory)."""
    gates, readout, bias = brain["gates"], brain["readout"], brain["bias"]
    z = np.append(observation, memory[1])
    net = gates @ z
    swapped = answer_of(brain, observation, memory[::-1])

    def of(
        known=None,
        order=(0, 1, 2, 3),
        ones=(1, 0, 0, 0),
        gate=squash,
        forget=None,
        enter=None,
        leave=None,
        candidate=np.tanh,
        shown=None,
        old=memory[0],
        outside=True,
    ) -> tuple:
        seen = z if known is None else known
        net = np.einsum("gui,i->gu", gates, seen)[list(order)]
        net = (net.T + np.array(ones, dtype=float).T).T
        kept = gate(net[0])
        taken = gate(net[1]) if enter is None else enter(kept)
        kept = kept if forget is None else forget(net[0])
        cells = kept * old + taken * candidate(net[3])
        leave = gate(net[2]) if leave is None else leave
        outputs = leave * (shown or np.tanh)(cells) if outside else np.tanh(leave * cells)
        return np.tanh(bias + readout @ outputs), np.array([cells, outputs])

    _, (cells, outputs) = right = answer_of(brain, observation, memory)
    kept, taken, shown = squash(net[0] + 1), squash(net[1]), squash(net[2])

    def made(cells: np.ndarray, outputs: np.ndarray | None = None) -> tuple:
        """What follows from other cells, and from other outputs."""
        outputs = shown * np.tanh(cells) if outputs is None else outputs
        return np.tanh(bias + readout @ outputs), np.array([cells, outputs])

    def noticed(weights: np.ndarray) -> np.ndarray:
        """The gates with other weights of the units' outputs or of the observation."""
        net = weights @ z
        cells = squash(net[0] + 1) * memory[0] + squash(net[1]) * np.tanh(net[3])
        return made(cells, squash(net[2]) * np.tanh(cells))

    def unit_by_unit(seen: int) -> tuple:
        """The units one after another, each with what is new in this row of the memory."""
        new = memory.copy()
        for unit in range(UNITS):
            known = np.append(observation, new[seen])
            forget, enter, leave, candidate = gates[:, unit] @ known
            cell = squash(forget + 1) * memory[0, unit] + squash(enter) * np.tanh(candidate)
            new[:, unit] = cell, squash(leave) * np.tanh(cell)
        return np.tanh(bias + readout @ new[1]), new

    more = {
        "The units are computed one after another, each with the new outputs of those before it, "
        "but all of them should see the outputs of the step before.": unit_by_unit(1),
        "The candidate is multiplied by the forget gate and the old cells by the input gate, but "
        "it should be the other way round.":
        made(taken * memory[0] + kept * np.tanh(net[3])),
        "The new memory holds tanh of the new cells, but the new cells themselves are asked for.":
        made(np.tanh(cells), outputs),
        "The new cells are put through tanh, and once more for the outputs, but tanh belongs to "
        "the outputs alone.": made(np.tanh(cells)),
        "The input gate is a factor inside the candidate's tanh, but should be a factor outside.":
        made(kept * memory[0] + np.tanh(taken * net[3])),
        "The forget gate is multiplied by tanh of the old cells, not by the cells themselves.":
        made(kept * np.tanh(memory[0]) + taken * np.tanh(net[3])),
        "The 1 is added to the new cells, but belongs inside the forget gate's logistic function.":
        made(squash(net[0]) * memory[0] + 1 + taken * np.tanh(net[3])),
        "The 1 is added to the new cells, too.": made(cells + 1),
        "The input gate is applied twice.": made(kept * memory[0] + taken**2 * np.tanh(net[3])),
        "The forget gate is applied twice.": made(kept**2 * memory[0] + taken * np.tanh(net[3])),
        "The output gate is applied twice.": made(cells, shown**2 * np.tanh(cells)),
        "The readout is reshaped to (10, 2), which mixes up its weights, but it has a row for each "
        "wheel.": (
            np.tanh(readout.reshape(UNITS, 2).T @ outputs + bias), right[1]),
        "The old cells are left out of the new cells, which are only candidate * input.": made(
            taken * np.tanh(net[3])),
        "The new cells are the mean of old cells * forget and candidate * input, but their sum is "
        "asked for.": made(cells / 2),
        "The new cells are the product of old cells * forget and candidate * input, but their sum "
        "is asked for.":
        made(kept * memory[0] * taken * np.tanh(net[3])),
        "The forget gate is added to the old cells, but they should be multiplied by it.":
        made(kept + memory[0] + taken * np.tanh(net[3])),
        "The input gate is added to the candidate, which should be multiplied by it.":
        made(kept * memory[0] + taken + np.tanh(net[3])),
        "The output gate is added to tanh(new cells), which should be multiplied by it.":
        made(cells, shown + np.tanh(cells)),
        "The forget gate is used where the output gate is asked for.":
        made(cells, kept * np.tanh(cells)),
        "The input gate is used where the output gate is asked for.":
        made(cells, taken * np.tanh(cells)),
        "The output gate is used where the input gate is asked for.":
        made(kept * memory[0] + shown * np.tanh(net[3])),
        "The output gate is used where the forget gate is asked for.":
        made(shown * memory[0] + taken * np.tanh(net[3])),
        "The old outputs, times 1 minus the output gate, are added to the new outputs, but nothing "
        "should be added to them.":
        made(cells, shown * np.tanh(cells) + (1 - shown) * memory[1]),
        "The logistic function is applied to the output gate's net input times tanh(new cells), "
        "but belongs to the net input alone.":
        made(cells, squash(net[2] * np.tanh(cells))),
        "The three gates are not put through the logistic function.":
        made((net[0] + 1) * memory[0] + net[1] * np.tanh(net[3]),
             net[2] * np.tanh((net[0] + 1) * memory[0] + net[1] * np.tanh(net[3]))),
        "The forget gate is not put through the logistic function.":
        made((net[0] + 1) * memory[0] + taken * np.tanh(net[3])),
        "The forget gate is 1 minus what it should be.":
        made(squash(-net[0] - 1) * memory[0] + taken * np.tanh(net[3])),
        "The input gate is 1 minus what it should be.":
        made(kept * memory[0] + squash(-net[1]) * np.tanh(net[3])),
        "The output gate is 1 minus what it should be.":
        made(cells, squash(-net[2]) * np.tanh(cells)),
        "The input gate is not put through the logistic function.":
        made(kept * memory[0] + net[1] * np.tanh(net[3])),
        "The output gate is not put through the logistic function.":
        made(cells, net[2] * np.tanh(cells)),
        "The forget gate goes through tanh instead of the logistic function.":
        made(np.tanh(net[0] + 1) * memory[0] + taken * np.tanh(net[3])),
        "The input gate goes through tanh instead of the logistic function.":
        made(kept * memory[0] + np.tanh(net[1]) * np.tanh(net[3])),
        "The output gate goes through tanh instead of the logistic function.":
        made(cells, np.tanh(net[2]) * np.tanh(cells)),
        "1 is added to tanh of the candidate, too, but belongs to the forget gate's net input "
        "alone.":
        made(kept * memory[0] + taken * (1 + np.tanh(net[3]))),
        "The new cells are cut off at -1 and 1, but they should have no limits.":
        made(cells.clip(-1, 1)),
        "The old outputs are added to the new cells, but do not belong there.":
        made(cells + memory[1]),
        "The outputs of the step before are put through tanh, but z should hold them as they are.":
        of(
            known=np.append(observation, np.tanh(memory[1]))),
        "z holds tanh of the old cells instead of the outputs of the step before.": of(
            known=np.append(observation, np.tanh(memory[0]))),
        "The observation is put through tanh, but z should hold it as it is.": of(
            known=np.append(np.tanh(observation), memory[1])),
        "The new outputs are those of the step before, unchanged.": made(cells, memory[1]),
        "The new memory holds the cells of the step before instead of the new ones.": (
            right[0], np.array([memory[0], outputs])),
        "The memory that was given is returned instead of the new one.": (right[0], memory),
        "Both rows of the new memory hold the cells, but the second should hold the outputs.":
        (right[0], np.array([cells, cells])),
        "Both rows of the new memory hold the outputs, but the first should hold the cells.":
        (right[0], np.array([outputs, outputs])),
        "The second row of the new memory is tanh(cells), without the output gate.": (
            right[0], np.array([cells, np.tanh(cells)])),
        "The gates see the observation in the opposite order.": noticed(
            np.concatenate([gates[..., 7::-1], gates[..., 8:]], axis=2)),
        "The bias is added once for each unit, but should be added only once for each wheel.": (
            np.tanh(readout @ outputs + UNITS * bias), right[1]),
        "The bias is a factor, but should be added.":
        (np.tanh((readout @ outputs) * bias), right[1]),
        "The bias of the first wheel is used for both.": (
            np.tanh(readout @ outputs + bias[0]), right[1]),
        "The two biases are exchanged.": (np.tanh(readout @ outputs + bias[::-1]), right[1]),
        "The action is brought to the range from 0 to 1, but should be tanh(...), from -1 to 1.": (
            (np.tanh(readout @ outputs + bias) + 1) / 2, right[1]),
        "The sum over the units is divided by their number before the bias is added, but no "
        "division is asked for.": (
            np.tanh(readout @ outputs / UNITS + bias), right[1]),
        "The action is read from tanh(outputs), but should be read from the outputs themselves.": (
            np.tanh(readout @ np.tanh(outputs) + bias), right[1]),
        "The action goes through tanh twice.": (np.tanh(right[0]), right[1]),
        "The absolute value of the action is returned, but the action should keep its sign.":
        (np.abs(right[0]), right[1]),
        "The action has the opposite sign.": (-right[0], right[1]),
    }  # fmt: skip
    return more | {
        "The 1 that should be added to the forget gate's net input is left out.":
        of(ones=(0, 0, 0, 0)),
        "1 is subtracted from the forget gate's net input instead of added.": of(
            ones=(-1, 0, 0, 0)
        ),
        "The 1 is added to the forget, the input and the output gate, but belongs to the forget "
        "gate alone.": of(
            ones=(1, 1, 1, 0)
        ),
        "The 1 is added to the input gate, but belongs to the forget gate.": of(ones=(0, 1, 0, 0)),
        "The 1 is added to the output gate, but belongs to the forget gate.": of(
            ones=(0, 0, 1, 0)
        ),
        "The 1 is added after the logistic function, but belongs inside it.": of(
            forget=lambda net: squash(net - 1) + 1
        ),
        **{
            "The gates are taken in the order "
            f"{', '.join(GATES[order.index(k)] for k in range(4))}, but should be taken as forget, "
            "input, output, candidate.": of(order=order)
            for order in permutations(range(4)) if order != (0, 1, 2, 3)
        },
        "The candidate goes through the logistic function instead of tanh.": of(
            candidate=squash
        ),
        "tanh of the candidate is left out.": of(candidate=lambda x: x),
        "The new cells go to the outputs without tanh.": of(shown=lambda x: x),
        "The new outputs are computed from the old cells, but should come from the new ones.":
        of(
            shown=lambda _: np.tanh(memory[0])
        ),
        "The three gates go through tanh instead of the logistic function.":
        of(gate=np.tanh),
        "The input gate is 1 minus the forget gate, but should have weights of its own.":
        of(
            enter=lambda kept: 1 - kept
        ),
        "The forget gate is not applied, so that the old cells are kept whole.": of(
            forget=lambda _: 1.0
        ),
        "The old cells are forgotten wholly, but the forget gate should decide how much of them "
        "stays.": of(
            forget=lambda _: 0.0
        ),
        "The input gate is not applied to the candidate.": of(enter=lambda _: 1.0),
        "The output gate is not applied.": of(leave=1.0),
        "The network sees its cells (row 0 of the memory) instead of its outputs (row 1).": of(
            known=np.append(observation, memory[0])
        ),
        "The outputs of the step before stand in front of the observation, but belong behind "
        "it.": of(known=np.append(memory[1], observation)),
        "z holds 0 instead of the outputs of the step before.": of(
            known=np.append(observation, np.zeros(UNITS))
        ),
        "The 1 is added to all four gates, but belongs to the forget gate alone.":
        of(ones=(1, 1, 1, 1)),
        "The 1 is added to the candidate, but belongs to the forget gate.": of(ones=(0, 0, 0, 1)),
        "The output gate is a factor inside the tanh of the new cells, but should be a factor "
        "outside.":
        of(outside=False),
        "The new cells go to the outputs through the logistic function instead of tanh.":
        of(shown=squash),
        "The forget gate is multiplied by the old outputs, not by the old cells.":
        of(old=memory[1]),
        "The old cells are multiplied by 1 minus the forget gate, not by the gate itself.": of(
            forget=lambda net: 1 - squash(net)
        ),
        "Each of the three gates is 1 minus what it should be.": of(
            gate=lambda net: squash(-net)
        ),
        "The new candidate is subtracted from the old cells, but should be added.": of(
            candidate=lambda x: -np.tanh(x)
        ),
        "The forget gate is a factor of the candidate, too, but should be a factor of the old "
        "cells alone.": of(
            enter=lambda kept: kept * squash(net[1])
        ),
        "The forget gate is used where the input gate is asked for.": of(enter=lambda kept: kept),
        "z holds 0 instead of the observation.": of(
            known=np.append(0 * observation, memory[1])
        ),
        "The bias of the wheels is added after tanh, but should be added inside it.": (
            np.tanh(readout @ outputs) + bias, right[1]
        ),
        "The bias of the wheels is subtracted, but should be added.":
        (np.tanh(readout @ outputs - bias), right[1]),
        "The action is read from tanh(new cells), without the output gate.": (
            np.tanh(bias + readout @ np.tanh(cells)), right[1]
        ),
        "The action is read from the cells of the step before.": (
            np.tanh(bias + readout @ memory[0]), right[1]
        ),
        "Cells and outputs are exchanged in the old and the new memory, but memory[0] should hold "
        "the cells.": (
            swapped[0], swapped[1][::-1]
        ),
        "The rows of the old memory are exchanged, but memory[0] should be the cells and memory[1] "
        "the outputs.": swapped,
        "The old cells are multiplied by 1 minus the input gate, not by the forget gate.": of(
            forget=lambda _: 1 - squash(net[1])
        ),
        "The 1 is added to each number of z for the forget gate, but should be added once, to the "
        "product.": of(
            ones=np.stack([gates[0].sum(axis=1), *np.zeros((3, UNITS))])
        ),
        "The 1 is added to each number of z for all gates, but should be added once, to the forget "
        "gate's product.": of(
            known=z + 1, ones=(0, 0, 0, 0)
        ),
        "The output gate sees tanh of the new cells, but all gates should see the same z.": of(
            leave=squash(gates[2] @ np.append(observation, np.tanh(cells)))
        ),
        "The two wheels are exchanged.": (right[0][::-1], right[1]),
        "The rows of the new memory are exchanged, with the outputs before the cells.": (
            right[0], np.array([outputs, cells])
        ),
        "The action is cut off at -1 and 1 instead of put through tanh.": (
            np.clip(bias + readout @ outputs, -1, 1), right[1]
        ),
        "The action is not put through tanh.": (bias + readout @ outputs, right[1]),
        "The bias of the two wheels is left out.": (np.tanh(readout @ outputs), right[1]),
        "The action is read from the cells instead of the outputs.": (
            np.tanh(bias + readout @ cells), right[1]
        ),
        "The action is read from the outputs of the step before.": (
            np.tanh(bias + readout @ memory[1]), right[1]
        ),
        "The action goes through the logistic function instead of tanh.": (
            squash(bias + readout @ outputs), right[1]
        ),
    }  # fmt: skip


def mistaken_parts(brain: dict, observation: np.ndarray, memory: np.ndarray, part: int) -> dict:
    """What mistakes make of the new cells (0), the new outputs (1) or the action (2)."""
    wrong = mistaken(brain, observation, memory)
    return {text: (*memory, wheels)[part] for text, (wheels, memory) in wrong.items()}


def inside(brain: dict, observation: np.ndarray, memory: np.ndarray, name: str, unit: int) -> str:
    """What the text says about a number of the answer, with the numbers from which it comes."""
    net = brain["gates"] @ np.append(observation, memory[1])
    (forget, enter, leave, candidate), old = net[:, unit if name != "action" else 0], memory[0]
    cells = answer_of(brain, observation, memory)[1][0]
    if name == "cells":
        return (
            f"Cell {unit} should be old cell {old[unit]:.4g} * forget {squash(forget + 1):.4g} + "
            f"candidate {np.tanh(candidate):.4g} * input {squash(enter):.4g}."
        )
    if name == "outputs":
        return (
            f"Output {unit} should be tanh(new cell {cells[unit]:.4g}) * output gate "
            f"{squash(leave):.4g}."
        )
    return (
        f"Action {unit} should be tanh(row {unit} of readout times the new outputs, plus "
        f"bias[{unit}])."
    )


def grid_of(places: int, headings: int) -> np.ndarray:
    ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
    return np.array(
        [(x, y, 2 * np.pi * k / headings) for y in ys for x in xs for k in range(headings)]
    )


@np.errstate(all="ignore")
def wrong_grids(places: int, headings: int, column: int) -> dict:
    """What slips make of a column of a grid."""

    def made(order, rows, spread, angles):
        ranges = spread(270, 350, places), spread(150, 250, places), angles
        table = np.meshgrid(*(ranges[i] for i in order), indexing="ij")
        y, x, heading = (table[order.index(i)].ravel() for i in range(3))
        return np.stack([x, y, heading], axis=1)[:, rows][:, column]

    turn = np.arange(headings) / headings
    table = np.meshgrid(
        np.linspace(150, 250, places), np.linspace(270, 350, places), 2 * np.pi * turn
    )
    names = ("y", "x", "the heading")
    xy = ("x", "y", "x or y")[column]
    return {
        "The x, y and headings of all starts are reshaped to rows of three, which mixes them up.":
        np.array(table).reshape(-1, 3)[:, column],
    } | slips(
        made,
        order={"": (0, 1, 2)} | ({
            f"This column is that of a grid in which {names[a]} changes slowest, then {names[b]}, "
            f"and {names[c]} fastest, but y should be slowest and the heading fastest.": (a, b, c)
            for a, b, c in permutations(range(3)) if (a, b, c) != (0, 1, 2)
        } if headings > 1 else {
            "In your grid y changes faster than x, or both change together, but x should change "
            "faster than y.": (1, 0, 2)
        }),
        rows={
            "": [0, 1, 2],
            "x and y are exchanged, but a row should hold x, y, heading.": [1, 0, 2],
            "The heading stands first in a row, but a row should hold x, y, heading.": [2, 0, 1],
        },
        spread={
            "": np.linspace,
            "The upper end of the range is missing.": partial(np.linspace, endpoint=False),
            "The values are the middles of equal parts of the range, but both ends should belong "
            "to the grid.":
            lambda a, b, n: a + (b - a) * (np.arange(n) + 0.5) / n,
            "The values are cut to whole numbers, but should keep their fractions.":
            lambda a, b, n: np.linspace(a, b, n).astype(int),
            ("x has the range of y.", "y has the range of x.", "")[column]: lambda a, b, n:
            np.linspace(*((150, 250) if a == 270 else (270, 350)), n),
            f"{xy} falls from its upper end to its lower one, but should rise.":
            lambda a, b, n: np.linspace(b, a, n),
            f"{xy} is the lower end of its range everywhere.": lambda a, b, n: np.full(n, float(a)),
            f"{xy} is the upper end of its range everywhere.": lambda a, b, n: np.full(n, float(b)),
            f"The lower end of {xy} is missing.": lambda a, b, n: np.linspace(a, b, n + 1)[1:],
            f"Both ends of {xy} are missing.": lambda a, b, n: np.linspace(a, b, n + 2)[1:-1],
            f"{xy} is counted from 0, not from its lower end.":
            lambda a, b, n: np.linspace(0, b - a, n),
            f"{xy} begins at 0, not at its lower end.":
            lambda a, b, n: np.linspace(0, b, n),
            f"The steps of {xy} are its range divided by `places` + 1, not by `places` - 1.":
            lambda a, b, n: a + np.arange(n) * (b - a) / (n + 1),
            f"The steps of {xy} are cut to whole millimetres, but {xy} should hold fractions.":
            lambda a, b, n: a + np.arange(n) * ((b - a) // max(n - 1, 1)),
            f"The values of {xy} are rounded, but {xy} should hold fractions.":
            lambda a, b, n: np.linspace(a, b, n).round(),
            f"The steps of {xy} are as long as those of the other one of x and y.": lambda a, b, n:
            a + np.linspace(0, 100 if a == 270 else 80, n),
        },
        angles={
            "": 2 * np.pi * turn,
            "The headings go from 0 to 2 pi with both included, but 2 pi is 0 again and should be "
            "left out.":
            np.linspace(0, 2 * np.pi, headings),
            "The headings are in degrees, not in radians.": 360 * turn,
            "The headings divide half a turn, not the whole one.": np.pi * turn,
            "The fraction of the step between headings is cut off.":
            np.arange(headings) * (2 * np.pi // headings),
            "The headings begin at minus pi, not at 0.": 2 * np.pi * turn - np.pi,
            "The headings turn clockwise, but should grow from 0.": -2 * np.pi * turn,
            "The headings are in whole turns, not in radians.": turn,
            "The headings divide the turn into one part too many.":
            2 * np.pi * np.arange(headings) / (headings + 1),
            "The headings begin half a part after 0, but should begin at 0.":
            2 * np.pi * (turn + 0.5 / headings),
            "The headings fall from 2 pi, but should begin at 0 and grow.": 2 * np.pi * (1 - turn),
            "The headings stand in the opposite order, but should begin at 0 and grow.":
            2 * np.pi * turn[::-1],
            "The headings lie between -pi and pi, but should grow from 0.":
            np.angle(np.exp(2j * np.pi * turn)),
            "The headings divide a quarter of a turn, not the whole one.": np.pi / 2 * turn,
            "The headings divide two turns, not one.": 4 * np.pi * turn,
            "The headings go from 0 to pi with both included, but should divide the whole turn.":
            np.linspace(0, np.pi, headings),
            "The headings begin at minus pi and end at pi, but should begin at 0 and leave out 2 "
            "pi.":
            np.linspace(-np.pi, np.pi, headings),
            "All headings are 0, but they should divide the whole turn.": 0 * turn,
            "The headings are counted as 0, 1, 2 and so on, but should be angles.":
            1.0 * np.arange(headings),
            "The step between headings is a right angle, however many there are.":
            np.pi / 2 * np.arange(headings),
            "The step between headings is 2 pi divided by `places`, not by `headings`.":
            2 * np.pi * np.arange(headings) / places,
            "The headings are rounded, but should keep their fractions.":
            (2 * np.pi * turn).round(),
            "The headings begin one part after 0 and end with 2 pi, but should begin at 0 and "
            "leave out 2 pi.":
            2 * np.pi * (np.arange(headings) + 1) / headings,
        },
    )  # fmt: skip


def described(poses: np.ndarray, rewards: np.ndarray, cylinder) -> dict:
    found = np.flatnonzero(rewards)
    search = int(found[0]) if len(found) else len(rewards)
    told = {key: [] for key in ("speed", "turning", "wall", "pace", "side")}
    for t in range(len(rewards)):
        (x, y, heading), (x2, y2, heading2) = poses[t], poses[t + 1]
        if t < search:
            told["speed"].append((x2 - x) * np.cos(heading) + (y2 - y) * np.sin(heading))
            turned = heading2 - heading
            told["turning"].append(np.arctan2(np.sin(turned), np.cos(turned)))
            told["wall"].append(min(x, y, 400 - x, 400 - y) < 72.5)
        if rewards[t] > 0:
            told["pace"].append(np.hypot(x2 - x, y2 - y))
            dx, dy = cylinder[0] - x2, cylinder[1] - y2
            left = np.cos(heading2) * dy - np.sin(heading2) * dx
            told["side"].append(left / np.hypot(dx, dy))
    means = {k: float(np.mean(v)) if v else 0.0 for k, v in told.items()}
    return {"search": search, **means, "steps": told}


NO_REWARD = "Without any reward, all steps should belong to the search, and none should be near."


@np.errstate(all="ignore")
def wrong_described(poses: np.ndarray, rewards: np.ndarray, cylinder, name: str) -> dict:
    """What slips make of a descriptor."""
    before, after, near = poses[:-1], poses[1:], rewards > 0
    (dx, dy, change), steps, many = (after - before).T, np.arange(len(rewards)), len(rewards)
    search = int(near.argmax()) if near.any() else many
    last = int(np.flatnonzero(near)[-1]) if near.any() else many
    if name == "search":
        return {
            NO_REWARD: np.argmax(near),
            "The search is one step too long, but should end before the first reward.":
            search + 1,
            "The search is one step too short.": search - 1,
            "All steps without a reward count, but the search should end at the first reward.":
            np.sum(~near),
            "All steps count, not only those of the search.": many,
            "These are the steps near the cylinder, not those of the search.": np.sum(near),
            "Without any reward, the search is given as 500 steps, but should have as many as the "
            "episode.":
            search if near.any() else 500,
            "Without any reward, the search has one step more than the episode, but should have as "
            "many.":
            search if near.any() else many + 1,
            "Without any reward, the search has one step less than the episode, but should have as "
            "many.":
            search if near.any() else many - 1,
            "The search is divided by 10, but should be counted in steps, not in seconds.":
            search / 10,
            "This is the longest run of steps without a reward, but the search should end at the "
            "first reward.":
            max(map(len, "".join(".x"[int(each)] for each in near).split("x"))),
            "These are the steps from the first reward on, not those before it.": many - search,
            "The search goes on to the last step with a reward, but should end at the first one.":
            last,
            "This is the share of the steps that belong to the search, but their number is asked "
            "for.": search / many,
            "Without any reward, the search is -1, but should have as many steps as the episode.":
            search if near.any() else -1,
            "A reward in the first step is overlooked.":
            int(near[1:].argmax()) + 1 if near[1:].any() else many,
            "The first step is left out when the first reward is looked for.":
            int(near[1:].argmax()) if near[1:].any() else many,
        }  # fmt: skip

    def forward(heading: np.ndarray) -> np.ndarray:
        return dx * np.cos(heading) + dy * np.sin(heading)

    turned = np.arctan2(np.sin(change), np.cos(change))
    walls = np.stack([*before[:, :2].T, *(400 - before[:, :2]).T])
    nearest = walls.min(axis=0)
    to_x, to_y = (np.asarray(cylinder, dtype=float) - after[:, :2]).T
    from_x, from_y = (np.asarray(cylinder, dtype=float) - before[:, :2]).T
    theta, later, length = before[:, 2], after[:, 2], np.hypot(dx, dy)
    bearing = np.arctan2(to_y, to_x)
    values = {
        "speed": {
            "": forward(theta),
            "The heading at the end of the step is taken, not that at its beginning.":
            forward(later),
            "The heading in the middle of the step is taken, not that at its beginning.":
            forward((theta + later) / 2),
            "This is how far the robot moves in any direction, but the way along its heading is "
            "asked for.": length,
            "The absolute value of the speed is taken, but driving backwards should be negative.":
            np.abs(forward(theta)),
            "The speed has the opposite sign.": -forward(theta),
            "Sine and cosine are exchanged.": dx * np.sin(theta) + dy * np.cos(theta),
            "The part in y is subtracted from that in x, but should be added.":
            dx * np.cos(theta) - dy * np.sin(theta),
            "This is how far the robot moves sideways, not along its heading.":
            dy * np.cos(theta) - dx * np.sin(theta),
            "The heading is left out, but the way along it is asked for.": dx + dy,
            "The heading at the start is taken in all steps, not the heading of each step.":
            dx * np.cos(theta[0]) + dy * np.sin(theta[0]),
            "The speed is multiplied by 10, but should be that per step, not per second.":
            10 * forward(theta),
            "The speed is divided by 10, but should be that per step.": forward(theta) / 10,
            "The way along the heading is divided by the length of the way, but should be in mm.":
            forward(theta) / np.where(length > 0, length, 1),
            "The heading is taken for degrees, but it is in radians, which np.cos takes.":
            forward(np.radians(theta)),
            "The heading is turned into degrees, but np.cos takes radians.":
            forward(np.degrees(theta)),
            "Only dx cos(heading) is there, but dy sin(heading) should be added.":
            dx * np.cos(theta),
            "Only dy sin(heading) is there, but dx cos(heading) should be added.":
            dy * np.sin(theta),
            "The places (x, y) after the step are taken instead of the ways (dx, dy).":
            after[:, 0] * np.cos(theta) + after[:, 1] * np.sin(theta),
            "The places (x, y) before the step are taken instead of the ways (dx, dy).":
            before[:, 0] * np.cos(theta) + before[:, 1] * np.sin(theta),
            "The whole length of the way is taken, with the sign of the speed, but only the part "
            "along the heading should count.": np.sign(forward(theta)) * length,
            "The parts in x and y are squared and added, and the root is taken, but their sum is "
            "asked for.":
            np.hypot(dx * np.cos(theta), dy * np.sin(theta)),
            "Ways backwards count as 0, but should be negative.": np.maximum(forward(theta), 0),
            "The way of the next step is taken, not that of this one.":
            np.append(forward(theta)[1:], 0),
            "This is the direction of the way, not how far it leads along the heading.":
            np.arctan2(dy, dx),
        },
        "turning": {
            "": turned,
            "The change of the heading is taken as it is, but the short way around is asked for.":
            change,
            "The turning has lost its sign, but turns to the right should be negative.":
            np.abs(turned),
            "The turning has the opposite sign, but should be positive to the left.": -turned,
            "A turn to the right is taken for a long one to the left.": change % (2 * np.pi),
            "The turning is in degrees, not in radians.": np.degrees(turned),
            "Only one direction is taken the short way around, and changes above pi are left as "
            "they are.":
            np.where(change < -np.pi, change + 2 * np.pi, change),
            "Only one direction is taken the short way around, and changes below -pi are left as "
            "they are.":
            np.where(change > np.pi, change - 2 * np.pi, change),
            "This is the absolute value of the short way around, without its sign.":
            np.minimum(np.abs(change), 2 * np.pi - np.abs(change)),
            "The turning is the heading after the step, but its change is asked for.": later,
            "The turning is the heading at the beginning of the step, but its change is asked for.":
            theta,
            "Half a turn is added and not subtracted again, but the turning should lie between -pi "
            "and pi.":
            (change + np.pi) % (2 * np.pi),
            "A turn to the left is taken for a long one to the right.": -(-change % (2 * np.pi)),
            "The turning is cut off at -pi and pi, but the short way around is asked for.":
            change.clip(-np.pi, np.pi),
            "Changes above pi and below -pi count as 0, but the short way around is asked for.":
            np.where(np.abs(change) > np.pi, 0, change),
            "The remainder by pi is taken, but a whole turn is 2 pi.": change % np.pi,
            "The turning is the sine of the change, not the change itself.": np.sin(change),
            "The turning is multiplied by 10, but should be that per step, not per second.":
            10 * turned,
            "The direction in which the robot moves is taken for its heading after the step.":
            np.angle(np.exp(1j * (np.arctan2(dy, dx) - theta))),
            "Changes below -pi do not take the short way around, which % leads to, but np.fmod "
            "does not.":
            np.fmod(change + np.pi, 2 * np.pi) - np.pi,
            "Changes beyond pi and -pi are made smaller by pi, but a whole turn is 2 pi.":
            change - np.pi * np.sign(change) * (np.abs(change) > np.pi),
            "The long way around is taken, not the short one.":
            turned - np.sign(turned) * 2 * np.pi,
            "The changes are brought between -pi / 2 and pi / 2, but should be from -pi to pi.":
            (change + np.pi / 2) % np.pi - np.pi / 2,
        },
        "wall": {
            "": nearest < 72.5,
            "A robot exactly 72.5 mm from a wall counts as near, but should be nearer than 72.5 mm "
            "to count.":
            nearest <= 72.5,
            **{f"Walls count within {limit} mm of the centre, but 72.5 mm is asked for.":
               nearest < limit
               for limit in (25, 30, 40, 50, 55, 60, 65, 70, 75, 80, 90, 99.5, 120, 145, 150)},
            "The end of the step is looked at, not its beginning.":
            np.minimum(after[:, :2], 400 - after[:, :2]).min(axis=1) < 72.5,
            "Only the left and the lower wall are looked at.": walls[:2].min(axis=0) < 72.5,
            "Only the right and the upper wall are looked at.": walls[2:].min(axis=0) < 72.5,
            "Only the left and the right wall are looked at.": walls[::2].min(axis=0) < 72.5,
            "Only the lower and the upper wall are looked at.": walls[1::2].min(axis=0) < 72.5,
            "A step counts only if two walls are near, but one should be enough.":
            np.minimum(*walls.reshape(2, 2, -1)).max(axis=0) < 72.5,
            "These are the steps far from all walls, not those near one.": nearest >= 72.5,
            "This is the distance to the nearest wall, but the share of steps in which it is below "
            "72.5 mm is asked for.": nearest,
            "Walls count within 72.5 mm of the robot's edge, but should count within 72.5 mm of "
            "its centre.":
            nearest - 27.5 < 72.5,
            "Walls count within 45 mm of the centre, but 72.5 mm is asked for.": nearest < 45,
            "Walls count within 100 mm of the centre, but 72.5 mm is asked for.": nearest < 100,
            "Walls count within 27.5 mm of the centre, but 72.5 mm is asked for.": nearest < 27.5,
            "The distance to the nearest corner is taken, but the distance to the nearest wall "
            "should count.":
            np.hypot(*np.minimum(before[:, :2], 400 - before[:, :2]).T) < 72.5,
            "The distance to the cylinder is taken, but the distance to the nearest wall should "
            "count.":
            np.hypot(from_x, from_y) < 72.5,
            "The distance to (0, 0) is taken, but the distance to the nearest wall should count.":
            np.hypot(*before[:, :2].T) < 72.5,
            "The distance to the arena's middle is taken, but the distance to the nearest wall "
            "should count.":
            np.hypot(*(before[:, :2] - 200).T) > 127.5,
            "Only the left wall is looked at.": walls[0] < 72.5,
            "Only the lower wall is looked at.": walls[1] < 72.5,
            "Only the right wall is looked at.": walls[2] < 72.5,
            "Only the upper wall is looked at.": walls[3] < 72.5,
            "Steps near two walls count twice, but should count once.":
            np.sum(walls < 72.5, axis=0),
            "The upper wall is left out.": walls[:3].min(axis=0) < 72.5,
            "The right wall is left out.": walls[[0, 1, 3]].min(axis=0) < 72.5,
            "The lower wall is left out.": walls[[0, 2, 3]].min(axis=0) < 72.5,
            "The left wall is left out.": walls[1:].min(axis=0) < 72.5,
            "A step counts if it begins or ends near a wall, but only its beginning should decide.":
            np.minimum(nearest, np.minimum(after[:, :2], 400 - after[:, :2]).min(axis=1)) < 72.5,
            "The right and the upper wall are taken to be at 500 mm, but should be at 400 mm.":
            np.minimum(before[:, :2].min(axis=1), 500 - before[:, :2].max(axis=1)) < 72.5,
            "The share is given in per cent, but should lie between 0 and 1.":
            100 * (nearest < 72.5),
            "The right and the lower wall count only if both are near (in Python `&` binds more "
            "tightly than `|`).":
            (walls[0] < 72.5) | ((walls[2] < 72.5) & (walls[1] < 72.5)) | (walls[3] < 72.5),
            "A step counts only if x and y are both near a wall, but one of them should be enough.":
            ((walls[0] < 72.5) | (walls[2] < 72.5)) & ((walls[1] < 72.5) | (walls[3] < 72.5)),
        },
        "pace": {
            "": length,
            "The pace is the way along the heading, but the whole length of the way is asked for.":
            forward(theta),
            "The pace is the absolute value of the way along the heading, but the whole length of "
            "the way is asked for.": np.abs(forward(theta)),
            "The square root is left out of the length of the way.": length**2,
            "The pace is the sum of the ways in x and y, not the straight way.":
            np.abs(dx) + np.abs(dy),
            "The pace is that of the step before, not that of this step.":
            np.append(0, length[:-1]),
            "The pace is that of the step after, not that of this step.": np.append(length[1:], 0),
            "The change of the heading is counted in the pace, but only x and y should count.":
            np.sqrt(length**2 + change**2),
            "The pace is multiplied by 10, but should be that per step, not per second.":
            10 * length,
            "The pace is the distance to the cylinder, not how far the robot moves.":
            np.hypot(to_x, to_y),
            "The pace is the change of the distance to the cylinder, not how far the robot moves.":
            np.hypot(from_x, from_y) - np.hypot(to_x, to_y),
            "The pace is the absolute change of the distance to the cylinder, not how far the "
            "robot moves.":
            np.abs(np.hypot(from_x, from_y) - np.hypot(to_x, to_y)),
            "Only the way in x is counted, but that in y should count, too.": np.abs(dx),
            "Only the way in y is counted, but that in x should count, too.": np.abs(dy),
            "The pace is the larger one of the ways in x and y, not the straight way.":
            np.maximum(np.abs(dx), np.abs(dy)),
            "The pace is how far the robot turns, not how far it moves.": np.abs(turned),
            "The pace is the distance from (0, 0), but the way from pose to pose is asked for.":
            np.hypot(*after[:, :2].T),
        },
        "side": {
            "": np.sin(bearing - later),
            "The pose before the step is taken, not that after it.":
            np.sin(np.arctan2(from_y, from_x) - theta),
            "The place is that before the step, not that after it.":
            np.sin(np.arctan2(from_y, from_x) - later),
            "The heading is that before the step, not that after it.": np.sin(bearing - theta),
            "This is the cosine, not the sine.": np.cos(bearing - later),
            "Left and right are exchanged.": np.sin(later - bearing),
            "The heading is not subtracted from the direction of the cylinder.": np.sin(bearing),
            "The heading is added, but should be subtracted.": np.sin(bearing + later),
            "This is the angle itself, but its sine is asked for.": bearing - later,
            "The direction is arctan2(dx, dy), but should be arctan2(dy, dx).":
            np.sin(np.arctan2(to_x, to_y) - later),
            "This is the sine times the distance to the cylinder, not the sine alone.":
            np.sin(bearing - later) * np.hypot(to_x, to_y),
            "Only the sign of the sine is taken, not the sine itself.":
            np.sign(np.sin(bearing - later)),
            "The direction leads from the arena's middle to the cylinder, not from the robot.":
            np.sin(np.arctan2(cylinder[1] - 200, cylinder[0] - 200) - later),
            "The direction leads from (0, 0) to the cylinder, but should lead from the robot.":
            np.sin(np.arctan2(cylinder[1], cylinder[0]) - later),
            "The direction leads from the start to the cylinder, but should lead from the robot's "
            "place after each step.":
            np.sin(np.arctan2(*(np.asarray(cylinder) - poses[0, :2])[::-1]) - later),
            "The heading at the start is subtracted, not that after each step.":
            np.sin(bearing - poses[0, 2]),
            "The angle is turned into degrees, but np.sin takes radians.":
            np.sin(np.degrees(bearing - later)),
            "The angle is taken for degrees, but it is in radians, which np.sin takes.":
            np.sin(np.radians(bearing - later)),
            "The direction is arctan(dy / dx), which takes opposite directions for the same, "
            "unlike np.arctan2(dy, dx).":
            np.sin(np.arctan(to_y / np.where(to_x == 0, 1e-9, to_x)) - later),
            "The absolute value of the side is taken, but it should be negative if the cylinder is "
            "to the right.":
            np.abs(np.sin(bearing - later)),
            "This is the tangent, not the sine.": np.tan(bearing - later),
            "This is the angle itself, the short way around, but its sine is asked for.":
            np.angle(np.exp(1j * (bearing - later))),
            "The direction in which the robot moves is taken for its heading after the step.":
            np.sin(bearing - np.arctan2(dy, dx)),
            "This is the sine of the direction minus the sine of the heading, but the sine of "
            "their difference is asked for.":
            np.sin(bearing) - np.sin(later),
            "x and y of the cylinder are exchanged.":
            np.sin(np.arctan2(cylinder[0] - after[:, 1], cylinder[1] - after[:, 0]) - later),
        },
    }  # fmt: skip
    of_search = {
        "": steps < search,
        "All steps without a reward count, but the search should end at the first reward.": ~near,
        "All steps count, not only those of the search.": steps >= 0,
        "The search is one step too long, but should end before the first reward.": steps <= search,
        "The search is one step too short.": steps < search - 1,
        "The first step is left out.": (steps > 0) & (steps < search),
        "These are the steps near the cylinder, not those of the search.": near,
        NO_REWARD: steps < np.argmax(near),
    }
    of_near = {
        "": near,
        "All steps after the search count, but only those with a reward should.": steps >= search,
        "All steps count, not only those with a reward.": steps >= 0,
        "These are the steps of the search, not those near the cylinder.": steps < search,
        "These are the steps without a reward, not those with one.": ~near,
        "Only the first step near the cylinder counts, but all of them should.": steps == search,
        "The first step near the cylinder is left out.": near & (steps > search),
        "For each step with a reward, the step before it is taken.": np.append(near[1:], False),
        "For each step with a reward, the step after it is taken.": np.append(False, near[:-1]),
        "All steps from the first reward to the last count, but only those with a reward should.": (
            steps >= search
        )
        & (steps <= last),
        "The first step is left out.": near & (steps > 0),
        "The last step with a reward is left out.": near & (steps < last),
    }
    of_near[NO_REWARD] = rewards == rewards.max()

    if name == "pace":
        spots = after[near, :2]
        hops, starts = (
            np.hypot(*np.diff(places[near, :2], axis=0).T) if near.sum() > 1 else np.zeros(1)
            for places in (after, before)
        )
        many_near = max(int(near.sum()), 1)
        extra = {
            "These are the ways from one place with a reward to the next such place, but the way "
            "from the beginning to the end of each step is asked for.": hops.mean(),
            "These are the ways from the beginning of one step with a reward to the beginning of "
            "the next such step, but the way from the beginning to the end of each step is asked "
            "for.": starts.mean(),
            "The ways are added up with their directions, so that they cancel out, but the mean of "
            "their lengths is asked for.":
            np.hypot(dx[near].sum(), dy[near].sum()) / many_near,
            "This is the root of the mean of the squares, not the mean of the lengths.":
            np.sqrt(np.sum(length[near] ** 2) / many_near),
            "This is the straight way from the first place near the cylinder to the last one, "
            "divided by the steps near it, but the mean way of these steps is asked for.":
            np.hypot(*(spots[-1] - spots[0])) / many_near if len(spots) else 0.0,
        }  # fmt: skip
    elif name == "speed":
        gone = np.hypot(*(poses[search, :2] - poses[0, :2]))
        part = steps < search
        ahead = np.array([np.cos(theta[part]).mean(), np.sin(theta[part]).mean()]) if search else 0
        extra = {
            "This is the straight way of the whole search, divided by its steps, but the mean way "
            "along the heading of each step is asked for.": gone / max(search, 1),
            "The mean ways are multiplied by the mean sine and cosine, but this should be done in "
            "each step, before the mean.":
            float(np.sum(ahead * np.array([dx[part].mean(), dy[part].mean()]))) if search else 0.0,
        }  # fmt: skip
    elif name == "side":
        away = np.linalg.norm(np.stack([to_x, to_y]))
        cross = np.sin(bearing - later) * np.hypot(to_x, to_y) / away
        extra = {"All steps are divided by the same length, but each should be divided by its own "
                 "distance (axis=1).":
                 cross[near].mean() if near.any() else 0.0,
                 "Directions and headings are averaged first, but the sine should be taken in each "
                 "step, before the mean.":
                 np.sin(np.arctan2(to_y[near].mean(), to_x[near].mean()) - later[near].mean())
                 if near.any() else 0.0}  # fmt: skip
    elif name == "turning":
        gone = poses[search, 2] - poses[0, 2]
        extra = {
            "The short way around is taken once, from the first heading to the last, but should be "
            "taken in each step.": ((gone + np.pi) % (2 * np.pi) - np.pi) / max(search, 1),
            "The short way around is taken after the mean, but should be taken in each step, "
            "before the mean.":
            (gone / max(search, 1) + np.pi) % (2 * np.pi) - np.pi,
        }  # fmt: skip
    else:
        extra = {}

    def made(value, which, summary):
        return summary(value[which].astype(float)) if which.any() else 0.0

    return extra | slips(
        made,
        value=values[name],
        which=of_near if name in ("pace", "side") else of_search,
        summary={
            "": np.mean,
            "The values are added up, but their mean is asked for.": np.sum,
            "This is the median, not the mean.": np.median,
            "This is the mean of the absolute values.": lambda v: np.abs(v).mean(),
            "The sum is divided by the number of all steps of the episode, not by that of its own "
            "steps.": lambda v: v.sum() / many,
            "This is the last value, not the mean.": lambda v: v[-1],
            "The sum is divided by one less than the number of values.":
            lambda v: v.sum() / max(len(v) - 1, 1),
            "The sum is divided by one more than the number of values.":
            lambda v: v.sum() / (len(v) + 1),
            "This is the first value, not the mean.": lambda v: v[0],
            "This is the largest value, not the mean.": np.max,
            "This is the smallest value, not the mean.": np.min,
            "This is the standard deviation, not the mean.": np.std,
            "This is the largest minus the smallest value, not the mean.": np.ptp,
        },
    )  # fmt: skip


MEANT = {
    "search": "The number of steps before the first one with a reward, or of all steps if there is "
    "none.",
    "speed": "The mean of dx cos(heading) + dy sin(heading) over the search, with the heading "
    "before each step, or 0 if no step belongs to it.",
    "turning": "The mean change of the heading in a step of the search, the short way around, or 0 "
    "if no step belongs to it.",
    "wall": "The share of the steps of the search that begin nearer than 72.5 mm to at least one "
    "of the four walls, or 0 if no step belongs to it.",
    "pace": "The mean length of the straight way from pose to pose, over all steps with a reward, "
    "or 0 if there are none.",
    "side": "The mean sine of the direction of the cylinder minus the heading, both after the "
    "step, over all steps with a reward, or 0 if there are none.",
}


def scaled(answer, table: np.ndarray, row: int, column: int) -> str:
    """What is right and wrong about a column of a standardised table."""
    got, values = np.asarray(answer, dtype=float)[:, column], table[:, column]
    steps, own = np.diff(got), np.diff(values)
    said = (
        f"Column {column} has the mean {values.mean():.6g} and the standard deviation "
        f"{values.std():.6g}."
    )
    factor = float(steps @ own / (own @ own))
    if factor <= 0 or np.abs(steps - factor * own).max() > 1e-6 * np.abs(got).max():
        return said
    middle, divisor = values.mean() - got.mean() / factor, 1 / factor
    wrong = [
        f"{text} {used:.6g}"
        for text, used, right in (
            ("subtracts", middle, values.mean()), ("divides by", divisor, values.std())
        )
        if abs(used - right) > 1e-6 * np.abs(values).max()
    ]  # fmt: skip
    return f"{said} Your code {' and '.join(wrong)} there." if wrong else said


@np.errstate(all="ignore")
def wrong_scales(table: np.ndarray) -> dict:
    """What slips make of a standardised table."""
    deviations = {
        "": (0, 0),
        "The standard deviation is that of each row, not that of each column (axis=0).": (1, 0),
        "The standard deviation is that of the whole table, not that of each column (axis=0).": (
            None,
            0,
        ),
        "The standard deviation has ddof=1, but ddof=0 is asked for.": (0, 1),
    }
    return slips(
        lambda centre, spread: (table - centre) / np.where(spread < 1e-12, 1.0, spread),
        centre={
            "": table.mean(axis=0),
            "The mean of the column is not subtracted.": 0.0,
            "The mean of each row is subtracted, not that of each column.":
            table.mean(axis=1, keepdims=True),
            "The mean of the whole table is subtracted, not that of each column.": table.mean(),
            "The median is subtracted, not the mean.": np.median(table, axis=0),
            "The smallest value is subtracted, not the mean.": table.min(axis=0),
        },
        spread={
            text: table.std(axis=axis, ddof=ddof, keepdims=True)
            for text, (axis, ddof) in deviations.items() if len(table) > ddof
        } | {
            "The differences are not divided by the standard deviation.": np.ones((1, 1)),
            "The differences are divided by the variance, not by the standard deviation.":
            table.var(axis=0),
            "The differences are divided by the range, not by the standard deviation.":
            np.ptp(table, axis=0),
            "The differences are divided by the largest of their absolute values, not by the "
            "standard deviation.":
            np.abs(table - table.mean(axis=0)).max(axis=0),
            "The differences are divided by the root of the sum of their squares, not by the "
            "standard deviation.":
            np.linalg.norm(table - table.mean(axis=0), axis=0),
            "The differences are divided by the mean, not by the standard deviation.":
            table.mean(axis=0),
            "The differences are divided by the root of the standard deviation, not by the "
            "standard deviation itself.":
            np.sqrt(table.std(axis=0)),
            "The differences are divided by the mean of their absolute values, not by the standard "
            "deviation.":
            np.abs(table - table.mean(axis=0)).mean(axis=0),
            "The differences are divided by the sum of the column, not by the standard deviation.":
            table.sum(axis=0),
            "The differences are divided by the largest value of the column, not by the standard "
            "deviation.": table.max(axis=0),
            "The standard deviation is that of the absolute values, not that of the values.":
            np.abs(table).std(axis=0),
            "The differences are divided by the root of the mean square of the column, not of the "
            "differences.": np.sqrt((table**2).mean(axis=0)),
        },
    ) | {
        "The mean alone is divided by the standard deviation, not the difference from it.":
        table - table.mean(axis=0) / table.std(axis=0),
        "The mean is subtracted after the division, but should be subtracted before it.":
        table / table.std(axis=0) - table.mean(axis=0),
        "The differences are multiplied by the standard deviation, but should be divided by it.":
        (table - table.mean(axis=0)) * table.std(axis=0),
        "The mean is added to the values, but should be subtracted from them.":
        (table + table.mean(axis=0)) / table.std(axis=0),
        "The absolute values of the differences are taken, but they should keep their signs.":
        np.abs(table - table.mean(axis=0)) / table.std(axis=0),
        "The values are subtracted from the mean, but the mean should be subtracted from the "
        "values.":
        (table.mean(axis=0) - table) / table.std(axis=0),
        "These are the places of the values in the order of their column, not the standardised "
        "values.":
        table.argsort(axis=0).argsort(axis=0),
        "The differences of all columns are divided by the standard deviation of the last column.":
        (table - table.mean(axis=0)) / table[:, -1].std(),
        "The differences of all columns are divided by the standard deviation of the first column.":
        (table - table.mean(axis=0)) / table[:, 0].std(),
    }  # fmt: skip


def grouped(table: np.ndarray, threshold: float, told: list | None = None) -> list[int]:
    """The families; told: takes a sentence for each merger, and one for what ends them."""
    rows = (table - table.mean(axis=0)) / table.std(axis=0)
    distance = np.linalg.norm(rows[:, None] - rows, axis=2)
    labels = np.arange(len(rows))
    while len(set(labels)) > 1:
        nearest = min(
            (distance[labels == i][:, labels == j].mean(), i, j)
            for i in set(labels)
            for j in set(labels)
            if i < j
        )
        if told is not None:
            one, other = (np.flatnonzero(labels == label).tolist() for label in nearest[1:])
            told.append(f"{one} and {other} are nearest, {nearest[0]:.3g} apart")
        if nearest[0] >= threshold:
            break
        labels[labels == nearest[2]] = nearest[1]
    return numbered(labels.tolist())


def numbered(labels: list) -> list[int]:
    """The same families, numbered in the order of their first robots."""
    names = list(dict.fromkeys(labels))
    return [names.index(label) for label in labels]


OVER_PAIRS: dict[str, Callable] = {
    "union": lambda apart, a, b: apart[np.ix_(a + b, a + b)].mean(),
    "median": lambda apart, a, b: np.median(apart[np.ix_(a, b)]),
    "sum of nearest": lambda apart, a, b: (
        (apart[np.ix_(a, b)].min() + apart[np.ix_(a, b)].max()) / 2
    ),
    "root": lambda apart, a, b: np.sqrt((apart[np.ix_(a, b)] ** 2).mean()),
    "last": lambda apart, a, b: apart[a[-1], b[-1]],
    "first row": lambda apart, a, b: apart[np.ix_(a[:1], b)].mean(),
    "one member": lambda apart, a, b: apart[np.ix_(a, b)].sum() / max(len(a), len(b)),
}
"""Other distances of two families, from the distances of their robots."""


def joined(
    table: np.ndarray, threshold: float, rows: Callable, apart: Callable, link: Callable, rule: str
) -> list[int]:
    """The families with slips, from a table of their distances.

    link: the new distances of two merged families, from their old ones and sizes. rule: which pair
    is merged; "leader", "centre" and "once" are other ways to make families.
    """
    points = np.nan_to_num(rows(table), posinf=0, neginf=0)
    base = apart(points[:, None] - points)
    distance = base.copy()
    if rule == "leader":
        labels = []
        for robot in range(len(table)):
            ahead = [first for first in labels[:robot] if distance[first, robot] < threshold]
            labels.append(ahead[0] if ahead else robot)
        return numbered(labels)
    groups, sizes = [[robot] for robot in range(len(table))], np.ones(len(table))
    np.fill_diagonal(distance, np.inf)
    while len(groups) > 1:
        below = np.triu(distance <= threshold if rule == "equal" else distance < threshold)
        if not below.any():
            break
        best = {
            "first": np.argmax(below),
            "lowest": np.argmax(below.T),
            "farthest": np.argmax(np.where(np.isfinite(distance), distance, -np.inf)),
            "farthest below": np.argmax(np.where(below, distance, -np.inf)),
        }
        i, j = sorted(np.unravel_index(best.get(rule, np.argmin(distance)), distance.shape))
        if rule == "centre":
            points = np.delete(points, j, 0)
            points[i] = rows(table)[groups[i] + groups[j]].mean(axis=0)
            distance = apart(points[:, None] - points)
        elif rule in OVER_PAIRS:
            parts = [*groups[:i], groups[i] + groups[j], *groups[i + 1 : j], *groups[j + 1 :]]
            distance = np.array([[OVER_PAIRS[rule](base, a, b) for b in parts] for a in parts])
        else:
            distance[i] = link(distance[i], distance[j], sizes[i], sizes[j])
            distance[:, i] = distance[i]
            distance = np.delete(np.delete(distance, j, 0), j, 1)
        np.fill_diagonal(distance, np.inf)
        groups[i] += groups.pop(j)
        sizes = np.array([len(group) for group in groups], dtype=float)
        if rule == "once":
            break
    labels = np.empty(len(table), dtype=int)
    for group in groups:
        labels[group] = min(group)
    return numbered(labels.tolist())


def wrong_families(table: np.ndarray, threshold: float) -> dict:
    """What one slip makes of families."""
    rows = {
        "": lambda t: (t - t.mean(axis=0)) / table.std(axis=0),
        "The descriptors are compared as they are, but should be standardised first.":
        lambda t: t + 0.0,
        "The descriptors are standardised with ddof=1, but ddof=0 is asked for.":
        lambda t: (t - t.mean(axis=0)) / t.std(axis=0, ddof=1),
        "Each robot's row is standardised, not each column.":
        lambda t: (t - t.mean(axis=1, keepdims=True)) / t.std(axis=1, keepdims=True),
        "The whole table is standardised at once, not each column.":
        lambda t: (t - t.mean()) / t.std(),
    }  # fmt: skip
    apart = {
        "": lambda d: np.sqrt((d**2).sum(axis=2)),
        "The square root is left out of the distance of two robots.": lambda d: (d**2).sum(axis=2),
        "The distance of two robots is the sum of the absolute differences, not the length of the "
        "difference.":
        lambda d: np.abs(d).sum(axis=2),
        "The distance of two robots is the largest absolute difference, not the length of the "
        "difference.":
        lambda d: np.abs(d).max(axis=2),
        "The distance of two robots is the root of the mean of the squares, not of their sum.":
        lambda d: np.sqrt((d**2).mean(axis=2)),
    }  # fmt: skip
    link = {
        "": lambda a, b, m, n: (m * a + n * b) / (m + n),
        "The distance of two families is that of their nearest robots, but the mean over all pairs "
        "is asked for.":
        lambda a, b, m, n: np.minimum(a, b),
        "The distance of two families is that of their most different robots, but the mean over "
        "all pairs is asked for.":
        lambda a, b, m, n: np.maximum(a, b),
        "When two families merge, their distances are averaged whatever their sizes, but the mean "
        "over all pairs of robots is asked for.":
        lambda a, b, m, n: (a + b) / 2,
        "A family is represented by its first robot, but the mean over all pairs is asked for.":
        lambda a, b, m, n: a,
        "The distances of the pairs are added up, but their mean is asked for.":
        lambda a, b, m, n: a + b,
    }  # fmt: skip
    rule = {
        "": "nearest",
        "Families exactly as far apart as the threshold are merged, but should be nearer than it.":
        "equal",
        "The first pair nearer than the threshold is merged, but the two nearest families should "
        "be merged.":
        "first",
        "The first pair below the threshold is merged, but the two nearest families should be "
        "merged.": "lowest",
        "Each robot joins the first robot that is near, but families should be merged, the nearest "
        "first.":
        "leader",
        "The distance of two families is that of their mean rows, but the mean distance of their "
        "robots is asked for.":
        "centre",
        "Only one merger is made, but merging should go on until no two families are nearer than "
        "the threshold.": "once",
        "The pairs inside a family are counted, too, but only pairs of a robot of the one and a "
        "robot of the other should be.": "union",
        "The median over all pairs of robots is taken, not the mean.": "median",
        "The distances of the nearest and the farthest pair are averaged, but the mean over all "
        "pairs is asked for.":
        "sum of nearest",
        "The distance of two families is the root of the mean square over all pairs, not the mean "
        "over all pairs.": "root",
        "A family is represented by its last robot, but the mean over all pairs is asked for.":
        "last",
        "One of the two families is represented by its first robot, but the mean over all pairs is "
        "asked for.":
        "first row",
        "The sum over all pairs is divided by the number of robots of one family, but should be "
        "divided by the number of pairs.": "one member",
        "The two families farthest apart are merged, but the two nearest should be merged.":
        "farthest",
        "Of the families nearer than the threshold, the two farthest apart are merged, but the two "
        "nearest should be merged.": "farthest below",
    }  # fmt: skip
    make = partial(joined, table, threshold)
    many = np.size(table, axis=1)
    other = {
        "The distance is compared with the threshold times the number of columns, not with the "
        "threshold.": threshold * many,
        "The distance is compared with the threshold divided by the number of columns, not with "
        "the threshold.": threshold / many,
        "The distance is compared with the threshold times the root of the number of columns, not "
        "with the threshold.": threshold * np.sqrt(many),
        "The distance is compared with the threshold divided by the root of the number of columns, "
        "not with the threshold.": threshold / np.sqrt(many),
        "The square of the distance is compared with the threshold, not the distance.": np.sqrt(
            threshold
        ),
        "The distance is compared with the threshold squared, not with the threshold.": threshold
        ** 2,
        "The distance is compared with twice the threshold, not with the threshold.": 2 * threshold,
        "The distance is compared with half of the threshold, not with the threshold.": threshold
        / 2,
    }
    right = {name: part[""] for name, part in
             {"rows": rows, "apart": apart, "link": link, "rule": rule}.items()}  # fmt: skip
    at_other = {text: joined(table, value, **right) for text, value in other.items()}
    found = slips(make, most=1, rows=rows, apart=apart, link=link, rule=rule) | at_other
    found["All robots are in one family, but they should not be."] = np.zeros(len(table))
    found["Each robot is in a family of its own, but some belong together."] = np.arange(len(table))
    return found


REMEMBERED = {
    "forget": "`forget` should return all zeros, in the shape of `after`.",
    "freeze": "Before step `since` the memory should be `after`; from then on it should stay what "
    "`before` is in step `since` of the same episode.",
}


def wrong_memories(first: np.ndarray, afters: np.ndarray, episode: int) -> dict:
    """Memories that may stand where another one belongs."""
    own, other = -(episode + 1) * afters, -(2 - episode) * afters
    return {
        **(
            {
                "This is the memory at the beginning of the second episode, though the first one "
                "was right, so something (for example a count or a flag) is kept from one episode "
                "to the next.": first,
                **{
                    f"This is the memory after step {k} of the first episode, but nothing should "
                    "be kept from one episode to the next.": each
                    for k, each in enumerate(other)
                },
            }
            if episode
            else {}
        ),
        "This is still the memory at the beginning of the episode.": first,
        "This memory is all zeros, but should not be.": 0 * first,
        **{
            f"This is the memory after step {k} of this episode.": each
            for k, each in enumerate(own)
        },
        "The cells are 0, but the outputs are not, though they belong to the memory, too.": own[0]
        * [[0], [1]],
        **{
            f"The {what} are those after step {k}, and the other row is 0.": each * factors
            for k, each in enumerate(own)
            for what, factors in (("cells", [[1], [0]]), ("outputs", [[0], [1]]))
        },
        **{
            f"The {what} are those after step {k}, but the other row is that after step "
            f"{k + 1}.": np.stack([own[k + (what != "cells")][0], own[k + (what == "cells")][1]])
            for k in range(len(own) - 1)
            for what in ("cells", "outputs")
        },
        "This is a memory of ones (an empty memory is all zeros).": np.ones_like(first),
        "This is one row, but a memory should have two rows, the cells and the outputs.": np.zeros(
            UNITS
        ),
    }


def changed_described(poses: np.ndarray, rewards: np.ndarray, cylinder, name: str) -> dict:
    """What comes of changed poses, rewards or places of the cylinder."""
    near = name in ("pace", "side")
    other = {
        "Each reward is taken for that of the step before it." if near else
        "The search ends one step too early, but should be all steps before the first one with a "
        "reward.":
        (poses, np.append(rewards[1:], 0), cylinder),
        "Each reward is taken for that of the step after it." if near else
        "The search goes one step too far, but the first step with a reward should not be part of "
        "it.":
        (poses, np.append(0, rewards[:-1]), cylinder),
        "x and y of the poses are exchanged.": (poses[:, [1, 0, 2]], rewards, cylinder),
        "x and y of the cylinder are exchanged.": (poses, rewards, cylinder[::-1]),
        "The headings are turned into degrees, but NumPy takes radians.":
        (np.column_stack([poses[:, :2], np.degrees(poses[:, 2])]), rewards, cylinder),
        "The headings are taken for degrees, but they are in radians, which NumPy takes.":
        (np.column_stack([poses[:, :2], np.radians(poses[:, 2])]), rewards, cylinder),
        "The headings have the opposite sign.": (poses * [1, 1, -1], rewards, cylinder),
        "The headings are taken to count from the y axis, but they count from the x axis.":
        (np.add(poses, [0, 0, np.pi / 2]), rewards, cylinder),
        "Steps with a reward are taken for those without, and the other way round.":
        (poses, 1 - rewards, cylinder),
        "The poses stand in the opposite order.": (poses[::-1], rewards, cylinder),
        "Poses and rewards stand in the opposite order.":
        (poses[::-1], rewards[::-1], cylinder),
        "For each heading, that of the step before is taken.":
        (np.column_stack([poses[:, :2], poses[[0, *range(len(rewards))], 2]]), rewards, cylinder),
        "The heading at the start is taken for all poses.":
        (np.column_stack([poses[:, :2], 0 * poses[:, 2] + poses[0, 2]]), rewards, cylinder),
        "The cylinder is taken to be in the middle of the arena.": (poses, rewards, [200, 200]),
        "The cylinder is taken to be at (0, 0).": (poses, rewards, [0, 0]),
        "The places are rounded first, but should keep their fractions.":
        (np.column_stack([poses[:, :2].round(), poses[:, 2]]),
                                          rewards, cylinder),
        "Millimetres are turned into metres, but mm are asked for.":
        (poses * [0.001, 0.001, 1], rewards,
                                                np.multiply(cylinder, 0.001)),
        "Millimetres are turned into centimetres, but mm are asked for.":
        (poses * [0.1, 0.1, 1], rewards,
                                                     np.multiply(cylinder, 0.1)),
    }  # fmt: skip
    if len(rewards) > 1:
        other |= {
            "The first step is left out.": (poses[1:], rewards[1:], cylinder),
            "The last step is left out.": (poses[:-1], rewards[:-1], cylinder),
        }
    return {text: described(*case)[name] for text, case in other.items()}


def wrong_reactions(brain: dict, seen: np.ndarray, memories: np.ndarray) -> dict:
    """What slips make of the actions."""

    def made(seen, memories, hand_on):
        actions, memory = [], memories[0]
        for each in memories:
            action, memory = answer_of(brain, seen, memory if hand_on else each)
            actions.append(action)
        return np.array(actions)

    many = len(memories)
    old = np.tanh(memories[:, 1] @ brain["readout"].T + brain["bias"])
    found = [answer_of(brain, seen, memory) for memory in memories]
    actions = np.array([action for action, _ in found])
    made_memories = np.array([memory for _, memory in found])
    others = {
        "The actions are read from the given outputs, but a step of the network with each memory "
        "is asked for.": old,
        "These are the new memories, but the actions are asked for.": made_memories,
        "These are the new cells, but the actions are asked for.": made_memories[:, 0],
        "These are the new outputs, but the actions are asked for.": made_memories[:, 1],
        "These are the actions of the first wheel alone.": actions[:, 0],
        "These are the actions of the second wheel alone.": actions[:, 1],
        "This is the action to the first memory alone.": actions[0],
        "This is the action to the last memory alone.": actions[-1],
        "This is the mean of the actions, but the action to each memory is asked for.":
        actions.mean(axis=0),
        "All actions are in one row, but each should have a row of its own.": actions.ravel(),
        "There is a row for each wheel, but each action should have a row of its own.": actions.T,
        "The last memory is left out.": actions[:-1],
        "The first memory is left out.": actions[1:],
        "The action to the first memory is subtracted from all.": actions - actions[0],
        "The mean of the actions is subtracted from all.": actions - actions.mean(axis=0),
        "The action to an empty memory is subtracted from all.":
        actions - answer_of(brain, seen, 0 * memories[0])[0],
        "The action is put through tanh once more, but `think` has done this.": np.tanh(actions),
        "The two wheels are exchanged.": actions[:, ::-1],
        "The memories are reshaped to cells and outputs, which mixes those of different memories.":
        np.array([
            answer_of(brain, seen, memory)[0]
            for memory in memories.reshape(2, many, -1).swapaxes(0, 1)
        ]),
        "The actions are added up from memory to memory.": np.cumsum(actions, axis=0),
        "The actions are rounded.": actions.round(),
        "Only the signs of the actions are given.": np.sign(actions),
        "Each action comes after two steps of the network, but one step with each memory is asked "
        "for.": np.array(
            [answer_of(brain, seen, memory)[0] for memory in made_memories]
        ),
    }  # fmt: skip
    return others | slips(
        made,
        seen={"": seen, "The observation is left out, and 0 stands in its place.": 0 * seen},
        memories={
            "": memories,
            "Each action is that to the memory which the network makes, not to the given one.":
            np.array(
                [answer_of(brain, seen, memory)[1] for memory in memories]
            ),
            "The outputs of each memory are replaced by 0.":
            memories * [[1], [0]],
            "The cells of each memory are replaced by 0.":
            memories * [[0], [1]],
            "The two rows of a memory are exchanged.": memories[:, ::-1],
            "All actions are those to the first memory.": np.repeat(memories[:1], many, axis=0),
            "All actions are those to the last memory.": np.repeat(memories[-1:], many, axis=0),
            "All actions are those to the mean of the memories.": np.repeat(
                memories.mean(axis=0)[None], many, axis=0
            ),
            "All memories are replaced by 0.": 0 * memories,
            "The actions stand in the opposite order.": memories[::-1],
        },
        hand_on={"": False, "The new memory is handed on to the next reaction, but each should use "
        "the memory given for it.": True},
    )  # fmt: skip
