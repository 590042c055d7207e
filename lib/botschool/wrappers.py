"""Read wrappers around environments from an experiment file: Gymnasium's, or your own.

    wrappers = TimeAwareObservation, ResizeObservation(shape=(32, 32)), my_module:MyWrapper

The first one is the innermost. Arguments are literals: numbers, words in quotes, lists, tuples.
`keywords` reads the options of the environment itself.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool.errors import BotschoolError, said
from botschool.inifile import nearest, shown
from botschool.paths import import_here

if TYPE_CHECKING:
    import gymnasium

FORGETFUL = {
    "NormalizeObservation": "normalize = 1 under [POLICY] (botschool rl: --params normalize=true)",
    "NormalizeReward": "a scale of your own (TransformReward)",
}
"""Wrappers whose statistics outlive an episode, and what to use instead."""


@dataclass(frozen=True)
class Wrapper:
    """A wrapper's name and arguments."""

    module: str
    """Its module; "" for Gymnasium's own wrappers."""
    name: str
    given: tuple[Any, ...] = ()
    named: dict[str, Any] = field(default_factory=dict)

    def around(self, env: gymnasium.Env, wrapped: str) -> gymnasium.Env:
        """Return the environment called `wrapped` inside the wrapper. Raises BotschoolError."""
        import gymnasium

        found = self._find()
        try:
            outside = found(env, *self.given, **self.named)
        except gymnasium.error.DependencyNotInstalled as error:
            raise BotschoolError(
                f"The wrapper {self.name} needs a package that is not installed: {said(error)}."
            ) from None
        except (Exception, SystemExit) as error:
            remedy = "give its arguments in brackets, as ResizeObservation(shape=(32, 32))"
            if env.render_mode is None and "render" in str(error):
                remedy = "let the environment draw, with options = render_mode='rgb_array'"
            raise BotschoolError(
                f"The wrapper {self.name} does not fit {wrapped} ({said(error)}): {remedy}, or "
                "leave it out."
            ) from error
        if not isinstance(outside, gymnasium.Env):
            raise BotschoolError(
                f"{self.name} is no wrapper: it makes a {type(outside).__name__} of an environment."
            )
        return outside

    def _find(self) -> Any:
        if not self.module and self.name in FORGETFUL:
            raise BotschoolError(
                f"The wrapper {self.name} remembers earlier episodes, so the return of an episode "
                f"would depend on them: use {FORGETFUL[self.name]} instead."
            )
        if not self.module:
            import gymnasium.wrappers as module
        else:
            module = import_here(self.module, f"take the wrapper {self.name} from")
        try:
            found = getattr(module, self.name)
        except (AttributeError, ImportError):
            raise BotschoolError(self._missing(module)) from None
        if not callable(found):
            raise BotschoolError(f"{self.name} is no wrapper, but a {type(found).__name__}.")
        return found

    def _missing(self, module: Any) -> str:
        import gymnasium

        known = [
            name
            for name, value in vars(module).items()
            if isinstance(value, type) and issubclass(value, gymnasium.Wrapper)
        ]
        near = nearest(self.name, known)
        place = self.module or "gymnasium.wrappers"
        if not near.endswith("?"):
            near = "write module:Class for one of your own" if not self.module else f"{near}"
        end = "" if near.endswith("?") else "."
        return f"There is no wrapper '{shown(self.name)}' in {place}; {near}{end}"


def parse(text: str) -> tuple[Wrapper, ...]:
    """Return the wrappers that a text names, separated by commas. Raises BotschoolError."""
    return tuple(_wrapper(part.strip()) for part in _split(text)) if text.strip() else ()


def keywords(text: str) -> dict[str, Any]:
    """Return an environment's options from `num_good=1, speeds=(2, 3)`. Raises BotschoolError."""
    try:
        call: Any = ast.parse(f"f({text})", mode="eval").body
        found = {each.arg: ast.literal_eval(each.value) for each in call.keywords}
        if call.args or None in found:
            raise ValueError
    except (ValueError, SyntaxError, AttributeError, MemoryError, RecursionError):
        raise BotschoolError(
            f"'{shown(text)}' cannot be read as options: write name=value, separated by commas, "
            "with numbers, words in quotes, lists or tuples, as in num_good=1, speeds=(2, 3)."
        ) from None
    return found


def bare(value: Any) -> Any:
    """Return a number of numpy as one of Python; other values as they are."""
    return value.item() if isinstance(value, np.generic) else value


def spelled(options: dict[str, str]) -> str:
    """Return the text from which `keywords` reads these options; a value that is no number, list
    and so on is a word.
    """
    return ", ".join(f"{name}={_literal(value)}" for name, value in options.items())


def _literal(text: str) -> str:
    try:
        return repr(ast.literal_eval(text))
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return repr(text)


def _split(text: str) -> list[str]:
    """Split a text at the commas outside of brackets."""
    parts, depth = [""], 0
    for character in text:
        depth += (character in "([{") - (character in ")]}")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def _wrapper(text: str) -> Wrapper:
    match = re.fullmatch(r"(?:([A-Za-z_][\w.]*)[:.])?([A-Za-z_]\w*)\s*(\(.*\))?", text, re.DOTALL)
    if not text:
        raise BotschoolError("the wrappers have a comma too many: put a name between two commas.")
    if not match:
        raise BotschoolError(
            f"'{shown(text)}' is no wrapper: write its name, as FlattenObservation, "
            "my_module:MyWrapper or ResizeObservation(shape=(32, 32))."
        )
    module, name, brackets = match.groups()
    try:
        call: Any = ast.parse(f"f{brackets or '()'}", mode="eval").body
        given = tuple(ast.literal_eval(value) for value in call.args)
        named = {each.arg: ast.literal_eval(each.value) for each in call.keywords if each.arg}
    except (ValueError, SyntaxError, AttributeError, MemoryError, RecursionError):
        raise BotschoolError(
            f"The arguments of the wrapper {name} cannot be read: write numbers, words in quotes, "
            "lists or tuples, as in ResizeObservation(shape=(32, 32))."
        ) from None
    return Wrapper(module or "", name, given, named)
