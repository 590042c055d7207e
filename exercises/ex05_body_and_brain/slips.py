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
    return {
        f"The {what} are read from place {i} on, but they begin at place {first}.": made(i)
        for i in places
    }


def wrong_sizes(p: np.ndarray, first: int, nominal: float) -> dict:
    """Slips in lengths (first: 0) or thicknesses (1)."""

    def at(i: int) -> np.ndarray:
        return scaled(p[i : i + 22 : 2], nominal)

    other = elsewhere("lengths" if nominal > 0.5 else "thicknesses", first, at, 22)
    return slips(
        lambda places, formula: formula(places),
        places={
            "": p[first:22:2],
            "Eleven parameters in a row are read here, but lengths and thicknesses should take "
            "turns.":
            p[11 * first : 11 * first + 11],
            "The wrong one of each two parameters is read: the first is for the length, the second "
            "for the thickness.":
            p[1 - first : 22 : 2],
        },
        formula={
            "": lambda q: scaled(q, nominal),
            "The parameters are cut off at -1 and 1, but sizes should use tanh.":
            lambda q: nominal * (1 + 0.9 * cut(q)),
            "tanh(0.9 p) is used instead of 0.9 tanh p.":
            lambda q: nominal * (1 + np.tanh(0.9 * q)),
            "The factor 0.9 before tanh is left out.": lambda q: nominal * (1 + np.tanh(q)),
            "The 1 in 1 + 0.9 tanh p is left out.": lambda q: nominal * 0.9 * np.tanh(q),
            f"{nominal} multiplies the 1 only, but it should multiply 1 + 0.9 tanh p.":
            lambda q: nominal + 0.9 * np.tanh(q),
            "0.9 (1 + tanh p) is used instead of 1 + 0.9 tanh p.":
            lambda q: nominal * 0.9 * (1 + np.tanh(q)),
            "0.9 tanh p is subtracted from 1, but it should be added.":
            lambda q: scaled(-q, nominal),
            "tanh is left out: the parameters themselves are used.":
            lambda q: nominal * (1 + 0.9 * q),
            "The nominal size is multiplied by 0.1 + 1.8 tanh p instead of 1 + 0.9 tanh p.":
            lambda q: nominal * (0.1 + 1.8 * np.tanh(q)),
            "tanh(1 + 0.9 p) is used instead of 1 + 0.9 tanh p.":
            lambda q: nominal * np.tanh(1 + 0.9 * q),
            f"The factor {nominal} is left out.": lambda q: 1 + 0.9 * np.tanh(q),
            f"The other one of the factors 0.8 and 0.2 is used instead of {nominal}.":
            lambda q: scaled(q, 0.16 / nominal),
            "tan p is used instead of tanh p.": lambda q: nominal * (1 + 0.9 * np.tan(q)),
            "arctan p, the inverse tangent, is used instead of tanh p.":
            lambda q: nominal * (1 + 0.9 * np.arctan(q)),
            "sin p is used instead of tanh p.": lambda q: nominal * (1 + 0.9 * np.sin(q)),
            "The logistic function 1 / (1 + exp(-p)) is used instead of tanh p.":
            lambda q: nominal * (1 + 0.9 / (1 + np.exp(-q))),
            "tanh(p / 2), the same as 2 / (1 + exp(-p)) - 1, is used instead of tanh p.":
            lambda q: nominal * (1 + 0.9 * np.tanh(q / 2)),
            "tanh(2 p) is used instead of tanh p.": lambda q: nominal * (1 + 0.9 * np.tanh(2 * q)),
            "The sign of tanh p is lost, but below p = 0 it should be negative.":
            lambda q: nominal * (1 + 0.9 * np.abs(np.tanh(q))),
            "0.9 + tanh p is used instead of 1 + 0.9 tanh p.":
            lambda q: nominal * (0.9 + np.tanh(q)),
            f"{nominal} multiplies p inside tanh, but it should multiply 1 + 0.9 tanh p.":
            lambda q: 1 + 0.9 * np.tanh(nominal * q),
            f"{nominal} multiplies p inside tanh, too, but it should multiply only 1 + 0.9 tanh p.":
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
            "The density varies by 80 %, that is by 4, but it should vary by 0.8.":
            lambda q: 5 + 4 * np.tanh(q),
            "The density varies by 90 %, as the sizes do, but it should vary by 0.8.":
            lambda q: scaled(q, 5),
            "The parameters of the densities are cut off at -1 and 1, but they should go through "
            "tanh.":
            lambda q: 5 + 0.8 * cut(q),
            "In the densities tanh is left out: the parameters themselves are used.":
            lambda q: 5 + 0.8 * q,
            "The density is 0.8 + 5 tanh p instead of 5 + 0.8 tanh p.":
            lambda q: 0.8 + 5 * np.tanh(q),
            "The density varies by 0.9 instead of 0.8.": lambda q: 5 + 0.9 * np.tanh(q),
            "The factor 0.8 before the tanh of the density is left out.": lambda q: 5 + np.tanh(q),
            "The density of all segments is 5: the 0.8 tanh p is left out.": lambda q: 5 + 0 * q,
        },
        product={
            "": lambda long, thick, dense: long * thick * dense,
            "The density is left out.": lambda long, thick, dense: long * thick,
            "These are the densities: length and thickness are left out.":
            lambda long, thick, dense: dense,
            "The thickness is left out.": lambda long, thick, dense: long * dense,
            "The length is left out.": lambda long, thick, dense: thick * dense,
            "The segments are round rods here, but they should be flat, with the area length x "
            "thickness.":
            lambda long, thick, dense: np.pi * (thick / 2) ** 2 * long * dense,
            "Length and thickness are added, but they should be multiplied.":
            lambda long, thick, dense: (long + thick) * dense,
            "Length x thickness is divided by the density, but it should be multiplied by it.":
            lambda long, thick, dense:
            long * thick / dense,
            "Length x thickness is multiplied by the 5 alone, but it should be multiplied by 5 + "
            "0.8 tanh p.":
            lambda long, thick, dense: long * thick * 5 + dense - 5,
            "The mean of all densities is used, but each segment should have its own.":
            lambda long, thick, dense: long * thick * dense.mean(),
            "The thickness is a factor twice, but it should be one only once: the world is flat.":
            lambda long, thick, dense: long * thick**2 * dense,
            "The length is a factor twice, but it should be one only once.":
            lambda long, thick, dense: long**2 * thick * dense,
            "Half of the thickness is taken, but the area should be length x thickness.":
            lambda long, thick, dense: long * thick / 2 * dense,
            "The segments are as long and thick as at p = 0 here, but they should have their own "
            "sizes.":
            lambda long, thick, dense: 0.16 * dense,
            "The masses are added up from segment to segment, but each mass by itself is asked "
            "for.":
            lambda long, thick, dense: np.cumsum(long * thick * dense),
            "The densities stand in the opposite order.":
            lambda long, thick, dense: long * thick * dense[::-1],
            "This is the sum of the masses, but one mass for each segment is asked for.":
            lambda long, thick, dense: np.sum(long * thick * dense),
        },
    )  # fmt: skip


