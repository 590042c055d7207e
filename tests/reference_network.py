"""The policy network of docs/specification.md, "Policy network", written for clarity. The C++ one
is tested against it.

Every array is float64 and every step allocates. Only the names of the hyperparameters are shared
with `botschool.net` (any object with the attributes of a NetworkSpec works).
"""

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from botschool.net import NetworkSpec

FEEDFORWARD, RECURRENT, FULLY_RECURRENT, LSTM, CONVOLUTIONAL = range(5)


def logistic(x):
    small = np.exp(-np.abs(x))  # the same for both signs, so that nothing overflows
    return np.where(x >= 0, 1, small) / (1 + small)


ACTIVATIONS = {
    1: logistic,
    2: np.tanh,
    3: lambda x: x,
    4: lambda x: np.where(x >= 0.5, 1.0, -1.0),
    5: lambda x: np.where(x < 0, 0.0, x),
}


def hidden_sizes(spec) -> list[int]:
    """Return the number of neurons of each hidden layer."""
    if spec.nhiddens == 0:
        return []
    if spec.nlayers == 2 and spec.nhiddens2 > 0:
        return [2 * spec.nhiddens - spec.nhiddens2, spec.nhiddens2]
    return [spec.nhiddens] * spec.nlayers


def output_count(spec) -> int:
    """Return the number of output neurons."""
    return spec.outputs * spec.nbins


def architecture_of(spec) -> int:
    """Return the architecture; an LSTM without units and a network behind an
    image are perceptrons.
    """
    alike = spec.architecture == CONVOLUTIONAL or (spec.architecture == LSTM and not spec.nhiddens)
    return FEEDFORWARD if alike else spec.architecture


def planes(spec) -> list[tuple[int, int, int]]:
    """Return (filters, height, width) of the image and of each convolutional layer's result."""
    shapes = [spec.image]
    for filters, kernel, stride in zip(spec.filters, spec.kernels, spec.strides, strict=True):
        _, height, width = shapes[-1]
        places = [len(range(0, side - kernel + 1, stride)) for side in (height, width)]
        shapes.append((filters, *places))
    return shapes


def read(spec) -> int:
    """Return the number of inputs, or of features of a convolutional network."""
    return int(np.prod(planes(spec)[-1])) if spec.architecture == CONVOLUTIONAL else spec.inputs


def kernels(spec) -> list[tuple[int, int, int, int]]:
    """Return the shape of the weights of each convolutional layer."""
    if spec.architecture != CONVOLUTIONAL:
        return []
    channels = [shape[0] for shape in planes(spec)]
    return [(f, c, k, k) for f, c, k in zip(spec.filters, channels, spec.kernels, strict=False)]


def matrices(spec) -> list[tuple[str, int, int]]:
    """Return (name, receivers, senders) of each block of connections, in the order
    of the genotype.
    """
    inputs, sizes, outputs = read(spec), hidden_sizes(spec), output_count(spec)
    hidden = sum(sizes)
    architecture = architecture_of(spec)
    if architecture == FULLY_RECURRENT:
        return [("all", hidden + outputs, inputs + hidden + outputs)]
    if architecture == LSTM:
        return [("gates", 4 * hidden, inputs + hidden), ("output", outputs, hidden)]
    blocks = []
    senders = inputs
    for i, size in enumerate(sizes):
        blocks.append((f"hidden{i}", size, senders))
        if architecture == RECURRENT:
            blocks.append((f"hidden{i} before", size, size))
        senders = size
    blocks.append(("output", outputs, senders))
    if architecture == RECURRENT:
        blocks.append(("output before", outputs, outputs))
    return blocks


def genotype_length(spec) -> int:
    """Return the number of parameters of one network."""
    count = sum(receivers * senders for _, receivers, senders in matrices(spec))
    count += sum(int(np.prod(shape)) for shape in kernels(spec))
    if spec.bias:
        count += sum(hidden_sizes(spec)) + output_count(spec)
        count += sum(shape[0] for shape in kernels(spec))
    if spec.action_noise == 2:
        count += spec.outputs
    return count


