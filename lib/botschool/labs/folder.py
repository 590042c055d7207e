"""Make and find the folder of a laboratory: labNN with sheet.md, measure.py, figure.py, runs."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from textwrap import indent

from botschool.errors import BotschoolError
from botschool.labs.declare import STRATEGY, Lab, load_lab
from botschool.labs.sheet import Sheet
from botschool.paths import course_root

FILE = re.compile(r"^<!-- file: (\S+) -->\n", re.MULTILINE)
"""Line of labNN.md that begins a file of the student's folder; the sheet stands above."""
NAME = Path(".botschool") / "name"


@dataclass(frozen=True)
class Place:
    """A student's folder."""

    lab: Lab
    folder: Path

    @classmethod
    def of(cls, number: str | int, here: Path | None = None) -> Place:
        """Return labNN in the current folder, or the current folder itself if it is labNN."""
        lab, here = load_lab(number), (here or Path.cwd())
        itself = here.resolve().name == lab.name and (here / "sheet.md").is_file()
        return cls(lab, here if itself else here / lab.name)

    @classmethod
    def find(cls, folder: Path) -> Place:
        """Return the place of a folder, whose name tells the laboratory. Raises BotschoolError."""
        found = re.fullmatch(r"lab(\d\d)", folder.resolve().name)
        if not found:
            raise BotschoolError(
                f"{folder.resolve()} is no folder of a laboratory (labNN): keep the laboratory's "
                "files where 'botschool lab' made them."
            )
        return cls(load_lab(int(found[1])), folder)

    @property
    def runs(self) -> Path:
        """Return the folder of its runs."""
        return self.folder / "runs"

    def sheet(self) -> Sheet:
        """Read and return the sheet. Raises BotschoolError if there is none."""
        return Sheet.read(self.folder / "sheet.md")


POST_EVALUATED = """\
After each generation the best robot is *post-evaluated*: it plays `pepisodes` further episodes,
the same for all generations of a run. Their mean is its post-evaluated fitness. The best robot of a
run is the one with the highest.

"""


def settings(lab: Lab) -> str:
    """Return all that decides a run of the laboratory, as a table: setting, value in the runs."""
    values: dict[str, dict[str, list[str]]] = {}
    for condition in lab.conditions:
        for section, named in condition.experiment.items():
            for name, value in named.items() if isinstance(named, dict) else [(section, named)]:
                if name == "maxmsteps" and condition.generations:
                    name, value = "generations", condition.generations
                shown = str(value).strip("[]").replace("'", "")
                setting = values.setdefault(f"[{section.upper()}] | `{name}`", {})
                setting.setdefault(shown, []).append(condition.name)
    rows = "\n".join(f"| {name} | {_value(found, lab)} |" for name, found in values.items())
    meets = any(c.experiment["exp"]["algo"] == "coevo2" for c in lab.conditions)
    trains = any(c.kind == "training" for c in lab.conditions)
    lists = "`botschool es` and `botschool rl --explain` list" if trains else "`botschool es` lists"
    return (
        f"{'' if meets else POST_EVALUATED}These settings decide a run. All others have their "
        f"defaults:\n{lists} and explain{'' if trains else 's'} them.\n\n"
        f"| section | setting | value |\n|---|---|---|\n{rows}"
    )


def _value(found: dict[str, list[str]], lab: Lab) -> str:
    """Return the values of a setting: the commonest first, the conditions with each other one."""
    (usual, where), *others = sorted(found.items(), key=lambda each: -len(each[1]))
    everywhere = sum(map(len, found.values())) == len(lab.conditions)
    if everywhere and len(where) > len(lab.conditions) / 2:
        return "; ".join([usual, *(f"{value} in {_together(n, lab)}" for value, n in others)])
    return "; ".join(f"{value} ({_together(names, lab)})" for value, names in found.items())


def _together(names: list[str], lab: Lab) -> str:
    """Return names of conditions; of those that share their first word, if all are there, it."""
    said: list[str] = []
    for word in dict.fromkeys(name.split()[0] for name in names):
        group = [c.name for c in lab.conditions if c.name.split()[0] == word]
        said += [word] if {*group} <= {*names} else [name for name in group if name in names]
    return ", ".join(said)


def skeletons(lab: Lab) -> dict[str, str]:
    """Return the files that the student's folder gets: name -> text."""
    sheet, *parts = FILE.split(lab.page)
    files = {"sheet.md": sheet.rstrip().replace("{SETTINGS}", settings(lab)) + "\n"}
    for name, text in zip(parts[::2], parts[1::2], strict=True):
        files[name] = text.strip().removeprefix("```python\n").removesuffix("```")
    told = indent(files["figure.py"], "    ").strip()
    figure = Path(__file__).with_name("figure.txt").read_text(encoding="utf-8")
    files["figure.py"] = figure.replace("{NUMBER}", str(lab.number)).replace("{TOLD}", told)
    return files


def start(place: Place, name: str, course: str) -> list[Path]:
    """Make the folder; leave existing files as they are and return them."""
    files = {
        file: text.replace("{NAME}", name).replace("{COURSE}", course).encode()
        for file, text in skeletons(place.lab).items()
    }
    if place.lab.strategy:
        files[f"{STRATEGY}.py"] = _of_the_exercise(place.lab.strategy)
    place.folder.mkdir(parents=True, exist_ok=True)
    kept = []
    for file, content in files.items():
        path = place.folder / file
        if path.exists():
            kept.append(path)
        else:
            path.write_bytes(content)
    return kept


def _of_the_exercise(file: str) -> bytes:
    """Return the student's file of an exercise, empty if there is none here."""
    with suppress(BotschoolError, OSError):
        return (course_root() / "exercises" / file).read_bytes()
    return b""


def check_strategy(place: Place) -> None:
    """Raise BotschoolError if the laboratory needs a strategy and the folder has none."""
    file, path = Path(place.lab.strategy), place.folder / f"{STRATEGY}.py"
    if not place.lab.strategy or (path.is_file() and b"evolve" in path.read_bytes()):
        return
    raise BotschoolError(
        f"{path} has no function evolve: copy your finished {file.name} of exercise "
        f"{int(file.parent.name[2:4])} into it."
    )


def known_name(here: Path) -> str:
    """Return the name from an earlier laboratory; "" if there is none."""
    try:
        return " ".join((here / NAME).read_text(encoding="utf-8").split())
    except (OSError, UnicodeDecodeError):
        return ""


def keep_name(here: Path, name: str) -> None:
    """Remember the name for the next laboratory."""
    (here / NAME).parent.mkdir(exist_ok=True)
    (here / NAME).write_text(f"{name}\n", encoding="utf-8")
