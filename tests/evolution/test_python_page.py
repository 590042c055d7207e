"""docs/python.md: its code runs as it stands, as a notebook and piece by piece."""

import re

import numpy as np
import pytest

import botschool
from running import TESTS

PAGE = TESTS.parent / "docs" / "python.md"
BLOCKS = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
LIBRARIES = {block.split()[1]: block for block in BLOCKS if block.startswith("# ")}


def test_the_page_shows_four_libraries():
    assert set(LIBRARIES) == {"cma", "evosax", "nevergrad", "scipy"}
    lines = {name: len(block.strip().splitlines()) for name, block in LIBRARIES.items()}
    assert max(lines.values()) <= 15, lines


@pytest.mark.slow
@pytest.mark.parametrize("name", LIBRARIES)
def test_a_library_finds_better_robots_by_its_example(name):
    pytest.importorskip(name)
    problem = botschool.problem("Pendulum-v1", hidden=4, maxsteps=100)
    asked = []

    class Watched:
        parameters, initial = problem.parameters, problem.initial

        def evaluate(self, genotypes, seeds):
            asked.append(problem.evaluate(genotypes, seeds))
            return asked[-1]

    scope = {"problem": Watched()}
    exec(LIBRARIES[name].replace("generations = 60", "generations = 15"), scope)
    assert len(asked) == 15 and all(len(returns) == 40 for returns, _ in asked)
    assert np.shape(scope["best"]) == (problem.parameters,)
    top = [returns.max() for returns, _ in asked]
    assert max(top[5:]) > max(top[:2])


@pytest.mark.long
def test_the_page_runs_as_a_notebook(tmp_path, monkeypatch):
    jupytext, nbclient = pytest.importorskip("jupytext"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    notebook = jupytext.read(PAGE)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.source for cell in code] == [block.rstrip("\n") for block in BLOCKS]
    for cell in code:
        name = cell.source.split()[1] if cell.source.startswith("# ") else ""
        if name and not _installed(name):
            cell.source = ""
    nbclient.NotebookClient(notebook, timeout=900).execute(cwd=tmp_path)
    made = {path.name for path in tmp_path.iterdir()}
    assert made == {"pole.png", "pole.mp4", "first.mp4", "agent.mp4", "results"}
    shown = "".join(str(cell.outputs) for cell in code)
    assert "in 20 fresh episodes" in shown and "<progress" in shown  # the bar of notebooks


def _installed(name: str) -> bool:
    try:
        __import__(name)
    except ImportError:
        return False
    return True
