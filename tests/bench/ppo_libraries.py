"""PPO until it reaches a goal: botschool beside Stable-Baselines3, SBX, and a PPO in JAX.

    pip install -c constraints.txt -e '.[bench,rl]'
    python tests/bench/ppo_libraries.py [PROBLEM ...] [--seeds 5]

Each training is a process on one core. The clock is the process's processor time. It stops while
20 new episodes are played, the same for all on Gymnasium's environments, every 2 % of the steps.
Their mean return ends the training when it reaches the goal. The libraries take turns.

Settings: defaults.yaml, section `native` for botschool and section `ppo` for the others. What JAX
compiles is counted apart. SBX compiles inside its first two updates: what they take more than the
median of the later ones counts as compiling.

The PPO in JAX is ours (jax_ppo.py), in the manner of PureJaxRL (Lu and others 2022): environments
of gymnax and the learning are one compiled function.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

GOALS = {"CartPole-v1": 500.0, "Pendulum-v1": -200.0, "Acrobot-v1": -85.0}
LIBRARIES = {
    "native": "botschool",
    "sb3": "Stable-Baselines3",
    "sbx": "SBX",
    "jax": "JAX and gymnax",
}
LOOKS = 50
ONE_CORE = {
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
    "OMP_NUM_THREADS": "1",
    "JAX_PLATFORMS": "cpu",
    "CUDA_VISIBLE_DEVICES": "",
}

Act = Callable[[np.ndarray], np.ndarray]
"""Most probable actions (n, ...) for observations (n, inputs)."""


def play(act: Act, env: str, seeds: range) -> float:
    """Mean return of one episode for each seed, played side by side."""
    import gymnasium

    envs = [gymnasium.make(env) for _ in seeds]
    seen = np.array([e.reset(seed=s)[0] for e, s in zip(envs, seeds, strict=True)])
    total, going = np.zeros(len(envs)), np.ones(len(envs), dtype=bool)
    while going.any():
        actions = np.asarray(act(seen))
        for i in np.flatnonzero(going):
            seen[i], reward, terminated, truncated, _ = envs[i].step(actions[i])
            total[i] += float(reward)
            going[i] = not (terminated or truncated)
    return float(total.mean())


@dataclass
class Clock:
    """Processor seconds of learning, and what was reached."""

    env: str
    seed: int
    every: int
    """Steps between two looks."""
    seconds: float = 0.0
    compiling: float = 0.0
    last: float = -np.inf
    updates: list[float] = field(default_factory=list)
    """Seconds of each."""
    _started: float = field(default_factory=time.process_time)
    _looked: int = 0

    def reached(self, steps: int, act: Act) -> bool:
        """Call between updates: stops the clock and looks if it is time."""
        self.updates.append(time.process_time() - self._started)
        if steps // self.every > self._looked:
            self._looked = steps // self.every
            first = 1_000_000 * self.seed + 20 * self._looked
            self.last = play(act, self.env, range(first, first + 20))
        self._started = time.process_time()
        return self.last >= GOALS[self.env]

    def result(self, steps: int, act: Act) -> dict[str, float]:
        """What a training was."""
        others = play(act, self.env, range(10_000_000, 10_000_100))
        return {
            "steps": steps,
            "seconds": sum(self.updates) - self.compiling,
            "compiling": self.compiling,
            "last": self.last,
            "others": others,
        }


def with_native(env: str, seed: int) -> dict[str, float]:
    """Our engine in C++."""
    from policy_gradients import made

    ppo, steps = made(env, seed)
    clock = Clock(env, seed, steps // LOOKS)
    while ppo.steps < steps:
        ppo.collect()
        ppo.update()
        if clock.reached(ppo.steps, ppo.act):
            break
    return clock.result(ppo.steps, ppo.act)


def with_sb3(env: str, seed: int, sbx: bool = False) -> dict[str, float]:
    """Stable-Baselines3, or SBX, which has the same interface and learns in JAX."""
    import gymnasium
    import stable_baselines3 as sb3
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.utils import LinearSchedule
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    from botschool.rl.model import choose
    from botschool.rl.parameters import linear

    s = choose("ppo", env, seed=seed, engine="sb3")
    options = {
        name: value if linear(value) is None else LinearSchedule(linear(value), 0.0, 1.0)
        for name, value in s.parameters.items()
    }
    options["policy_kwargs"] = {"net_arch": options.pop("net_arch", [64, 64])}
    for name in ("stats_window_size", "device", "activation_fn", "log_std_init", "ortho_init"):
        options.pop(name, None)  # the defaults of both
    envs = DummyVecEnv([lambda: gymnasium.make(env)] * s.envs)
    if s.normalize:
        envs = VecNormalize(envs, gamma=options["gamma"])
    if sbx:
        from sbx import PPO
    else:
        import torch

        torch.set_num_threads(1)
        PPO = sb3.PPO
    model = PPO("MlpPolicy", envs, seed=seed, device="cpu", **options)

    def act(observations: np.ndarray) -> np.ndarray:
        if s.normalize:
            observations = envs.normalize_obs(observations)
        return model.predict(observations.astype(np.float32), deterministic=True)[0]

    class Stops(BaseCallback):
        """Looks before each rollout."""

        def _on_rollout_start(self) -> None:
            self.ends = self.num_timesteps > 0 and clock.reached(self.num_timesteps, act)

        def _on_step(self) -> bool:
            return not self.ends

    clock = Clock(env, seed, s.steps // LOOKS)
    model.learn(s.steps, callback=Stops())
    if sbx:
        usual = float(np.median(clock.updates[2:]))
        clock.compiling = sum(max(0.0, each - usual) for each in clock.updates[:2])
    return clock.result(model.num_timesteps, act)


def with_jax(env: str, seed: int) -> dict[str, float]:
    """Our PPO in JAX."""
    from jax_ppo import Ppo

    from botschool.rl.settings import defaults

    ppo = Ppo(env, seed, defaults("ppo", env), LOOKS)
    clock = Clock(env, seed, ppo.steps_of_a_part)
    clock.compiling = ppo.compiling
    while ppo.steps < ppo.length:
        ppo.learn()
        if clock.reached(ppo.steps, ppo.act):
            break
    result = clock.result(ppo.steps, ppo.act)
    return result | {"seconds": sum(clock.updates)}  # it was compiled before


def measure(library: str, env: str, seed: int) -> dict[str, float]:
    """One training in a process of its own, on the last core."""
    core = str(max(os.sched_getaffinity(0)))
    command = [sys.executable, __file__, env, "--seed", str(seed), "--library", library]
    done = subprocess.run(
        ["taskset", "-c", core, *command],
        env=os.environ | ONE_CORE,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise SystemExit(f"{library} on {env}: {done.stderr[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1])


def compare(envs: list[str], seeds: range) -> None:
    """Prints a table."""
    print("| problem | library | seconds of one core | compiling | steps | 100 new episodes |")
    print("|---|---|---|---|---|---|")
    for env in envs:
        found: dict[str, list[dict[str, float]]] = {name: [] for name in LIBRARIES}
        for seed in seeds:
            for name, list_ in found.items():
                list_.append(measure(name, env, seed))
                print(env, name, seed, list_[-1], file=sys.stderr, flush=True)
        for name, runs in found.items():
            print(f"| {env} | {LIBRARIES[name]} | {' | '.join(columns(env, runs))} |", flush=True)


def columns(env: str, runs: list[dict[str, float]]) -> list[str]:
    """Cells of a row; a star where the goal was not reached."""
    seconds = [
        f"{run['seconds']:.2f}{'' if run['last'] >= GOALS[env] else '*'}"
        for run in sorted(runs, key=lambda run: run["seconds"])
    ]
    middle = {name: float(np.median([run[name] for run in runs])) for name in runs[0]}
    compiling = f"{middle['compiling']:.1f}" if middle["compiling"] else "-"
    others = sorted(run["others"] for run in runs)
    return [
        ", ".join(seconds),
        compiling,
        f"{middle['steps']:,.0f}",
        f"{others[0]:.1f} to {others[-1]:.1f}",
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problems", nargs="*", default=[])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=411)
    parser.add_argument("--library", choices=LIBRARIES)
    asked = parser.parse_args()
    envs = asked.problems or list(GOALS)
    if asked.library is None:
        compare(envs, range(asked.seed, asked.seed + asked.seeds))
        return
    train = {"native": with_native, "sb3": with_sb3, "jax": with_jax}
    if asked.library == "sbx":
        found = with_sb3(envs[0], asked.seed, sbx=True)
    else:
        found = train[asked.library](envs[0], asked.seed)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
