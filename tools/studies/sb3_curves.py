"""Learning curves of Stable-Baselines3's PPO, beside which a test puts those of the native engine.

    python tools/studies sb3_curves        trains the seeds that data/sb3_curves.json lacks

Acrobot only, two minutes of one core: data/ppo.json has the curves of CartPole and Pendulum, by
ppo_compare.py. tests/test_policy_gradients_curves.py reads both files.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import ppo_compare

DATA = Path(__file__).parent / "data" / "sb3_curves.json"
SEEDS = range(1, 6)
SETTINGS = {
    "Acrobot-v1": {
        "total_timesteps": 60_000, "n_envs": 16, "n_steps": 128, "batch_size": 256, "n_epochs": 4,
        "gamma": 0.99, "gae_lambda": 0.94, "learning_rate": 0.001,
    },
}  # fmt: skip


def kept() -> dict[str, dict[str, list[float]]]:
    """Return the curve of each problem and seed."""
    return json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else {}


def main() -> None:
    """See the top of the file."""
    import torch

    torch.set_num_threads(1)
    ppo_compare.SETTINGS = {env: {**of, "anneal": 0} for env, of in SETTINGS.items()}
    ppo_compare.EVALUATED = 1
    curves = kept()
    for seed in SEEDS:
        for env, settings in SETTINGS.items():
            mine = curves.setdefault(env, {})
            if str(seed) not in mine:
                episodes, _ = ppo_compare.stable_baselines3(env, seed)
                curve = ppo_compare.curve(episodes, settings["total_timesteps"])
                mine[str(seed)] = [None if np.isnan(x) else round(float(x), 2) for x in curve]
                DATA.write_text(json.dumps(curves, indent=1) + "\n", encoding="utf-8")
                print(env, seed, mine[str(seed)], flush=True)


if __name__ == "__main__":
    main()
