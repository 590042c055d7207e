"""Compute what slips make of answers, and why right answers are right; for the grader."""

import tempfile
from collections.abc import Callable
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
        },
    )  # fmt: skip


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
        "The parameters are cut off at the scale, not at -1 and 1.":
        lambda q, scale: scale * q.clip(-scale, scale),
        "The angles are cut off at their largest value, but the parameters are not scaled.":
        lambda q, scale: q.clip(-scale, scale),
        "The parameters are cut off above only: -1 is a limit, too.":
        lambda q, scale: scale * np.minimum(q, 1),
        "The parameters are cut off below only: 1 is a limit, too.":
        lambda q, scale: scale * np.maximum(q, -1),
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
        },
        sums={
            "": lambda a: a,
            "These are sums of angles, which belong to `outline`.": np.cumsum,
            "The torso has a default angle, too: it is 0 here.":
            lambda a: np.where(np.arange(11) == 0, 0, a),
            "The torso has a default angle, too: it is left out.": lambda a: np.append(a[1:], 0),
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

    def by_amount(one, other):
        first = np.abs(one) < np.abs(other)
        return np.where(first == low, one, other)

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
            "A limit is taken without its sign: both can lie on one side of the default angle.":
            lambda one, other: (-1 if low else 1) * np.abs(pick(one, other)),
            "Limits are taken without their signs.": amounts,
            "The limits of all joints are sorted, but each joint has its own two (axis=1).":
            lambda one, other: np.sort(one if low else other),
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

    def drawn(heading, along, across, wide, joint, first):
        along = long * along(heading)
        side = wide * across(heading)
        ends = np.cumsum(along + joint(side))
        begin = np.append(0, ends[:-1]) + first * along[0]
        found = np.stack([begin - side, begin + along - side, begin + along + side, begin + side])
        return np.stack([found.real.T, found.imag.T], axis=2)

    own = corners(p)
    orders = {"x and y of each corner are exchanged.": own[..., ::-1]} | {
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
            "A segment's own angle is left out of its heading.": np.cumsum(bends) - bends,
            "The angles turn clockwise here, but are counter-clockwise.": -np.cumsum(bends),
            "A heading is cut off, but may go beyond pi.": np.cumsum(bends).clip(-np.pi, np.pi),
            "The heading of a segment has the angles of two segments only: sum up all.":
            bends + np.append(0, bends[:-1]),
            "The angles are summed up twice.": np.cumsum(np.cumsum(bends)),
            "The torso's angle is counted twice from segment 1 on, and each other one comes one "
            "segment late.": np.append(bends[0], bends[0] + np.cumsum(bends)[:-1]),
        },
        along={
            "": lambda a: np.exp(1j * a),
            "Sine and cosine of the direction along a segment are exchanged.":
            lambda a: np.sin(a) + 1j * np.cos(a),
            "A segment goes to x - l cos, not to x + l cos.": lambda a: -np.exp(-1j * a),
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
            "": 0,
            "The middle of the torso lies at (0, 0), but its beginning belongs there.": -0.5,
            "The end of the torso lies at (0, 0), but its beginning belongs there.": -1,
        },
    )  # fmt: skip


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
        },
    )  # fmt: skip


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
        },
    ) | {
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
    "mass": lambda p: wrong_sums(masses(p), lengths(p) * thicknesses(p)),
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


CORNERS = ("beginning right", "end right", "end left", "beginning left")


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
            return f"Segment {k} begins at {where} there, {name} {before}."
        if np.abs(sides[0][k] - sides[1][k]).max() > 1e-3 or abs(along[k] @ across[k]) > 1e-3:
            return f"The four corners of segment {k}, one after another, make no rectangle."
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
            return (
                f"Segment {k} has the heading {heading[k]:.4g} there, but {turned} is "
                f"{right_heading[k]:.4g}."
            )
    return ""


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


def own_returns(
    text: str, walkers: np.ndarray, seed: int, episodes: int, other: Callable = lambda i, j: 0
) -> np.ndarray:
    """The return of each brain in each body in each episode; other: what slips add to the seed."""
    n = len(walkers)
    returns = np.zeros((n, n, episodes))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "trial.ini"
        file.write_text(text)
        for i, j in np.ndindex(n, n):
            parts = walkers[i, :-134], walkers[j, -134:-70], walkers[i, -70:]
            robot = SavedRobot(file, np.concatenate(parts))
            returns[i, j] = robot.evaluate(seed + other(i, j), episodes)
    return returns


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
    }  # fmt: skip
    seeds = {
        "Each row has a seed of its own, but all pairs have the same.": lambda i, j: i,
        "Each column has a seed of its own, but all pairs have the same.": lambda i, j: j,
        "Each pair has a seed of its own, but all have the same.": lambda i, j: n * i + j,
        "The diagonal has another seed than the rest.": lambda i, j: int(i != j),
        "The seed that is given is not used: this is what the seed 0 gives.": lambda i, j: -seed,
        "The seed that is given is not used: this is what the seed 1 gives.":
        lambda i, j: 1 - seed,
    }  # fmt: skip
    return slips(
        lambda returns, rows, summary: rows(summary(returns)),
        returns={"": returns} | {
            said: own_returns(text, walkers, seed, episodes, other)
            for said, other in seeds.items() if n == 2
        },
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
        },
    )  # fmt: skip


def wrong_losses(matrix: np.ndarray, key: str) -> dict:
    """What mistakes make of a part of the answer."""
    n, own, others = len(matrix), np.diagonal(matrix), matrix[~np.eye(len(matrix), dtype=bool)]
    if key == "own":
        return {
            "This is the other diagonal.": np.diagonal(matrix[:, ::-1]).mean(),
            "The diagonal is added up, not averaged.": own.sum(),
            "This is the mean of the whole matrix.": matrix.mean(),
            "These are the best returns of the rows: the diagonal is asked for.": matrix.max(
                axis=1
            ).mean(),
            "These are the best returns of the columns: the diagonal is asked for.": matrix.max(
                axis=0
            ).mean(),
        }
    if key == "foreign":
        return {
            "The diagonal is counted among the foreign places.": matrix.mean(),
            "The foreign returns are divided by the number of all places: there are n (n - 1) "
            "foreign ones.": others.sum() / n**2,
            "The foreign returns are divided by n: there are n (n - 1) foreign places.":
            others.sum() / n,
            "The foreign returns are divided by n - 1: there are n (n - 1) foreign places.":
            others.sum() / (n - 1),
            "Only the places above the diagonal are counted.": matrix[np.triu_indices(n, 1)].mean(),
            "Only the places below the diagonal are counted.":
            matrix[np.tril_indices(n, -1)].mean(),
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
        }  # fmt: skip
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
    }  # fmt: skip


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
