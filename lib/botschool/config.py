"""Experiment files: the text of an .ini file <-> a typed, checked `Experiment`.

Every hyperparameter is declared once, below, with its default, its allowed values and a line of
explanation; reading, checking and listing all follow from these declarations.
"""

# Hyperparameters keep the names they have in .ini files.
# ruff: noqa: N815

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import MISSING, Field, asdict, dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.inifile import Entry, nearest, read_sections, refusal, shown

NO_YES = {0: "no", 1: "yes"}
DECAY = {0: "none", 1: "by 0.005 x centre", 2: "by 0.005 x sign(centre)"}


def hyper(default: Any, help: str, **limits: Any) -> Any:
    """A hyperparameter: a dataclass field with an explanation and limits.

    Limits are `low` and `high` (both allowed), `above` (itself not allowed), or `choices`, a dict
    from each allowed value to its meaning. The value has the type of the default;
    `default=MISSING` stands for a text that must be given.
    """
    return field(default=default, metadata={"help": help, **limits})


@dataclass
class Exp:
    """Section [EXP]: what is evolved, and by which algorithm."""

    environment: str = hyper(MISSING, "the problem: a native one or any Gymnasium id")
    algo: str = hyper(
        "OpenAI-ES",
        "the evolutionary algorithm",
        choices={
            "OpenAI-ES": "evolution strategy that follows an estimated gradient",
            "SSS": "steady state",
            "coevo2": "two competing populations",
        },
    )


@dataclass
class PolicyConfig:
    """Section [POLICY]: the network and how its robot is evaluated."""

    nrobots: int = hyper(1, "robots in the environment, one network each", low=1, high=1000)
    heterogeneous: int = hyper(0, "each robot has parameters of its own", choices=NO_YES)
    episodes: int = hyper(1, "episodes a candidate's fitness averages", low=1, high=1000000)
    pepisodes: int = hyper(1, "episodes of a post-evaluation", low=1, high=1000000)
    maxsteps: int = hyper(1000, "steps after which an episode is cut", low=1, high=100000000)
    nhiddens: int = hyper(
        50, "hidden neurons per layer (0 = inputs go straight to outputs)", low=0, high=10000
    )
    nhiddens2: int = hyper(
        0,
        "neurons of the second of two layers, the first gets the others (0 = equal layers)",
        low=0,
        high=20000,
    )
    nlayers: int = hyper(1, "hidden layers; recurrent networks have one", low=1, high=16)
    bias: int = hyper(0, "hidden and output neurons have a bias", choices=NO_YES)
    out_type: int = hyper(
        2, "activation of outputs", choices={1: "logistic", 2: "tanh", 3: "linear", 4: "binary"}
    )
    nbins: int = hyper(
        1,
        "output neurons per actuator; from 2 on the strongest picks the action",
        low=1,
        high=1000,
    )
    architecture: int = hyper(
        0,
        "wiring of the network",
        choices={0: "feed-forward", 1: "recurrent", 2: "fully recurrent", 3: "LSTM"},
    )
    afunction: int = hyper(
        2, "activation of hidden neurons", choices={1: "logistic", 2: "tanh", 3: "linear"}
    )
    winit: int = hyper(
        0, "initial weights", choices={0: "Xavier", 1: "norm-incoming", 2: "uniform"}
    )
    action_noise: int = hyper(
        0,
        "noise added to actions",
        choices={0: "none", 1: "Gaussian", 2: "Gaussian, evolved size"},
    )
    action_noise_range: float = hyper(
        0.01, "standard deviation of the noise when action_noise = 1", low=0, high=1000
    )
    normalize: int = hyper(0, "observations are scaled to mean 0 and spread 1", choices=NO_YES)
    clip: int = hyper(0, "inputs are kept within -5 to 5, scaled or not", choices=NO_YES)
    wrange: float = hyper(
        1.0, "initial weights lie within -wrange to wrange when winit = 2", low=0, high=1000
    )


@dataclass
class OpenAIESConfig:
    """Section [ALGO] of OpenAI-ES."""

    maxmsteps: float = hyper(1.0, "length of the run, in million steps", above=0, high=1e9)
    stepsize: float = hyper(0.01, "step size of Adam", above=0, high=1000)
    samplesize: int = hyper(
        20, "perturbations per generation, two candidates each", low=1, high=1000000
    )
    noiseStdDev: float = hyper(0.02, "standard deviation of perturbations", above=0, high=1000)
    wdecay: int = hyper(0, "pull of the centre towards 0", choices=DECAY)
    symseed: int = hyper(1, "both candidates of a perturbation meet the same seed", choices=NO_YES)
    saveeach: float = hyper(60.0, "minutes between saves (0 = every generation)", low=0, high=1e6)


@dataclass
class SSSConfig:
    """Section [ALGO] of SSS."""

    maxmsteps: float = hyper(1.0, "length of the run, in million steps", above=0, high=1e9)
    popsize: int = hyper(20, "candidates in the population, an even number", low=2, high=1000000)
    mutrate: float = hyper(
        0.02, "standard deviation of mutations (the key mutation is the same)", low=0, high=1000
    )
    saveeach: float = hyper(60.0, "minutes between saves (0 = every generation)", low=0, high=1e6)


