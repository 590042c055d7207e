"""The study of co-evolution: who takes part, that it can be stopped, and what its numbers mean."""

from dataclasses import replace

import numpy as np
import pytest

from botschool import config

pytestmark = pytest.mark.usefixtures("studies")


def tiny(monkeypatch):
    """A plan of two variants and one seed, as small as can be."""
    import coevolution_page
    import coevolution_plan

    variants = coevolution_plan.VARIANTS[1:3]
    for module in (coevolution_plan, coevolution_page):
        monkeypatch.setattr(module, "VARIANTS", variants)
    changes = {
        "coevo2-random": {"popsize": 2, "selsize": 1, "samplesize": 1},
        "archive": {"samplesize": 1, "ncompetitors": 1},
    }
    plan = coevolution_plan.Plan(
        "tiny", "tiny", (0.02, 0.1), (1,), dict.fromkeys(changes, 1), changes
    )  # fmt: skip
    monkeypatch.setattr(coevolution_page, "PLANS", (plan,))
    return plan


# who takes part


def test_runs_differ_from_their_files_in_what_the_plan_says():
    from coevolution_plan import EXPERIMENTS, PLANS, VARIANTS

    lengths = {"saveeach", "maxmsteps", "archivelen"}
    for plan in PLANS:
        for variant in VARIANTS:
            own = config.to_dict(plan.experiment(variant))
            file = config.to_dict(config.load(EXPERIMENTS / f"{variant.file}.ini"))
            differing = {
                key for part in own for key in own[part] if own[part][key] != file[part][key]
            }
            told = set(variant.changes) | set(plan.changes.get(variant.name, {})) | lengths
            assert differing <= told
            assert "saveeach" in differing


def test_experiment_files_say_the_same(tmp_path):
    from coevolution_plan import PLANS, runs

    for plan in PLANS:
        for run in runs(tmp_path, plan)[:5]:
            written = config.load(run.write_experiment())
            assert written == plan.experiment(run.variant)


def test_one_seed_of_all_comes_first_and_short_plans_end_first(tmp_path):
    from coevolution_plan import PLANS, VARIANTS, jobs

    found = list(jobs(tmp_path))
    assert [run.variant for run, _ in found[:5]] == list(VARIANTS)
    assert {run.seed for run, _ in found[:5]} == {1}
    steps = [millions for run, millions in found if run.plan is PLANS[0]]
    assert steps == sorted(steps)
    begun = [(plan.name, plan.milestones[0]) for plan in PLANS]
    rest = [(plan.name, millions) for plan in PLANS for millions in plan.milestones[1:]]
    order = [(run.plan.name, millions) for run, millions in found]
    assert order[:: 5 * len(VARIANTS)] == begun + rest
    assert len(found) == sum(len(plan.milestones) * len(plan.seeds) * 5 for plan in PLANS)


# the queue


@pytest.mark.slow
def test_from_runs_to_the_page(tmp_path, monkeypatch):
    """The first milestone, then the second, of one run only."""
    plan = tiny(monkeypatch)
    from coevolution_measure import measured
    from coevolution_page import behaviour, cross, progress, reached
    from coevolution_plan import complete, runs
    from coevolution_queue import Queue

    first, second = runs(tmp_path, plan)
    assert complete(tmp_path, plan) is None and first.reached() == 0
    assert Queue(tmp_path, (replace(plan, milestones=(0.02,)),)).work(2)
    assert complete(tmp_path, plan) == 0.02

    both = measured(tmp_path, (plan,))
    assert set(both["tiny"]["runs"]) == {first.name, second.name}
    for run in both["tiny"]["runs"].values():
        shape = (len(run["generations"]),) * 2
        assert np.shape(run["predators"]) == shape and shape[0] >= 2
        assert run["generations"][0] == 0 and run["millions"][-1] >= 0.02
    data = {"plans": both}
    assert "**0.02 million steps a run**, all (tiny)" in progress(data)
    assert "archive, prey" in progress(data) and "predators of archive" in cross(data)
    assert "| coevo2-random |" in behaviour(data)

    queue = Queue(tmp_path, (plan,))
    queue.waiting = [job for job in queue.waiting if job[0].name == first.name]
    assert queue.work(1)
    assert first.reached() >= 0.1 > second.reached() >= 0.02
    assert complete(tmp_path, plan) == 0.02  # so it is still compared there
    alone = replace(plan, milestones=(0.1,))
    late = {"plans": measured(tmp_path, (alone,))}
    assert set(late["plans"]["tiny"]["runs"]) == {first.name}
    assert "the 1 of 2 that have come so far" in progress(late)
    assert "archive, " not in progress(late) and "| archive |" in reached(late)


# numbers


@pytest.mark.slow
def test_intervals_over_seeds():
    from coevolution_page import in_words, interval

    mean, low, high = interval([1, 2, 3, 4, 5])  # deviation 1.5811, t 2.776
    assert (mean, low, high) == pytest.approx((3, 3 - 1.963, 3 + 1.963), abs=1e-3)
    assert in_words([0.5]) == "+0.50" and np.isnan(interval([0.5])[1])
    assert in_words([0, 0.5, 1], ".2f") == "0.50 (-0.74 to 1.74)"
    assert in_words([0, 0.5, 1], ".2f", 0, 1) == "0.50 (0.00 to 1.00)"  # shares, nothing else
    numbers = np.random.default_rng(1).standard_normal((20_000, 5))
    inside = [low < 0 < high for _, low, high in map(interval, numbers)]
    assert np.mean(inside) == pytest.approx(0.95, abs=0.006)
