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
        "The units are computed one after another, and each one sees the new outputs of those "
        "before it: all see the outputs of the step before.": unit_by_unit(1),
        "The forget gate is used for the candidate and the input gate for the old cells.":
        made(taken * memory[0] + kept * np.tanh(net[3])),
        "The new cells are kept after tanh: tanh belongs to the outputs alone.":
        made(np.tanh(cells), outputs),
        "The new cells are put through tanh, and once more for the outputs.": made(np.tanh(cells)),
        "The input gate is multiplied inside the candidate's tanh, but belongs outside.":
        made(kept * memory[0] + np.tanh(taken * net[3])),
        "The forget gate is multiplied by tanh of the old cells, not by the cells themselves.":
        made(kept * np.tanh(memory[0]) + taken * np.tanh(net[3])),
        "The 1 is added to the new cells, but belongs inside the forget gate's logistic function.":
        made(squash(net[0]) * memory[0] + 1 + taken * np.tanh(net[3])),
        "The 1 is added to the new cells, too.": made(cells + 1),
        "The input gate is applied twice.": made(kept * memory[0] + taken**2 * np.tanh(net[3])),
        "The forget gate is applied twice.": made(kept**2 * memory[0] + taken * np.tanh(net[3])),
        "The output gate is applied twice.": made(cells, shown**2 * np.tanh(cells)),
        "The readout is reshaped, which mixes its weights up: it has a row for each wheel.": (
            np.tanh(readout.reshape(UNITS, 2).T @ outputs + bias), right[1]),
        "The old cells are not added: only the new candidate is there.": made(
            taken * np.tanh(net[3])),
        "Old cells and candidate are averaged, but belong together as a sum.": made(cells / 2),
        "Old cells and candidate are multiplied, but belong together as a sum.":
        made(kept * memory[0] * taken * np.tanh(net[3])),
        "The forget gate is added to the old cells, but is a factor of them.":
        made(kept + memory[0] + taken * np.tanh(net[3])),
        "The input gate is added to the candidate, but is a factor of it.":
        made(kept * memory[0] + taken + np.tanh(net[3])),
        "The output gate is added to tanh(new cells), but is a factor of it.":
        made(cells, shown + np.tanh(cells)),
        "The forget gate is used for the output gate, too.": made(cells, kept * np.tanh(cells)),
        "The input gate is used for the output gate, too.": made(cells, taken * np.tanh(cells)),
        "The output gate is used for the input gate, too.":
        made(kept * memory[0] + shown * np.tanh(net[3])),
        "The output gate is used for the forget gate, too.":
        made(shown * memory[0] + taken * np.tanh(net[3])),
        "1 minus the output gate of the old outputs is added to the new ones: only the new ones "
        "belong there.":
        made(cells, shown * np.tanh(cells) + (1 - shown) * memory[1]),
        "The logistic function stands around the whole output.":
        made(cells, squash(net[2] * np.tanh(cells))),
        "The gates are not put through the logistic function.":
        made((net[0] + 1) * memory[0] + net[1] * np.tanh(net[3]),
             net[2] * np.tanh((net[0] + 1) * memory[0] + net[1] * np.tanh(net[3]))),
        "The forget gate is not put through the logistic function.":
        made((net[0] + 1) * memory[0] + taken * np.tanh(net[3])),
        "The forget gate is 1 minus what it should be, as with a wrong sign in its formula.":
        made(squash(-net[0] - 1) * memory[0] + taken * np.tanh(net[3])),
        "The input gate is 1 minus what it should be, as with a wrong sign in its formula.":
        made(kept * memory[0] + squash(-net[1]) * np.tanh(net[3])),
        "The output gate is 1 minus what it should be, as with a wrong sign in its formula.":
        made(cells, squash(-net[2]) * np.tanh(cells)),
        "The input gate is not put through the logistic function.":
        made(kept * memory[0] + net[1] * np.tanh(net[3])),
        "The output gate is not put through the logistic function.":
        made(cells, net[2] * np.tanh(cells)),
        "The forget gate goes through tanh, but belongs to the logistic function.":
        made(np.tanh(net[0] + 1) * memory[0] + taken * np.tanh(net[3])),
        "The input gate goes through tanh, but belongs to the logistic function.":
        made(kept * memory[0] + np.tanh(net[1]) * np.tanh(net[3])),
        "The output gate goes through tanh, but belongs to the logistic function.":
        made(cells, np.tanh(net[2]) * np.tanh(cells)),
        "The 1 is added before the logistic function to the candidate's tanh.":
        made(kept * memory[0] + taken * (1 + np.tanh(net[3]))),
        "The cells are cut off at -1 and 1.": made(cells.clip(-1, 1)),
        "The old outputs are added to the new cells.": made(cells + memory[1]),
        "The outputs of the step before are put through tanh before the gates see them.": of(
            known=np.append(observation, np.tanh(memory[1]))),
        "The tanh of the cells stands in z instead of the outputs.": of(
            known=np.append(observation, np.tanh(memory[0]))),
        "The observation is put through tanh first.": of(
            known=np.append(np.tanh(observation), memory[1])),
        "The new outputs stay those of the step before.": made(cells, memory[1]),
        "The new cells stay those of the step before.": (
            right[0], np.array([memory[0], outputs])),
        "The new memory is the old one.": (right[0], memory),
        "Both rows of the new memory are the cells.": (right[0], np.array([cells, cells])),
        "Both rows of the new memory are the outputs.": (right[0], np.array([outputs, outputs])),
        "The second row of the new memory is tanh(cells), without the output gate.": (
            right[0], np.array([cells, np.tanh(cells)])),
        "The gates of the observation see it in the opposite order.": noticed(
            np.concatenate([gates[..., 7::-1], gates[..., 8:]], axis=2)),
        "The bias is added once for each unit: it is added once for each wheel.": (
            np.tanh(readout @ outputs + UNITS * bias), right[1]),
        "The bias is a factor, but belongs added.": (np.tanh((readout @ outputs) * bias), right[1]),
        "The bias of the first wheel is used for both.": (
            np.tanh(readout @ outputs + bias[0]), right[1]),
        "The two biases are exchanged.": (np.tanh(readout @ outputs + bias[::-1]), right[1]),
        "The action lies between -1 and 1: it is 0 to 1 here.": (
            (np.tanh(readout @ outputs + bias) + 1) / 2, right[1]),
        "The sum over the units is divided by their number before the bias is added: no division "
        "is asked for.": (
            np.tanh(readout @ outputs / UNITS + bias), right[1]),
        "The action is read from tanh(outputs): the outputs themselves are asked for.": (
            np.tanh(readout @ np.tanh(outputs) + bias), right[1]),
        "The action goes through tanh twice.": (np.tanh(right[0]), right[1]),
        "The action has lost its sign.": (np.abs(right[0]), right[1]),
        "The action has the wrong sign.": (-right[0], right[1]),
    }  # fmt: skip
    return more | {
        "The 1 that is added for the forget gate is left out.": of(ones=(0, 0, 0, 0)),
        "1 is subtracted from the forget gate's net input instead of added.": of(
            ones=(-1, 0, 0, 0)
        ),
        "The 1 is added to all gates, but belongs to the forget gate alone.": of(
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
            "The gates are taken in another order than forget, input, output, candidate: as "
            f"{', '.join(GATES[order.index(k)] for k in range(4))}.": of(order=order)
            for order in permutations(range(4)) if order != (0, 1, 2, 3)
        },
        "The candidate goes through the logistic function instead of tanh.": of(
            candidate=squash
        ),
        "tanh of the candidate is left out.": of(candidate=lambda x: x),
        "The new cells go to the outputs without tanh.": of(shown=lambda x: x),
        "The outputs show the cells of the step before: the new ones are asked for.": of(
            shown=lambda _: np.tanh(memory[0])
        ),
        "The three gates go through tanh, but the logistic function is asked for.":
        of(gate=np.tanh),
        "The input gate is 1 minus the forget gate here, not a gate of its own.": of(
            enter=lambda kept: 1 - kept
        ),
        "The forget gate is not applied: the old cells are kept whole.": of(
            forget=lambda _: 1.0
        ),
        "The old cells are forgotten whole: the forget gate decides how much of them stays.": of(
            forget=lambda _: 0.0
        ),
        "The input gate is not applied to the candidate.": of(enter=lambda _: 1.0),
        "The output gate is not applied.": of(leave=1.0),
        "The network sees its cells (row 0 of the memory) instead of its outputs (row 1).": of(
            known=np.append(observation, memory[0])
        ),
        "The outputs of the step before stand in front of the observation, but belong behind "
        "it.": of(known=np.append(memory[1], observation)),
        "The outputs of the step before are left out: 0 stands in their place.": of(
            known=np.append(observation, np.zeros(UNITS))
        ),
        "The 1 is added to all four, but belongs to the forget gate alone.": of(ones=(1, 1, 1, 1)),
        "The 1 is added to the candidate, but belongs to the forget gate.": of(ones=(0, 0, 0, 1)),
        "The output gate is multiplied inside the tanh of the new cells, but belongs outside.":
        of(outside=False),
        "The new cells go through the logistic function, but tanh is asked for.": of(shown=squash),
        "The forget gate is multiplied by the old outputs, not by the old cells.":
        of(old=memory[1]),
        "The old cells are multiplied by 1 minus the forget gate, not by the gate itself.": of(
            forget=lambda net: 1 - squash(net)
        ),
        "Each gate is 1 minus what it should be, as with a wrong sign in its formula.": of(
            gate=lambda net: squash(-net)
        ),
        "The new candidate is subtracted from the old cells, but belongs added.": of(
            candidate=lambda x: -np.tanh(x)
        ),
        "The forget gate is also a factor of what is added: it belongs to the old cells alone.": of(
            enter=lambda kept: kept * squash(net[1])
        ),
        "The forget gate is used for the input gate, too.": of(enter=lambda kept: kept),
        "The gates see the outputs of the step before alone: the observation is left out.": of(
            known=np.append(0 * observation, memory[1])
        ),
        "The bias of the wheels is added after tanh, but belongs inside it.": (
            np.tanh(readout @ outputs) + bias, right[1]
        ),
        "The bias of the wheels is subtracted.": (np.tanh(readout @ outputs - bias), right[1]),
        "The action is read from tanh(new cells): the output gate is left out.": (
            np.tanh(bias + readout @ np.tanh(cells)), right[1]
        ),
        "The action is read from the cells of the step before.": (
            np.tanh(bias + readout @ memory[0]), right[1]
        ),
        "Cells and outputs are exchanged in the old and the new memory: memory[0] is to hold the "
        "cells.": (
            swapped[0], swapped[1][::-1]
        ),
        "The old cells are taken for the outputs and the old outputs for the cells.": swapped,
        "The old cells keep 1 minus the input gate: the forget gate decides that.": of(
            forget=lambda _: 1 - squash(net[1])
        ),
        "The 1 is added to each number of z: it is added once, to the product.": of(
            ones=np.stack([gates[0].sum(axis=1), *np.zeros((3, UNITS))])
        ),
        "The 1 is added to each number of z, for all gates, but belongs to the forget gate.": of(
            known=z + 1, ones=(0, 0, 0, 0)
        ),
        "The output gate sees tanh of the new cells: all gates see the same z.": of(
            leave=squash(gates[2] @ np.append(observation, np.tanh(cells)))
        ),
        "The two wheels are exchanged.": (right[0][::-1], right[1]),
        "The rows of the new memory are exchanged: the outputs stand before the cells.": (
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
            f"Unit {unit}: old cell {old[unit]:.4g} * forget {squash(forget + 1):.4g} + candidate "
            f"{np.tanh(candidate):.4g} * input {squash(enter):.4g}."
        )
    if name == "outputs":
        return f"Unit {unit}: tanh(new cell {cells[unit]:.4g}) * output {squash(leave):.4g}."
    return f"Wheel {unit}: tanh(row {unit} of readout times the new outputs, plus bias[{unit}])."


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
        "The table of meshgrid is reshaped to rows of three: this mixes x, y and heading.":
        np.array(table).reshape(-1, 3)[:, column],
    } | slips(
        made,
        order={"": (0, 1, 2)} | ({
            f"{names[a]} changes slowest here, then {names[b]}, and {names[c]} fastest.": (a, b, c)
            for a, b, c in permutations(range(3)) if (a, b, c) != (0, 1, 2)
        } if headings > 1 else {
            "y changes faster than x here, or both change together.": (1, 0, 2)
        }),
        rows={
            "": [0, 1, 2],
            "x and y are exchanged: a row holds x, y, heading.": [1, 0, 2],
            "The heading stands first in a row: it holds x, y, heading.": [2, 0, 1],
        },
        spread={
            "": np.linspace,
            "The upper ends of x and y are missing.": partial(np.linspace, endpoint=False),
            "x and y are the middles of equal parts: both ends belong to the grid.":
            lambda a, b, n: a + (b - a) * (np.arange(n) + 0.5) / n,
            "x and y are cut to whole numbers.": lambda a, b, n: np.linspace(a, b, n).astype(int),
            ("x has the range of y.", "y has the range of x.", "")[column]: lambda a, b, n:
            np.linspace(*((150, 250) if a == 270 else (270, 350)), n),
            f"{xy} falls from its upper end to its lower one, but is to rise.":
            lambda a, b, n: np.linspace(b, a, n),
            f"{xy} is left at its lower end.": lambda a, b, n: np.full(n, float(a)),
            f"{xy} is left at its upper end.": lambda a, b, n: np.full(n, float(b)),
            f"The lower end of {xy} is missing.": lambda a, b, n: np.linspace(a, b, n + 1)[1:],
            f"Both ends of {xy} are missing.": lambda a, b, n: np.linspace(a, b, n + 2)[1:-1],
            f"{xy} is counted from 0, not from its lower end.":
            lambda a, b, n: np.linspace(0, b - a, n),
            f"{xy} begins at 0, not at its lower end.":
            lambda a, b, n: np.linspace(0, b, n),
            f"The steps of {xy} are as long as its range divided by `places` + 1.":
            lambda a, b, n: a + np.arange(n) * (b - a) / (n + 1),
            f"The steps of {xy} are whole millimetres: {xy} holds fractions.":
            lambda a, b, n: a + np.arange(n) * ((b - a) // max(n - 1, 1)),
            f"The steps of {xy} are rounded: {xy} holds fractions.":
            lambda a, b, n: np.linspace(a, b, n).round(),
            f"{xy} has the steps of the other one of x and y.": lambda a, b, n:
            a + np.linspace(0, 100 if a == 270 else 80, n),
        },
        angles={
            "": 2 * np.pi * turn,
            "The headings 0 and 2 pi are the same: leave out 2 pi.":
            np.linspace(0, 2 * np.pi, headings),
            "The headings are in degrees.": 360 * turn,
            "The headings divide half a turn, not the whole one.": np.pi * turn,
            "The fraction of the step between headings is cut off, as `//` does.":
            np.arange(headings) * (2 * np.pi // headings),
            "The headings begin at minus pi, not at 0.": 2 * np.pi * turn - np.pi,
            "The headings turn clockwise.": -2 * np.pi * turn,
            "The headings are counted in whole turns.": turn,
            "The headings divide the turn into one part too many.":
            2 * np.pi * np.arange(headings) / (headings + 1),
            "The headings begin half a part after 0, but 0 belongs to them.":
            2 * np.pi * (turn + 0.5 / headings),
            "The headings fall from 2 pi, but are to begin at 0 and grow.": 2 * np.pi * (1 - turn),
            "The headings stand in the opposite order.": 2 * np.pi * turn[::-1],
            "The headings lie between -pi and pi here, but are to grow from 0.":
            np.angle(np.exp(2j * np.pi * turn)),
            "The headings divide a quarter of a turn, not the whole one.": np.pi / 2 * turn,
            "The headings divide two turns.": 4 * np.pi * turn,
            "The headings reach half a turn, which is included.": np.linspace(0, np.pi, headings),
            "The headings begin at minus pi and end at pi: they begin at 0, without 2 pi.":
            np.linspace(-np.pi, np.pi, headings),
            "All headings are 0.": 0 * turn,
            "The headings are counted, not measured: they are angles.": 1.0 * np.arange(headings),
            "The step between headings is a right angle, however many there are.":
            np.pi / 2 * np.arange(headings),
            "The step between headings is 2 pi divided by `places`, not by `headings`.":
            2 * np.pi * np.arange(headings) / places,
            "The headings are rounded.": (2 * np.pi * turn).round(),
            "The headings begin one part after 0 and end with 2 pi: 0 belongs to them, 2 pi does "
            "not.":
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


NO_REWARD = "Without any reward all steps belong to the search, and none is near."


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
            "The first step with a reward is part of the search here.": search + 1,
            "The last step of the search is left out.": search - 1,
            "All steps without a reward count here, but the search ends at the first reward.":
            np.sum(~near),
            "All steps count here, not those of the search.": many,
            "These are the steps near the cylinder, not those of the search.": np.sum(near),
            "Without any reward, the search has as many steps as the episode, not 500.":
            search if near.any() else 500,
            "Without any reward, the search has as many steps as the episode, not one more.":
            search if near.any() else many + 1,
            "Without any reward, the search has as many steps as the episode, not one less.":
            search if near.any() else many - 1,
            "The search is divided by 10 here: it is counted in steps, not in seconds.":
            search / 10,
            "This is the longest run of steps without a reward: the search ends at the first "
            "reward.":
            max(map(len, "".join(".x"[int(each)] for each in near).split("x"))),
            "These are the steps from the first reward on.": many - search,
            "The search ends at the last step with a reward, not at the first one.": last,
            "The share of the search is given, not its number of steps.": search / many,
            "Without any reward the search is -1 here, but has all steps of the episode.":
            search if near.any() else -1,
            "A reward in the first step is overlooked.":
            int(near[1:].argmax()) + 1 if near[1:].any() else many,
            "The first step is left out before the first reward is sought.":
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
            "This is how far the robot moves, be it forwards or backwards.": length,
            "The speed has lost its sign.": np.abs(forward(theta)),
            "The speed has the wrong sign.": -forward(theta),
            "Sine and cosine are exchanged.": dx * np.sin(theta) + dy * np.cos(theta),
            "The part in y is subtracted from that in x, but belongs added.":
            dx * np.cos(theta) - dy * np.sin(theta),
            "This is how far the robot moves sideways.": dy * np.cos(theta) - dx * np.sin(theta),
            "The heading is left out: speed is along it.": dx + dy,
            "The heading of each step is asked for, not that at the start.":
            dx * np.cos(theta[0]) + dy * np.sin(theta[0]),
            "The speed is multiplied by 10 here: it is asked for per step, not per second.":
            10 * forward(theta),
            "The speed is divided by 10 here: it is asked for per step.": forward(theta) / 10,
            "The way is divided by its own length: this is the cosine of its direction.":
            forward(theta) / np.where(length > 0, length, 1),
            "The heading is taken for degrees: np.cos takes radians.":
            forward(np.radians(theta)),
            "The heading is turned into degrees: np.cos takes radians.":
            forward(np.degrees(theta)),
            "Only the x part is there: the y part is to be added.": dx * np.cos(theta),
            "Only the y part is there: the x part is to be added.": dy * np.sin(theta),
            "The places are multiplied, not the ways between them.":
            after[:, 0] * np.cos(theta) + after[:, 1] * np.sin(theta),
            "The places are multiplied, not the ways between them: this is the beginning.":
            before[:, 0] * np.cos(theta) + before[:, 1] * np.sin(theta),
            "The way has the sign of the speed, but its own length: only the part along the "
            "heading counts.": np.sign(forward(theta)) * length,
            "The squares are added and the root is taken: this is not the way along the heading.":
            np.hypot(dx * np.cos(theta), dy * np.sin(theta)),
            "Ways backwards count as 0: they are negative.": np.maximum(forward(theta), 0),
            "The way is that of the next step.": np.append(forward(theta)[1:], 0),
            "The direction of the way is compared with the x axis, not with the heading.":
            np.arctan2(dy, dx),
        },
        "turning": {
            "": turned,
            "The heading leaps by a whole turn: take the short way around.": change,
            "The turning has lost its sign.": np.abs(turned),
            "The turning has the wrong sign: to the left is positive.": -turned,
            "A turn to the right becomes a long one to the left.": change % (2 * np.pi),
            "The turning is in degrees.": np.degrees(turned),
            "Only one direction is taken the short way around: a turn may leap by 2 pi or -2 pi.":
            np.where(change < -np.pi, change + 2 * np.pi, change),
            "Only one direction is taken the short way around: it may leap by -2 pi or 2 pi.":
            np.where(change > np.pi, change - 2 * np.pi, change),
            "This is the amount of the short way around, without its sign.":
            np.minimum(np.abs(change), 2 * np.pi - np.abs(change)),
            "The turning is the heading itself: take its change.": later,
            "The turning is the heading at the beginning of the step: take its change.": theta,
            "Half a turn is not taken off again: the short way is from -pi to pi.":
            (change + np.pi) % (2 * np.pi),
            "The turning lies between -2 pi and 0: a turn to the left becomes a long one to the "
            "right.": -(-change % (2 * np.pi)),
            "The turning is cut off at -pi and pi: a leap is a whole turn too much.":
            change.clip(-np.pi, np.pi),
            "A leap counts as 0: take the short way around.":
            np.where(np.abs(change) > np.pi, 0, change),
            "The remainder by pi is taken here, but a whole turn is 2 pi.": change % np.pi,
            "The turning is the sine of the change.": np.sin(change),
            "The turning is multiplied by 10 here: it is asked for per step, not per second.":
            10 * turned,
            "The direction in which the robot moves is taken for its heading.":
            np.angle(np.exp(1j * (np.arctan2(dy, dx) - theta))),
            "np.fmod keeps the sign of what is divided, so that turns below -pi do not take the "
            "short way: % does it.":
            np.fmod(change + np.pi, 2 * np.pi) - np.pi,
            "Changes beyond pi and -pi are made smaller by pi here, but a whole turn is 2 pi.":
            change - np.pi * np.sign(change) * (np.abs(change) > np.pi),
            "The long way around is taken.": turned - np.sign(turned) * 2 * np.pi,
            "The changes lie between -pi / 2 and pi / 2 here, but the short way around is between "
            "-pi and pi.":
            (change + np.pi / 2) % np.pi - np.pi / 2,
        },
        "wall": {
            "": nearest < 72.5,
            "A robot exactly 72.5 mm from a wall counts as near: it has to be nearer than 72.5 mm.":
            nearest <= 72.5,
            **{f"Walls count within {limit} mm of the centre: it is 72.5 mm.": nearest < limit
               for limit in (25, 30, 40, 50, 55, 60, 65, 70, 75, 80, 90, 99.5, 120, 145, 150)},
            "The end of the step is looked at, not its beginning.":
            np.minimum(after[:, :2], 400 - after[:, :2]).min(axis=1) < 72.5,
            "Only the left and the lower wall are looked at.": walls[:2].min(axis=0) < 72.5,
            "Only the right and the upper wall are looked at.": walls[2:].min(axis=0) < 72.5,
            "Only the left and the right wall are looked at.": walls[::2].min(axis=0) < 72.5,
            "Only the lower and the upper wall are looked at.": walls[1::2].min(axis=0) < 72.5,
            "Two walls have to be near here: one is enough.":
            np.minimum(*walls.reshape(2, 2, -1)).max(axis=0) < 72.5,
            "These are the steps far from all walls.": nearest >= 72.5,
            "This is the distance to the nearest wall: how often is it below 72.5?": nearest,
            "The robot's radius is subtracted, but 72.5 mm count from its centre.":
            nearest - 27.5 < 72.5,
            "Walls count within 45 mm of the centre: it is 72.5 mm.": nearest < 45,
            "Walls count within 100 mm of the centre: it is 72.5 mm.": nearest < 100,
            "Walls count within 27.5 mm of the centre: it is 72.5 mm.": nearest < 27.5,
            "The distance to the nearest corner counts here: it is that to a wall.":
            np.hypot(*np.minimum(before[:, :2], 400 - before[:, :2]).T) < 72.5,
            "The distance to the cylinder counts here: it is that to a wall.":
            np.hypot(from_x, from_y) < 72.5,
            "The distance to (0, 0) counts here: it is that to a wall.":
            np.hypot(*before[:, :2].T) < 72.5,
            "The distance to the arena's middle counts here: it is that to a wall.":
            np.hypot(*(before[:, :2] - 200).T) > 127.5,
            "Only the left wall is looked at.": walls[0] < 72.5,
            "Only the lower wall is looked at.": walls[1] < 72.5,
            "Only the right wall is looked at.": walls[2] < 72.5,
            "Only the upper wall is looked at.": walls[3] < 72.5,
            "Steps near a wall count once for each wall that is near.":
            np.sum(walls < 72.5, axis=0),
            "The upper wall is left out.": walls[:3].min(axis=0) < 72.5,
            "The right wall is left out.": walls[[0, 1, 3]].min(axis=0) < 72.5,
            "The lower wall is left out.": walls[[0, 2, 3]].min(axis=0) < 72.5,
            "The left wall is left out.": walls[1:].min(axis=0) < 72.5,
            "A step counts if it begins or ends near a wall: its beginning decides.":
            np.minimum(nearest, np.minimum(after[:, :2], 400 - after[:, :2]).min(axis=1)) < 72.5,
            "The arena is 400 mm wide: the far walls are elsewhere here.":
            np.minimum(before[:, :2].min(axis=1), 500 - before[:, :2].max(axis=1)) < 72.5,
            "The share is given in per cent.": 100 * (nearest < 72.5),
            "In Python `&` binds more tightly than `|`: x and y are mixed up here.":
            (walls[0] < 72.5) | ((walls[2] < 72.5) & (walls[1] < 72.5)) | (walls[3] < 72.5),
            "Both x and y have to be near a wall: one of them is enough.":
            ((walls[0] < 72.5) | (walls[2] < 72.5)) & ((walls[1] < 72.5) | (walls[3] < 72.5)),
        },
        "pace": {
            "": length,
            "The pace counts only what leads forwards.": forward(theta),
            "The pace is the amount of what leads forwards.": np.abs(forward(theta)),
            "The square root is left out.": length**2,
            "The pace is the sum of the two ways, not the straight one.": np.abs(dx) + np.abs(dy),
            "The pace is that of the step before.": np.append(0, length[:-1]),
            "The pace is that of the step after.": np.append(length[1:], 0),
            "The change of the heading is counted in the pace.": np.sqrt(length**2 + change**2),
            "The pace is multiplied by 10 here: it is asked for per step, not per second.":
            10 * length,
            "The pace is the way to the cylinder.": np.hypot(to_x, to_y),
            "The pace is the change of the distance to the cylinder.":
            np.hypot(from_x, from_y) - np.hypot(to_x, to_y),
            "The pace is the amount of the change of the distance to the cylinder.":
            np.abs(np.hypot(from_x, from_y) - np.hypot(to_x, to_y)),
            "Only the way in x is counted.": np.abs(dx),
            "Only the way in y is counted.": np.abs(dy),
            "The pace is the larger one of the two ways.": np.maximum(np.abs(dx), np.abs(dy)),
            "The pace is the turning, not the way.": np.abs(turned),
            "The place itself is measured: take the way from pose to pose.":
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
            "The heading is not subtracted.": np.sin(bearing),
            "The heading is added, not subtracted.": np.sin(bearing + later),
            "The sine is not taken.": bearing - later,
            "The direction is computed as arctan2(dx, dy), but arctan2(dy, dx) is asked for.":
            np.sin(np.arctan2(to_x, to_y) - later),
            "This is the sine times the distance to the cylinder.":
            np.sin(bearing - later) * np.hypot(to_x, to_y),
            "Only the sign of the side is taken.": np.sign(np.sin(bearing - later)),
            "The direction leads from the arena's middle to the cylinder, not from the robot.":
            np.sin(np.arctan2(cylinder[1] - 200, cylinder[0] - 200) - later),
            "The direction is that of the cylinder's coordinates: it leads from the robot to it.":
            np.sin(np.arctan2(cylinder[1], cylinder[0]) - later),
            "The direction leads from the start to the cylinder: take the robot's place.":
            np.sin(np.arctan2(*(np.asarray(cylinder) - poses[0, :2])[::-1]) - later),
            "The heading at the start is subtracted: take that after each step.":
            np.sin(bearing - poses[0, 2]),
            "The angle is turned into degrees: np.sin takes radians.":
            np.sin(np.degrees(bearing - later)),
            "The angle is taken for degrees: np.sin takes radians.":
            np.sin(np.radians(bearing - later)),
            "np.arctan(dy / dx) does not tell a cylinder ahead from one behind: use np.arctan2.":
            np.sin(np.arctan(to_y / np.where(to_x == 0, 1e-9, to_x)) - later),
            "The side has lost its sign: -1 means that the cylinder is to the right.":
            np.abs(np.sin(bearing - later)),
            "This is the tangent, not the sine.": np.tan(bearing - later),
            "This is the angle itself, the short way around: its sine is asked for.":
            np.angle(np.exp(1j * (bearing - later))),
            "The direction in which the robot moves is taken for its heading.":
            np.sin(bearing - np.arctan2(dy, dx)),
            "The sine of each is subtracted: take the sine of the difference.":
            np.sin(bearing) - np.sin(later),
            "x and y of the cylinder are exchanged.":
            np.sin(np.arctan2(cylinder[0] - after[:, 1], cylinder[1] - after[:, 0]) - later),
        },
    }  # fmt: skip
    of_search = {
        "": steps < search,
        "All steps without a reward count here, but the search ends at the first reward.": ~near,
        "All steps count here, not those of the search.": steps >= 0,
        "The first step with a reward is part of the search here.": steps <= search,
        "The last step of the search is left out.": steps < search - 1,
        "The first step is left out.": (steps > 0) & (steps < search),
        "These are the steps near the cylinder, not those of the search.": near,
        NO_REWARD: steps < np.argmax(near),
    }
    of_near = {
        "": near,
        "All steps after the search count here, but those without a reward are not near.": steps
        >= search,
        "All steps count here, not those with a reward.": steps >= 0,
        "These are the steps of the search, not those near the cylinder.": steps < search,
        "These are the steps without a reward.": ~near,
        "Only the first step near the cylinder counts.": steps == search,
        "The first step near the cylinder is left out.": near & (steps > search),
        "The steps are one too early.": np.append(near[1:], False),
        "The steps are one too late.": np.append(False, near[:-1]),
        "Steps count from the first reward to the last: only those with a reward do.": (
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
            "These are the ways from one place with a reward to the next such place: take "
            "each step from its own beginning to its end.": hops.mean(),
            "These are the ways from the beginning of one step with a reward to the beginning of "
            "the next such step: take each step from its own beginning to its end.": starts.mean(),
            "The ways are added up with their directions, so they cancel out: take each length.":
            np.hypot(dx[near].sum(), dy[near].sum()) / many_near,
            "The root is taken of the mean of the squares: take the mean of the lengths.":
            np.sqrt(np.sum(length[near] ** 2) / many_near),
            "This is the straight way from the first place near the cylinder to the last one.":
            np.hypot(*(spots[-1] - spots[0])) / many_near if len(spots) else 0.0,
        }  # fmt: skip
    elif name == "speed":
        gone = np.hypot(*(poses[search, :2] - poses[0, :2]))
        part = steps < search
        ahead = np.array([np.cos(theta[part]).mean(), np.sin(theta[part]).mean()]) if search else 0
        extra = {
            "This is the straight way of the whole search, divided by its steps: take each "
            "step.": gone / max(search, 1),
            "Mean ways and mean headings are multiplied: multiply in each step first.":
            float(np.sum(ahead * np.array([dx[part].mean(), dy[part].mean()]))) if search else 0.0,
        }  # fmt: skip
    elif name == "side":
        away = np.linalg.norm(np.stack([to_x, to_y]))
        cross = np.sin(bearing - later) * np.hypot(to_x, to_y) / away
        extra = {"All steps are divided by one length: each has a distance of its own (axis=1).":
                 cross[near].mean() if near.any() else 0.0,
                 "Directions and headings are averaged first: take the sine in each step.":
                 np.sin(np.arctan2(to_y[near].mean(), to_x[near].mean()) - later[near].mean())
                 if near.any() else 0.0}  # fmt: skip
    elif name == "turning":
        gone = poses[search, 2] - poses[0, 2]
        extra = {
            "The short way around is taken once, from the first heading to the last: take it in "
            "each step.": ((gone + np.pi) % (2 * np.pi) - np.pi) / max(search, 1),
            "The mean is taken first and the short way around then: take it in each step.":
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
            "The values are added up: the mean is asked for.": np.sum,
            "This is the median, not the mean.": np.median,
            "This is the mean of the amounts.": lambda v: np.abs(v).mean(),
            "The sum is divided by all steps of the episode.": lambda v: v.sum() / many,
            "This is the last value, not the mean.": lambda v: v[-1],
            "The sum is divided by one too few.": lambda v: v.sum() / max(len(v) - 1, 1),
            "The sum is divided by one too many.": lambda v: v.sum() / (len(v) + 1),
            "This is the first value, not the mean.": lambda v: v[0],
            "This is the largest value, not the mean.": np.max,
            "This is the smallest value, not the mean.": np.min,
            "This is the standard deviation, not the mean.": np.std,
            "This is the largest minus the smallest value, not the mean.": np.ptp,
        },
    )  # fmt: skip


MEANT = {
    "search": "The search is all steps before the first one with a reward.",
    "speed": "Mean over the search of dx cos(heading) + dy sin(heading), with the heading before.",
    "turning": "Mean over the search of the change of the heading, the short way around.",
    "wall": "Share of the steps of the search that begin nearer than 72.5 mm to one of four walls.",
    "pace": "Mean over all steps with a reward of the straight way from pose to pose.",
    "side": "Mean over all steps with a reward of the sine of the direction of the cylinder minus "
    "the heading, both after the step.",
}


def scaled(answer, table: np.ndarray, row: int, column: int) -> str:
    """What is right and wrong about a column of a standardised table."""
    got, values = np.asarray(answer, dtype=float)[:, column], table[:, column]
    steps, own = np.diff(got), np.diff(values)
    said = f"Column {column} has the mean {values.mean():.6g} and the deviation {values.std():.6g}."
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
        "Each row is brought to one scale: each column is asked for (axis=0).": (1, 0),
        "The whole table is brought to one scale: each column is asked for (axis=0).": (None, 0),
        "The standard deviation has ddof=1: ddof=0 is asked for.": (0, 1),
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
            "The variance is taken for the standard deviation.": table.var(axis=0),
            "The differences are divided by the range, not by the standard deviation.":
            np.ptp(table, axis=0),
            "The differences are divided by the largest one.":
            np.abs(table - table.mean(axis=0)).max(axis=0),
            "The differences are divided by the length of the column: divide by its deviation.":
            np.linalg.norm(table - table.mean(axis=0), axis=0),
            "The differences are divided by the mean, not by the standard deviation.":
            table.mean(axis=0),
            "The differences are divided by the root of the standard deviation.":
            np.sqrt(table.std(axis=0)),
            "The differences are divided by the mean amount of the differences.":
            np.abs(table - table.mean(axis=0)).mean(axis=0),
            "The differences are divided by the sum of the column.": table.sum(axis=0),
            "The differences are divided by the largest value of the column.": table.max(axis=0),
            "The standard deviation is that of the amounts.": np.abs(table).std(axis=0),
            "The differences are divided by the root of the mean square of the column, not of the "
            "differences.": np.sqrt((table**2).mean(axis=0)),
        },
    ) | {
        "The mean alone is divided, not the difference: brackets are missing.":
        table - table.mean(axis=0) / table.std(axis=0),
        "The mean is subtracted after the division: subtract it first.":
        table / table.std(axis=0) - table.mean(axis=0),
        "The differences are multiplied by the standard deviation: divide by it.":
        (table - table.mean(axis=0)) * table.std(axis=0),
        "The values are added to the mean: subtract it.":
        (table + table.mean(axis=0)) / table.std(axis=0),
        "The differences have lost their signs.":
        np.abs(table - table.mean(axis=0)) / table.std(axis=0),
        "The differences are turned around: subtract the mean from the value.":
        (table.mean(axis=0) - table) / table.std(axis=0),
        "The places in the order of the column are given, not the values.":
        table.argsort(axis=0).argsort(axis=0),
        "The standard deviation is that of the last column, for all.":
        (table - table.mean(axis=0)) / table[:, -1].std(),
        "The standard deviation is that of the first column, for all.":
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
        "The descriptors are not brought to one scale first.": lambda t: t + 0.0,
        "The descriptors are brought to one scale with ddof=1.":
        lambda t: (t - t.mean(axis=0)) / t.std(axis=0, ddof=1),
        "The scale is that of each robot, not that of each column.":
        lambda t: (t - t.mean(axis=1, keepdims=True)) / t.std(axis=1, keepdims=True),
        "The scale is that of the whole table, not that of each column.":
        lambda t: (t - t.mean()) / t.std(),
    }  # fmt: skip
    apart = {
        "": lambda d: np.sqrt((d**2).sum(axis=2)),
        "The square root of the distance is left out.": lambda d: (d**2).sum(axis=2),
        "The distance is the sum of the differences, not the straight line.":
        lambda d: np.abs(d).sum(axis=2),
        "The distance is the largest difference, not the straight line.":
        lambda d: np.abs(d).max(axis=2),
        "The distance is the root of the mean of the squares, not of their sum.":
        lambda d: np.sqrt((d**2).mean(axis=2)),
    }  # fmt: skip
    link = {
        "": lambda a, b, m, n: (m * a + n * b) / (m + n),
        "Families are as near as their nearest robots: take the mean over all pairs.":
        lambda a, b, m, n: np.minimum(a, b),
        "Families are as far apart as their most different robots: take the mean over all pairs.":
        lambda a, b, m, n: np.maximum(a, b),
        "When two families merge, their distances are averaged whatever their sizes: the mean "
        "over all pairs of robots is asked for.":
        lambda a, b, m, n: (a + b) / 2,
        "A family is represented by its first robot, but the mean over all pairs is asked for.":
        lambda a, b, m, n: a,
        "The distances of the pairs are added up: take their mean.": lambda a, b, m, n: a + b,
    }  # fmt: skip
    rule = {
        "": "nearest",
        "Families exactly as far apart as the threshold are merged.": "equal",
        "The first pair nearer than the threshold is merged, not the two nearest families.":
        "first",
        "The first pair below the threshold is merged, not the two nearest families.": "lowest",
        "Each robot joins the first robot that is near, but families are to be merged, the "
        "nearest first.":
        "leader",
        "The distance of two families is that of their means: take the mean distance of robots.":
        "centre",
        "Only one merger is made: merge again and again.": "once",
        "The pairs inside a family are counted, too: take the mean over a robot of the one and a "
        "robot of the other.": "union",
        "The median over the pairs is taken, not the mean.": "median",
        "The nearest and the farthest pair are averaged: take the mean over all pairs.":
        "sum of nearest",
        "The distances are squared before the mean is taken.": "root",
        "A family is represented by its last robot: take the mean over all pairs.": "last",
        "One of the two families is represented by its first robot: take the mean over all pairs.":
        "first row",
        "The sum over all pairs is divided by the robots of one family: divide by the number of "
        "pairs.": "one member",
        "The two families farthest apart are merged, not the two nearest.": "farthest",
        "Of the families nearer than the threshold, the two farthest apart are merged, not the two "
        "nearest.": "farthest below",
    }  # fmt: skip
    make = partial(joined, table, threshold)
    many = np.size(table, axis=1)
    other = {
        "The threshold is multiplied by the number of columns.": threshold * many,
        "The threshold is divided by the number of columns.": threshold / many,
        "The threshold is multiplied by the root of the number of columns.": threshold
        * np.sqrt(many),
        "The threshold is divided by the root of the number of columns.": threshold / np.sqrt(many),
        "The square of the distance is compared with the threshold.": np.sqrt(threshold),
        "The distance is compared with the square of the threshold.": threshold**2,
        "Twice the threshold is used.": 2 * threshold,
        "Half of the threshold is used.": threshold / 2,
    }
    right = {name: part[""] for name, part in
             {"rows": rows, "apart": apart, "link": link, "rule": rule}.items()}  # fmt: skip
    at_other = {text: joined(table, value, **right) for text, value in other.items()}
    found = slips(make, most=1, rows=rows, apart=apart, link=link, rule=rule) | at_other
    found["All robots are in one family here."] = np.zeros(len(table))
    found["Each robot is in a family of its own here."] = np.arange(len(table))
    return found


