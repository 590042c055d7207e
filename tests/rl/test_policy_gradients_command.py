"""`botschool rl train` with the native engine, as a user runs it."""

import os
import random
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.rl.agent import Agent, play
from botschool.rl.folder import RunFolder
from botschool.rl.native import PPO, training
from botschool.rl.training import train

COMMAND = [sys.executable, "-m", "botschool"]
SMALL = {"n_steps": 40, "batch_size": 80, "n_epochs": 4}


def botschool(arguments):
    return subprocess.run([*COMMAND, *arguments], capture_output=True, text=True)


def files_of(folder):
    """What must not depend on interruptions."""
    run = RunFolder(folder)
    log = {n: c for n, c in run.log().items() if n not in ("time/fps", "time/time_elapsed")}
    arrays = {}
    for name in ("best_model", "last_model", "evaluations"):
        with np.load(run.path / f"{name}.npz") as loaded:
            arrays |= {f"{name}.{key}": loaded[key] for key in loaded.files}
    return log | arrays


def assert_same(mine, theirs):
    assert mine.keys() == theirs.keys()
    for name, array in theirs.items():
        np.testing.assert_array_equal(mine[name], array, err_msg=name)


@pytest.mark.slow
def test_a_training_needs_no_torch(tmp_path):
    code = """if True:
        import sys
        for name in ("torch", "stable_baselines3", "tensorboard"): sys.modules[name] = None
        from botschool.cli import main
        sys.argv = ["botschool", "rl", "train", "--algo", "ppo", "--env", "CartPole-v1",
                    "--steps", "3000", "-o", "runs"]
        try: main()
        except SystemExit as end: assert not end.code, end.code
        sys.argv = ["botschool", "rl", "enjoy", "runs/ppo/CartPole-v1_1", "--render", "none"]
        main()
    """
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "finished after 3072 steps" in done.stdout
    assert "episodes 10" in done.stdout
    assert RunFolder(tmp_path / "runs/ppo/CartPole-v1_1").settings().engine == "native"


def test_curves_are_tensorboards(tmp_path):
    loader = pytest.importorskip("tensorboard.backend.event_processing.event_accumulator")
    run = train("ppo", "Pendulum-v1", tmp_path, params=SMALL, envs=4, steps=3200, evaluations=4)
    log = run.log()
    events = loader.EventAccumulator(str(run.path))
    events.Reload()
    tags = events.Tags()["scalars"]
    assert {"rollout/ep_rew_mean", "train/approx_kl", "train/std", "eval/mean_reward"} <= set(tags)
    for tag in tags:
        scalars = events.Scalars(tag)
        filled = ~np.isnan(log[tag])
        assert [each.step for each in scalars] == log["steps"][filled].tolist()
        np.testing.assert_allclose([e.value for e in scalars], log[tag][filled], rtol=1e-6)
    evaluations = run.evaluations()
    assert evaluations.steps.tolist() == [0, 800, 1600, 2400, 3200]
    assert evaluations.returns.shape == (5, 20)


@pytest.mark.slow
def test_engines_have_the_same_indicators(tmp_path):
    pytest.importorskip("stable_baselines3")
    columns = {}
    for engine in ("native", "sb3"):
        run = train(
            "ppo", "Pendulum-v1", tmp_path, params=SMALL, envs=2, steps=500, engine=engine,
            evaluations=1, episodes=1,
        )  # fmt: skip
        assert run.settings().engine == engine
        columns[engine] = set(run.log())
    assert columns["native"] - columns["sb3"] == set()
    assert columns["sb3"] - columns["native"] <= {"rollout/discounted_return"}


@pytest.mark.parametrize("env", ["CartPole-v1", "botschool/PlanarWalker2D-v5"])
def test_the_agent_is_the_one_that_was_measured(env, tmp_path):
    """Loaded, it acts in Gymnasium as in C++; in Stable-Baselines3, with the same actions."""
    params = SMALL | {"normalize": True}
    run = train("ppo", env, tmp_path, params=params, envs=4, steps=4000, seed=5, evaluations=2)
    agent = Agent.load(run.last)
    with np.load(run.path / "checkpoint.npz") as arrays:
        ppo = PPO(env, 5, 4, True, 4000, **run.settings().parameters)
        ppo.restore({n[4:]: arrays[n] for n in arrays.files if n.startswith("ppo_")})
    rng = np.random.default_rng(1)
    environment = run.make_env()
    observations = np.stack([environment.reset(seed=i)[0] for i in range(50)])
    observations = (observations + 0.3 * rng.standard_normal(observations.shape)).astype(np.float32)
    actions, _ = agent.act(observations)
    np.testing.assert_array_equal(actions, ppo.act(observations))
    torch = pytest.importorskip("torch")
    from botschool.rl.native.sb3 import to_sb3

    model = to_sb3(ppo)
    theirs, _ = model.predict(ppo.normalised(observations), deterministic=True)
    np.testing.assert_allclose(actions, theirs, rtol=0, atol=1e-6)
    values = model.policy.predict_values(torch.tensor(ppo.normalised(observations)))
    np.testing.assert_allclose(
        ppo.forward(observations)[1], values.detach().numpy()[:, 0], atol=1e-5
    )
    if env != "CartPole-v1":  # its episodes begin as those of the native problem
        seeds = range(20)  # one counts in double precision, the other in single: alike in the mean
        returns, _ = play(agent, [run.make_env() for _ in seeds], seeds)
        mine, _ = ppo.play(seeds)
        assert returns.mean() == pytest.approx(mine.mean(), rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["threads", "killed"])