def wrong_cuts() -> dict:
    """Slips in what is done with parameters q of angles and their scale."""
    return {
        "": lambda q, scale: scale * cut(q),
        "The parameters of the angles are not cut off at -1 and 1, but they should be.":
        lambda q, scale: scale * q,
        "The parameters of the angles are put through tanh, but they should be cut off at -1 and "
        "1.":
        lambda q, scale: scale * np.tanh(q),
        "The angles are cut off at -1 and 1 after they are scaled, but the parameters should be "
        "cut off.":
        lambda q, scale: cut(scale * q),
        "The parameters are cut off at 0 and 1 instead of -1 and 1.":
        lambda q, scale: scale * q.clip(0, 1),
        "The parameters are cut off at -0.5 and 0.5 instead of -1 and 1.":
        lambda q, scale: scale * q.clip(-0.5, 0.5),
        "The angles reach their largest amount at p = -0.5 and 0.5 already instead of -1 and 1.":
        lambda q, scale: 2 * scale * q.clip(-0.5, 0.5),
        "The parameters are cut off at plus and minus the largest angle instead of -1 and 1.":
        lambda q, scale: scale * q.clip(-scale, scale),
        "The parameters are cut off at plus and minus the largest angle and not scaled at all.":
        lambda q, scale: q.clip(-scale, scale),
        "The parameters are cut off at 1 only, but they should be cut off at -1, too.":
        lambda q, scale: scale * np.minimum(q, 1),
        "The parameters are cut off only below, at -1, but they should be cut off at 1, too.":
        lambda q, scale: scale * np.maximum(q, -1),
        "Parameters beyond -1 and 1 come back on the other side, but they should be cut off.":
        lambda q, scale: scale * ((q + 1) % 2 - 1),
        "Parameters beyond -1 and 1 become 0, but they should become -1 and 1.":
        lambda q, scale: scale * np.where(np.abs(q) > 1, 0, q),
        "The parameters are divided by the largest amount among them, but each should be cut off.":
        lambda q, scale: scale * q / np.maximum(np.abs(q).max(), 1e-9),
        "Only the sign of a parameter is used, but its amount up to 1 should count, too.":
        lambda q, scale: scale * np.sign(q),
        "The parameters are put through sine, but they should be cut off at -1 and 1.":
        lambda q, scale: scale * np.sin(q),
        "The parameters have lost their signs.": lambda q, scale: scale * cut(np.abs(q)),
        "The angles are cut off at -pi and pi, but the parameters should be cut off at -1 and 1.":
        lambda q, scale: (scale * q).clip(-np.pi, np.pi),
        "The formula of sizes, 1 + 0.9 tanh p, is used, but angles should be cut off and scaled.":
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
            "The default angles are scaled by pi / 2, as limits are, instead of 3 pi / 4.":
            np.pi / 2,
            "The angles are in degrees, but radians are asked for.": 135,
            "The scale is 3 / 4: pi is left out.": 0.75,
            "The scale is 4 pi / 3 instead of 3 pi / 4.": np.pi * 4 / 3,
            "The scale is pi / 4 instead of 3 pi / 4.": np.pi / 4,
            "The scale is 3 / (4 pi) instead of 3 pi / 4.": 0.75 / np.pi,
            "The scale is 3 pi / 2 instead of 3 pi / 4.": 1.5 * np.pi,
            "The scale is pi instead of 3 pi / 4.": np.pi,
            "The scale is 3 pi instead of 3 pi / 4.": 3 * np.pi,
            "Only the torso has the scale 3 pi / 4 and the others pi / 2, but all should have 3 pi "
            "/ 4.":
            np.append(0.75 * np.pi, np.full(10, np.pi / 2)),
            "The torso has the scale pi / 2, but all segments should have 3 pi / 4.":
            np.append(np.pi / 2, np.full(10, 0.75 * np.pi)),
        },
        sums={
            "": lambda a: a,
            "The angles are summed up from the torso on, but each default angle by itself is asked "
            "for.":
            np.cumsum,
            "The torso's default angle is 0, but it should come from a parameter, too.":
            lambda a: np.where(np.arange(11) == 0, 0, a),
            "The torso's default angle is left out, and the others stand one place too early.":
            lambda a: np.append(a[1:], 0),
            "The angle before it is subtracted from each angle, but each by itself is asked for.":
            lambda a: np.diff(a, prepend=0),
            "The torso's angle is added to all others, but each by itself is asked for.":
            lambda a: np.append(a[:1], a[1:] + a[0]),
            "The torso's angle is subtracted from all, but each by itself is asked for.":
            lambda a: a - a[0],
            "2 pi is added to negative angles, but they should stay negative.":
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
            "The first ten parameters are paired with the last ten, but the two of a joint stand "
            "side by side.":
            p[22:42].reshape(2, 10),
        },
        cutting=wrong_cuts(),
        scale={
            "": np.pi / 2,
            "The limits are scaled by 3 pi / 4, as default angles are, instead of pi / 2.":
            0.75 * np.pi,
            "The limits are in degrees, but radians are asked for.": 90,
            "The scale of the limits is pi instead of pi / 2.": np.pi,
            "The scale of the limits is pi / 4 instead of pi / 2.": np.pi / 4,
        },
        end={
            "": end,
            f"The {'first' if low else 'second'} limit of each joint is taken, but the {name} one "
            f"should be the {'smaller' if low else 'larger'} one of the two.": pick,
            "Lower and upper limits are exchanged.": far,
            "The amounts of the limits are compared, but the more negative one should be the lower "
            "one.":
            by_amount,
            "The amounts of the limits are compared, but the lower one should be the more negative "
            "one.":
            partial(by_amount, last=True),
            "The amount of one limit is taken to each side, but both limits can lie on one side.":
            lambda one, other: (-1 if low else 1) * np.abs(pick(one, other)),
            "The limits have lost their signs, but they can be negative.": amounts,
            "The limits are sorted from joint to joint, but each joint has its own two (axis=1).":
            lambda one, other: np.sort(one if low else other),
            "All 20 limits are sorted together, but each joint has its own two (axis=1).": paired,
            f"The {name} limit is {'minus the larger' if low else 'minus the smaller'} one, but "
            "each limit is a number of its own.": lambda one, other: -far(one, other),
            "The larger amount of the two limits is taken to both sides, but each limit is a "
            "number of its own.":
            lambda one, other: (-1 if low else 1) * np.maximum(np.abs(one), np.abs(other)),
            "The smaller amount of the two limits is taken to both sides, but each limit is a "
            "number of its own.":
            lambda one, other: (-1 if low else 1) * np.minimum(np.abs(one), np.abs(other)),
            "The second limit is added to the first one, but both should count from the default "
            "angle.":
            lambda one, other: end(one, one + other),
            "Half of the way between the two limits is taken to each side, but the limits are "
            "asked for.":
            lambda one, other: (-1 if low else 1) * np.abs(one - other) / 2,
            "The smallest or largest limit of all joints is taken, but each joint has its own two "
            "(axis=1).":
            lambda one, other: 0 * one + (np.min if low else np.max)([one, other]),
            "The first limit of each joint is compared with 0, but it should be compared with the "
            "second.":
            lambda one, other: end(one, 0),
            "The second limit of each joint is compared with 0, but it should be compared with the "
            "first.":
            lambda one, other: end(other, 0),
            "A lower limit is at most 0 and an upper one at least 0 here, but both can lie on one "
            "side.":
            lambda one, other: end(end(one, other), 0),
            "A lower limit is at least 0 and an upper one at most 0 here, but the other way is "
            "possible, too.":
            lambda one, other: far(end(one, other), 0),
        },
        added={
            "": 0,
            "The default angle is added to the limits, but they should count from the default "
            "angle.":
            angles(p)[1:],
            "The default angle of the segment before is added to the limits, but no angle should "
            "be.":
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
        "y points downwards, but it should point upwards.": own * [1, -1],
        "x points to the left, but it should point to the right.": own * [-1, 1],
        "The segments are turned around (0, 0) after they are moved, but each should be turned "
        "around its own beginning.":
        np.stack([turned.real, turned.imag], axis=2),
        "The corners are mixed up as if four lists of 11 were reshaped, but np.stack with axis=1 "
        "is needed.":
        own.swapaxes(0, 1).reshape(11, 4, 2),
    } | {"x and y of each corner are exchanged.": own[..., ::-1]} | {
        "The corners of a segment come in the wrong order "
        f"{', '.join(CORNERS[k] for k in order)}.": own[:, order]
        for order in permutations(range(4)) if order != (0, 1, 2, 3)
    }  # fmt: skip
    return orders | slips(
        drawn,
        heading={
            "": np.cumsum(bends),
            "Each default angle is taken for the heading, but it should be added to the heading "
            "before.":
            bends,
            "The torso's default angle is left out of all headings, but it should be in all of "
            "them.":
            np.cumsum(flat),
            "The torso's angle turns clockwise, but it should turn counter-clockwise.":
            np.cumsum(bends) - 2 * bends[0],
            "The torso's angle is counted twice in all headings, but it should be counted once.":
            np.cumsum(bends) + bends[0],
            "The torso's angle counts for the torso alone, but it should be in all headings.":
            np.append(bends[0], np.cumsum(bends[1:])),
            "A segment's own angle is left out of its heading, but it should be in it.":
            np.cumsum(bends) - bends,
            "The angles turn clockwise, but they should turn counter-clockwise.": -np.cumsum(bends),
            "The headings are cut off at -pi and pi, but they may go beyond.":
            np.cumsum(bends).clip(-np.pi, np.pi),
            "A heading is the sum of the last two angles only, but all up to its own should be "
            "summed up.":
            bends + np.append(0, bends[:-1]),
            "Half of a segment's own angle is left out of its heading, but all of it should be in "
            "it.":
            np.cumsum(bends) - bends / 2,
            "The angles are summed up twice, but they should be summed up once.":
            np.cumsum(np.cumsum(bends)),
            "The headings are converted from degrees to radians, but they are in radians already.":
            np.radians(np.cumsum(bends)),
            "The headings are converted to degrees, but np.cos takes radians.":
            np.degrees(np.cumsum(bends)),
            "The joints are at their lower limits here, but at rest they should be at their "
            "default angles.":
            np.cumsum(bends + low),
            "The joints are at their upper limits here, but at rest they should be at their "
            "default angles.":
            np.cumsum(bends + high),
            "The joints are in the middle of their limits here, but at rest they should be at "
            "their default angles.":
            np.cumsum(bends + (low + high) / 2),
            "The angles after the torso's are subtracted from it, but they should be added.":
            2 * bends[0] - np.cumsum(bends),
            "The angles are summed up from the last segment on, but the torso's should come first.":
            np.cumsum(bends[::-1]),
            "The headings are means of the angles instead of sums.":
            np.cumsum(bends) / (np.arange(11) + 1),
            "The torso's angle is counted twice from segment 1 on, and each other one a segment "
            "too late.":
            np.append(bends[0], bends[0] + np.cumsum(bends)[:-1]),
        },
        along={
            "": lambda a: np.exp(1j * a),
            "Sine and cosine of the direction along a segment are exchanged.":
            lambda a: np.sin(a) + 1j * np.cos(a),
            "A segment goes to x - l cos instead of x + l cos.": lambda a: -np.exp(-1j * a),
            "A segment goes to y - l sin instead of y + l sin.": lambda a: np.exp(-1j * a),
            "A segment goes against its heading, but it should go along it.":
            lambda a: -np.exp(1j * a),
            "A segment lies along the heading of the one before (the torso along 0) instead of its "
            "own.":
            lambda a: np.exp(1j * np.append(0, a[:-1])),
            "A segment other than the torso lies along the heading of the one before it instead of "
            "its own.":
            lambda a: np.exp(1j * np.append(a[:1], a[:-1])),
            "A segment lies along its own default angle instead of its heading.":
            lambda a: np.exp(1j * bends),
            "All segments lie along the ground, but each should lie along its heading.":
            lambda a: 1 + 0j * a,
        },
        across={
            "": lambda a: 1j * np.exp(1j * a),
            "The direction across a segment is (sin, cos) instead of (-sin, cos).":
            lambda a: np.sin(a) + 1j * np.cos(a),
            "The direction across a segment is (cos, -sin) instead of (-sin, cos).":
            lambda a: np.cos(a) - 1j * np.sin(a),
            "The direction across a segment is (-cos, sin) instead of (-sin, cos).":
            lambda a: -np.cos(a) + 1j * np.sin(a),
            "The direction across a segment is the one along it, (cos, sin), instead of (-sin, "
            "cos).":
            lambda a: np.exp(1j * a),
            "The direction across a segment is always upwards, but it should turn with its "
            "heading.":
            lambda a: 1j + 0 * a,
            "The direction across a segment belongs to its default angle instead of its heading.":
            lambda a: 1j * np.exp(1j * bends),
            "The direction across a segment belongs to the heading of the one before (for the "
            "torso, to 0) instead of its own.":
            lambda a: 1j * np.exp(1j * np.append(0, a[:-1])),
            "The direction across a segment other than the torso belongs to the heading of the one "
            "before it instead of its own.":
            lambda a: 1j * np.exp(1j * np.append(a[:1], a[:-1])),
            "Half of the thickness is added in x and in y alike, but it should go in the direction "
            "across.":
            lambda a: 1 + 1j + 0 * a,
        },
        wide={
            "": thick / 2,
            "A segment reaches its whole thickness to each side, but it should reach half of it.":
            thick,
            "The thickness is left out: these are places on the middle line.": 0 * thick,
            "Half of the thickness is halved once more.": thick / 4,
            "All segments are as thick as the torso, but each should have its own thickness.":
            thick[0] / 2 + 0 * thick,
            "A segment has the thickness of the one before instead of its own.":
            np.append(thick[:1], thick[:-1]) / 2,
            "Half of the length is taken instead of half of the thickness.": long / 2,
        },
        joint={
            "": lambda side: 0,
            "The next segment begins at the left corner of the end, but it should begin at the end "
            "of the middle line.":
            lambda side: side,
            "The next segment begins at the right corner of the end, but it should begin at the "
            "end of the middle line.":
            lambda side: -side,
            "The thickness of a segment moves the next one on in x, but only the length should "
            "move it.":
            lambda side: thick,
        },
        first={
            "": lambda along: 0,
            "The middle of the torso lies at (0, 0), but its beginning should lie there.":
            lambda along: -along[0] / 2,
            "The end of the torso lies at (0, 0), but its beginning should lie there.":
            lambda along: -along[0],
            "Each segment has its middle where its beginning should be.": lambda along: -along / 2,
            "Each segment begins where it should end.": lambda along: along,
            "All segments begin at (0, 0), but each should begin at the end of the one before.":
            lambda along: -np.append(0, np.cumsum(along)[:-1]),
        },
    )  # fmt: skip


