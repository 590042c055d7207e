"""The pages are what their data give, and all that are compared play the same networks."""

import importlib
import re
import runpy

import numpy as np
import pytest

from running import TESTS

PAGES = ("agents", "optimisers", "results_page", "spatial_page")


@pytest.mark.usefixtures("studies")
@pytest.mark.parametrize("name", PAGES)
def test_pages_are_made_from_their_data(name):
    for page in importlib.import_module(name).pages():
        text = page.path.read_text(encoding="utf-8")
        assert page.filled(text) == text, f"run tools/studies pages {name.removesuffix('_page')}"
        found = re.findall(r"<!-- (?!end|BEGIN|END)(\w+) -->", text)
        assert sorted(page.sections) == sorted(found)


@pytest.mark.usefixtures("studies")
def test_the_command_knows_every_page():
    folder = TESTS.parent / "tools" / "studies"
    command = runpy.run_path(str(folder / "__main__.py"))
    assert tuple(command["studies"]("pages")) == PAGES


@pytest.mark.usefixtures("studies")
def test_a_run_that_is_kept_is_not_done_again(tmp_path):
    from study import Results

    def run():
        done.append(1)
        return {"new": len(done)}

    done: list[int] = []
    for _ in range(2):
        results = Results(tmp_path / "runs.jsonl")
        for seed in (2, 1):
            results.do({"seed": seed, "params": {}}, run)
    assert len(done) == 2
    assert [run["new"] for run in results.of(params={})] == [2, 1]


@pytest.mark.usefixtures("studies")
@pytest.mark.parametrize("problem", ["Acrobot-v1", "Pendulum-v1"])
def test_the_batched_network_is_the_policy(problem):
    import contestants
    from speed import DATA

    weights = contestants.Weights.of(problem, DATA)
    b1, b2, w1, w2 = weights.layers()
    rng = np.random.default_rng(1)
    for i in (0, 7):
        observation = rng.standard_normal(w1.shape[2]).astype(np.float32)
        weights.policy.load(weights.genotypes[i], None)
        weights.policy.reset(1, 0)
        expected = weights.policy.act(observation)
        output = w2[i] @ np.tanh(w1[i] @ observation + b1[i]) + b2[i]
        assert (output.argmax() if isinstance(expected, int) else output) == pytest.approx(
            expected, 1e-5
        )
