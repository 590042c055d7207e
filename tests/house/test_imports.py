"""Imports run one way: nothing imports upwards, nothing in a circle (docs/architecture.md)."""

import ast
from pathlib import Path

import pytest

import botschool

PACKAGE = Path(botschool.__file__).parent

LAYERS = (
    {"errors", "npy", "screen", "sisters", "__init__"},
    {"console"},
    {"_core", "paths", "terminal", "inifile", "output", "sandbox"},
    {"examples", "linear", "lock", "seeds", "wrappers"},
    {"policies"},
    {"arenas"},
    {"arena", "net"},
    {"problems"},
    {"evolution.algorithm"},
    {"evolution.algorithms"},
    {"config"},
    {"cluster"},
    {"evolution"},
    {"render"},
    {"envs"},
    {"rl"},
    {"analysis", "page"},
    {"course", "grading.declare", "interface"},
    {"grading.packed", "grading.run"},
    {"grading.judge"},
    {"grading.notebook"},
    {"grading.copies"},
    {"grading.report"},
    {"grading.classes"},
    {"grading"},
    {"labs.fields"},
    {"labs.declare"},
    {"labs"},
    {"cli"},
    {"__main__"},
)
"""Units from the lowest to the highest; those of a layer do not import each other."""


def modules() -> dict[str, Path]:
    """Every module, by its name without the package's."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 1 else parts)
        found[name] = path
    return found


MODULES = modules()


def imported(path: Path, name: str) -> set[str]:
    """Our modules that a file imports, anywhere in it, be it in a function or for types only."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports name their module in full"
            names = [f"{node.module}.{alias.name}" for alias in node.names] + [node.module]
        else:
            continue
        for full in names:
            own = full.removeprefix("botschool.") if full.startswith("botschool.") else ""
            while own and own not in MODULES and own != "_core":
                own = own.rpartition(".")[0]
            if own and own != name:
                found.add(own)
    return found


@pytest.fixture(scope="module")
def imports():
    """Each module, and those of ours that it imports."""
    return {name: imported(path, name) for name, path in MODULES.items()}


def unit(module: str) -> str:
    """The unit of LAYERS that a module belongs to: the innermost one that has it."""
    while module and module not in RANK:
        module = module.rpartition(".")[0]
    return module


RANK = {name: rank for rank, units in enumerate(LAYERS) for name in units}


def test_each_unit_is_named_once():
    assert len(RANK) == sum(map(len, LAYERS))


def test_every_module_has_a_layer():
    assert not [name for name in MODULES if not unit(name)]


def test_nothing_imports_upwards(imports):
    upwards = []
    for name, targets in imports.items():
        for target in targets:
            one, other = unit(name), unit(target)
            if one == other:
                continue
            if RANK[other] >= RANK[one]:
                upwards.append(f"{name} -> {target}")
    assert not upwards, "\n".join(sorted(upwards))


def test_nothing_imports_in_a_circle(imports):
    state: dict[str, int] = {}

    def visit(name: str, way: list[str]) -> None:
        assert state.get(name) != 1, " -> ".join([*way[way.index(name) :], name])
        if name in state or name not in imports:
            return
        state[name] = 1
        for target in sorted(imports[name]):
            # a package's __init__ stands for the package, whose modules may import each other
            if not name.startswith(f"{target}."):
                visit(target, [*way, name])
        state[name] = 2

    for name in imports:
        visit(name, [])


def test_the_sandbox_imports_nothing_of_ours(imports):
    for name, targets in imports.items():
        if unit(name) == "sandbox":
            assert all(unit(target) == "sandbox" for target in targets), name


@pytest.mark.slow
def test_nothing_of_the_package_imports_exercises_or_solutions():
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not any(n.split(".")[0] in ("exercises", "solutions") for n in names), path
