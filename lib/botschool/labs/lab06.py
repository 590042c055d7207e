"""How many ways are there to find a cylinder, and which need memory?"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import larger, mean_interval, one_of, p_value, side
from botschool.labs.measuring import CYLINDER, Run, forage, interval


def described(episode: dict[str, np.ndarray]) -> tuple[float, float, float, float]:
    """Return steps of the search, speed and turning in it, and the cylinder's side afterwards."""
    poses, near = episode["poses"], episode["rewards"] > 0
    search = int(near.argmax()) if near.any() else len(near)
    before, after = poses[:-1], poses[1:]
    moved = after[:, :2] - before[:, :2]
    forward = moved[:, 0] * np.cos(before[:, 2]) + moved[:, 1] * np.sin(before[:, 2])
    turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
    away = np.asarray(CYLINDER) - after[:, :2]
    sides = np.sin(np.arctan2(away[:, 1], away[:, 0]) - after[:, 2])[near]
    told = [values.mean() if len(values) else 0.0 for values in (forward[:search], turned[:search])]
    return search, float(told[0]), float(told[1]), float(sides.mean()) if len(sides) else 0.0


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return the return, the share of it that is lost without memory, and four descriptors."""
    ordinary, forgetful = forage(run), forage(run, forget=True)
    earned = float(np.mean([each["rewards"].sum() for each in ordinary]))
    without = float(np.mean([each["rewards"].sum() for each in forgetful]))
    rows = np.mean([described(each) for each in ordinary], axis=0)
    return {
        "return": earned,
        "lost": 1 - without / earned if earned > 0 else 0.0,
        **dict(zip(("search", "speed", "turning", "side"), map(float, rows), strict=True)),
    }


KINDS = {"LSTM": 3, "feed-forward": 0}
"""Networks: name -> architecture."""
DESCRIPTORS = ("search", "speed", "turning", "side")
THRESHOLD = 2.0
SHARE = 0.8
"""Does memory earn more than this?"""


def condition(kind: str, msteps: float = 20) -> Condition:
    """Return a condition: Kheperas with this network."""
    network = f"nhiddens=10, bias=1, architecture={KINDS[kind]}, out_type=2, winit=0"
    return Condition.of(
        kind,
        "ErDiscrim",
        f"episodes=3, pepisodes=25, maxsteps=500, {network}",
        f"maxmsteps={msteps}, samplesize=20, stepsize=0.03, noiseStdDev=0.05",
    )


def families(table: np.ndarray, threshold: float) -> list[set[int]]:
    """Group robots by the mean distance of their standardised descriptors (exercise 6)."""
    spread = table.std(axis=0)
    rows = (table - table.mean(axis=0)) / np.where(spread < 1e-12, np.inf, spread)
    apart = np.linalg.norm(rows[:, None] - rows[None], axis=2)
    groups = [[robot] for robot in range(len(rows))]
    while len(groups) > 1:
        pairs = sorted(combinations(range(len(groups)), 2), key=lambda pair: pair[::-1])
        distance = [apart[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
        if min(distance) >= threshold:
            break
        i, j = pairs[int(np.argmin(distance))]
        groups[i] += groups.pop(j)
    return [set(group) for group in groups]


def grouped(data: Data) -> list[list[set[int]]]:
    """Return the families of all robots at the threshold, a little below it and above it."""
    columns = [np.concatenate([data[kind][name] for kind in KINDS]) for name in DESCRIPTORS]
    table = np.stack(columns, axis=1)
    return [families(table, THRESHOLD * factor) for factor in (0.98, 1, 1.02)]


def counted(data: Data, answers: Answers) -> Judged:
    """Judge the number of families."""
    counts = [len(groups) for groups in grouped(data)]
    return one_of(counts, "group the descriptors of your robots again, as the sheet says.")


def mixed(data: Data, answers: Answers) -> Judged:
    """Judge whether a family has robots of both kinds."""
    first = set(range(len(data["LSTM"]["speed"])))
    found = [any(g & first and g - first for g in groups) for groups in grouped(data)]
    words = ["yes" if each else "no" for each in found]
    return one_of(words, "look again which robots each of your families has.")


def share_lost(data: Data, answers: Answers) -> Judged:
    """Judge whether memory earns more than SHARE of the LSTMs' return."""
    right = side(mean_interval(data["LSTM"]["lost"]), SHARE, ("more", "less"), slack=0.015)
    told = "compare 0.8 with the interval of the mean share that your LSTM robots lose."
    return one_of(right, told)


BOTH = ("LSTM", "feed-forward")
LAB = Lab(
    number=6,
    conditions=tuple(condition(kind) for kind in KINDS),
    statements={
        "families": Statement(6, BOTH, counted),
        "mixed": Statement(4, BOTH, mixed),
        "better": larger(5, "return", BOTH),
        "p": p_value(4, "return", BOTH),
        "lost": Statement(6, ("LSTM",), share_lost),
    },
    measures={"return": 1e-3, "lost": 1e-3} | dict.fromkeys(DESCRIPTORS, 1e-3),
    reference=reference,
    unseen=(condition("LSTM", 4), condition("feed-forward", 4)),
    columns=(
        Column(np.median, "return", 0.6),
        Column(interval, "return", 1),
        Column(np.median, "lost", 0.006),
        Column(np.median, "search", 0.6),
    ),
    figure=Figure("turning", BOTH, ("rad",)),
    rubric=(
        "Two families are described in words, so that one could recognise them on the replay.",
        "The student says what the feed-forward robots are good for here (a control).",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    shown=BOTH,
)
