"""Find programs, and sheets of laboratories, that resemble each other, and show them on a page.

Programs are compared as sequences of tokens, without comments, layout and names of variables. Code
of the skeleton does not count, and code that many have counts little. A similar pair is a reason to
look, not a proof.
"""

from __future__ import annotations

import ast
import io
import itertools
import keyword
import math
import re
import tokenize
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from html import escape
from types import MappingProxyType

from botschool.grading.classes.wall import Broken, walled
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number, called
from botschool.grading.report.paper import listing, paper, runs

LENGTH = 9
"""Tokens in a sequence to compare."""
LEAST, MOST_PAIRS = 0.5, 20
"""Smallest similarity of pairs to show, and their number."""
LIKE_OURS, SHARE = 0.9, 0.5
"""Smallest similarity with our solution to show, and share of the solution that is in it."""
OURS = "our solution"
EQUAL = 0.995
"""Similarity of programs that are one to the reader: a group of them is shown once."""
MIN_SEQUENCES = 15
"""Own tokens that a submission needs to be compared."""
MAX_TOKENS = 50_000
LONG = 6
"""Words of an answer that two people hardly write by chance."""


@dataclass(frozen=True)
class Program:
    """A submission's code."""

    student: str
    text: str


@dataclass(frozen=True)
class Pair:
    """Two submissions, their similarity (0 to 1), and the similar lines of each."""

    first: Program
    second: Program
    similarity: float
    lines: tuple[frozenset[int], frozenset[int]]
    also: tuple[str, ...] = ()
    """Students whose programs equal these two."""
    with_ours: bool = False
    """Whether the second one is our solution."""


def tokens(text: str) -> list[tuple[str, int]]:
    """Return (token, line) of a program, with names and numbers replaced by their kind."""
    found: list[tuple[str, int]] = []
    reader = tokenize.generate_tokens(io.StringIO(text).readline)
    skipped = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
    try:
        for token in itertools.islice(reader, MAX_TOKENS):
            if token.type in skipped:
                continue
            word = token.string
            if token.type == tokenize.NAME and not keyword.iskeyword(word):
                word = "name"
            elif token.type == tokenize.STRING:
                word = "text"
            found.append((word, token.start[0]))
    except (tokenize.TokenError, SyntaxError, ValueError, RecursionError):
        pass  # what comes before an error is compared
    return found


def _sequences(text: str) -> dict[tuple[str, ...], set[int]]:
    """Return each sequence of tokens with its lines."""
    all_of = tokens(text)
    found: dict[tuple[str, ...], set[int]] = {}
    for at in range(len(all_of) - LENGTH + 1):
        part = all_of[at : at + LENGTH]
        found.setdefault(tuple(word for word, _ in part), set()).update(line for _, line in part)
    return found


def _parts(text: str) -> list[str]:
    """Return a program's statements without layout, comments, annotations and documentation.

    The order of functions does not count, since each statement outside functions is a part.
    """
    try:
        tree = ast.parse(text)
        for node in ast.walk(tree):
            body = getattr(node, "body", None)
            if isinstance(body, list) and len(body) > 1 and isinstance(body[0], ast.Expr):
                body[:1] = [] if isinstance(body[0].value, ast.Constant) else body[:1]
            for name in ("annotation", "returns"):
                if getattr(node, name, None) and not isinstance(node, ast.AnnAssign):
                    setattr(node, name, None)
        return [ast.unparse(node) for node in tree.body]
    except (SyntaxError, ValueError, RecursionError):
        return [text]


def _both(text: str) -> tuple[set[tuple[str, ...]], dict[tuple[str, ...], set[int]]]:
    """Return the sequences of a program's parts, and those of its text with their lines."""
    return set().union(*map(_sequences, _parts(text))), _sequences(text)