REMEMBERED = {
    "forget": "All zeros are asked for.",
    "freeze": "Before step `since` the memory is `after`; from then on it stays what `before` is "
    "in step `since`.",
}


def wrong_memories(first: np.ndarray, afters: np.ndarray, episode: int) -> dict:
    """Memories that may stand where another one belongs."""
    own, other = -(episode + 1) * afters, -(2 - episode) * afters
    return {
        **(
            {
                "This is the memory at the beginning of the second episode, though the first one "
                "was "
                "right: something goes on from one episode to the next, for example a count or a "
                "flag.": first,
                **{
                    f"This is the memory after step {k} of the first episode: it is kept from one "
                    "episode to the next.": each
                    for k, each in enumerate(other)
                },
            }
            if episode
            else {}
        ),
        "This is the memory at the beginning of the episode, or always the one before.": first,
        "This memory is empty.": 0 * first,
        **{f"This is the memory after step {k}.": each for k, each in enumerate(own)},
        "Only the cells are empty, but the outputs are memory, too.": own[0] * [[0], [1]],
        **{
            f"The {what} are those of step {k}, the others are empty.": each * factors
            for k, each in enumerate(own)
            for what, factors in (("cells", [[1], [0]]), ("outputs", [[0], [1]]))
        },
        **{
            f"The {what} are those of step {k}, the others those of step {k + 1}: the whole memory "
            "is frozen.": np.stack([own[k + (what != "cells")][0], own[k + (what == "cells")][1]])
            for k in range(len(own) - 1)
            for what in ("cells", "outputs")
        },
        "This is a memory of ones: an empty memory is 0.": np.ones_like(first),
        "A memory has two rows, the cells and the outputs: this is one row.": np.zeros(UNITS),
    }


