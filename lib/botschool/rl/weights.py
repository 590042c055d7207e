"""Store an agent as its weights only: an .npz file of numbers, which cannot contain code.

actor.mu.weight ...        the parts of the policy that act, by their names in its state_dict
normalisation.mean ...     if observations are normalised: mean, variance, clip, epsilon

Parts that only learning needs (critics, target networks) are left out. `config.yaml` in the same
folder names the policy of the weights.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import numpy as np

from botschool.errors import BotschoolError
from botschool.npy import opened
from botschool.output import save_npz

if TYPE_CHECKING:
    from stable_baselines3.common.policies import BasePolicy

WEIGHTS = "weights.npz"

LEARNING = (
    "value_net.", "mlp_extractor.value_net.", "vf_features_extractor.", "critic", "lstm_critic.",
    "actor_target.", "q_net_target.", "quantile_net_target.",
)  # fmt: skip
"""Beginnings of the names of parts that only learning needs."""

NORMALISATION = "normalisation"
SCALING = ("mean", "variance", "clip", "epsilon")
"""Scaling of observations: mean and variance have their shape, the others are numbers."""

MOST_BYTES = 2**28
"""Largest size in memory; larger files are refused."""

Normalise = Callable[[np.ndarray], np.ndarray]


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Read a model's file in the block. Raises BotschoolError if it is missing or damaged."""
    if not path.exists():
        raise BotschoolError(f"There is no model {path}: train one with `botschool rl train`.")
    try:
        yield
    except BotschoolError:
        raise
    except Exception as error:  # a damaged file can fail in any way
        raise BotschoolError(
            f"{path} is damaged, or it is not a model of this training: take the other "
            "model of its folder, or train again."
        ) from error


def save(path: Path, policy: BasePolicy, scaling: Mapping[str, np.ndarray] | None) -> None:
    """Write the file; scaling: arrays by the names of SCALING. Raises BotschoolError."""
    arrays = {name: value.cpu().numpy() for name, value in acting(policy).items()}
    for name in SCALING if scaling is not None else ():
        arrays[f"{NORMALISATION}.{name}"] = np.asarray(scaling[name])
    save_npz(path, arrays)


def acting(policy: BasePolicy) -> dict:
    """Return the tensors of a policy's state that acting needs."""
    state = policy.state_dict()
    return {name: value for name, value in state.items() if not name.startswith(LEARNING)}


def fill(path: Path, policy: BasePolicy, normalised: bool) -> dict[str, np.ndarray] | None:
    """Load the file's weights into the policy; return the scaling of observations if normalised.

    Nothing in the file is unpickled. Raises ValueError unless the file holds exactly this policy's
    weights and all numbers are finite.
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
    """Return the scaling if it fits observations of this shape. Raises ValueError otherwise."""
    shapes = {"mean": shape, "variance": shape, "clip": (), "epsilon": ()}
    for name, array in scaling.items():
        if array.shape != shapes[name] or not np.isfinite(array).all():
            raise ValueError(f"{name} does not fit the observations")
    if (scaling["variance"] + scaling["epsilon"] <= 0).any() or scaling["clip"] <= 0:
        raise ValueError("the scaling of observations is not usable")
    return scaling


def numbers(path: Path) -> dict[str, np.ndarray]:
    """Return the arrays of an .npz file. Raises ValueError or OSError if it holds anything else."""
    with opened(path) as file:
        with ZipFile(file) as archive:
            if sum(each.file_size for each in archive.infolist()) > MOST_BYTES:
                raise ValueError("it is too large")
        file.seek(0)
        with np.load(file, allow_pickle=False) as found:
            arrays = {name: found[name] for name in found.files}
    for name, array in arrays.items():
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiu":
            raise ValueError(f"{name} holds no numbers")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} is not finite")
    return arrays


def scaling_bytes(scaling: Mapping[str, np.ndarray]) -> bytes:
    """Return the arrays of SCALING as the bytes of an .npz file."""
    content = BytesIO()
    arrays: dict[str, Any] = {name: scaling[name] for name in SCALING}
    np.savez(content, **arrays)
    return content.getvalue()


def read_scaling(content: bytes) -> dict[str, np.ndarray]:
    """Read the arrays of scaling_bytes."""
    with np.load(BytesIO(content), allow_pickle=False) as arrays:
        return {name: arrays[name] for name in SCALING}


def normaliser(scaling: Mapping[str, np.ndarray]) -> Normalise:
    """Return the function that normalises observations (n, ...) as the training did."""
    mean, clip = scaling["mean"], scaling["clip"]
    deviation = np.sqrt(scaling["variance"] + scaling["epsilon"])

    def normalise(observations: np.ndarray) -> np.ndarray:
        return np.clip((observations - mean) / deviation, -clip, clip).astype(np.float32)

    return normalise