def parse(spec, genotype) -> dict[str, np.ndarray]:
    """Return the parts of a genotype: biases ("hidden bias", "output bias"), matrices by name, "log
    deviation", and for a convolutional layer "filters0" and "filters0 bias".
    """
    genotype = np.asarray(genotype, dtype=np.float64)
    assert genotype.shape == (genotype_length(spec),)
    hidden, outputs = sum(hidden_sizes(spec)), output_count(spec)
    parts = {"hidden bias": np.zeros(hidden), "output bias": np.zeros(outputs)}
    place = 0

    def take(*shape):
        nonlocal place
        size = int(np.prod(shape))
        place += size
        return genotype[place - size : place].reshape(shape)

    for i, shape in enumerate(kernels(spec)):
        parts[f"filters{i} bias"] = take(shape[0]) if spec.bias else np.zeros(shape[0])
        parts[f"filters{i}"] = take(*shape)
    if spec.bias:
        parts["hidden bias"] = take(hidden)
        parts["output bias"] = take(outputs)
    for name, receivers, senders in matrices(spec):
        parts[name] = take(receivers, senders)
    parts["log deviation"] = take(spec.outputs) if spec.action_noise == 2 else None
    assert place == len(genotype)
    return parts


class ReferenceNetwork:
    """One network; `step` returns (actions without noise, activations) of fresh arrays."""

    def __init__(self, spec, genotype, normalisation=None):
        self.spec = spec
        self.parts = parse(spec, genotype)
        self.mean, self.deviation = np.zeros(spec.inputs), np.ones(spec.inputs)
        if normalisation is not None:
            self.mean, self.deviation = np.split(np.asarray(normalisation, dtype=float), 2)
        self.reset()

    def reset(self):
        self.hidden = np.zeros(sum(hidden_sizes(self.spec)))
        self.output = np.zeros(output_count(self.spec))
        self.state = np.zeros_like(self.hidden)

    def step(self, observation):
        inputs = np.array(observation, dtype=np.float64)
        if self.spec.normalize:
            inputs = (inputs - self.mean) / self.deviation
        if self.spec.clip:
            inputs = np.clip(inputs, -5, 5)
        if self.spec.architecture == CONVOLUTIONAL:
            inputs = self.features(inputs.reshape(self.spec.image))
        update = (self.layered, self.layered, self.all_at_once, self.lstm)
        self.hidden, net_output = update[architecture_of(self.spec)](inputs)
        self.net_output = net_output
        self.output = ACTIVATIONS[self.spec.out_type](net_output)
        return self.action(), np.concatenate([inputs, self.hidden, self.output])

    def features(self, image):
        for i, stride in enumerate(self.spec.strides):
            weights, bias = self.parts[f"filters{i}"], self.parts[f"filters{i} bias"]
            side = weights.shape[-1]
            windows = np.lib.stride_tricks.sliding_window_view(image, (side, side), axis=(1, 2))
            windows = windows[:, ::stride, ::stride]
            net = np.einsum("fcij,cyxij->fyx", weights, windows) + bias[:, None, None]
            image = ACTIVATIONS[self.spec.afunction](net)
        return image.ravel()

    def layered(self, senders):
        parts, sizes = self.parts, hidden_sizes(self.spec)
        again = self.spec.architecture == RECURRENT
        biases = np.split(parts["hidden bias"], np.cumsum(sizes)[:-1]) if sizes else []
        before = np.split(self.hidden, np.cumsum(sizes)[:-1]) if sizes else []
        layers = []
        for i in range(len(sizes)):
            net = biases[i] + parts[f"hidden{i}"] @ senders
            if again:
                net = net + parts[f"hidden{i} before"] @ before[i]
            senders = ACTIVATIONS[self.spec.afunction](net)
            layers.append(senders)
        net = parts["output bias"] + parts["output"] @ senders
        if again:
            net = net + parts["output before"] @ self.output
        return np.concatenate([*layers, []]), net

    def all_at_once(self, inputs):
        bias = np.concatenate([self.parts["hidden bias"], self.parts["output bias"]])
        net = bias + self.parts["all"] @ np.concatenate([inputs, self.hidden, self.output])
        hidden = len(self.hidden)
        return ACTIVATIONS[self.spec.afunction](net[:hidden]), net[hidden:]

    def lstm(self, inputs):
        units = len(self.hidden)
        z = np.concatenate([inputs, self.hidden])
        gates = self.parts["gates"].reshape(units, 4, len(z)) @ z
        forget, candidate = logistic(gates[:, 0] + 1), np.tanh(gates[:, 3])
        self.state = self.state * forget + candidate * logistic(gates[:, 1])
        hidden = np.tanh(self.state) * logistic(gates[:, 2])
        return hidden, self.parts["output bias"] + self.parts["output"] @ hidden

    def action(self):
        return binned(self.spec, self.output)


def binned(spec, outputs):
    """Return the actuators' values for these activations of the output neurons."""
    if spec.nbins == 1:
        return np.array(outputs, dtype=float)
    rows = np.asarray(outputs).reshape(spec.outputs, spec.nbins)
    winner = np.array([list(row).index(max(row)) for row in rows])
    return spec.low + (spec.high - spec.low) * winner / (spec.nbins - 1)


