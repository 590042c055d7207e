"""plotstat reads trainings, alone and beside evolution."""

import numpy as np
import pytest
from matplotlib.image import imread

from botschool.analysis import plots
from botschool.analysis.runs import BEST_POST, STEPS
from botschool.analysis.trainings import POST_EVALUATED, TRAINING_EPISODES, read_curve
from botschool.errors import BotschoolError
from botschool.rl.folder import Evaluations, RunFolder
from botschool.rl.settings import Settings
from test_analysis import drawn, lines_of, save_run, stat_of  # noqa: F401  (drawn is a fixture)

MEANS = [0.0, 50.0, 20.0, 90.0]


def save_training(folder, number, means=MEANS, **given):
    """A training with these post-evaluations after 0, 1000, ... steps, of 2 episodes each."""
    run = RunFolder(folder / "ppo" / f"Acrobot-v1_{number}")
    run.path.mkdir(parents=True)
    used = Settings("ppo", "Acrobot-v1", "mlp", number, 3000, 1, False, 3, 2, given, given)
    used.save(run.config)
    means = np.array(means)
    run.save_evaluations(
        Evaluations(
            1000 * np.arange(len(means)),
            np.stack([means - 1, means + 1], axis=1),
            np.full((len(means), 2), 50),
        )
    )
    rows = ["rollout/ep_rew_mean,time/total_timesteps", "10,500", "30,1500", ",2000", "70,3000"]
    (run.path / "progress.csv").write_text("\n".join(rows) + "\n")
    return run


def test_a_training_becomes_a_curve(tmp_path):
    run = save_training(tmp_path, 1)
    curve = read_curve(run)
    assert curve[:, STEPS].tolist() == [0, 1000, 2000, 3000]
    assert curve[:, POST_EVALUATED].tolist() == MEANS
    assert curve[:, BEST_POST].tolist() == [0, 50, 50, 90]
    np.testing.assert_allclose(curve[1:, TRAINING_EPISODES], [20, 43.333333, 70])
    assert np.isnan(curve[0, TRAINING_EPISODES])
    counted = read_curve(run, count_evaluations=True)
    assert counted[:, STEPS].tolist() == [100, 1200, 2300, 3400]


def test_one_training_is_drawn(tmp_path, drawn):  # noqa: F811
    run = save_training(tmp_path, 3)
    plots.plot_stat([run.path], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    np.testing.assert_array_equal(lines["post-evaluated"][:, 1], MEANS)
    assert set(lines) == {
        "post-evaluated",
        "best post-evaluated so far",
        "episodes of the training",
    }
    axes = drawn[0].axes[0]
    assert axes.get_title() == "ppo Acrobot-v1, run 3"
    assert axes.get_xlabel() == "steps of training"
    assert imread(tmp_path / "a.png").shape[:2] == (500, 800)


def test_trainings_that_differ_in_the_seed_alone_are_averaged(tmp_path, drawn):  # noqa: F811
    for number, last in ((1, 80.0), (2, 100.0)):
        save_training(tmp_path, number, [*MEANS[:-1], last])
    save_training(tmp_path, 3, gamma=0.9)
    plots.plot_stat([tmp_path], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    mean = lines["ppo Acrobot-v1, mean ± sd of 2 runs"]
    np.testing.assert_allclose(mean[-1], [3000, 90.0])
    np.testing.assert_allclose(mean[:, 1].max(), 90.0)
    assert lines["ppo Acrobot-v1 gamma=0.9, 1 run"][-1, 1] == 90.0
    assert drawn[0].axes[0].get_title() == "post-evaluated"


def test_evolution_and_a_training_share_a_figure(tmp_path, drawn):  # noqa: F811
    """Both as evolution measures them: the best so far, every step counted."""
    save_run(tmp_path / "acrobot", 1, stat_of(5))
    save_training(tmp_path / "rl", 1)
    plots.plot_stat([tmp_path / "acrobot", tmp_path / "rl"], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    np.testing.assert_array_equal(lines["acrobot, 1 run"][:, 1], stat_of(5)[:, BEST_POST])
    np.testing.assert_array_equal(
        lines["ppo Acrobot-v1, 1 run"],
        [[100, 0], [1200, 50], [2300, 50], [3400, 90]],
    )
    axes = drawn[0].axes[0]
    assert axes.get_title() == "best post-evaluated so far"
    assert axes.get_xlabel() == "steps, those of post-evaluations included"
    assert axes.get_ylabel() == "mean return of an episode"


def test_a_damaged_training_is_skipped_unless_it_was_named(tmp_path, drawn):  # noqa: F811
    save_training(tmp_path, 1)
    bad = save_training(tmp_path, 2)
    (bad.path / "evaluations.npz").write_bytes(b"PK junk")
    notices = []
    plots.plot_stat([tmp_path], tmp_path / "a.png", notices.append)
    assert len(notices) == 1 and "evaluations.npz is damaged" in notices[0]
    with pytest.raises(BotschoolError, match="damaged"):
        plots.plot_stat([bad.path], tmp_path / "a.png")
    (bad.path.parent / "Acrobot-v1_1" / "evaluations.npz").unlink()
    with pytest.raises(BotschoolError, match="no training in"):
        plots.plot_stat([tmp_path], tmp_path / "a.png", notices.append)