def wrong_mass(p: np.ndarray) -> dict:
    """Slips in "mass"."""
    long, thick = lengths(p), thicknesses(p)
    dense = masses(p) / long / thick
    mixed = "This is not the sum of the masses, but the mass of a single segment "
    return wrong_sums(masses(p), long * thick) | {
        f"{mixed}with the length of all together and a mean thickness and density.":
        long.sum() * thick.mean() * dense.mean(),
        f"{mixed}with the sums of all lengths, thicknesses and densities.":
        long.sum() * thick.sum() * dense.sum(),
        f"{mixed}with the area of all together and a mean density.":
        (long * thick).sum() * dense.mean(),
        f"{mixed}with a mean length, thickness and density.":
        long.mean() * thick.mean() * dense.mean(),
        f"{mixed}with the sums of all lengths and thicknesses and a mean density.":
        long.sum() * thick.sum() * dense.mean(),
        "The densities are added up, but masses are asked for.": dense.sum(),
    }  # fmt: skip


def wrong_sums(values: np.ndarray, other: np.ndarray) -> dict:
    """Slips in "length" or "mass"; other: the numbers that may be mistaken for these."""
    return slips(
        lambda values, summary: summary(values),
        values={
            "": values,
            "Another quantity is added up: thicknesses instead of lengths, or areas instead of "
            "masses.":
            other,
        },
        summary={
            "": np.sum,
            "This is the mean over the segments instead of the sum.": np.mean,
            "The torso is left out.": lambda v: v[1:].sum(),
            "The last segment is left out.": lambda v: v[:-1].sum(),
            "This is the largest one instead of the sum.": np.max,
            "This is the largest minus the smallest one instead of the sum.": np.ptp,
            "This is that of the torso alone instead of the sum over all segments.": lambda v: v[0],
            "The numbers are multiplied, but they should be added up.": np.prod,
            "This is the median instead of the sum.": np.median,
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
            "The thickness is left out: the middle line is measured instead of the corners.":
            middle,
            "Only the first corner of each segment is measured, but all four should count.":
            every[:, :1],
            "The ends of the segments are left out, but they should count, too.": every[:, ::3],
            "The beginnings of the segments are left out, but they should count, too.":
            every[:, 1:3],
            "The left corners of the segments are left out, but they should count, too.":
            every[:, :2],
            "The right corners of the segments are left out, but they should count, too.":
            every[:, 2:],
            "The torso is left out.": every[1:],
            "The last segment is left out.": every[:-1],
            "Only the torso is measured, but the whole body should be.": every[:1],
            "The middles of the segments are measured, but all their corners should be.":
            every.mean(axis=1, keepdims=True),
        },
        axis={"": axis, "Width and height are exchanged.": 1 - axis},
        summary={
            "": np.ptp,
            "This is the largest coordinate alone: the smallest should be subtracted from it.":
            np.max,
            "This is the largest amount of a coordinate instead of the largest minus the smallest "
            "coordinate.":
            lambda v: np.abs(v).max(),
            "The smallest coordinate is added to the largest, but it should be subtracted from it.":
            lambda v: v.max() + v.min(),
            "This is the smallest minus the largest coordinate, but it should be the other way "
            "round.":
            lambda v: -np.ptp(v),
            "This is the way from the first place to the last, but the corners in between should "
            "count, too.":
            lambda v: abs(v[-1] - v[0]),
            "This is a standard deviation instead of the largest minus the smallest coordinate.":
            np.std,
            "This is the smallest coordinate alone: it should be subtracted from the largest.":
            np.min,
            "This is minus the smallest coordinate: the largest is left out.":
            lambda v: -v.min(),
            "The mean is subtracted from the largest coordinate, but the smallest should be.":
            lambda v: v.max() - v.mean(),
            "This is twice the largest amount of a coordinate instead of the largest minus the "
            "smallest.":
            lambda v: 2 * np.abs(v).max(),
            "A smallest coordinate below 0 counts as 0, but it should be subtracted from the "
            "largest.":
            lambda v: v.max() - max(v.min(), 0),
        },
    ) | {
        "The ways of all segments are added up, but ways there and back overlap.":
        np.abs(middle[:, 1, axis] - middle[:, 0, axis]).sum(),
        "This is the largest extent of a single segment instead of that of the whole body.":
        np.ptp(every[..., axis], axis=1).max(),
        "The extents of the single segments are added up, but that of the whole body is asked for.":
        np.ptp(every[..., axis], axis=1).sum(),
        "Each of the four corners is measured by itself, and the mean taken, but all belong "
        "together.":
        np.ptp(every[..., axis], axis=0).mean(),
        "Each of the four corners is measured by itself, and the largest taken, but all belong "
        "together.":
        np.ptp(every[..., axis], axis=0).max(),
        "x and y are mixed, but width should be of x alone and height of y alone.": np.ptp(every),
        "x and y of the first corners are mixed, but width should be of x alone and height of y "
        "alone.":
        np.ptp(every[:, 0]),
        "This is the way from the first place to the last, but the corners in between should "
        "count, too.":
        abs(middle[-1, 1, axis]),
    }  # fmt: skip


