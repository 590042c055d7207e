"""Copy the repository for students: everything to build and work with, and no answers."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.copies.links import leave_out_what_no_text_shows
from botschool.grading.copies.skeleton import find_leaks, pairs, skeleton
from botschool.grading.declare import weights
from botschool.grading.declare.exercise import exercise_numbers, folder_of
from botschool.grading.declare.mistakes import case_text
from botschool.grading.declare.trust import check_trusted, trust
from botschool.grading.packed import PACKED, is_packed, pack, pack_answers, pack_module
from botschool.output import written_whole
from botschool.paths import material
from botschool.sandbox.scratch import remove_tree

RELEASED = (
    "lib", "data", "exercises", "tools", "docs", "Makefile", "pyproject.toml", "constraints.txt",
    "LICENSE", ".gitignore",
)  # fmt: skip
"""At the top of the repository; other files are not copied (exercise 10 builds envs/)."""
COMPILED = re.compile(r"lib/(?!walkthroughs/)|pyproject\.toml$|tools/(material|build_backend)")
"""Only in a copy that compiles botschool."""
WHEELS = "wheels"
"""In a copy that installs botschool: a folder for its wheels."""
MANIFEST = ".release.json"
"""In the copy: the digest of every released file, and the skeletons' texts."""
START = "exercises/README.md"
"""The students' start page; the copy gets it as README.md, too."""
_WITHHELD = re.compile(
    r"docs/(reports/)?(instructor|answer|solution|architecture|algorithms|cluster|results\.|evolution|images/learning)"
    r"|^exercises/ex\d\d_[^/]*/slips\.py$|^lib/(?!botschool/labs/lab\d\d\.).*\.md$|^docs/book/|^tools/(figures/|studies/|wheels)"
    r"|(^|/)(__pycache__|\..*_cache|results)/"
    r"|\.(pyc|so|pyd|dylib|dll|ipynb|egg-info)$|(^|/)(?!\.gitignore$)\.[^/]*$",
    re.IGNORECASE,
)
_NOT_RELEASED = re.compile(
    r"^[^\n]*\bBEGIN NOT RELEASED\b.*?\bEND NOT RELEASED\b[^\n]*\n", re.DOTALL | re.MULTILINE
)
"""Lines of a text that are left out of the copy."""


@dataclass
class Released:
    """Result of a release."""

    files: int
    """Number of files in the copy."""
    written: int
    """Number of new or changed files."""
    edited: list[str] = field(default_factory=list)
    """Files that were left alone, because somebody has edited them."""
    unknown: str = ""
    """Why the user's trust in the copy could not be noted."""


def release(
    root: Path,
    target: Path,
    numbers: set[int] | None = None,
    with_answers: bool | None = None,
    trusted: bool = True,
    compiled: bool = True,
    wheels: Sequence[Path] = (),
    pages: bool = True,
    tasks: str = "",
) -> Released:
    """Make the copy, or update it.

    root: the repository, or the material of an installed package.
    numbers: the exercises; None for all.
    with_answers: whether to pack the answers to the questions, which students see after full marks;
    None for yes in a new copy, and in another one if it has some.
    trusted: whether the user may run the copy's graders at its place.
    compiled: whether the copy gets botschool's source and compiles it; otherwise it uses the
    installed botschool, or installs one of the wheels.
    pages: whether each exercise gets its living page.
    tasks: points of tasks, as in declare/weights.py.

    The function makes a new copy as a whole or not at all. An existing copy keeps its exercises,
    files that somebody has edited, and .git. Raises BotschoolError.
    """
    root, target = root.resolve(), target.absolute()
    check_trusted(root)  # a repository's settings may name programs that git runs
    manifest = _check(root, target)
    source = [path for path in root.glob("lib/*") if path.name != "walkthroughs"]
    compiled = compiled and not wheels and bool(source)
    for number in sorted(numbers or ()):
        folder_of(number, root)
    numbers = set(exercise_numbers(root) if numbers is None else numbers)
    for name in manifest:
        if found := re.match(r"exercises/ex(\d\d)_", name):
            numbers = numbers | {int(found[1])}
    if with_answers is None:
        with_answers = not manifest or any(name.endswith(f"/{PACKED}") for name in manifest)
    with _temporary(target) as made:
        _build(root, made, numbers, compiled)
        if tasks:
            (made / weights.FILE).write_text(f"{tasks}\n", encoding="utf-8")
        for wheel in wheels:
            (made / WHEELS).mkdir(exist_ok=True)
            shutil.copy(wheel, made / WHEELS)
        _pack_answers(root, made, with_answers)
        if pages:
            _add_pages(made)
        files = _finish(root, made)
        if not target.is_dir() or not any(target.iterdir()):
            return _placed(made, target, Released(len(files), len(files)), trusted)
        try:
            return _update(made, target, manifest, files)
        except OSError as error:
            raise BotschoolError(
                f"Cannot write {error.filename} ({error.strerror}): the copy is not up to "
                "date yet, try again."
            ) from None


