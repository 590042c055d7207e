"""An agent as its weights alone: an .npz file of arrays of numbers, in which nothing can run.

    actor.mu.weight ...        the parts of the policy that act, by their names in its state_dict
    normalisation.mean ...     where observations are normalised: mean, variance, clip, epsilon

What only learning needs (critics, target networks) is left out. `config.yaml` in the same folder
says of which policy they are the weights.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import numpy as np

from botschool.output import save_npz

if TYPE_CHECKING:
    from stable_baselines3.common.policies import BasePolicy

WEIGHTS = "weights.npz"

LEARNING = (
    "value_net.", "mlp_extractor.value_net.", "vf_features_extractor.", "critic", "lstm_critic.",
    "actor_target.", "q_net_target.", "quantile_net_target.",
)  # fmt: skip
"""How the names begin of what only learning needs."""

NORMALISATION = "normalisation"
SCALING = ("mean", "variance", "clip", "epsilon")
"""Of the observations: mean and variance have their shape, the others are numbers."""

MOST_BYTES = 2**28
"""A file that would fill more memory is no agent."""

Normalise = Callable[[np.ndarray], np.ndarray]


def save(path: Path, policy: BasePolicy, scaling: Mapping[str, np.ndarray] | None) -> None:
    """Writes the file. scaling: arrays by the names of SCALING. Raises BotschoolError."""
    arrays = {name: value.cpu().numpy() for name, value in acting(policy).items()}
    for name in SCALING if scaling is not None else ():
        arrays[f"{NORMALISATION}.{name}"] = np.asarray(scaling[name])
    save_npz(path, arrays)


def acting(policy: BasePolicy) -> dict:
    """The tensors of a policy's state that acting needs."""
    state = policy.state_dict()
    return {name: value for name, value in state.items() if not name.startswith(LEARNING)}


def fill(path: Path, policy: BasePolicy, normalised: bool) -> dict[str, np.ndarray] | None:
    """Puts the file's weights into the policy; the scaling of observations if it is normalised.

    Nothing in the file is ever unpickled. Raises ValueError unless it holds this policy's finite
    numbers and nothing else.
    """
    import torch

    arrays = numbers(path)
    names = [f"{NORMALISATION}.{name}" for name in SCALING] if normalised else []
    wanted = acting(policy)
    if arrays.keys() != wanted.keys() | set(names):
        raise ValueError("these are weights of another policy")
    for name, tensor in wanted.items():
        if arrays[name].shape != tuple(tensor.shape):
            raise ValueError(f"{name} has another shape")
    given = {name: torch.from_numpy(arrays[name]) for name in wanted}
    policy.load_state_dict({**policy.state_dict(), **given})
    if not normalised:
        return None
    scaling = {name: arrays[f"{NORMALISATION}.{name}"] for name in SCALING}
    return checked(scaling, policy.observation_space.shape)


def checked(scaling: dict[str, np.ndarray], shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    """Return the scaling of observations of this shape. Raises ValueError for any other."""
    shapes = {"mean": shape, "variance": shape, "clip": (), "epsilon": ()}
    for name, array in scaling.items():
        if array.shape != shapes[name] or not np.isfinite(array).all():
            raise ValueError(f"{name} does not fit the observations")
    if (scaling["variance"] + scaling["epsilon"] <= 0).any() or scaling["clip"] <= 0:
        raise ValueError("the observations cannot be scaled so")
    return scaling


def numbers(path: Path) -> dict[str, np.ndarray]:
    """The arrays of an .npz file. Raises ValueError or OSError if it holds anything else."""
    with ZipFile(path) as archive:
        if sum(each.file_size for each in archive.infolist()) > MOST_BYTES:
            raise ValueError("it is too large")
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    for name, array in arrays.items():
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiu":
            raise ValueError(f"{name} holds no numbers")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} is not finite")
    return arrays


def scaling_bytes(scaling: Mapping[str, np.ndarray]) -> bytes:
    """An .npz file of the arrays of SCALING."""
    content = BytesIO()
    arrays: dict[str, Any] = {name: scaling[name] for name in SCALING}
    np.savez(content, **arrays)
    return content.getvalue()


def read_scaling(content: bytes) -> dict[str, np.ndarray]:
    """The reverse of scaling_bytes."""
    with np.load(BytesIO(content), allow_pickle=False) as arrays:
        return {name: arrays[name] for name in SCALING}


def normaliser(scaling: Mapping[str, np.ndarray]) -> Normalise:
    """The function that normalises observations (n, ...) as the training did."""
    mean, clip = scaling["mean"], scaling["clip"]
    deviation = np.sqrt(scaling["variance"] + scaling["epsilon"])

    def normalise(observations: np.ndarray) -> np.ndarray:
        return np.clip((observations - mean) / deviation, -clip, clip).astype(np.float32)

    return normalise
