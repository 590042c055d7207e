"""The trained agents in data/agents: trained, measured in new episodes, told on a page.

    python tools/studies agents train [ENV ...]     into results/agents; what is there stays
    python tools/studies agents keep [ENV ...]      their weights into data/agents, measured

Without a name: all of PLAN that were trained.
"""

from __future__ import annotations

import contextlib
import io
import json
import math
import shlex
import shutil
import sys
import time

import numpy as np
from study import ROOT, Page, table

TRAINED = ROOT / "results" / "agents"
AGENTS = ROOT / "data" / "agents"
DONE = "done.json"
"""In the folder of a training that has ended: the seconds that it took."""

EPISODES = 100
SOLVED = {
    "CartPole-v1": "475", "Acrobot-v1": "-100", "MountainCarContinuous-v0": "90",
    "InvertedPendulum-v5": "950", "InvertedDoublePendulum-v5": "9100", "Reacher-v5": "-3.75",
    "Pendulum-v1": "-200 (*)", "BalanceBotBulletEnv-v0": "450 (*)",
}  # fmt: skip
"""Gymnasium's reward_threshold; (*): it has none, and the page says where the number is from."""

SMALL = {"evaluations": 10, "episodes": 10}
QUICK = {"n_steps": 256, "batch_size": 256, "learning_rate": "linear 0.001"}
EIGHT = {"envs": 8} | SMALL
PLAN = (
    ("ppo", "CartPole-v1", {"steps": 50_000} | SMALL),
    ("ppo", "InvertedPendulum-v5", {
        "steps": 100_000, "params": QUICK, "envs": 8, "evaluations": 10, "episodes": 5}),
    ("ppo", "BalanceBotBulletEnv-v0", {
        "steps": 16_384, "envs": 1, "params": {"normalize": False, "n_steps": 512, "batch_size": 64,
        "learning_rate": 0.001, "gamma": 0.98, "gae_lambda": 0.9}} | SMALL),
    ("ppo", "MountainCarContinuous-v0", {"steps": 20_000} | SMALL),
    ("ppo", "Acrobot-v1", {"steps": 100_000} | SMALL),
    ("ppo", "Pendulum-v1", SMALL),
    ("ppo", "InvertedDoublePendulum-v5", {
        "steps": 300_000, "params": QUICK | {"gamma": 0.98, "gae_lambda": 0.9}} | EIGHT),
    ("ppo", "Reacher-v5", {
        "steps": 300_000, "params": QUICK | {"gamma": 0.95, "gae_lambda": 0.9}} | EIGHT),
    ("sac", "HumanoidBulletEnv-v5", {"evaluations": 12, "episodes": 5}),
    *(("ppo", f"botschool/{body}", {}) for body in (
        "PlanarHopper-v5", "PlanarHalfCheetah-v5", "PlanarWalker2D-v5",
        "SpatialAnt-v5", "SpatialHumanoid-v0")),
)  # fmt: skip
"""Algorithm, environment, and what the training has in place of the defaults."""


def train(only: list[str]) -> None:
    """Trains what was not trained yet."""
    from botschool.rl.training import train

    for algo, env, options in chosen(only):
        if newest(algo, env) is not None:
            continue
        before = time.process_time()
        run = train(algo, env, TRAINED, **options)
        seconds = round(time.process_time() - before)
        (run.path / DONE).write_text(json.dumps({"seconds": seconds}))
        curve = " ".join(f"{each:.1f}" for each in run.evaluations().returns.mean(axis=1))
        print(f"{run.path}: {seconds} s, {curve}", flush=True)


def chosen(only: list[str]) -> list[tuple[str, str, dict]]:
    """The rows of the plan on these environments; on all of them if none is named."""
    return [row for row in PLAN if not only or row[1] in only]


def newest(algo: str, env: str):
    """Its last training that has ended, None if there is none."""
    from botschool.rl.folder import runs_of

    ended = {n: run for n, run in runs_of(TRAINED, algo, env).items() if (run.path / DONE).exists()}
    return ended[max(ended)] if ended else None


def keep(only: list[str]) -> None:
    """Writes the weights and settings of the trainings, and measures them in new episodes."""
    from botschool.rl import shipped
    from botschool.rl.agent import save_weights
    from botschool.rl.watch import Player

    order = {(algo, env): i for i, (algo, env, _) in enumerate(PLAN)}
    rows = {(each.algo, each.env): row_of(each) for each in shipped.agents()}
    for algo, env, _ in chosen(only):
        run = newest(algo, env)
        if run is None:
            continue
        path = shipped.place(AGENTS, algo, env)
        path.parent.mkdir(parents=True, exist_ok=True)
        if run.best.suffix == path.suffix:  # the native learner saves weights alone
            shutil.copy(run.best, path)
        else:
            save_weights(run.best, path)
        shutil.copy(run.config, path.parent)
        player = Player(path)
        with contextlib.redirect_stdout(io.StringIO()):
            player.play(EPISODES)
        rows[algo, env] = {
            "algo": algo,
            "env": env,
            "steps": run.settings().steps,
            "mean": round(float(np.mean(player.returns)), 2),
            "deviation": round(float(np.std(player.returns)), 2),
            "episodes": EPISODES,
            "command": command(run.settings()),
            "seconds": json.loads((run.path / DONE).read_text())["seconds"],
        }
        print(rows[algo, env], flush=True)
    kept = sorted(rows.values(), key=lambda row: order.get((row["algo"], row["env"]), len(order)))
    (AGENTS / shipped.TABLE).write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def row_of(trained) -> dict:
    """What the table holds of an agent."""
    return {name: value for name, value in vars(trained).items() if name != "path"}


def command(used) -> str:
    """The command that trains with these settings."""
    from botschool.rl.settings import defaults

    words = ["botschool", "rl", "train", "--algo", used.algo, "--env", used.env]
    usual = defaults(used.algo, used.env)
    options = (
        ("-n", used.steps, usual["steps"]),
        ("--envs", used.envs, usual["envs"]),
        ("-s", used.seed, 1),
        ("--evaluations", used.evaluations, 20),
        ("--episodes", used.episodes, 20),
    )
    for flag, value, default in options:
        words += [flag, str(value)] if value != default else []
    if used.given:
        given = [f"{name}={spelled(value)}" for name, value in used.given.items()]
        words += ["--params", *given]
    return shlex.join(words)


def spelled(value) -> str:
    """A hyperparameter's value as the command reads it."""
    return json.dumps(value).strip('"').replace(" ", "") if not isinstance(value, str) else value


def pages() -> list[Page]:
    """Return the page, made from what was measured."""
    from botschool.rl import shipped

    rows = [
        [
            each.env, each.algo, f"{each.steps:,}", f"{each.seconds} s",
            f"{each.mean:.1f} +- {each.deviation:.1f}", SOLVED.get(each.env, "-"),
            str(math.ceil(each.path.stat().st_size / 1000)), f"`{each.command}`",
        ]
        for each in shipped.agents()
    ]  # fmt: skip
    columns = ["problem", "algorithm", "steps", "time", "return", "solved from", "kB", "command"]
    return [Page(AGENTS / "README.md", {"agents": table(columns, rows)})]


def main() -> None:
    what, *only = sys.argv[1:]
    {"train": train, "keep": keep}[what](only)
    if what == "keep":
        for page in pages():
            page.write()
