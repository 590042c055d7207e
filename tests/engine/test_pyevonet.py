"""The original library's face of policy networks: what its scripts do, and what it refuses."""

import gc
import re

import numpy as np
import pytest

from botschool import net
from reference_network import ReferenceNetwork

# The 20 arguments in order, as the chapter sets them.
ARGUMENTS = {
    "nnetworks": 1,
    "heterogeneous": 0,
    "ninputs": 4,
    "nhiddens": 10,
    "noutputs": 2,
    "nlayers": 1,
    "nhiddens2": 0,
    "bias": 1,
    "architecture": 2,
    "afunction": 2,
    "out_type": 3,
    "winit": 0,
    "clip": 0,
    "normalize": 0,
    "action_noise": 0,
    "action_noise_range": 0,
    "wrange": 0.0,
    "nbins": 1,
    "low": 0.0,
    "high": 0.0,
}
OUT_OF_RANGE = {
    "nnetworks": [0, -1, 10**6, 2**40],
    "heterogeneous": [2, -1],
    "ninputs": [0, -3, 2**31, 10**7],
    "nhiddens": [-1, 2**31, 10**7],
    "noutputs": [0, -1, 10**7],
    "nlayers": [0, -1, 2, 17, 10**9],
    "nhiddens2": [1, -1],
    "bias": [2, -1],
    "architecture": [4, 5, -1],
    "afunction": [0, 4, 6],
    "out_type": [0, 6],
    "winit": [-1, 3],
    "clip": [2, -1],
    "normalize": [2, -1],
    "action_noise": [3, -1],
    "action_noise_range": [-0.1, float("nan"), float("inf")],
    "wrange": [-1, float("nan"), float("inf")],
    "nbins": [0, -1, 10**6],
    "low": [float("nan"), float("-inf")],
    "high": [float("nan"), float("inf")],
}
REAL = {"action_noise_range", "wrange", "low", "high"}
# The spec calls two of them otherwise.
ALSO_CALLED = {"ninputs": "inputs", "noutputs": "outputs", "nnetworks": "number of networks"}
NPARAMETERS = 12 + 12 * 16


def build(**changes):
    return net.PyEvonet(*(ARGUMENTS | changes).values())


def is_a_sentence(error):
    text = str(error.value)
    return " " in text and text[-1] == "." and "\n" not in text and "arguments" not in text


def test_the_way_scripts_use_it():
    inputs = np.arange(4, dtype=np.float32)
    outputs = np.arange(2, dtype=np.float32)
    activations = np.arange(4 + 10 + 2, dtype=np.float64)
    network = net.PyEvonet(
        1, 0, 4, 10, 2, 1, 0, 1, 2, 2, 3, 0, 0, 0, 0, 0, 0.0, 1, 0.0, 0.0
    )  # fmt: skip
    count = network.computeParameters()
    assert count == NPARAMETERS
    parameters = np.arange(count, dtype=np.float64)
    network.copyGenotype(parameters)
    network.copyInput(inputs)
    network.copyOutput(outputs)
    network.copyNeuronact(activations)
    network.seed(101)
    network.initWeights()
    assert not parameters[:12].any() and np.all(parameters[12:] != 0)
    assert abs(parameters[12:].std() - np.sqrt(2 / (16 + 12))) < 0.05
    network.resetNet()
    assert not activations.any()
    reference = ReferenceNetwork(network.spec, parameters)
    rng = np.random.default_rng(1)
    for _ in range(10):
        inputs = rng.random(4).astype(np.float32)
        network.copyInput(inputs)
        network.updateNet()
        action, everything = reference.step(inputs)
        assert outputs == pytest.approx(action, rel=1e-6, abs=1e-7)
        assert activations == pytest.approx(everything, rel=1e-12, abs=1e-12)


