"""Read experiment files: the text of an .ini file becomes a typed, checked `Experiment`.

botschool.policies.hyperparameters declares hyperparameters; each algorithm declares its own in its
file of botschool.evolution.algorithms. Reading, checking and listing use these declarations.
"""

from __future__ import annotations

import math
import re
from dataclasses import MISSING, Field, asdict, dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import Any

import botschool.evolution.algorithms  # noqa: F401  (fills ALGORITHMS)
from botschool import _core, sisters
from botschool.arenas.plan import PROBLEM, Plan, PlanError
from botschool.arenas.robots import MODELS, find
from botschool.arenas.section import WORDS, ArenaConfig
from botschool.arenas.things import KINDS
from botschool.errors import BotschoolError
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.algorithms.coevo2 import Coevo2Config
from botschool.evolution.algorithms.openaies import OpenAIESConfig
from botschool.evolution.algorithms.own import OwnConfig
from botschool.evolution.algorithms.sss import SSSConfig
from botschool.inifile import Entry, nearest, read_sections, refusal, shown
from botschool.policies.hyperparameters import NO_YES, PolicyConfig, conflicts, hyper, one_layer
from botschool.problems import physics
from botschool.problems.native import NATIVE, own_name
from botschool.wrappers import keywords, parse, spelled

__all__ = [
    "NO_YES",
    "Coevo2Config",
    "Exp",
    "Experiment",
    "OpenAIESConfig",
    "PolicyConfig",
    "SSSConfig",
    "describe",
    "from_dict",
    "hyper",
    "load",
    "to_dict",
]


@dataclass
class Exp:
    """Section [EXP]: the problem, and the algorithm that evolves its robots."""

    environment: str = hyper(
        MISSING, "the problem: a native one, any Gymnasium id, or PettingZoo's for two"
    )
    algo: str = hyper(
        "OpenAI-ES",
        "the evolutionary algorithm (or your own, as module:name)",
        choices={name: ALGORITHMS[name].explanation for name in sorted(ALGORITHMS)},
        same=sisters.SAME,
        own=r"[A-Za-z_][\w.]*:[A-Za-z_]\w*",
    )
    robots: str = hyper(
        "",
        "other wheeled robots than the problem's own, one kind for all or one each",
        each=MODELS,
    )
    wrappers: str = hyper(
        "",
        "wrappers around the environment, which then is played in Python",
        check=parse,
        form="names of Gymnasium's wrappers or module:Class, separated by commas",
    )
    options: str = hyper(
        "",
        "options of the environment, as its constructor takes them",
        check=keywords,
        form="name=value, separated by commas",
    )
    reward: str = hyper(
        "",
        "an expression in place of a native problem's own reward, as ahead - 0.05 * effort",
        check=str,
        form="an expression over quantities that `botschool problems NAME` lists",
    )
    ends: str = hyper(
        "",
        "an expression that ends an episode where it is true, as height < 0.2",
        check=str,
        form="an expression over quantities that `botschool problems NAME` lists",
    )
    physics: str = hyper(
        "",
        "numbers of a runner's world, or ranges from which each episode draws them",
        check=physics.read,
        form="name=number or name=low..high, as in gravity=3.7, friction=0.4..1.2",
    )


SECTIONS = ("EXP", "POLICY", "ALGO")
ARENA, ENV, TUNE = "ARENA", "ENV", "TUNE"
"""Sections for a declared arena, for options of the environment (as in evorobotpy3), for tuning."""
ALIASES = {
    f.metadata["alias"]: f.name.lower()
    for entry in ALGORITHMS.values()
    for f in fields(entry.config)
    if "alias" in f.metadata
}


@dataclass
class Experiment:
    """An experiment file; `path` is the file it was read from and does not count in comparisons."""

    exp: Exp
    policy: PolicyConfig
    algo: Any
    """The hyperparameters of `exp.algo`, in the dataclass that its file declares."""
    arena: Any = None
    """The section [ARENA] (arenas.section.ArenaConfig), None without one."""
    path: Path | None = field(default=None, compare=False)
    notes: tuple[str, ...] = field(default=(), compare=False)
    """What of the file means something else here, in sentences."""
    tune: dict[str, Entry] = field(default_factory=dict, compare=False)
    """The section [TUNE], which botschool.analysis.tuning reads."""

    @property
    def competitive(self) -> bool:
        """Return whether two populations evolve against each other."""
        return ALGORITHMS[self.exp.algo].competitive

    @property
    def single(self) -> bool:
        """Return whether one population plays both sides."""
        return self.competitive and len(ALGORITHMS[self.exp.algo].make.sides) == 1

    @property
    def plan(self) -> Plan | None:
        """Return the declared arena, if there is one."""
        return None if self.arena is None else Plan.of(self.arena)

    @property
    def parts(self) -> tuple[str, ...]:
        """Return its sections, named as in to_dict."""
        return ("exp", "policy", "algo") + (("arena",) if self.arena is not None else ())


