"""Find the Gymnasium ids that are native problems for policy gradients."""

from __future__ import annotations

from botschool.errors import BotschoolError
from botschool.inifile import nearest
from botschool.problems.native import IDS, INFOS, NATIVE, gym_id


def native_problem(env: str) -> tuple[str, int] | None:
    """Return the C++ name and the longest episode of a native problem with one robot, else None.

    env: its name in experiment files, or its Gymnasium id, such as botschool/Discrim-v0.
    """
    return _PROBLEMS.get(gym_id(env))


def find(env: str) -> tuple[str, int]:
    """Return the same as native_problem. Raises BotschoolError that suggests the nearest name."""
    found = native_problem(env)
    if found is None:
        hint = nearest(env, list(_PROBLEMS))
        end = "" if hint.endswith("?") else "."
        raise BotschoolError(f"{env} is not a native problem with one robot; {hint}{end}")
    return found


_PROBLEMS = {
    IDS[name]: found
    for name, found in NATIVE.items()
    if name in IDS
    and not INFOS[found[0]]["body"]
    and name != "Pendulum-v0"  # Gymnasium no longer has it
}
