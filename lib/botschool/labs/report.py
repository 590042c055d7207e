"""Write a laboratory's report: one page with the sheet, the figure, replays and the points."""

from __future__ import annotations

import re
from base64 import b64encode
from html import escape
from pathlib import Path

from botschool import problems
from botschool.labs.check import Checked
from botschool.labs.declare import WORDS, Lab
from botschool.labs.folder import Place
from botschool.labs.saved import SavedRun
from botschool.labs.sheet import uncommented
from botschool.output import save_bytes

_STYLE = """
:root { color-scheme: light dark }
body { font: 16px/1.55 system-ui, sans-serif; max-width: 46rem; margin: 2rem auto; padding: 0 1rem }
h1 { line-height: 1.2 } h2 { margin-top: 2.2rem; border-bottom: 1px solid #8886 }
table { border-collapse: collapse; display: block; overflow-x: auto }
td, th { border-bottom: 1px solid #8884; padding: .3rem .8rem; text-align: left }
blockquote { border-left: 4px solid #0072b2; margin: 1rem 0; padding: .1rem 1rem }
pre { background: #8882; padding: .6rem 1rem; overflow-x: auto }
img { max-width: 100%; background: white } iframe { width: 100%; height: 34rem; border: 0 }
b.answer, b.chosen { color: #0072b2 } .open { opacity: .55 } li { margin: .3rem 0 }
"""


def write_report(place: Place, checked: Checked, folder: Path) -> Path:
    """Write report.html into the laboratory's folder; folder: for temporary files."""
    lab = place.lab
    blocks = place.sheet().text.split("\n\n")
    text = "\n\n".join(b for b in blocks if not b.startswith("Write after `answer:`"))
    title, *sections = re.split(r"^## +", text, flags=re.MULTILINE)
    body = [_markdown(title)]
    for section in sections:
        head, _, text = section.partition("\n")
        body.append(f"<h2>{escape(head.strip())}</h2>{_markdown(text)}")
        if head.strip() == "Figure" and checked.picture:
            data = b64encode(checked.picture).decode()
            body.append(f'<img alt="The figure of the runs" src="data:image/png;base64,{data}">')
        if head.strip() == "Runs":
            body += [_replay(lab, checked, name, folder) for name in lab.shown]
    body.append(f"<h2>Points</h2>{_points(checked)}")
    page = (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
        f'content="width=device-width"><title>{escape(lab.title)}</title><style>{_STYLE}</style>'
        f"</head><body>{''.join(body)}</body></html>\n"
    )
    path = place.folder / "report.html"
    save_bytes(path, page.encode())
    return path


def _points(checked: Checked) -> str:
    rows = [
        f"<tr><td>{part.name}</td><td>{part.points:g} of {part.max_points:g}</td>"
        f"<td>{'<br>'.join(map(escape, part.messages))}</td></tr>"
        for part in checked.parts
    ]
    rows.append(f"<tr><td>words</td><td>{WORDS} points: your instructor's</td><td></td></tr>")
    return f"<table>{''.join(rows)}</table><p>{checked.points:g} of 90 points.</p>"


def _replay(lab: Lab, checked: Checked, name: str, folder: Path) -> str:
    """Return a frame with the page that replays the best proven robot of a condition."""
    from botschool.render.replay import write_replay
    from botschool.render.scenes import scene_of, with_frames

    runs = checked.runs.get(name)
    if not runs:
        return ""
    best: SavedRun = runs[int(lab.best(checked.data[name]).argmax())]
    experiment = best.condition.load()
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    genotype, normalisation = policy.split(best.genotype)
    scene = scene_of(problem)
    steps = problem.play(
        policy, genotype, normalisation, 1, 0, experiment.policy.maxsteps, render=scene is None
    )
    page = folder / "replay.html"
    neurons = policy.spec.inputs, policy.spec.outputs
    fps = scene.fps if scene else problem.fps
    about = f"{name}, seed {best.seed}"
    write_replay(page, problem.name, about, [with_frames(problem, steps)], fps, neurons, scene)
    inside = escape(page.read_text(encoding="utf-8"), quote=True)
    return f'<p>The best of {escape(name)}:</p><iframe title="{name}" srcdoc="{inside}"></iframe>'


def _markdown(text: str) -> str:
    """Return the Markdown of a sheet as HTML."""
    blocks = re.split(r"\n\s*\n", text.strip("\n"))
    return "".join(_block(block) for block in blocks if block.strip())


def _block(block: str) -> str:
    block = uncommented(block).strip("\n")
    lines = block.splitlines()
    if not block.strip():
        return ""
    if lines[0].startswith("# "):
        return f"<h1>{_inline(lines[0][2:])}</h1>" + _block("\n".join(lines[1:]))
    if all(line.startswith("    ") for line in lines):
        return f"<pre>{escape(block)}</pre>"
    if lines[0].startswith("|"):
        rows = [line.strip().strip("|").split("|") for line in lines if not re.match(r"\|-", line)]
        cells = ["".join(f"<td>{_inline(cell.strip())}</td>" for cell in row) for row in rows]
        return f"<table>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"
    if lines[0].startswith("- "):
        items = re.split(r"^- ", block, flags=re.MULTILINE)[1:]
        return f"<ul>{''.join(f'<li>{_inline(item)}</li>' for item in items)}</ul>"
    quoted = [line.lstrip()[1:] for line in lines if line.lstrip().startswith(">")]
    plain = [line for line in lines if not line.lstrip().startswith(">")]
    shown = f"<p>{_inline(chr(10).join(plain))}</p>" if "".join(plain).strip() else ""
    return shown + (f"<blockquote>{_inline(chr(10).join(quoted))}</blockquote>" if quoted else "")


def _inline(text: str) -> str:
    """Return a line with its code unchanged, and with emphasis, answers and boxes elsewhere."""
    pieces = re.split(r"`([^`]+)`", text)
    pieces[1::2] = [f"<code>{escape(code)}</code>" for code in pieces[1::2]]
    pieces[::2] = [_answers(escape(piece)) for piece in pieces[::2]]
    return "".join(pieces)


def _answers(text: str) -> str:
    text = re.sub(r"\*([^*\n]+)\*", r"<em>\1</em>", text)
    text = re.sub(r"answer:[ \t]{0,9}(.*)", r'<b class="answer">\1</b>', text)
    return re.sub(r"\[\s{0,9}([xX]?)\s{0,9}\]\s{0,9}([^\[\n<]+)", _box, text)


def _box(found: re.Match) -> str:
    mark, label = found[1], found[2].strip()
    if mark:
        return f'<b class="chosen">&#9745; {label}</b> '
    return f'<span class="open">&#9744; {label}</span> '