def wrong_freedom(p: np.ndarray) -> dict:
    (low, high), raw = limits(p), p[22:42].reshape(10, 2)
    half = np.pi / 2
    return slips(
        lambda pair, summary: summary(*pair),
        pair={
            "": (low, high),
            "The parameters of the limits are not cut off at -1 and 1, but they should be, as in "
            "`joints`.":
            (half * raw.min(axis=1), half * raw.max(axis=1)),
            "The parameters of the limits are not multiplied by pi / 2, but they should be, as in "
            "`joints`.":
            tuple(np.sort(cut(raw).T, axis=0)),
            "The limits are not put in order here, but the smaller of the two should be the lower "
            "one.":
            tuple(half * cut(raw).T),
        },
        summary={
            "": lambda low, high: np.mean(high - low),
            "This is the sum over the joints instead of the mean.":
            lambda low, high: np.sum(high - low),
            "The sum is divided by 11, the number of segments, but there are 10 joints.":
            lambda low, high: np.sum(high - low) / 11,
            "The smallest of all limits is subtracted from the largest, but each joint should have "
            "its own difference.":
            lambda low, high: high.max() - low.min(),
            "Only the upper limits count here, but the lower ones should be subtracted from them.":
            lambda low, high: high.mean(),
            "Only the lower limits count here, but they should be subtracted from the upper ones.":
            lambda low, high: low.mean(),
            "The lower limit is added to the upper one, but it should be subtracted.":
            lambda low, high: np.mean(high + low),
            "The upper limit is subtracted from the lower one, but it should be the other way "
            "round.":
            lambda low, high: np.mean(low - high),
            "The amounts of the two limits are added, but both can lie on one side of the default "
            "angle.":
            lambda low, high: np.mean(np.abs(high) + np.abs(low)),
            "This is the largest freedom of a joint instead of the mean.":
            lambda low, high: np.max(high - low),
            "This is the median instead of the mean.": lambda low, high: np.median(high - low),
            "This is the freedom of the first joint instead of the mean.":
            lambda low, high: high[0] - low[0],
            "This is the mean amount of the limits, but lower ones should be subtracted from upper "
            "ones.":
            lambda low, high: np.mean(np.abs([low, high])),
            "This is half of the freedom, but the whole way from lower to upper limit is asked "
            "for.":
            lambda low, high: np.mean(high - low) / 2,
            "This is the smallest freedom of a joint instead of the mean.":
            lambda low, high: np.min(high - low),
            "Only joints that can move at all are counted, but the mean should be over all 10.":
            lambda low, high: np.mean((high - low)[high > low]) if (high > low).any() else 0.0,
            "This is the standard deviation of all limits instead of the mean freedom.":
            lambda low, high: np.std([low, high]),
            "This is the standard deviation over the joints instead of the mean.":
            lambda low, high: np.std(high - low),
            "The larger amount of a joint's two limits is taken instead of upper minus lower "
            "limit.":
            lambda low, high: np.mean(np.maximum(np.abs(low), np.abs(high))),
            "This is the largest minus the smallest angle that any joint can have instead of the "
            "mean freedom.":
            lambda low, high: np.ptp([angles(p)[1:] + low, angles(p)[1:] + high]),
            "The freedom is in degrees, but radians are asked for.":
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
        return f"{key}[{i}] should be {nominal} (1 + 0.9 tanh p[{at}]), with p[{at}] = {p[at]:.4g}."
    if key == "masses":
        return (
            f"masses[{i}] should be length {long[i]:.4g} x thickness {thick[i]:.4g} x density. The "
            f"density should be 5 + 0.8 tanh p[{53 + i}], with p[{53 + i}] = {p[53 + i]:.4g}."
        )
    cut_off = "cut off at -1 and 1"
    if key == "angles":
        return (
            f"angles[{i}] should be 3 pi / 4 times p[{42 + i}], {cut_off}, with p[{42 + i}] = "
            f"{p[42 + i]:.4g}."
        )
    if key in ("lower", "upper"):
        a, b = 22 + 2 * i, 23 + 2 * i
        return (
            f"The limits of joint {i} should be pi / 2 times p[{a}] and p[{b}], each {cut_off}, "
            f"with p[{a}] = {p[a]:.4g} and p[{b}] = {p[b]:.4g}. {key}[{i}] should be the "
            f"{'smaller' if key == 'lower' else 'larger'} of the two."
        )
    if key in ("width", "height"):
        values = corners(p)[:, :, int(key == "height")]
        return (
            f"{key} should be the largest {'y' if key == 'height' else 'x'} of all 44 corners, "
            f"{values.max():.4g}, minus the smallest, {values.min():.4g}."
        )
    if key == "freedom":
        return (
            f"freedom should be the mean of how far the joints can move, "
            f"{np.round(high - low, 3).tolist()}."
        )
    parts = long if key == "length" else masses(p)
    return f"{key} should be the sum of those of the segments, {np.round(parts, 3).tolist()}."


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
                "Both ends should have half the thickness of the segment itself to each side."
            )
        return (
            "the direction across is another one at its end than at its beginning, but it "
            "should be the same."
        )
    along = (got[1] + got[2] - got[0] - got[3]) / 2
    turned = [float(np.arctan2(each[1], each[0])) for each in (along, first)]
    return (
        f"it goes in the direction {turned[0]:.4g} from its beginning to its end, and "
        f"{turned[1]:.4g} from right to left. Both should follow from one heading, a right "
        "angle apart."
    )


def measured(got: np.ndarray, p: np.ndarray, *place: int) -> str:
    """What the corners of a submission show: the first thing that is not as the text says."""
    own = corners(p)
    turned = "the sum of all default angles up to its own (without full turns)"

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
            (end[k - 1], f"but segment {k - 1} ends at")
            if k
            else (np.zeros(2), "but it should begin at")
        )
        if np.abs(begin[k] - before).max() > 1e-3:
            where, before = begin[k].round(3).tolist(), before.round(3).tolist()
            if same_corners(got[k], own[k]):
                return f"The corners of segment {k} are right, but they come in the wrong order."
            return f"Segment {k} begins at {where} in your answer, {name} {before}."
        if np.abs(sides[0][k] - sides[1][k]).max() > 1e-3 or abs(along[k] @ across[k]) > 1e-3:
            said = f"The four corners of segment {k} in your answer make no rectangle"
            return f"{said}: {crooked(got[k])}"
        if left[k] < 0:
            return f"The right corners of segment {k} lie on its left side in your answer."
        if abs(thick[k] - right_thick[k]) > 1e-3:
            return (
                f"Segment {k} is {thick[k]:.4g} m thick in your answer, but it should be "
                f"{right_thick[k]:.4g} m, half of it to each side."
            )
        if abs(long[k] - right_long[k]) > 1e-3:
            return (
                f"Segment {k} is {long[k]:.4g} m long in your answer, but it should be "
                f"{right_long[k]:.4g} m."
            )
        if abs(np.exp(1j * heading[k]) - np.exp(1j * right_heading[k])) > 1e-3:
            bend = f" ({' + '.join(f'{a:.4g}' for a in angles(p)[: k + 1])})" * (0 < k < 6)
            return (
                f"Segment {k} has the heading {heading[k]:.4g} in your answer, but it should have "
                f"{right_heading[k]:.4g}{bend}, {turned}."
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
        "The parameters have the opposite signs here.": -p,
        "All parameters are cut off at -1 and 1 here, but only those of angles should be.": cut(p),
        "All parameters are put through tanh before they are used, but they should be used as they "
        "are.": np.tanh(p),
        "The parameters are rounded, but they should be used as they are.": p.round(),
        "The fractions of the parameters are cut off, but they should be used, too.": np.trunc(p),
        "All parameters are read in the opposite order.": p[::-1],
        "The parameters of the torso count as 0, but they should be used, too.": without(
            0, 1, 42, 53
        ),
        "The parameters of the last segment count as 0, but they should be used, too.": without(
            20, 21, 52, 63
        ),
        "The parameters of the first joint count as 0, but they should be used, too.": without(
            22, 23
        ),
        "The parameters of the last joint count as 0, but they should be used, too.": without(
            40, 41
        ),
        "The segments stand in the opposite order.": turned,
        "All parameters are read one place too late.": np.roll(p, -1),
        "All parameters are read one place too early.": np.roll(p, 1),
        "The parameters are divided by the largest amount, but they should be used as they are.": p
        / np.abs(p).max(),
        "The parameters have their mean subtracted, but they should be used as they are.": p
        - p.mean(),
        "The parameters of the densities are left out: all densities are 5.": without(
            *range(53, 64)
        ),
        "The parameters of the default angles are left out: all angles are 0.": without(
            *range(42, 53)
        ),
        "The parameters of the lengths are left out: all lengths are 0.8.": without(
            *range(0, 22, 2)
        ),
        "The parameters of the thicknesses are left out: all thicknesses are 0.2.": without(
            *range(1, 22, 2)
        ),
    }
    return {text: own(parameters) for text, parameters in other.items()}


