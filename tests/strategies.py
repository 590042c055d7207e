"""Random networks for hypothesis."""

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from botschool.net import NetworkSpec
from reference_network import FEEDFORWARD, architecture_of, genotype_length, hidden_sizes

# The same examples every time: a test that fails does so for everyone.
REPEATABLE = settings(deadline=None, derandomize=True, database=None, max_examples=100)


@st.composite
def layer_choices(draw):
    """Hyperparameters that make the shape of a network."""
    choice = {"architecture": draw(st.integers(0, 3)), "nhiddens": draw(st.integers(0, 7))}
    if choice["architecture"] == FEEDFORWARD:
        choice["nlayers"] = draw(st.integers(1, 4))
        if choice["nlayers"] == 2 and choice["nhiddens"] > 0:
            choice["nhiddens2"] = draw(st.integers(0, 2 * choice["nhiddens"] - 1))
    return choice


@st.composite
def policy_choices(draw):
    """Hyperparameters of a policy, without those that its problem decides and without noise."""
    flag = st.integers(0, 1)
    return draw(layer_choices()) | {
        "bias": draw(flag),
        "normalize": draw(flag),
        "clip": draw(flag),
        "afunction": draw(st.integers(1, 3)),
        "out_type": draw(st.integers(1, 4)),
    }


@st.composite
def specs(draw):
    """A NetworkSpec of a few neurons."""
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


def random_genotype(spec, rng, scale=1.0):
    """Gaussian parameters whose size keeps the gain of every layer, and so rounding errors, small.

    Log standard deviations of the action noise are so low that the noise is far below rounding.
    """
    senders = spec.inputs + sum(hidden_sizes(spec)) + spec.outputs * spec.nbins
    genotype = scale / np.sqrt(senders) * rng.standard_normal(genotype_length(spec))
    if spec.action_noise == 2:
        genotype[-spec.outputs :] = -200
    return genotype


def random_normalisation(spec, rng):
    """Means, then standard deviations."""
    return np.concatenate(
        [rng.normal(size=spec.inputs), np.exp(rng.uniform(-1, 2, size=spec.inputs))]
    )


def keeps_memory(spec) -> bool:
    """Whether a step depends on the ones before."""
    return architecture_of(spec) != FEEDFORWARD