def test_the_way_scripts_normalise():
    network = build(normalize=1, clip=1)
    vectors = np.arange(8, dtype=np.float64)
    inputs, _, activations, _ = hand_over(network)
    network.copyNormalization(vectors)
    network.getNormalizationVectors()
    assert vectors.tolist() == [0] * 4 + [1] * 4
    rng = np.random.default_rng(2)
    seen = rng.normal([1, 2, 3, 4], [1, 2, 0.001, 50], size=(200, 4)).astype(np.float32)
    network.normphase(1)
    for x in seen:
        inputs[:] = x
        network.updateNet()
        # the vectors in use change when asked to, not before
        assert activations[:4] == pytest.approx(np.clip(x, -5, 5), abs=1e-12)
    network.normphase(0)
    inputs[:] = 1000
    network.updateNet()
    network.updateNormalizationVectors()
    network.getNormalizationVectors()
    x, count = seen.astype(np.float64), 200.01
    mean = x.sum(axis=0) / count
    deviation = np.sqrt(np.maximum(((x**2).sum(axis=0) + 0.01) / count - mean**2, 0.01))
    assert vectors == pytest.approx(np.concatenate([mean, deviation]), rel=1e-10)
    inputs[:] = [1, 2, 3, 4]
    network.updateNet()
    assert activations[:4] == pytest.approx((inputs - mean) / deviation, abs=1e-12)
    vectors[:] = [0, 0, 0, 1, 2, 4, 0.5, 1]
    network.updateNet()
    assert activations[0] != 0.5  # not before setNormalizationVectors
    network.setNormalizationVectors()
    network.updateNet()
    assert activations[:4].tolist() == [0.5, 0.5, 5, 3]
    network.resetNormalizationVectors()
    network.getNormalizationVectors()
    assert vectors.tolist() == [0] * 4 + [1] * 4
    network.updateNormalizationVectors()  # and the statistics are forgotten
    network.getNormalizationVectors()
    assert vectors.tolist() == [0] * 4 + [1] * 4
    for bad in (0, -1, np.nan):
        vectors[-1] = bad
        with pytest.raises(ValueError, match="standard deviations above 0") as error:
            network.setNormalizationVectors()
        assert is_a_sentence(error)


def hand_over(network, seed=1):
    """Fresh arrays of the right kind, handed over: inputs, outputs, activations, parameters."""
    inputs, outputs = np.zeros(4, np.float32), np.zeros(2, np.float32)
    activations, parameters = np.zeros(16), np.zeros(network.computeParameters())
    network.copyGenotype(parameters)
    network.copyInput(inputs)
    network.copyOutput(outputs)
    network.copyNeuronact(activations)
    network.seed(seed)
    network.initWeights()
    network.resetNet()
    return inputs, outputs, activations, parameters


def test_parameters_and_inputs_are_read_in_place():
    network = build()
    inputs, outputs, activations, parameters = hand_over(network)
    inputs[:] = [1, -1, 2, 0.5]
    for _ in range(3):
        reference = ReferenceNetwork(network.spec, parameters)
        network.resetNet()
        network.updateNet()
        assert activations == pytest.approx(reference.step(inputs)[1], abs=1e-12)
        assert outputs == pytest.approx(activations[-2:], rel=1e-6)
        parameters *= 0.9
        inputs[0] += 1


def garbage():
    """Takes the place of memory that was given back, had it been."""
    return [np.full(n, np.nan) for n in range(1, 300) for _ in range(4)]


def test_arrays_are_kept_alive():
    def run(keep):
        network = build(normalize=1)
        arrays = hand_over(network)
        vectors = np.array([0.1, 0.2, 0.3, 0.4, 1, 2, 3, 4])
        network.copyNormalization(vectors)
        arrays[0][:] = [0.5, -1, 1, 2]
        outputs = arrays[1]
        if not keep:
            del arrays, vectors
            gc.collect()
        littered = garbage()
        network.setNormalizationVectors()
        results = []
        for _ in range(5):
            network.updateNet()
            results.append(outputs.copy())
            littered.append(garbage())
        return np.array(results)

    assert np.array_equal(run(keep=True), run(keep=False))
    assert run(True).any()