def wrong_parts(brain: np.ndarray, body: np.ndarray, part: slice) -> dict[str, np.ndarray]:
    """What slips make of a part of a transplanted genotype; all have the length of the part."""
    one, other, end = brain[part], body[part], len(brain) - 70
    if part.stop == -70:
        return {
            "The body is still the one of the brain's own genotype.": one,
            "The foreign body is added to the brain's own body, but it should take its place.":
            one + other,
            "The mean of both bodies is taken, but the foreign body alone is asked for.":
            (one + other) / 2,
            "The body is all 0, but the foreign body is asked for.": 0 * one,
            "The first half of the body is still the one of the brain's own genotype.":
            np.append(one[:32], other[32:]),
            "The second half of the body is still the one of the brain's own genotype.":
            np.append(other[:32], one[32:]),
            "The last 64 numbers of the other genotype are taken, but 70 numbers follow its body.":
            body[-64:],
            "The first 64 numbers of the other genotype are taken, but its network stands there.":
            body[:64],
            "35 numbers follow the place from which the body is taken, but 70 should follow it.":
            body[-99:-35],
        } | {
            f"Only the {'last' if by > 0 else 'first'} {64 - abs(by)} numbers of the body are "
            "foreign, but all 64 should be, up to the last 70 of the genotype.": np.where(
                (np.arange(end - 64, end) >= end - 64 + by) & (np.arange(end - 64, end) < end + by),
                other, one)
            for by in (-35, -6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, 35)
        }  # fmt: skip
    if part.start == -70:
        return {
            "Means and deviations come from the body's genotype, but they should be those of the "
            "brain.":
            other,
            "The means come from the body's genotype, but they should be those of the brain.":
            np.append(other[:35], one[35:]),
            "The deviations come from the body's genotype, but they should be those of the brain.":
            np.append(one[:35], other[35:]),
            "Means and deviations are exchanged.": np.append(one[35:], one[:35]),
            "Means and deviations of both genotypes are averaged, but they should be those of the "
            "brain.":
            (one + other) / 2,
            "The means are 0 and the deviations 1, but they should be those of the brain.":
            np.repeat([0.0, 1.0], 35),
            "Means and deviations are all 0, but they should be those of the brain.": 0 * one,
        }  # fmt: skip
    return {
        "The network is that of the body's genotype, but it should be that of the brain's.": other,
        "The foreign body stands in the first 64 places, but the network should.": np.append(
            body[-134:-70], one[64:]
        ),
        "The networks of both genotypes are averaged, but the brain's alone is asked for.": (
            one + other
        )
        / 2,
        "The networks of both genotypes are added, but the brain's alone is asked for.": one
        + other,
        **{
            f"The network's last part (length {k}) comes from the body's genotype, but it should "
            f"be that of the brain.": np.append(one[:-k], other[-k:])
            for k in (1, 2, 3, 4, 5, 6, 10, 35, 64, 70)
        },
        "The network is all 0, but it should be that of the brain.": 0 * one,
    }


