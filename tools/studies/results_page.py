"""Blocks of docs/reports/results.md and bodies.md, `<!-- NAME -->` to `<!-- end -->`, made from
data/."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
from evolved import BOX2D, ROWS
from report import Table
from trained import PROBLEMS

DOCS = Path(__file__).parents[2] / "docs"
DATA = Path(__file__).parent / "data"
PAGES = (DOCS / "reports" / "results.md", DOCS / "reports" / "bodies.md")
PARTS = ("box2d", "evolved", "planar", "planarspeed", "ppo", "speed", "trained")
PUBLISHED_PPO = {"CartPole-v1": "500", "Pendulum-v1": "-172 +- 104", "Acrobot-v1": "-73.5 +- 18"}
SPEED = ("others", "gymnasium", "workers", "runs", "memory")
PLANAR_SPEED = ("runners", "runnerworkers")
"""Parts of the bench that the pages show."""
SURE = 0.9
"""Share of new episodes in which a runner must go ten body lengths, or never fall, to count."""
SHARES = (10, 25, 50, 75, 100)


def load() -> dict:
    """{part: what its file holds}; a part that was never measured is missing."""
    return {
        name: json.loads(file.read_text(encoding="utf-8"))
        for name in PARTS
        if (file := DATA / f"{name}.json").exists()
    }


def spread(values, digits: int = 1) -> str:
    """Mean +- standard deviation."""
    values = np.asarray(values, dtype=float)
    deviation = f" +- {values.std(ddof=1):.{digits}f}" if len(values) > 1 else ""
    return f"{values.mean():.{digits}f}{deviation}"


def markdown(columns: list[str], rows: list[list[str]]) -> str:
    return Table("", "", columns, rows).markdown()


def conditions(parts: dict) -> str:
    """Where each part was measured."""
    rows = [
        [name, str(s["minutes"] or "-"), s["date"], s["commit"], s["machine"], s["note"]]
        for name, s in ((name, part["measured"]) for name, part in parts.items())
    ]
    return markdown(["part", "minutes", "date", "commit", "machine", "meanwhile"], rows)


def solved(row, runs: list[dict]) -> str:
    """How many runs solved the problem, and the steps that took."""
    if row.solved is None:
        return "-"
    after = [each["solved"] / 1e6 for each in runs if each["solved"] is not None]
    count = f"{row.solved:g} on {len(after)} of {len(runs)}"
    return f"{count}: {np.median(after):.2g} M, {max(after):.2g} M" if after else count


def evolved(parts: dict) -> str:
    """A row for each experiment file."""
    lines = []
    found = parts["evolved"]["data"] | parts.get("box2d", {"data": {}})["data"]
    for row in [row for row in ROWS + BOX2D if row.file in found]:
        of, runs = found[row.file], found[row.file]["runs"]
        best, new, seconds = ([each[key] for each in runs] for key in ("best", "new", "seconds"))
        lines.append([
            f"{row.file}.ini", of["algorithm"], f"{of['steps']:g} M", str(len(runs)), spread(best),
            f"{min(best):.1f} to {max(best):.1f}", f"{np.mean(new):.1f}", solved(row, runs),
            row.published, f"{np.mean(seconds):.1f} s",
        ])  # fmt: skip
    return markdown(
        [
            "experiment", "algorithm", "steps", "seeds", "best post-evaluated", "range",
            "in new episodes", "solved (steps)", "published", "a run, one core",
        ],
        lines,
    )  # fmt: skip


def planar(parts: dict) -> str:
    """A row for each runner, and where that was measured."""
    rows = []
    for file, of in parts["planar"]["data"].items():
        runs = of["runs"]
        best, new, metres, seconds = (
            [each[key] for each in runs] for key in ("best", "new", "metres", "seconds")
        )
        sure, whole = (sum(each[key] >= SURE for each in runs) for key in ("lengths", "upright"))
        finer = [100 * each["finer"][1] / each["finer"][0] for each in runs]
        rows.append([
            f"{file}.ini", f"{of['steps']:g} M", str(len(runs)), spread(best, 0),
            f"{min(best):.0f} to {max(best):.0f}", spread(new, 0), spread(metres),
            f"{min(metres):.1f} to {max(metres):.1f}", f"{sure} of {len(runs)}",
            f"{whole} of {len(runs)}", f"{min(finer):.0f} to {max(finer):.0f} %",
            f"{np.mean(seconds):.0f} s",
        ])  # fmt: skip
    columns = [
        "experiment", "steps", "seeds", "best post-evaluated", "range", "in new episodes",
        "metres", "range", "ten lengths", "no falls", "half the substep", "a run, one core",
    ]  # fmt: skip
    at = parts["planar"]["measured"]
    stamp = f"({at['date']}, commit {at['commit']}, {at['minutes']} minutes. {at['note']})"
    return f"{markdown(columns, rows)}\n\n{stamp}"


def tables(part: str, measured: str = "speed"):
    """A function that gives the tables of a part of the bench, without its internal targets."""

    def shown(parts: dict) -> str:
        if part not in parts[measured]["data"]:
            return "Not measured yet."
        texts = []
        for table in parts[measured]["data"][part]:
            kept = [i for i, name in enumerate(table["columns"]) if name not in ("", "target")]
            columns = [table["columns"][i] for i in kept]
            rows = [[row[i] for i in kept] for row in table["rows"]]
            texts.append(f"**{table['title']}**\n\n{markdown(columns, rows)}\n\n{table['about']}")
        return "\n\n".join(texts)

    return shown


def trained(parts: dict) -> str:
    """PPO's defaults."""
    rows = []
    for problem, runs in parts["trained"]["data"].items():
        best, last = ([each[key] for each in runs] for key in ("best", "last"))
        rows.append([
            problem, str(len(runs)), spread(best), f"{min(best):.1f} to {max(best):.1f}",
            spread(last), f"{min(last):.1f} to {max(last):.1f}", str(PROBLEMS[problem]),
            PUBLISHED_PPO[problem],
        ])  # fmt: skip
    columns = ["problem", "seeds", "best model", "range", "last model", "range", "aim", "rl-zoo"]
    return markdown(columns, rows)


