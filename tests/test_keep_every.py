"""--keep-every: the best of earlier generations stay (docs/specification.md, "Run files")."""

import numpy as np
import pytest

from botschool.evolution.run import Run, evolve
from running import contents, same, write_experiment

KEPT = 3


@pytest.fixture
def ini(tmp_path):
    """A native problem, some fifteen generations; post-evaluations may wait for the next one."""
    policy = {"episodes": 1, "maxsteps": 20}
    return write_experiment(tmp_path, "Pendulum-v1", policy=policy, maxmsteps=0.003)


def run_of(command, ini, folder, *flags):
    flags = ("-o", folder, "--keep-every", KEPT, *flags)
    code, _, errors = command("es", "-f", ini, "-s", 5, *flags)
    assert (code, errors) == (0, "")
    return folder


def test_the_best_so_far_of_every_third_generation_is_kept(ini, tmp_path, command):
    from botschool import config

    run_of(command, ini, tmp_path / "kept")
    run = Run(config.load(ini), 5)
    best = {0: run.policy.initial(5)}
    while run.record.steps < run.max_steps:
        run.advance()
        best[run.record.generation] = run.record.bestg
    last = run.record.generation
    assert last > 3 * KEPT
    names = {f"bestgS5G{g}.npy" for g in range(0, last + 1, KEPT)}
    assert {path.name for path in (tmp_path / "kept").glob("bestgS5G*.npy")} == names
    for name in names:
        generation = int(name.removesuffix(".npy").partition("G")[2])
        np.testing.assert_array_equal(np.load(tmp_path / "kept" / name), best[generation])
    assert not np.array_equal(best[KEPT], best[last])


def test_nothing_else_changes(ini, tmp_path, command):
    kept = contents(run_of(command, ini, tmp_path / "kept"))
    assert command("es", "-f", ini, "-s", 5, "-o", tmp_path / "plain")[0] == 0
    plain = contents(tmp_path / "plain")
    assert {name: kept[name] for name in kept if "G" not in name.partition(":")[0]} == plain


def test_interrupted_and_resumed_keeps_the_same(ini, tmp_path, command):
    whole = run_of(command, ini, tmp_path / "whole")
    for generations in (1, 2, 7):
        run_of(command, ini, tmp_path / "parts", "--generations", generations, "--resume")
    run_of(command, ini, tmp_path / "parts", "--resume")
    assert same(whole, tmp_path / "parts")


def test_runs_side_by_side_keep_the_same(ini, tmp_path, command):
    whole = run_of(command, ini, tmp_path / "whole", "-n", 2)
    assert same(whole, run_of(command, ini, tmp_path / "beside", "-n", 2, "-w", 2))


def test_a_normalised_robot_is_kept_with_its_vectors(tmp_path, command):
    ini = write_experiment(tmp_path, policy={"normalize": 1}, maxmsteps=0.002)
    folder = run_of(command, ini, tmp_path / "kept")
    first, last = np.load(folder / "bestgS5G0.npy"), np.load(folder / "bestgS5.npy")
    assert first.shape == last.shape
    np.testing.assert_array_equal(first[-8:], [0] * 4 + [1] * 4)
    code, out, _ = command("es", "-f", ini, "-s", 5, "-p", "-g", folder / "bestgS5G3.npy")
    assert code == 0 and "episode 3" in out


def test_force_removes_them(ini, tmp_path, command):
    folder = run_of(command, ini, tmp_path / "kept")
    (folder / "bestgS51G3.npy").write_text("of another run")
    assert command("es", "-f", ini, "-s", 5, "-o", folder, "--force")[0] == 0
    assert [path.name for path in folder.glob("bestgS*G*.npy")] == ["bestgS51G3.npy"]


def test_a_full_disk_leaves_a_run_that_goes_on(ini, tmp_path, command, monkeypatch):
    from botschool import config
    from botschool.errors import BotschoolError
    from botschool.evolution import run as module

    whole = run_of(command, ini, tmp_path / "whole")

    def full(path, array):
        if path.name == "bestgS5G6.npy":
            raise BotschoolError("no space")
        return save(path, array)

    save = module.save_npy
    (tmp_path / "parts").mkdir()
    with monkeypatch.context() as patch:
        patch.setattr(module, "save_npy", full)
        with pytest.raises(BotschoolError, match="no space"):
            evolve(Run(config.load(ini), 5), tmp_path / "parts", keep_every=KEPT)
    run_of(command, ini, tmp_path / "parts", "--resume")
    assert same(whole, tmp_path / "parts")


def test_it_is_not_for_two_populations(tmp_path, refused):
    policy = {"nrobots": 2, "heterogeneous": 1}
    (tmp_path / "own.ini").write_text(
        "[EXP]\nenvironment = ErPredprey\nalgo = coevo2\n[POLICY]\n"
        + "".join(f"{key} = {value}\n" for key, value in policy.items())
        + "[ALGO]\npopsize = 4\nselsize = 2\n"
    )
    says = ["--keep-every", "saveeach"]
    refused("es", "-f", tmp_path / "own.ini", "-o", tmp_path, "--keep-every", 2, says=says)
