"""Write a laboratory's report: prediction and findings, the figure, numbers, replays, words."""

from __future__ import annotations

from base64 import b64encode
from contextlib import suppress
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from botschool import problems
from botschool.grading.report.paper import paper
from botschool.labs.check import Check
from botschool.labs.declare import WORDS, Lab
from botschool.labs.fields import Field
from botschool.labs.folder import Place
from botschool.labs.sheet import Sheet, Unreadable
from botschool.output import save_bytes
from botschool.policies.policy import Policy
from botschool.problems.base import Problem

Robot = tuple[Problem, Policy, np.ndarray, np.ndarray | None]
_STYLE = """
main { max-width: 46rem; } h2 { margin-top: 2.2rem; border-bottom: 1px solid var(--line); }
table { border-collapse: collapse; display: block; overflow-x: auto; }
td, th { border-bottom: 1px solid var(--line); padding: .3rem .8rem; text-align: left; }
blockquote { border-left: 4px solid var(--answer); margin: 1rem 0; padding: .1rem 1rem; }
img { max-width: 100%; background: white; } iframe { width: 100%; height: 34rem; border: 0; }
b.answer { color: var(--answer); } main { --answer: #0072b2; } li { margin: .3rem 0; }
"""


def write_report(place: Place, checked: Check, folder: Path) -> Path:
    """Write report.html into the laboratory's folder; folder: for temporary files."""
    lab, sheet, fields = place.lab, checked.sheet, place.lab.fields.values()
    name = escape(sheet.text_of("name"))
    body = [
        f"<h1>{escape(lab.title)}</h1><p>Laboratory {lab.number}, {name}</p>",
        _told("You predicted", [f for f in fields if f.predicts], checked.answers),
        _told("You found", [f for f in fields if not f.predicts], checked.answers),
    ]
    if checked.picture:
        data = b64encode(checked.picture).decode()
        body.append(f'<img alt="The figure of the runs" src="data:image/png;base64,{data}">')
    body += ["<h2>The numbers</h2>", _table(sheet, lab)]
    if shown := "".join(_replay(checked, name, folder) for name in lab.shown):
        body += ["<h2>The robots</h2>", shown]
    if sheet.words:
        body += ["<h2>In your words</h2>", f"<blockquote>{_inline(sheet.words)}</blockquote>"]
    body.append(f"<h2>Points</h2>{_points(checked)}")
    path = place.folder / "report.html"
    page = paper(lab.title, "\n".join(body), _STYLE, scripts=True)
    save_bytes(path, page.encode("utf-8", "replace"))
    return path


def _told(title: str, fields: list[Field], answers: dict[str, Any]) -> str:
    """Return answers of the sheet as a list, each after what it answers; texts are quoted."""
    there = [field for field in fields if field.id in answers]
    rows = [
        f'<li>{_inline(f.what)} <b class="answer">{_inline(_shown(answers[f.id]))}</b></li>'
        for f in there
        if f.kind != "text"
    ]
    texts = [
        f"<blockquote>{_inline(answers[f.id])}</blockquote>" for f in there if f.kind == "text"
    ]
    nothing = "" if there else "<p>Nothing is written yet.</p>"
    return f"<h2>{title}</h2><ul>{''.join(rows)}</ul>{''.join(texts)}{nothing}"


def _shown(answer: Any) -> str:
    return f"{answer:g}" if isinstance(answer, float) else str(answer)


def _table(sheet: Sheet, lab: Lab) -> str:
    """Return the sheet's table, with intervals, as the student has filled it in."""
    rows = [["", *lab.titles]]
    for condition in lab.conditions:
        with suppress(Unreadable):
            rows.append([condition.name, *sheet.row(condition.name)])
    cells = ["".join(f"<td>{_inline(cell)}</td>" for cell in row) for row in rows]
    return f"<table>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"


def _points(checked: Check) -> str:
    rows = [
        f"<tr><td>{part.name}</td><td>{part.points:g} of {part.max_points:g}</td>"
        f"<td>{'<br>'.join(map(escape, part.messages))}</td></tr>"
        for part in checked.parts.values()
    ]
    rows.append(f"<tr><td>words</td><td>{WORDS} points: your instructor's</td><td></td></tr>")
    return f"<table>{''.join(rows)}</table><p>{checked.points:g} of 90 points.</p>"


def _replay(checked: Check, name: str, folder: Path) -> str:
    """Return a frame that replays the best proven robot of a condition; "" if there is none."""
    if not (runs := checked.runs.get(name)):
        return ""
    best = max(runs, key=lambda run: run.stat[-1, 2])
    experiment = best.condition.load()
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    robot = problem, policy, *policy.split(best.genotype)
    about, steps = f"{name}, seed {best.seed}", experiment.policy.maxsteps
    frame = replay_frame(robot, steps, problem.name, about, folder)
    return f"<p>The best of {escape(name)}:</p>{frame}"


def replay_frame(robot: Robot, steps: int, title: str, about: str, folder: Path) -> str:
    """Return a frame with a page that replays an episode; folder: for temporary files."""
    from botschool.render.replay import write_replay
    from botschool.render.scenes import scene_of, with_frames

    problem, policy, *numbers = robot
    scene = scene_of(problem)
    played = problem.play(policy, *numbers, 1, 0, steps, render=scene is None)
    page, neurons = folder / "replay.html", (policy.spec.inputs, policy.spec.outputs)
    fps = scene.fps if scene else problem.fps
    write_replay(page, title, about, [with_frames(problem, played)], fps, neurons, scene)
    inside = escape(page.read_text(encoding="utf-8"), quote=True)
    # as high as its content, so that the bar below it hides no chart
    fit = "this.style.height=this.contentDocument.documentElement.scrollHeight+2+'px'"
    return (
        f'<iframe title="{escape(about)}" loading="lazy" onload="{fit}" srcdoc="{inside}"></iframe>'
    )


def _inline(text: str) -> str:
    """Return a line of Markdown as HTML."""
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).disable(["link", "image", "autolink"])
    return markdown.renderInline(text)
