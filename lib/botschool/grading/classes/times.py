"""Read times: in any language of a learning platform, and from what platforms leave in folders."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
import unicodedata
from datetime import date, datetime, time
from pathlib import Path, PurePosixPath
from typing import Any
from zoneinfo import ZoneInfo

from botschool.grading.classes.files import TIMESTAMP, File
from botschool.sandbox.inside import read_inside

SUBMITTED = "submitted"
"""The folder of nbgrader's course that holds the students' folders."""
_MAX_REFS, _SECONDS = 5_000_000, 20
_MONTHS = [
    "january januar janner janvier enero gennaio janeiro januari stycznia ledna januara tammikuuta "
    "января січня ocak ιανουαριου ianuarie januar janar gener",
    "february februar fevrier febrero febbraio fevereiro februari lutego unora februara "
    "helmikuuta февраля лютого subat φεβρουαριου februarie februar febrer",
    "march marz mars marzo marco maart marca brezna maaliskuuta марта березня mart μαρτιου martie "
    "marts marc",
    "april avril abril aprile kwietnia dubna aprila huhtikuuta апреля квітня nisan απριλιου "
    "aprilie",
    "may mai mayo maggio maio mei maj maja kvetna toukokuuta мая травня mayis μαιου maig",
    "june juni juin junio giugno junho czerwca cervna juna kesakuuta июня червня haziran ιουνιου "
    "iunie juny",
    "july juli juillet julio luglio julho lipca cervence jula heinakuuta июля липня temmuz ιουλιου "
    "iulie juliol",
    "august aout agosto augustus augusti sierpnia srpna augusta elokuuta августа серпня agustos "
    "αυγουστου agost",
    "september septembre septiembre settembre setembro wrzesnia zari septembra syyskuuta "
    "сентября вересня eylul σεπτεμβριου septembrie setembre",
    "october oktober octobre octubre ottobre outubro pazdziernika rijna oktobra lokakuuta "
    "октября жовтня ekim οκτωβριου octombrie",
    "november novembre noviembre novembro listopadu novembra marraskuuta ноября "
    "листопада kasim νοεμβριου noiembrie",
    "december dezember decembre diciembre dicembre dezembro grudnia prosince decembra joulukuuta "
    "декабря грудня aralik δεκεμβριου decembrie desember desembre",
]
"""The months in the languages of Moodle's most frequent packs, without accents."""
_MONTH = {name: number for number, names in enumerate(_MONTHS, 1) for name in names.split()}
_CLOCK = re.compile(r"(\d{1,2}):(\d\d)(?::\d\d)?\s*([^\W\d_][^\d]*)?")
_HALVES = {"\u5348\u524d": 0, "\u4e0a\u5348": 0, "\u5348\u5f8c": 1, "\u4e0b\u5348": 1}
"""The halves of the day in Japanese and Chinese, which stand before the clock."""
_NUMERIC = re.compile(r"(\d{4})\s*[-/.\u5e74\ub144]\s*(\d{1,2})\s*[-/.\u6708\uc6d4]\s*(\d{1,2})")


def moment_of(value: Any) -> datetime | None:
    """Return a table's time in local time."""
    try:
        text = re.sub(r"(\.\d{6})\d+|\s+(?=Z$|[+-]\d\d:?\d\d$)", r"\1", str(value).strip())
        moment = value if isinstance(value, datetime) else datetime.fromisoformat(text)
        return moment if moment.tzinfo is None else moment.astimezone().replace(tzinfo=None)
    except (ValueError, OverflowError, OSError):  # no time, or one before or after all clocks
        return None


def read_moment(text: str) -> datetime | None:
    """Return the time that a text names for sure, in whatever language; None for others.

    A date without a time lasts to its last minute. "5/6/2026" may be two days, so it is none.
    """
    text = text.strip()
    if re.fullmatch(r"\d{4}-\d\d-\d\d([T ]\d\d:\d\d.*)?", text):
        moment = moment_of(text)
        return moment and (datetime.combine(moment, _END) if len(text) == 10 else moment)
    plain = unicodedata.normalize("NFD", text.casefold())
    plain = "".join(each for each in plain if not unicodedata.combining(each))
    plain = plain.replace("\u0131", "i").replace("\u0142", "l")
    day = _day(plain)
    clock = _clock(plain)
    return datetime.combine(day, clock) if day and clock else None


_END = time(23, 59, 59)


