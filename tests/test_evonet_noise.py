"""Action noise, and the running statistics that normalise observations."""

import numpy as np
import pytest

from botschool import _core
from botschool.net import Network, NetworkSpec


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


@pytest.mark.parametrize("architecture", [0, 1, 2, 3])
@pytest.mark.parametrize("kind", [1, 2])
def test_noise_is_on_the_action_alone(kind, architecture):
    noisy = noisy_network(kind, architecture=architecture)
    quiet = noisy_network(0, architecture=architecture)
    quiet.parameters[:] = noisy.parameters[: len(quiet.parameters)]
    for _ in range(5):
        noisy.step()
        quiet.step()
        assert np.array_equal(noisy.activations, quiet.activations)
        assert np.all(noisy.action != quiet.action)
        assert np.array_equal(quiet.action, quiet.activations[-3:])


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


def test_noise_of_size_zero_is_none():
    assert not noise_of(noisy_network(1, action_noise_range=0), 10).any()


def test_noise_is_added_to_the_chosen_bin():
    network = noisy_network(1, action_noise_range=0.01, nbins=3, low=-1, high=1)
    clean = np.round(network.step() * 1).copy()
    assert set(clean.tolist()) <= {-1, 0, 1}
    assert np.all(np.abs(network.action - clean) < 0.06)
    assert np.all(network.action != clean)


def test_moments_start_as_if_nothing_had_to_change():
    moments = _core.Moments(3)
    assert moments.state.tolist() == [0.01] + [0] * 3 + [0.01] * 3
    assert moments.vectors().tolist() == [0] * 3 + [1] * 3


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


@pytest.mark.parametrize("values", [[0, 0], [0, 0, 1, 0], [0, 0, 1, -1], [np.nan, 0, 1, 1], "abcd"])
def test_network_refuses_bad_normalisation(values):
    network = Network(NetworkSpec(inputs=2, outputs=1, normalize=1))
    with pytest.raises((ValueError, TypeError), match="normalisation"):
        network.normalisation = values
