"""Sections of docs/reports/coevolution.md, and its figures, made from data/coevolution.json."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import coevolution_figures
import numpy as np
from coevolution_plan import PLANS, VARIANTS, Plan
from study import DATA, REPORTS, Page, table

from botschool.analysis.tournament import PROGRESS, ROLES

KEPT = DATA / "coevolution.json"
T_975 = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262)
"""97.5 % quantiles of Student's t distribution with 1, 2, ... degrees of freedom."""
LONG = 100
"""Steps of a chase that can be followed."""


def interval(values: np.ndarray) -> tuple[float, float, float]:
    """Mean over seeds and its 95 % interval, by Student's t; of one seed the ends are nan."""
    values = np.asarray(values, dtype=float)
    mean, count = float(values.mean()), len(values)
    if count < 2:
        return mean, float("nan"), float("nan")
    half = T_975[count - 2] * values.std(ddof=1) / np.sqrt(count)
    return mean, float(mean - half), float(mean + half)


def in_words(values, form: str = "+.2f", least=-np.inf, most=np.inf) -> str:
    """The mean with its interval, as "+0.31 (+0.25 to +0.36)"; "-" of what cannot be said.

    least, most: what the values can be; the interval ends there.
    """
    mean, low, high = interval(values)
    if np.isnan(mean):
        return "-"
    low, high = np.clip((low, high), least, most)
    ends = "" if np.isnan(low) else f" ({low:{form}} to {high:{form}})"
    return f"{mean:{form}}{ends}"


@dataclass
class Group:
    """The measured runs of a variant, one a seed."""

    variant: str
    runs: list[dict]

    def matrices(self, role: str) -> list[np.ndarray]:
        """Of each run: mean fitness of a side's generations against those of the other side."""
        of_predators = [np.array(run["predators"]) for run in self.runs]
        return of_predators if role == ROLES[0] else [1 - each.T for each in of_predators]

    def indices(self, index: Callable, role: str, first: int) -> list[float]:
        """A measure of progress of each run, from the first time on or the second one (1)."""
        parts = [matrix[first:, first:] for matrix in self.matrices(role)]
        return [float(index(part)) if len(part) > 1 else float("nan") for part in parts]


def groups(found: dict) -> list[Group]:
    """What a plan has of each variant; variants without a measured run are left out."""
    made = [
        Group(v.name, [run for name, run in found["runs"].items() if name.split()[1] == v.name])
        for v in VARIANTS
    ]
    return [group for group in made if group.runs]


def shown(data: dict) -> Iterator[tuple[Plan, dict]]:
    """The plans of which something has been measured."""
    for plan in PLANS:
        found = data["plans"].get(plan.name)
        if found and found["runs"]:
            yield plan, found


def heading(plan: Plan, found: dict) -> str:
    """What is compared, as a line above a table."""
    count, all_of = len(found["runs"]), len(found["reached"])
    who = "all" if count == all_of else f"the {count} of {all_of} that have come so far"
    return f"**{found['millions']:g} million steps a run**, {who} ({found['about']}):"


def picture(plan: Plan, name: str) -> str:
    """The link to a figure that coevolution_figures draws."""
    return f"![{name.capitalize()} of the {plan.name} runs](../images/study_{plan.name}_{name}.png)"


def reached(data: dict) -> str:
    """How far each run has come."""
    texts = []
    for plan in PLANS:
        found = data["plans"][plan.name]
        seeds = [str(seed) for seed in plan.seeds]
        rows = []
        for variant in VARIANTS:
            cells = []
            for seed in seeds:
                millions, generations = found["reached"][f"{plan.name} {variant.name} {seed}"]
                cells.append(f"{millions:.0f} ({generations})" if millions else "-")
            rows.append([variant.name, *cells])
        goal = f"of {plan.milestones[-1]:g} million steps ({plan.about})"
        made = table(["algorithm", *(f"seed {seed}" for seed in seeds)], rows)
        texts.append(f"Runs {goal}; million steps done, generations in brackets:\n\n{made}")
    return "\n\n".join(texts)


