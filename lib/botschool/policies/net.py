"""Step policy networks by hand ("evonet"; docs/specification.md, "Policy network").

`Network` has numpy arrays to read and write, `reset()` and `step()`. `PyEvonet` has the original
library's interface, for scripts written for it: the caller owns all arrays and hands them over.
Evolution uses neither: it evaluates whole episodes in C++.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, make_dataclass
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool import _core
from botschool.policies.hyperparameters import NETWORK, PolicyConfig


@dataclass(frozen=True)
class _Spec:
    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __post_init__(self) -> None:
        self.evonet()

    def core(self) -> _core.Spec:
        """Return the C++ counterpart, without convolutional layers."""
        spec = _core.Spec()
        for field in fields(self):
            if field.type is not tuple:
                value = getattr(self, field.name)
                setattr(spec, field.name, _number(field.name, value, field.type is int))
        return spec

    def evonet(self, networks: int = 1, heterogeneous: bool = False) -> _core.Evonet:
        """Return networks with this specification; checks everything."""
        vision = _core.Vision()
        if self.image:
            shape = _numbers("image", self.image)
            if len(shape) != 3:
                raise ValueError(
                    f"image has {len(shape)} numbers, but needs channels, height and width."
                )
            vision.channels, vision.height, vision.width = shape
        for name in ("filters", "kernels", "strides"):
            setattr(vision, name, _numbers(name, getattr(self, name)))
        return _core.Evonet(self.core(), networks, heterogeneous, vision)


def _fields() -> list[tuple]:
    plain = [(name, int) for name in ("inputs", "outputs")]
    network = [(f.name, f.type, f.default) for f in fields(PolicyConfig) if f.name in NETWORK]
    layers = [(name, tuple, ()) for name in ("image", "filters", "kernels", "strides")]
    return [*plain, *network, ("low", float, -1.0), ("high", float, 1.0), *layers]


if TYPE_CHECKING:

    class NetworkSpec(_Spec):
        """Hides the fields that come from C++ from type checkers."""

        def __init__(self, inputs: int, outputs: int, **hyperparameters: Any) -> None: ...

else:
    NetworkSpec = make_dataclass(
        "NetworkSpec", _fields(), bases=(_Spec,), frozen=True, namespace={"__module__": __name__}
    )
NetworkSpec.__doc__ = f"""The layout of a policy network. Raises ValueError or TypeError.