def similar_pairs(programs: Sequence[Program], skeleton: str, solution: str = "") -> list[Pair]:
    """Return the similar pairs, the most similar one first, our solution among the programs.

    Right answers resemble it by nature, so only those that are nearly it are pairs with it.
    """
    ours = Program(OURS, solution)
    programs = [*programs, ours] if solution else programs
    given, given_lines = _both(skeleton)
    all_of = []
    for program in programs:
        try:
            sequences, lines = walled(_both, program.text)
        except Broken:
            continue
        if len(sequences - given) >= MIN_SEQUENCES:
            shown = {key: own for key, own in lines.items() if key not in given_lines}
            all_of.append((program, sequences - given, shown))
    having = Counter(key for _, own, _ in all_of for key in own)
    weight = {key: math.log((len(all_of) + 1) / count) for key, count in having.items()}
    sums = [sum(weight[key] for key in own) for _, own, _ in all_of]
    pairs = []
    numbered = enumerate(all_of)
    for (i, (first, a, there)), (j, (second, b, here)) in itertools.combinations(numbered, 2):
        if first.student == second.student and second is not ours:
            continue
        shorter = max(1e-9, min(sums[i], sums[j]))
        similarity = min(1.0, sum(weight[key] for key in a & b) / shorter)
        least = LEAST
        if second is ours:
            least = LIKE_OURS if len(a & b) >= SHARE * len(b) else 2.0
        if similarity >= least:
            common = there.keys() & here.keys()
            both = _lines(there, common), _lines(here, common)
            pairs.append(Pair(first, second, similarity, both, with_ours=second is ours))
    pairs.sort(key=lambda pair: (-pair.similarity, pair.first.student, pair.second.student))
    return pairs


def like_ours(pairs: Iterable[Pair]) -> dict[str, float]:
    """Return who handed in a program like our solution, and how similar it is."""
    return {pair.first.student: pair.similarity for pair in pairs if pair.with_ours}


def grouped(pairs: Sequence[Pair]) -> list[Pair]:
    """Return pairs to show: equal programs count as one."""
    groups: dict[str, frozenset[str]] = {}
    for pair in pairs:
        if pair.similarity >= EQUAL:
            names = (pair.first.student, pair.second.student)
            joined = frozenset().union(*(groups.get(name, {name}) for name in names))
            groups |= dict.fromkeys(joined, joined)
    kept, seen = [], set()
    for pair in pairs:
        names = (pair.first.student, pair.second.student)
        both = frozenset(groups.get(name, frozenset({name})) for name in names)
        if both not in seen:
            seen.add(both)
            also = sorted(next(iter(both)) - set(names)) if len(both) == 1 else ()
            kept.append(replace(pair, also=tuple(also)))
    return kept[:MOST_PAIRS]


def _lines(own: dict[tuple[str, ...], set[int]], keys: Iterable[tuple[str, ...]]) -> frozenset[int]:
    """Return the lines on which these sequences stand."""
    return frozenset(line for key in keys for line in own[key])


def _words(text: str) -> list[str]:
    """Return the words of a text, sorted, without capitals and signs."""
    return sorted(re.findall(r"\w+", unicodedata.normalize("NFC", text).casefold()))


@dataclass(frozen=True)
class Sheet:
    """A laboratory's sheet, as it was handed in."""

    student: str
    name: str
    """The name that stands in it."""
    robots: frozenset[str]
    """Hashes of the robots of its runs."""
    prediction: Mapping[str, str] = field(default_factory=dict)
    """Question -> answer."""

    @property
    def sentences(self) -> set[str]:
        """Return the long answers of the prediction, without signs and capital letters."""
        return {
            own
            for each in self.prediction.values()
            if len((own := " ".join(_words(each))).split()) >= LONG
        }


@dataclass(frozen=True)
class Doubt:
    """Sentences that say why these sheets deserve a look."""

    told: list[str]
    sheets: tuple[Sheet, ...]


def doubtful(sheets: Sequence[Sheet], people: Iterable[str]) -> list[Doubt]:
    """Return each sheet of another's name, and each two with equal runs or predictions.

    people: the names of all students. A sheet may hold a part of its student's name.
    """
    known = {person: set(_words(person)) for person in people}
    found = []
    for sheet in sheets:
        named, own = set(_words(sheet.name)), set(_words(sheet.student))
        others = [person for person, parts in known.items() if named <= parts]
        if named and not named <= own and others:
            said = (
                f"{sheet.student} handed in a sheet with the name {plain(sheet.name[:80])}, "
                f"which is that of {', '.join(others)}."
            )
            theirs = [each for each in sheets if each.student in others]
            found.append(Doubt([said], (sheet, *theirs)))
    for first, second in itertools.combinations(sheets, 2):
        if first.student == second.student:
            continue
        told, both = [], f"{first.student} and {second.student}"
        if common := len(first.robots & second.robots):
            told.append(
                f"{both} handed in the same runs: {common} of {len(first.robots)} and of "
                f"{len(second.robots)}."
            )
        if first.sentences & second.sentences:
            told.append(f"{both} give the same reason in their predictions.")
        if told:
            found.append(Doubt(told, (first, second)))
    return found