def progress(data: dict) -> str:
    """Historical and global progress with intervals over seeds, with and without random robots."""
    texts = []
    for plan, found in shown(data):
        rows = []
        for group in groups(found):
            for role in ROLES:
                cells = []
                for first in (0, 1):
                    for index in PROGRESS.values():
                        values = group.indices(index, role, first)
                        above = sum(value > 0 for value in values)
                        cells.append(f"{in_words(values)}, {above} of {len(values)}")
                rows.append([f"{group.variant}, {role}", *cells])
        columns = ["", *PROGRESS, *(f"{name}, no random robots" for name in PROGRESS)]
        texts.append(f"{heading(plan, found)}\n\n{table(columns, rows)}")
        texts.append(picture(plan, "progress"))
    return "\n\n".join(texts) or "No run has ended yet."


def verdict(data: dict) -> str:
    """What the table of progress says of each side, and who has made the most, in sentences."""
    texts = []
    for plan, found in shown(data):
        if min(len(group.runs) for group in groups(found)) < 2:
            texts.append(f"{heading(plan, found)} one seed alone tells nothing of others.")
            continue
        lines = [f"{heading(plan, found)}", ""]
        of_both = {}
        for name, index in PROGRESS.items():
            for first, without in ((0, ""), (1, ", random robots left out")):
                for role in ROLES:
                    values = {
                        group.variant: group.indices(index, role, first) for group in groups(found)
                    }
                    lines.append(f"- {name} of {role}{without}: {signs(values)}.")
                    if index is PROGRESS["global progress"] and not first:
                        of_both[role] = values
        times = [len(run["generations"]) for group in groups(found) for run in group.runs]
        lines += ["", order(of_both) if len(set(times)) == 1 else unranked(times)]
        texts.append("\n".join(lines))
    return "\n\n".join(texts) or "No run has ended yet."


def signs(values: dict[str, list[float]]) -> str:
    """Of which variants the whole interval is above 0, or below it."""
    ends = {name: interval(those)[1:] for name, those in values.items()}
    above = [name for name, (low, _) in ends.items() if low > 0]
    below = [name for name, (_, high) in ends.items() if high < 0]
    parts = [f"above 0 with {_listed(above)}"] if above else []
    parts += [f"below 0 with {_listed(below)}"] if below else []
    open_ = [name for name in values if name not in above + below]
    parts += [f"not distinguishable from 0 with {_listed(open_)}"] if open_ else []
    return "; ".join(parts)


def order(global_progress: dict[str, dict[str, list[float]]]) -> str:
    """Variants by the global progress of both sides, and whether the first leads for certain."""
    sides = list(global_progress.values())
    both = {name: np.mean([side[name] for side in sides], axis=0) for name in sides[0]}
    ranked = sorted(both, key=lambda name: -np.mean(both[name]))
    told = ", ".join(f"{name} {in_words(both[name])}" for name in ranked)
    text = f"Global progress, the mean of both sides, from the most to the least: {told}."
    if len(ranked) > 1 and min(len(both[name]) for name in ranked[:2]) > 1:
        apart = interval(both[ranked[0]])[1] > interval(both[ranked[1]])[2]
        text += f" The intervals of the first two {'do not ' if apart else ''}overlap."
    return text


def unranked(times: list[int]) -> str:
    """Why algorithms are not ranked if their runs have different numbers of measured times."""
    return (
        f"Who has made the most is not said: runs with few saved generations have {min(times)} "
        f"times, others up to {max(times)}. The fewer times, the further apart are two of them (of "
        "three two thirds of the run on average, of many one third), and the larger is an index."
    )


