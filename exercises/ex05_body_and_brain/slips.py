"""Compute what slips make of answers, and why right answers are right; for the grader."""

import tempfile
from collections.abc import Callable
from functools import cache, lru_cache, partial
from itertools import permutations
from pathlib import Path

import numpy as np

from botschool.course import SavedRobot
from botschool.grading import slips

BODY = 64


def scaled(p: np.ndarray, nominal: float) -> np.ndarray:
    return nominal + 0.9 * nominal * np.tanh(p)


def lengths(p: np.ndarray) -> np.ndarray:
    return scaled(p[0:22:2], 0.8)


def thicknesses(p: np.ndarray) -> np.ndarray:
    return scaled(p[1:22:2], 0.2)


def masses(p: np.ndarray) -> np.ndarray:
    return lengths(p) * thicknesses(p) * (5 + 0.8 * np.tanh(p[53:64]))


def angles(p: np.ndarray) -> np.ndarray:
    return np.minimum(np.maximum(p[42:53], -1), 1) * 135 * np.pi / 180


def limits(p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    one, other = (np.minimum(np.maximum(p[first:42:2], -1), 1) * np.pi / 2 for first in (22, 23))
    return np.minimum(one, other), np.maximum(one, other)


def corners(p: np.ndarray, wide: float = 1.0) -> np.ndarray:
    """Segment by segment, in complex numbers; wide: 1, but for mistakes."""
    place, heading, found = 0j, 0.0, []
    for length, thickness, angle in zip(lengths(p), wide * thicknesses(p), angles(p), strict=True):
        heading += angle
        along = length * np.exp(1j * heading)
        side = thickness / 2 * np.exp(1j * (heading + np.pi / 2))
        found.append([place - side, place + along - side, place + along + side, place + side])
        place += along
    return np.stack([np.real(found), np.imag(found)], axis=2)


def cut(p: np.ndarray) -> np.ndarray:
    return p.clip(-1, 1)


def elsewhere(what: str, first: int, made: Callable, many: int = 11) -> dict:
    """What comes of parameters that begin at another place; made: a function of the place."""
    places = [i for i in range(BODY + 1 - many) if i != first]
    return {f"The {what} begin at place {first}, not at {i}.": made(i) for i in places}


def wrong_sizes(p: np.ndarray, first: int, nominal: float) -> dict:
    """Slips in lengths (first: 0) or thicknesses (1)."""

    def at(i: int) -> np.ndarray:
        return scaled(p[i : i + 22 : 2], nominal)

    other = elsewhere("lengths" if nominal > 0.5 else "thicknesses", first, at, 22)
    return slips(
        lambda places, formula: formula(places),
        places={
            "": p[first:22:2],
            "Lengths and thicknesses take turns among the parameters.":
            p[11 * first : 11 * first + 11],
            "Lengths and thicknesses are exchanged: of each two parameters the length comes first.":
            p[1 - first : 22 : 2],
        },
        formula={
            "": lambda q: scaled(q, nominal),
            "The parameters are cut off at -1 and 1, but sizes use tanh.":
            lambda q: nominal * (1 + 0.9 * cut(q)),
            "0.9 is a factor of tanh p, not of p: it stands before the tanh.":
            lambda q: nominal * (1 + np.tanh(0.9 * q)),
            "The factor 0.9 is left out.": lambda q: nominal * (1 + np.tanh(q)),
            "The 1 that is added to 0.9 tanh p is left out.": lambda q: nominal * 0.9 * np.tanh(q),
            f"{nominal} is a factor of the whole bracket, also of 0.9 tanh p.":
            lambda q: nominal + 0.9 * np.tanh(q),
            "0.9 is a factor of tanh p alone, not of 1 + tanh p.":
            lambda q: nominal * 0.9 * (1 + np.tanh(q)),
            "0.9 tanh p is added to 1, not subtracted from it.": lambda q: scaled(-q, nominal),
            "tanh is left out: the parameters themselves are used.":
            lambda q: nominal * (1 + 0.9 * q),
            "tanh lies between -1 and 1, not between 0 and 1: at p = 0 a size is in the middle.":
            lambda q: nominal * (0.1 + 1.8 * np.tanh(q)),
            "tanh stands around the whole bracket, but belongs to p alone.":
            lambda q: nominal * np.tanh(1 + 0.9 * q),
            f"The factor {nominal} is left out.": lambda q: 1 + 0.9 * np.tanh(q),
            f"The factor is {nominal} here.": lambda q: scaled(q, 0.16 / nominal),
            "The function is tanh, not tan.": lambda q: nominal * (1 + 0.9 * np.tan(q)),
            "The function is tanh, not the inverse tangent.":
            lambda q: nominal * (1 + 0.9 * np.arctan(q)),
            "The function is tanh, not sine.": lambda q: nominal * (1 + 0.9 * np.sin(q)),
            "The function is tanh, not the logistic function.":
            lambda q: nominal * (1 + 0.9 / (1 + np.exp(-q))),
            "2 / (1 + exp(-p)) - 1 is tanh(p / 2), not tanh p.":
            lambda q: nominal * (1 + 0.9 * np.tanh(q / 2)),
            "tanh is that of p itself, not of 2 p.": lambda q: nominal * (1 + 0.9 * np.tanh(2 * q)),
            "tanh lies between -1 and 1: its sign is lost here.":
            lambda q: nominal * (1 + 0.9 * np.abs(np.tanh(q))),
            "1 and 0.9 are exchanged.": lambda q: nominal * (0.9 + np.tanh(q)),
            f"{nominal} is a factor of the size, not of the parameter.":
            lambda q: 1 + 0.9 * np.tanh(nominal * q),
            f"{nominal} is a factor of the size, and not of the parameter, too.":
            lambda q: nominal * (1 + 0.9 * np.tanh(nominal * q)),
        },
    ) | other  # fmt: skip


def wrong_masses(p: np.ndarray) -> dict:
    def at(i: int) -> np.ndarray:
        return lengths(p) * thicknesses(p) * (5 + 0.8 * np.tanh(p[i : i + 11]))

    return elsewhere("densities", 53, at) | slips(
        lambda formula, product: product(lengths(p), thicknesses(p), formula(p[53:])),
        formula={
            "": lambda q: 5 + 0.8 * np.tanh(q),
            "The density is 5 and varies by 0.8, not by 80 % or 90 % of it.":
            lambda q: 5 + 4 * np.tanh(q),
            "The density varies by 0.8, not like the sizes.": lambda q: scaled(q, 5),
            "The parameters of the densities are cut off, but must go through tanh.":
            lambda q: 5 + 0.8 * cut(q),
            "The tanh of the densities is left out.": lambda q: 5 + 0.8 * q,
            "The density varies by 0.8 around 5: 0.8 and 5 are exchanged.":
            lambda q: 0.8 + 5 * np.tanh(q),
            "The density varies by 0.8, not by 0.9.": lambda q: 5 + 0.9 * np.tanh(q),
            "The density varies by 0.8: this factor is left out.": lambda q: 5 + np.tanh(q),
            "The density is the same for all: the 0.8 tanh p is left out.": lambda q: 5 + 0 * q,
        },
        product={
            "": lambda long, thick, dense: long * thick * dense,
            "The density is left out.": lambda long, thick, dense: long * thick,
            "These are the densities: length and thickness are left out.":
            lambda long, thick, dense: dense,
            "The thickness is left out.": lambda long, thick, dense: long * dense,
            "The length is left out.": lambda long, thick, dense: thick * dense,
            "A segment is flat: its area is length x thickness, not that of a round rod.":
            lambda long, thick, dense: np.pi * (thick / 2) ** 2 * long * dense,
            "Length and thickness are multiplied, not added.":
            lambda long, thick, dense: (long + thick) * dense,
            "The density is a factor, not a divisor.": lambda long, thick, dense:
            long * thick / dense,
            "Length and thickness are factors of the whole density: 5 + 0.8 tanh p needs brackets.":
            lambda long, thick, dense: long * thick * 5 + dense - 5,
            "Each segment has a density of its own, not the mean of all.":
            lambda long, thick, dense: long * thick * dense.mean(),
            "The thickness is a factor once, not twice: the world is flat.":
            lambda long, thick, dense: long * thick**2 * dense,
            "The length is a factor once, not twice.":
            lambda long, thick, dense: long**2 * thick * dense,
            "Half of the thickness is taken, but the area is length x thickness.":
            lambda long, thick, dense: long * thick / 2 * dense,
            "The segments are as long and thick as at p = 0 here: take their own sizes.":
            lambda long, thick, dense: 0.16 * dense,
            "The masses are added up from segment to segment.":
            lambda long, thick, dense: np.cumsum(long * thick * dense),
            "The densities stand in the opposite order.":
            lambda long, thick, dense: long * thick * dense[::-1],
            "One mass for each segment is asked for, not their sum.":
            lambda long, thick, dense: np.sum(long * thick * dense),
        },
    )  # fmt: skip


def wrong_cuts() -> dict:
    """Slips in what is done with parameters q of angles and their scale."""
    return {
        "": lambda q, scale: scale * cut(q),
        "The parameters of angles are to be cut off at -1 and 1.": lambda q, scale: scale * q,
        "The parameters of angles are cut off, not put through tanh.":
        lambda q, scale: scale * np.tanh(q),
        "The angles are cut off at -1 and 1 after they are scaled: cut off the parameters.":
        lambda q, scale: cut(scale * q),
        "The parameters are cut off at 0 and 1 instead of -1 and 1.":
        lambda q, scale: scale * q.clip(0, 1),
        "The parameters are cut off at -0.5 and 0.5 instead of -1 and 1.":
        lambda q, scale: scale * q.clip(-0.5, 0.5),
        "The angles reach their largest value at -0.5 and 0.5 already, not at -1 and 1.":
        lambda q, scale: 2 * scale * q.clip(-0.5, 0.5),
        "The parameters are cut off at the scale, not at -1 and 1.":
        lambda q, scale: scale * q.clip(-scale, scale),
        "The angles are cut off at their largest value, but the parameters are not scaled.":
        lambda q, scale: q.clip(-scale, scale),
        "The parameters are cut off above only: -1 is a limit, too.":
        lambda q, scale: scale * np.minimum(q, 1),
        "The parameters are cut off below only: 1 is a limit, too.":
        lambda q, scale: scale * np.maximum(q, -1),
        "Parameters beyond -1 and 1 come back on the other side here: cut them off.":
        lambda q, scale: scale * ((q + 1) % 2 - 1),
        "Parameters beyond -1 and 1 become 0 here: they become -1 and 1.":
        lambda q, scale: scale * np.where(np.abs(q) > 1, 0, q),
        "The parameters are divided by the largest amount: cut each one off.":
        lambda q, scale: scale * q / np.maximum(np.abs(q).max(), 1e-9),
        "Only the sign of a parameter is used.": lambda q, scale: scale * np.sign(q),
        "The parameters are put through sine: cut them off.": lambda q, scale: scale * np.sin(q),
        "The parameters have lost their signs.": lambda q, scale: scale * cut(np.abs(q)),
        "The angles are cut off at -pi and pi, the parameters not at all.":
        lambda q, scale: (scale * q).clip(-np.pi, np.pi),
        "A length's formula is used, 1 + 0.9 tanh p: angles are cut off and scaled.":
        lambda q, scale: scale * (1 + 0.9 * np.tanh(q)),
    }  # fmt: skip


def wrong_angles(p: np.ndarray) -> dict:
    def at(i: int) -> np.ndarray:
        return 0.75 * np.pi * cut(p[i : i + 11])

    return elsewhere("default angles", 42, at) | slips(
        lambda cutting, scale, sums: sums(cutting(p[42:53], scale)),
        cutting=wrong_cuts(),
        scale={
            "": 0.75 * np.pi,
            "The default angles are scaled by pi / 2, as the limits are.": np.pi / 2,
            "The angles are in degrees, not in radians.": 135,
            "The scale is 3 pi / 4: pi is left out.": 0.75,
            "The scale is 3 pi / 4, not 4 pi / 3.": np.pi * 4 / 3,
            "The scale is 3 pi / 4, not pi / 4.": np.pi / 4,
            "pi is a factor of the scale, not a divisor.": 0.75 / np.pi,
            "The scale is 3 pi / 4, not 3 pi / 2.": 1.5 * np.pi,
            "The scale is 3 pi / 4, not pi.": np.pi,
            "The scale is 3 pi / 4: the 4 is left out.": 3 * np.pi,
            "All segments have the scale 3 pi / 4: only the torso has it here.":
            np.append(0.75 * np.pi, np.full(10, np.pi / 2)),
            "All segments have the scale 3 pi / 4, also the torso.":
            np.append(np.pi / 2, np.full(10, 0.75 * np.pi)),
        },
        sums={
            "": lambda a: a,
            "These are sums of angles, which belong to `outline`.": np.cumsum,
            "The torso has a default angle, too: it is 0 here.":
            lambda a: np.where(np.arange(11) == 0, 0, a),
            "The torso has a default angle, too: it is left out.": lambda a: np.append(a[1:], 0),
            "These are differences of neighbours: a parameter already counts from the segment "
            "before.": lambda a: np.diff(a, prepend=0),
            "The torso's angle is added to all others.": lambda a: np.append(a[:1], a[1:] + a[0]),
            "The torso's angle is subtracted from all.": lambda a: a - a[0],
            "The angles are cut to -pi to pi or 0 to 2 pi: an angle may be negative.":
            lambda a: a % (2 * np.pi),
            "The angles stand in the opposite order.": lambda a: a[::-1],
        },
    )  # fmt: skip


def wrong_limits(p: np.ndarray, name: str) -> dict:
    """Slips in "lower" or "upper"."""
    low = name == "lower"
    end, far = (np.minimum, np.maximum) if low else (np.maximum, np.minimum)
    pick = (lambda one, other: one) if low else (lambda one, other: other)

    def amounts(one, other):
        ordered = np.sort(np.abs([one, other]), axis=0)
        return ordered[0 if low else 1]

    def by_amount(one, other, last=False):
        """last: take the second one of equal amounts."""
        smaller = np.abs(one) < np.abs(other) if low else np.abs(one) > np.abs(other)
        equal = np.abs(one) == np.abs(other)
        return np.where(smaller | (equal & (not last)), one, other)

    def paired(one, other):
        return np.sort(np.ravel([one, other], order="F")).reshape(10, 2)[:, 0 if low else 1]

    def at(i: int) -> np.ndarray:
        return np.pi / 2 * end(*cut(p[i : i + 20].reshape(10, 2).T))

    return elsewhere("limits", 22, at, 20) | slips(
        lambda places, cutting, scale, end, added: end(*cutting(places, scale)) + added,
        places={
            "": p[22:42].reshape(10, 2).T,
            "The two limits of a joint stand side by side among the parameters.":
            p[22:42].reshape(2, 10),
        },
        cutting=wrong_cuts(),
        scale={
            "": np.pi / 2,
            "The limits are scaled by 3 pi / 4, as the default angles are.": 0.75 * np.pi,
            "The limits are in degrees, not in radians.": 90,
            "The scale of the limits is pi / 2, not pi.": np.pi,
            "The scale of the limits is pi / 2, not pi / 4.": np.pi / 4,
        },
        end={
            "": end,
            f"The {name} limit is the {'smaller' if low else 'larger'} one of the two.": pick,
            "Lower and upper limits are exchanged.": far,
            "The amounts of the limits are compared: the smaller one is the more negative one.":
            by_amount,
            "The amounts of the limits are compared, but the smaller one is the more negative one.":
            partial(by_amount, last=True),
            "A limit is taken without its sign: both can lie on one side of the default angle.":
            lambda one, other: (-1 if low else 1) * np.abs(pick(one, other)),
            "Limits are taken without their signs.": amounts,
            "The limits of all joints are sorted, but each joint has its own two (axis=1).":
            lambda one, other: np.sort(one if low else other),
            "All 20 limits are sorted together, but each joint has its own two (axis=1).": paired,
            f"The {name} limit is {'minus the larger' if low else 'minus the smaller'} one here: "
            "the two limits are two numbers of their own.": lambda one, other: -far(one, other),
            "The limit with the larger amount counts to both sides here: the two limits are two "
            "numbers of their own.":
            lambda one, other: (-1 if low else 1) * np.maximum(np.abs(one), np.abs(other)),
            "The limit with the smaller amount counts to both sides here.":
            lambda one, other: (-1 if low else 1) * np.minimum(np.abs(one), np.abs(other)),
            "The second limit is added to the first one: it counts from the default angle, too.":
            lambda one, other: end(one, one + other),
            "Half of the way between the two limits is taken to each side.":
            lambda one, other: (-1 if low else 1) * np.abs(one - other) / 2,
            "One limit of all joints is taken: each joint has its own two (axis=1).":
            lambda one, other: 0 * one + (np.min if low else np.max)([one, other]),
            "A joint has two limits: only the first one is looked at.":
            lambda one, other: end(one, 0),
            "A joint has two limits: only the second one is looked at.":
            lambda one, other: end(other, 0),
            "A lower limit is at most 0 and an upper one at least 0 here: both can lie on one "
            "side.": lambda one, other: end(end(one, other), 0),
            "The limits are cut off at 0: both can lie on one side of the default angle.":
            lambda one, other: far(end(one, other), 0),
        },
        added={
            "": 0,
            "The default angle is added: limits count from the default angle.": angles(p)[1:],
            "The default angle of the segment before is added: limits count from 0.":
            angles(p)[:-1],
        },
    )  # fmt: skip


def wrong_corners(p: np.ndarray) -> dict:
    """Slips in `outline`."""
    long, thick, bends = lengths(p), thicknesses(p), angles(p)
    flat = np.where(np.arange(11) == 0, 0, bends)

    low, high = (np.append(0, each) for each in limits(p))

    def drawn(heading, along, across, wide, joint, first):
        along = long * along(heading)
        side = wide * across(heading)
        ends = np.cumsum(along + joint(side))
        begin = np.append(0, ends[:-1]) + first(along)
        found = np.stack([begin - side, begin + along - side, begin + along + side, begin + side])
        return np.stack([found.real.T, found.imag.T], axis=2)

    own, heading = corners(p), np.exp(1j * np.cumsum(bends))
    begin = np.append(0, np.cumsum(long * heading)[:-1])
    placed = np.stack([begin + x * long + y * thick * 1j for x, y in RECTANGLE], axis=1)
    turned = placed * heading[:, None]
    orders = {
        "y points downwards here, but belongs upwards.": own * [1, -1],
        "x points to the left here, but belongs to the right.": own * [-1, 1],
        "The segments are turned around (0, 0) after they are moved: turn each around its own "
        "beginning, then move it.": np.stack([turned.real, turned.imag], axis=2),
        "Four lists of 11 corners are reshaped, which mixes them up: stack them with axis=1.":
        own.swapaxes(0, 1).reshape(11, 4, 2),
    } | {"x and y of each corner are exchanged.": own[..., ::-1]} | {
        "The corners of a segment come in another order: "
        f"{', '.join(CORNERS[k] for k in order)}.": own[:, order]
        for order in permutations(range(4)) if order != (0, 1, 2, 3)
    }  # fmt: skip
    return orders | slips(
        drawn,
        heading={
            "": np.cumsum(bends),
            "An angle is that to the segment before, not that to the ground.": bends,
            "The torso leans by its own default angle: it is left out.": np.cumsum(flat),
            "The torso's angle turns clockwise here, but is counter-clockwise.":
            np.cumsum(bends) - 2 * bends[0],
            "The torso's angle is counted twice in all headings.": np.cumsum(bends) + bends[0],
            "The torso's angle counts for the torso alone: it is in all headings.":
            np.append(bends[0], np.cumsum(bends[1:])),
            "A segment's own angle is left out of its heading.": np.cumsum(bends) - bends,
            "The angles turn clockwise here, but are counter-clockwise.": -np.cumsum(bends),
            "A heading is cut off, but may go beyond pi.": np.cumsum(bends).clip(-np.pi, np.pi),
            "The heading of a segment has the angles of two segments only: sum up all.":
            bends + np.append(0, bends[:-1]),
            "Half of a segment's own angle is left out of its heading.":
            np.cumsum(bends) - bends / 2,
            "The angles are summed up twice.": np.cumsum(np.cumsum(bends)),
            "The headings are converted: np.cos takes radians.": np.radians(np.cumsum(bends)),
            "The headings are in degrees here: np.cos takes radians.":
            np.degrees(np.cumsum(bends)),
            "The joints are at their lower limits here: at rest they are at their default angles.":
            np.cumsum(bends + low),
            "The joints are at their upper limits here: at rest they are at their default angles.":
            np.cumsum(bends + high),
            "The joints are in the middle of their limits here: at rest they are at their default "
            "angles.": np.cumsum(bends + (low + high) / 2),
            "The angles are subtracted from segment to segment: add them up.":
            2 * bends[0] - np.cumsum(bends),
            "The last segment's angle comes first here: the torso's comes first.":
            np.cumsum(bends[::-1]),
            "The headings are means of the angles, not their sums.":
            np.cumsum(bends) / (np.arange(11) + 1),
            "The torso's angle is counted twice from segment 1 on, and each other one comes one "
            "segment late.": np.append(bends[0], bends[0] + np.cumsum(bends)[:-1]),
        },
        along={
            "": lambda a: np.exp(1j * a),
            "Sine and cosine of the direction along a segment are exchanged.":
            lambda a: np.sin(a) + 1j * np.cos(a),
            "A segment goes to x - l cos, not to x + l cos.": lambda a: -np.exp(-1j * a),
            "A segment goes to y + l sin, not to y - l sin.": lambda a: np.exp(-1j * a),
            "A segment goes along its heading, not against it.": lambda a: -np.exp(1j * a),
            "A segment lies along the heading of the one before, though its corners have its own.":
            lambda a: np.exp(1j * np.append(0, a[:-1])),
            "A segment lies along the heading of the one before it, though its corners have its "
            "own.": lambda a: np.exp(1j * np.append(a[:1], a[:-1])),
            "A segment lies along its own default angle, though its corners have its heading.":
            lambda a: np.exp(1j * bends),
            "The segments lie in a straight line, though their corners are turned.":
            lambda a: 1 + 0j * a,
        },
        across={
            "": lambda a: 1j * np.exp(1j * a),
            "The direction across a segment has lost its minus sign.":
            lambda a: np.sin(a) + 1j * np.cos(a),
            "The direction across a segment is (-sin, cos), not (cos, -sin) or (-cos, sin).":
            lambda a: np.cos(a) - 1j * np.sin(a),
            "The direction across a segment is (-sin, cos), not (-cos, sin).":
            lambda a: -np.cos(a) + 1j * np.sin(a),
            "The direction across a segment is the one along it.": lambda a: np.exp(1j * a),
            "The direction across a segment turns with its heading: it is not always upwards.":
            lambda a: 1j + 0 * a,
            "The direction across a segment belongs to its heading, not to its default angle.":
            lambda a: 1j * np.exp(1j * bends),
            "The direction across a segment belongs to its own heading, not to that of the one "
            "before.": lambda a: 1j * np.exp(1j * np.append(0, a[:-1])),
            "The direction across a segment belongs to its own heading, not that of the one "
            "before it.": lambda a: 1j * np.exp(1j * np.append(a[:1], a[:-1])),
            "Half of the thickness counts in x and in y alike: it belongs to the direction across.":
            lambda a: 1 + 1j + 0 * a,
        },
        wide={
            "": thick / 2,
            "A segment reaches half of its thickness to each side.": thick,
            "The thickness is left out: these are places on the middle line.": 0 * thick,
            "Half of the thickness is halved once more.": thick / 4,
            "All segments are as thick as the torso.": thick[0] / 2 + 0 * thick,
            "A segment has the thickness of the one before.": np.append(thick[:1], thick[:-1]) / 2,
            "Half of the length is taken for half of the thickness.": long / 2,
        },
        joint={
            "": lambda side: 0,
            "The next segment begins at the end of the middle line, not at the left corner there.":
            lambda side: side,
            "The next segment begins at the end of the middle line, not at the right corner there.":
            lambda side: -side,
            "The thickness of a segment does not move the next one away.": lambda side: thick,
        },
        first={
            "": lambda along: 0,
            "The middle of the torso lies at (0, 0), but its beginning belongs there.":
            lambda along: -along[0] / 2,
            "The end of the torso lies at (0, 0), but its beginning belongs there.":
            lambda along: -along[0],
            "Each segment has its middle where its beginning belongs.": lambda along: -along / 2,
            "Each segment begins where it ends: the place is moved on before the corners are "
            "found.": lambda along: along,
            "All segments begin at (0, 0): each begins at the end of the one before.":
            lambda along: -np.append(0, np.cumsum(along)[:-1]),
        },
    )  # fmt: skip


def wrong_mass(p: np.ndarray) -> dict:
    """Slips in "mass"."""
    long, thick = lengths(p), thicknesses(p)
    dense = masses(p) / long / thick
    mixed = "Multiply for each segment first, then add up: the mass is not that of one segment "
    return wrong_sums(masses(p), long * thick) | {
        f"{mixed}with the length of all and a mean thickness and density.":
        long.sum() * thick.mean() * dense.mean(),
        f"{mixed}with the sums of all lengths, thicknesses and densities.":
        long.sum() * thick.sum() * dense.sum(),
        f"{mixed}with the area of all and a mean density.": (long * thick).sum() * dense.mean(),
        f"{mixed}with mean sizes.": long.mean() * thick.mean() * dense.mean(),
        f"{mixed}with sums of lengths and thicknesses.": long.sum() * thick.sum() * dense.mean(),
        "The densities are added up, but masses are asked for.": dense.sum(),
    }  # fmt: skip


def wrong_sums(values: np.ndarray, other: np.ndarray) -> dict:
    """Slips in "length" or "mass"; other: the numbers that may be mistaken for these."""
    return slips(
        lambda values, summary: summary(values),
        values={"": values, "Another quantity of the segments is added up.": other},
        summary={
            "": np.sum,
            "This is the mean over the segments, not the sum.": np.mean,
            "The torso is left out.": lambda v: v[1:].sum(),
            "The last segment is left out.": lambda v: v[:-1].sum(),
            "This is the largest one, not the sum.": np.max,
            "This is the largest minus the smallest one, not the sum.": np.ptp,
            "This is that of the torso alone.": lambda v: v[0],
            "The numbers are multiplied, not added up.": np.prod,
            "This is the median, not the sum.": np.median,
        },
    )  # fmt: skip


@np.errstate(all="ignore")
def wrong_extent(p: np.ndarray, axis: int) -> dict:
    """Slips in "width" (axis 0) or "height" (1)."""
    every, middle = corners(p), corners(p, wide=0)
    return slips(
        lambda places, axis, summary: summary(places[..., axis].ravel()),
        places={
            "": every,
            "The thickness is left out: it counts where the corners are, not the middle line.":
            middle,
            "All four corners of a segment count, not the first one only.": every[:, :1],
            "The ends of the segments are left out: they count, too.": every[:, ::3],
            "The beginnings of the segments are left out: they count, too.": every[:, 1:3],
            "The left corners of the segments are left out: they count, too.": every[:, :2],
            "The right corners of the segments are left out: they count, too.": every[:, 2:],
            "The torso is left out.": every[1:],
            "The last segment is left out.": every[:-1],
            "Only the torso is measured.": every[:1],
            "The middles of the segments are measured: all corners count.":
            every.mean(axis=1, keepdims=True),
        },
        axis={"": axis, "Width and height are exchanged.": 1 - axis},
        summary={
            "": np.ptp,
            "Only the largest coordinate is taken: subtract the smallest.": np.max,
            "The largest amount of a coordinate is taken: subtract the smallest coordinate from "
            "the largest.": lambda v: np.abs(v).max(),
            "The smallest coordinate is added: subtract it.": lambda v: v.max() + v.min(),
            "The difference has the wrong sign.": lambda v: -np.ptp(v),
            "This is the way from the first place to the last: the corners in between count, too.":
            lambda v: abs(v[-1] - v[0]),
            "This is a standard deviation, not the difference of the extremes.": np.std,
            "Only the smallest coordinate is taken: subtract it from the largest.": np.min,
            "Only the amount of the smallest coordinate is taken: subtract it from the largest.":
            lambda v: -v.min(),
            "The mean is subtracted from the largest coordinate: subtract the smallest.":
            lambda v: v.max() - v.mean(),
            "Twice the largest amount is taken, but the body is not the same on both sides of 0.":
            lambda v: 2 * np.abs(v).max(),
            "The lower end is at most 0 here, as if there were ground: subtract the smallest.":
            lambda v: v.max() - max(v.min(), 0),
        },
    ) | {
        "The amounts of all segments' ways are added up, but ways there and back overlap.":
        np.abs(middle[:, 1, axis] - middle[:, 0, axis]).sum(),
        "The difference is taken for each segment alone: take it over all corners of all.":
        np.ptp(every[..., axis], axis=1).max(),
        "The differences of the segments are added up: take one over all corners of all.":
        np.ptp(every[..., axis], axis=1).sum(),
        "The difference is taken for each of the four corners alone, then their mean.":
        np.ptp(every[..., axis], axis=0).mean(),
        "The difference is taken for each of the four corners alone, then the largest one.":
        np.ptp(every[..., axis], axis=0).max(),
        "x and y are mixed: width is of x alone, height of y alone.": np.ptp(every),
        "x and y of the first corners are mixed: width is of x alone, height of y alone.":
        np.ptp(every[:, 0]),
        "This is the way from the first place to the last: the corners in between count, too.":
        abs(middle[-1, 1, axis]),
    }  # fmt: skip


def wrong_freedom(p: np.ndarray) -> dict:
    (low, high), raw = limits(p), p[22:42].reshape(10, 2)
    half = np.pi / 2
    return slips(
        lambda pair, summary: summary(*pair),
        pair={
            "": (low, high),
            "The limits are those of `joints`, cut off: the parameters go beyond them.":
            (half * raw.min(axis=1), half * raw.max(axis=1)),
            "The limits are angles: the parameters are not scaled here.":
            tuple(np.sort(cut(raw).T, axis=0)),
            "The smaller limit is the lower one: the limits are not in order here.":
            tuple(half * cut(raw).T),
        },
        summary={
            "": lambda low, high: np.mean(high - low),
            "This is the sum over the joints, not the mean.": lambda low, high: np.sum(high - low),
            "The sum is divided by the 11 segments, but there are 10 joints.":
            lambda low, high: np.sum(high - low) / 11,
            "The largest limit and the smallest one belong to different joints: take the "
            "difference of each joint first.": lambda low, high: high.max() - low.min(),
            "Only the upper limits count here: subtract the lower ones.":
            lambda low, high: high.mean(),
            "Only the lower limits count here: subtract them from the upper ones.":
            lambda low, high: low.mean(),
            "The lower limit is added: subtract it.": lambda low, high: np.mean(high + low),
            "The difference is the wrong way round.": lambda low, high: np.mean(low - high),
            "The amounts of the two limits are added, but both can be on one side.":
            lambda low, high: np.mean(np.abs(high) + np.abs(low)),
            "This is the largest freedom, not the mean.": lambda low, high: np.max(high - low),
            "This is the median, not the mean.": lambda low, high: np.median(high - low),
            "This is the freedom of the first joint alone.": lambda low, high: high[0] - low[0],
            "These are the amounts of the 20 limits: subtract lower from upper ones.":
            lambda low, high: np.mean(np.abs([low, high])),
            "The freedom is the whole way from the lower to the upper limit: this is half of it.":
            lambda low, high: np.mean(high - low) / 2,
            "This is the smallest freedom, not the mean.": lambda low, high: np.min(high - low),
            "Only joints that move at all are counted: the mean is over all 10.":
            lambda low, high: np.mean((high - low)[high > low]) if (high > low).any() else 0.0,
            "This is the standard deviation of all limits.": lambda low, high: np.std([low, high]),
            "This is the standard deviation over the joints, not the mean.":
            lambda low, high: np.std(high - low),
            "The largest amount of the limits is taken for each joint.":
            lambda low, high: np.mean(np.maximum(np.abs(low), np.abs(high))),
            "The limits are added to the default angles and all of them compared.":
            lambda low, high: np.ptp([angles(p)[1:] + low, angles(p)[1:] + high]),
            "The freedom is in degrees, not in radians.":
            lambda low, high: np.degrees(np.mean(high - low)),
        },
    )  # fmt: skip


MISTAKES = {
    "lengths": lambda p: wrong_sizes(p, 0, 0.8),
    "thicknesses": lambda p: wrong_sizes(p, 1, 0.2),
    "masses": wrong_masses,
    "angles": wrong_angles,
    "lower": lambda p: wrong_limits(p, "lower"),
    "upper": lambda p: wrong_limits(p, "upper"),
    "length": lambda p: wrong_sums(lengths(p), thicknesses(p)),
    "mass": wrong_mass,
    "width": lambda p: wrong_extent(p, 0),
    "height": lambda p: wrong_extent(p, 1),
    "freedom": wrong_freedom,
}
"""What slips make of an answer's parts: functions of the parameters."""


def origin_of(p: np.ndarray, key: str, *place: int) -> str:
    """What the text says about a number, with the parameters or parts from which it comes."""
    i = place[0] if place else 0
    long, thick, (low, high) = lengths(p), thicknesses(p), limits(p)
    if key in ("lengths", "thicknesses"):
        at, nominal = (2 * i, 0.8) if key == "lengths" else (2 * i + 1, 0.2)
        return f"{key}[{i}] comes from p[{at}] = {p[at]:.4g}: it is {nominal} (1 + 0.9 tanh p)."
    if key == "masses":
        return (
            f"masses[{i}] is length {long[i]:.4g} x thickness {thick[i]:.4g} x density, which "
            f"comes from p[{53 + i}] = {p[53 + i]:.4g}: it is 5 + 0.8 tanh p."
        )
    cut_off = "times the parameter, which is cut off at -1 and 1 first"
    if key == "angles":
        return f"angles[{i}] comes from p[{42 + i}] = {p[42 + i]:.4g}: 3 pi / 4 {cut_off}."
    if key in ("lower", "upper"):
        a, b = 22 + 2 * i, 23 + 2 * i
        return (
            f"The limits of joint {i} come from p[{a}] = {p[a]:.4g} and p[{b}] = {p[b]:.4g}: "
            f"pi / 2 {cut_off}. The {'smaller' if key == 'lower' else 'larger'} one is {key}[{i}]."
        )
    if key in ("width", "height"):
        values = corners(p)[:, :, int(key == "height")]
        return (
            f"Of all 44 corners the largest {'y' if key == 'height' else 'x'} is "
            f"{values.max():.4g} and the smallest {values.min():.4g}."
        )
    if key == "freedom":
        return f"The joints can move by {np.round(high - low, 3).tolist()}: take the mean."
    parts = long if key == "length" else masses(p)
    return f"It is the sum of these: {np.round(parts, 3).tolist()}."


RECTANGLE = ((0, -0.5), (1, -0.5), (1, 0.5), (0, 0.5))
"""The corners of a segment in lengths and thicknesses, as it lies before it is turned."""
CORNERS = ("beginning right", "end right", "end left", "beginning left")


def same_corners(got: np.ndarray, own: np.ndarray) -> bool:
    """Whether the four corners are the right ones, in any order but the right one."""
    apart = np.abs(got[:, None] - own).max(axis=2) < 1e-3
    return bool(apart.any(axis=1).all() and apart.any(axis=0).all() and not apart.diagonal().all())


def crooked(got: np.ndarray) -> str:
    """What is wrong with four corners that make no rectangle."""
    first, last = got[3] - got[0], got[2] - got[1]
    if np.abs(first - last).max() > 1e-3:
        wide = [float(np.hypot(*each)) for each in (first, last)]
        if abs(wide[0] - wide[1]) > 1e-3:
            return (
                f"it is {wide[0]:.4g} m thick at its beginning and {wide[1]:.4g} m at its end. "
                "Both ends have half the thickness of the segment itself to each side."
            )
        return "the direction across is another one at its end than at its beginning."
    along = (got[1] + got[2] - got[0] - got[3]) / 2
    turned = [float(np.arctan2(each[1], each[0])) for each in (along, first)]
    return (
        f"it goes in the direction {turned[0]:.4g} from its beginning to its end, and "
        f"{turned[1]:.4g} from right to left. Both follow from one heading, a right angle apart."
    )


def measured(got: np.ndarray, p: np.ndarray, *place: int) -> str:
    """What the corners of a submission show: the first thing that is not as the text says."""
    own = corners(p)
    turned = "the sum of all default angles up to its own"

    def parts(corners: np.ndarray) -> tuple:
        """Beginnings, ends, lengths, headings and thicknesses, from the corners."""
        begin, end = (corners[:, 0] + corners[:, 3]) / 2, (corners[:, 1] + corners[:, 2]) / 2
        along, across = end - begin, corners[:, 3] - corners[:, 0]
        heading = np.arctan2(along[:, 1], along[:, 0])
        return begin, end, np.hypot(*along.T), heading, np.hypot(*across.T)

    begin, end, long, heading, thick = parts(got)
    _, _, right_long, right_heading, right_thick = parts(own)
    sides = got[:, 1] - got[:, 0], got[:, 2] - got[:, 3]
    along, across = end - begin, got[:, 3] - got[:, 0]
    left = along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]
    for k in range(11):
        before, name = (
            (end[k - 1], f"but segment {k - 1} ends at") if k else (np.zeros(2), "not at")
        )
        if np.abs(begin[k] - before).max() > 1e-3:
            where, before = begin[k].round(3).tolist(), before.round(3).tolist()
            if same_corners(got[k], own[k]):
                return f"The corners of segment {k} are right, but come in another order."
            return f"Segment {k} begins at {where} there, {name} {before}."
        if np.abs(sides[0][k] - sides[1][k]).max() > 1e-3 or abs(along[k] @ across[k]) > 1e-3:
            said = f"The four corners of segment {k}, one after another, make no rectangle"
            return f"{said}: {crooked(got[k])}"
        if left[k] < 0:
            return f"The right corners of segment {k} lie to its left."
        if abs(thick[k] - right_thick[k]) > 1e-3:
            return (
                f"Segment {k} is {thick[k]:.4g} m thick there, but `sizes` gives "
                f"{right_thick[k]:.4g}: half of it belongs to each side."
            )
        if abs(long[k] - right_long[k]) > 1e-3:
            return f"Segment {k} is {long[k]:.4g} m long there, not {right_long[k]:.4g} m."
        if abs(np.exp(1j * heading[k]) - np.exp(1j * right_heading[k])) > 1e-3:
            bend = f" ({' + '.join(f'{a:.4g}' for a in angles(p)[: k + 1])})" * (0 < k < 6)
            return (
                f"Segment {k} has the heading {heading[k]:.4g} there, but {turned} is "
                f"{right_heading[k]:.4g}{bend}."
            )
    return ""


