"""The genotype of a policy network: its length, the place of each parameter, its first values."""

import numpy as np
import pytest

from botschool.net import Network, NetworkSpec
from reference_network import matrices, parse


def spec_of(**changes) -> NetworkSpec:
    return NetworkSpec(**({"inputs": 3, "outputs": 2, "nhiddens": 4} | changes))


# Which connection each parameter of a small network is, counted by hand from
# docs/specification.md, "Policy network":
# "2.3" is the weight to neuron 2 from neuron 3, "2.3'" from its activation of the step before,
# "2" the bias of neuron 2. Neurons are numbered inputs 0-1, then hidden, then the output.
def connection(text):
    """(receiver, sender or None, whether from the step before)."""
    receiver, _, sender = text.rstrip("'").partition(".")
    return int(receiver), int(sender) if sender else None, text.endswith("'")


# Large enough that a standard deviation is known to 1 %.
LARGE = {"inputs": 30, "outputs": 25, "nhiddens": 40, "bias": 1}
SHAPES = {
    "feed-forward": {},
    "two layers": {"nlayers": 2, "nhiddens2": 25},
    "recurrent": {"architecture": 1},
    "fully recurrent": {"architecture": 2},
    "LSTM": {"architecture": 3},
    "perceptron": {"nhiddens": 0},
    "bins and noise": {"nbins": 2, "action_noise": 2},
}
# (fan in, fan out) of each block, from docs/specification.md, "Policy network": fan in counts all
# senders of the receiving layer; fan out is the size of that layer (one block: all its receivers).
FANS = {
    "feed-forward": {"hidden0": (30, 40), "output": (40, 25)},
    "two layers": {"hidden0": (30, 55), "hidden1": (55, 25), "output": (25, 25)},
    "recurrent": {
        "hidden0": (30 + 40, 40),
        "hidden0 before": (30 + 40, 40),
        "output": (40 + 25, 25),
        "output before": (40 + 25, 25),
    },
    "fully recurrent": {"all": (30 + 40 + 25, 40 + 25)},
    "LSTM": {"gates": (30 + 40, 40), "output": (40, 25)},
    "perceptron": {"output": (30, 25)},
    "bins and noise": {"hidden0": (30, 40), "output": (40, 50)},
}


def initial_parts(spec, seed=1):
    network = Network(spec)
    network.parameters[:] = 9
    return parse(spec, network.initialise(seed))


def pooled(spec, name, draws=20):
    return np.concatenate([initial_parts(spec, seed)[name].ravel() for seed in range(draws)])


@pytest.mark.parametrize("shape", SHAPES)
def test_xavier_weights(shape):
    spec = NetworkSpec(**(LARGE | SHAPES[shape]), winit=0)
    assert set(FANS[shape]) == {name for name, _, _ in matrices(spec)}
    for name, (fan_in, fan_out) in FANS[shape].items():
        weights = pooled(spec, name) / np.sqrt(2 / (fan_in + fan_out))
        n = len(weights)
        assert abs(weights.mean()) < 5 / np.sqrt(n)
        assert abs(weights.std() - 1) < 5 / np.sqrt(2 * n)
        assert abs((weights**4).mean() - 3) < 5 * np.sqrt(96 / n)  # Gaussian


@pytest.mark.parametrize("shape", SHAPES)
def test_uniform_weights(shape):
    spec = NetworkSpec(**(LARGE | SHAPES[shape]), winit=2, wrange=0.7)
    for name in FANS[shape]:
        weights = pooled(spec, name) / 0.7
        n = len(weights)
        assert -1 <= weights.min() < -0.99 and 0.99 < weights.max() <= 1
        assert abs(weights.mean()) < 5 * np.sqrt(1 / 3 / n)
        assert abs((weights**2).mean() - 1 / 3) < 5 * np.sqrt(4 / 45 / n)


@pytest.mark.parametrize(("out_type", "output_norm"), [(1, 1), (2, 1), (3, 0.01), (4, 1)])
@pytest.mark.parametrize("shape", SHAPES)
def test_norm_incoming_weights(shape, out_type, output_norm):
    spec = NetworkSpec(**(LARGE | SHAPES[shape]), winit=1, out_type=out_type)
    parts = initial_parts(spec)
    if shape == "LSTM":
        incoming = [(1, parts["gates"]), (output_norm, parts["output"])]
    elif shape == "fully recurrent":
        incoming = [(1, parts["all"][:40]), (output_norm, parts["all"][40:])]
    elif shape == "recurrent":
        incoming = [
            (1, np.hstack([parts["hidden0"], parts["hidden0 before"]])),
            (output_norm, np.hstack([parts["output"], parts["output before"]])),
        ]
    else:
        incoming = [(1, parts.get("hidden0", np.ones((1, 1)))), (output_norm, parts["output"])]
        if shape == "two layers":
            assert np.linalg.norm(parts["hidden1"], axis=1) == pytest.approx(1)
    for norm, rows in incoming:
        assert np.linalg.norm(rows, axis=1) == pytest.approx(norm, rel=1e-12)
        # directions are those of Gaussian vectors: no element stands out, whatever its block
        unit = rows / norm * np.sqrt(rows.shape[1])
        columns = (unit**2).mean(axis=0)
        if len(rows) > 1:
            assert np.all(np.abs(columns - 1) < 6 * np.sqrt(2 / len(rows)))


@pytest.mark.parametrize("winit", [0, 1, 2])
def test_initial_weights_are_a_function_of_seed_and_index(winit):
    spec = spec_of(winit=winit)
    one, other = Network(spec), Network(spec)
    draws = {}
    for seed in (0, 1, 2**32 + 1, 2**64 - 1):
        for index in (0, 1, 2**32 - 1):
            one.seed(seed, index)
            other.seed(seed, index)
            other.reset()
            draws[seed, index] = one.initialise().copy()
            assert np.array_equal(draws[seed, index], other.initialise())
    assert len({tuple(np.sort(d).tolist()) for d in draws.values()}) == len(draws)