def _day(text: str) -> date | None:
    text = _CLOCK.sub(" ", text) if not _NUMERIC.search(text) else text
    numeric = _NUMERIC.findall(text)
    months = {_MONTH[word] for word in re.findall(r"[^\W\d_]+", text) if word in _MONTH}
    years = re.findall(r"(?<!\d)((?:19|20)\d\d)(?!\d)", text)
    days = re.findall(r"(?<!\d)(\d{1,2})(?!\d)", text)
    try:
        if len(numeric) == 1:
            return date(*map(int, numeric[0]))
        if len(months) == len(years) == len(days) == 1:
            return date(int(years[0]), months.pop(), int(days[0]))
        if len(years) == 1 and len(days) == 2 and not months and max(map(int, days)) > 12:
            first, second = map(int, days)
            return date(int(years[0]), *((second, first) if first > 12 else (first, second)))
    except ValueError:
        pass
    return None


def _clock(text: str) -> time | None:
    found = list(_CLOCK.finditer(text))
    if not found:
        return _END
    hour, minute = int(found[0][1]), int(found[0][2])
    half = re.sub(r"[^a-z]", "", found[0][3] or "")
    if len(found) > 1 or hour > 23 or minute > 59:
        return None
    if half in ("am", "pm"):
        hour = hour % 12 + 12 * (half == "pm")
    elif (found[0][3] or "").strip() and hour <= 12:  # a half of the day, in some language
        return None
    before = re.search(r"([\u1100-\uffff]{2,}) ?$", text[: found[0].start()])
    if before and hour <= 12:
        if before[1] not in _HALVES:
            return None
        hour = hour % 12 + 12 * _HALVES[before[1]]
    return time(hour, minute)


def told_by(file: File) -> datetime | None:
    """Return when a file was handed in, from what a platform writes: a clone, or a text file.

    Students can write the same within what they hand in: of several clones the outermost counts, in
    an archive none, and the text file beside a clone only in the folder `submitted`.
    """
    file = file.packed or file
    if file.top.parent.name == SUBMITTED:
        return _collected(file)
    return _committed(file) or _collected(file)


def _collected(file: File) -> datetime | None:
    """Return the time in timestamp.txt, of the person or beside a file of the folder's.

    nbgrader writes "2026-11-20 21:14:03.5 Europe/Rome", Sakai "20261120211403000".
    """
    beside = PurePosixPath(file.place).with_name(TIMESTAMP)
    near = [str(beside)] if len(beside.parts) <= 2 else []  # STUDENT/EXERCISE/timestamp.txt
    for place in dict.fromkeys([*near, TIMESTAMP]):
        try:
            words = read_inside(file.top, place, 100).decode().split()
            if re.fullmatch(r"20\d{15}", words[0]):
                return datetime.strptime(words[0][:14], "%Y%m%d%H%M%S")
            moment = datetime.fromisoformat(" ".join(words[:2]))
            zone = ZoneInfo(words[2]) if len(words) > 2 else None
        except (OSError, ValueError, LookupError):
            continue
        return moment_of(moment.replace(tzinfo=zone) if zone else moment)
    return None


def _committed(file: File) -> datetime | None:
    """Return the time of the last commit that changed a file, in the file's repository."""
    parts = PurePosixPath(file.place).parts
    for depth in range(len(parts)):
        git = file.top.joinpath(*parts[:depth], ".git")
        if git.is_dir() and not git.is_symlink():
            return _last_commit(git, "/".join(parts[depth:]))
    return None


def _last_commit(git: Path, place: str) -> datetime | None:
    """Ask git in an empty repository with the clone's objects, so that no settings of it count."""
    objects, branch = git / "objects", _read(git, "HEAD", 1000).strip().removeprefix("ref: ")
    if objects.is_symlink() or not objects.is_dir() or ".." in branch:
        return None
    names = ["HEAD", "packed-refs", "shallow", *([branch] if branch.startswith("refs/") else [])]
    with tempfile.TemporaryDirectory(prefix="botschool-") as temporary:
        own = Path(temporary)
        environment = {
            "PATH": os.environ.get("PATH", ""),
            "GIT_DIR": str(own),
            "GIT_ALTERNATE_OBJECT_DIRECTORIES": str(objects.absolute()),
            "GIT_CONFIG_NOSYSTEM": "1",
            "GIT_CONFIG_GLOBAL": os.devnull,
            "GIT_LITERAL_PATHSPECS": "1",
        }
        command = ["git", "log", "-1", "--format=%ct", "HEAD", "--", place]
        try:
            for folder in ("objects", "refs"):
                (own / folder).mkdir()
            for name in names:
                if content := _read(git, name, _MAX_REFS):
                    (own / name).parent.mkdir(parents=True, exist_ok=True)
                    (own / name).write_text(content)
            done = subprocess.run(
                command, cwd=own, env=environment, capture_output=True, timeout=_SECONDS, check=True
            )
            return datetime.fromtimestamp(int(done.stdout))
        except (OSError, subprocess.SubprocessError, ValueError, OverflowError):
            return None


def _read(folder: Path, name: str, most: int) -> str:
    try:
        return read_inside(folder, name, most).decode("utf-8", "replace")
    except OSError:
        return ""
