"""Run a user's own strategy: `algo = module:name` under [EXP] (docs/experiments.md).

The name is a function evolve(evaluate, centre, generations, seed, ...), which runs in a thread and
waits there during evaluations, or a class with `ask` and `tell`.
"""

from __future__ import annotations

import inspect
import threading
import traceback
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from queue import SimpleQueue
from typing import Any

import numpy as np

from botschool.errors import FORCE, BotschoolError, Option, said
from botschool.evolution.algorithm import (
    ALGORITHMS,
    Entry,
    Initial,
    RunConfig,
    Stateful,
    mean_absolute,
)
from botschool.inifile import nearest
from botschool.paths import import_here
from botschool.policies.hyperparameters import hyper
from botschool.wrappers import keywords

GENERATIONS = 1_000_000
"""Value of the argument `generations`: the run's budget ends the function earlier."""
POPSIZE = 20
"""Rows of `population`, unless the options set popsize."""


@dataclass
class OwnConfig(RunConfig):
    """Section [ALGO] of a user's own strategy."""

    options: str = hyper(
        "",
        "arguments of your strategy",
        check=keywords,
        form="name=value, separated by commas",
    )


class _Left(BaseException):
    """Raised to end the thread of a function whose run is over."""


class Asked:
    """Turns a function that calls evaluate(candidates, seed) into `ask` and `tell`.

    The function runs in a thread of its own and waits whenever the caller computes.
    """

    def __init__(self, function: Callable[..., Any], **arguments: Any) -> None:
        self._asked: SimpleQueue = SimpleQueue()
        self._told: SimpleQueue = SimpleQueue()
        weakref.finalize(self, self._told.put, None)
        threading.Thread(
            target=_turns, args=(function, arguments, self._asked, self._told), daemon=True
        ).start()

    def ask(self) -> tuple[Any, Any]:
        """Return the next candidates and their evaluation seed. Raises the function's errors."""
        candidates, seed, error = self._asked.get()
        if error is not None:
            raise error
        return candidates, seed

    def tell(self, fitness: np.ndarray) -> None:
        """Give the candidates' fitness back to the function."""
        self._told.put(fitness)


def _turns(function: Callable, arguments: dict, asked: SimpleQueue, told: SimpleQueue) -> None:
    def evaluate(candidates: Any, seed: Any = None) -> np.ndarray:
        asked.put((candidates, seed, None))
        fitness = told.get()
        if fitness is None:
            raise _Left
        return fitness

    error: BaseException = StopIteration()
    try:
        function(evaluate=evaluate, **arguments)
    except _Left:
        return
    except BaseException as raised:
        error = raised
    asked.put((None, None, error))