def load(path: str | PathLike[str]) -> Experiment:
    """Read and check an experiment file.

    Raises BotschoolError; its sentence names the file, the line, the error and the remedy.
    """
    return _experiment(read_sections(path, (*SECTIONS, ARENA, ENV, TUNE), ALIASES), path)


def to_dict(experiment: Experiment) -> dict[str, dict[str, Any]]:
    """Return the experiment as plain numbers and strings, ready for JSON, without its path."""
    return {part: asdict(getattr(experiment, part)) for part in experiment.parts}


def from_dict(data: dict[str, dict[str, Any]], source: str = "experiment") -> Experiment:
    """Return the experiment that `to_dict` gave; missing keys get their default.

    Raises BotschoolError in the same cases as `load`; its sentence starts with `source`.
    """
    if not isinstance(data, dict) or not all(isinstance(part, dict) for part in data.values()):
        raise BotschoolError(f"{source}: expected the nested dict that to_dict gives.")
    sections = {
        part.upper(): {str(key).lower(): Entry(str(key), value, 0) for key, value in values.items()}
        for part, values in data.items()
    }
    return replace(_experiment(sections, source), path=None)


def defaults(experiment: Experiment) -> dict[str, dict[str, Any]]:
    """Return all of the experiment's hyperparameters that have a default, as in to_dict."""
    return {
        part: {f.name: f.default for f in fields(getattr(experiment, part))}
        for part in experiment.parts
    }


def free(experiment: Experiment) -> set[tuple[str, str]]:
    """Return the (section, key) pairs, as in to_dict, that may change when a run is resumed."""
    return {("algo", f.name) for f in fields(experiment.algo) if f.metadata.get("free")}


def describe() -> list[tuple[str, str, Any, str]]:
    """Return rows (section, name, default, help) of all hyperparameters of all algorithms.

    Sections are `EXP`, `POLICY`, `ARENA` and `ALGO NAME` of each algorithm. The default is None for
    hyperparameters that must be given. robot1 also stands for robot2, robot3 and so on. The help
    ends with the allowed values.
    """
    parts = [("EXP", Exp), ("POLICY", PolicyConfig), (ARENA, ArenaConfig)]
    parts += [(f"ALGO {name}", ALGORITHMS[name].config) for name in sorted(ALGORITHMS)]
    return [
        (
            section,
            f.name,
            None if f.default is MISSING else f.default,
            f"{f.metadata['help']}{_also(f)}: {_allowed(f)}",
        )
        for section, config in parts
        for f in fields(config)
        if config is not ArenaConfig or not re.search("[2-9]$", f.name)
    ]


def _experiment(sections: dict[str, dict[str, Entry]], path: str | PathLike[str]) -> Experiment:
    if "EXP" not in sections:
        raise refusal(
            path,
            0,
            "section [EXP] is missing: add a line [EXP] with the line environment = NAME under it",
        )
    notes: list[str] = []
    exp = _build(Exp, "EXP", sections["EXP"], path, notes)
    exp.environment = own_name(exp.environment)
    if exp.wrappers and exp.environment in NATIVE and ARENA not in sections:
        notes.append(f"{exp.environment} runs in Python: the native engine takes no wrappers.")
    if sections.get(ENV):
        notes += _take_options(exp, sections[ENV], path)
    policy = _build(PolicyConfig, "POLICY", sections.get("POLICY", {}), path, notes)
    if "pepisodes" not in sections.get("POLICY", {}):
        policy.pepisodes = _post_episodes(exp)
    algo = _build(ALGORITHMS[exp.algo].config, "ALGO", sections.get("ALGO", {}), path, notes)
    arena = _arena(exp, sections.get(ARENA), path)
    lines = {key: entry.line for entries in sections.values() for key, entry in entries.items()}
    for keys, sentence in (*conflicts(policy), *ALGORITHMS[exp.algo].conflicts(algo)):
        raise refusal(path, max(lines.get(key.lower(), 0) for key in keys), sentence)
    policy, note = one_layer(policy)
    told = (*notes, *note)
    return Experiment(exp, policy, algo, arena, Path(path), told, sections.get(TUNE, {}))