@dataclass
class Coevo2Config:
    """Section [ALGO] of coevo2."""

    ngenerations: int = hyper(1000, "length of the run, in generations", low=1, high=1000000000)
    popsize: int = hyper(80, "candidates in each of the two populations", low=1, high=10000)
    selsize: int = hyper(
        10, "candidates evolved, and competitors met, in a generation", low=1, high=10000
    )
    samplesize: int = hyper(
        20, "perturbations per sub-generation, two candidates each", low=1, high=1000000
    )
    stepsize: float = hyper(0.01, "step size of Adam", above=0, high=1000)
    noiseStdDev: float = hyper(0.02, "standard deviation of perturbations", above=0, high=1000)
    wdecay: int = hyper(0, "pull of the centre towards 0", choices=DECAY)
    evolving: str = hyper(
        "random",
        "which candidates evolve in a generation",
        choices={"random": "drawn at random", "best": "the best against the chosen competitors"},
    )
    saveeach: int = hyper(100, "generations between saves", low=1, high=1000000000)


AlgoConfig = OpenAIESConfig | SSSConfig | Coevo2Config
ALGORITHMS: dict[str, type] = {
    "OpenAI-ES": OpenAIESConfig,
    "SSS": SSSConfig,
    "coevo2": Coevo2Config,
}
SECTIONS = ("EXP", "POLICY", "ALGO")
ALIASES = {"mutation": "mutrate"}
_UNDER = {
    "EXP": "with the line environment = NAME under it",
    "POLICY": "(nothing needs to follow it: every key has a default)",
    "ALGO": "(nothing needs to follow it: every key has a default)",
}


@dataclass
class Experiment:
    """One experiment file; `path` is where it was read from, and takes no part in equality."""

    exp: Exp
    policy: PolicyConfig
    algo: AlgoConfig
    path: Path | None = field(default=None, compare=False)


def load(path: str | PathLike[str]) -> Experiment:
    """Read and check an experiment file.

    Raises BotschoolError with one sentence: the file, the line, what is wrong, what to do.
    """
    return _experiment(read_sections(path, SECTIONS, ALIASES), path)


def to_dict(experiment: Experiment) -> dict[str, dict[str, Any]]:
    """The experiment as plain numbers and strings, ready for JSON, without its path."""
    return {part: asdict(getattr(experiment, part)) for part in ("exp", "policy", "algo")}


def from_dict(data: dict[str, dict[str, Any]], source: str = "experiment") -> Experiment:
    """The experiment that `to_dict` gave; keys that are missing get their default.

    Raises BotschoolError, whose sentence starts with `source`, where `load` would.
    """
    if not isinstance(data, dict) or not all(isinstance(part, dict) for part in data.values()):
        raise BotschoolError(f"{source}: expected the nested dict that to_dict gives.")
    sections = {
        part.upper(): {str(key).lower(): Entry(str(key), value, 0) for key, value in values.items()}
        for part, values in data.items()
    }
    return replace(_experiment(sections, source), path=None)


def describe() -> list[tuple[str, str, Any, str]]:
    """Rows (section, name, default, help) of all hyperparameters of all algorithms.

    Sections are `EXP`, `POLICY` and `ALGO OpenAI-ES`, `ALGO SSS`, `ALGO coevo2`. The default is
    None where a value must be given. The help ends with the allowed values.
    """
    parts = [("EXP", Exp), ("POLICY", PolicyConfig)]
    parts += [(f"ALGO {name}", config) for name, config in ALGORITHMS.items()]
    return [
        (
            section,
            f.name,
            None if f.default is MISSING else f.default,
            f"{f.metadata['help']}: {_allowed(f)}",
        )
        for section, config in parts
        for f in fields(config)
    ]


def _experiment(sections: dict[str, dict[str, Entry]], path: str | PathLike[str]) -> Experiment:
    for section in SECTIONS:
        if section not in sections:
            raise refusal(
                path,
                0,
                f"section [{section}] is missing: add a line [{section}] {_UNDER[section]}",
            )
    exp = _build(Exp, "EXP", sections["EXP"], path)
    policy = _build(PolicyConfig, "POLICY", sections["POLICY"], path)
    algo = _build(ALGORITHMS[exp.algo], "ALGO", sections["ALGO"], path)
    experiment = Experiment(exp, policy, algo, Path(path))
    lines = {key: entry.line for entries in sections.values() for key, entry in entries.items()}
    for keys, sentence in _conflicts(experiment):
        raise refusal(path, max(lines.get(key.lower(), 0) for key in keys), sentence)
    return experiment


