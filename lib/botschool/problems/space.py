"""Read the options of runners: reward for standing, ground, variations, a declared body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from botschool import _core
from botschool.errors import BotschoolError
from botschool.inifile import nearest
from botschool.problems import physics
from botschool.problems.finding import find, say
from botschool.problems.robot import Robot
from botschool.wrappers import keywords

DECLARED = "SpatialBody-v0"
"""The problem whose body its user may declare; without one it is the ant's."""
RUNNERS = tuple(
    f"{body}-v{version}"
    for body in (
        "PlanarHopper", "PlanarWalker2D", "PlanarHalfCheetah", "SpatialAnt", "SpatialHumanoid",
    )
    for version in "05"
)  # fmt: skip
"""Problems that take the option `alive`."""
SPACE = (
    *(name for name in RUNNERS if name.startswith("Spatial")),
    "SpatialHumanoidStandup-v0",
    "SpatialBalanceBot-v0",
)

RANGES: dict[str, tuple[str, float, float, float]] = {
    "alive": ("the reward for each step without a fall", 0.0, -100, 100),
    **{key: tuple(physics.NUMBERS[key]) for key in ("slope", "step", "bumps")},
}
BODY: dict[str, tuple[str, float, float, float]] = {
    "seconds": ("length of a step", 0.02, 0.001, 0.1),
    "substep": ("seconds of a substep", 0.002, 0.0001, 0.01),
    "noise": ("of the start's coordinates and speeds", 0.01, 0, 0.5),
    "lowest": ("height of the root below which an episode ends", -100.0, -100, 100),
    "highest": ("height of the root above which an episode ends", 100.0, -100, 100),
    "effort": ("price of the sum of squared actions", 0.0, 0, 100),
    "reach": ("the way of a position servo from its home for an action of 1", 100.0, 0.001, 100),
}


@dataclass(frozen=True)
class Options:
    """Options of a runner; `race` is None if it is the problem's own."""

    alive: float = 0.0
    race: Any = None
    body: dict | None = None
    """Of a robot of one's own: what differs from the problem's description in C++."""
    robot: Robot | None = None


def options_of(name: str, text: str, numbers: str = "") -> Options:
    """Return the options of a native problem from `alive=0.5, vary='ground, mass'`; numbers: its
    physics (botschool.problems.physics).

    Raises BotschoolError.
    """
    space, declared = name in SPACE or name == DECLARED, name == DECLARED
    if numbers and not (name in RUNNERS or space):
        raise BotschoolError(
            f"{name} has no physics in numbers, which runners and bodies in space have: remove "
            f"the line physics = {numbers}."
        )
    if not (text or numbers):
        return Options()
    if not (name in RUNNERS or space):
        raise BotschoolError(f"{name} takes no options: remove the line options = {text}.")
    given = keywords(text)
    known = dict(RANGES) if space else {"alive": RANGES["alive"]}
    known |= BODY if declared else {}
    words = [*known, "vary", *["robot", "urdf"] * declared]
    for key in given:
        if key not in words:
            raise BotschoolError(
                f"{name} has no option '{key}': {nearest(key, words)}. It takes {', '.join(words)}."
            )
    value = {key: _number(key, given.get(key, row[1]), row) for key, row in known.items()}
    race = _core.Race(physics.rows(_spans(given, value, numbers)))
    if not declared or not given.keys() & {"robot", "urdf"}:
        needless = sorted(given.keys() & BODY.keys())
        if needless:
            raise BotschoolError(
                f"{needless[0]} is of a robot of your own: add robot='my_robot.xml' to the options."
            )
        return Options(value["alive"], race if numbers or given.keys() - {"alive"} else None)
    return _declared(given, value, race)


def _number(key: str, value: Any, row: tuple[str, float, float, float]) -> float:
    meaning, _, low, high = row
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise BotschoolError(
            f"{key} = {value!r} is not possible: it is {meaning}, a number from {low} to {high}."
        )
    return float(value)


def _spans(given: dict, value: dict[str, float], numbers: str) -> physics.Spans:
    """Return the ranges of the options and of `physics`. Raises BotschoolError."""
    spans = physics.read(numbers)
    older: physics.Spans = {key: (value[key], value[key]) for key in value.keys() & given.keys()}
    older = {key: span for key, span in older.items() if key in ("slope", "step", "bumps")}
    for word in _varied(given):
        older |= physics.VARY[word]
    if twice := sorted(spans.keys() & older.keys()):
        raise BotschoolError(
            f"{twice[0]} stands in physics and in options (vary names ranges, too): keep one."
        )
    return spans | older


def _varied(given: dict) -> list[str]:
    text = given.get("vary", "")
    names = (
        [word.strip() for word in text.split(",") if word.strip()]
        if isinstance(text, str)
        else None
    )
    if names is None or not set(names) <= set(physics.VARY):
        wrong = next((word for word in names or () if word not in physics.VARY), text)
        raise BotschoolError(
            f"vary = {wrong!r} is not possible: write some of "
            f"{', '.join(physics.VARY)} in quotes, as in "
            "vary='ground, mass'."
        )
    return names


def _declared(given: dict, value: dict[str, float], race: Any) -> Options:
    path = given.get("robot", given.get("urdf"))
    if not isinstance(path, str):
        raise BotschoolError(
            f"robot = {path!r} is no path of a file: write robot='my_robot.xml' (MJCF, or .urdf)."
        )
    if value["substep"] > value["seconds"]:
        raise BotschoolError("substep must not be above seconds.")
    robot = find(path, value["reach"])
    substeps = max(1, round(value["seconds"] / value["substep"]))
    robot.declare(
        race,
        seconds=value["seconds"],
        substeps=substeps,
        noise=value["noise"],
        low=value["lowest"],
        high=value["highest"],
        alive=0.0,
        effort=value["effort"],
    )
    for sentence in robot.doubts(value["seconds"] / substeps):
        say(sentence)
    facts = {
        "observations": robot.observations,
        "outputs": robot.motors,
        "seconds": value["seconds"],
    }
    return Options(value["alive"], race, facts, robot)
