"""Train on native problems by proximal policy optimisation (Schulman 2017), whole or by steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from botschool import _core, linear
from botschool.errors import BotschoolError
from botschool.problems.native import INFOS, NativeProblem, gym_id
from botschool.rl.native import problem
from botschool.rl.native.hyperparameters import Hyperparameters, at


@dataclass(frozen=True)
class Rollout:
    """The experience of the environments; arrays of shape (n_steps, n_envs), float32.

    The arrays are the training's own: update() learns from what you write into advantages or
    returns. The next collect() overwrites them.
    """

    observations: np.ndarray
    """(n_steps, n_envs, inputs), normalised if the training normalises."""
    actions: np.ndarray
    """(n_steps, n_envs, actuators); for a discrete problem (n_steps, n_envs, 1), the index."""
    log_probs: np.ndarray
    """Logarithm of the probability (density) with which the policy chose the action."""
    values: np.ndarray
    """The critic's prediction for the observation."""
    rewards: np.ndarray
    """Where time ran out, the reward includes gamma times the critic's prediction of the rest."""
    ended: np.ndarray
    """1 where the episode ended with this step, 2 where time ran out, else 0."""
    last_values: np.ndarray
    """(n_envs,): the critic's predictions for the observations after the last step."""
    advantages: np.ndarray
    """Generalised advantage estimates."""
    returns: np.ndarray
    """Targets of the critic: advantages + values."""


@dataclass(frozen=True)
class Minibatch:
    """n samples; float32 arrays of length n, or with n rows."""

    observations: np.ndarray
    actions: np.ndarray
    log_probs: np.ndarray
    values: np.ndarray
    advantages: np.ndarray
    returns: np.ndarray


@dataclass(frozen=True)
class Loss:
    """The loss of a minibatch: policy_loss + vf_coef * value_loss - ent_coef * entropy."""

    loss: float
    policy_loss: float
    value_loss: float
    entropy: float
    approx_kl: float
    clip_fraction: float
    log_probs: np.ndarray
    """(n,): logarithm of the actions' probabilities under the present policy."""
    ratios: np.ndarray
    """(n,): probability of the action now, divided by its probability when it was chosen."""
    values: np.ndarray
    """(n,): the critic's present predictions."""
    gradient: np.ndarray
    """(parameters,): gradient of the loss, before max_grad_norm shortens it."""
    gradients: dict[str, np.ndarray]
    """The same gradient by the names of PPO.weights."""