def _post_episodes(exp: Exp) -> int:
    """Return the episodes of a post-evaluation where a file does not tell them."""
    if ALGORITHMS[exp.algo].competitive:
        return 1  # fitness is the mean over all opponents; only -p and tournaments use it
    return 20 if exp.environment in NATIVE and not exp.wrappers else 5


def _take_options(exp: Exp, entries: dict[str, Entry], path: str | PathLike[str]) -> list[str]:
    """Make the lines of [ENV] options of the environment; return a note if it has none."""
    first = next(iter(entries.values()))
    if exp.options:
        raise refusal(
            path, first.line, "section [ENV] and options mean the same: keep one of the two"
        )
    native = {name for info in _core.native_problems() for name in (info["name"], info["alias"])}
    if exp.environment in native and not exp.environment.startswith("Planar"):
        return [f"section [ENV] is left out: {exp.environment} has no options."]
    exp.options = spelled({entry.key: entry.value for entry in entries.values()})
    try:
        keywords(exp.options)
    except BotschoolError as error:
        raise refusal(path, first.line, str(error).rstrip(".")) from None
    return []


def _arena(exp: Exp, entries: dict[str, Entry] | None, path: str | PathLike[str]) -> Any:
    """Return the section [ARENA] after checking its plan; None if there is none."""
    declared = exp.environment == PROBLEM
    if entries is None and not declared:
        return None
    if not declared:
        raise refusal(
            path,
            0,
            f"section [ARENA] declares an arena, but environment is {exp.environment}: set "
            f"environment = {PROBLEM}, or remove the section",
        )
    arena = _build(ArenaConfig, ARENA, entries or {}, path, [])
    try:
        Plan.of(arena)
    except PlanError as error:
        entry = (entries or {}).get(error.key)
        raise refusal(path, entry.line if entry else 0, str(error).rstrip(".")) from None
    return arena


def _build(
    cls: type,
    section: str,
    entries: dict[str, Entry],
    path: str | PathLike[str],
    notes: list[str],
) -> Any:
    """Return an instance of `cls` from the entries of its section; add to the notes."""
    known = {f.name.lower(): f for f in fields(cls)}
    values = {}
    for key, entry in entries.items():
        if key in sisters.NEEDLESS and cls is not OwnConfig:
            said = f"line {entry.line}: {entry.key} is left out: "
            notes.append(f"{said}{sisters.NEEDLESS[key]}.")
            continue
        alias = known[key].metadata.get("alias") if key in known else None
        if key not in known or entry.key.lower() not in (key, alias):
            raise refusal(path, entry.line, _unknown(entry.key, section, cls))
        try:
            values[known[key].name] = _value(known[key], entry)
        except (ValueError, BotschoolError) as error:
            raise refusal(path, entry.line, str(error).rstrip(".")) from None
    for f in fields(cls):
        if f.default is MISSING and f.name not in values:
            raise refusal(
                path, 0, f"{f.name} is missing: add the line {f.name} = NAME under [{section}]"
            )
    return cls(**values)


def _value(f: Field, entry: Entry) -> Any:
    """Return the entry's value in the type and limits of `f`. Raises ValueError."""
    raw, limits = entry.value, f.metadata
    said = f"{entry.key} = {shown(raw)}"
    if raw == "" and f.default == "":
        return ""
    if raw == "":
        raise ValueError(f"{entry.key} has no value: it needs {_allowed(f)}")
    if f.default is MISSING or isinstance(f.default, str):
        return _text(f, raw, said)
    number = _number(raw)
    if number is None:
        comma = isinstance(raw, str) and _number(raw.replace(",", ".", 1)) is not None
        remedy = "write a point instead of the comma" if comma else f"it needs {_allowed(f)}"
        raise ValueError(f"{said} is not a number: {remedy}")
    if not math.isfinite(number):
        raise ValueError(f"{said} is not a finite number: it needs {_allowed(f)}")
    if isinstance(f.default, int):
        if number != int(number):
            raise ValueError(f"{said} is not a whole number: it needs {_allowed(f)}")
        number = int(number)
    else:
        number = float(number)
    inside = (
        number in limits.get("choices", [number])
        and limits.get("low", number) <= number <= limits.get("high", number)
        and not ("above" in limits and number <= limits["above"])
    )
    if not inside:
        raise ValueError(f"{said} is out of range: it needs {_allowed(f)}")
    return number


