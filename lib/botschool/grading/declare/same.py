"""Compare a submission with our solution on inputs that a grader declares.

    @same(ranks, 4, "utilities")
    def equals_in_their_order(rng):
        yield np.array([1.0, 2.0, 2.0, 1.0])
        yield rng.integers(0, 4, 40).astype(float)

is a check of 4 points. `utilities` of the submission and of our solution get the same inputs, the
smallest first, and must give the same answers. What every function must keep is tried with more
inputs, which are made from these (docs/specification.md, "Graders that declare"). A function of the
grader may stand for the name: a driver, run with the module in both confined processes.
"""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading.declare.arguments import (
    cut_to_size,
    in_single,
    mapped,
    numbers,
    one_changed,
    with_others,
)
from botschool.grading.declare.checks import Mismatch, Wrong, expect_close, expect_fields, show
from botschool.grading.declare.exercise import Task
from botschool.grading.declare.values import argument
from botschool.sandbox.protocol import pack

Inputs = Callable[..., Iterable[Any]]
KEEPS = {
    "draw": "other inputs, drawn as under another secret",
    "again": "the same call later, in a new process",
    "kept": "an answer, looked at after another call; then other numbers in the same arrays",
    "changes": "one argument changed at a time",
    "square": "arrays cut to a square",
    "one": "arrays cut to size one",
    "single": "arrays in single precision",
    "list": "lists, where our docstring calls the function with one",
}
"""What every function must keep, by the names with which a grader switches it off."""
BASES, OF_A_DRIVER = 2, 1
"""Inputs of a check, the smallest ones, from which more are made."""
QUICK = 0.05
"""Processor seconds of our answer to an input from which more are made."""
PATIENCE, SLOWER = 5.0, 20.0
"""Seconds that a call may take, which may import a package, and how many times as long as ours."""
HURRY = 1.0
"""As PATIENCE, once a call of the task has not returned in time."""
SHORT = 110
"""Characters of a call that is shown as Python."""
SINGLE = 1e-4
"""Smallest tolerance for arguments in single precision."""
KEPT = (
    "Something stays from an earlier call: look for a variable of the module, a default argument, "
    "an array that is changed in place, or a file."
)
NOTES = {
    "again": KEPT,
    "single": "The arrays of this call have dtype float32.",
    "list": "This call gives a list, as the docstring does.",
}


def seed_of(rng: np.random.Generator) -> int:
    """Draw a seed for a function of the submission."""
    return int(rng.integers(1, 100_000))


def same(
    task: Task,
    points: int,
    what: str | Callable[..., Any],
    tolerance: float = 1e-9,
    parts: tuple[str, ...] = (),
    view: Callable[..., Any] | None = None,
    off: dict[str, str] | None = None,
    name: str = "",
    fixed: str = "",
) -> Callable[[Inputs], Inputs]:
    """Return a decorator of a function of a random generator that yields inputs.

    An input is a tuple of arguments, or the only argument.
    what: the name of a function, or a driver, whose docstring begins with the call in words; {0}
    stands for its first argument after the module.
    tolerance: relative and absolute.
    parts: names of the parts of an answer in order, if it is a list; the keys to compare, if it is
    a dict with others.
    view: returns what is compared, of an answer and its arguments, where chance decides the rest.
    It runs in the grader's process, on our answer, too; it raises Wrong for a wrong form.
    off: names from KEEPS, and the reason why a right answer need not keep this.
    name: the check's, where several share a function of inputs and may give it more arguments:
    same(decay, 4, "descent", name="by_sign")(slopes, 2); "" for the name of the function.
    fixed: why the inputs are the same under every secret; "" if they are drawn.
    """

    def keep(inputs: Inputs, *given: Any, **named: Any) -> Inputs:
        if wrong := set(off or ()) - set(KEEPS):
            raise ValueError(f"{inputs.__name__}: off names {wrong}; there are {list(KEEPS)}")

        def draw(rng: np.random.Generator) -> Iterable[Any]:
            return inputs(rng, *given, **named)

        check = Same(task, what, draw, tolerance, parts, view, off or {}, fixed)
        check.__name__ = name or inputs.__name__
        task.check(points)(check)
        return inputs

    return keep


