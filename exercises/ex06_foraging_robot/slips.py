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
    return {
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
        "The candidate goes through tanh, not through the logistic function.": of(
            candidate=squash
        ),
        "tanh of the candidate is left out.": of(candidate=lambda x: x),
        "The new cells go through tanh before the output gate.": of(shown=lambda x: x),
        "The outputs show the cells of the step before: the new ones are asked for.": of(
            shown=lambda _: np.tanh(memory[0])
        ),
        "The gates use the logistic function, not tanh.": of(gate=np.tanh),
        "The input gate is a gate of its own, not 1 minus the forget gate.": of(
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
        "The output gate is a factor of tanh(new cells), not of the cells.": of(outside=False),
        "The new cells go through the logistic function, but tanh is asked for.": of(shown=squash),
        "The forget gate is a factor of the old cells, not of the old outputs.": of(old=memory[1]),
        "The forget gate is taken for its opposite: 1 keeps the old cells, 0 forgets them.": of(
            forget=lambda net: 1 - squash(net)
        ),
        "The logistic function has a minus sign too few or too many.": of(
            gate=lambda net: squash(-net)
        ),
        "The new candidate is subtracted, but belongs to the old cells.": of(
            candidate=lambda x: -np.tanh(x)
        ),
        "The forget gate is a factor of the old cells alone, not of what is added to them.": of(
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
        "Cells and outputs are exchanged: memory[0] holds the cells, in the old and the new one.": (
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
        "The rows of the new memory are exchanged: the cells come first.": (
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


def wrong_grids(places: int, headings: int, column: int) -> dict:
    """What slips make of a column of a grid."""

    def made(order, rows, spread, angles):
        ranges = spread(270, 350, places), spread(150, 250, places), angles
        table = np.meshgrid(*(ranges[i] for i in order), indexing="ij")
        y, x, heading = (table[order.index(i)].ravel() for i in range(3))
        return np.stack([x, y, heading], axis=1)[:, rows][:, column]

    turn = np.arange(headings) / headings
    names = ("y", "x", "the heading")
    return slips(
        made,
        order={"": (0, 1, 2)} | {
            f"{names[a]} changes slowest here, then {names[b]}, and {names[c]} fastest.": (a, b, c)
            for a, b, c in permutations(range(3)) if (a, b, c) != (0, 1, 2)
        },
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
            "x has the range of y, and y that of x.": lambda a, b, n:
            np.linspace(*((150, 250) if a == 270 else (270, 350)), n),
        },
        angles={
            "": 2 * np.pi * turn,
            "The headings 0 and 2 pi are the same: leave out 2 pi.":
            np.linspace(0, 2 * np.pi, headings),
            "The headings are in degrees.": 360 * turn,
            "The headings divide half a turn, not the whole one.": np.pi * turn,
            "`//` cuts the fraction off: divide with `/`.":
            np.arange(headings) * (2 * np.pi // headings),
            "The headings begin at minus pi, not at 0.": 2 * np.pi * turn - np.pi,
            "The headings turn clockwise.": -2 * np.pi * turn,
            "The headings are counted in whole turns.": turn,
            "The headings divide the turn into one part too many.":
            2 * np.pi * np.arange(headings) / (headings + 1),
            "The headings begin after 0, which belongs to them.":
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


def wrong_described(poses: np.ndarray, rewards: np.ndarray, cylinder, name: str) -> dict:
    """What slips make of a descriptor."""
    before, after, near = poses[:-1], poses[1:], rewards > 0
    (dx, dy, change), steps, many = (after - before).T, np.arange(len(rewards)), len(rewards)
    search = int(near.argmax()) if near.any() else many
    last = int(np.flatnonzero(near)[-1]) if near.any() else many
    if name == "search":
        return {
            "A robot that is never near searches through the whole episode: np.argmax gives 0.":
            np.argmax(near),
            "The first step with a reward is part of the search here.": search + 1,
            "The last step of the search is left out.": search - 1,
            "All steps without a reward are counted: the search ends at the first reward.":
            np.sum(~near),
            "The steps near the cylinder are counted.": np.sum(near),
            "The search ends at the last step with a reward, not at the first one.": last,
            "The share of the search is given, not its number of steps.": search / many,
            "A search without end has -1 here, not all the steps.": search if near.any() else -1,
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
            "The two parts are to be added: one is subtracted here.":
            dx * np.cos(theta) - dy * np.sin(theta),
            "This is how far the robot moves sideways.": dy * np.cos(theta) - dx * np.sin(theta),
            "The heading is left out: speed is along it.": dx + dy,
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
            "The short way around is within half a turn, not a quarter.":
            (change + np.pi / 2) % np.pi - np.pi / 2,
        },
        "wall": {
            "": nearest < 72.5,
            "A robot exactly 72.5 mm from a wall is not nearer than 72.5 mm.": nearest <= 72.5,
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
            "The direction is arctan2(dy, dx), not arctan2(dx, dy).":
            np.sin(np.arctan2(to_x, to_y) - later),
            "The sine is not divided by the distance.":
            np.sin(bearing - later) * np.hypot(to_x, to_y),
            "Only the sign of the side is taken.": np.sign(np.sin(bearing - later)),
        },
    }  # fmt: skip
    of_search = {
        "": steps < search,
        "The search ends at the first reward: later steps without one do not belong to it.": ~near,
        "All steps count here, not those of the search.": steps >= 0,
        "The first step with a reward is part of the search here.": steps <= search,
        "The last step of the search is left out.": steps < search - 1,
        "The first step is left out.": (steps > 0) & (steps < search),
        "These are the steps near the cylinder, not those of the search.": near,
        "Without any reward, all steps belong to the search.": steps < np.argmax(near),
    }
    of_near = {
        "": near,
        "Steps after the search count only with a reward: the robot may lose the cylinder.": steps
        >= search,
        "All steps count here, not those with a reward.": steps >= 0,
        "These are the steps of the search, not those near the cylinder.": steps < search,
        "These are the steps without a reward.": ~near,
        "Only the first step near the cylinder counts.": steps == search,
        "The first step near the cylinder is left out.": near & (steps > search),
        "The steps are one too early.": np.append(near[1:], False),
        "The steps are one too late.": np.append(False, near[:-1]),
    }

    if name == "pace":
        spots = after[near, :2]
        hops = np.hypot(*np.diff(spots, axis=0).T) if len(spots) > 1 else np.zeros(1)
        extra = {"These are the ways from one place with a reward to the next such place: take "
                 "each step from its own beginning to its end.": hops.mean()}  # fmt: skip
    elif name == "speed":
        gone = np.hypot(*(poses[search, :2] - poses[0, :2]))
        extra = {"This is the straight way of the whole search, divided by its steps: take each "
                 "step.": gone / max(search, 1)}  # fmt: skip
    elif name == "side":
        away = np.linalg.norm(np.stack([to_x, to_y]))
        cross = np.sin(bearing - later) * np.hypot(to_x, to_y) / away
        extra = {"All steps are divided by one length: each has a distance of its own (axis=1).":
                 cross[near].mean() if near.any() else 0.0}  # fmt: skip
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
        },
    )  # fmt: skip


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


def joined(
    table: np.ndarray, threshold: float, rows: Callable, apart: Callable, link: Callable, rule: str
) -> list[int]:
    """The families with slips, from a table of their distances.

    link: the new distances of two merged families, from their old ones and sizes. rule: which pair
    is merged; "leader", "centre" and "once" are other ways to make families.
    """
    points = np.nan_to_num(rows(table), posinf=0, neginf=0)
    distance = apart(points[:, None] - points)
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
        best = {"first": np.argmax(below), "lowest": np.argmax(below.T)}
        i, j = sorted(np.unravel_index(best.get(rule, np.argmin(distance)), distance.shape))
        if rule == "centre":
            points = np.delete(points, j, 0)
            points[i] = rows(table)[groups[i] + groups[j]].mean(axis=0)
            distance = apart(points[:, None] - points)
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
        "Two families weigh alike when they merge: take the mean over all pairs of robots.":
        lambda a, b, m, n: (a + b) / 2,
        "A family is represented by its first robot: take the mean over all pairs.":
        lambda a, b, m, n: a,
        "The distances of the pairs are added up: take their mean.": lambda a, b, m, n: a + b,
    }  # fmt: skip
    rule = {
        "": "nearest",
        "Families exactly as far apart as the threshold are merged.": "equal",
        "The first pair nearer than the threshold is merged, not the two nearest families.":
        "first",
        "The first pair below the threshold is merged, not the two nearest families.": "lowest",
        "Robots join the first robot that is near: families are to be merged, the nearest first.":
        "leader",
        "The distance of two families is that of their means: take the mean distance of robots.":
        "centre",
        "Only one merger is made: merge again and again.": "once",
    }  # fmt: skip
    make = partial(joined, table, threshold)
    return slips(make, most=1, rows=rows, apart=apart, link=link, rule=rule)


REMEMBERED = {
    "forget": "All zeros are asked for.",
    "freeze": "Before step `since` the memory is `after`; from then on it stays what `before` is "
    "in step `since`.",
}


def wrong_memories(first: np.ndarray, afters: np.ndarray, episode: int) -> dict:
    """Memories that may stand where another one belongs."""
    own, other = -(episode + 1) * afters, -(2 - episode) * afters
    return {
        "This is the memory at the beginning of the episode.": first,
        "This memory is empty.": 0 * first,
        **{f"This is the memory after step {k}.": each for k, each in enumerate(own)},
        **{
            f"This is the memory after step {k} of the other episode: it is kept from one episode "
            "to the next.": each
            for k, each in enumerate(other)
        },
        "Only the cells are empty, but the outputs are memory, too.": own[0] * [[0], [1]],
    }


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
    return {"The actions are read from the given outputs: `think` is not called.": old} | slips(
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
