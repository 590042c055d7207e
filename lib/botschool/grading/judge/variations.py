"""Vary our solution by typical slips, one at a time, with a sentence that names each slip.

A slip is another operator, function, index or argument, a part left out, or a step in another
place. `variations` yields the functions of a task with one slip each; known.py compares their
answers with a submission's. A sentence quotes only what the task's text says as well.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterable, Iterator
from typing import Any

from botschool.grading.judge.evidence import EXCHANGED, pattern, quoted
from botschool.grading.judge.expressions import (
    FIRST,
    LAST,
    OTHER,
    SIGNS,
    Edit,
    Expressions,
    is_common,
)
from botschool.grading.judge.sentences import (
    Quotes,
    Variation,
    colon,
    holds_everywhere,
    placed,
    without_quotes,
)

_REGION = re.compile(r"### BEGIN SOLUTION task (\d+\.\d+).*?### END SOLUTION", re.DOTALL)
_FUNCTIONS = (ast.FunctionDef, ast.ClassDef)
_SKIPPED = {
    (ast.FunctionDef, "decorator_list"), (ast.FunctionDef, "args"), (ast.FunctionDef, "returns"),
    (ast.AnnAssign, "annotation"),
}  # fmt: skip
"""Fields of nodes that hold no steps."""
MOST_NAMES = 16
"""Variables of a function that are tried for one another."""
_SIGNED = {(ast.Assign, "value"), (ast.Dict, "values"), (ast.Return, "value")}
"""Fields of nodes that hold whole results."""
Place = tuple[Any, str, "int | None", Any, str]
"""A node, the field and the index of a part in it, the part, and what is made of it."""


def variations(solution: str, task: str, styles: Iterable[str] = ()) -> Iterator[Variation]:
    """Yield the solution with one slip in a task's functions, then with one made everywhere.

    styles: right solutions in other styles, whose functions are then varied, too. A vague sentence
    is not said of them if it is true of our solution, with another answer.
    """
    public = _REGION.sub("", solution)
    done, said = {solution}, set[str]()
    for text in (solution, *styles):
        for each in _of_one(text, task, public, done, own=text is solution):
            if each.own:
                said.add(each.what)
            if each.own or not each.vague or each.what not in said:
                yield each


def _of_one(text: str, task: str, public: str, done: set[str], own: bool) -> Iterator[Variation]:
    """Yield the slips in one solution, unless they are done.

    own: whether it is our solution, and not one in another style, whose variables nobody knows.
    """
    regions = [
        range(*(text.count("\n", 0, at) + 1 for at in found.span()))
        for found in _REGION.finditer(text)
        if found[1] == task
    ]
    lines = text.splitlines(keepends=True)
    named = [node for node in ast.parse(text).body if isinstance(node, _FUNCTIONS)]
    last = {node.name: node for node in named}
    functions: list[Any] = []
    for node in named:
        in_task = any(node.lineno <= region.start <= (node.end_lineno or 0) for region in regions)
        if in_task and last[node.name] not in functions:
            functions.append(last[node.name])
            if last[node.name] is not node:  # written anew, below
                regions.append(range(functions[-1].lineno, (functions[-1].end_lineno or 0) + 1))
    done |= {ast.unparse(function) for function in functions}
    several: list[tuple[Any, str, list[Edit]]] = []
    for function in functions:
        where = f"In `{function.name}`: " if len(functions) > 1 else ""
        slips = _Slips(public, regions, function, own)
        found: dict[tuple[str, str], list[Edit]] = {}
        for what, place, edits in slips.all():
            if not own and len(edits) == 1 and _hidden(edits[0], what):
                continue  # a number in code that nobody has seen
            yield from _made(lines, function, where + placed(place, what), edits, done, own)
            if len(edits) == 1:
                found.setdefault((without_quotes(what), ""), []).append(edits[0])
                found.setdefault((what, place or str(edits[0].line)), []).append(edits[0])
        several += [(function, where + what, edits) for (what, _), edits in found.items()]
    for function, what, edits in several:
        if len(edits) > 1 and holds_everywhere(what):
            yield from _made(lines, function, what, edits, done, own)


def _hidden(edit: Edit, what: str) -> bool:
    """Return whether a slip changes a number that its sentence does not name."""
    new = edit.new
    if isinstance(new, ast.UnaryOp):
        new = new.operand
    return isinstance(new, ast.Constant) and what.startswith("A number is") and "`" not in what


def _made(
    lines: list[str], function: Any, what: str, edits: list[Edit], done: set[str], own: bool
) -> Iterator[Variation]:
    """Yield the variation that edits make, unless it is there already or no longer Python."""
    for edit in edits:
        edit.swap()
    try:
        text = ast.unparse(function)
        whole = edits[0].node if isinstance(edits[0].node, ast.expr) else edits[0].new
        shown = pattern(whole, quoted(what)) if EXCHANGED in what and len(edits) == 1 else ""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            compile(text, "<variation>", "exec")
    except (SyntaxError, ValueError, TypeError, AttributeError, RecursionError):
        text = ""
    for edit in reversed(edits):
        edit.swap()
    if text and text not in done:
        done.add(text)
        first, last = function.lineno - 1, function.end_lineno
        first -= sum(1 for _ in function.decorator_list)
        text = "".join([*lines[:first], text, "\n", *lines[last:]])
        sign = SIGNS.get(type(edits[0].new), "") if isinstance(edits[0].new, ast.cmpop) else ""
        yield Variation(what, text, own, shown, function.name, sign)


class _Slips:
    """The slips of a function: sentences with edits."""

    def __init__(self, public: str, regions: list[range], function: ast.AST, own: bool) -> None:
        self._own = own
        self._regions = regions
        self._function = function
        parameters = [
            arg.arg
            for node in ast.walk(function)
            if isinstance(node, ast.FunctionDef)
            for arg in (*node.args.args, *node.args.kwonlyargs)
            if arg.arg != "self"
        ]
        self._parts = Expressions(Quotes(public, own), parameters)

    def all(self) -> Iterator[tuple[str, str, list[Edit]]]:
        """Yield all slips as (sentence, place, edits); slips of numbers come last: many fit."""
        places = list(self._places(self._function))
        for node, field, at, part, place in places:
            if isinstance(part, ast.expr) and not isinstance(part, ast.Constant):
                for what, edit in self._parts.inside(part):
                    yield what, place, [edit]
                for what, new in self._parts.others(part):
                    said = _of_its_place(what, node, field, part, new)
                    if said:
                        yield said, place, [Edit(node, field, at, new)]
        yield from self._exchanged(places)
        for node, field, at, part, place in places:
            if (type(node), field) in _SIGNED and not isinstance(part, (ast.Constant, ast.Dict)):
                negative = ast.UnaryOp(ast.USub(), part)
                whole = place or isinstance(node, ast.Return)
                what = "The sign is reversed" + ("." if whole else ", of the whole or of a part.")
                yield what, place, [Edit(node, field, at, negative)]
        for node in {id(each[0]): each[0] for each in places}.values():
            if isinstance(node, (ast.For, ast.comprehension)):
                for what, new in self._parts.passes(node):
                    yield what, "", [Edit(node, "iter", None, new)]
        for node in {id(each[0]): each[0] for each in places}.values():
            for field in ("body", "orelse"):
                steps = getattr(node, field, None)
                if isinstance(steps, list) and not isinstance(node, ast.ClassDef):
                    for what, edits in self._steps(node, field, steps):
                        yield what, "", edits
        yield from self._mixed_up(places if self._own else [])
        for node, field, at, part, place in places:
            if isinstance(part, ast.Constant):
                for what, new in self._parts.others(part):
                    said = _of_its_place(what, node, field, part, new)
                    if said:
                        yield said, place, [Edit(node, field, at, new)]

    def _exchanged(self, places: list[Place]) -> Iterator[tuple[str, str, list[Edit]]]:
        """Yield the slips that take two parameters for each other everywhere."""
        names = self._parts.parameters
        for j, other in enumerate(names if len(names) < 8 else ()):
            for one in names[:j]:
                new = {one: other, other: one}
                edits = [
                    Edit(node, field, at, ast.Name(new[part.id], ast.Load()))
                    for node, field, at, part, _ in places
                    if isinstance(part, ast.Name) and part.id in new
                ]
                if len(edits) > 1:
                    yield f"`{one}` and `{other}` are exchanged.", "", edits

    def _mixed_up(self, places: list[Place]) -> Iterator[tuple[str, str, list[Edit]]]:
        """Yield the slips that take a variable of the function for another one."""
        names = {
            part.id: part
            for _, _, _, part, _ in places
            if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store) and part.id != "_"
        }
        for node, field, at, part, place in places if len(names) <= MOST_NAMES else ():
            if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load) and part.id in names:
                for other in sorted(names.keys() - {part.id}):
                    new = ast.Name(other, ast.Load())
                    said = [self._parts.quoted(each).strip() for each in (new, part)]
                    what = "A variable is used where another one belongs."
                    if all(said):
                        what = f"{said[0]} is used where {said[1]} belongs."
                    yield what, place, [Edit(node, field, at, new)]

    def _places(self, node: ast.AST, place: str = "") -> Iterator[Place]:
        """Yield (node, field, index, part, what is made of it) of all parts in the regions."""
        for field, value in ast.iter_fields(node):
            if (type(node), field) in _SKIPPED:
                continue
            for at, part in enumerate(value) if isinstance(value, list) else [(None, value)]:
                if not isinstance(part, ast.AST):
                    continue
                inner = place
                if isinstance(node, ast.Dict) and field == "values" and node.keys[at or 0]:
                    inner = ast.unparse(node.keys[at or 0])  # type: ignore[arg-type]
                elif isinstance(node, ast.Assign) and field == "value" and self._named(node):
                    inner = self._parts.quoted(node.targets[0]).strip() or place
                line = getattr(part, "lineno", None)
                if line is None or any(line in region for region in self._regions):
                    yield node, field, at, part, inner
                yield from self._places(part, inner)

    def _named(self, node: ast.Assign) -> bool:
        """Return whether to name what is assigned to: not the variables of another style."""
        return self._own or not isinstance(node.targets[0], ast.Name)

    # --- steps

    def _steps(
        self, node: Any, field: str, steps: list[ast.stmt]
    ) -> Iterator[tuple[str, list[Edit]]]:
        """Yield slips of a list of steps: left out, in another order, inside or outside a loop."""
        inside = [any(step.lineno in region for region in self._regions) for step in steps]
        needed = ast.Return, ast.Import, ast.ImportFrom, ast.FunctionDef
        for i, step in enumerate(steps):
            if inside[i] and not isinstance(step, needed):
                yield f"A step is left out{self._about(step)}.", [Edit(node, field, i, ast.Pass())]
        for i, step in enumerate(steps):
            if not inside[i]:
                continue
            if isinstance(step, ast.AugAssign):
                yield (
                    (
                        f"A value is replaced where something should be added to it"
                        f"{self._about(step)}."
                    ),
                    [Edit(node, field, i, _assigned(step))],
                )
                for other in OTHER.get(type(step.op), ()):
                    signs = SIGNS[other], SIGNS[type(step.op)]
                    yield (
                        f"`{signs[0]}=` stands where `{signs[1]}=` belongs.",
                        [Edit(step, "op", None, other())],
                    )
            if isinstance(step, ast.If):
                about = colon(self._parts.about(step.test))
                yield (
                    f"A case is left out{about}.",
                    [Edit(step, "test", None, ast.Constant(False))],
                )
                yield (
                    f"A condition is left out{about}.",
                    [Edit(step, "test", None, ast.Constant(True))],
                )
            if isinstance(step, (ast.Break, ast.Continue)):
                other = ast.Continue if isinstance(step, ast.Break) else ast.Break
                yield (
                    "A loop goes on where it should end, or ends where it should go on.",
                    [Edit(node, field, i, other())],
                )
            if i + 1 < len(steps) and inside[i + 1]:
                order = [*steps[:i], steps[i + 1], step, *steps[i + 2 :]]
                yield (
                    f"Two steps are done in the wrong order{self._about(step, steps[i + 1])}.",
                    [Edit(node, field, None, order)],
                )
            if isinstance(step, (ast.For, ast.While)):
                yield from self._loops(node, field, steps, i)

    def _loops(
        self, node: Any, field: str, steps: list[ast.stmt], i: int
    ) -> Iterator[tuple[str, list[Edit]]]:
        """Yield slips that move a step into the loop at i, or out of it."""
        loop: Any = steps[i]
        for j in range(i):
            if isinstance(steps[j], (ast.Assign, ast.AnnAssign)):
                rest = [each for k, each in enumerate(steps) if k != j]
                yield (
                    (
                        f"What should be done once before a loop is done anew in each pass"
                        f"{self._about(steps[j])}."
                    ),
                    [
                        Edit(loop, "body", None, [steps[j], *loop.body]),
                        Edit(node, field, None, rest),
                    ],
                )
        for j, step in enumerate(loop.body):
            if isinstance(step, (ast.Assign, ast.AnnAssign, ast.Expr)):
                body = [each for k, each in enumerate(loop.body) if k != j] or [ast.Pass()]
                yield (
                    (
                        f"What should be done in each pass of a loop is done only once before it"
                        f"{self._about(step)}."
                    ),
                    [
                        Edit(loop, "body", None, body),
                        Edit(node, field, None, [*steps[:i], step, *steps[i:]]),
                    ],
                )
        if i + 1 < len(steps) and not isinstance(steps[i + 1], (ast.For, ast.While)):
            about = self._about(steps[i + 1])
            yield (
                f"What should be done after a loop is done in each pass{about}.",
                [
                    Edit(loop, "body", None, [*loop.body, steps[i + 1]]),
                    Edit(node, field, None, [*steps[: i + 1], *steps[i + 2 :]]),
                ],
            )

    def _about(self, *steps: ast.stmt) -> str:
        """Return what steps are about, as far as the task's text has their names."""
        found: list[str] = []
        for step in steps:
            value = getattr(step, "value", None)
            called = [value.func, *_inside(value.func)] if isinstance(value, ast.Call) else []
            if isinstance(step, (ast.Assign, ast.AugAssign)):
                targets = step.targets if isinstance(step, ast.Assign) else [step.target]
                named = [self._parts.quoted(each).strip() for each in targets]
                found += named if any(named) else [self._first_named(called)]
            elif isinstance(step, ast.Expr) and called:
                found.append(self._first_named(called))
            elif isinstance(step, ast.Return):
                found.append("`return`")
        found = list(dict.fromkeys(each for each in found if each))
        return f": {', '.join(found)}" if found not in ([], ["`return`"]) else ""

    def _first_named(self, parts: list[ast.expr]) -> str:
        """Return the first part that may be quoted and says something, or ""."""
        telling = (self._parts.quoted(each).strip() for each in parts if not is_common(each))
        return next((said for said in telling if said), "")


def _inside(function: ast.expr) -> list[ast.expr]:
    """Return what a method is called of: `observations` of `observations.append`."""
    return [function.value] if isinstance(function, ast.Attribute) else []


def _of_its_place(what: str, node: ast.AST, field: str, part: ast.expr, new: ast.expr) -> str:
    """Return a sentence that fits the place of a slip; "" if nobody makes this slip there."""
    index = isinstance(node, ast.Subscript) and field == "slice"
    if not index and what in (FIRST, LAST):
        return ""
    both = [each.value for each in (new, part) if isinstance(each, ast.Constant)]
    if index and len(both) == 2 and isinstance(both[1], int) and what not in (FIRST, LAST):
        return f"Number {both[0]!r} is taken where number {both[1]} belongs (counted from 0)."
    if isinstance(node, ast.Expr) and what.endswith(" is left out."):
        return f"{what[:-1]}, or stands where it has no effect."
    return what


def _assigned(step: ast.AugAssign) -> ast.Assign:
    target = ast.parse(ast.unparse(step.target)).body[0].value  # type: ignore[attr-defined]
    target.ctx = ast.Store()
    return ast.Assign([target], step.value, lineno=step.lineno)
