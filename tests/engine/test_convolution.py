"""Convolutional networks (docs/specification.md, "Convolutional networks")."""

import re
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool import config, problems
from botschool.net import Network, NetworkSpec
from botschool.policies.policy import Image, Policy
from botschool.problems import Episodes
from reference_network import (
    REPEATABLE,
    ReferenceNetwork,
    convolutional_specs,
    genotype_length,
    parse,
    planes,
    random_genotype,
    random_normalisation,
    read,
)
from running import experiment, run_seeds, same, write_experiment

POLICY = {
    "architecture": 4, "afunction": 5, "filters": "4, 6", "kernels": "8, 3", "strides": "4, 2",
    "bias": 1, "nhiddens": 5,
}  # fmt: skip


def spec_of(image=(2, 7, 6), filters=(3, 2), kernels=(3, 2), strides=(2, 1), **changes):
    given = {"inputs": int(np.prod(image)), "outputs": 2, "nhiddens": 4, "architecture": 4}
    lists = {"image": image, "filters": filters, "kernels": kernels, "strides": strides}
    return NetworkSpec(**(given | lists | changes))


# the network


@pytest.mark.slow
@REPEATABLE
@given(convolutional_specs(), st.integers(0, 2**32))
def test_network_agrees_with_the_reference(spec, seed):
    rng = np.random.default_rng(seed)
    genotype, vectors = random_genotype(spec, rng, 2.0), random_normalisation(spec, rng)
    network, reference = Network(spec), ReferenceNetwork(spec, genotype, vectors)
    assert len(network.parameters) == genotype_length(spec)
    network.parameters[:] = genotype
    network.normalisation = vectors
    for _ in range(3):
        observation = 4 * rng.standard_normal(spec.inputs)
        network.observation = observation
        action, activations = reference.step(observation)
        assert network.step() == pytest.approx(action, rel=1e-12, abs=1e-12)
        assert network.activations == pytest.approx(activations, rel=1e-12, abs=1e-12)
    assert network.neurons == (read(spec), spec.outputs * spec.nbins)


@pytest.mark.slow
@REPEATABLE
@given(convolutional_specs(), st.integers(0, 2**32))
def test_convolutions_are_those_of_torch(spec, seed):
    torch = pytest.importorskip("torch")
    rng = np.random.default_rng(seed)
    genotype = random_genotype(spec, rng, 2.0)
    parts = parse(spec, genotype)
    network = Network(spec)
    network.parameters[:] = genotype
    network.observation[:] = observation = rng.uniform(0, 1, spec.inputs)
    network.step()
    x = torch.tensor(observation.reshape(1, *spec.image))  # normalisation does nothing yet
    activation = {1: torch.sigmoid, 2: torch.tanh, 3: lambda x: x, 5: torch.relu}[spec.afunction]
    for i, stride in enumerate(spec.strides):
        weights, bias = (torch.tensor(parts[f"filters{i}{end}"]) for end in ("", " bias"))
        x = activation(torch.nn.functional.conv2d(x, weights, bias, stride))
    assert x.shape[1:] == planes(spec)[-1]
    features = network.activations[: network.neurons[0]]
    np.testing.assert_allclose(features, x.numpy().ravel(), rtol=1e-5, atol=1e-12)