def _listed(names: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def cross(data: dict) -> str:
    """All against all: the last predators of each variant against the last prey of each."""
    texts = []
    for plan, found in shown(data):
        if not found["cross"]:
            continue
        own = [name.split()[1] for name in found["cross"]["names"]]
        names = [group.variant for group in groups(found)]
        fitness = strangers(np.array(found["cross"]["predators"]))
        means = by_variant(fitness, own, names)
        rows = [
            [f"predators of {name}", *(in_words([value], ".2f") for value in means[i]),
             in_words(strength(fitness, own, names)[name], ".2f", 0, 1)]
            for i, name in enumerate(names)
        ]  # fmt: skip
        prey = strength(1 - fitness.T, own, names)
        rows.append(
            ["**prey against all**", *(in_words(prey[name], ".2f", 0, 1) for name in names), ""]
        )
        columns = ["fitness of", *(f"prey of {name}" for name in names), "against all"]
        texts.append(f"{heading(plan, found)}\n\n{table(columns, rows)}")
    return "\n\n".join(texts) or "No run has ended yet."


def strangers(fitness: np.ndarray) -> np.ndarray:
    """Only those who have not evolved together: nan where a run would meet itself."""
    fitness = fitness.copy()
    np.fill_diagonal(fitness, np.nan)
    return fitness


def by_variant(fitness: np.ndarray, own: list[str], names: list[str]) -> np.ndarray:
    """Mean over the runs of each variant, rows and columns; own: the variant of each run."""
    places = [np.array([name == each for each in own]) for name in names]
    return np.array([[_mean(fitness[np.ix_(row, column)]) for column in places] for row in places])


def strength(fitness: np.ndarray, own: list[str], names: list[str]) -> dict[str, list[float]]:
    """Return the mean fitness of each variant's runs (rows) against all, by variant."""
    found: dict[str, list[float]] = {name: [] for name in names}
    for row, name in zip(fitness, own, strict=True):
        against = [_mean(row[[each == other for each in own]]) for other in names]
        found[name].append(_mean(np.array(against)))
    return found


def _mean(values: np.ndarray) -> float:
    """Mean of what there is; nan if there is nothing."""
    there = values[~np.isnan(values)]
    return float(there.mean()) if there.size else float("nan")


def behaviour(data: dict) -> str:
    """What the last robots do, and in how many times chases are long enough to be followed."""
    texts = []
    for plan, found in shown(data):
        rows = []
        for group in groups(found):
            last = {key: [run[key][-1] for run in group.runs] for key in ("caught", "steps")}
            speed = np.array([run["speed"][-1] for run in group.runs])
            every = [steps for run in group.runs for steps in run["steps"]]
            rows.append([
                group.variant, in_words(100 * np.array(last["caught"]), ".0f", 0, 100),
                ", ".join(str(steps) for steps in last["steps"]),
                in_words(speed[:, 0], ".2f"), in_words(speed[:, 1], ".2f"),
                in_words([run["distance"][-1] for run in group.runs], ".2f"),
                f"{sum(steps > LONG for steps in every)} of {len(every)}",
            ])  # fmt: skip
        columns = [
            "algorithm", "caught, %", "median steps of each seed", "speed of predators, m/s",
            "of prey", "distance, m", f"times with more than {LONG} steps",
        ]  # fmt: skip
        texts.append(f"{heading(plan, found)}\n\n{table(columns, rows)}")
        texts.append(picture(plan, "behaviour"))
    return "\n\n".join(texts) or "No run has ended yet."


def origin(data: dict) -> str:
    """Where and when it was measured."""
    stamps = {plan.name: found["measured"] for plan, found in shown(data)}
    return "\n".join(
        f"The {name} runs were measured on {stamp['date']}, commit {stamp['commit']}, "
        f"{stamp['machine']}."
        for name, stamp in stamps.items()
    )


SECTIONS: dict[str, Callable[[dict], str]] = {
    "reached": reached,
    "progress": progress,
    "verdict": verdict,
    "cross": cross,
    "behaviour": behaviour,
    "origin": origin,
}
"""Who makes each section, whose name begins with study_."""


def load() -> dict:
    """What was measured."""
    return json.loads(KEPT.read_text(encoding="utf-8"))


def pages() -> list[Page]:
    """Return the page, made from what was measured."""
    data = load()
    sections = {f"study_{name}": make(data) for name, make in SECTIONS.items()}
    figures = {
        f"study_{plan.name}_{name}": partial(draw, groups(found))
        for plan, found in shown(data)
        for name, draw in coevolution_figures.FIGURES.items()
    }
    return [Page(REPORTS / "coevolution.md", sections, figures, dpi=100)]
