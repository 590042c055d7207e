"""Exchange weights with Stable-Baselines3 by its names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from botschool.rl.native.ppo import PPO

if TYPE_CHECKING:
    import stable_baselines3


def names_of(parts: list[str]) -> dict[str, list[str]]:
    """Return our name of each part -> the names of its weights in Stable-Baselines3's policy.

    Stable-Baselines3 has two copies of layers that policy and critic share.
    """
    names: dict[str, list[str]] = {name: [] for name in parts}
    for net, body, head in (
        ("actor", "mlp_extractor.policy_net", "action_net"),
        ("critic", "mlp_extractor.value_net", "value_net"),
    ):
        layers = [name[:-7] for name in parts if name.startswith("shared.") and _weight(name)]
        layers += [name[:-7] for name in parts if name.startswith(f"{net}.") and _weight(name)]
        for number, layer in enumerate(layers):
            place = head if layer == layers[-1] else f"{body}.{2 * number}"
            for part in ("weight", "bias"):
                names[f"{layer}.{part}"].append(f"{place}.{part}")
    if "log_std" in names:
        names["log_std"].append("log_std")
    return names


def _weight(name: str) -> bool:
    return name.endswith(".weight")


def weights(ppo: PPO) -> dict[str, np.ndarray]:
    """Return copies of all weights by Stable-Baselines3's names."""
    names = names_of(list(ppo.weights))
    return {name: part.copy() for own, part in ppo.weights.items() for name in names[own]}


def fill(ppo: PPO, arrays: dict[str, np.ndarray]) -> None:
    """Load weights by Stable-Baselines3's names. Raises ValueError for another network's."""
    wanted = weights(ppo)
    if not wanted.keys() <= arrays.keys():
        raise ValueError("these are weights of another policy")
    for own, names in names_of(list(ppo.weights)).items():
        for name in names:
            if arrays[name].shape != wanted[name].shape:
                raise ValueError(f"{name} has another shape")
        ppo.weights[own][...] = arrays[names[0]]


def to_sb3(ppo: PPO) -> stable_baselines3.PPO:
    """Return a model of Stable-Baselines3 with the native agent's weights. Needs torch.

    If the native agent normalises, the model expects normalised observations (PPO.normalised).
    """
    import gymnasium
    import stable_baselines3
    import torch

    import botschool.problems.faces  # noqa: F401 (registers the ids)

    h = ppo.hyperparameters
    shared, pi, vf = h.layers()
    model = stable_baselines3.PPO(
        "MlpPolicy",
        gymnasium.make(ppo.env),
        gamma=h.gamma,
        gae_lambda=h.gae_lambda,
        device="cpu",
        policy_kwargs={
            "net_arch": {"pi": shared + pi, "vf": shared + vf},
            "activation_fn": torch.nn.Tanh if h.activation_fn == "tanh" else torch.nn.ReLU,
        },
    )
    state = {name: torch.from_numpy(each) for name, each in weights(ppo).items()}
    model.policy.load_state_dict(state)
    return model
