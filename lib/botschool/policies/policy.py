"""Bind a network to a problem: observation -> action, genotype in and out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from botschool.errors import BotschoolError
from botschool.policies.hyperparameters import (
    CONVOLUTIONAL,
    CONVOLUTIONS,
    NETWORK,
    PolicyConfig,
    numbers,
)
from botschool.policies.net import Network, NetworkSpec

LARGEST = 30_000
"""Largest number of values of an observation for a network without convolutional layers."""


@dataclass(frozen=True)
class Image:
    """The image format of an observation (docs/specification.md, "Convolutional networks")."""

    shape: tuple[int, ...]
    """(height, width), with the channels last or first; or several such images in a row."""
    white: float = 1.0
    """The value of a white pixel."""

    @property
    def axes(self) -> tuple[int, ...]:
        """Return the axes in the order frames, channels, height, width, as far as they exist."""
        every = tuple(range(len(self.shape)))
        frames, frame = every[:-3], every[-3:]
        if len(frame) == 3 and self.shape[frame[0]] >= self.shape[frame[2]]:
            frame = (frame[2], *frame[:2])
        return frames + frame

    @property
    def planes(self) -> tuple[int, int, int]:
        """Return the number of channels of all frames, height and width."""
        *channels, height, width = (self.shape[axis] for axis in self.axes)
        return int(np.prod(channels)), height, width

    def write(self, observation: np.ndarray, planes: np.ndarray) -> None:
        """Write an observation (flat) to `planes` (flat): channel by channel, 0 to 1."""
        turned = observation.reshape(self.shape).transpose(self.axes)
        np.divide(turned, self.white, out=planes.reshape(turned.shape))


@dataclass(frozen=True)
class Interface:
    """A problem's requirements of a policy."""

    observations: int
    """Values of one robot's observation."""
    outputs: int
    """One robot's actuators, or the number of actions of a discrete problem."""
    discrete: bool
    """Whether an action is the index of the most active output."""
    low: float | None = -1.0
    """Smallest action of every actuator; None if they differ or are unbounded."""
    high: float | None = 1.0
    morphology: int = 0
    """Parameters of the body, at the end of the genotype."""
    robots: int = 1
    """Robots in the environment, one network each."""
    groups: tuple[int, ...] = ()
    """Sizes of the groups of outputs, each of which chooses an index, if a discrete action has
    several indices; () if it is one index.
    """
    image: Image | None = None
    """Image format of the observation, if it is one."""
    reach: tuple[tuple[float, float], ...] = ()
    """Smallest and largest action of each actuator; () means `low` and `high` for all."""
    scaled: bool = False
    """Whether outputs with limits are scaled to `reach`; otherwise they are taken as they are."""

    @property
    def limits(self) -> np.ndarray:
        """Return smallest and largest action of each actuator, (actuators, 2), or infinity."""
        low = -np.inf if self.low is None else self.low
        high = np.inf if self.high is None else self.high
        return np.array(self.reach or [(low, high)] * self.outputs)