def test_interrupted_is_uninterrupted(engine, tmp_path):
    """Killed at random moments and resumed, with other threads: the same files."""
    options = ["--algo", "ppo", "--env", "Pendulum-v1", "--steps", "24000", "--envs", "20"]
    options += ["--params", "n_steps=40", "batch_size=160", "normalize=true"]
    whole = botschool(["rl", "train", *options, "-o", tmp_path / "whole"])
    assert whole.returncode == 0, whole.stderr
    expected = files_of(tmp_path / "whole/ppo/Pendulum-v1_1")
    if engine == "threads":
        assert (
            botschool(["rl", "train", *options, "-w", "3", "-o", tmp_path / "many"]).returncode == 0
        )
        assert_same(files_of(tmp_path / "many/ppo/Pendulum-v1_1"), expected)
        return
    folder = tmp_path / "cut/ppo/Pendulum-v1_1"
    chance, kills = random.Random(4), 0
    command = [*COMMAND, "rl", "train", *options, "-o", tmp_path / "cut"]
    for _ in range(200):
        if folder.exists():
            command = [*COMMAND, "rl", "train", "--resume", folder]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        for line in process.stdout:  # killed a moment after it has begun to work
            if line.startswith("seed") or "finished" in line:
                break
        while not (folder / "checkpoint.npz").exists() and process.poll() is None:
            time.sleep(0.01)  # without one there is nothing to go on from
        time.sleep(chance.uniform(0.0, 0.25))
        if process.poll() is None and kills < 6:
            os.kill(process.pid, signal.SIGKILL)
            kills += 1
            process.wait()
            continue
        rest = process.communicate()[0]
        if process.returncode == 0:
            assert "finished" in line + rest
            break
    assert kills >= 2
    assert_same(files_of(folder), expected)


@pytest.mark.slow
def test_replications_are_the_trainings_by_themselves(tmp_path):
    options = ["--algo", "ppo", "--env", "CartPole-v1", "--steps", "2000"]
    done = botschool(["rl", "train", *options, "-r", "3", "-w", "2", "-s", "5", "-o", tmp_path])
    assert done.returncode == 0, done.stderr
    found = {}
    for number in (1, 2, 3):
        run = RunFolder(tmp_path / f"ppo/CartPole-v1_{number}")
        found[run.settings().seed] = files_of(run.path)
    assert found.keys() == {5, 6, 7}
    alone = train("ppo", "CartPole-v1", tmp_path / "alone", steps=2000, seed=6)
    assert_same(found[6], files_of(alone.path))


@pytest.mark.parametrize(
    "damage",
    [
        {"log_sizes": -np.ones(2, dtype=int)},
        {"log_returns": np.zeros((2, 2))},
        {"log_seconds": np.zeros(0)},
        {"returns": np.zeros((0, 2))},
        {"returns": np.array(["one"])},
        {"steps": np.zeros(7, dtype=int)},
        {"ppo_counts": np.zeros(3, dtype=np.uint64)},
    ],
    ids=lambda damage: "".join(damage),
)
def test_damaged_checkpoints_that_fuzzers_found(tmp_path, damage):
    run = train("ppo", "CartPole-v1", tmp_path, steps=600, evaluations=1, episodes=2)
    with np.load(run.path / "checkpoint.npz") as file:
        arrays = dict(file)
    np.savez(run.path / "checkpoint.npz", **(arrays | damage))
    before = (run.path / "progress.csv").read_bytes()
    with pytest.raises(BotschoolError, match=r"damaged|not a checkpoint of this training"):
        training.resume(run, lambda steps, found: None)
    assert (run.path / "progress.csv").read_bytes() == before


@pytest.mark.slow
def test_what_cannot_go_on_is_a_sentence(tmp_path):
    run = train("ppo", "CartPole-v1", tmp_path, steps=600, evaluations=1, episodes=2)
    (run.path / "checkpoint.npz").write_bytes(b"PK rubbish")
    for folder, words in ((run.path, "damaged"), (tmp_path, "config.yaml")):
        done = botschool(["rl", "train", "--resume", folder])
        assert done.returncode == 2
        assert words in done.stderr
        assert "Traceback" not in done.stderr
    (run.path / "best_model.npz").write_bytes(b"PK rubbish")
    with pytest.raises(BotschoolError, match="damaged"):
        Agent.load(run.best)
