"""Save and load trained models, and play episodes with them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.errors import BotschoolError
from botschool.output import save_bytes
from botschool.problems.base import Interrupted
from botschool.rl import weights
from botschool.rl.environments import described, make
from botschool.rl.folder import RunFolder
from botschool.rl.model import build
from botschool.rl.policies import check_trusted
from botschool.rl.weights import Normalise
from botschool.seeds import libraries_kept, seed_libraries

if TYPE_CHECKING:
    from stable_baselines3.common.base_class import BaseAlgorithm

    from botschool.rl.native.files import NativeAgent
    from botschool.rl.settings import Settings

NORMALISATION = "normalisation.npz"
"""Member of a model's zip file: mean and variance of the observations, clip and epsilon."""


def save_model(model: BaseAlgorithm, path: Path) -> None:
    """Write a model to a file atomically. Raises BotschoolError."""
    content = BytesIO()
    model.save(content)
    scaling = model.get_vec_normalize_env()
    if scaling is not None:
        arrays = {"mean": scaling.obs_rms.mean, "variance": scaling.obs_rms.var}
        arrays |= {"clip": scaling.clip_obs, "epsilon": scaling.epsilon}
        with ZipFile(content, "a") as archive:
            archive.writestr(NORMALISATION, weights.scaling_bytes(arrays))
    save_bytes(path, content.getvalue())


def save_weights(model: Path, path: Path) -> None:
    """Write only the weights of a training's model. Raises BotschoolError."""
    agent = Agent.load(model)
    if not isinstance(agent, Agent):
        raise BotschoolError(f"{model} already holds only weights: copy it.")
    weights.save(path, agent.model.policy, agent.scaling)


class Agent:
    """A model and the observation scaling that it was trained with."""

    def __init__(self, model: BaseAlgorithm, normalise: Normalise | None = None) -> None:
        self.model = model
        self.scaling: dict[str, np.ndarray] | None = None
        self._normalise = normalise

    @classmethod
    def load(
        cls, path: Path | str, env: str | None = None, policy: str | None = None
    ) -> Agent | NativeAgent:
        """Return the model in a file of a run's folder, for its environment or for `env`.

        The file is a model of Stable-Baselines3 (.zip) or holds only weights (.npz). Only weights
        are read, and no Python object in the file is loaded. If the settings name a policy class of
        the user's own, its module is imported only if `policy` names the same class. Raises
        BotschoolError if the file is missing or damaged, or if the model belongs to another
        environment or policy.
        """
        path = Path(path)
        settings = RunFolder(path.parent).settings()
        if settings.engine == "native":
            return _native(path, settings, env)
        check_trusted(path, settings.policy, policy)
        own = make(settings.env, settings.wrappers, **settings.own)
        if env is not None and env != settings.env:
            _check_same(settings.env, own, env, make(env, settings.wrappers))
        with weights.reading(path):
            model = build(settings, own, small=True)
            scaling = _fill(model, path, settings.normalize)
        agent = cls(model, None if scaling is None else weights.normaliser(scaling))
        agent.scaling = scaling
        return agent

    def act(
        self, observations: Any, state: Any = None, starts: np.ndarray | None = None
    ) -> tuple[np.ndarray, Any]:
        """Return the most likely actions for observations (n, ...), and the new state of an lstm.

        starts: bool, shape (n,), true where an episode begins. Raises BotschoolError where a
        network gives no finite numbers.
        """
        if self._normalise is not None:
            observations = self._normalise(observations)
        try:
            return self.model.predict(observations, state, starts, deterministic=True)
        except ValueError as error:
            if "invalid values" not in str(error):
                raise
            raise BotschoolError(
                "The network gives numbers that are not finite: the model is damaged, or its "
                "training diverged. Take the other model of its folder, or train again."
            ) from None


def _native(path: Path, settings: Settings, env: str | None) -> NativeAgent:
    from botschool.rl.native.files import NativeAgent

    if env is not None and env != settings.env:
        _check_same(settings.env, make(settings.env), env, make(env))
    return NativeAgent.load(path, settings)


def _check_same(trained: str, own: gymnasium.Env, other: str, given: gymnasium.Env) -> None:
    pairs = [
        ("observations", own.observation_space, given.observation_space),
        ("actions", own.action_space, given.action_space),
    ]
    for what, ours, theirs in pairs:
        if type(ours) is not type(theirs) or ours.shape != theirs.shape or _n(ours) != _n(theirs):
            raise BotschoolError(
                f"This is a model of {trained}, whose {what} are {described(ours)}; it cannot "
                f"act in {other}, whose {what} are {described(theirs)}."
            )


def _n(space: spaces.Space) -> Any:
    return getattr(space, "n", None)


def _fill(model: BaseAlgorithm, path: Path, normalised: bool) -> dict[str, np.ndarray] | None:
    """Load a file's weights into the model. Return the scaling of observations, if any."""
    if path.suffix == ".npz":
        return weights.fill(path, model.policy, normalised)
    model.set_parameters(str(path), device=model.device)
    if not normalised:
        return None
    with ZipFile(path) as archive:
        scaling = weights.read_scaling(archive.read(NORMALISATION))
    return weights.checked(scaling, model.observation_space.shape)


def play(
    agent: Agent | NativeAgent,
    envs: Sequence[gymnasium.Env],
    seeds: Sequence[int],
    stopping: Callable[[], bool] = lambda: False,
) -> tuple[np.ndarray, np.ndarray]:
    """Play one episode in each environment, in lockstep.

    Return the returns (n,), float64, and the lengths (n,), int64. Raises Interrupted when
    `stopping()` is true.
    """
    with libraries_kept():
        return _play(agent, envs, seeds, stopping)


def _play(
    agent: Agent | NativeAgent,
    envs: Sequence[gymnasium.Env],
    seeds: Sequence[int],
    stopping: Callable[[], bool],
) -> tuple[np.ndarray, np.ndarray]:
    n = len(envs)
    pairs = zip(envs, seeds, strict=True)
    observations = [env.reset(seed=seed_libraries(seed))[0] for env, seed in pairs]
    returns, lengths = np.zeros(n), np.zeros(n, dtype=np.int64)
    running, starts, state = np.ones(n, dtype=bool), np.ones(n, dtype=bool), None
    while running.any():
        if stopping():
            raise Interrupted
        actions, state = agent.act(stacked(observations), state, starts)
        starts[:] = False
        for i in np.flatnonzero(running).tolist():
            observations[i], reward, terminated, truncated, _ = envs[i].step(actions[i])
            returns[i] += reward
            lengths[i] += 1
            running[i] = not (terminated or truncated)
    return returns, lengths


def stacked(observations: Sequence[Any]) -> Any:
    """Return the observations as one batch, or as a dictionary of batches."""
    if isinstance(observations[0], dict):
        return {key: np.stack([one[key] for one in observations]) for key in observations[0]}
    return np.stack(observations)
