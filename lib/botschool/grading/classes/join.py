"""Join the rows of a table with the entries of a download by equal values, never by likeness.

docs/specification.md, "Who is who".
"""

from __future__ import annotations

import itertools
import re
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from botschool.grading.declare.checks import plain

Values = Mapping[str, str]
"""Where a value stands (a table's column, a part of a name) -> the value."""
WHOLE = "the whole name"
ENOUGH = 3
"""Rows that a pair joins if it is no chance."""
_MOST_PIECES, _MOST_WORDS = 8, 6
_DERIVED = " \u2192 "
"""Stands in the label of a value that is computed from a cell."""
_MARKS = re.compile("[\u200e\u200f\u202a-\u202e\u2066-\u2069\ufeff]")
_CUTS = (
    ("", re.compile("_+")),
    (" cut at dashes", re.compile(r"\s+[-\u2013\u2014]+\s+")),
    (" cut at brackets", re.compile(r"\s*[()\[\]{}]+\s*")),
    (" cut at commas", re.compile(r"\s*,\s*")),
    (" cut at hyphens", re.compile("-")),
    (" cut at spaces", re.compile(r"\s+")),
    (" cut at @", re.compile(r"@\S*")),
)
_NUMBERS_ONLY = {
    " cut at commas": re.compile(r"[\d@,]"),
    " cut at spaces": re.compile(r"^\S*[\d@]\S*$"),
}
"""What parts of these cuts must have: a first name alone identifies nobody, and Anna Maria Rossi is
not Maria Rossi.
"""
_NUMBERED = re.compile(r"(\D*)(\d+)(\D*)")


def clean(text: str) -> str:
    """Return a value as it is compared: composed letters, single spaces, no marks of direction."""
    return " ".join(_MARKS.sub("", unicodedata.normalize("NFC", text)).split())


def folded(text: str) -> str:
    """Return a value without the difference of capitals; "Berg, Ada" is "Ada Berg"."""
    text = clean(text)
    if text.count(",") == 1:
        last, first = text.split(",")
        text = f"{first.strip()} {last.strip()}".strip()
    return unicodedata.normalize("NFC", text.casefold())


def is_name(text: str) -> bool:
    """Return whether a value looks like a person's full name: two words without digits."""
    letters = not any(each.isdigit() or each in "@_" for each in text)
    return letters and len(clean(text).split()) > 1


def cut(name: str) -> dict[str, str]:
    """Return the parts of a name of a file or folder: the whole, and what stands between signs."""
    found, waiting = {WHOLE: name}, [("", name)]
    for kind, sign in _CUTS:
        inner = []
        for outer, text in waiting:
            if kind == " cut at hyphens" and " " in text:  # Anne-Marie Berg is not Marie Berg
                continue
            for label, part, single in _runs(text, sign, kind):
                if kind in _NUMBERS_ONLY and not _NUMBERS_ONLY[kind].search(part):
                    continue
                found.setdefault(outer + label, part)
                if "_" in part:
                    found.setdefault(f"{outer}{label} as words", part.replace("_", " "))
                inner += [(f"{outer}{label}, ", part)] * single
        waiting += inner
    return found


def _runs(text: str, sign: re.Pattern, kind: str) -> Iterator[tuple[str, str, bool]]:
    """Yield (label, part, whether it is a single piece) of the pieces of a text, and of runs."""
    spans, at = [], 0
    for found in sign.finditer(text):
        spans.append((at, found.start()))
        at = found.end()
    spans = [(a, b) for a, b in [*spans, (at, len(text))] if a < b]
    count = len(spans)
    if count == 1 and spans[0] != (0, len(text)):
        yield f"part 1{kind}", text[slice(*spans[0])], True
    if count < 2:
        return
    for i, (first, end) in enumerate(spans):
        yield f"part {i + 1}{kind}", text[first:end], True
        for j in range(i + 1, count + 1) if count <= _MOST_PIECES else (i + 1,):
            part, left = text[first : spans[j - 1][1]], count - j
            until = f"part {left + 1} from the end" if left else "the last part"
            if i or left:
                yield f"part {i + 1} to {until}{kind}", part, False
            if j > i + 1:
                yield f"parts {i + 1} to {j}{kind}", part, False
            else:
                yield f"part {left + 1} from the end{kind}", part, False


