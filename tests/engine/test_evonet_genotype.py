"""The genotype of a policy network: its length, the place of each parameter, its first values."""

import numpy as np
import pytest

from botschool.net import Network, NetworkSpec
from reference_network import genotype_length, matrices, parse, philox


def spec_of(**changes) -> NetworkSpec:
    return NetworkSpec(**({"inputs": 3, "outputs": 2, "nhiddens": 4} | changes))


@pytest.mark.parametrize(
    ("changes", "length"),
    [
        ({}, 3 * 4 + 4 * 2),
        ({"bias": 1}, 4 + 2 + 3 * 4 + 4 * 2),
        ({"nlayers": 3}, 3 * 4 + 4 * 4 + 4 * 4 + 4 * 2),
        ({"nlayers": 2, "nhiddens2": 3}, 3 * 5 + 5 * 3 + 3 * 2),
        ({"nlayers": 2, "nhiddens2": 3, "bias": 1}, 5 + 3 + 2 + 3 * 5 + 5 * 3 + 3 * 2),
        ({"nhiddens": 0, "bias": 1}, 2 + 3 * 2),
        ({"nhiddens": 0, "nlayers": 3}, 3 * 2),
        ({"nbins": 5, "bias": 1}, 4 + 10 + 3 * 4 + 4 * 10),
        ({"architecture": 1, "bias": 1}, 4 + 2 + 3 * 4 + 4 * 4 + 4 * 2 + 2 * 2),
        ({"architecture": 1, "nhiddens": 0}, 3 * 2 + 2 * 2),
        ({"architecture": 2, "bias": 1}, 4 + 2 + (4 + 2) * (3 + 4 + 2)),
        ({"architecture": 2, "nhiddens": 0}, 2 * (3 + 2)),
        ({"architecture": 3, "bias": 1}, 4 + 2 + 4 * 4 * (3 + 4) + 4 * 2),
        ({"architecture": 3, "nhiddens": 0}, 3 * 2),
        ({"action_noise": 1}, 3 * 4 + 4 * 2),
        ({"action_noise": 2}, 3 * 4 + 4 * 2 + 2),
        ({"action_noise": 2, "nbins": 5}, 3 * 4 + 4 * 10 + 2),
    ],
)
def test_genotype_length(changes, length):
    spec = spec_of(**changes)
    assert len(Network(spec).parameters) == length
    assert genotype_length(spec) == length


# Which connection each parameter of a small network is, counted by hand from
# docs/specification.md, "Policy network":
# "2.3" is the weight to neuron 2 from neuron 3, "2.3'" from its activation of the step before,
# "2" the bias of neuron 2. Neurons are numbered inputs 0-1, then hidden, then the output.
PLACES = {
    "feed-forward": ({}, "2 3 4  2.0 2.1 3.0 3.1  4.2 4.3"),
    "unequal layers": (
        {"nlayers": 2, "nhiddens2": 1},
        "2 3 4 5 6  2.0 2.1 3.0 3.1 4.0 4.1  5.2 5.3 5.4  6.5",
    ),
    "recurrent": (
        {"architecture": 1},
        "2 3 4  2.0 2.1 3.0 3.1  2.2' 2.3' 3.2' 3.3'  4.2 4.3  4.4'",
    ),
    "fully recurrent": (
        {"architecture": 2},
        "2 3 4  2.0 2.1 2.2' 2.3' 2.4'  3.0 3.1 3.2' 3.3' 3.4'  4.0 4.1 4.2' 4.3' 4.4'",
    ),
    "perceptron": ({"nhiddens": 0}, "2  2.0 2.1"),
}


def connection(text):
    """(receiver, sender or None, whether from the step before)."""
    receiver, _, sender = text.rstrip("'").partition(".")
    return int(receiver), int(sender) if sender else None, text.endswith("'")