def _build(cls: type, section: str, entries: dict[str, Entry], path: str | PathLike[str]) -> Any:
    """An instance of `cls` from the entries of its section."""
    known = {f.name.lower(): f for f in fields(cls)}
    values = {}
    for key, entry in entries.items():
        if key not in known:
            raise refusal(path, entry.line, _unknown(entry.key, section, cls))
        try:
            values[known[key].name] = _value(known[key], entry)
        except ValueError as error:
            raise refusal(path, entry.line, str(error)) from None
    for f in fields(cls):
        if f.default is MISSING and f.name not in values:
            raise refusal(
                path, 0, f"{f.name} is missing: add the line {f.name} = NAME under [{section}]"
            )
    return cls(**values)


def _value(f: Field, entry: Entry) -> Any:
    """The entry's value, in the type and the limits that `f` declares; ValueError otherwise."""
    raw, limits = entry.value, f.metadata
    said = f"{entry.key} = {shown(raw)}"
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
    """The value of a hyperparameter that is a text: one of its choices, or a name."""
    choices = {choice.lower(): choice for choice in f.metadata.get("choices", [])}
    if not choices:
        if not isinstance(raw, str) or not re.fullmatch(r"[\w./:-]+", raw, re.ASCII):
            raise ValueError(
                f"{said} is not a name: write it without quotes and spaces, as in CartPole-v1"
            )
        return raw
    if str(raw).lower() not in choices:
        raise ValueError(f"{said} is unknown: {nearest(str(raw), choices.values())}")
    return choices[str(raw).lower()]


def _number(raw: Any) -> float | int | None:
    """The number that a text or a value is, nan and the infinities included; None if it is none."""
    if isinstance(raw, str):
        pattern = r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?|[+-]?(nan|inf|infinity)"
        return float(raw) if re.fullmatch(pattern, raw, re.ASCII | re.IGNORECASE) else None
    if isinstance(raw, bool) or not isinstance(raw, (int, float)):
        return None
    return raw if abs(raw) < 1e300 or isinstance(raw, float) else math.inf


def _allowed(f: Field) -> str:
    """What a value may be, as the end of a sentence."""
    limits = f.metadata
    if "choices" in limits:
        *most, last = [f"{value} ({meaning})" for value, meaning in limits["choices"].items()]
        return f"{', '.join(most)} or {last}"
    if f.default is MISSING:
        return "a name such as CartPole-v1"
    kind = "a whole number" if isinstance(f.default, int) else "a number"
    if "above" in limits:
        return f"{kind} above {limits['above']}, at most {limits['high']:.0f}"
    return f"{kind} from {limits['low']} to {limits['high']:.0f}"


def _unknown(key: str, section: str, cls: type) -> str:
    """The sentence for a key that its section does not have."""
    name = key.lower()
    for other, config in (("EXP", Exp), ("POLICY", PolicyConfig)):
        if name in (f.name.lower() for f in fields(config)):
            return f"{key} belongs in section [{other}], not [{section}]: move the line there"
    owners = [
        algo
        for algo, config in ALGORITHMS.items()
        if ALIASES.get(name, name) in (f.name.lower() for f in fields(config))
    ]
    if owners and section != "ALGO":
        return f"{key} belongs in section [ALGO], not [{section}]: move the line there"
    if owners:
        chosen = next(algo for algo, config in ALGORITHMS.items() if config is cls)
        return (
            f"{key} is a hyperparameter of {' and '.join(owners)}, but this experiment uses "
            f"{chosen}: remove the line, or set algo = {owners[0]} in section [EXP]"
        )
    return f"{key} is no hyperparameter: {nearest(key, (f.name for f in fields(cls)))}"


def _conflicts(experiment: Experiment) -> Iterator[tuple[tuple[str, ...], str]]:
    """Hyperparameters that cannot go together: their names and a sentence with the remedy."""
    p, a = experiment.policy, experiment.algo
    if p.nhiddens2 and p.nlayers != 2:
        yield (
            ("nhiddens2",),
            f"nhiddens2 = {p.nhiddens2} needs nlayers = 2, but nlayers is {p.nlayers}: "
            "set nlayers = 2 or nhiddens2 = 0",
        )
    if p.nhiddens2 and p.nhiddens2 >= 2 * p.nhiddens:
        yield (
            ("nhiddens2",),
            f"nhiddens2 = {p.nhiddens2} leaves no neuron to the first layer: "
            f"it must be below 2 x nhiddens = {2 * p.nhiddens}",
        )
    if p.architecture and p.nhiddens and p.nlayers != 1:
        yield (
            ("architecture",),
            f"architecture = {p.architecture} is recurrent and has one hidden layer, "
            f"but nlayers is {p.nlayers}: set nlayers = 1 or architecture = 0",
        )
    if isinstance(a, SSSConfig) and a.popsize % 2:
        yield (
            ("popsize",),
            f"popsize = {a.popsize} is odd, but SSS replaces the worst half by the best half: "
            f"set popsize = {a.popsize + 1}",
        )
    if isinstance(a, Coevo2Config) and a.selsize > a.popsize:
        yield (
            ("selsize", "popsize"),
            f"selsize = {a.selsize} is more than popsize = {a.popsize}: lower selsize",
        )
