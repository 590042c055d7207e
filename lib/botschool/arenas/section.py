"""Define the section [ARENA] of experiment files: its keys and what they mean.

botschool.arenas.plan checks that they fit together.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, make_dataclass
from typing import TYPE_CHECKING, Any

from botschool import _core
from botschool.arenas.things import KINDS, LONGEST, Thing
from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown
from botschool.policies.hyperparameters import hyper

WORDS = _core.declarations()
"""Names and limits from lib/arena/robots/declaration.hpp."""
REWARDS = {
    "avoid": "fast, straight and away from things",
    "explore": "1 for each cell of 8 x 8 that is new",
    "near-cylinder": "1 near a cylinder",
    "near-light": "1 near a light",
    "on-zone": "1 on a zone",
    "same-zone": "1 while all robots are on the same zone",
    "every-zone": "1 while there is a robot on every zone",
    "together": "distance covered by robots that stay near each other",
}


def sensors_of(text: str) -> tuple[str, ...]:
    """Return the sensors that a text names. Raises ValueError."""
    names = tuple(name.strip().lower() for name in str(text).split(","))
    for name in names:
        if name not in WORDS["sensors"]:
            near = nearest(name, WORDS["sensors"])
            raise ValueError(f"there is no sensor '{shown(name)}': {near}")
        if names.count(name) > 1:
            raise ValueError(f"the sensor {name} is named twice")
    return names


def _length(default: float, explanation: str) -> Any:
    return hyper(default, explanation, above=0, high=LONGEST)


@dataclass
class Scalars:
    """The keys of the section except robots and objects."""

    width: float = _length(400.0, "of the arena, mm")
    height: float = _length(400.0, "of the arena, mm")
    steps: int = hyper(1000, "longest episode, in steps of 0.1 s", low=1, high=1000000)
    sensors: str = hyper(
        "infrared",
        "what every robot senses, in this order",
        check=sensors_of,
        form=f"names separated by commas, of {', '.join(WORDS['sensors'])}",
    )
    noise: float = hyper(
        0.0, "standard deviation of the noise of all readings except time and bias", low=0, high=10
    )
    reward: str = hyper("avoid", "reward of each step", choices=REWARDS)
    distance: float = _length(60.0, "largest distance that counts as near, in mm between edges")
    collisions: str = hyper(
        "block",
        "effect of a collision",
        choices={
            "block": "the robot stays where it was",
            "end": "the episode ends without a reward",
        },
    )
    light_distance: float = _length(200.0, "distance in mm at which a light is half as bright")
    laser_beams: int = hyper(8, "number of laser beams", low=1, high=WORDS["beams"])
    laser_angle: float = hyper(
        360.0, "angle that the laser beams cover, in degrees, centred ahead", above=0, high=360
    )
    laser_range: float = _length(500.0, "range of the laser beams, mm")


def reader(key: str, cls: type[Thing]) -> Callable[[str], Thing]:
    """Return a function that reads this key's text; its errors begin with the key."""

    def read(text: str) -> Thing:
        try:
            return cls.read(text)
        except (ValueError, BotschoolError) as error:
            raise ValueError(f"{key}: {str(error).rstrip('.')}") from None

    return read


def _lines() -> list[tuple[str, type, Any]]:
    """Return the keys robot1, robot2 ... of a file."""
    made: list[tuple[str, type, Any]] = []
    for kind, cls in KINDS.items():
        form = ", ".join(("KIND" if f.name == "kind" else f"{f.name} NUMBER") for f in fields(cls))
        for number in range(1, WORDS[f"{kind}s"] + 1):
            check = reader(f"{kind}{number}", cls)
            line = hyper("", f"{kind} {number} of the arena", check=check, form=form)
            made.append((f"{kind}{number}", str, line))
    return made


if TYPE_CHECKING:

    class ArenaConfig(Scalars):
        """Hides the numbered keys, robot1, robot2 ..., from type checkers."""

else:
    ArenaConfig = make_dataclass(
        "ArenaConfig", _lines(), bases=(Scalars,), namespace={"__module__": __name__}
    )
    ArenaConfig.__doc__ = """Section [ARENA]: the arena of `environment = ErArena`."""