def wrong_transplants(brain: np.ndarray, body: np.ndarray) -> dict[str, np.ndarray]:
    """What slips make of a whole transplanted genotype, whose length is wrong."""
    network, norm, own, foreign = brain[:-134], brain[-70:], brain[-134:-70], body[-134:-70]
    missing = (
        "The means and deviations at the end are missing, but those of the brain should be there."
    )
    return {
        missing: np.append(network, foreign),
        "The brain's own body is still there beside the foreign one, which should take its place.":
        np.concatenate([network, own, foreign, norm]),
        "The foreign body stands behind the brain's whole genotype, but it should replace its "
        "body.":
        np.append(brain, foreign),
        "The foreign body stands in front of the brain's whole genotype, but it should replace its "
        "body.":
        np.append(foreign, brain),
        "Two genotypes are returned, but one is asked for.": np.array(
            [np.concatenate([network, foreign, norm]),
             np.concatenate([body[:-134], own, body[-70:]])]),
        "This is the body alone, but a whole genotype is asked for.": foreign,
        "This is the brain without any body, but a whole genotype is asked for.":
        np.append(network, norm),
        "The two whole genotypes stand one after another, but one genotype is asked for.":
        np.append(brain, body),
        "The means are left out, but 35 means and 35 deviations should follow the body.":
        np.concatenate([network, foreign, norm[35:]]),
        "The deviations are left out, but 35 means and 35 deviations should follow the body.":
        np.concatenate([network, foreign, norm[:35]]),
        "The foreign genotype from its body on stands behind the brain's whole genotype, but only "
        "its body should replace the brain's.":
        np.append(brain, body[-134:]),
        "The array is empty, but it should hold network, body, means and deviations.":
        np.zeros(0),
    }  # fmt: skip