def derive(rows: Sequence[dict[str, str]], labels: Sequence[str]) -> None:
    """Add values computed from a table's cells.

    The number in "Participant 9001" if all cells of the column have the same words around it, a
    cell without signs that all have in front, what stands before an @, two neighbours as one name,
    and a name in one word from each of its later words on, as Canvas writes it: bergada.
    """
    for label in labels:
        cells = [row[label] for row in rows if row.get(label)]
        found = [_NUMBERED.fullmatch(cell) for cell in cells]
        around = {(each[1], each[3]) for each in found if each}
        signs = {re.match(r"\W*", cell)[0] for cell in cells}
        for row in rows:
            cell = row.get(label, "")
            if cell and all(found) and len(around) == 1 and around != {("", "")}:
                row[f"{label}{_DERIVED}the number"] = _NUMBERED.fullmatch(cell)[2]
            elif cell and len(signs) == 1 and signs != {""}:
                row[f"{label}{_DERIVED}without {min(signs)}"] = cell[len(min(signs)) :]
            if cell.count("@") == 1 and " " not in cell:
                row[f"{label}{_DERIVED}before the @"] = cell.partition("@")[0]
            words = ["".join(filter(_is_letter, word)) for word in folded(cell).split()]
            for at in range(1, len(words)) if is_name(cell) and len(words) <= _MOST_WORDS else ():
                row[f"{label}{_DERIVED}in one word from {at + 1}"] = "".join(
                    words[at:] + words[:at]
                )
    for a, b in itertools.pairwise(labels):
        for row in rows:
            both = row.get(a, ""), row.get(b, "")
            if all(both) and is_name(" ".join(both)):
                row[f"{a}{_DERIVED}with {b}"] = " ".join(both)
                row[f"{b}{_DERIVED}with {a}"] = " ".join(reversed(both))


def _is_letter(sign: str) -> bool:
    """Return whether a sign is a letter, a digit, or a vowel or accent of its own."""
    return sign.isalnum() or unicodedata.category(sign)[0] == "M"


def _is_derived(label: str) -> bool:
    return _DERIVED in label


@dataclass
class Joined:
    """Which row each entry has."""

    rows: list[int | None]
    label: str = ""
    """The column of the pair that joins most."""
    said: str = ""
    """How, in one line."""
    why: dict[int, str] = field(default_factory=dict)
    """An entry without a row -> why it is doubtful."""


@dataclass
class _Pair:
    label: str
    part: str
    of: dict[int, int]
    """Entry -> row."""

    @property
    def count(self) -> int:
        return len(set(self.of.values()))

    def agrees(self, of: Mapping[int, int]) -> bool:
        """Return whether it says the same of some entries, and of none another."""
        both = [entry for entry in self.of if entry in of]
        return bool(both) and all(self.of[entry] == of[entry] for entry in both)


def join(
    rows: Sequence[Values],
    names: Sequence[str],
    entries: Sequence[Values],
    loose: Sequence[bool] = (),
    what: str = "names",
) -> Joined:
    """Return the row of each entry, by the pair (column, part) that joins most rows one to one.

    names: of the rows, to be shown. loose: which entries are single files, of which a person may
    have several. what: whose parts these are, in words.
    """
    pairs, shared = _pairs(rows, entries, loose)
    pairs = _without_words(pairs, rows)
    joined = Joined([None] * len(entries))
    if not pairs:
        joined.why = _ambiguous(pairs, shared)
        return joined
    best = max(pairs, key=lambda pair: (pair.count, not _is_derived(pair.label)))
    others = [p for p in pairs if p is not best and 2 * p.count >= best.count]
    rivals = [p for p in others if _is_derived(best.label) or not _is_derived(p.label)]
    proven = best.count >= ENOUGH or any(
        p.agrees(best.of) for p in pairs if p.label != best.label and p.part != best.part
    )
    of: dict[int, int] = {}
    for entry, row in best.of.items():
        other = next((p for p in rivals if p.of.get(entry, row) != row), None)
        if other:
            joined.why[entry] = (
                f"{_shown(best.label)} says {plain(names[row])}, {_shown(other.label)} says "
                f"{plain(names[other.of[entry]])}"
            )
        elif not proven and _differ(names[row], rows[row], entries[entry]):
            joined.why[entry] = f"{_shown(best.label)} says {plain(names[row])}: another name"
        else:
            of[entry] = row
    _join_left(pairs, best, rows, entries, of, joined.why, names)
    for entry, row in of.items():
        joined.rows[entry] = row
    unjoined = {entry for entry in range(len(entries)) if entry not in of}
    doubts = _ambiguous([best], shared)
    joined.why |= {e: why for e, why in doubts.items() if e in unjoined and e not in joined.why}
    joined.label = best.label
    joined.said = (
        f"joined by {_shown(best.label)} and {plain(best.part)} of the {what}: {len(of)} of "
        f"{len(entries)}"
    )
    return joined


