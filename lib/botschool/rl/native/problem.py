"""Find the Gymnasium ids that are native problems for policy gradients."""

from __future__ import annotations

from botschool.errors import BotschoolError
from botschool.inifile import nearest
from botschool.problems.native import INFOS, NATIVE


def native_problem(env: str) -> tuple[str, int] | None:
    """Return the C++ name and the longest episode of a native problem with one robot, else None.

    env: a Gymnasium id, such as CartPole-v1 or botschool/Discrim-v0.
    """
    return _PROBLEMS.get(env)


def find(env: str) -> tuple[str, int]:
    """Return the same as native_problem. Raises BotschoolError that suggests the nearest name."""
    found = native_problem(env)
    if found is None:
        hint = nearest(env, list(_PROBLEMS))
        end = "" if hint.endswith("?") else "."
        raise BotschoolError(f"{env} is not a native problem with one robot; {hint}{end}")
    return found


def _faces() -> dict[str, tuple[str, int]]:
    faces = {}
    for name, (core, limit) in NATIVE.items():
        info = INFOS[core]
        if (
            info["robots"] == 1 and not info["body"] and name != "Pendulum-v0"
        ):  # Gymnasium no longer has this problem
            own = info["gym"] or (name if _of_gymnasium(name) else f"botschool/{name}")
            faces[own] = (core, limit)
    return faces


def _of_gymnasium(name: str) -> bool:
    return name.startswith(("Acrobot", "CartPole", "MountainCar", "Pendulum"))


_PROBLEMS = _faces()