def test_sums_have_the_order_of_the_row():
    """Bias, then one product after another, channel by channel and row by row: bit for bit."""
    spec = spec_of((3, 8, 9), (5,), (4,), (2,), bias=1, afunction=3, nhiddens=0, out_type=3)
    rng = np.random.default_rng(1)
    network = Network(spec)
    network.parameters[:] = genotype = random_genotype(spec, rng, 3.0)
    network.observation[:] = observation = rng.uniform(-1, 1, spec.inputs)
    network.step()
    parts, image, features = parse(spec, genotype), observation.reshape(spec.image), []
    for f in range(5):
        for y in range(3):
            for x in range(3):
                under = image[:, 2 * y : 2 * y + 4, 2 * x : 2 * x + 4].ravel()
                total = float(parts["filters0 bias"][f])
                for weight, value in zip(parts["filters0"][f].ravel(), under, strict=True):
                    total += float(weight) * float(value)
                features.append(total)
    assert network.activations[:45].tolist() == features
    shuffled = sum(float(w) * float(v) for w, v in zip(parts["filters0"][4].ravel(), under))  # noqa: B905
    assert shuffled + float(parts["filters0 bias"][4]) != features[-1]  # so the order tells


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"image": ()}, "architecture is 4 .* images"),
        ({"image": (1, 2)}, "channels, height and width"),
        ({"image": (1, 2, 0)}, "from 1 to"),
        ({"image": (100, 1000, 1000)}, "a million"),
        ({"filters": (3,)}, "number each"),
        ({"filters": (), "kernels": (), "strides": ()}, "number each"),
        ({"filters": (1,) * 17, "kernels": (1,) * 17, "strides": (1,) * 17}, "at most 16"),
        ({"kernels": (3, 4)}, "kernel of convolutional layer 2 is 4 x 4, .* 3 x 2 only"),
        ({"kernels": (8, 1)}, "kernel of convolutional layer 1 is 8 x 8, .* 7 x 6 only"),
        ({"strides": (0, 1)}, "from 1 to 1000"),
        ({"filters": (1001, 1)}, "from 1 to 1000"),
        ({"image": (1, 900, 900), "kernels": (1, 1), "strides": (1, 1)}, "too large"),
        ({"afunction": 4}, "afunction is 4"),
        ({"nhiddens": 10000, "nlayers": 3}, "too large"),
    ],
)  # fmt: skip
def test_what_cannot_be_built(changes, words):
    with pytest.raises(ValueError, match=words) as error:
        spec_of(**changes)
    assert re.fullmatch(r"\S[^\n]*\.", str(error.value))


# images