def changed(own: Callable, p: np.ndarray) -> dict:
    """What comes of changed parameters; own: the right function of the parameters."""

    def without(*places: int) -> np.ndarray:
        return np.where(np.isin(np.arange(BODY), places), 0, p)

    groups = [p[0:22:2], p[1:22:2], p[22:42:2], p[23:42:2], p[42:53], p[53:]]
    turned = p.copy()
    turned[0:22:2], turned[1:22:2], turned[22:42:2], turned[23:42:2], turned[42:53], turned[53:] = (
        group[::-1] for group in groups
    )
    first = np.zeros(BODY)
    first[:22], first[42:] = p[:22], p[42:]
    other = {
        "The parameters have lost their signs.": np.abs(p),
        "The parameters have the opposite signs.": -p,
        "All parameters are cut off at -1 and 1 first.": cut(p),
        "All parameters are put through tanh first.": np.tanh(p),
        "The parameters are rounded first.": p.round(),
        "The parameters are cut to whole numbers first.": np.trunc(p),
        "All parameters are all read in the opposite order.": p[::-1],
        "The torso has parameters like all others: it has those of p = 0 here.": without(
            0, 1, 42, 53
        ),
        "The last segment has parameters like all others: it has those of p = 0 here.": without(
            20, 21, 52, 63
        ),
        "The first joint has parameters like all others: it has those of p = 0 here.": without(
            22, 23
        ),
        "The last joint has parameters like all others: it has those of p = 0 here.": without(
            40, 41
        ),
        "The segments stand in the opposite order.": turned,
        "All parameters are read one place too late.": np.roll(p, -1),
        "All parameters are read one place too early.": np.roll(p, 1),
        "The parameters are divided by their largest amount first.": p / np.abs(p).max(),
        "The mean of the parameters is subtracted first.": p - p.mean(),
        "The densities are left out: all have that of p = 0.": without(*range(53, 64)),
        "The default angles are left out: all are 0.": without(*range(42, 53)),
        "The lengths are left out: all are 0.8.": without(*range(0, 22, 2)),
        "The thicknesses are left out: all are 0.2.": without(*range(1, 22, 2)),
    }
    return {text: own(parameters) for text, parameters in other.items()}