class PPO:
    """A policy, a critic, environments to act in, and an optimiser.

    env: a native problem with one robot, by any of its names. normalize: scale observations and
    rewards by their running mean and deviation. total_timesteps: the steps over which "linear X"
    falls. threads: change the speed, not the result. own: `reward`, `ends` and `physics` of
    the problem, as in experiment files. The other arguments are Hyperparameters, with
    Stable-Baselines3's names and defaults. Raises BotschoolError.
    """

    def __init__(
        self,
        env: str,
        seed: int = 1,
        n_envs: int = 8,
        normalize: bool = False,
        total_timesteps: int = 1_000_000,
        threads: int = 1,
        instruction_set: str = "",
        own: dict[str, str] | None = None,
        **hyperparameters: Any,
    ) -> None:
        self.env, self.seed, self.n_envs, self.normalize = gym_id(env), seed, n_envs, normalize
        self.total_timesteps = total_timesteps
        self.hyperparameters = Hyperparameters.of(hyperparameters)
        self.problem, self.limit = problem.find(env)
        h = self.hyperparameters.core(seed, n_envs, normalize, threads)
        if own:
            h.choose(NativeProblem(self.problem, **own).options())
        try:
            self.core = _core.PolicyGradient(self.problem, self.limit, h, instruction_set)
        except ValueError as error:
            raise BotschoolError(f"PPO cannot be set up for {env}: {error}") from error
        info = INFOS[self.problem]
        self._discrete = info["discrete"]
        self.outputs: int = info["outputs"]
        """Number of actuators, or of actions to choose from."""

    @property
    def steps(self) -> int:
        """Return the steps of all environments so far."""
        return self.core.steps

    @property
    def progress(self) -> float:
        """Return the share of the training that is done, from 0 to 1."""
        return min(1.0, self.steps / self.total_timesteps)

    @property
    def parameters(self) -> np.ndarray:
        """Return all parameters, float32. Writing into them changes the agent."""
        return self.core.parameters

    @property
    def weights(self) -> dict[str, np.ndarray]:
        """Return views of the parameters: actor.0.weight (outputs, inputs), actor.0.bias, ...

        The names begin with actor, critic or shared (if layers are shared); a Gaussian adds
        log_std.
        """
        return self.named(self.parameters)

    def named(self, vector: np.ndarray) -> dict[str, np.ndarray]:
        """Return views of the parts of a vector of parameters, or of a gradient, by name."""
        return {
            name: vector[place : place + int(np.prod(shape))].reshape(shape)
            for name, shape, place in self.core.parts
        }

    @property
    def rollout(self) -> Rollout:
        """Return the last rollout."""
        return Rollout(**self.core.rollout)

    @property
    def episodes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return steps so far, returns and lengths of the episodes that the last rollout ended."""
        return self.core.episodes

    def collect(self) -> Rollout:
        """Act for n_steps steps in each environment; compute advantages and returns."""
        self.core.collect()
        return self.rollout

    def minibatch(self, rows: Sequence[int] | np.ndarray | None = None) -> Minibatch:
        """Return samples; row t * n_envs + e is step t of environment e. None: all rows."""
        chosen = slice(None) if rows is None else np.asarray(rows)
        columns = self.core.rollout
        names = ("observations", "actions", "log_probs", "values", "advantages", "returns")
        return Minibatch(
            *(columns[n].reshape(-1, *columns[n].shape[2:])[chosen].copy() for n in names)
        )

    def loss(self, batch: Minibatch, clip_range: float | None = None) -> Loss:
        """Return the loss of a minibatch under the present parameters, and its gradient."""
        h, n = self.hyperparameters, len(batch.observations)
        if clip_range is None:
            clip_range = at(h.clip_range, self.progress)
        found = self.core.loss(
            *(_matrix(x, n) for x in (batch.observations, batch.actions)),
            *(_vector(x) for x in (batch.log_probs, batch.values, batch.advantages, batch.returns)),
            clip_range,
            at(h.clip_range_vf, self.progress),
        )
        loss = found["policy_loss"] + h.vf_coef * found["value_loss"]
        return Loss(
            loss=loss - h.ent_coef * found["entropy"],
            ratios=linear.exp(found["log_probs"] - _vector(batch.log_probs)),
            gradients=self.named(found["gradient"]),
            **found,
        )

    def step(self, gradient: np.ndarray, learning_rate: float | None = None) -> None:
        """Make one step of Adam against a gradient, which max_grad_norm shortens.

        Raises BotschoolError if the gradient is not finite.
        """
        if learning_rate is None:
            learning_rate = at(self.hyperparameters.learning_rate, self.progress)
        if not self.core.step(_vector(gradient), learning_rate):
            raise self._broken()

    def update(self) -> dict[str, float]:
        """Go n_epochs times through the rollout in minibatches; return the means of the indicators.

        Raises BotschoolError if numbers are no longer finite.
        """
        h, progress = self.hyperparameters, self.progress
        rates = {
            name: at(getattr(h, name), progress)
            for name in ("learning_rate", "clip_range", "clip_range_vf")
        }
        found = self.core.update(**rates)
        if not found.pop("finite"):
            raise self._broken()
        return found | rates

    def learn(
        self,
        total_timesteps: int,
        callback: Callable[[PPO, dict[str, float]], bool | None] | None = None,
    ) -> PPO:
        """Collect and update until this many steps are done; return the agent itself.

        callback: called after each update with its indicators; returning False ends the training.
        """
        self.total_timesteps = total_timesteps
        while self.steps < total_timesteps:
            self.collect()
            found = self.update()
            if callback is not None and callback(self, found) is False:
                break
        return self

    def normalised(self, observations: np.ndarray) -> np.ndarray:
        """Return observations (n, inputs) normalised as the networks receive them, float32."""
        x = np.asarray(observations, dtype=np.float32)
        if not self.normalize:
            return np.ascontiguousarray(x)
        mean, variance = self.core.observed
        scale = (1 / np.sqrt(variance + 1e-8)).astype(np.float32)
        scaled = (x - mean.astype(np.float32)) * scale
        return np.ascontiguousarray(np.clip(scaled, np.float32(-10), np.float32(10)))

    def forward(self, observations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return policy outputs (n, outputs) and critic predictions (n,) for raw observations."""
        return self.core.forward(self.normalised(observations))

    def act(self, observations: np.ndarray) -> np.ndarray:
        """Return the most probable actions for observations (n, inputs), in Gymnasium's format."""
        outputs, _ = self.forward(observations)
        if self._discrete:
            return outputs.argmax(axis=1)
        info = INFOS[self.problem]
        return np.clip(outputs, info["low"], info["high"]).astype(np.float32)

    def play(self, seeds: Sequence[int] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Play a new episode for each seed without exploration; return returns and lengths (n,)."""
        chosen = np.array(seeds, dtype=np.uint64)
        return self.core.play(chosen, np.zeros(len(chosen), dtype=np.uint32))

    def state(self) -> dict[str, np.ndarray]:
        """Return all that the rest of the training depends on, as arrays (between updates)."""
        return self.core.state()

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Continue from a state as if never interrupted. Raises ValueError if it does not fit."""
        try:
            self.core.restore({name: np.ascontiguousarray(each) for name, each in state.items()})
        except (KeyError, RuntimeError, TypeError) as error:
            raise ValueError(f"this is not the state of such a training: {error}") from error

    def _broken(self) -> BotschoolError:
        return BotschoolError(
            f"The training on {self.env} broke down after {self.steps} steps: the network's "
            "outputs are no longer usable numbers, so lower learning_rate or max_grad_norm."
        )


def _matrix(values: np.ndarray, rows: int) -> np.ndarray:
    return np.ascontiguousarray(np.asarray(values, dtype=np.float32).reshape(rows, -1))


def _vector(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float32)