def ppo(parts: dict) -> str:
    """Two PPOs side by side."""
    rows, sentences = [], []
    for problem, found in parts["ppo"]["data"].items():
        for library, of in found["libraries"].items():
            curves = np.array(of["curves"])
            at = [curves[:, curves.shape[1] * share // 100 - 1] for share in SHARES]
            rows.append([problem, library, *(spread(each, 0) for each in at), spread(of["new"])])
        sentences.append(found["agreement"])
    columns = ["problem", "PPO of", *(f"{share} %" for share in SHARES), "new episodes"]
    return "\n\n".join([markdown(columns, rows), *sentences])


BLOCKS = {
    "conditions": (conditions, None),
    "evolved": (evolved, "evolved"),
    "trained": (trained, "trained"),
    "ppo": (ppo, "ppo"),
    "planar": (planar, "planar"),
    **{part: (tables(part), "speed") for part in SPEED},
    **{part: (tables(part, "planarspeed"), "planarspeed") for part in PLANAR_SPEED},
}
"""Who makes each block, and the part of the data without which it stays as it is."""


def filled(text: str, parts: dict) -> str:
    """A page with its blocks made anew."""

    def block(match: re.Match) -> str:
        make, needed = BLOCKS[match[2]]
        if needed and needed not in parts:
            return match[0]
        return f"{match[1]}\n{make(parts)}\n{match[3]}"

    return re.sub(r"(<!-- (\w+) -->)\n(?:.*?\n)??(<!-- end -->)", block, text, flags=re.DOTALL)


def write() -> None:
    """Writes the pages and their figures."""
    import results_figures as figures

    parts = load()
    for page in PAGES:
        page.write_text(filled(page.read_text(encoding="utf-8"), parts), encoding="utf-8")
    print(f"{DOCS}; figures: {', '.join(figures.draw(parts, DOCS / 'images'))}")