def _finish(root: Path, made: Path) -> dict[str, str]:
    """Write the manifest and return the digests. Raises BotschoolError for a part of a solution."""
    for path, line in find_leaks(root, (path for path in made.rglob("*") if path.is_file()))[:1]:
        raise BotschoolError(
            f"{path.relative_to(made)} contains a part of a solution ('{line[:60]}'): "
            "nothing was released. Remove that part and try again."
        )
    files = _digests(made)
    names = [name for name in _skeletons_of(root) if name in files]
    skeletons = {name: (made / name).read_text(encoding="utf-8") for name in names}
    text = json.dumps({"files": files, "skeletons": skeletons}, indent=1, sort_keys=True)
    (made / MANIFEST).write_text(text + "\n", encoding="utf-8")
    return files


def _placed(made: Path, target: Path, done: Released, trusted: bool) -> Released:
    """Move a new copy to its place."""
    made.chmod(0o755)
    if target.is_dir():
        target.rmdir()
    made.rename(target)
    try:
        if trusted:
            trust(target)
    except BotschoolError as error:  # the copy still works in other places
        done.unknown = str(error)
    return done


def _check(root: Path, target: Path) -> dict[str, str]:
    """Return the digests of an existing copy, {} for a new one. Raises BotschoolError."""
    if not (root / "solutions").is_dir() and root != material():
        raise BotschoolError(f"{root} is a student's copy already: run this in the repository.")
    if target.is_symlink() or (target.exists() and not target.is_dir()):
        raise BotschoolError(f"{target} is not a folder: name a new one.")
    for name in (*RELEASED, "solutions"):
        if target.resolve().is_relative_to(root / name):
            raise BotschoolError(f"{target} is inside the course's {name}: choose another place.")
    if not target.is_dir() or {path.name for path in target.iterdir()} <= {".git"}:
        return {}
    if not (target / MANIFEST).is_file():
        raise BotschoolError(
            f"{target} is not empty and not a copy made by botschool release: name a new folder."
        )
    try:
        return dict(json.loads((target / MANIFEST).read_text(encoding="utf-8"))["files"])
    except (OSError, ValueError, KeyError, TypeError):
        raise BotschoolError(
            f"{target / MANIFEST} is damaged, so edited files cannot be recognised: name a "
            "new folder."
        ) from None


@contextmanager
def _temporary(target: Path) -> Iterator[Path]:
    """Yield a folder beside the target; remove it at the end if it is still there."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    except OSError as error:
        raise BotschoolError(f"Cannot make {target} ({error.strerror}).") from None
    try:
        yield made
    finally:
        if made.exists():
            remove_tree(made)


def _skeletons_of(root: Path) -> list[str]:
    """Return the paths of the files that students write into."""
    if (root / "solutions").is_dir():
        return [place.relative_to(root).as_posix() for _, place in pairs(root)]
    return list(json.loads((root / MANIFEST).read_text(encoding="utf-8"))["skeletons"])


def _build(root: Path, made: Path, numbers: set[int], compiled: bool) -> None:
    """Write the whole copy into an empty folder."""
    for path in released_files(root, numbers):
        if not compiled and COMPILED.match(path.relative_to(root).as_posix()):
            continue
        place = made / path.relative_to(root)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, place)
        _change(place, lambda text: _without_tests(_NOT_RELEASED.sub("", text)))
    for solution, place in pairs(root):
        if _number(place, root) in numbers:
            released = made / place.relative_to(root)
            released.parent.mkdir(parents=True, exist_ok=True)
            text = skeleton(solution.read_text(encoding="utf-8"))
            released.write_text(text, encoding="utf-8", newline="\n")
    for grader in made.glob("exercises/ex[0-9][0-9]_*/test_*.py"):
        _change(grader, partial(_packed, root=root, folder=grader.parent.name))
    pack_measures(made / "lib" / "botschool", made / "lib" / "botschool")
    if not compiled:
        leave_out_what_no_text_shows(made)
    start = made / START
    if start.is_file():
        _change(start, lambda text: _rows(text, start.parent))
        text = start.read_text(encoding="utf-8").replace("](ex", "](exercises/ex")
        text = text.replace("](../", "](")
        (made / "README.md").write_text(text, encoding="utf-8", newline="\n")


def _without_tests(text: str) -> str:
    """Return a text whose tables lack the last column, if it names the repository's tests."""
    text = re.sub(r"^(\|.*\|) test \|\n(\|---\|---\|)---\|$", r"\1\n\2", text, flags=re.MULTILINE)
    return re.sub(r"^(\|.*\|)[^|\n]*`tests/[^|\n]*\|$", r"\1", text, flags=re.MULTILINE)


def _packed(grader: str, root: Path, folder: str) -> str:
    """Return a grader packed with its solution, wrong ones, and right ones in other styles."""
    file = re.search(r'file="([^"]+)"', grader)
    if is_packed(grader) or not file:
        return grader
    solution = (root / "solutions" / folder / file[1]).read_text(encoding="utf-8")
    return pack(grader, solution, case_text(root, int(folder[2:4])))