def wrong_parts(brain: np.ndarray, body: np.ndarray, part: slice) -> dict[str, np.ndarray]:
    """What slips make of a part of a transplanted genotype; all have the length of the part."""
    one, other, end = brain[part], body[part], len(brain) - 70
    if part.stop == -70:
        return {
            "The body is still the one of the brain's own genotype.": one,
            "The foreign body is added to the brain's own: it takes its place.": one + other,
            "The mean of both bodies is taken: the foreign one takes the place of the own.":
            (one + other) / 2,
            "The body is all 0.": 0 * one,
            "The first half of the body is still the one of the brain's own genotype.":
            np.append(one[:32], other[32:]),
            "The second half of the body is still the one of the brain's own genotype.":
            np.append(other[:32], one[32:]),
            "The last 64 numbers of the other genotype are taken for the body.": body[-64:],
            "The first 64 numbers of the other genotype are taken for the body.": body[:64],
            "The body of the other genotype is sought 35 numbers from the end.": body[-99:-35],
        } | {
            f"All but {abs(by)} of the body's numbers are foreign: its place is {abs(by)} too "
            f"{'late' if by > 0 else 'early'} in both genotypes.": np.where(
                (np.arange(end - 64, end) >= end - 64 + by) & (np.arange(end - 64, end) < end + by),
                other, one)
            for by in (-35, -6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, 35)
        }  # fmt: skip
    if part.start == -70:
        return {
            "Means and deviations come from the body's genotype, but belong to the brain.": other,
            "The means come from the body's genotype, but belong to the brain.":
            np.append(other[:35], one[35:]),
            "The deviations come from the body's genotype, but belong to the brain.":
            np.append(one[:35], other[35:]),
            "Means and deviations are exchanged.": np.append(one[35:], one[:35]),
            "Means and deviations of both genotypes are averaged: they belong to the brain.":
            (one + other) / 2,
            "Means and deviations are 0 and 1: they belong to the brain.":
            np.repeat([0.0, 1.0], 35),
            "Means and deviations are all 0: they belong to the brain.": 0 * one,
        }  # fmt: skip
    return {
        "The network is that of the body's genotype: brain and body are exchanged.": other,
        "The foreign body stands in the first 64 places, but the network comes first.": np.append(
            body[-134:-70], one[64:]
        ),
        "The networks of both genotypes are averaged.": (one + other) / 2,
        "The networks of both genotypes are added.": one + other,
        **{
            f"The last {k} numbers of the network come from the body's genotype: the place of the "
            f"body is too far ahead.": np.append(one[:-k], other[-k:])
            for k in (1, 2, 3, 4, 5, 6, 10, 35, 64, 70)
        },
        "The network is all 0.": 0 * one,
    }


