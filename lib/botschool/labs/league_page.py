"""Write a league's page: ranks, replays of the winners, and who catches whom."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

import numpy as np

from botschool.grading.report.paper import paper
from botschool.labs.league import CHASE_STEPS, POLE_STEPS, RACE_STEPS, UNITS, League, Ranked
from botschool.labs.report import replay_frame
from botschool.output import save_bytes

TITLES = {
    "hopper": "Hoppers",
    "walker": "Walkers",
    "cheetah": "Cheetahs",
    "cart-pole": "Cart-poles",
    "predator": "Predators",
    "prey": "Prey",
}
_STYLE = """
h2 { margin: 2.6rem 0 .2rem; } p { margin: .3rem 0 1rem; } nav a { margin-right: 1rem; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(19rem, 1fr)); gap: 1.5rem;
 align-items: start; }
table { border-collapse: collapse; width: 100%; }
td, th { padding: .25rem .5rem; text-align: left; border-bottom: 1px solid var(--line); }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr.first td { font-weight: 650; }
.bar { background: var(--line); height: .55rem; border-radius: .3rem; min-width: 5rem; }
.bar i { display: block; height: 100%; border-radius: .3rem; background: #0072b2; }
iframe { width: 100%; height: 38rem; border: 1px solid var(--line); border-radius: .5rem; }
details { margin: .6rem 0; }
.who { overflow-x: auto; } .who table { width: auto; font-size: .75rem; }
.who td, .who th { padding: .1rem .3rem; border: 0; text-align: center; }
.who th.row { text-align: right; white-space: nowrap; }
"""
SHOWN = 10
"""Ranks that the page shows unfolded."""


def write_page(league: League, path: Path, folder: Path, title: str) -> None:
    """Write the page; folder: for temporary files. Raises BotschoolError."""
    count = len({each.entry.file for places in league.tables.values() for each in places})
    links = "".join(f'<a href="#{name}">{TITLES[name]}</a>' for name in league.tables)
    body = [
        f"<h1>{escape(title)}</h1><p class=soft>{count} robots. All results were measured here, "
        f"in episodes that nobody had seen.</p><nav>{links}</nav>"
    ]
    for name, places in league.tables.items():
        heading = f'<h2 id="{name}">{TITLES[name]}</h2><p class=soft>{UNITS[name]}</p>'
        body.append(f"{heading}<div class=two><div>{_table(places)}</div>")
        body.append(f"<div>{_replay(league, name, places, folder)}</div></div>")
    if len(league.hunters) > 1:
        body.append(_who(league))
    page = paper(title, "\n".join(body), _STYLE, scripts=True)
    save_bytes(path, page.encode("utf-8", "replace"))


def _table(places: Sequence[Ranked]) -> str:
    most = max((each.result for each in places), default=0) or 1
    rows = []
    for each in places:
        width = round(100 * max(0.0, each.result) / most)
        first = ' class="first"' if each.rank == 1 else ""
        rows.append(
            f"<tr{first}><td class=n>{each.rank}</td><td class=name>"
            f"{escape(each.entry.shown)}</td><td class=n>{each.result:.2f}</td>"
            f'<td><div class=bar><i style="width:{width}%"></i></div></td></tr>'
        )
    table = f"<table>{''.join(rows[:SHOWN])}</table>"
    if rest := rows[SHOWN:]:
        table += f"<details><summary>{len(rest)} more</summary><table>{''.join(rest)}</table>"
        table += "</details>"
    return table


def _replay(league: League, name: str, places: Sequence[Ranked], folder: Path) -> str:
    """Return a frame that replays the winner of a discipline; predator and prey share one."""
    if name == "prey":
        return ""
    first = places[0].entry
    problem, policy, genotype, normalisation = first.robot()
    about, steps = first.shown, POLE_STEPS if name == "cart-pole" else RACE_STEPS
    if name == "predator":
        genotype, about = _pair(league, genotype)
        steps = CHASE_STEPS
    robot = problem, policy, genotype, normalisation
    return replay_frame(robot, steps, TITLES[name], about, folder)


def _pair(league: League, own: np.ndarray) -> tuple[np.ndarray, str]:
    """Return the pair to replay, and a line about it.

    The best predator chases the best prey if their networks are alike, otherwise its own prey.
    """
    hunter, hunted = (league.tables[side][0].entry for side in ("predator", "prey"))
    if hunter.experiment.policy != hunted.experiment.policy:
        return own, f"{hunter.shown}, both"
    pair = np.concatenate([np.split(hunter.genotype, 2)[0], np.split(hunted.genotype, 2)[1]])
    return pair, f"{hunter.shown} chases {hunted.shown}"


def _who(league: League) -> str:
    """Return the table of who catches whom, both sides in the order of their ranks."""
    rank = {side: [each.entry for each in league.tables[side]] for side in ("predator", "prey")}

    def places(side: str) -> list[int]:
        return [league.hunters.index(entry) for entry in rank[side]]

    head = "".join(f"<th>{k}</th>" for k in range(1, len(league.hunters) + 1))
    rows = []
    for row, entry in zip(places("predator"), rank["predator"], strict=True):
        cells = "".join(
            f'<td style="background:rgba(213,94,0,{league.chases[row, column]:.2f})">'
            f"{100 * league.chases[row, column]:.0f}</td>"
            for column in places("prey")
        )
        rows.append(f"<tr><th class=row>{escape(entry.shown[:20])}</th>{cells}</tr>")
    return (
        "<h2>Who catches whom</h2><p class=soft>Predators in rows, prey in columns by rank; the "
        "share of time left at the catch, in percent. 0: not caught.</p>"
        f"<div class=who><table><tr><th></th>{head}</tr>{''.join(rows)}</table></div>"
    )
