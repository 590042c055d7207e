"""Make typical slips in our solution, one at a time: each must lose points of its task.

A slip is another operator, function, number, place or pass of a loop, or a part left out.
`slips(solution, "3.2")` yields (label, text of the solution with the slip) for each slip in what
students write for the task.
"""

import ast
import re

REGION = re.compile(r"### BEGIN SOLUTION task (\d+\.\d+).*?### END SOLUTION", re.DOTALL)
NEAR = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
TURNED = {ast.Lt: ast.Gt, ast.LtE: ast.GtE, ast.Gt: ast.Lt, ast.GtE: ast.LtE,
          ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}  # fmt: skip
OTHER = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
         ast.Pow: ast.Mult, ast.FloorDiv: ast.Mod, ast.Mod: ast.FloorDiv}  # fmt: skip
ALIKE = (("min", "max"), ("argmin", "argmax"), ("minimum", "maximum"), ("sum", "mean"),
         ("sin", "cos"), ("std", "var"), ("floor", "ceil"), ("mean", "median"), ("any", "all"),
         ("terminated", "truncated"), ("low", "high"), ("first", "last"))  # fmt: skip
SWAP = {one: other for pair in ALIKE for one, other in (pair, pair[::-1])}
STEPS = (ast.Assign, ast.AugAssign, ast.Expr)
TELLING = ("axis", "dim", "ddof", "keepdims", "kind", "correction")
"""Arguments whose absence is a slip."""
LONGEST = 60
"""Characters of a part in a label."""


def slips(solution, task):
    """Yield (label, text) of each slip in a task's code; a text comes once."""
    lines = solution.splitlines(keepends=True)
    inside = set()
    for part in REGION.finditer(solution):
        if part[1] == task:
            inside |= {*range(*(solution.count("\n", 0, at) + 1 for at in part.span()))}
    texts = set()
    for node in ast.parse(solution).body:
        if not isinstance(node, (ast.FunctionDef, ast.ClassDef)) or not inside & {
            *range(node.lineno, node.end_lineno + 1)
        }:
            continue
        texts.add(ast.unparse(node))
        first = node.lineno - 1 - len(node.decorator_list)
        for where, old, new, put, back in changes(node, inside):
            label = f"{task} {node.name}+{where - node.lineno}: {short(old)} -> {short(new)}"
            put()
            text = ast.unparse(node)
            back()
            if text not in texts and parses(text):
                texts.add(text)
                yield label, "".join([*lines[:first], text, "\n", *lines[node.end_lineno :]])


def short(part):
    """What a label shows of a part."""
    text = ast.unparse(part) if isinstance(part, ast.AST) else str(part)
    return " ".join(text.split())[:LONGEST]


def parses(text):
    try:
        compile(text, "<slip>", "exec")
    except (SyntaxError, ValueError):
        return False
    return True


def changes(function, inside):
    """Yield (line, old part, new part, a function that makes the change, one that undoes it)."""
    for node in ast.walk(function):
        for field, value in ast.iter_fields(node):
            places = enumerate(value) if isinstance(value, list) else [(None, value)]
            for at, part in list(places):
                if not isinstance(part, (ast.expr, ast.stmt)) or part.lineno not in inside:
                    continue
                for new in [*expressions(part)] if isinstance(part, ast.expr) else [*steps(part)]:
                    yield part.lineno, part, new, *swap(node, field, at, part, new)


def swap(node, field, at, old, new):
    def put(part):
        if at is None:
            setattr(node, field, part)
        else:
            getattr(node, field)[at] = part

    return lambda: put(new), lambda: put(old)


def steps(part):
    """Yield other statements in the place of one."""
    leaves_nothing = isinstance(part, ast.Expr) and not isinstance(part.value, ast.Call)
    if isinstance(part, STEPS) and not leaves_nothing:
        yield ast.Pass()
    if isinstance(part, ast.AugAssign):
        yield ast.Assign([part.target], part.value, lineno=part.lineno)
    if isinstance(part, ast.If):
        yield ast.If(ast.UnaryOp(ast.Not(), part.test), part.body, part.orelse)
        if not part.orelse:
            yield ast.If(ast.Constant(True), part.body, [])
            yield ast.Pass()
    if isinstance(part, ast.Return) and part.value is not None and number_like(part.value):
        yield ast.Return(ast.UnaryOp(ast.USub(), part.value))