class Own(Stateful):
    """Runs a user's own strategy like a built-in algorithm.

    A checkpoint holds the fitness values that the strategy was told. A resumed run tells them
    again, from the start, so the strategy need not save anything; it must draw all random numbers
    from its seed.
    """

    evolves = ("generation", "told", "seen")

    def __init__(
        self, name: str, config: Any, initial: Initial, seed: int, found: Callable | None = None
    ) -> None:
        """Start the strategy; found: the function or class, if it is not imported by its name."""
        self.name, self.seed = name, seed
        self._found = found or _find(name)
        self._arguments = self._given(keywords(config.options), initial)
        self._size = len(initial(0))
        self._begin()

    def _begin(self) -> None:
        self.generation = 0
        self._history = np.zeros(1024)
        self.told = self._history[:0]
        """All fitness values so far, one candidate after another."""
        self.seen = 0.0
        """Sum of the average absolute parameters of all generations."""
        self._strategy: Any = None
        self._candidates: np.ndarray | None = None
        self._next_seed = self.seed
        self._average = 0.0

    def _given(self, options: dict[str, Any], initial: Initial) -> dict[str, Any]:
        """Return the arguments of the strategy. Raises BotschoolError if they cannot be given."""
        try:
            takes = inspect.signature(self._found).parameters
        except (TypeError, ValueError):
            raise self._wrong("is neither a function nor a class: name one") from None
        function = not isinstance(self._found, type)
        if function and "evaluate" not in takes:
            raise self._wrong(
                "has no argument evaluate: write evolve(evaluate, centre, generations, seed), or a "
                "class with the methods ask and tell"
            )
        popsize = options.get("popsize", POPSIZE)
        if not isinstance(popsize, int) or not 1 <= popsize <= 1_000_000:
            raise self._wrong(f"has popsize = {popsize}: write a whole number above 0")
        known: dict[str, Callable[[], Any]] = {
            "centre": lambda: initial(0).copy(),
            "start": lambda: initial(0).copy(),
            "population": lambda: np.array([initial(i) for i in range(popsize)]),
            "generations": lambda: GENERATIONS,
            "seed": lambda: self.seed,
        }
        any_name = any(each.kind is each.VAR_KEYWORD for each in takes.values())
        for key in options:
            if key in (*known, "evaluate"):
                raise self._wrong(f"gets {key} from the tool: remove it from options")
            rows = key == "popsize" and "population" in takes
            if key not in takes and not any_name and not rows:
                near = nearest(key, [name for name in takes if name not in (*known, "evaluate")])
                raise self._wrong(f"takes no argument {key}: {near}")
        given = {key: value for key, value in options.items() if key in takes or any_name}
        given |= {key: make() for key, make in known.items() if key in takes}
        for key, each in takes.items():
            free = each.kind in (each.VAR_KEYWORD, each.VAR_POSITIONAL)
            if key not in given and key != "evaluate" and each.default is each.empty and not free:
                raise self._wrong(f"needs {key}: write options = {key}=VALUE under [ALGO]")
        return given

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the strategy's candidates, and a seed for each. Raises BotschoolError."""
        if self._candidates is None:
            if self._strategy is None:
                self._strategy = self._called(self._start)
            asked = self._called(self._strategy.ask)
            pair = isinstance(self._strategy, Asked)
            candidates, seed = asked if pair else (asked, None)
            self._candidates = self._checked(candidates)
            self._next_seed = self._checked_seed(seed)
        seeds = np.full(len(self._candidates), self._next_seed, dtype=np.uint64)
        return self._candidates, seeds

    def tell(self, fitness: np.ndarray) -> None:
        """Give the fitness of the candidates to the strategy. Raises BotschoolError."""
        assert self._candidates is not None
        given = np.array(fitness, dtype=float)
        self._called(self._strategy.tell, given.copy())
        self._average = mean_absolute(self._candidates)
        self.seen += self._average
        self._candidates = None
        self._remember(given)
        self.generation += 1

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the candidates that were told last."""
        return self._average

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Tell the strategy everything again. Raises BotschoolError if its answers differ."""
        told, at = np.array(state["told"], dtype=float), 0
        self._begin()
        for _ in range(int(state["generation"])):
            count = len(self.ask()[0])
            self.tell(told[at : at + count])
            at += count
        if at != len(told) or not np.isclose(self.seen, float(state["seen"]), rtol=1e-6):
            raise self._wrong(
                "gives other candidates than before, so the run cannot be resumed: draw all random "
                "numbers from the seed, undo your last change, or use ",
                FORCE,
                " to start anew",
            )

    def _remember(self, fitness: np.ndarray) -> None:
        """Append to a buffer that grows by doubling; earlier states stay as they are."""
        end = len(self.told) + len(fitness)
        if end > len(self._history):
            self._history = np.concatenate([self.told, np.zeros(end)])
        self._history[len(self.told) : end] = fitness
        self.told = self._history[:end]

    def _start(self) -> Any:
        if not isinstance(self._found, type):
            return Asked(self._found, **self._arguments)
        made = self._found(**self._arguments)
        for method in ("ask", "tell"):
            if not callable(getattr(made, method, None)):
                raise self._wrong(f"has no method {method}: a strategy has ask() and tell(fitness)")
        return made

    def _checked(self, candidates: Any) -> np.ndarray:
        try:
            array = np.array(candidates, dtype=float)
        except (TypeError, ValueError):
            raise self._wrong("gives candidates that are not an array of numbers") from None
        if array.ndim != 2 or array.shape[1] != self._size or not len(array):
            raise self._wrong(
                f"gives candidates of shape {array.shape}: it must be (candidates, {self._size}), "
                "a row of parameters for each"
            )
        if not np.isfinite(array).all():
            row = int((~np.isfinite(array)).any(axis=1).argmax())
            raise self._wrong(
                f"gives candidate {row} of generation {self.generation} a parameter that is not "
                "finite (nan or inf): look for a division by 0 or steps that explode"
            )
        return array

    def _checked_seed(self, seed: Any) -> int:
        if seed is None:
            return self.seed + self.generation
        try:
            if 0 <= int(seed) < 2**63 and int(seed) == seed:
                return int(seed)
        except (TypeError, ValueError, OverflowError):
            pass
        raise self._wrong(f"gives evaluate the seed {seed!r:.40}: it must be a whole number")

    def _called(self, function: Callable, *arguments: Any) -> Any:
        """Return the result of the strategy's code. Raises BotschoolError if the code fails."""
        try:
            return function(*arguments)
        except (BotschoolError, KeyboardInterrupt):
            raise
        except StopIteration:
            raise self._wrong(
                f"has returned after {self.generation} generations, before the run's steps were "
                "spent: let it loop over range(generations)"
            ) from None
        except SystemExit:
            raise self._wrong("calls sys.exit or quit: remove that") from None
        except BaseException as error:
            place = ""
            own = inspect.getmodule(self._found)
            for frame in traceback.extract_tb(error.__traceback__):
                if own and frame.filename == getattr(own, "__file__", None):
                    place = f", line {frame.lineno} ({frame.name})"
            what = "" if said(error) == type(error).__name__ else f": {said(error)}"
            raise self._wrong(
                f"fails in generation {self.generation}{place} with {type(error).__name__}{what}"
            ) from error

    def _wrong(self, *parts: str | Option) -> BotschoolError:
        return BotschoolError(f"Your strategy {self.name} ", *parts, ".")


OFFERED: dict[str, Callable[..., Any]] = {}
"""Strategies that a program has given, by `module:name`."""


def offer(found: Callable[..., Any]) -> str:
    """Enter a class or function of a program; return its name for `algo`. Raises BotschoolError."""
    if not callable(found) or not hasattr(found, "__name__") or not found.__name__.isidentifier():
        raise BotschoolError(
            f"{found!r:.60} is no strategy: give a class with ask and tell, or a function."
        )
    name = f"{found.__module__}:{found.__name__}"
    OFFERED[name] = found
    return name


def _find(name: str) -> Callable[..., Any]:
    """Return the function or class that `module:name` names. Raises BotschoolError."""
    if name in OFFERED:
        return OFFERED[name]
    module, _, attribute = name.partition(":")
    inside = import_here(module, f"take the strategy {attribute} from")
    found = getattr(inside, attribute, None)
    if not callable(found):
        own = [key for key, value in vars(inside).items() if callable(value) and key[0] != "_"]
        raise BotschoolError(
            f"The module {module} has no function or class {attribute}: {nearest(attribute, own)}."
        )
    return found


def _entry(name: str) -> Entry:
    return Entry(name, "your own strategy", OwnConfig, partial(Own, name), False)


ALGORITHMS.own = _entry