# --- Random networks for hypothesis.


# Use the same examples every time: a failing test then fails for everyone.
REPEATABLE = settings(deadline=None, derandomize=True, database=None, max_examples=100)


HIDDEN_ACTIVATIONS = st.sampled_from([1, 2, 3, 5])


@st.composite
def layer_choices(draw):
    """Draw hyperparameters that determine the shape of a network."""
    choice = {"architecture": draw(st.integers(0, 3)), "nhiddens": draw(st.integers(0, 7))}
    if choice["architecture"] == FEEDFORWARD:
        choice["nlayers"] = draw(st.integers(1, 4))
        if choice["nlayers"] == 2 and choice["nhiddens"] > 0:
            choice["nhiddens2"] = draw(st.integers(0, 2 * choice["nhiddens"] - 1))
    return choice


@st.composite
def policy_choices(draw):
    """Draw hyperparameters of a policy, without noise and without those that its problem
    determines.
    """
    flag = st.integers(0, 1)
    return draw(layer_choices()) | {
        "bias": draw(flag),
        "normalize": draw(flag),
        "clip": draw(flag),
        "afunction": draw(HIDDEN_ACTIVATIONS),
        "out_type": draw(st.integers(1, 5)),
    }


@st.composite
def specs(draw):
    """Draw a NetworkSpec with a few neurons."""
    low, width = draw(st.integers(-3, 3)), draw(st.integers(1, 4))
    return NetworkSpec(
        inputs=draw(st.integers(1, 6)),
        outputs=draw(st.integers(1, 5)),
        nbins=draw(st.sampled_from([1, 1, 2, 3, 7])),
        low=low,
        high=low + width,
        action_noise=draw(st.sampled_from([0, 0, 1, 2])),
        action_noise_range=0.0,
        **draw(policy_choices()),
    )


@st.composite
def convolutional_specs(draw):
    """Draw a NetworkSpec for an image of a few pixels, in one or several layers."""
    flag, few = st.integers(0, 1), st.integers(1, 6)
    image = (draw(st.integers(1, 4)), draw(st.integers(1, 13)), draw(st.integers(1, 13)))
    height, width = image[1:]
    layers = []
    for _ in range(draw(st.integers(1, 3))):
        kernel, stride = draw(st.integers(1, min(height, width, 5))), draw(st.integers(1, 3))
        layers.append((draw(few), kernel, stride))
        height, width = ((side - kernel) // stride + 1 for side in (height, width))
    filters, sides, strides = zip(*layers, strict=True)
    return NetworkSpec(
        inputs=int(np.prod(image)),
        outputs=draw(few),
        architecture=CONVOLUTIONAL,
        nhiddens=draw(st.integers(0, 5)),
        nlayers=draw(st.integers(1, 2)),
        nbins=draw(st.sampled_from([1, 1, 3])),
        bias=draw(flag),
        normalize=draw(flag),
        clip=draw(flag),
        afunction=draw(HIDDEN_ACTIVATIONS),
        out_type=draw(st.integers(1, 5)),
        action_noise=draw(st.sampled_from([0, 0, 2])),
        image=image,
        filters=filters,
        kernels=sides,
        strides=strides,
    )


def random_genotype(spec, rng, scale=1.0):
    """Return Gaussian parameters small enough that rounding errors do not grow from layer to layer.

    Log standard deviations of the action noise are so low that the noise is far below rounding.
    """
    senders = read(spec) + sum(hidden_sizes(spec)) + spec.outputs * spec.nbins
    senders += sum(int(np.prod(shape[1:])) for shape in kernels(spec))
    genotype = scale / np.sqrt(senders) * rng.standard_normal(genotype_length(spec))
    if spec.action_noise == 2:
        genotype[-spec.outputs :] = -200
    return genotype


def random_normalisation(spec, rng):
    """Return means, then standard deviations."""
    return np.concatenate(
        [rng.normal(size=spec.inputs), np.exp(rng.uniform(-1, 2, size=spec.inputs))]
    )


def keeps_memory(spec) -> bool:
    """Return whether a step depends on the previous ones."""
    return architecture_of(spec) != FEEDFORWARD


def philox(key, counter):
    """Philox4x32-10 (Salmon et al. 2011), in whole numbers."""
    (a, b, c, d), (k, m), word = counter, (key % 2**32, key >> 32), 2**32
    for _ in range(10):
        p, q = 0xD2511F53 * a, 0xCD9E8D57 * c
        a, b, c, d = (q // word) ^ b ^ k, q % word, (p // word) ^ d ^ m, p % word
        k, m = (k + 0x9E3779B9) % word, (m + 0xBB67AE85) % word
    return a, b, c, d