class Same:
    """A check that compares answers with our solution's."""

    def __init__(
        self,
        task: Task,
        what: str | Callable[..., Any],
        inputs: Inputs,
        tolerance: float,
        parts: tuple[str, ...],
        view: Callable[..., Any] | None,
        off: dict[str, str],
        fixed: str = "",
    ) -> None:
        """Take what `same` takes."""
        self.task, self.what, self.off, self.fixed = task, what, off, fixed
        self.tolerance, self.parts, self.view = tolerance, parts, view
        self._draw = inputs
        self.__name__ = inputs.__name__

    def inputs(self) -> list[tuple]:
        """Return the inputs, the smallest first."""
        return [own for own, _ in self._pairs()]

    def _pairs(self) -> list[tuple[tuple, tuple]]:
        """Return the inputs, the smallest first, each with that of another secret."""
        own, others = self._drawn(""), self._drawn(" of another secret")
        pairs = [*zip(own, others, strict=True)]
        return sorted(pairs, key=lambda pair: len(pack([*pair[0]])))

    def _drawn(self, draw: str) -> list[tuple]:
        key = f"{self.task.id} {self.__name__}{draw}"
        rng = np.random.default_rng(self.task.exercise.seed(key))
        return [each if isinstance(each, tuple) else (each,) for each in self._draw(rng)]

    def __call__(self, student: Any) -> None:
        """Raise Wrong unless the submission answers as our solution does."""
        for arguments in self.inputs():
            self._compare(student, arguments)
        first = next(each for _, _, each in self.task.checks if isinstance(each, Same))
        if first is self and "again" not in self.off:
            student.stop()
        for kept, arguments in self.more():
            self._compare(student, arguments, kept)
        self._keep_an_answer(student)

    def _keep_an_answer(self, student: Any) -> None:
        """Raise Wrong if another call changes an answer; the first check of a function tries it."""
        checks = [each for _, _, each in self.task.checks if isinstance(each, Same)]
        first = next(each for each in checks if each.what == self.what) is self
        if callable(self.what) or not first or "kept" in self.off:
            return
        pairs = self._pairs()
        different = (pair for pair in pairs if pack([*pair[0]]) != pack([*pair[1]]))
        arguments, others = next(different, pairs[0])
        ours = self.task.exercise.ours.answer(self.what, arguments)
        kinds = (np.ndarray, list, dict)
        if ours.seconds > QUICK or not any(isinstance(e, kinds) for e in (ours.value, *arguments)):
            return
        shown = f"{self.what}({', '.join(map(argument, arguments))})"
        after = self.task.exercise.ours.answer(self.what, others)
        try:
            with student.within(PATIENCE, _before_another):
                both = self.what, [*arguments], [*others]
                answer, again = student.run(_before_another, *both, said=shown)
            self._alike(f"{shown}, looked at after another call,", answer, ours.value, arguments)
            if not after.raised and _finite(after.value):
                said = f"{shown} and then again, with other numbers in the same arrays,"
                self._alike(said, again, after.value, others)
        except Wrong as error:
            error.args, error.stays = (f"{error} {KEPT}",), True
            raise

    def _alike(self, said: str, answer: Any, wanted: Any, arguments: tuple) -> None:
        wanted = self.seen("", wanted, arguments)
        alike(said, self.seen(said, answer, arguments), wanted, self.tolerance, self.parts)

    def _compare(self, student: Any, arguments: tuple, kept: str = "") -> None:
        ours = self.task.exercise.ours.answer(self.what, arguments)
        if ours.raised:
            if kept:
                return
            raise BotschoolError(f"Our solution fails in {self.__name__}: {ours.raised}")
        if kept and not _finite(ours.value):
            return
        tolerance = max(self.tolerance, SINGLE) if kept == "single" else self.tolerance
        try:
            got = self.ask(student, arguments, ours.seconds)
            wanted = self.seen("", ours.value, arguments)
            answer = self.seen(student.said, got, arguments)
            alike(student.said, answer, wanted, tolerance, self.parts)
        except Wrong as error:
            error.args = (f"{error} {NOTES.get(kept, '')}".rstrip(),)
            error.stays = kept == "again"
            raise

    def seen(self, said: str, answer: Any, arguments: tuple) -> Any:
        """Return what is compared of an answer. Raises Wrong."""
        if self.view is None:
            return answer
        try:
            return self.view(answer, *arguments)
        except Wrong as error:
            raise Wrong(f"{said}: {error}") from None
        except KeyError as error:
            raise Wrong(f"{said} has no {error}.") from None
        except Exception as error:  # an answer of another form
            raise Wrong(f"{said} returned {show(answer)}, which cannot be judged.") from error

    def equal(self, arguments: tuple, one: Any, other: Any) -> bool:
        """Return whether two answers are the same to this check."""
        try:
            got, wanted = (self.seen("", each, arguments) for each in (one, other))
            alike("", got, wanted, self.tolerance, self.parts)
        except (Wrong, KeyError):  # either may lack a part
            return False
        return True

    def ask(self, student: Any, arguments: tuple, seconds: float) -> Any:
        """Return a submission's answer; seconds: that our solution took. Raises Wrong."""
        patience = HURRY if student.hung else PATIENCE
        with student.within(patience + SLOWER * seconds, self.what):
            return self._ask(student, arguments)

    def _ask(self, student: Any, arguments: tuple) -> Any:
        if callable(self.what):
            words = (self.what.__doc__ or self.what.__name__).strip().splitlines()[0]
            given = [each if isinstance(each, str) else argument(each) for each in arguments]
            return student.run(self.what, *arguments, said=words.format(*given))
        got = student.call(self.what, *arguments)
        if 0 < len(student.pasted) <= SHORT:
            student.said = student.pasted
        return got

    def more(self) -> Iterator[tuple[str, tuple]]:
        """Yield a name from KEEPS and arguments: what every function must keep."""
        ours, pairs = self.task.exercise.ours, self._pairs()
        places, felt = set[tuple](), set[tuple]()
        bases = OF_A_DRIVER if callable(self.what) else BASES
        for at, (arguments, others) in enumerate(pairs):
            places |= {(n,) for n, e in enumerate(arguments) if not isinstance(e, (dict, list))}
            all_felt = at >= bases and places <= felt
            if all_felt or ours.answer(self.what, arguments).seconds > QUICK:
                return
            made = [("draw", others)] if at < bases else []
            changed: list[tuple[str, tuple]] = []
            several = len(arguments) > 1 or any(isinstance(each, dict) for each in arguments)
            if several and "changes" not in self.off:
                if not callable(self.what):  # a driver's arguments may need each other
                    others = with_others(arguments, others, self._of_the_task)
                for place, each in one_changed(arguments, others):
                    places.add(place)
                    if not self._views(each):
                        continue
                    if place not in felt and self._feels(arguments, each):
                        felt.add(place)
                    elif at >= bases:
                        continue
                    changed.append(("changes", each))
            if at < bases or changed:  # a cache of the new process needs the call itself
                made += [("again", arguments), *changed]
            if at < bases and not callable(self.what):
                made += [(name, each) for name, each in cut_to_size(arguments)]
                made.append(("single", mapped(arguments, in_single)))
                if re.search(rf"\b{self.what}\(\[", _docstring(ours.solution, self.what)):
                    made.append(("list", mapped(arguments, lambda array: array.tolist())))
            base = pack([*arguments])
            for name, each in made:
                if name not in self.off and (name == "again" or pack([*each]) != base):
                    yield name, each

    def _of_the_task(self) -> list[tuple]:
        """Return the inputs of all checks of the task that call the same."""
        checks = (check for _, _, check in self.task.checks)
        same = (each for each in checks if isinstance(each, Same) and each.what == self.what)
        return [arguments for check in same for arguments in check.inputs()]

    def _views(self, arguments: tuple) -> bool:
        """Return whether the view can look at our own answer to these arguments."""
        if self.view is None:
            return True
        ours = self.task.exercise.ours.answer(self.what, arguments)
        try:
            self.view(ours.value, *arguments)
        except Exception:  # arguments that need each other
            return bool(ours.raised)
        return True

    def _feels(self, arguments: tuple, changed: tuple) -> bool:
        """Return whether our answer changes with the arguments: only then a cache is seen."""
        if self.view is not None:
            return True
        one, other = (self.task.exercise.ours.answer(self.what, e) for e in (arguments, changed))
        return not other.raised and not self.equal(arguments, one.value, other.value)


