"""Random networks for hypothesis."""

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from botschool.net import NetworkSpec
from reference_network import (
    CONVOLUTIONAL,
    FEEDFORWARD,
    architecture_of,
    genotype_length,
    hidden_sizes,
    kernels,
    read,
)

# The same examples every time: a test that fails does so for everyone.
REPEATABLE = settings(deadline=None, derandomize=True, database=None, max_examples=100)


HIDDEN_ACTIVATIONS = st.sampled_from([1, 2, 3, 5])


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
        "afunction": draw(HIDDEN_ACTIVATIONS),
        "out_type": draw(st.integers(1, 5)),
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


@st.composite
def convolutional_specs(draw):
    """A NetworkSpec of an image of a few pixels, in one or several layers."""
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
    """Gaussian parameters whose size keeps the gain of every layer, and so rounding errors, small.

    Log standard deviations of the action noise are so low that the noise is far below rounding.
    """
    senders = read(spec) + sum(hidden_sizes(spec)) + spec.outputs * spec.nbins
    senders += sum(int(np.prod(shape[1:])) for shape in kernels(spec))
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