def other_places(genotype: np.ndarray) -> dict[str, np.ndarray]:
    """Pieces of a genotype that are not the body."""
    end = len(genotype) - 70
    pieces = {(i, i + 64) for i in (*range(65), *range(end - 200, end + 7))} - {(end - 64, end)}
    pieces |= {(i, end) for i in range(end - 200, end - 64)} | {(end - 64, end + 35)}
    return {
        f"This is genotype[{i}:{j}]. The body has 64 numbers and stands before the last 70.":
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
            return f" Your number is that of the seed {other}, but all should have the seed {seed}."
    return ""


@np.errstate(all="ignore")
def wrong_matrices(
    returns: np.ndarray, text: str, walkers: np.ndarray, seed: int, episodes: int
) -> dict:
    """What slips make of a matrix; other seeds for two walkers only, as they take time."""
    n = len(walkers)
    rows = {
        "": lambda m: m,
        "All numbers of a row are that of the brain in its own body, but it should have every "
        "body.":
        lambda m: np.repeat(np.diagonal(m)[:, None], n, axis=1),
        "All numbers of a column are that of the body with its own brain, but it should have every "
        "brain.":
        lambda m: np.repeat(np.diagonal(m)[None], n, axis=0),
        "The half below the diagonal mirrors the one above, but each pair should have its own "
        "number.":
        lambda m: np.triu(m) + np.triu(m, 1).T,
        "The half above the diagonal mirrors the one below, but each pair should have its own "
        "number.":
        lambda m: np.tril(m) + np.tril(m, -1).T,
        "Rows and columns are exchanged: rows should be brains and columns bodies.": lambda m: m.T,
        "The diagonal is left out, but each brain should be evaluated in its own body, too.":
        lambda m: m - np.diag(np.diagonal(m)),
        "Only the diagonal is filled, but every brain should be evaluated in every body.":
        lambda m: np.diag(np.diagonal(m)),
        "The returns of a row are added up from pair to pair, but each by itself is asked for.":
        lambda m: np.cumsum(m, axis=1),
        "The returns of a column are added up from pair to pair, but each by itself is asked for.":
        lambda m: np.cumsum(m, axis=0),
        "The brain's return in its own body is subtracted, but the returns themselves are asked "
        "for.":
        lambda m: m - np.diagonal(m)[:, None],
        "The body's return with its own brain is subtracted, but the returns themselves are asked "
        "for.":
        lambda m: m - np.diagonal(m)[None],
        "Each row is divided by the brain's return in its own body, but the returns are asked for.":
        lambda m: m / np.diagonal(m)[:, None],
        "Each column is divided by the body's return with its own brain, but the returns are asked "
        "for.":
        lambda m: m / np.diagonal(m)[None],
        "The fractions of the returns are cut off.": np.trunc,
        "The columns stand in the opposite order.": lambda m: m[:, ::-1],
        "The rows stand in the opposite order.": lambda m: m[::-1],
        "Each row holds the returns of the first brain, but it should hold those of its own.":
        lambda m: m[[0] * n],
        "Each row holds the returns of the last brain, but it should hold those of its own.":
        lambda m: m[[-1] * n],
        "Each column holds the returns with the first body, but it should hold those with its own.":
        lambda m: m[:, [0] * n],
        "Each column holds the returns with the last body, but it should hold those with its own.":
        lambda m: m[:, [-1] * n],
        "The returns below 0 count as 0, but they should stay as they are.":
        lambda m: np.maximum(m, 0),
        "The returns have lost their signs.": np.abs,
        "All numbers below the diagonal are 0, but each pair should be evaluated.": np.triu,
        "All numbers above the diagonal are 0, but each pair should be evaluated.": np.tril,
        "Each row is sorted, but column j should belong to body j.": lambda m: np.sort(m, axis=1),
    }  # fmt: skip
    seeds = {
        "Each row has a seed of its own, but all pairs should have the same.": lambda i, j: i,
        "Each column has a seed of its own, but all pairs should have the same.": lambda i, j: j,
        "Each pair has a seed of its own, but all should have the same.": lambda i, j: n * i + j,
        "The diagonal has another seed than the rest, but all pairs should have the same.":
        lambda i, j: int(i != j),
        "The seed that is given is not used: this is what the seed 0 gives.": lambda i, j: -seed,
        "The seed that is given is not used: this is what the seed 1 gives.":
        lambda i, j: 1 - seed,
        "The seed is one more than the one that is given.": lambda i, j: 1,
        "The seed grows by the number of episodes from row to row, but all pairs should have the "
        "same.":
        lambda i, j: i * episodes,
        "The seed grows by the number of episodes from pair to pair, but all should have the same.":
        lambda i, j: (n * i + j) * episodes,
        "The seed grows by the number of episodes from column to column, but all should have the "
        "same.":
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
        made["Means and deviations come from the walker that gives the body, but they belong to "
             "the "
             "brain."] = np.where(np.eye(n, dtype=bool)[..., None], returns, foreign)  # fmt: skip
        said = (
            "Each episode has a seed of its own, but `evaluate` should get the seed once for all "
            "episodes."
        )
        first = [with_seeds(lambda i, j, k=k: k)[:, :, :1] for k in range(episodes)]
        made[said] = np.concatenate(first, axis=2)
    return slips(
        lambda returns, rows, summary: rows(summary(returns)),
        returns={"": returns} | made,
        rows=rows,
        summary={
            "": lambda r: r.mean(axis=2),
            "Only the first episode counts here, but the mean is asked for.": lambda r: r[:, :, 0],
            "Only the last episode counts here, but the mean is asked for.": lambda r: r[:, :, -1],
            "The best episode is taken instead of the mean.": lambda r: r.max(axis=2),
            "The worst episode is taken instead of the mean.": lambda r: r.min(axis=2),
            "The median of the episodes is taken instead of the mean.":
            lambda r: np.median(r, axis=2),
            "The episodes are added up, but they should be averaged.": lambda r: r.sum(axis=2),
            "This is the standard deviation of the episodes instead of the mean.":
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
            "This is the mean of the other diagonal.": np.diagonal(matrix[:, ::-1]).mean(),
            "The diagonal is added up, but it should be averaged.": own.sum(),
            "This is the mean of the whole matrix, but that of the diagonal is asked for.":
            matrix.mean(),
            "This is the mean of the best returns of the rows, but that of the diagonal is asked "
            "for.":
            matrix.max(axis=1).mean(),
            "This is the mean of the best returns of the columns, but that of the diagonal is "
            "asked for.":
            matrix.max(axis=0).mean(),
            "This is the median of the diagonal instead of the mean.": np.median(own),
            "This is the best one of the diagonal instead of the mean.": own.max(),
            "This is the first one of the diagonal instead of the mean.": own[0],
            "The sum of the diagonal is divided by n * n instead of n.": own.sum() / n**2,
            "The sum of the diagonal is divided by n - 1 instead of n.": own.sum() / (n - 1),
            "This is the mean of the first row instead of the diagonal.": matrix[0].mean(),
            "The whole diagonal is given, but its mean is asked for.": own,
            "The mean of the foreign returns is subtracted, but the mean of the diagonal alone is "
            "asked for.":
            own.mean() - others.mean(),
            "This is the mean of the foreign returns, but that of the diagonal is asked for.":
            others.mean(),
        }  # fmt: skip
    if key == "foreign":
        upper, lower = matrix[np.triu_indices(n, 1)], matrix[np.tril_indices(n, -1)]
        return {
            "The diagonal is counted among the foreign places, but it should be left out.":
            matrix.mean(),
            "The sum of the foreign returns is divided by n * n instead of n (n - 1).":
            others.sum() / n**2,
            "The sum of the foreign returns is divided by n instead of n (n - 1).":
            others.sum() / n,
            "The sum of the foreign returns is divided by n - 1 instead of n (n - 1).":
            others.sum() / (n - 1),
            "The sum of the foreign returns is divided by n * n - 1 instead of n (n - 1).":
            others.sum() / (n**2 - 1),
            "The sum of the foreign returns is divided by n (n - 1) / 2 instead of n (n - 1).":
            others.sum() / (n * (n - 1) / 2),
            "Only the places above the diagonal are counted, but those below should be, too.":
            upper.mean(),
            "Only the places below the diagonal are counted, but those above should be, too.":
            lower.mean(),
            "The foreign returns are added up, but they should be averaged.": others.sum(),
            "This is the median of the foreign places instead of the mean.": np.median(others),
            "This is the best foreign return instead of the mean.": others.max(),
            "The other diagonal is left out instead of the one of the walkers themselves.":
            matrix[~np.eye(n, dtype=bool)[::-1]].mean(),
            "This is the mean of the diagonal, but that of all other places is asked for.":
            own.mean(),
            "This is the loss, own minus foreign, but the foreign mean itself is asked for.":
            own.mean() - others.mean(),
            "The mean of the diagonal is subtracted from that of the whole matrix, but the mean of "
            "all other places is asked for.":
            matrix.mean() - own.mean(),
            "The sum of the whole matrix is divided by n (n - 1), but the diagonal should be left "
            "out of the sum.":
            matrix.sum() / (n * n - n),
            "The best returns of the rows are averaged, but all foreign places should count.":
            matrix.max(axis=1).mean(),
            "Only the places just above the diagonal are averaged, but all foreign places should "
            "be.":
            np.diagonal(matrix, 1).mean(),
        }  # fmt: skip
    table = matrix.T if key == "bodies" else matrix
    rest = table[~np.eye(n, dtype=bool)].reshape(n, n - 1)
    if key == "at home":
        return {
            "This is the share of the brains instead of their number.":
            np.mean(own > rest.max(axis=1)),
            "This counts columns, which are bodies, but rows should be counted, which are brains.":
            np.sum([own[i] > max(np.delete(matrix[:, i], i)) for i in range(n)]),
            "A brain counts here if it beats the mean of the others in its row, but it should beat "
            "each of them.":
            np.sum(own > rest.mean(axis=1)),
            "A brain counts here if it beats at least one of the others in its row, but it should "
            "beat each of them.":
            np.sum(own > rest.min(axis=1)),
            "A brain that does just as well in another body is counted, but it should do better in "
            "its own.":
            np.sum(own >= rest.max(axis=1)),
            "The first of equal returns counts as the best, but a brain should do better in its "
            "own body.":
            np.sum(matrix.argmax(axis=1) == np.arange(n)),
            "Pairs are counted in which a brain does worse than in its own body, but brains should "
            "be counted.":
            np.sum(own[:, None] > matrix),
            "Pairs are counted in which a body does worse than with its own brain, but brains "
            "should be counted.":
            np.sum(own > matrix),
            "Brains that do worse at home than in each other body are counted, but those that do "
            "better should be.":
            np.sum(own < rest.min(axis=1)),
            "Brains that are not at home are counted, but those that are should be.":
            np.sum(own <= rest.max(axis=1)),
            "The own return is compared with the best of the whole matrix instead of the others in "
            "its row.":
            np.sum(own >= matrix.max()),
            "A brain counts here if its loss is above 0, but it should beat each of the others in "
            "its row.":
            np.sum(own - rest.mean(axis=1) > 0),
            "A brain counts here if it beats the mean of all foreign places, but it should beat "
            "each of its row.":
            np.sum(own > others.mean()),
            "A brain counts here only if it beats all foreign places, but it should beat only "
            "those of its row.":
            np.sum(own > others.max()),
            "A brain counts here if it beats the median of the others in its row, but it should "
            "beat each of them.":
            np.sum(own > np.median(rest, axis=1)),
            "0 counts among the others in each row, but it should not: returns can be below 0.":
            np.sum(own > (matrix * (1 - np.eye(n))).max(axis=1)),
            "A brain counts here only if it is the best in its row and in its column, but only the "
            "row should count.":
            np.sum((own > rest.max(axis=1)) & (own > [
                max(np.delete(matrix[:, i], i)) for i in range(n)])),
            "The numbers (0, 1, ...) of the brains at home are added up, but the brains should be "
            "counted.":
            np.flatnonzero(own > rest.max(axis=1)).sum(),
        }  # fmt: skip
    with np.errstate(all="ignore"):
        unequal = np.where(table == own[:, None], np.nan, table)
        unequal = np.nansum(unequal, axis=1) / np.sum(np.isfinite(unequal), axis=1)
    return {
        "The others are subtracted from own returns of other walkers, as own - matrix pairs them "
        "for rows, but one own return belongs to all of them.":
        (own - table).sum(axis=1) / (n - 1),
        "The own place is counted among the others, but it should be left out.":
        own - table.mean(axis=1),
        "The sum of the others is divided by n instead of n - 1.":
        own - rest.sum(axis=1) / n,
        "The others are added up, but they should be averaged.": own - rest.sum(axis=1),
        "The mean of all foreign places is subtracted instead of that of the row or column.":
        own - others.mean(),
        "The best of the others is subtracted instead of their mean.": own - rest.max(axis=1),
        "The loss is divided by the own return, but the loss itself is asked for.":
        1 - rest.mean(axis=1) / np.where(own, own, np.nan),
        "This is the mean of the others, but it should be subtracted from the own return.":
        rest.mean(axis=1),
        "Rows and columns are exchanged: rows should be for brains and columns for bodies.":
        own - (table.sum(axis=0) - own) / (n - 1),
        "Places that equal the own return are left out, too, but only the own place should be.":
        own - unequal,
        "The first place of each row or column is left out instead of the own one.":
        own - table[:, 1:].mean(axis=1),
        "The last place of each row or column is left out instead of the own one.":
        own - table[:, :-1].mean(axis=1),
        "The loss has lost its sign, but it should be below 0 where the others do better.":
        np.abs(own - rest.mean(axis=1)),
        "The own return is subtracted from the mean of the others, but it should be the other way "
        "round.":
        rest.mean(axis=1) - own,
        "The worst of the others is subtracted instead of their mean.": own - rest.min(axis=1),
        "The median of the others is subtracted instead of their mean.":
        own - np.median(rest, axis=1),
        "This is the mean of all losses, but one number for each is asked for.":
        np.mean(own - rest.mean(axis=1)),
        "This is the sum of all losses, but one number for each is asked for.":
        np.sum(own - rest.mean(axis=1)),
        "The mean of the own returns is used for each, but each should have its own.":
        own.mean() - rest.mean(axis=1),
        "A loss below 0 counts as 0, but it should stay negative.":
        np.maximum(own - rest.mean(axis=1), 0),
        "The own return is divided by the mean of the others, but that should be subtracted.":
        own / rest.mean(axis=1),
        "The loss is divided by the mean of the others, but the loss itself is asked for.":
        own / rest.mean(axis=1) - 1,
        "The sum of the others is divided by n - 2 instead of n - 1.":
        own - rest.sum(axis=1) / max(n - 2, 0.5),
        "0 stands on the own place and is counted among the others, but it should be left out.":
        own - (table * (1 - np.eye(n))).sum(axis=1) / n,
        "The best of the row or column is taken for the own return, but that stands on the "
        "diagonal.":
        table.max(axis=1) - rest.mean(axis=1),
        "The best of the row or column, the own one included, is subtracted instead of the mean of "
        "the others.":
        own - table.max(axis=1),
        "The own return is in the sum of the others, but it should be left out.":
        own - table.sum(axis=1) / (n - 1),
        "The differences to the others are added up, but their mean is asked for.":
        ((n - 1) * own - rest.sum(axis=1)),
    }  # fmt: skip


def changed_losses(matrix: np.ndarray, key: str) -> dict:
    """What comes of a changed matrix."""
    n, own = len(matrix), np.diagonal(matrix)
    no_last, no_first = np.arange(n) < n - 1, np.arange(n) > 0
    off = ~np.eye(n, dtype=bool)
    with np.errstate(all="ignore"):
        other = {
            "The matrix is divided by its largest value, but it should be used as it is.": matrix
            / matrix.max(),
            "The matrix is divided by its largest amount, but it should be used as it is.": matrix
            / np.abs(matrix).max(),
            "The rows of the matrix are divided by the own returns, but they should be used as "
            "they are.": matrix / own[:, None],
            "The columns of the matrix are divided by the own returns, but they should be used as "
            "they are.": matrix / own,
            "The mean of the matrix is subtracted from it, but it should be used as it is.": matrix
            - matrix.mean(),
            "The returns have lost their signs.": np.abs(matrix),
            "The returns are rounded, but they should be used as they are.": matrix.round(),
            "Returns below 0 count as 0, but they should be used as they are.": np.maximum(
                matrix, 0
            ),
            "Each row is sorted, but its places belong to bodies.": np.sort(matrix, axis=1),
            "Each column is sorted, but its places belong to brains.": np.sort(matrix, axis=0),
            "The columns are taken in the opposite order.": matrix[:, ::-1],
            "Rows and columns are exchanged.": matrix.T,
        }
        if n > 2:
            other["The last walker is left out."] = matrix[:-1, :-1]
            other["The first walker is left out."] = matrix[1:, 1:]
        if n > 3:
            other["Only the first three walkers count here, but all n should."] = matrix[:3, :3]
        found = {text: own_loss(each, key) for text, each in other.items()}
        if key == "foreign":
            found |= {
                "The sum of the foreign returns is divided by 6 instead of n (n - 1).": matrix[
                    off
                ].sum()
                / 6,
                "The last row is left out.": matrix[off & no_last[:, None]].mean(),
                "The first row is left out.": matrix[off & no_first[:, None]].mean(),
                "The last column is left out.": matrix[off & no_last].mean(),
                "The first column is left out.": matrix[off & no_first].mean(),
            }
        if key in ("brains", "bodies"):
            table = matrix if key == "brains" else matrix.T
            rest = table[off].reshape(n, n - 1)
            found |= {
                "The sum of the others is divided by 2 instead of n - 1.":
                own - rest.sum(axis=1) / 2,
                "The loss of all together, own minus foreign, is given for each, but each should "
                "have its own.":
                0 * own + own.mean() - rest.mean(),
            }  # fmt: skip
    return found


def reason(matrix: np.ndarray, key: str, *place: int) -> str:
    """What the text says about a part of the answer, with its numbers."""
    n, own = len(matrix), np.diagonal(matrix)
    if key == "own":
        return f"own should be the mean of the diagonal, {own.round(2).tolist()}."
    if key == "foreign":
        return f"foreign should be the mean of the {n * n - n} places that are not on the diagonal."
    if key == "at home":
        best = [max(np.delete(row, i)) for i, row in enumerate(matrix)]
        return (
            f"At home the brains have {own.round(2).tolist()}; the best of the others in each row "
            f"is {np.round(best, 2).tolist()}. Count the brains for which the first is greater."
        )
    line, what = (matrix[place[0]], "row") if key == "brains" else (matrix[:, place[0]], "column")
    others = np.delete(line, place[0]).round(2).tolist()
    return (
        f"{key}[{place[0]}] should be {own[place[0]]:.4g}, from the diagonal, minus the mean of "
        f"the others in its {what}, {others}."
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