def number_like(part):
    return isinstance(part, (ast.BinOp, ast.Call, ast.Subscript, ast.UnaryOp, ast.Name))


def expressions(part):
    """Yield other expressions in the place of one."""
    if isinstance(part, ast.Compare) and len(part.ops) == 1:
        for table in (NEAR, TURNED):
            if other := table.get(type(part.ops[0])):
                yield ast.Compare(part.left, [other()], part.comparators)
    elif isinstance(part, ast.BinOp):
        if other := OTHER.get(type(part.op)):
            yield ast.BinOp(part.left, other(), part.right)
        if isinstance(part.op, (ast.Sub, ast.Div, ast.MatMult, ast.Pow)):
            yield ast.BinOp(part.right, part.op, part.left)
        yield part.left
        yield ast.UnaryOp(ast.USub(), part.right) if isinstance(part.op, ast.Sub) else part.right
    elif isinstance(part, ast.BoolOp):
        yield ast.BoolOp(ast.Or() if isinstance(part.op, ast.And) else ast.And(), part.values)
        for at in range(len(part.values)):
            rest = part.values[:at] + part.values[at + 1 :]
            yield rest[0] if len(rest) == 1 else ast.BoolOp(part.op, rest)
    elif isinstance(part, ast.UnaryOp) and isinstance(part.op, (ast.USub, ast.Not)):
        yield part.operand
    elif isinstance(part, ast.Constant):
        yield from constants(part.value)
    elif isinstance(part, ast.Call):
        yield from calls(part)
    elif isinstance(part, ast.Attribute) and part.attr in SWAP:
        yield ast.Attribute(part.value, SWAP[part.attr], part.ctx)
    elif isinstance(part, ast.Subscript) and isinstance(part.ctx, ast.Load):
        yield from pieces(part)


def constants(value):
    if isinstance(value, bool):
        yield ast.Constant(not value)
    elif isinstance(value, int):
        yield from (ast.Constant(value + 1), ast.Constant(value - 1))
    elif isinstance(value, float) and value:
        yield from (ast.Constant(2 * value), ast.Constant(-value))


def calls(part):
    """Yield a call of another function, with other arguments, or what it gets."""
    name = getattr(part.func, "attr", getattr(part.func, "id", ""))
    if name in SWAP and isinstance(part.func, ast.Name):
        yield ast.Call(ast.Name(SWAP[name], ast.Load()), part.args, part.keywords)
    if name == "range":
        begin, end = ([ast.Constant(0), *part.args])[-2:]
        for more, at in ((1, 0), (-1, 1), (1, 1)):
            ends = [begin, end]
            ends[at] = ast.BinOp(ends[at], ast.Add(), ast.Constant(more))
            yield ast.Call(part.func, ends, [])
    elif name in ("tanh", "clip", "abs", "sqrt", "exp", "log", "round", "cumsum", "argsort"):
        yield from part.args[:1]
    for at in range(len(part.args) - 1 if name != "range" else 0):
        pair = [part.args[at + 1], part.args[at]]
        yield ast.Call(part.func, [*part.args[:at], *pair, *part.args[at + 2 :]], part.keywords)
    for keyword in part.keywords:
        if keyword.arg in TELLING:
            rest = [other for other in part.keywords if other is not keyword]
            yield ast.Call(part.func, part.args, rest)


def pieces(part):
    """Yield another piece, one place away."""
    place = part.slice
    if isinstance(place, ast.Slice):
        if place.step is not None:
            yield part.value
        lower = place.lower or ast.Constant(0)
        moved = ast.BinOp(lower, ast.Add(), ast.Constant(1))
        yield ast.Subscript(part.value, ast.Slice(moved, place.upper, place.step), part.ctx)
        if place.upper is not None:
            moved = ast.BinOp(place.upper, ast.Sub(), ast.Constant(1))
            yield ast.Subscript(part.value, ast.Slice(place.lower, moved, place.step), part.ctx)
    elif isinstance(place, (ast.Name, ast.BinOp)):
        moved = ast.BinOp(place, ast.Sub(), ast.Constant(1))
        yield ast.Subscript(part.value, moved, part.ctx)