def _pairs(
    rows: Sequence[Values], entries: Sequence[Values], loose: Sequence[bool]
) -> tuple[list[_Pair], dict[tuple[str, str], dict[int, str]]]:
    """Return the pairs that join something, and the values that several have."""
    index: dict[str, dict[str, list[int]]] = defaultdict(lambda: defaultdict(list))
    for at, row in enumerate(rows):
        for label, text in row.items():
            if text:
                index[folded(text)][label].append(at)
    hits: dict[tuple[str, str], dict[int, int]] = defaultdict(dict)
    shared: dict[tuple[str, str], dict[int, str]] = defaultdict(dict)
    for at, parts in enumerate(entries):
        for part, text in parts.items():
            for label, there in index.get(folded(text), {}).items():
                same = there
                if len(there) > 1:
                    same = [row for row in there if clean(rows[row][label]) == clean(text)]
                if len(same) == 1:
                    hits[label, part][at] = same[0]
                else:
                    shared[label, part][at] = text
    found = []
    for (label, part), of in hits.items():
        counts = Counter(of.values())
        several = len(counts) > 1
        alone = {
            entry: row
            for entry, row in of.items()
            if counts[row] == 1 or (several and loose and loose[entry])
        }
        shared[label, part] |= {e: entries[e][part] for e in of if e not in alone}
        found += [_Pair(label, part, alone)] * bool(alone)
    return found, shared


def _without_words(pairs: list[_Pair], rows: Sequence[Values]) -> list[_Pair]:
    """Return the pairs without columns of first names, where the whole names join as well."""
    most = max((pair.count for pair in pairs), default=0)
    whole = {pair.label for pair in pairs if 2 * pair.count >= most}

    def is_word(pair: _Pair, label: str) -> bool:
        joined = set(pair.of.values())
        within = [
            folded(rows[row][pair.label]) in words
            for row in joined
            if len(words := folded(rows[row].get(label, "")).split()) > 1
        ]
        return label != pair.label and sum(within) * 2 > len(joined)

    return [pair for pair in pairs if not any(is_word(pair, label) for label in whole)]


def _join_left(
    pairs: list[_Pair],
    best: _Pair,
    rows: Sequence[Values],
    entries: Sequence[Values],
    of: dict[int, int],
    why: dict[int, str],
    names: Sequence[str],
) -> None:
    """Join what the best pair leaves, where pairs that never differ from it say the same.

    They join nobody for whom the best pair's values exist and differ.
    """
    taken, proposed = set(of.values()), defaultdict[int, set[int]](set)
    for pair in pairs:
        is_whole = pair.part == WHOLE and pair.label == best.label and not {*pair.of} & {*of}
        if pair is best or not (is_whole or pair.agrees(of)):
            continue
        for entry, row in pair.of.items():
            if entry in of or entry in why or row in taken:
                continue
            here, there = rows[row].get(best.label, ""), entries[entry].get(best.part, "")
            if pair.label == best.label or not (here and there) or folded(here) == folded(there):
                proposed[entry].add(row)
            else:
                why[entry] = (
                    f"{_shown(pair.label)} says {plain(names[row])}, but {_shown(best.label)} "
                    "differs"
                )
    counts = Counter(row for said in proposed.values() for row in said)
    for entry, said in proposed.items():
        if len(said) == 1 and counts[min(said)] == 1:
            of[entry] = min(said)
            why.pop(entry, None)
        else:
            shown = ", ".join(plain(names[row]) for row in sorted(said))
            why[entry] = f"it may be {shown}"


def _ambiguous(pairs: list[_Pair], shared: Mapping[tuple[str, str], dict[int, str]]) -> dict:
    """Return why entries are doubtful whose value several people or entries have."""
    keys = [(p.label, p.part) for p in pairs] or [*shared]
    found: dict[int, str] = {}
    for key in keys:
        for entry, text in shared.get(key, {}).items():
            if is_name(text) or pairs:
                found.setdefault(entry, f"several have {_shown(key[0])} '{plain(text)}'")
    return found


def _differ(name: str, row: Values, parts: Values) -> bool:
    """Return whether an entry has a full name, a row has one, too, and it is another.

    name: of the row, to be shown.
    """
    own = [folded(part) for part in parts.values() if is_name(part)]
    names = [re.escape(folded(text)) for text in (name, *row.values()) if is_name(text)]
    same = re.compile(rf"(?<!\w)(?:{'|'.join(names)})(?!\w)")
    return is_name(name) and bool(own) and not any(map(same.search, own))


def _shown(label: str) -> str:
    column, arrow, more = label.partition(_DERIVED)
    return f"the column '{plain(column)}'" + (f" ({plain(more)})" if arrow else "")
