"""Turn what a program names (a file, an id, a dict, keywords) into a checked experiment."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields, replace
from difflib import get_close_matches
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from botschool.arenas.section import ArenaConfig
from botschool.config import Exp, Experiment, from_dict, load, to_dict
from botschool.errors import BotschoolError
from botschool.evolution.algorithm import ALGORITHMS, RunConfig
from botschool.evolution.algorithms import own
from botschool.inifile import shown
from botschool.paths import own_file
from botschool.policies.hyperparameters import PolicyConfig
from botschool.wrappers import bare, spelled

Source: TypeAlias = str | PathLike[str] | dict[str, Any] | Experiment
"""An experiment file, a problem's name, a dict of hyperparameters, or an Experiment."""

SHORT = {"hidden": "nhiddens"}
"""Further names of hyperparameters, for programs."""

SECTIONS = {
    f.name.lower(): part
    for part, kind in [
        *(("arena", ArenaConfig), *(("algo", entry.config) for entry in ALGORITHMS.values())),
        *(("policy", PolicyConfig), ("exp", Exp)),
    ]
    for f in fields(kind)
}
"""The section of each hyperparameter."""


@contextmanager
def in_python_words() -> Iterator[None]:
    """Raise the block's BotschoolError with remedies for Python, without the way it came."""
    try:
        yield
    except BotschoolError as error:
        raise BotschoolError(error.in_python) from None


def experiment_of(
    source: Source, given: dict[str, Any], algorithm: Callable[..., Any] | None = None
) -> Experiment:
    """Return the experiment that a program means; given: hyperparameters that replace its own.

    algorithm: a class with ask and tell, or a function, for `algo`; it gets the hyperparameters
    that no section has. Raises BotschoolError.
    """
    check_words(given)
    parts, path = _parts(source)
    before = dict(parts.get("algo", {}))
    given = {SHORT.get(key, key): value for key, value in given.items()}
    if algorithm is not None:
        if "algo" in given:
            raise BotschoolError("algo and algorithm mean the same: give one of them.")
        given["algo"] = own.offer(algorithm)
        run = {f.name for f in fields(RunConfig)}
        names = [key for key in given if _part(key) not in ("exp", "policy") and key not in run]
        arguments = {key: given.pop(key) for key in names}
        parts["algo"] = {"options": spelled({k: repr(bare(v)) for k, v in arguments.items()})}
    for key, value in given.items():
        parts.setdefault(_part(key), {})[key] = _plain(value)
    if "algo" in given and before:  # keep what the new algorithm has, too
        kind = type(from_dict({**parts, "algo": {}}).algo)
        kept = {f.name for f in fields(kind)} - {"options"}
        parts["algo"] = {key: before[key] for key in before if key in kept} | {
            key: value for key, value in parts["algo"].items() if before.get(key) != value
        }
    return replace(from_dict(parts, str(path or "experiment")), path=path)


def check_words(given: dict[str, Any]) -> None:
    """Raise BotschoolError for a word of Stable-Baselines3 that another word means here."""
    if "total_timesteps" in given:
        raise BotschoolError("total_timesteps means steps here: write steps=100_000.")


def _parts(source: Source) -> tuple[dict[str, dict[str, Any]], Path | None]:
    """Return the sections that a source has, as to_dict names them, and its file."""
    if isinstance(source, Experiment):
        return to_dict(source), source.path
    if isinstance(source, dict):
        parts: dict[str, dict[str, Any]] = {}
        for key, value in source.items():
            if isinstance(value, dict) and key.lower() in ("exp", "policy", "algo", "arena"):
                parts.setdefault(key.lower(), {}).update({k: _plain(v) for k, v in value.items()})
            else:
                parts.setdefault(_part(key), {})[SHORT.get(key, key)] = _plain(value)
        return parts, None
    if not isinstance(source, (str, PathLike)):
        raise BotschoolError(
            f"An experiment is a file, the name of a problem or a dict, but not a "
            f"{type(source).__name__}: write 'hopper.ini' or 'CartPole-v1'."
        )
    if isinstance(source, str) and not source.endswith(".ini") and not Path(source).is_file():
        return {"exp": {"environment": source}}, None
    experiment = load(own_file(source, "experiments"))
    for note in experiment.notes:
        print(f"note: {source}: {note}", file=sys.stderr)
    return to_dict(experiment), experiment.path


def _part(key: str) -> str:
    """Return the section of a hyperparameter; of an unknown one that which has the most similar."""
    key = SHORT.get(key, key).lower()
    near = [key] if key in SECTIONS else get_close_matches(key, SECTIONS, n=1)
    return SECTIONS[near[0]] if near else "algo"


def _plain(value: Any) -> Any:
    """Return a value as experiment files have it."""
    value = bare(value)
    if isinstance(value, dict):
        return spelled({key: repr(bare(each)) for key, each in value.items()})
    if isinstance(value, (list, tuple)):
        return ", ".join(str(bare(each)) for each in value)
    return int(value) if isinstance(value, bool) else value


def whole(name: str, value: Any, least: int = 1, most: int = 2**62) -> int:
    """Return a whole number within limits, of Python or numpy. Raises BotschoolError."""
    number = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not number or not least <= value <= most:
        power = {2**62: "2^62", 2**64 - 1: "2^64 - 1", 2**32 - 1: "2^32 - 1"}[most]
        raise BotschoolError(
            f"{name} is {value!r:.40}, but must be a whole number from {least} to {power}."
        )
    return int(value)


def seeded(seed: Any) -> int:
    """Return the seed of episodes or networks. Raises BotschoolError."""
    return whole("seed", seed, 0, 2**64 - 1)


def numbers(name: str, values: Any) -> np.ndarray:
    """Return an array of numbers, of any shape. Raises BotschoolError for texts and the like."""
    try:
        array = np.asarray(values)
    except (ValueError, TypeError, OverflowError):  # rows of different lengths, for example
        array = np.empty(0, object)
    if array.dtype.kind not in "fiu":
        raise BotschoolError(
            f"{name} is {shown(values)}, but must be an array of numbers, all rows equally long."
        )
    return array


def usable(workers: int, native: bool) -> int:
    """Return how many workers can start: one, with a note, where a script's processes would run the
    script again. Raises BotschoolError for no number of workers.
    """
    workers = whole("workers", workers)
    script = getattr(sys.modules.get("__main__"), "__file__", None)
    if native or workers == 1 or script is None or not script.endswith(".py"):
        return workers
    try:
        guarded = "__name__" in Path(script).read_text(encoding="utf-8", errors="replace")
    except OSError:
        guarded = True
    if guarded:
        return workers
    print(
        f"note: workers = 1, because worker processes import {script}: put its calls under "
        "`if __name__ == '__main__':` to use more.",
        file=sys.stderr,
    )
    return 1
