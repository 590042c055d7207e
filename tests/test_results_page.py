"""The pages are what their data give, and all that are compared play the same networks."""

from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
pytestmark = pytest.mark.usefixtures("studies")


def test_the_page_is_made_from_its_data():
    import results_page as page

    found = []
    for each in page.PAGES:
        text = each.read_text(encoding="utf-8")
        assert page.filled(text, page.load()) == text, "run tools/studies results --only"
        found += page.re.findall(r"<!-- (?!end)(\w+) -->", text)
    assert sorted(page.BLOCKS) == sorted(found)


def test_the_page_of_algorithms_is_made_from_its_data():
    import algorithms
    import algorithms_page as page

    names = ("tried", "runs", "longer")
    tried, done, longer = (algorithms.Results(page.DATA / f"{name}.jsonl") for name in names)
    text = page.PAGE.read_text(encoding="utf-8")
    assert page.filled(text, tried, done, longer) == text, "run tools/studies algorithms page"
    assert page.seeds(done) == len(algorithms.SEEDS)


def test_what_tuning_gives_is_told_from_its_data():
    import json

    import tuned

    text = tuned.PAGE.read_text(encoding="utf-8")
    assert tuned.filled(text) == text, "run tools/studies tuned page"
    for name, search in tuned.SEARCHES.items():
        measured = json.loads(search.data.read_text(encoding="utf-8"))
        assert [run["seed"] for run in measured["runs"]] == list(search.seeds)
        assert f"<!-- tuned {name} -->" in text


@pytest.mark.parametrize("name", ["docs/reports/bodies.md", "data/genotypes/README.md"])
def test_rows_of_other_locomotors_stay(tmp_path, name):
    import locomotor_curves

    text = (ROOT / name).read_text(encoding="utf-8")
    page = tmp_path / "page.md"
    page.write_text(text, encoding="utf-8")
    locomotor_curves.put(page, {})
    assert page.read_text(encoding="utf-8") == text
    locomotor_curves.put(page, {"hopper": ["| hopper | new |"]})
    found = page.read_text(encoding="utf-8")
    gone = set(text.splitlines()) - set(found.splitlines())
    assert gone and all(line.startswith("| hopper") for line in gone)
    assert found.count("| hopper | new |") == 1
    assert all(f"\n| {robot}" in found for robot in ("halfcheetah", "walker2d", "ant", "humanoid"))


def test_an_interval_of_differences():
    import tuned

    low, high = tuned.interval(np.full(20, 5.0))
    assert low == high == 5.0
    values = np.random.default_rng(3).normal(1.0, 2.0, 400)
    low, high = tuned.interval(values)
    assert abs((high - low) / 2 - 1.96 * values.std() / 20) < 0.02
    assert low < values.mean() < high


def test_the_page_of_clusters_is_made_from_its_data():
    pytest.importorskip("distributed")
    import cluster_page as page

    text = page.PAGE.read_text(encoding="utf-8")
    assert page.filled(text, page.load()) == text, "run tools/studies cluster page"
    assert sorted(page.BLOCKS) == sorted(page.re.findall(r"<!-- (?!end)(\w+) -->", text))


def test_a_block_without_data_stays():
    import results_page as page

    text = "<!-- ppo -->\nold\n<!-- end -->\n<!-- conditions -->\n<!-- end -->\n"
    made = page.filled(text, {})
    assert made.startswith("<!-- ppo -->\nold\n<!-- end -->\n<!-- conditions -->\n| part")
    assert page.filled(made, {}) == made


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


def test_missing_packages_are_named_and_left_out(monkeypatch):
    import comparison

    monkeypatch.setattr(comparison.importlib.util, "find_spec", lambda name: None)
    assert "gymnax, envpool" in comparison.notice()
    assert "botschool[bench]" in comparison.notice()
    assert list(comparison._present(comparison.CONTESTANTS)) == ["botschool", "Gymnasium's loop"]