def changed_described(poses: np.ndarray, rewards: np.ndarray, cylinder, name: str) -> dict:
    """What comes of changed poses, rewards or places of the cylinder."""
    near = name in ("pace", "side")
    other = {
        "The rewards are one step too early." if near else
        "The search ends one step too early: it is all steps before the first one with a reward.":
        (poses, np.append(rewards[1:], 0), cylinder),
        "The rewards are one step too late." if near else
        "The search goes one step too far: the first step with a reward is not part of it.":
        (poses, np.append(0, rewards[:-1]), cylinder),
        "x and y of the poses are exchanged.": (poses[:, [1, 0, 2]], rewards, cylinder),
        "x and y of the cylinder are exchanged.": (poses, rewards, cylinder[::-1]),
        "The headings are turned into degrees: NumPy takes radians.":
        (np.column_stack([poses[:, :2], np.degrees(poses[:, 2])]), rewards, cylinder),
        "The headings are taken for degrees.":
        (np.column_stack([poses[:, :2], np.radians(poses[:, 2])]), rewards, cylinder),
        "The headings have the opposite sign.": (poses * [1, 1, -1], rewards, cylinder),
        "The headings count from the y axis, not from the x axis.":
        (np.add(poses, [0, 0, np.pi / 2]), rewards, cylinder),
        "Steps with a reward are taken for those without, and the reverse.":
        (poses, 1 - rewards, cylinder),
        "The poses stand in the opposite order.": (poses[::-1], rewards, cylinder),
        "Poses and rewards stand in the opposite order.":
        (poses[::-1], rewards[::-1], cylinder),
        "The heading of each step is that of the step before.":
        (np.column_stack([poses[:, :2], poses[[0, *range(len(rewards))], 2]]), rewards, cylinder),
        "The heading at the start is taken for all steps.":
        (np.column_stack([poses[:, :2], 0 * poses[:, 2] + poses[0, 2]]), rewards, cylinder),
        "The cylinder is taken to be in the middle of the arena.": (poses, rewards, [200, 200]),
        "The cylinder is taken to be at (0, 0).": (poses, rewards, [0, 0]),
        "The places are rounded first.": (np.column_stack([poses[:, :2].round(), poses[:, 2]]),
                                          rewards, cylinder),
        "Millimetres are turned into metres.": (poses * [0.001, 0.001, 1], rewards,
                                                np.multiply(cylinder, 0.001)),
        "Millimetres are turned into centimetres.": (poses * [0.1, 0.1, 1], rewards,
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
        "The actions are read from the given outputs: `think` is not called.": old,
        "These are the new memories: the actions are asked for.": made_memories,
        "These are the new cells: the actions are asked for.": made_memories[:, 0],
        "These are the new outputs: the actions are asked for.": made_memories[:, 1],
        "This is the action of the first wheel alone.": actions[:, 0],
        "This is the action of the second wheel alone.": actions[:, 1],
        "This is the action to the first memory alone.": actions[0],
        "This is the action to the last memory alone.": actions[-1],
        "This is the mean of the actions: the action to each memory is asked for.":
        actions.mean(axis=0),
        "All actions are in one row: each has a row of its own.": actions.ravel(),
        "A row for each wheel is given: each action has a row of its own.": actions.T,
        "The last memory is left out.": actions[:-1],
        "The first memory is left out.": actions[1:],
        "The action to the first memory is subtracted from all.": actions - actions[0],
        "The mean of the actions is subtracted from all.": actions - actions.mean(axis=0),
        "The action to an empty memory is subtracted from all.":
        actions - answer_of(brain, seen, 0 * memories[0])[0],
        "The action is put through tanh once more: `think` has done this.": np.tanh(actions),
        "The two wheels are exchanged.": actions[:, ::-1],
        "The memories are reshaped to cells and outputs: this mixes those of different memories.":
        np.array([
            answer_of(brain, seen, memory)[0]
            for memory in memories.reshape(2, many, -1).swapaxes(0, 1)
        ]),
        "The actions are added up from memory to memory.": np.cumsum(actions, axis=0),
        "The actions are rounded.": actions.round(),
        "Only the signs of the actions are given.": np.sign(actions),
        "Each action is a step of the network twice: call `think` once for each memory.": np.array(
            [answer_of(brain, seen, memory)[0] for memory in made_memories]
        ),
    }  # fmt: skip
    return others | slips(
        made,
        seen={"": seen, "The observation is left out: 0 stands in its place.": 0 * seen},
        memories={
            "": memories,
            "Each action has the memory that the network makes, not the one given.": np.array(
                [answer_of(brain, seen, memory)[1] for memory in memories]
            ),
            "The outputs of the memory are left out: only its cells are used.":
            memories * [[1], [0]],
            "The cells of the memory are left out: only its outputs are used.":
            memories * [[0], [1]],
            "The two rows of a memory are exchanged.": memories[:, ::-1],
            "All actions have the first memory.": np.repeat(memories[:1], many, axis=0),
            "All actions have the last memory.": np.repeat(memories[-1:], many, axis=0),
            "All actions have the mean of the memories.": np.repeat(
                memories.mean(axis=0)[None], many, axis=0
            ),
            "The memories are left out: all are 0.": 0 * memories,
            "The actions stand in the opposite order.": memories[::-1],
        },
        hand_on={"": False, "The new memory is handed on: each has its own.": True},
    )  # fmt: skip