def wrong_transplants(brain: np.ndarray, body: np.ndarray) -> dict[str, np.ndarray]:
    """What slips make of a whole transplanted genotype, whose length is wrong."""
    network, norm, own, foreign = brain[:-134], brain[-70:], brain[-134:-70], body[-134:-70]
    missing = "The means and deviations at the end are missing: they belong to the brain."
    return {
        missing: np.append(network, foreign),
        "The brain's own body is still there: the foreign one takes its place.":
        np.concatenate([network, own, foreign, norm]),
        "The foreign body stands behind the whole genotype of the brain.":
        np.append(brain, foreign),
        "The foreign body stands in front of the brain's whole genotype.":
        np.append(foreign, brain),
        "Two genotypes are returned, but one is asked for.": np.array(
            [np.concatenate([network, foreign, norm]),
             np.concatenate([body[:-134], own, body[-70:]])]),
        "This is the body alone.": foreign,
        "This is the brain without any body.": np.append(network, norm),
        "The two whole genotypes stand one after another.": np.append(brain, body),
        "The means are left out: 35 means and 35 deviations follow the body.":
        np.concatenate([network, foreign, norm[35:]]),
        "The deviations are left out: 35 means and 35 deviations follow the body.":
        np.concatenate([network, foreign, norm[:35]]),
        "The foreign genotype from its body on stands behind the whole genotype of the brain.":
        np.append(brain, body[-134:]),
        "Network, body, means and deviations are given one by one: make one array of them.":
        np.zeros(0),
    }  # fmt: skip


