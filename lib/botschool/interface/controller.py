"""An evolved controller as a list of plain layers, from which `export` writes files of other tools.

The layers compute what docs/specification.md, "Policy network", says, without action noise.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from botschool.errors import BotschoolError
from botschool.policies.policy import Policy

RECURRENT, FULLY_RECURRENT, LSTM, CONVOLUTIONAL = 1, 2, 3, 4
LOGISTIC, TANH, LINEAR, BINARY, RELU = 1, 2, 3, 4, 5
BEFORE = "_before"
"""Ends the name of what a layer gave in the step before; 0 at the start of an episode."""


@dataclass
class Layer:
    """Neurons that are computed together: activation(bias + sum of weights @ sender)."""

    name: str
    bias: np.ndarray
    activation: int
    weights: dict[str, np.ndarray] = field(default_factory=dict)
    """Sender -> matrix, (neurons, senders)."""


class Controller:
    """The network of one robot, with what happens to its inputs and outputs."""

    def __init__(
        self, policy: Policy, genotype: np.ndarray, normalisation: np.ndarray | None
    ) -> None:
        """Take a genotype apart. Raises BotschoolError for images and several networks."""
        spec, interface = policy.spec, policy.interface
        if spec.architecture == CONVOLUTIONAL or interface.robots > 1 or interface.groups:
            raise BotschoolError(
                "A controller is exported if it drives one robot, with one action or several "
                "actuators, and reads no images."
            )
        self.inputs, self.clip = spec.inputs, bool(spec.clip)
        vectors = np.repeat([0.0, 1.0], spec.inputs) if normalisation is None else normalisation
        self.mean, self.deviation = np.split(np.asarray(vectors, float), 2)
        self.layers: list[Layer] = []
        self.cells = 0
        """Units of an LSTM, whose gates are the first four layers."""
        self._rest = np.asarray(genotype[: policy.nparameters], float)
        self._split(spec)
        self.discrete = interface.discrete
        self.bins = spec.nbins
        self.low, self.high = spec.low, spec.high
        self.factor, self.shift = policy._scale or (np.ones(spec.outputs), np.zeros(spec.outputs))
        self.actions = 1 if self.discrete else spec.outputs

    @property
    def memory(self) -> dict[str, int]:
        """Return what is kept for the next step, and its size."""
        kept = {"cell": self.cells} if self.cells else {}
        for layer in self.layers:
            if any(f"{layer.name}{BEFORE}" in other.weights for other in self.layers):
                kept[layer.name] = len(layer.bias)
        return kept | ({"hidden": self.cells} if self.cells else {})

    def _take(self, *shape: int) -> np.ndarray:
        size = int(np.prod(shape))
        taken, self._rest = self._rest[:size], self._rest[size:]
        return taken.reshape(shape)

    def _split(self, spec) -> None:
        outputs = spec.outputs * spec.nbins
        sizes = [spec.nhiddens] * spec.nlayers if spec.nhiddens else []
        if spec.nlayers == 2 and spec.nhiddens2 > 0 and sizes:
            sizes = [2 * spec.nhiddens - spec.nhiddens2, spec.nhiddens2]
        hidden = sum(sizes)
        bias = self._take(hidden + outputs) if spec.bias else np.zeros(hidden + outputs)
        output = Layer("output", bias[hidden:], spec.out_type)
        if spec.architecture == LSTM and hidden:
            self._lstm(spec, hidden, output)
        elif spec.architecture == FULLY_RECURRENT and hidden:
            self._all_at_once(spec, Layer("hidden0", bias[:hidden], spec.afunction), output)
        else:
            again = spec.architecture in (RECURRENT, FULLY_RECURRENT)
            self._one_by_one(spec, sizes, bias, output, again)
        self.layers.append(output)

    def _one_by_one(self, spec, sizes, bias, output: Layer, again: bool) -> None:
        sender, senders, first = "inputs", spec.inputs, 0
        for i, size in enumerate(sizes):
            layer = Layer(f"hidden{i}", bias[first : first + size], spec.afunction)
            layer.weights[sender] = self._take(size, senders)
            if again:
                layer.weights[layer.name + BEFORE] = self._take(size, size)
            self.layers.append(layer)
            sender, senders, first = layer.name, size, first + size
        output.weights[sender] = self._take(len(output.bias), senders)
        if again:
            output.weights["output" + BEFORE] = self._take(len(output.bias), len(output.bias))

    def _all_at_once(self, spec, hidden: Layer, output: Layer) -> None:
        sizes = (spec.inputs, len(hidden.bias), len(output.bias))
        rows = self._take(len(hidden.bias) + len(output.bias), sum(sizes))
        senders = ("inputs", "hidden0" + BEFORE, "output" + BEFORE)
        for layer, block in ((hidden, rows[: sizes[1]]), (output, rows[sizes[1] :])):
            blocks = np.split(block, np.cumsum(sizes)[:-1], axis=1)
            layer.weights = dict(zip(senders, blocks, strict=True))
        self.layers.append(hidden)

    def _lstm(self, spec, units: int, output: Layer) -> None:
        rows = self._take(units, 4, spec.inputs + units)
        for i, name in enumerate(("forget", "input", "give", "candidate")):
            gate = Layer(name, np.full(units, float(i == 0)), TANH if i == 3 else LOGISTIC)
            blocks = np.split(rows[:, i], [spec.inputs], axis=1)
            gate.weights = dict(zip(("inputs", "hidden" + BEFORE), blocks, strict=True))
            self.layers.append(gate)
        self.cells = units
        output.weights["hidden"] = self._take(len(output.bias), units)
