"""The study of co-evolution: who takes part, that it can be stopped, and what its numbers mean."""

import os
import signal
import sys
import threading
from dataclasses import replace

import numpy as np
import pytest

from botschool import config

pytestmark = pytest.mark.usefixtures("studies")
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")


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


@pytest.mark.slow
@posix
def test_the_queue_is_stopped_and_goes_on(tmp_path, monkeypatch):
    """A request to stop reaches its runs, which end as they like."""
    plan = tiny(monkeypatch)
    import coevolution_queue

    program = "import signal, sys; signal.signal(15, lambda *_: sys.exit(130)); signal.pause()"

    def patient(run, millions):
        run.write_experiment()
        return [sys.executable, "-c", program]

    with monkeypatch.context() as patch:
        patch.setattr(coevolution_queue, "command", patient)
        queue = coevolution_queue.Queue(tmp_path, (plan,))
        threading.Timer(1.5, os.kill, (os.getpid(), signal.SIGTERM)).start()
        assert not queue.work(2)
    assert not queue.running and not queue.failed
    assert len(queue.waiting) == 2  # two of four had been begun
    assert len(coevolution_queue.Queue(tmp_path, (plan,)).waiting) == 4
    assert signal.getsignal(signal.SIGTERM) is not queue.stop


@pytest.mark.slow
def test_a_run_that_fails_stops_no_other(tmp_path, monkeypatch, capsys):
    plan = tiny(monkeypatch)
    import coevolution_queue

    right = coevolution_queue.command

    def command(run, millions):
        line = right(run, millions)
        return [*line, "--no-such-option"] if run.variant.name == "archive" else line

    monkeypatch.setattr(coevolution_queue, "command", command)
    queue = coevolution_queue.Queue(tmp_path, (replace(plan, milestones=(0.01, 0.02)),))
    assert not queue.work(1)
    assert queue.failed == ["tiny archive 1"]
    assert "tiny archive 1: failed, see" in capsys.readouterr().out
    assert [run.name for run, _ in coevolution_queue.Queue(tmp_path, (plan,)).waiting] == [
        "tiny archive 1",
        "tiny coevo2-random 1",
        "tiny archive 1",
    ]


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


def test_runs_with_different_numbers_of_times_are_not_ranked():
    from coevolution_page import verdict

    def run(times: int, gain: float) -> dict:
        rows, columns = np.indices((times, times)) / (times - 1)
        return {
            "generations": list(range(times)),
            "predators": 0.5 + gain * (rows - columns),
        }

    def ranked(*times: int) -> str:
        runs = {f"small archive {seed}": run(times[0], 0.1 + 0.01 * seed) for seed in (1, 2)}
        runs |= {f"small archivestar {seed}": run(times[1], 0.3) for seed in (1, 2)}
        return verdict({"plans": {"small": plan | {"runs": runs}}})

    plan = {"millions": 50, "about": "", "reached": dict.fromkeys("abcd")}
    assert "from the most to the least: archivestar +0.14" in ranked(6, 6)
    assert "have 3 times, others up to 6" in ranked(6, 3) and "least" not in ranked(6, 3)


def test_means_are_of_all_seeds():
    """Times differ: the mean is taken where all have been measured, or between two such times."""
    from coevolution_figures import mean_curves
    from matplotlib.figure import Figure

    axes = Figure().subplots()
    mean_curves(axes, [[0, 5, 10], [0, 8]], [[0, 0.5, 1], [1, 1]], "black", "mean")
    at, mean = axes.lines[-1].get_data()
    assert list(at) == [0, 4, 8] and list(mean) == pytest.approx([0.5, 0.7, 0.9])


def test_a_cross_test_is_between_strangers():
    """Runs a1, a2 of a variant, b1 of another; each beats its own competitors only."""
    from coevolution_page import by_variant, strangers, strength

    fitness = strangers(np.array([[1.0, 0.2, 0.4], [0.1, 1.0, 0.6], [0.3, 0.5, 1.0]]))
    own, names = ["a", "a", "b"], ["a", "b"]
    assert by_variant(fitness, own, names)[0] == pytest.approx([0.15, 0.5])
    assert by_variant(fitness, own, names)[1, 0] == pytest.approx(0.4)
    found = strength(fitness, own, names)
    assert found["a"] == pytest.approx([0.3, 0.35])  # means of (0.2, 0.4) and of (0.1, 0.6)
    assert found["b"] == pytest.approx([0.4])


def test_times_are_as_far_apart_in_steps(tmp_path, monkeypatch):
    """Generations get longer: those are chosen that are nearest to 0, 1, ... 10 million steps."""
    plan = tiny(monkeypatch)
    import coevolution_measure
    from coevolution_plan import runs

    run = runs(tmp_path, plan)[0]
    run.home.mkdir(parents=True)
    steps = np.array([0.4, 1.1, 2.2, 4.1, 5.8, 10.2, 14.0]) * 1e6
    np.save(run.files.stat, np.column_stack([steps, *[steps] * 5]).ravel())
    for generation in (0, 1, 2, 3, 4, 5, 6, 7):
        np.save(run.files.populations(generation), np.zeros(1))
    assert run.reached() == 14
    assert coevolution_measure.times(run, 10) == [0, 2, 3, 4, 5, 6]
    run.files.populations(2).unlink()
    assert coevolution_measure.times(run, 10) == [0, 1, 3, 4, 5, 6]


def test_one_plan_alone(tmp_path, monkeypatch, capsys):
    import coevolution
    from coevolution_plan import PLANS

    asked = []

    class Queue:
        def __init__(self, folder, plans):
            asked.extend(plans)

        def work(self, processes):
            return True

    monkeypatch.setattr(coevolution, "Queue", Queue)
    monkeypatch.setattr(coevolution.os, "nice", lambda _: 0, raising=False)
    for what in ("run", "state"):
        words = ["coevolution", what, "--plan", PLANS[1].name, "--folder", str(tmp_path)]
        monkeypatch.setattr("sys.argv", words)
        assert coevolution.main() == 0
    assert asked == [PLANS[1]]
    assert capsys.readouterr().out == f"{PLANS[1].name}: all have reached no milestone\n"


def test_what_was_measured_of_other_plans_stays(tmp_path, monkeypatch):
    import json

    import coevolution
    import coevolution_page
    from coevolution_plan import PLANS, StudyRun

    data, first = tmp_path / "study.json", PLANS[0].name
    data.write_text(json.dumps({"plans": {plan.name: {"old": 1} for plan in PLANS}}))
    for module in (coevolution, coevolution_page):
        monkeypatch.setattr(module, "KEPT", data)
    monkeypatch.setattr(coevolution, "pages", list)
    monkeypatch.setattr(
        coevolution, "measured", lambda _, plans: {p.name: {"new": 1} for p in plans}
    )
    monkeypatch.setattr(StudyRun, "reached", lambda run: float(run.plan.name == first))
    coevolution.page(tmp_path, PLANS)
    found = coevolution_page.load()["plans"]
    assert found[first].keys() == {"measured", "new"}
    assert all(found[plan.name] == {"old": 1} for plan in PLANS[1:])