@pytest.mark.parametrize(
    ("shape", "planes", "place"),
    [
        ((5, 6), (1, 5, 6), lambda c, y, x: (y, x)),
        ((5, 6, 3), (3, 5, 6), lambda c, y, x: (y, x, c)),
        ((4, 5, 6), (4, 5, 6), lambda c, y, x: (c, y, x)),
        ((4, 4, 4), (4, 4, 4), lambda c, y, x: (y, x, c)),
        ((2, 5, 6, 3), (6, 5, 6), lambda c, y, x: (c // 3, y, x, c % 3)),
        ((2, 3, 5, 6), (6, 5, 6), lambda c, y, x: (c // 3, c % 3, y, x)),
    ],
)
def test_where_the_channels_are(shape, planes, place):
    observation = np.arange(np.prod(shape), dtype=float)
    image, written = Image(shape, 255.0), np.zeros(observation.size)
    assert image.planes == planes
    image.write(observation, written)
    written = written.reshape(planes)
    for c, y, x in np.ndindex(planes):
        assert written[c, y, x] == observation.reshape(shape)[place(c, y, x)] / 255


def test_a_policy_sees_the_picture():
    name = "tiny_envs:Picture-v0"
    problem = problems.make(name)
    policy = Policy(name, problem.interface, config.PolicyConfig(**POLICY))
    spec = policy.spec
    assert (spec.image, spec.filters, spec.kernels, spec.strides) == (
        (3, 40, 40), (4, 6), (8, 3), (4, 2)
    )  # fmt: skip
    genotype = policy.initial(1)
    reference = ReferenceNetwork(spec, genotype)
    [*moments] = problem.play(policy, genotype, None, 3, 0, 10)
    assert len(moments) > 3
    for moment in moments:
        picture = moment.observation.reshape(40, 40, 3)
        assert picture.max() == 200
        action, _ = reference.step(picture.transpose(2, 0, 1).ravel() / 255)
        assert moment.action == pytest.approx(0.4 * action, abs=1e-6)  # the limits of its space


# evolution


@pytest.mark.slow
@pytest.mark.parametrize(("algo", "normalize"), [("SSS", 0), ("OpenAI-ES", 1), ("sNES", 0)])
def test_they_evolve_alike_with_workers_and_resumed(algo, normalize, tmp_path):
    policy = POLICY | {"normalize": normalize}
    own = experiment(tmp_path, "tiny_envs:Picture-v0", algo, policy, maxmsteps=0.0006)
    assert run_seeds(own, tmp_path / "whole")
    assert run_seeds(own, tmp_path / "parts", steps=300)
    workers = 2 if algo == "SSS" else 1
    assert run_seeds(own, tmp_path / "parts", workers=workers, resume=True)
    assert same(tmp_path / "whole", tmp_path / "parts")


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"kernels": "8, 4"}, None),
        ({"kernels": "41, 3"}, ["convolutional layer 1 is 41 x 41", "40 x 40 only"]),
        ({"kernels": "8"}, ["filters = 4, 6; kernels = 8; strides = 4, 2", "as many numbers"]),
        ({"kernels": "8, x"}, ["8, x is not a list of whole numbers", "16, 32"]),
        ({"kernels": "8, 1001"}, "8, 1001 is not a list of whole numbers from 1 to 1000"),
        ({"strides": "4,"}, "4, is not a list"),
        ({"filters": "0, 3"}, "0, 3 is not a list"),
        ({"filters": ""}, "filters has no value: it needs whole numbers"),
        ({"architecture": 0}, "filters = 4, 6 needs architecture = 4"),
        ({"afunction": 4}, "5 (relu)"),
        ({"nbins": 2, "nlayers": 2}, None),
    ],
)
def test_experiment_files(changes, says, tmp_path, refused, command):
    policy = POLICY | {"maxsteps": 3, "episodes": 1, "pepisodes": 1} | changes
    ini = write_experiment(tmp_path, "tiny_envs:Picture-v0", policy=policy, maxmsteps=0.00001)
    if says is None:
        code, _, errors = command("es", "-f", ini, "-o", tmp_path / "run")
        assert (code, errors) == (0, "")
    else:
        refused("es", "-f", ini, "-o", tmp_path / "run", says=says)
        assert not (tmp_path / "run").exists()


# Atari's games


@pytest.fixture
def pong():
    pytest.importorskip("ale_py")
    pytest.importorskip("cv2")
    around = "AtariPreprocessing(screen_size=42), FrameStackObservation(stack_size=2)"
    return problems.make("ALE/Pong-v5", wrappers=around)


@pytest.mark.slow
def test_an_episode_of_pong_does_not_depend_on_those_before(pong):
    policy = Policy("Pong", pong.interface, config.PolicyConfig(**POLICY))
    genotypes = np.array([policy.initial(1, i) for i in range(2)])
    episodes = Episodes.of(np.array([7, 7], dtype=np.uint64), 2)

    def fitness(chosen):
        return pong.evaluate(policy, genotypes, None, episodes.select(chosen), 120).fitness

    whole = fitness(slice(None))
    assert (fitness(slice(2, 4)) == whole[2:]).all() and (fitness(slice(0, 1)) == whole[0]).all()
    assert (whole <= -1).all()
    pong.close()


def test_what_atari_needs(tmp_path, command, monkeypatch):
    pytest.importorskip("ale_py")
    monkeypatch.setitem(sys.modules, "cv2", None)
    ini = write_experiment(tmp_path, "ALE/Pong-v5")
    ini.write_text(ini.read_text().replace("algo =", "wrappers = AtariPreprocessing\nalgo ="))
    code, _, errors = command("es", "-f", ini, "-o", tmp_path / "run")
    sentence = errors.splitlines()[-1]  # the emulator's banner may stand above it
    assert code == 2 and "AtariPreprocessing needs a package" in sentence
    assert "opencv" in sentence
