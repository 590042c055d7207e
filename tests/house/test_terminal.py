"""No byte of what others wrote steers the terminal, whichever command prints it."""

import csv
import re
import shutil
import unicodedata
from pathlib import Path

import numpy as np
import pytest
from rich.markdown import Markdown
from rich.markup import escape
from rich.progress import Progress

import botschool
from botschool.cli.app import GROUPS
from botschool.console import Console
from botschool.labs.entries import write_entry
from botschool.output import save_npz
from botschool.paths import course_root
from botschool.screen import guarded_terminal, plain

CONTROLS = [*map(chr, [*range(1, 9), *range(11, 32), *range(127, 160)]), *"\u200e\u200f\u061c"]
CONTROLS += [*map(chr, [*range(0x202A, 0x202F), *range(0x2066, 0x206A)]), "\u2028", "\ufeff"]
ORDERS = "\x1b]52;c;aGk=\x07\x1b]0;title\x1b\\\x9b2J\x1b[2J\x1b[1A\x1b[31m\x1b]8;;http://x\x1b\\y"
EVIL = f"a{ORDERS}{''.join(CONTROLS)}z"
COMMANDS = [
    (GROUPS[module], command.name or command.callback.__name__)
    for module in GROUPS
    for command in module.app.registered_commands
]


def steering(text):
    """The characters in a text that steer a terminal or turn the direction of reading."""
    kept = "\n\t\u200c\u200d"
    return [
        c for c in text if unicodedata.category(c) in ("Cc", "Cf", "Zl", "Zp") and c not in kept
    ]


@pytest.mark.parametrize("command_name", COMMANDS, ids=lambda name: name[1])
def test_no_command_prints_the_control_characters_of_its_arguments(
    command_name, command, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    words = [word for word in command_name if word]
    longer = EVIL + "z" * 255  # no file can have this name
    for arguments in ([longer], ["-f", EVIL], [f"--{EVIL}"]):
        code, out, errors = command(*words, *arguments)
        assert code and not steering(out + errors), (arguments, out, errors)


def test_texts_that_people_write_stay_as_they_are():
    text = (
        "Zo\u00eb\u00a0\u0645\u200c\u0631 \u65e5\u3000\u8a9e, \U0001f469\u200d\U0001f52c\tx\n\udc80"
    )
    assert plain(text) == text and steering(EVIL) and not steering(plain(EVIL))


def printed(capsys, *things, **options):
    with guarded_terminal():
        for thing in things:
            Console(**options).print(thing)
    return capsys.readouterr().out


def test_rich_styles_its_own_texts_and_no_others(capsys):
    """In a terminal, where it writes colours; Markdown may have links."""
    red = printed(capsys, "[red]ok[/]", force_terminal=True, color_system="standard")
    assert red == "\x1b[31mok\x1b[0m\n"
    evil = printed(
        capsys,
        f"[red]{escape(EVIL)}[/]",
        Markdown(EVIL),
        force_terminal=True,
        color_system="standard",
    )
    assert not steering(re.sub(r"\x1b\[[0-9;]*m", "", evil)) and "\ufffd" in evil


def test_bars_move_the_cursor_and_what_is_printed_beside_them_does_not(capsys):
    """A bar replaces stdout by a stream of Rich's."""
    for said in ("benign", EVIL):
        with guarded_terminal(), Progress(console=Console(force_terminal=True)) as bar:
            bar.add_task("x", total=2)
            print(said)
        text = capsys.readouterr().out
        assert "\r\x1b[2K" in text and ("\ufffd" in text) == (said == EVIL)
        assert not {"\x9b", "\u202e", "\x01"} & {*text} and "\x1b]" not in text


def test_only_one_module_makes_consoles_and_every_bar_has_one():
    """A console of Rich's own would let colours of others through."""
    own = re.compile(r"import rich\b|rich\.console|rich import|sys\.(stdout\.buffer|__stdout__)")
    for path in Path(botschool.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert path.name == "console.py" or not own.search(
            text.replace("from rich import box", "")
        ), path
        for bar in re.findall(r"\b(?:Progress|Live)\((.*)", text):
            assert "console=" in bar, path


def test_names_and_files_of_a_league(command, tmp_path):
    folder = tmp_path / "entries"
    folder.mkdir()
    ini = course_root() / "data" / "experiments" / "cartpole.ini"
    np.save(tmp_path / "g.npy", np.zeros(72))
    name = EVIL.replace("/", "")[:60]
    entry = write_entry(tmp_path / "g.npy", ini, "Ada", folder / f"{name}.robot.npz")
    with np.load(entry) as saved:
        save_npz(folder / "b.robot.npz", dict(saved) | {"name": EVIL})
    (folder / f"{name}x.robot.npz").write_bytes(b"PK")
    code, out, errors = command("league", folder, "-o", tmp_path / "league.html")
    assert code == 0 and "not in the league" in out and not steering(out + errors)
    with open(tmp_path / "league.csv", encoding="utf-8-sig", newline="") as file:
        rows = list(csv.reader(file))
    assert len(rows) == 3 and not steering("".join(map("".join, rows)))
    assert not steering((tmp_path / "league.html").read_text())


def test_the_sheet_of_a_laboratory(command, tmp_path, monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(course_root()))
    monkeypatch.chdir(tmp_path)
    assert command("lab", "3", "start", "--name", EVIL)[0] == 0
    sheet = tmp_path / "lab03" / "sheet.md"
    text = sheet.read_text(encoding="utf-8").replace("answer:\n", f"answer: {EVIL}\n")
    sheet.write_text(text.replace(">\n", f"> {EVIL} {'word ' * 12}\n"), encoding="utf-8")
    shutil.copytree(tmp_path / "lab03", tmp_path / "other" / "lab03")
    for more in ((), ("--submission", tmp_path / "other")):
        code, out, errors = command("lab", "3", "check", *more)
        assert code == 1 and not steering(out + errors)