def sheets_section(number: Number, doubts: Sequence[Doubt]) -> str:
    """Return the part of the page on similar submissions that shows these sheets."""
    shown = []
    for doubt in doubts:
        told = "".join(f"<p>{escape(each)}</p>" for each in doubt.told)
        sides = "".join(map(_side, doubt.sheets))
        shown.append(f'<section>{told}<div class="both">{sides}</div></section>')
    return f"<h1>{called(number)}: sheets to look at</h1>{''.join(shown)}"


def _side(sheet: Sheet) -> str:
    answers = "".join(
        f"<dt>{escape(what)}</dt><dd>{escape(plain(text))}</dd>"
        for what, text in sheet.prediction.items()
    )
    about = f"name: {plain(sheet.name[:80]) or 'none'}; runs: {len(sheet.robots)}"
    return f"<div><h2>{escape(sheet.student)}</h2><p>{escape(about)}</p><dl>{answers}</dl></div>"


_STYLE = """
.pair { display: none; }
.pair:target { display: block; }
main:has(.pair:target) > :not(.pair) { display: none; }
.both { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 1rem;
 margin-top: .6rem; }
.both h3 { margin: 0 0 .3rem; font-size: 1rem; }
main { max-width: 90rem; }
nav { display: flex; justify-content: space-between; margin-bottom: .6rem; }
@media (max-width: 40rem) { .both { grid-template-columns: minmax(0, 1fr); } }
@media print { nav { display: none; } .pair { display: block; break-before: page; } }
"""


def similarity_page(
    found: dict[int, tuple[int, list[Pair]]],
    sheets: Iterable[str] = (),
    skeletons: Mapping[Number, str] = MappingProxyType({}),
) -> str:
    """Return a page without scripts, which shows one pair at a time.

    found: exercise -> programs compared, and pairs. sheets: parts of the page on laboratories.
    skeletons: the exercises' files, whose lines are folded.
    """
    body, pages = [*sheets], []
    for number, (count, pairs) in found.items():
        body.append(f"<h1>Exercise {number}: {len(pairs)} similar pairs of {count} programs</h1>")
        names = [f"e{number}p{index}" for index in range(len(pairs))]
        items = "".join(
            f'<li><a href="#{name}">{_title(pair)}</a></li>'
            for name, pair in zip(names, pairs, strict=True)
        )
        body.append(f"<ol>{items}</ol>" if pairs else "")
        for at, (name, pair) in enumerate(zip(names, pairs, strict=True)):
            after = names[at + 1] if at + 1 < len(names) else "top"
            skeleton = skeletons.get(number, "")
            both = _listing(pair.first, pair.lines[0], skeleton)
            both += _listing(pair.second, pair.lines[1], skeleton)
            pages.append(
                f'<section class="pair" id="{name}"><nav><a href="#top">all pairs</a>'
                f'<a href="#{after}">{"next" if after != "top" else "all pairs"}</a></nav>'
                f'<h2>{_title(pair)}</h2><div class="both">{both}</div></section>'
            )
    about = (
        '<p id="top" class="soft">Compared without comments, layout and the names of variables; '
        "what the skeleton holds does not count, and what many have counts little. A similar pair "
        "is a reason to look, and no proof.</p>"
    )
    return paper("Similar submissions", "\n".join([about, *body, *pages]), _STYLE)


def _title(pair: Pair) -> str:
    names = f"{escape(pair.first.student)} and {escape(pair.second.student)}"
    also = f"; also {escape(', '.join(pair.also))}" if pair.also else ""
    return f"{round(100 * pair.similarity)}%: {names}{also}"


def _listing(program: Program, lines: frozenset[int], skeleton: str) -> str:
    code = "".join(
        listing(program.text, first, end, given, lines)
        for first, end, given in runs(program.text, skeleton)
    )
    return f"<div><h3>{escape(program.student)}</h3>{code}</div>"