@pytest.mark.parametrize("name", ARGUMENTS)
def test_every_argument_is_checked(name):
    words = re.compile(f"{name}|{ALSO_CALLED.get(name, name)}|layer|connections")
    for value in OUT_OF_RANGE[name]:
        with pytest.raises(ValueError, match=words) as error:
            build(**{name: value})
        assert is_a_sentence(error), error.value
    for value in ("2", None, [1], *([] if name in REAL else [1.0, 0.5])):
        with pytest.raises((TypeError, ValueError), match=words) as error:
            build(**{name: value})
        assert is_a_sentence(error), error.value
    number = ARGUMENTS[name]
    assert build(**{name: np.float64(number) if name in REAL else np.int64(number)})


# method: (dtype, size, whether it is written to)
ARRAYS = {
    "copyGenotype": (np.float64, NPARAMETERS, True),
    "copyInput": (np.float32, 4, False),
    "copyOutput": (np.float32, 2, True),
    "copyNeuronact": (np.float64, 16, True),
    "copyNormalization": (np.float64, 8, True),
}


def unsuitable(dtype, size, written):
    """(what is wrong, the array)."""
    good = np.zeros(size, dtype)
    other = np.float32 if dtype == np.float64 else np.float64
    yield "too short", good[1:].copy()
    yield "too long", np.zeros(size + 1, dtype)
    yield "empty", np.zeros(0, dtype)
    yield "two-dimensional", good.reshape(1, -1)
    yield "other precision", good.astype(other)
    yield "integers", good.astype(np.int64)
    yield "objects", good.astype(object)
    yield "complex", good.astype(np.complex128)
    yield "other byte order", good.astype(np.dtype(dtype).newbyteorder())
    yield "every second value", np.zeros(2 * size, dtype)[::2]
    yield "backwards", good[::-1]
    yield "a list", [0.0] * size
    yield "nothing", None
    yield "a number", 1.0
    yield "bytes", bytes(good)
    if written:
        good.flags.writeable = False
        yield "read-only", good


@pytest.mark.parametrize("method", ARRAYS)
def test_unsuitable_arrays_are_refused(method):
    network = build(normalize=1)
    for what, array in unsuitable(*ARRAYS[method]):
        with pytest.raises((TypeError, ValueError)) as error:
            getattr(network, method)(array)
        assert is_a_sentence(error) and "vector" in str(error.value), (what, error.value)


@pytest.mark.parametrize("missing", ["copyGenotype", "copyInput", "copyOutput", "copyNeuronact"])
def test_arrays_that_are_missing_are_named(missing):
    network = build()
    for method, (dtype, size, _) in ARRAYS.items():
        if method not in (missing, "copyNormalization"):
            getattr(network, method)(np.zeros(size, dtype))
    with pytest.raises(ValueError, match=missing):
        network.updateNet()
    for method in ("initWeights", "resetNet", "updateNormalizationVectors"):
        if method == "initWeights" and missing == "copyGenotype":
            with pytest.raises(ValueError, match=missing):
                network.initWeights()
        else:
            getattr(network, method)()
    for method in ("setNormalizationVectors", "getNormalizationVectors"):
        with pytest.raises(ValueError, match="copyNormalization"):
            getattr(network, method)()


def test_an_array_reshaped_later_cannot_crash():
    network = build()
    inputs, outputs, _, _ = hand_over(network)
    inputs.shape = (2, 2)
    with pytest.raises((TypeError, ValueError)):
        network.updateNet()
    inputs.shape = (4,)
    inputs.resize(400, refcheck=False)
    with pytest.raises((TypeError, ValueError)):
        network.updateNet()
    inputs.resize(4, refcheck=False)
    outputs.flags.writeable = False
    with pytest.raises((TypeError, ValueError)):
        network.updateNet()
    outputs.flags.writeable = True
    network.updateNet()
