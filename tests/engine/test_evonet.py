"""The forward pass of policy networks against an independent one (reference_network.py)."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.net import Network, NetworkSpec, PyEvonet
from botschool.policies.policy import Policy
from reference_network import (
    ACTIVATIONS,
    REPEATABLE,
    ReferenceNetwork,
    binned,
    hidden_sizes,
    output_count,
    policy_choices,
    random_genotype,
    random_normalisation,
    specs,
)


def assert_close(actual, expected, tolerance):
    """Errors are relative to values above 1 and absolute below, as sums of such terms round."""
    actual, expected = np.asarray(actual), np.asarray(expected)
    error = np.abs(actual - expected) / np.maximum(1, np.abs(expected))
    assert actual.shape == expected.shape
    assert np.all(error <= tolerance), f"{error.max()} at {np.argmax(error)}"


@pytest.mark.slow
@REPEATABLE
@given(specs(), st.integers(0, 2**32), st.sampled_from([0.3, 1.0, 1.5]))
def test_network_agrees_with_the_reference(spec, seed, scale):
    rng = np.random.default_rng(seed)
    genotype, normalisation = random_genotype(spec, rng, scale), random_normalisation(spec, rng)
    network = Network(spec)
    network.parameters[:] = genotype
    reference = ReferenceNetwork(spec, genotype, normalisation)
    network.normalisation = normalisation
    for _ in range(2):
        network.reset()
        reference.reset()
        for observation in 4 * rng.standard_normal((6, spec.inputs)):
            network.observation = observation
            action, activations = reference.step(observation)
            assert_close(network.step(), action, 1e-12)
            assert_close(network.activations, activations, 1e-12)


@REPEATABLE
@given(specs(), st.integers(1, 4), st.booleans(), st.integers(0, 2**32))
def test_several_networks_agree_with_the_reference(spec, count, heterogeneous, seed):
    rng = np.random.default_rng(seed)
    genotypes = [random_genotype(spec, rng) for _ in range(count if heterogeneous else 1)]
    normalisation = random_normalisation(spec, rng)
    together = py_evonet(spec, count, heterogeneous)
    parameters = np.concatenate(genotypes)
    inputs = np.empty(count * spec.inputs, np.float32)
    outputs = np.empty(count * spec.outputs, np.float32)
    neurons = spec.inputs + sum(hidden_sizes(spec)) + output_count(spec)
    activations = np.empty(count * neurons)
    assert together.computeParameters() == len(parameters)
    together.copyGenotype(parameters)
    together.copyInput(inputs)
    together.copyOutput(outputs)
    together.copyNeuronact(activations)
    together.copyNormalization(normalisation)
    together.setNormalizationVectors()
    references = [
        ReferenceNetwork(spec, genotypes[n if heterogeneous else 0], normalisation)
        for n in range(count)
    ]
    together.resetNet()
    assert not activations.any()
    for _ in range(4):
        inputs[:] = rng.standard_normal(len(inputs))
        together.updateNet()
        expected = [r.step(x) for r, x in zip(references, np.split(inputs, count), strict=True)]
        assert_close(activations, np.concatenate([a for _, a in expected]), 1e-12)
        # actions are single precision here
        assert_close(outputs, np.concatenate([a for a, _ in expected]), 1e-7)


def py_evonet(spec, count=1, heterogeneous=False):
    """The original library's face of a spec: its nhiddens counts all layers."""
    return PyEvonet(
        count, int(heterogeneous), spec.inputs, spec.nhiddens * spec.nlayers, spec.outputs,
        spec.nlayers, spec.nhiddens2, spec.bias, spec.architecture, spec.afunction, spec.out_type,
        spec.winit, spec.clip, spec.normalize, spec.action_noise, spec.action_noise_range,
        spec.wrange, spec.nbins, spec.low, spec.high,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", problems.names())
@REPEATABLE
@given(policy_choices(), st.sampled_from([1, 1, 2, 5]), st.integers(0, 2**32))
def test_lanes_of_evolution_agree_with_the_reference(name, choices, nbins, seed):
    rng = np.random.default_rng(seed)
    problem = problems.make(name)
    discrete = problem.interface.discrete
    robots = problem.interface.robots
    config = PolicyConfig(nrobots=robots, nbins=1 if discrete else nbins, **choices)
    policy = Policy(name, problem.interface, config)
    spec = policy.spec
    # memories fade at this scale, so what single precision loses does not grow over the steps
    genotypes = np.array([random_genotype(spec, rng, 0.5) for _ in range(robots)])
    normalisation = random_normalisation(spec, rng)
    bodies = rng.standard_normal((robots, problem.interface.morphology))
    tape = problem.engine(policy).record(np.hstack([genotypes, bodies]), normalisation, seed, 3, 40)
    assert 0 < len(tape["rewards"]) <= 40
    columns = [tape[kind] for kind in ("observations", "actions", "activations")]
    for robot, genotype in enumerate(genotypes):
        reference = ReferenceNetwork(spec, genotype, normalisation)
        agrees(reference, discrete, *[np.split(c, robots, axis=1)[robot] for c in columns])


def agrees(reference, discrete, *columns):
    """A robot's observations, actions and activations are those of its reference network."""
    spec = reference.spec
    for observation, action, activations in zip(*columns, strict=True):
        _, expected = reference.step(observation)
        if spec.out_type == 4 and np.any(np.abs(reference.net_output - 0.5) < 1e-4):
            break  # single precision may decide otherwise, and then remember it
        assert_close(activations, expected, 1e-4)
        outputs = activations[-output_count(spec) :]
        if discrete:
            assert action == list(outputs).index(max(outputs))
        else:
            assert_close(action, binned(spec, outputs), 1e-6)


@REPEATABLE
@given(policy_choices(), st.integers(0, 2**32))
def test_lanes_of_evolution_agree_with_the_network(choices, seed):
    problem = problems.make("Pendulum-v1")
    config = PolicyConfig(nrobots=1, action_noise=1, action_noise_range=0.3, **choices)
    policy = Policy("Pendulum-v1", problem.interface, config)
    rng = np.random.default_rng(seed)
    genotype = random_genotype(policy.spec, rng, 0.5)
    normalisation = random_normalisation(policy.spec, rng) if config.normalize else None
    policy.load(genotype, normalisation)
    policy.reset(seed, 7)
    for moment in problem.play(policy, genotype, normalisation, seed, 7, 40):
        action = policy.act(moment.observation)
        if policy.spec.out_type == 4 and np.sum(np.abs(moment.action - action)) > 1:
            break
        assert_close(moment.action, action, 1e-4)


@pytest.mark.parametrize("kind", ACTIVATIONS)
def test_activations_at_their_edges(kind):
    network = Network(NetworkSpec(inputs=1, outputs=1, nhiddens=0, out_type=kind))
    network.parameters[:] = 1
    for x in (0, 0.5, np.nextafter(0.5, 0), -0.5, 1e-300, 1e-9, 20, -20, 700, -700, 1e6, -1e6):
        network.observation[:] = x
        expected = float(ACTIVATIONS[kind](np.float64(x)))
        # below 1e-300 our logistic is as good as 0
        assert network.step()[0] == pytest.approx(expected, rel=1e-14, abs=1e-300)


def test_clip_and_normalisation():
    network = Network(NetworkSpec(inputs=2, outputs=1, nhiddens=0, normalize=1, clip=1))
    network.normalisation = [1, -2, 0.5, 10]
    for observation, seen in [
        ((1, -2), (0, 0)),
        ((2, 8), (2, 1)),
        ((3.5, 48), (5, 5)),
        ((3.6, 1e9), (5, 5)),
        ((-1.6, -1e9), (-5, -5)),
    ]:
        network.observation = observation
        network.step()
        assert network.activations[:2] == pytest.approx(seen, abs=1e-15)


# Every architecture with every activation of outputs, and inputs as they come, clipped, normalised.
COMBINATIONS = list(itertools.product(range(4), range(1, 6), range(2), range(2)))


@pytest.mark.parametrize(("architecture", "out_type", "clip", "normalize"), COMBINATIONS)
def test_combinations(architecture, out_type, clip, normalize):
    choices = {
        "nhiddens": 6, "bias": 1, "architecture": architecture, "out_type": out_type, "clip": clip,
        "normalize": normalize,
    }  # fmt: skip
    rng = np.random.default_rng(1)

    network = Network(NetworkSpec(inputs=3, outputs=4, **choices))
    genotype = random_genotype(network.spec, rng)
    normalisation = random_normalisation(network.spec, rng)
    network.parameters, network.normalisation = genotype, normalisation
    reference = ReferenceNetwork(network.spec, genotype, normalisation)
    for observation in 40 * rng.standard_normal((20, 3)):
        network.observation = observation
        action, activations = reference.step(observation)
        assert_close(network.step(), action, 1e-12)
        assert_close(network.activations, activations, 1e-12)

    problem = problems.make("Pendulum-v1")
    policy = Policy("Pendulum-v1", problem.interface, PolicyConfig(nrobots=1, **choices))
    genotype = random_genotype(policy.spec, rng, 0.5)
    normalisation = np.array([0.1, -0.1, 0.5, 0.2, 0.1, 1.5])
    tape = problem.engine(policy).record(genotype[None], normalisation, 2, 0, 100)
    assert np.abs(tape["observations"]).max() > 5, "nothing to clip"
    reference = ReferenceNetwork(policy.spec, genotype, normalisation)
    agrees(reference, False, *[tape[kind] for kind in ("observations", "actions", "activations")])


def test_memory_ends_with_the_episode():
    rng = np.random.default_rng(5)
    for architecture in (1, 2, 3):
        spec = NetworkSpec(inputs=2, outputs=2, nhiddens=3, architecture=architecture)
        network = Network(spec)
        network.parameters[:] = random_genotype(spec, rng)
        network.observation = [1, 2]
        first, second = network.step().copy(), network.step().copy()
        assert not np.array_equal(first, second)
        network.reset()
        assert not network.activations.any() and not network.action.any()
        assert np.array_equal(network.step(), first)
        assert np.array_equal(network.step(), second)


# --- Action noise, and the running statistics that normalise observations.


def noise_of(network, steps):
    """Actions minus outputs, shape (steps, outputs)."""
    outputs = network.spec.outputs
    return np.array([network.step() - network.activations[-outputs:] for _ in range(steps)])


def noisy_network(action_noise, action_noise_range=0.3, **changes):
    network = Network(
        NetworkSpec(
            **({"inputs": 2, "outputs": 3, "nhiddens": 4, "out_type": 3} | changes),
            action_noise=action_noise,
            action_noise_range=action_noise_range,
        )
    )
    network.initialise(5)
    network.observation[:] = 0.3, -2
    return network


@pytest.mark.parametrize(
    ("kind", "deviations"), [(1, [0.3, 0.3, 0.3]), (2, [np.exp(-2), 1, np.exp(1.5)])]
)
def test_action_noise_is_gaussian(kind, deviations):
    network = noisy_network(kind)
    if kind == 2:
        network.parameters[-3:] = -2, 0, 1.5
    n = 20_000
    noise = noise_of(network, n) / deviations
    assert np.all(np.abs(noise.mean(axis=0)) < 5 / np.sqrt(n))
    assert np.all(np.abs(noise.std(axis=0) - 1) < 5 / np.sqrt(2 * n))
    assert np.all(np.abs((noise**4).mean(axis=0) - 3) < 5 * np.sqrt(96 / n))
    # independent of each other and from step to step
    both = np.hstack([noise[1:], noise[:-1]])
    correlation = np.corrcoef(both.T) - np.eye(6)
    assert np.all(np.abs(correlation) < 5 / np.sqrt(n))
    within = np.mean(np.abs(noise) < 1, axis=0)
    assert within == pytest.approx(0.6827, abs=0.02)


def test_noise_is_a_function_of_seed_episode_and_step():
    network, draws = noisy_network(1), set()
    for seed, episode in [(1, 0), (1, 1), (2, 0), (2**64 - 1, 0), (2**32, 2**32 - 1)]:
        network.seed(seed, episode)
        network.reset()
        noise = noise_of(network, 10)
        network.reset()  # an episode starts, the noise goes on
        assert not np.array_equal(noise_of(network, 10), noise)
        network.seed(seed, episode)
        assert np.array_equal(noise_of(network, 10), noise)
        other = noisy_network(1)
        other.seed(seed, episode)
        assert np.array_equal(noise_of(other, 10), noise)
        draws |= set(noise.ravel().tolist())
    assert len(draws) == 5 * 10 * 3


def test_moments_follow_the_rules():
    rng = np.random.default_rng(2)
    moments = _core.Moments(4)
    scale = np.array([1, 10, 0.001, 0])
    batches = [rng.normal(3, 1, size=(n, 4)) * scale for n in (1, 50, 7)]
    for x in batches:
        moments.add(len(x), x.sum(axis=0), (x**2).sum(axis=0))
    x = np.concatenate(batches)
    count, total, squares = len(x) + 0.01, x.sum(axis=0), (x**2).sum(axis=0) + 0.01
    mean = total / count
    deviation = np.sqrt(np.maximum(squares / count - mean**2, 0.01))
    assert moments.state == pytest.approx(np.concatenate([[count], total, squares]), rel=1e-12)
    assert moments.vectors() == pytest.approx(np.concatenate([mean, deviation]), rel=1e-12)
    assert moments.vectors()[-2:].tolist() == [0.1, 0.1]  # the floor
    restored = _core.Moments(4)
    restored.state = moments.state
    assert np.array_equal(restored.vectors(), moments.vectors())
    moments.reset()
    assert np.array_equal(moments.state, _core.Moments(4).state)


def test_network_normalises_with_the_vectors_in_use():
    network = Network(NetworkSpec(inputs=2, outputs=1, nhiddens=0, normalize=1))
    assert network.normalisation.tolist() == [0, 0, 1, 1]
    network.normalisation[:] = 7  # a copy
    network.observation = [3, -4]
    network.step()
    assert network.activations[:2].tolist() == [3, -4]
    network.normalisation = [1, 2, 0.5, 4]
    network.reset()  # an episode's start leaves them alone
    network.step()
    assert network.activations[:2].tolist() == [4, -1.5]
    plain = Network(NetworkSpec(inputs=2, outputs=1, nhiddens=0))
    plain.normalisation = [1, 2, 0.5, 4]
    plain.observation = [3, -4]
    plain.step()
    assert plain.activations[:2].tolist() == [3, -4]