def pack_measures(package: Path, target: Path) -> None:
    """Pack the modules that check laboratories; target: the package that receives them."""
    for measures in package.glob("labs/lab[0-9][0-9].py"):
        text = measures.read_text(encoding="utf-8")
        place = target / measures.relative_to(package)
        place.parent.mkdir(parents=True, exist_ok=True)
        packed = text if is_packed(text) else pack_module(text)
        place.write_text(packed, encoding="utf-8", newline="\n")


def _pack_answers(root: Path, made: Path, wanted: bool) -> None:
    """Pack the answers of a repository; take away those of a wheel if they are not wanted."""
    for text in root.glob("solutions/ex[0-9][0-9]_*/README.md"):
        folder = made / "exercises" / text.parent.name
        if folder.is_dir():
            packed = pack_answers(text.read_text(encoding="utf-8"))
            (folder / PACKED).write_text(packed, encoding="ascii", newline="\n")
    for packed_file in () if wanted else made.glob(f"exercises/*/{PACKED}"):
        packed_file.unlink()


def _add_pages(made: Path) -> None:
    """Write each exercise's living page beside its text."""
    # A wheel is built before the module that pages need.
    from botschool.page.exercise import PAGE, has_page, linked, write_exercise_page

    for text in sorted(made.glob("exercises/ex[0-9][0-9]_*/README.md")):
        if not has_page(text.parent):
            continue
        write_exercise_page(text.parent)
        _change(text, partial(linked, target=PAGE))


def _change(path: Path, change) -> None:
    """Rewrite a file, if it is text."""
    try:
        text = path.read_bytes().decode()
    except UnicodeDecodeError:
        return
    changed = change(text)
    if changed != text:
        path.write_text(changed, encoding="utf-8", newline="\n")


def _rows(text: str, folder: Path) -> str:
    """Return a text without table rows that link to missing exercises."""
    return "".join(
        line
        for line in text.splitlines(keepends=True)
        if not line.startswith("|")
        or all((folder / name).is_file() for name in re.findall(r"\]\((ex[^)]+)\)", line))
    )


def _update(made: Path, target: Path, before: dict[str, str], files: dict[str, str]) -> Released:
    """Update files that nobody has edited, and remove files that are no longer released."""
    done = Released(len(files), 0)
    for name, digest in files.items():
        present = _digest(target, name)
        if present == digest:
            continue
        if present is not None and present != before.get(name):
            done.edited.append(name)
            continue
        place = target / name
        place.parent.mkdir(parents=True, exist_ok=True)
        with written_whole(place) as temporary:
            shutil.copy2(made / name, temporary)
        done.written += 1
    for name in before.keys() - files.keys():
        if _digest(target, name) == before[name]:
            (target / name).unlink()
    with written_whole(target / MANIFEST) as temporary:
        shutil.copy2(made / MANIFEST, temporary)
    return done


def _digests(folder: Path) -> dict[str, str]:
    """Return path -> digest of all files in a folder."""
    names = (path.relative_to(folder) for path in sorted(folder.rglob("*")) if path.is_file())
    return {name.as_posix(): _digest(folder, name.as_posix()) for name in names}


def _digest(folder: Path, name: str) -> str | None:
    """Return the digest of a file's content.

    None if nothing is there, "" if it is not a plain file or is behind a link.
    """
    place = folder
    for part in Path(name).parts:
        place = place / part
        if place.is_symlink():
            return ""
        if not place.exists():
            return None if place.parent.is_dir() else ""
    if not place.is_file():
        return ""
    return hashlib.sha256(place.read_bytes()).hexdigest()


def released_files(root: Path, numbers: set[int] | None = None) -> list[Path]:
    """Return the files to copy, without the exercises' own files, which are generated."""
    generated = {place for _, place in pairs(root)}
    return [
        path
        for path in _candidates(root)
        if path.relative_to(root).parts[0] in RELEASED
        and not _WITHHELD.search(path.relative_to(root).as_posix())
        and not path.is_symlink()
        and path.is_file()
        and path not in generated
        and (numbers is None or _number(path, root) in {None, *numbers})
    ]


def _number(path: Path, root: Path) -> int | None:
    """Return the exercise that a file belongs to; None if it belongs to none."""
    found = re.match(
        r"(?:exercises|docs/images/course)/ex(\d\d)_", path.relative_to(root).as_posix()
    )
    return int(found[1]) if found else None


def _candidates(root: Path) -> list[Path]:
    """Return the repository's files, without those that git ignores, if there is git."""
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others"]
    try:
        done = subprocess.run([*command, "--exclude-standard"], capture_output=True, check=True)
        names = done.stdout.decode(errors="surrogateescape").split("\0")
        return sorted({root / name for name in names if name})
    except (OSError, subprocess.CalledProcessError):
        tops = [root / name for name in RELEASED]
        return sorted(path for top in tops for path in (top, *top.rglob("*")) if path.is_file())