def _text(f: Field, raw: Any, said: str) -> str:
    """Return the value of a text hyperparameter: one of its choices, or a name."""
    if "check" in f.metadata:
        f.metadata["check"](str(raw))
        return str(raw)
    if "each" in f.metadata:
        return ", ".join(find(name.strip()).name for name in str(raw).split(","))
    choices = {choice.lower(): choice for choice in f.metadata.get("choices", [])}
    if not choices:
        if not isinstance(raw, str) or not re.fullmatch(r"[\w./:-]+", raw, re.ASCII):
            raise ValueError(
                f"{said} is not a name: write it without quotes and spaces, as in CartPole-v1"
            )
        return raw
    if "own" in f.metadata and re.fullmatch(f.metadata["own"], str(raw), re.ASCII):
        return str(raw)
    raw = f.metadata.get("same", {}).get(str(raw).lower(), raw)
    if remedy := sisters.instead(f.name, str(raw)):
        raise ValueError(f"{said} is no algorithm of botschool es: {remedy}")
    if str(raw).lower() not in choices:
        raise ValueError(f"{said} is unknown: {nearest(str(raw), choices.values())}")
    return choices[str(raw).lower()]


def _number(raw: Any) -> float | int | None:
    """Return the number that a text or a value is, even nan or infinite; None for other values."""
    if isinstance(raw, str):
        pattern = r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?|[+-]?(nan|inf|infinity)"
        return float(raw) if re.fullmatch(pattern, raw, re.ASCII | re.IGNORECASE) else None
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        return None
    return raw if abs(raw) < 1e300 or isinstance(raw, float) else math.inf


def _allowed(f: Field) -> str:
    """Return the allowed values, as the end of a sentence."""
    limits = f.metadata
    if "choices" in limits:
        *most, last = [f"{value} ({meaning})" for value, meaning in limits["choices"].items()]
        return f"{', '.join(most)} or {last}" if most else last
    if f.default is MISSING:
        return "a name such as CartPole-v1"
    if "form" in limits:
        return limits["form"]
    if "each" in limits:
        return f"names separated by commas, of {', '.join(limits['each'])}"
    kind = "a whole number" if isinstance(f.default, int) else "a number"
    if "above" in limits:
        return f"{kind} above {limits['above']}, at most {limits['high']:.0f}"
    return f"{kind} from {limits['low']} to {limits['high']:.0f}"


def _also(f: Field) -> str:
    """Return the other name of a key, in brackets."""
    return f" (the key {f.metadata['alias']} is the same)" if "alias" in f.metadata else ""


def _unknown(key: str, section: str, cls: type) -> str:
    """Return the sentence about a key that its section does not have."""
    name = key.lower()
    if section == ARENA and (kind := re.fullmatch(r"(\D+?)s?(\d*)", name)) and kind[1] in KINDS:
        if kind[2]:
            return f"there is no {key}: an arena has {kind[1]}1 to {kind[1]}{WORDS[kind[1] + 's']}"
        return f"{key} has no number: write {kind[1]}1, and so on"
    for other, config in (("EXP", Exp), ("POLICY", PolicyConfig), (ARENA, ArenaConfig)):
        if name in (f.name.lower() for f in fields(config)):
            return f"{key} belongs in section [{other}], not [{section}]: move the line there"
    if cls is OwnConfig:
        return f"{key} is an argument of your own strategy: write options = {key}=VALUE"
    if remedy := sisters.instead("key", key):
        return f"{key} is no hyperparameter here: {remedy}"
    owners = [
        algo
        for algo in sorted(ALGORITHMS)
        if ALIASES.get(name, name) in (f.name.lower() for f in fields(ALGORITHMS[algo].config))
    ]
    if owners and section != "ALGO":
        return f"{key} belongs in section [ALGO], not [{section}]: move the line there"
    if owners:
        chosen = next(algo for algo, entry in ALGORITHMS.items() if entry.config is cls)
        listed = " and ".join(filter(None, (", ".join(owners[:-1]), owners[-1])))
        return (
            f"{key} is a hyperparameter of {listed}, but this experiment uses "
            f"{chosen}: remove the line, or set algo = {owners[0]} in section [EXP]"
        )
    return f"{key} is no hyperparameter: {nearest(key, (f.name for f in fields(cls)))}"