@pytest.mark.parametrize("case", PLACES)
def test_place_of_each_parameter(case):
    changes, text = PLACES[case]
    places = [connection(each) for each in text.split()]
    spec = NetworkSpec(
        **(
            {"inputs": 2, "outputs": 1, "nhiddens": 2, "bias": 1, "afunction": 3, "out_type": 3}
            | changes
        )
    )
    network = Network(spec)
    assert len(network.parameters) == len(places)
    rng = np.random.default_rng(1)
    genotype, observations = rng.normal(size=len(places)), rng.normal(size=(2, 2))
    base = activations_of(network, genotype, observations)
    for k, (receiver, sender, before) in enumerate(places):
        changed = activations_of(network, genotype + 1e-3 * (np.arange(len(genotype)) == k),
                                 observations)  # fmt: skip
        difference = (changed - base) / 1e-3
        if before:
            assert not difference[0].any()
            assert difference[1, receiver] == pytest.approx(base[0, sender], abs=1e-10)
        else:
            sent = 1 if sender is None else base[0, sender]
            assert difference[0, receiver] == pytest.approx(sent, abs=1e-10)
        # nothing but this neuron and those that it sends to in the same step
        step, reached = (1 if before else 0), {r for r, s, b in places if s == receiver and not b}
        beyond = {r for r, s, b in places if s in reached and not b}
        for neuron in set(range(len(base[0]))) - {receiver} - reached - beyond:
            assert difference[step, neuron] == 0


def activations_of(network, genotype, observations):
    network.parameters[:] = genotype
    network.reset()
    rows = []
    for observation in observations:
        network.observation = observation
        network.step()
        rows.append(network.activations.copy())
    return np.array(rows)


def test_place_of_each_parameter_of_an_lstm():
    spec = NetworkSpec(inputs=1, outputs=1, nhiddens=2, architecture=3, bias=1, out_type=3)
    network = Network(spec)
    rng = np.random.default_rng(3)
    genotype, observations = rng.normal(size=3 + 2 * 4 * 3 + 2), rng.normal(size=(3, 1))
    assert len(network.parameters) == len(genotype)
    base = activations_of(network, genotype, observations)
    assert np.abs(base[:, 3]).max() < 2 and base[:, 3] == pytest.approx(
        genotype[2] + base[:, 1:3] @ genotype[-2:], abs=1e-14
    )

    def effect(k):
        unit = np.arange(len(genotype)) == k
        return activations_of(network, genotype + unit, observations) - base

    assert not effect(0).any() and not effect(1).any()  # hidden biases have no effect
    assert effect(2)[:, 3] == pytest.approx(1)
    for unit in range(2):
        for gate, name in enumerate(("forget", "input", "output", "candidate")):
            for sender in range(3):  # the input and both units
                difference = effect(3 + (4 * unit + gate) * 3 + sender)
                # the first state is 0 and so are the first previous outputs
                first = (1 if name == "forget" else 0) if sender == 0 else 1
                assert not difference[:first].any()
                assert difference[first, 1 + unit] != 0
                assert difference[first, 2 - unit] == 0
    for unit in range(2):
        assert effect(27 + unit)[:, 3] == pytest.approx(base[:, 1 + unit], abs=1e-14)


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
@pytest.mark.parametrize("shape", SHAPES)
def test_biases_and_log_deviations_start_at_zero(shape, winit):
    parts = initial_parts(NetworkSpec(**(LARGE | SHAPES[shape]), winit=winit))
    assert not parts["hidden bias"].any() and not parts["output bias"].any()
    if shape == "bins and noise":
        assert parts["log deviation"].tolist() == [0] * 25
    assert all(np.all(parts[name] != 0) for name in FANS[shape])


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


@pytest.mark.parametrize("seed", [0, 1, 2**32 + 5, 2**64 - 1])
def test_initial_weights_stay_what_they_are(seed):
    """On every machine, in every version: counter = (number of the weight, 0, stream 3, index)."""
    assert philox(0, (0, 0, 0, 0)) == (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)
    network = Network(NetworkSpec(inputs=3, outputs=2, nhiddens=0, winit=2, wrange=0.7))
    for index in (0, 9):
        network.seed(seed, index)
        draws = [philox(seed, (i, 0, 3, index)) for i in range(6)]
        unit = np.array([(high << 32 | low) / 2**64 for high, low, _, _ in draws])
        assert network.initialise() == pytest.approx(-0.7 + 1.4 * unit, abs=1e-15)
