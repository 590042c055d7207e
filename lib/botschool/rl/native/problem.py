"""Which Gymnasium ids are native problems that policy gradients train on."""

from __future__ import annotations

from botschool.errors import BotschoolError
from botschool.inifile import nearest
from botschool.problems.native import INFOS, NATIVE


def native_problem(env: str) -> tuple[str, int] | None:
    """The name in C++ and the longest episode of a native problem with one robot, else None.

    env: a Gymnasium id, as CartPole-v1 or botschool/Discrim-v0.
    """
    return _PROBLEMS.get(env)


def find(env: str) -> tuple[str, int]:
    """The same, or BotschoolError with the nearest name."""
    found = native_problem(env)
    if found is None:
        hint = nearest(env, list(_PROBLEMS))
        end = "" if hint.endswith("?") else "."
        raise BotschoolError(f"{env} is no native problem with one robot; {hint}{end}")
    return found


def _faces() -> dict[str, tuple[str, int]]:
    faces = {}
    for name, (core, limit) in NATIVE.items():
        info = INFOS[core]
        if (
            info["robots"] == 1 and not info["body"] and name != "Pendulum-v0"
        ):  # Gymnasium's is gone
            own = info["gym"] or (name if _of_gymnasium(name) else f"botschool/{name}")
            faces[own] = (core, limit)
    return faces


def _of_gymnasium(name: str) -> bool:
    return name.startswith(("Acrobot", "CartPole", "MountainCar", "Pendulum"))


_PROBLEMS = _faces()