inputs: values of an observation. outputs: actuators, or the actions of a discrete problem. low,
high: smallest and largest action, for bins. image, filters, kernels, strides: for architecture 4
(convolutional), the image's channels, height and width (`inputs` is their product), and a number
for each convolutional layer. The others are the hyperparameters of networks in experiment files,
with their defaults: {", ".join(NETWORK)}.
"""


class Network:
    """One policy network in double precision.

    `parameters`, `observation`, `action` and `activations` are numpy views of the network's own
    memory: write `parameters[:]` and `observation[:]` (or assign to them, which copies), call
    `step()`, read `action`. `activations` holds inputs, hidden neurons and outputs.

    >>> network = Network(NetworkSpec(inputs=2, outputs=1, nhiddens=3, bias=1))
    >>> network.initialise(seed=1)
    >>> network.observation[:] = 0.5, -0.5
    >>> network.step().shape
    (1,)
    """

    def __init__(self, spec: NetworkSpec) -> None:
        self.spec = spec
        self._core = spec.evonet()
        self._parameters = np.zeros(self._core.nparameters)
        self._observation = np.zeros(self._core.ninputs)
        self._action = np.zeros(self._core.nactions)
        self._activations = np.zeros(self._core.nneurons)
        self.seed(1)

    @property
    def parameters(self) -> np.ndarray:
        """Return the genotype in use, shape (parameters,); docs/specification.md, "Policy network",
        has its order.
        """
        return self._parameters

    @parameters.setter
    def parameters(self, values) -> None:
        self._parameters[:] = _vector("parameters", values, len(self._parameters))

    @property
    def observation(self) -> np.ndarray:
        """Return the raw observation that `step()` reads, shape (inputs,).

        A convolutional network's observation is ordered channel by channel, row by row, with values
        from 0 to 1.
        """
        return self._observation

    @observation.setter
    def observation(self, values) -> None:
        self._observation[:] = _vector("observation", values, len(self._observation))

    @property
    def action(self) -> np.ndarray:
        """Return the actuators after binning and noise, shape (outputs,)."""
        return self._action

    @property
    def activations(self) -> np.ndarray:
        """Return the activations, shape (neurons,): inputs (normalised and clipped), hidden
        neurons, outputs. A convolutional network has the features of its last convolutional layer
        instead of inputs.
        """
        return self._activations

    @property
    def neurons(self) -> tuple[int, int]:
        """Return how many activations are inputs (or features), and how many are outputs."""
        hidden = self.spec.nhiddens * self.spec.nlayers if self.spec.nhiddens else 0
        outputs = self.spec.outputs * self.spec.nbins
        return len(self._activations) - hidden - outputs, outputs

    @property
    def normalisation(self) -> np.ndarray:
        """Return a copy of the means in use, then the standard deviations, shape (2 * inputs,)."""
        return self._core.get_normalisation()

    @normalisation.setter
    def normalisation(self, values) -> None:
        self._core.set_normalisation(_normalisation(values, self.spec.inputs))

    def seed(self, seed: int, episode: int = 0) -> None:
        """Seed the initial weights and the action noise, which starts anew."""
        if not isinstance(episode, Integral) or not 0 <= episode < 2**32:
            raise ValueError(f"An episode is a whole number from 0 to 2^32 - 1, not {episode!r}.")
        self._core.seed(_seed(seed), int(episode))

    def initialise(self, seed: int | None = None) -> np.ndarray:
        """Draw initial weights (`winit`) into `parameters` and return them."""
        if seed is not None:
            self.seed(seed)
        self._core.initialise(self._parameters)
        return self._parameters

    def reset(self) -> None:
        """Start an episode: activations and memory become 0; the action noise continues."""
        self._core.reset()
        self._activations[:] = 0
        self._action[:] = 0

    def step(self) -> np.ndarray:
        """Update all neurons once; return `action`."""
        self._core.step(self._parameters, self._observation, self._action, self._activations)
        return self._action


class PyEvonet:
    """The original library's network, with the same 20 positional arguments and methods.

    `nhiddens` is the total of all layers here. The arrays handed over are kept alive and read (or
    written) in place: inputs and outputs float32, parameters, activations and normalisation
    float64, all C-contiguous. Wrong sizes, types and ranges raise ValueError or TypeError.
    """

    def __init__(
        self,
        nnetworks: int,
        heterogeneous: int,
        ninputs: int,
        nhiddens: int,
        noutputs: int,
        nlayers: int,
        nhiddens2: int,
        bias: int,
        architecture: int,
        afunction: int,
        out_type: int,
        winit: int,
        clip: int,
        normalize: int,
        action_noise: int,
        action_noise_range: float,
        wrange: float,
        nbins: int,
        low: float,
        high: float,
    ) -> None:
        nlayers = _number("nlayers", nlayers, True)
        nhiddens = _number("nhiddens", nhiddens, True)
        if nlayers < 1:
            raise ValueError(f"nlayers is {nlayers}, but must be at least 1.")
        if nhiddens % nlayers:
            raise ValueError(
                f"nhiddens is the total of all layers here: {nhiddens} cannot be shared "
                f"equally by {nlayers} layers."
            )
        heterogeneous = _number("heterogeneous", heterogeneous, True)
        if heterogeneous not in (0, 1):
            raise ValueError(f"heterogeneous is {heterogeneous!r}, but must be 0 or 1.")
        self.spec = NetworkSpec(
            inputs=ninputs,
            outputs=noutputs,
            nhiddens=nhiddens // nlayers,
            nlayers=nlayers,
            nhiddens2=nhiddens2,
            bias=bias,
            architecture=architecture,
            afunction=afunction,
            out_type=out_type,
            winit=winit,
            clip=clip,
            normalize=normalize,
            action_noise=action_noise,
            action_noise_range=action_noise_range,
            wrange=wrange,
            nbins=nbins,
            low=low,
            high=high,
        )
        nnetworks = _number("nnetworks", nnetworks, True)
        self._core = self.spec.evonet(nnetworks, bool(heterogeneous))
        self._arrays: dict[str, np.ndarray] = {}

    def computeParameters(self) -> int:
        """Return the length of the genotype."""
        return self._core.nparameters

    def copyGenotype(self, parameters: np.ndarray) -> None:
        """Hand over the parameters, float64, shape (computeParameters(),)."""
        self._keep("parameters", parameters, np.float64, self._core.nparameters)

    def copyInput(self, inputs: np.ndarray) -> None:
        """Hand over the observation, float32, shape (nnetworks * ninputs,)."""
        self._keep("input", inputs, np.float32, self._core.ninputs, written=False)

    def copyOutput(self, outputs: np.ndarray) -> None:
        """Hand over the array for actions, float32, shape (nnetworks * noutputs,)."""
        self._keep("output", outputs, np.float32, self._core.nactions)

    def copyNeuronact(self, activations: np.ndarray) -> None:
        """Hand over the array for activations, float64, shape (nnetworks * neurons,)."""
        self._keep("neuron activation", activations, np.float64, self._core.nneurons)

    def copyNormalization(self, vectors: np.ndarray) -> None:
        """Hand over the normalisation vector, float64: all means, then all deviations."""
        self._keep("normalization", vectors, np.float64, 2 * self.spec.inputs)

    def seed(self, seed: int) -> None:
        """Seed initial weights and action noise."""
        self._core.seed(_seed(seed), 0)

    def initWeights(self) -> None:
        """Draw initial weights into the parameters handed over."""
        self._core.initialise(self._array("parameters", "copyGenotype"))

    def resetNet(self) -> None:
        """Set all activations and memory to 0."""
        self._core.reset()
        if "neuron activation" in self._arrays:
            self._arrays["neuron activation"][:] = 0

    def updateNet(self) -> None:
        """Update all neurons once, from the input to the output and activation arrays."""
        self._core.step_single(
            self._array("parameters", "copyGenotype"),
            self._array("input", "copyInput"),
            self._array("output", "copyOutput"),
            self._array("neuron activation", "copyNeuronact"),
        )

    def normphase(self, phase: int) -> None:
        """Switch statistics: 1: `updateNet` adds the observations that it sees; 0: it does not."""
        if phase not in (0, 1):
            raise ValueError(f"normphase takes 0 or 1, not {phase!r}.")
        self._core.collecting = bool(phase)

    def updateNormalizationVectors(self) -> None:
        """Take means and deviations of the statistics collected so far into use."""
        self._core.set_normalisation(self._core.moments.vectors())

    def setNormalizationVectors(self) -> None:
        """Take the vector passed to `copyNormalization` into use."""
        vectors = self._array("normalization", "copyNormalization")
        self._core.set_normalisation(_normalisation(vectors, self.spec.inputs))

    def getNormalizationVectors(self) -> None:
        """Write the vectors in use into the vector passed to `copyNormalization`."""
        self._array("normalization", "copyNormalization")[:] = self._core.get_normalisation()

    def resetNormalizationVectors(self) -> None:
        """Forget the statistics: means 0 and deviations 1 are in use again."""
        self._core.moments.reset()
        n = self.spec.inputs
        self._core.set_normalisation(np.repeat([0.0, 1.0], n))

    def _keep(self, name: str, array, dtype, size: int, written: bool = True) -> None:
        if not isinstance(array, np.ndarray):
            raise TypeError(f"The {name} vector must be a numpy array, not {type(array).__name__}.")
        if array.dtype != dtype:
            raise TypeError(
                f"The {name} vector is {array.dtype}, but must be {np.dtype(dtype)}: "
                f"use .astype(np.{np.dtype(dtype)})."
            )
        if array.shape != (size,):
            raise ValueError(f"The {name} vector has shape {array.shape}, but needs ({size},).")
        if not array.flags.c_contiguous or (written and not array.flags.writeable):
            raise ValueError(f"The {name} vector must be contiguous and writable: use .copy().")
        self._arrays[name] = array

    def _array(self, name: str, method: str) -> np.ndarray:
        if name not in self._arrays:
            raise ValueError(f"Hand over the {name} vector with {method}() first.")
        return self._arrays[name]


def _number(name: str, value, integral: bool):
    if isinstance(value, Integral):
        value = int(value)
        if abs(value) > 2**31 - 1:
            raise ValueError(f"{name} is {value}, which is far too large.")
        return value
    if isinstance(value, Real) and not integral:
        if not math.isfinite(value):
            raise ValueError(f"{name} is {value}, but must be a finite number.")
        return float(value)
    kind = "a whole number" if integral else "a number"
    raise TypeError(f"{name} is {value!r}, but must be {kind}.")


def _numbers(name: str, values) -> list[int]:
    try:
        return [_number(name, value, True) for value in values]
    except TypeError:
        raise TypeError(f"{name} is {values!r}, but must be whole numbers.") from None


def _seed(seed: int) -> int:
    if not isinstance(seed, Integral) or not 0 <= seed < 2**64:
        raise ValueError(f"A seed is a whole number from 0 to 2^64 - 1, not {seed!r}.")
    return int(seed)


def _vector(name: str, values, size: int) -> np.ndarray:
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} must be numbers, not {array.dtype}.")
    if array.shape != (size,):
        raise ValueError(f"{name} has shape {array.shape}, but needs ({size},).")
    return array


def _normalisation(values, inputs: int) -> np.ndarray:
    array = np.ascontiguousarray(_vector("normalisation", values, 2 * inputs), dtype=np.float64)
    if not np.all(np.isfinite(array)) or np.any(array[inputs:] <= 0):
        raise ValueError("The normalisation needs finite means and standard deviations above 0.")
    return array
