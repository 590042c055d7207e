"""Slips in expressions: another operator, function, index or argument, or a part left out."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from botschool.grading.judge.sentences import Quotes, colon, in_, used

_BOUNDARY: dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt
}  # fmt: skip
_REVERSED: dict[type, type] = {
    ast.Lt: ast.Gt, ast.LtE: ast.GtE, ast.Gt: ast.Lt, ast.GtE: ast.LtE, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
}  # fmt: skip
OTHER: dict[type, tuple[type, ...]] = {
    ast.Add: (ast.Sub,), ast.Sub: (ast.Add,), ast.Mult: (ast.Div, ast.Add), ast.Div: (ast.Mult,),
    ast.FloorDiv: (ast.Div,), ast.Mod: (ast.FloorDiv,),
}  # fmt: skip
SIGNS: dict[type, str] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Pow: "**", ast.MatMult: "@",
}  # fmt: skip
_PARTS: dict[type, tuple[str, str]] = {
    ast.Add: ("term", "term"), ast.Sub: ("term", "term that is subtracted"),
    ast.Mult: ("factor", "factor"), ast.Div: ("numerator", "divisor"),
    ast.Mod: ("number", "remainder (%)"), ast.Pow: ("base", "power"),
    ast.FloorDiv: ("number", "whole-number division (//)"), ast.MatMult: ("matrix", "matrix"),
}  # fmt: skip
_ALIKE = (
    ("mean", "sum", "median", "max", "min", "prod"), ("sin", "cos"), ("argmax", "argmin"),
    ("maximum", "minimum"), ("floor", "ceil", "round", "trunc", "rint"), ("any", "all"),
    ("zeros", "ones"), ("zeros_like", "ones_like"), ("std", "var"), ("argsort", "sort"),
    ("vstack", "hstack"), ("log", "log2", "log10", "log1p"), ("normal", "uniform"),
    ("nlargest", "nsmallest"), ("tanh", "sigmoid"), ("cumsum", "cumprod"),
)  # fmt: skip
"""Functions that are taken for one another."""
FIRST = "The first one is taken where the last one belongs."
LAST = "The last one is taken where the first one belongs."
"""Sentences on an index."""
_KEPT = {"array", "asarray", "zeros", "ones", "float", "len", "range", "enumerate", "zip", "empty"}
"""Functions that nobody leaves out by mistake, or without effect."""


@dataclass
class Edit:
    """A part of a syntax tree that takes the place of another."""

    node: Any
    field: str
    at: int | None
    new: Any

    @property
    def line(self) -> int:
        """Return the line of the changed part; 0 if it has none."""
        return int(getattr(self.node, "lineno", 0))

    def swap(self) -> None:
        """Put the new part in; a second call takes it out."""
        if self.at is None:
            old = getattr(self.node, self.field)
            setattr(self.node, self.field, self.new)
        else:
            place = getattr(self.node, self.field)
            old, place[self.at] = place[self.at], self.new
        self.new = old


class Expressions:
    """The slips of a function's expressions."""

    def __init__(self, quotes: Quotes, parameters: list[str]) -> None:
        """Take what sentences may quote, and the names of the function's parameters."""
        self.quoted, self.about = quotes.quoted, quotes.about
        self.parameters = parameters

    def _named(self, node: ast.expr) -> str:
        """Return the name of a called function."""
        return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")

    # --- expressions: another part in the place of this one

    def others(self, part: ast.expr) -> Iterator[tuple[str, ast.expr]]:
        """Yield (sentence, expression that takes the place of this one)."""
        if isinstance(part, ast.BinOp):
            yield from self._operands(part)
        elif isinstance(part, ast.UnaryOp):
            if isinstance(part.op, ast.USub):
                if isinstance(part.operand, ast.Constant) and part.operand.value == 1:
                    yield FIRST, ast.Constant(0)
                yield "A minus sign is missing: something is turned around.", part.operand
            elif isinstance(part.op, ast.Not):
                yield "A condition holds where it should not (`not` is missing).", part.operand
        elif isinstance(part, ast.BoolOp):
            for i, value in enumerate(part.values):
                rest = [each for j, each in enumerate(part.values) if j != i]
                kept = rest[0] if len(rest) == 1 else ast.BoolOp(part.op, rest)
                about = colon(self.quoted(value))
                yield f"One of several conditions is left out{about}.", kept
        elif isinstance(part, ast.IfExp):
            yield f"The case{self.about(part.test)} is left out.", part.orelse
            test = self.quoted(part.test) or " a condition"
            yield f"The case is left out in which{test} does not hold.", part.body
            yield (
                "The two cases of a condition are exchanged.",
                ast.IfExp(part.test, part.orelse, part.body),
            )
        elif isinstance(part, ast.Call):
            yield from self._calls(part)
        elif isinstance(part, ast.Constant):
            yield from self._constants(part)
        elif isinstance(part, ast.Attribute) and part.attr == "T":
            yield "A matrix is not transposed (.T).", part.value
        elif isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load):
            if part.id in self.parameters and len(self.parameters) < 8:
                for other in self.parameters:
                    if other != part.id:
                        yield (
                            f"`{other}` is used where `{part.id}` belongs.",
                            ast.Name(other, ast.Load()),
                        )
        elif isinstance(part, (ast.Subscript, ast.ListComp, ast.Dict)):
            yield from self._containers(part)

    def _operands(self, part: ast.BinOp) -> Iterator[tuple[str, ast.expr]]:
        left, right = _PARTS.get(type(part.op), ("", ""))
        whole = in_(self.quoted(part))
        if isinstance(part.op, (ast.Sub, ast.Div)):
            what = "A difference" if isinstance(part.op, ast.Sub) else "A fraction"
            said = f"{what} is the wrong way round."
            if isinstance(part.op, ast.Sub) and isinstance(part.left, ast.UnaryOp):  # of -a - b
                said = "The sign is reversed."
            yield said, ast.BinOp(part.right, part.op, part.left)
        if isinstance(part.op, ast.MatMult):
            yield "The two sides of `@` are exchanged.", ast.BinOp(part.right, part.op, part.left)
        if right and not isinstance(part.op, ast.MatMult):
            yield f"A {right} is left out{colon(self.quoted(part.right))}{whole}.", part.left
            if not isinstance(part.op, (ast.Pow, ast.Mod, ast.FloorDiv)):
                taken = part.right
                if isinstance(part.op, ast.Sub):
                    taken = ast.UnaryOp(ast.USub(), part.right)
                elif isinstance(part.op, ast.Div):
                    taken = ast.BinOp(ast.Constant(1), part.op, part.right)
                yield f"A {left} is left out{colon(self.quoted(part.left))}{whole}.", taken
        if isinstance(part.op, ast.Pow):
            yield (
                f"An exponent is one too large{colon(self.quoted(part))}.",
                ast.BinOp(part.left, part.op, ast.BinOp(part.right, ast.Add(), ast.Constant(1))),
            )

    def _calls(self, part: ast.Call) -> Iterator[tuple[str, ast.expr]]:
        name = self._named(part.func)
        method = isinstance(part.func, ast.Attribute) and not _is_module(part.func.value)
        if name in ("clip", "minimum", "maximum", "min", "max") and not part.keywords:
            inside = part.func.value if method else None  # type: ignore[attr-defined]
            values = [*([inside] if inside else []), *part.args]
            if len(values) == 3:
                for at, which in ((1, "below"), (2, "above")):
                    args = [*part.args]
                    args[at - method] = ast.Constant(None)
                    yield f"A value is not limited {which}.", ast.Call(part.func, args, [])
                yield (
                    "Limits are kept by tanh where `clip` is asked for.",
                    _of("np.tanh", values[0]),
                )
            elif len(values) == 2:
                for kept, other in (values, values[::-1]):
                    yield f"A limit is left out (`{name}`){colon(self.quoted(other))}.", kept
        if name == "tanh" and len(part.args) == 1:
            yield (
                "Values are cut off where `tanh` is asked for.",
                ast.parse(f"np.clip({ast.unparse(part.args[0])}, -1, 1)", mode="eval").body,
            )
        if name not in _KEPT:
            if method and name.islower():
                yield f"`.{name}()` is left out.", part.func.value  # type: ignore[attr-defined]
            elif part.args:
                yield f"`{name}` is left out.", part.args[0]
        for i in range(len(part.args) - 1 if name != "range" else 0):
            args = [*part.args]
            args[i], args[i + 1] = args[i + 1], args[i]
            yield (
                f"Two arguments of `{name}` are exchanged.",
                ast.Call(part.func, args, part.keywords),
            )
        for keyword in part.keywords:
            rest = [each for each in part.keywords if each is not keyword]
            yield f"`{keyword.arg}=` is left out in `{name}`.", ast.Call(part.func, part.args, rest)
            along = ast.unparse(keyword.value)
            if keyword.arg in ("axis", "dim") and along in ("-1", "0", "1"):
                place = ast.Constant(int(along == "0"))
                other = [*rest, ast.keyword(keyword.arg, place)]
                yield (
                    f"`{name}` is taken along the other axis.",
                    ast.Call(part.func, part.args, other),
                )
        if name in ("std", "var") and not part.keywords:
            ddof = [ast.keyword("ddof", ast.Constant(1))]
            yield (
                f"`{name}` divides by n - 1 where n is asked for (ddof).",
                ast.Call(part.func, part.args, ddof),
            )
        if name == "enumerate" and len(part.args) == 1:
            yield (
                "Counting begins at 1 instead of 0.",
                ast.Call(part.func, [*part.args, ast.Constant(1)], []),
            )

    def _constants(self, part: ast.Constant) -> Iterator[tuple[str, ast.expr]]:
        value = part.value
        said = "" if value in range(-9, 10) else self.quoted(part)  # a text has these anywhere
        if isinstance(value, bool):
            yield f"{not value} stands where {value} belongs.", ast.Constant(not value)
        elif isinstance(value, int):
            if value == 0:
                last = ast.UnaryOp(ast.USub(), ast.Constant(1))
                yield LAST, last
            for more, word in ((1, "more"), (-1, "less")):
                end = " (off by one)" if abs(value) < 4 else ""
                shown = colon(said) or used(value + more)
                yield (
                    f"A number is one {word} than it should be{end}{shown}.",
                    ast.Constant(value + more),
                )
        elif isinstance(value, float) and value:
            for factor, word in ((2.0, "twice"), (0.5, "half of"), (-1.0, "minus")):
                shown = colon(said) or used(factor * value)
                yield f"A number is {word} what it should be{shown}.", ast.Constant(factor * value)

    def _containers(self, part: ast.expr) -> Iterator[tuple[str, ast.expr]]:
        if isinstance(part, ast.Dict):
            for i in range(len(part.keys)):
                for j in range(i):
                    values = [*part.values]
                    values[i], values[j] = values[j], values[i]
                    names = [ast.unparse(part.keys[k]) for k in (j, i) if part.keys[k]]  # type: ignore[arg-type]
                    yield f"{' and '.join(names)} are exchanged.", ast.Dict(part.keys, values)
        elif isinstance(part, ast.Subscript) and isinstance(part.ctx, ast.Load):
            at = part.slice
            if isinstance(at, ast.Slice):
                if at.step is not None:
                    yield (
                        "The order is not reversed ([::-1]), or a step is left out.",
                        (ast.Subscript(part.value, ast.Slice(at.lower, at.upper), part.ctx)),
                    )
                yield "A part is not cut out ([...:...]).", part.value
                for lower, upper, how in ((1, 0, "begins one place late"),
                                          (-1, 0, "begins one place early"),
                                          (0, 1, "ends one place late"),
                                          (0, -1, "ends one place early"),
                                          (1, 1, "comes one place late"),
                                          (-1, -1, "comes one place early")):  # fmt: skip
                    ends = ast.Slice(_moved(at.lower, lower, 0), _moved(at.upper, upper, None))
                    ends.step = at.step
                    yield (
                        f"A part that is cut out {how} (off by one).",
                        ast.Subscript(part.value, ends, part.ctx),
                    )
            elif not isinstance(at, (ast.Constant, ast.UnaryOp, ast.Tuple)):
                for more, word in ((1, "late"), (-1, "early")):
                    yield (
                        f"A value is taken one place too {word} (off by one).",
                        ast.Subscript(part.value, _moved(at, more, None), part.ctx),
                    )
            if isinstance(at, ast.Compare):
                which = colon(self.quoted(at))
                yield f"All values are used where a condition selects some{which}.", part.value
            elif not isinstance(at, ast.Slice) and not _is_key(at):
                yield "A whole array or list is used where one element of it belongs.", part.value

    # --- expressions that keep their place, and change inside

    def inside(self, part: ast.expr) -> Iterator[tuple[str, Edit]]:
        """Yield (sentence, edit) for another operator or function."""
        if isinstance(part, ast.Compare) and len(part.ops) == 1:
            kind = type(part.ops[0])
            what = colon(self.quoted(part))
            if kind in _BOUNDARY:
                other = _BOUNDARY[kind]
                first, second = sorted((SIGNS[other], SIGNS[kind]))
                yield (  # in a condition that is turned around it is the other one
                    (
                        f"`{first}` and `{second}` are taken for each other{what}. What must "
                        "happen when both sides are equal?"
                    ),
                    Edit(part, "ops", 0, other()),
                )
            if kind in _REVERSED:
                yield (
                    f"A comparison is the wrong way round{what}.",
                    Edit(part, "ops", 0, _REVERSED[kind]()),
                )
        elif isinstance(part, ast.BinOp):
            for other in OTHER.get(type(part.op), ()):
                signs = SIGNS[other], SIGNS[type(part.op)]
                what = f"`{signs[0]}` stands where `{signs[1]}` belongs"
                if {*signs} == {"+", "-"}:  # in a bracket with a minus sign it is the other one
                    what = "`+` and `-` are taken for each other"
                where = in_(self.quoted(part))
                if where or {*signs} != {"+", "*"}:  # of all slips that one is told by its place
                    yield f"{what}{where}.", Edit(part, "op", None, other())
        elif isinstance(part, ast.BoolOp):
            other = ast.Or if isinstance(part.op, ast.And) else ast.And
            yield "`and` and `or` are taken for each other.", Edit(part, "op", None, other())
        elif isinstance(part, ast.Call):
            name = self._named(part.func)
            field = "attr" if isinstance(part.func, ast.Attribute) else "id"
            for group in _ALIKE:
                for word in group if name in group else ():
                    pair = len(group) == 2 or {word, name} == {"min", "max"}
                    what = f"`{word}` is taken where `{name}` is asked for."
                    if pair:
                        what = f"`{min(word, name)}` and `{max(word, name)}` are mixed up."
                    if word != name:
                        yield what, Edit(part.func, field, None, word)
        elif isinstance(part, (ast.ListComp, ast.GeneratorExp)):
            for loop in part.generators:
                for test in loop.ifs:
                    rest = [each for each in loop.ifs if each is not test]
                    yield (
                        f"A condition is left out{colon(self.quoted(test))}.",
                        Edit(loop, "ifs", None, rest),
                    )
        elif isinstance(part, (ast.Tuple, ast.List)) and len(part.elts) < 7:
            for i in range(len(part.elts) - 1):
                if any(isinstance(e, ast.Name) and e.id == "_" for e in part.elts[i : i + 2]):
                    continue  # a value that is dropped: nobody would call this an exchange
                elements = [*part.elts]
                elements[i], elements[i + 1] = elements[i + 1], elements[i]
                both = [self.quoted(each) for each in part.elts[i : i + 2]]
                which = f" numbers {i + 1} and {i + 2} of {len(part.elts)}"
                if all(both):
                    which = " and".join(both)
                yield f"Two values are exchanged:{which}.", Edit(part, "elts", None, elements)

    def passes(self, loop: ast.For | ast.comprehension) -> Iterator[tuple[str, ast.expr]]:
        """Yield (sentence, other values) for what a loop goes over."""
        over = loop.iter
        first, last = (
            "The first pass of a loop is left out.",
            "The last pass of a loop is left out.",
        )
        counting = isinstance(over, ast.Call) and self._named(over.func) == "range"
        if counting and ast.unparse(loop.target) == "_":  # it does not matter which one
            first = last = "A loop makes one pass too few."
        if isinstance(over, ast.Call) and self._named(over.func) == "range" and len(over.args) < 3:
            begin, end = ([ast.Constant(0), *over.args])[-2:]
            yield first, _range(_moved(begin, 1, 0), end)
            yield last, _range(begin, _moved(end, -1, 0))
            yield "A loop makes one pass too many.", _range(begin, _moved(end, 1, 0))
            yield (
                "A loop counts from 1 instead of 0.",
                _range(_moved(begin, 1, 0), _moved(end, 1, 0)),
            )
            yield "A loop goes in the wrong order.", _of("reversed", over)
        elif isinstance(over, (ast.Name, ast.Attribute, ast.Call)):
            sliced = _of("list", over)
            yield first, ast.Subscript(sliced, ast.Slice(ast.Constant(1)), ast.Load())
            yield last, ast.Subscript(sliced, ast.Slice(None, ast.Constant(-1)), ast.Load())
            yield "A loop goes in the wrong order.", _of("reversed", sliced)


def _is_key(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def is_common(node: ast.expr) -> bool:
    """Return whether this is a module or a function of Python, whose name alone says little."""
    return _is_module(node) or ast.unparse(node) in dir(builtins)


def _is_module(node: ast.expr) -> bool:
    """Return whether this is np, math, torch or np.linalg, not an object."""
    names = ("np", "numpy", "math", "torch", "random", "linalg", "self", "config", "Path")
    return ast.unparse(node).rpartition(".")[2] in names


def _of(name: str, *arguments: ast.expr) -> ast.Call:
    return ast.Call(ast.parse(name, mode="eval").body, [*arguments], [])


def _range(begin: ast.expr, end: ast.expr) -> ast.Call:
    return _of("range", begin, end)


def _moved(place: ast.expr | None, more: int, default: int | None) -> ast.expr | None:
    """Return an expression for a place that is one more or one less."""
    if more == 0:
        return place
    if place is None:
        if default is None:
            return ast.Constant(-1) if more < 0 else None
        return ast.Constant(more) if more > 0 else None
    op = ast.Add() if more > 0 else ast.Sub()
    return ast.BinOp(place, op, ast.Constant(1))