class Policy:
    """The policy that an experiment's [POLICY] describes, for one problem.

    A genotype is a float64 vector of `genotype_size` parameters. In a saved genotype of a
    normalised policy, all means and then all standard deviations follow (docs/specification.md,
    "Run files").
    """

    def __init__(self, problem: str, interface: Interface, config: PolicyConfig) -> None:
        if config.nrobots != interface.robots:
            robots = "one robot" if interface.robots == 1 else f"{interface.robots} robots"
            raise BotschoolError(
                f"{problem} has {robots}: set nrobots = {interface.robots}, not {config.nrobots}."
            )
        if config.nbins > 1 and interface.discrete:
            raise BotschoolError(
                f"{problem} has discrete actions, which need no bins: set nbins = 1."
            )
        if config.nbins > 1 and (interface.low is None or interface.high is None):
            raise BotschoolError(
                f"The actuators of {problem} have no common finite range, so its actions cannot "
                "be binned: set nbins = 1."
            )
        self.interface = interface
        self.config = config
        self._scale = _scaling(interface, config)
        self.unreached = _unreached(problem, interface, config)
        """A note about actions that the outputs do not reach, or hardly; often ""."""
        self._image = interface.image if config.architecture == CONVOLUTIONAL else None
        if config.architecture == CONVOLUTIONAL and self._image is None:
            raise BotschoolError(
                f"architecture = {CONVOLUTIONAL} (convolutional) reads images, but "
                f"observations of {problem} are not images: set architecture = 0."
            )
        if self._image is None and interface.observations > LARGEST:
            raise BotschoolError(
                f"{problem} cannot be evolved: its observations have {interface.observations} "
                f"values, but a flat network reads at most {LARGEST}: set architecture = "
                f"{CONVOLUTIONAL} (convolutional) if they are images, or make them smaller, as "
                "with wrappers = GrayscaleObservation, ResizeObservation(shape=(32, 32))."
            )
        try:
            self.spec = NetworkSpec(
                inputs=interface.observations,
                outputs=interface.outputs,
                **{name: getattr(config, name) for name in NETWORK},
                **self._convolutions(),
                low=-1.0 if interface.low is None else interface.low,
                high=1.0 if interface.high is None else interface.high,
            )
        except ValueError as error:
            raise BotschoolError(f"The network for {problem} cannot be built: {error}") from None
        self.network = Network(self.spec)
        self.nparameters = len(self.network.parameters)
        """Parameters of one network."""
        self.networks = interface.robots if config.heterogeneous else 1
        """Networks in a genotype; without `heterogeneous` all robots share one."""
        self.morphology = np.zeros(interface.morphology)
        """Parameters of the body, from the loaded genotype; often none."""

    def _convolutions(self) -> dict[str, tuple[int, ...]]:
        if self._image is None:
            return {}
        lists = {name: numbers(getattr(self.config, name)) for name in CONVOLUTIONS}
        return {"image": self._image.planes, **lists}

    @property
    def scales(self) -> bool:
        """Return whether outputs are scaled to the limits of the actions."""
        return self._scale is not None

    @property
    def neurons(self) -> tuple[int, int]:
        """Return the inputs (or features of images) and outputs of one network."""
        return self.network.neurons

    @property
    def genotype_size(self) -> int:
        """Return the number of parameters of the networks and of the body."""
        return self.networks * self.nparameters + self.interface.morphology

    def initial(self, seed: int, index: int = 0) -> np.ndarray:
        """Return a random genotype, shape (genotype_size,); each (seed, index) gives another."""
        parts = []
        for network in range(self.networks):
            self.network.seed(seed, index * self.networks + network)
            parts.append(self.network.initialise().copy())
        return np.concatenate([*parts, np.zeros(self.interface.morphology)])

    def split(self, saved: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        """Split a saved genotype into (genotype, normalisation vectors or None).

        Raises BotschoolError if it has the wrong length for this policy.
        """
        saved = np.asarray(saved)
        vectors = 2 * self.spec.inputs if self.spec.normalize else 0
        expected = self.genotype_size + vectors
        if saved.dtype.kind not in "fiu" or saved.shape != (expected,):
            parts = f" ({self.genotype_size} parameters, {vectors} for normalisation)"
            raise BotschoolError(
                f"The genotype has shape {saved.shape}, but this experiment needs {expected} "
                f"values{parts if vectors else ''}: it was saved with other [POLICY] settings."
            )
        saved = saved.astype(np.float64)
        if not np.all(np.isfinite(saved)):
            raise BotschoolError("The genotype holds values that are not finite numbers.")
        if not vectors:
            return saved, None
        if np.any(saved[-self.spec.inputs :] <= 0):
            raise BotschoolError("The genotype's standard deviations must be above 0.")
        return saved[: self.genotype_size], saved[self.genotype_size :]

    def join(self, genotype: np.ndarray, normalisation: np.ndarray | None) -> np.ndarray:
        """Return the genotype to save: the reverse of `split`."""
        return genotype.copy() if normalisation is None else np.append(genotype, normalisation)

    def load(self, genotype: np.ndarray, normalisation: np.ndarray | None) -> None:
        """Put a genotype (and normalisation vectors) into the network."""
        self.network.parameters[:] = genotype[: self.nparameters]
        self.morphology = genotype[self.genotype_size - self.interface.morphology :]
        if normalisation is not None:
            self.network.normalisation = normalisation

    def reset(self, seed: int, episode: int) -> None:
        """Start an episode; its action noise depends only on (seed, episode)."""
        self.network.seed(seed, episode)
        self.network.reset()

    def act(self, observation: np.ndarray) -> np.ndarray | int:
        """Return the action: an index for a discrete problem (int64 of shape (groups,) if it has
        several), else float32 of shape (outputs,).
        """
        if self._image is None:
            self.network.observation[:] = observation
        else:
            self._image.write(observation, self.network.observation)
        action = self.network.step()
        if self.interface.groups:
            edges = np.cumsum(self.interface.groups)[:-1]
            return np.array([np.argmax(group) for group in np.split(action, edges)])
        if self.interface.discrete:
            return int(np.argmax(action))
        if self._scale is not None:
            action = self._scale[0] * action + self._scale[1]
        return action.astype(np.float32)


OUTPUTS = {1: (0.0, 1.0), 2: (-1.0, 1.0), 4: (-1.0, 1.0)}
"""Smallest and largest output by `out_type`; the others have no limits."""
LEAST_SHARE = 0.1
"""Share of the actions near 0 below which a note says that outputs without limits begin there."""


def _scaling(interface: Interface, config: PolicyConfig) -> tuple[np.ndarray, np.ndarray] | None:
    """Return factor and shift of each output, by which outputs with limits reach those of the
    actions; None if nothing changes (docs/specification.md, "Outputs").
    """
    if not interface.scaled or interface.discrete or config.nbins > 1:
        return None
    if config.out_type not in OUTPUTS:
        return None
    least, most = OUTPUTS[config.out_type]
    limits = interface.limits
    limits[~np.isfinite(limits).all(axis=1)] = least, most
    factor = (limits[:, 1] - limits[:, 0]) / (most - least)
    shift = limits[:, 0] - factor * least
    return None if (factor == 1).all() and not shift.any() else (factor, shift)


def _unreached(problem: str, interface: Interface, config: PolicyConfig) -> str:
    limited = config.out_type in OUTPUTS
    if interface.discrete or config.nbins > 1 or (limited and interface.scaled):
        return ""
    least, most = OUTPUTS.get(config.out_type, (-1.0, 1.0))
    for low, high in interface.limits.tolist():
        if not 0 < high - low < np.inf:
            continue
        share = max(0.0, min(high, most) - max(low, least)) / (high - low)
        actions = f"actions of {problem} go from {low:g} to {high:g}"
        if limited and share < 1:
            return (
                f"{actions}, but outputs from {least:g} to {most:g} (out_type = "
                f"{config.out_type}), and {problem} takes them as they are: out_type = 3 (linear) "
                "reaches all."
            )
        if interface.scaled and share < LEAST_SHARE:
            return (
                f"{actions}, but outputs begin near 0 (out_type = {config.out_type}), from where "
                "they hardly get there: out_type = 2 (tanh) is scaled to that range."
            )
    return ""
