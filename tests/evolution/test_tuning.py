"""botschool tune, and the time that a run takes."""

import shutil

import pytest

from botschool import config

optuna = pytest.importorskip("optuna")

from botschool.analysis.tuning import Plan, space_of, tune  # noqa: E402
from botschool.rl.study import Log  # noqa: E402

INI = """[EXP]
environment = CartPole-v1
algo = SSS

[POLICY]
maxsteps = 50
episodes = 1

[ALGO]
maxmsteps = 0.01
"""
MARKS = """
[TUNE]
mutrate = 0.01 .. 0.3 log
popsize = 4 .. 6
nhiddens = 2, 5
"""


@pytest.fixture
def plan(tmp_path):
    (tmp_path / "pole.ini").write_text(INI + MARKS)
    experiment = config.load(tmp_path / "pole.ini")
    return Plan(experiment, tmp_path / "tuned", 9, 600, 1, 2, 1)


def test_a_file_marks_what_to_tune(plan):
    assert space_of(plan.experiment) == {
        "mutrate": Log(0.01, 0.3),
        "popsize": [4.0, 6.0],
        "nhiddens": ("2", "5"),
    }


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("mutrat = 0.1 .. 0.2", "did you mean mutrate"),
        ("mutrate = 0.1", "0.001 .. 0.1 log"),
        ("mutrate = 0.2 .. 0.1", "no choice of values"),
        ("mutrate = 0 .. 1 log", "no choice of values"),
        ("mutrate = 0.1 .. 1e12", "out of range"),
        ("popsize = 4, x", "not a number"),
        ("environment = CartPole-v1, Acrobot-v1", "no hyperparameter"),
    ],
)
def test_a_wrong_mark_is_refused(line, words, tmp_path, refused):
    (tmp_path / "pole.ini").write_text(f"{INI}[TUNE]\n{line}\n")
    refused("tune", tmp_path / "pole.ini", "-o", tmp_path / "t", says=words)
    assert not (tmp_path / "t").exists()


def test_two_sides_are_refused(tmp_path, refused):
    (tmp_path / "p.ini").write_text("[EXP]\nenvironment = ErPredprey\nalgo = coevo2\n")
    refused("tune", tmp_path / "p.ini", "-o", tmp_path / "t", says="two sides compete")


def trials(plan):
    study = optuna.load_study(
        study_name="tune",
        storage=optuna.storages.JournalStorage(
            optuna.storages.journal.JournalFileBackend(str(plan.path / "study.log"))
        ),
    )
    ended = (optuna.trial.TrialState.COMPLETE, optuna.trial.TrialState.PRUNED)
    return [(t.params, t.value, t.state) for t in study.get_trials(states=ended)]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::optuna.exceptions.ExperimentalWarning")
def test_a_stopped_tuning_continues_and_its_best_file_runs(plan, tmp_path, command):
    said = []
    assert tune(plan, said.append)
    assert "tuning mutrate, popsize, nhiddens" in said[0] and "for each trial" in said[0]
    whole = trials(plan)
    assert len(whole) == 9 and all(4 <= each["popsize"] <= 6 for each, *_ in whole[1:])
    assert (plan.path / "tuning.png").stat().st_size > 5000
    best = config.load(plan.path / "best.ini")
    assert best.exp == plan.experiment.exp and not best.tune
    shutil.rmtree(plan.path)
    asked = 0

    def stopping():
        nonlocal asked
        asked += 1
        return asked > 40

    assert not tune(plan, stopping=stopping)
    assert len(trials(plan)) < 9
    # what a killed process leaves
    (plan.path / "study.log.lock").symlink_to(plan.path / "study.log")
    assert tune(plan)
    assert trials(plan) == whole
    refused = command("tune", plan.experiment.path, "-o", tmp_path / "tuned", "--steps", 700)
    assert refused[0] == 2 and "is a tuning with" in refused[2]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::optuna.exceptions.ExperimentalWarning")
def test_the_command(tmp_path, command, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pole.ini").write_text(INI + MARKS)
    code, said, _ = command("tune", "pole.ini", "--trials", 2, "--steps", 300, "-o", "t")
    assert code == 0 and "best experiment: t/pole/best.ini" in said
    assert command("es", "-f", "t/pole/best.ini", "--steps", 100, "-o", "r")[0] == 0
    assert command("es", "-f", "pole.ini", "--steps", 100, "-o", "s")[0] == 0