def other_places(genotype: np.ndarray) -> dict[str, np.ndarray]:
    """Pieces of a genotype that are not the body."""
    end = len(genotype) - 70
    pieces = {(i, i + 64) for i in (*range(65), *range(end - 200, end + 7))} - {(end - 64, end)}
    pieces |= {(i, end) for i in range(end - 200, end - 64)} | {(end - 64, end + 35)}
    return {
        f"This is genotype[{i}:{j}]. The body lies before the last 70 numbers, and has 64.":
        genotype[i:j]
        for i, j in sorted(pieces | {(end - 64, end + 70), (end, end + 70)})
    }  # fmt: skip


@lru_cache(maxsize=1000)
def returns_of(text: str, genotype: bytes, seed: int, episodes: int) -> np.ndarray:
    """The return of a robot in each episode; kept, as checks are repeated to find causes."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "trial.ini"
        file.write_text(text)
        return SavedRobot(file, np.frombuffer(genotype)).evaluate(seed, episodes)


def pair_returns(
    text: str, walkers: np.ndarray, episodes: int, i: int, j: int, seed: int
) -> np.ndarray:
    """The return of brain i in body j in each episode."""
    parts = walkers[i, :-134], walkers[j, -134:-70], walkers[i, -70:]
    return returns_of(text, np.concatenate(parts).tobytes(), seed, episodes)


def own_returns(text: str, walkers: np.ndarray, seed: int, episodes: int) -> np.ndarray:
    """The return of each brain in each body in each episode."""
    each = range(len(walkers))
    return np.array([[pair_returns(text, walkers, episodes, i, j, seed) for j in each]
                     for i in each])  # fmt: skip


def other_seed(
    got: float, text: str, walkers: np.ndarray, seed: int, episodes: int, i: int, j: int
) -> str:
    """Say with which other seed brain i in body j has this mean return, "" if with none."""
    near = (*range(seed + 1, seed + 5), seed + episodes, seed - 1, 0, 1)
    for other in dict.fromkeys(each for each in near if each >= 0 and each != seed):
        mean = pair_returns(text, walkers, episodes, i, j, other).mean()
        if abs(got - mean) < 1e-5 * max(1, abs(mean)):
            return f" Your number is that of the seed {other}: all pairs have the seed {seed}."
    return ""


@np.errstate(all="ignore")
def wrong_matrices(
    returns: np.ndarray, text: str, walkers: np.ndarray, seed: int, episodes: int
) -> dict:
    """What slips make of a matrix; other seeds for two walkers only, as they take time."""
    n = len(walkers)
    rows = {
        "": lambda m: m,
        "A row holds one number again and again: each brain stays in its own body.":
        lambda m: np.repeat(np.diagonal(m)[:, None], n, axis=1),
        "A column holds one number again and again: each body keeps its own brain.":
        lambda m: np.repeat(np.diagonal(m)[None], n, axis=0),
        "A pair gets the number of the pair with the roles exchanged: the half below the "
        "diagonal mirrors the one above.": lambda m: np.triu(m) + np.triu(m, 1).T,
        "A pair gets the number of the pair with the roles exchanged: the half above the "
        "diagonal mirrors the one below.": lambda m: np.tril(m) + np.tril(m, -1).T,
        "Rows are brains and columns are bodies: the two are exchanged.": lambda m: m.T,
        "The diagonal is left out: each brain is evaluated in its own body, too.":
        lambda m: m - np.diag(np.diagonal(m)),
        "Only the diagonal is evaluated.": lambda m: np.diag(np.diagonal(m)),
        "The returns of a row are added up from pair to pair.": lambda m: np.cumsum(m, axis=1),
        "The returns of a column are added up from pair to pair.": lambda m: np.cumsum(m, axis=0),
        "The brain's return in its own body is subtracted: that belongs to `loss`.":
        lambda m: m - np.diagonal(m)[:, None],
        "The body's return with its own brain is subtracted: that belongs to `loss`.":
        lambda m: m - np.diagonal(m)[None],
        "Each row is divided by the brain's return in its own body.":
        lambda m: m / np.diagonal(m)[:, None],
        "Each column is divided by the body's return with its own brain.":
        lambda m: m / np.diagonal(m)[None],
        "The matrix holds whole numbers: the fractions are cut off.": np.trunc,
        "The columns stand in the opposite order.": lambda m: m[:, ::-1],
        "The rows stand in the opposite order.": lambda m: m[::-1],
        "Each row holds the returns of the first brain.": lambda m: m[[0] * n],
        "Each row holds the returns of the last brain.": lambda m: m[[-1] * n],
        "Each column holds the returns with the first body.": lambda m: m[:, [0] * n],
        "Each column holds the returns with the last body.": lambda m: m[:, [-1] * n],
        "The returns below 0 count as 0.": lambda m: np.maximum(m, 0),
        "The returns have lost their signs.": np.abs,
        "Only the half above the diagonal is evaluated.": np.triu,
        "Only the half below the diagonal is evaluated.": np.tril,
        "Each row is put in order, but column j belongs to body j.": lambda m: np.sort(m, axis=1),
    }  # fmt: skip
    seeds = {
        "Each row has a seed of its own, but all pairs have the same.": lambda i, j: i,
        "Each column has a seed of its own, but all pairs have the same.": lambda i, j: j,
        "Each pair has a seed of its own, but all have the same.": lambda i, j: n * i + j,
        "The diagonal has another seed than the rest.": lambda i, j: int(i != j),
        "The seed that is given is not used: this is what the seed 0 gives.": lambda i, j: -seed,
        "The seed that is given is not used: this is what the seed 1 gives.":
        lambda i, j: 1 - seed,
        "The seed is one more than the one that is given.": lambda i, j: 1,
        "The seed grows by the number of episodes from row to row: all pairs have the same.":
        lambda i, j: i * episodes,
        "The seed grows by the number of episodes from pair to pair: all have the same.":
        lambda i, j: (n * i + j) * episodes,
        "The seed grows by the number of episodes from column to column: all have the same.":
        lambda i, j: j * episodes,
    }  # fmt: skip
    made: dict[str, np.ndarray] = {}
    if n == 2:
        evaluated = cache(partial(pair_returns, text, walkers, episodes))

        def with_seeds(other: Callable) -> np.ndarray:
            pairs = [[evaluated(i, j, seed + other(i, j)) for j in range(n)] for i in range(n)]
            return np.array(pairs)

        made = {said: with_seeds(other) for said, other in seeds.items()}
        made["Each robot is evaluated in one episode more than asked for."] = np.array(
            [[pair_returns(text, walkers, episodes + 1, i, j, seed) for j in range(n)]
             for i in range(n)]
        )  # fmt: skip
        strangers = np.concatenate([walkers[:, :-70], walkers[::-1, -70:]], axis=1)
        foreign = np.array([[pair_returns(text, strangers, episodes, i, j, seed)
                             for j in range(n)] for i in range(n)])  # fmt: skip
        made["Means and deviations come from the walker that gives the body: they belong to the "
             "brain."] = np.where(np.eye(n, dtype=bool)[..., None], returns, foreign)  # fmt: skip
        said = (
            "Each episode has a seed of its own: `evaluate` gets the seed once, and all episodes."
        )
        first = [with_seeds(lambda i, j, k=k: k)[:, :, :1] for k in range(episodes)]
        made[said] = np.concatenate(first, axis=2)
    return slips(
        lambda returns, rows, summary: rows(summary(returns)),
        returns={"": returns} | made,
        rows=rows,
        summary={
            "": lambda r: r.mean(axis=2),
            "Only the first episode counts, not the mean.": lambda r: r[:, :, 0],
            "Only the last episode counts, not the mean.": lambda r: r[:, :, -1],
            "The best episode is taken, not the mean.": lambda r: r.max(axis=2),
            "The worst episode is taken, not the mean.": lambda r: r.min(axis=2),
            "The median of the episodes is taken, not the mean.": lambda r: np.median(r, axis=2),
            "The episodes are added up, not averaged.": lambda r: r.sum(axis=2),
            "This is the standard deviation of the episodes, not the mean.":
            lambda r: r.std(axis=2),
            "The sum of the episodes is divided by one more than their number.":
            lambda r: r.sum(axis=2) / (r.shape[2] + 1),
        },
    )  # fmt: skip


@np.errstate(all="ignore")
def wrong_losses(matrix: np.ndarray, key: str) -> dict:
    """What mistakes make of a part of the answer."""
    n, own, others = len(matrix), np.diagonal(matrix), matrix[~np.eye(len(matrix), dtype=bool)]
    if key == "own":
        return {
            "This is the other diagonal.": np.diagonal(matrix[:, ::-1]).mean(),
            "The diagonal is added up, not averaged.": own.sum(),
            "This is the mean of the whole matrix.": matrix.mean(),
            "These are the best returns of the rows: the diagonal is asked for.":
            matrix.max(axis=1).mean(),
            "These are the best returns of the columns: the diagonal is asked for.":
            matrix.max(axis=0).mean(),
            "This is the median of the diagonal, not the mean.": np.median(own),
            "This is the best one of the diagonal, not the mean.": own.max(),
            "This is the first one of the diagonal, not the mean.": own[0],
            "The sum of the diagonal is divided by all places of the matrix.": own.sum() / n**2,
            "The sum of the diagonal is divided by n - 1.": own.sum() / (n - 1),
            "This is the mean of the first row, not of the diagonal.": matrix[0].mean(),
            "The whole diagonal is given, but its mean is asked for.": own,
            "The foreign returns are subtracted: `own` is the mean of the diagonal alone.":
            own.mean() - others.mean(),
            "These are the foreign returns: own and foreign are exchanged.": others.mean(),
        }  # fmt: skip
    if key == "foreign":
        upper, lower = matrix[np.triu_indices(n, 1)], matrix[np.tril_indices(n, -1)]
        return {
            "The diagonal is counted among the foreign places.": matrix.mean(),
            "The foreign returns are divided by the number of all places: there are n (n - 1) "
            "foreign ones.": others.sum() / n**2,
            "The foreign returns are divided by n: there are n (n - 1) foreign places.":
            others.sum() / n,
            "The foreign returns are divided by n - 1: there are n (n - 1) foreign places.":
            others.sum() / (n - 1),
            "The foreign returns are divided by one less than all places, but not by n (n - 1).":
            others.sum() / (n**2 - 1),
            "The foreign returns are divided by half of the foreign places: there are n (n - 1).":
            others.sum() / (n * (n - 1) / 2),
            "Only the places above the diagonal are counted.": upper.mean(),
            "Only the places below the diagonal are counted.": lower.mean(),
            "The foreign returns are added up, not averaged.": others.sum(),
            "This is the median of the foreign places, not the mean.": np.median(others),
            "This is the best foreign return, not the mean.": others.max(),
            "The other diagonal is left out, not the one of the walkers themselves.":
            matrix[~np.eye(n, dtype=bool)[::-1]].mean(),
            "These are the own returns: own and foreign are exchanged.": own.mean(),
            "This is the loss, own minus foreign: the foreign mean itself is asked for.":
            own.mean() - others.mean(),
            "The mean of the diagonal is subtracted from the mean of the whole matrix: take the "
            "mean over all other places.": matrix.mean() - own.mean(),
            "The sum of the diagonal is not subtracted from that of the matrix.":
            matrix.sum() / (n * n - n),
            "The best return of each row is averaged: all foreign places count.":
            matrix.max(axis=1).mean(),
            "This is the mean of the places next to the diagonal: all foreign places count.":
            np.diagonal(matrix, 1).mean(),
        }  # fmt: skip
    table = matrix.T if key == "bodies" else matrix
    rest = table[~np.eye(n, dtype=bool)].reshape(n, n - 1)
    if key == "at home":
        return {
            "This is the share of the brains, not their number.": np.mean(own > rest.max(axis=1)),
            "Brains are rows: this counts columns.":
            np.sum([own[i] > max(np.delete(matrix[:, i], i)) for i in range(n)]),
            "A brain must beat each other place of its row, not their mean.":
            np.sum(own > rest.mean(axis=1)),
            "A brain must beat all other places of its row, not just one.":
            np.sum(own > rest.min(axis=1)),
            "A brain that does as well in another body is not at home: it must do better.":
            np.sum(own >= rest.max(axis=1)),
            "The first of equal returns counts as the best: a brain must do better than in all "
            "others.": np.sum(matrix.argmax(axis=1) == np.arange(n)),
            "Foreign bodies are counted in which a brain does worse: count brains.":
            np.sum(own[:, None] > matrix),
            "Foreign places with less than the diagonal's return of their column are counted.":
            np.sum(own > matrix),
            "Brains that do worse at home than in each other body are counted.":
            np.sum(own < rest.min(axis=1)),
            "Brains that are not at home are counted.": np.sum(own <= rest.max(axis=1)),
            "The best return of the whole matrix is compared: each brain has its own row.":
            np.sum(own >= matrix.max()),
            "A brain is at home if its loss is above 0: it must beat each of the others.":
            np.sum(own - rest.mean(axis=1) > 0),
            "A brain must beat each other place of its row, not the mean of all foreign places.":
            np.sum(own > others.mean()),
            "A brain must beat the others of its own row, not all foreign places.":
            np.sum(own > others.max()),
            "A brain must beat each other place of its row, not their median.":
            np.sum(own > np.median(rest, axis=1)),
            "0 stands on the diagonal, which beats returns below 0.":
            np.sum(own > (matrix * (1 - np.eye(n))).max(axis=1)),
            "A brain must be the best in its row only: row and column are both asked here.":
            np.sum((own > rest.max(axis=1)) & (own > [
                max(np.delete(matrix[:, i], i)) for i in range(n)])),
            "The numbers of the brains are added up: count them.":
            np.flatnonzero(own > rest.max(axis=1)).sum(),
        }  # fmt: skip
    with np.errstate(all="ignore"):
        unequal = np.where(table == own[:, None], np.nan, table)
        unequal = np.nansum(unequal, axis=1) / np.sum(np.isfinite(unequal), axis=1)
    return {
        "The returns of a column are subtracted for a row: own - matrix pairs them column by "
        "column.": (own - table).sum(axis=1) / (n - 1),
        "The own place is counted among the others.": own - table.mean(axis=1),
        "The others are added up and divided by n: there are n - 1 others.":
        own - rest.sum(axis=1) / n,
        "The others are added up, not averaged.": own - rest.sum(axis=1),
        "The mean of all foreign places is subtracted, not that of the row or column.":
        own - others.mean(),
        "The best of the others is subtracted, not their mean.": own - rest.max(axis=1),
        "The loss is divided by the own return.":
        1 - rest.mean(axis=1) / np.where(own, own, np.nan),
        "This is the mean of the others: subtract it from the own return.": rest.mean(axis=1),
        "Rows are brains and columns bodies: the two are exchanged.":
        own - (table.sum(axis=0) - own) / (n - 1),
        "Places that equal the own return are left out, too: leave out the own place alone.":
        own - unequal,
        "The first place of each line is left out, not the own one.":
        own - table[:, 1:].mean(axis=1),
        "The last place of each line is left out, not the own one.":
        own - table[:, :-1].mean(axis=1),
        "The loss has lost its sign: it is below 0 where a foreign one does better.":
        np.abs(own - rest.mean(axis=1)),
        "The loss is the other way round: subtract the others from the own return.":
        rest.mean(axis=1) - own,
        "The worst of the others is subtracted, not their mean.": own - rest.min(axis=1),
        "The median of the others is subtracted, not their mean.": own - np.median(rest, axis=1),
        "One number for each is asked for, not the mean of all.": np.mean(own - rest.mean(axis=1)),
        "One number for each is asked for, not the sum of all.": np.sum(own - rest.mean(axis=1)),
        "The mean of the own returns is used for each: take its own return.":
        own.mean() - rest.mean(axis=1),
        "A loss below 0 counts as 0: keep it.": np.maximum(own - rest.mean(axis=1), 0),
        "The others' mean is divided by, not subtracted.": own / rest.mean(axis=1),
        "The loss is divided by the mean of the others.": own / rest.mean(axis=1) - 1,
        "The others are added up and divided by n - 2: there are n - 1 others.":
        own - rest.sum(axis=1) / max(n - 2, 0.5),
        "0 stands on the own place and is counted among the others.":
        own - (table * (1 - np.eye(n))).sum(axis=1) / n,
        "The best one of the line is taken for the own return.":
        table.max(axis=1) - rest.mean(axis=1),
        "The best of the whole line is subtracted, the own one included.":
        own - table.max(axis=1),
        "The whole line is added up, the own return included.":
        own - table.sum(axis=1) / (n - 1),
        "The loss is added up over the others: take their mean.":
        ((n - 1) * own - rest.sum(axis=1)),
    }  # fmt: skip


def changed_losses(matrix: np.ndarray, key: str) -> dict:
    """What comes of a changed matrix."""
    n, own = len(matrix), np.diagonal(matrix)
    no_last, no_first = np.arange(n) < n - 1, np.arange(n) > 0
    off = ~np.eye(n, dtype=bool)
    with np.errstate(all="ignore"):
        other = {
            "The matrix is divided by its largest value first.": matrix / matrix.max(),
            "The matrix is divided by its largest amount first.": matrix / np.abs(matrix).max(),
            "The matrix is divided by the own returns of the rows first.": matrix / own[:, None],
            "The matrix is divided by the own returns of the columns first.": matrix / own,
            "The mean of the matrix is subtracted first.": matrix - matrix.mean(),
            "The returns have lost their signs.": np.abs(matrix),
            "The returns are rounded first.": matrix.round(),
            "Returns below 0 count as 0.": np.maximum(matrix, 0),
            "Each row is sorted first, but its places belong to bodies.": np.sort(matrix, axis=1),
            "Each column is sorted first.": np.sort(matrix, axis=0),
            "The rows are turned around.": matrix[:, ::-1],
            "Rows and columns are exchanged.": matrix.T,
        }
        if n > 2:
            other["The last walker is left out."] = matrix[:-1, :-1]
            other["The first walker is left out."] = matrix[1:, 1:]
        if n > 3:
            other["Only the first three walkers count: there are n."] = matrix[:3, :3]
        found = {text: own_loss(each, key) for text, each in other.items()}
        if key == "foreign":
            found |= {
                "There are n (n - 1) foreign places, not always 6.": matrix[off].sum() / 6,
                "The last row is left out.": matrix[off & no_last[:, None]].mean(),
                "The first row is left out.": matrix[off & no_first[:, None]].mean(),
                "The last column is left out.": matrix[off & no_last].mean(),
                "The first column is left out.": matrix[off & no_first].mean(),
            }
        if key in ("brains", "bodies"):
            table = matrix if key == "brains" else matrix.T
            rest = table[off].reshape(n, n - 1)
            found |= {
                "There are n - 1 others, not always 2.": own - rest.sum(axis=1) / 2,
                "The loss of all together is given for each: own minus foreign.":
                0 * own + own.mean() - rest.mean(),
            }  # fmt: skip
    return found


def reason(matrix: np.ndarray, key: str, *place: int) -> str:
    """What the text says about a part of the answer, with its numbers."""
    n, own = len(matrix), np.diagonal(matrix)
    if key == "own":
        return f"The diagonal is {own.round(2).tolist()}: take the mean."
    if key == "foreign":
        return f"There are {n * n - n} places that are not on the diagonal: take their mean."
    if key == "at home":
        best = [max(np.delete(row, i)) for i, row in enumerate(matrix)]
        return (
            f"At home the brains have {own.round(2).tolist()}; the best of the others in each row "
            f"is {np.round(best, 2).tolist()}. Count where the first is greater."
        )
    line, what = (matrix[place[0]], "row") if key == "brains" else (matrix[:, place[0]], "column")
    others = np.delete(line, place[0]).round(2).tolist()
    return (
        f"{key}[{place[0]}] is {own[place[0]]:.4g}, on the diagonal, minus the mean of the others "
        f"in its {what}: {others}."
    )


def own_loss(matrix: np.ndarray, key: str):
    n = len(matrix)
    others = [[matrix[i, j] for j in range(n) if j != i] for i in range(n)]
    if key == "own":
        return np.mean([matrix[i, i] for i in range(n)])
    if key == "foreign":
        return np.mean(others)
    if key == "brains":
        return [matrix[i, i] - np.mean(others[i]) for i in range(n)]
    if key == "bodies":
        return [
            matrix[i, i] - np.mean([matrix[j, i] for j in range(n) if j != i]) for i in range(n)
        ]
    return sum(matrix[i, i] > max(others[i]) for i in range(n))