def _before_another(module, name, arguments, others):
    """Return an answer as it is after another call, and the one to the same arrays, changed.

    Runs in the child.
    """
    import copy

    import numpy

    def changed(value, other):
        """Return a value that holds what another one holds, if it can: it is the same object."""
        if type(value) is not type(other):
            return other
        if isinstance(value, numpy.ndarray):
            if (value.shape, value.dtype) != (other.shape, other.dtype):
                return other
            value[...] = other
        elif isinstance(value, dict) and value.keys() == other.keys():
            value.update({key: changed(value[key], other[key]) for key in value})
        elif isinstance(value, list):
            value[:] = other
        else:
            return other
        return value

    function = getattr(module, name)
    answer = function(*arguments)
    function(*others)
    kept = copy.deepcopy(answer)
    function(*arguments)  # what is kept of the last call only is kept of these
    now = [changed(value, other) for value, other in zip(arguments, others, strict=True)]
    return [kept, function(*now)]


def alike(said: str, got: Any, wanted: Any, tolerance: float, parts: tuple[str, ...] = ()) -> None:
    """Raise Wrong at the first part of an answer that differs from ours."""
    before = said.rstrip(",")  # a driver's words may end so, before "returned"
    if isinstance(wanted, dict):
        keys = parts or tuple(wanted)
        for key in keys:  # a view may show fewer parts of a wrong answer
            value = expect_fields(said, got, key)[0]
            alike(f"{before}: {key}", value, wanted[key], tolerance)
    elif isinstance(wanted, (list, tuple)) and not numbers(wanted):
        names = parts or tuple(f"[{i}]" for i in range(len(wanted)))
        if not isinstance(got, (list, tuple)) or len(got) != len(wanted):
            sentence = f"{said} should be {len(wanted)} values, not {show(got)}."
            raise Mismatch(sentence, said, wanted)
        for name, one, other in zip(names, got, wanted, strict=True):
            alike(f"{before}: {name}", one, other, tolerance)
    elif wanted is None or isinstance(wanted, (str, bool, np.bool_)):
        got, wanted = (bool(e) if isinstance(e, np.bool_) else e for e in (got, wanted))
        if not isinstance(got, (str, bool, np.bool_, type(None))) or got != wanted:
            sentence = f"{said} is {show(got)}, but {show(wanted)} was expected."
            raise Mismatch(sentence, said, wanted)
    else:
        expect_close(said, got, wanted, tolerance)


def _finite(value: Any) -> bool:
    """Return whether an answer holds no NaN and no infinity."""
    if isinstance(value, (dict, list, tuple)):
        return all(map(_finite, value.values() if isinstance(value, dict) else value))
    number = isinstance(value, (float, np.ndarray)) and np.asarray(value).dtype.kind == "f"
    return bool(np.isfinite(value).all()) if number else True


@functools.cache
def _docstring(solution: str, name: str) -> str:
    """Return the docstring of a function of our solution, or ""."""
    nodes = [each for each in ast.walk(ast.parse(solution)) if isinstance(each, ast.FunctionDef)]
    return next((ast.get_docstring(node) or "" for node in nodes if node.name == name), "")
