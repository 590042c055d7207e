"""No argument crashes the engine: it raises, or it does what was asked."""

import numpy as np
import pytest

from botschool import _core
from botschool.problems import Episodes
from test_engine import policy_of, same


def good_arguments(policy):
    return {
        "genotypes": np.zeros((3, policy.genotype_size)),
        "normalisation": np.repeat([0.0, 1.0], policy.spec.inputs),
        "candidates": np.array([[0, 2]], np.int32),
        "seeds": np.array([1, 2], np.uint64),
        "episodes": np.array([0, 0], np.uint32),
        "collect": np.array([0, 1], np.uint8),
        "limit": 10,
        "threads": 1,
    }


BAD = {
    "genotypes": [
        lambda x: x[:, 1:].copy(),
        lambda x: x[0],
        lambda x: x[:0],
        lambda x: x[:2].copy(),
        lambda x: x[None],
        lambda x: np.zeros((3, 0)),
        lambda x: None,
        lambda x: "genotypes",
    ],
    "normalisation": [lambda x: x[1:], lambda x: np.append(x, 1), lambda x: x[None], lambda x: 3],
    "candidates": [
        lambda x: x[:, 1:].copy(),
        lambda x: x[:0],
        lambda x: np.append(x, 0).astype(np.int32)[None],
        lambda x: np.array([[0, 3]], np.int32),
        lambda x: np.array([[-1, 0]], np.int32),
        lambda x: np.array([[0, 2**31 - 1]], np.int32),
        lambda x: np.array([[0, -(2**31)]], np.int32),
        lambda x: np.repeat(x, 2, axis=0),
        lambda x: x[0],
        lambda x: None,
    ],
    "seeds": [lambda x: x[1:], lambda x: np.append(x, x), lambda x: x[None], lambda x: None],
    "episodes": [lambda x: x[1:], lambda x: np.append(x, x), lambda x: x[None], lambda x: None],
    "collect": [lambda x: x[1:], lambda x: np.append(x, x), lambda x: x[None], lambda x: 1],
    "limit": [lambda x: 0, lambda x: -1, lambda x: 2**31, lambda x: "10", lambda x: None],
    "threads": [lambda x: 0, lambda x: -1, lambda x: 2**40, lambda x: None, lambda x: 0.5],
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_refused(name):
    policy = policy_of("CartPole-v1", "recurrent")
    engine = _core.Engine("CartPole-v1", policy.spec.core())
    good = good_arguments(policy)
    engine.evaluate(**good)
    for number, spoil in enumerate(BAD[name]):
        with pytest.raises((ValueError, TypeError, OverflowError)):
            engine.evaluate(**(good | {name: spoil(good[name])}))
            pytest.fail(f"{name} {number} was accepted")


@pytest.mark.parametrize("name", ["genotypes", "candidates", "seeds", "episodes", "collect"])
@pytest.mark.parametrize(
    "dtype", [np.float32, np.complex128, np.int16, object, "U3", "datetime64[s]"]
)
def test_other_types_are_refused_or_converted(name, dtype):
    policy = policy_of("CartPole-v1", "recurrent")
    engine = _core.Engine("CartPole-v1", policy.spec.core())
    good = good_arguments(policy)
    try:
        result = engine.evaluate(**(good | {name: good[name].astype(dtype)}))
    except (ValueError, TypeError):
        return
    assert same(result, engine.evaluate(**good))


def test_empty_batch():
    policy = policy_of("CartPole-v1")
    engine = _core.Engine("CartPole-v1", policy.spec.core())
    none = Episodes.of(np.arange(0), 3)
    genotypes, candidates = np.zeros((0, policy.genotype_size)), none.candidate[None]
    for threads in (1, 4):
        fitness, steps, moments = engine.evaluate(
            genotypes, None, candidates, none.seed, none.episode, np.zeros(0, np.uint8), 10, threads
        )
        assert fitness.shape == steps.shape == (0,) and moments.shape == (0, 8)


def test_engine_refuses_what_does_not_fit():
    spec = policy_of("CartPole-v1").spec.core()
    with pytest.raises(ValueError, match="no native problem 'CartPole-v9'"):
        _core.Engine("CartPole-v9", spec)
    with pytest.raises(ValueError, match="no instruction set 'mmx'"):
        _core.Engine("CartPole-v1", spec, "mmx")
    with pytest.raises(ValueError, match="6 inputs and 3 outputs"):
        _core.Engine("Acrobot-v1", spec)
    with pytest.raises(ValueError, match="no native problem"):
        _core.make_stepper("")
    spec.nhiddens = -1
    with pytest.raises(ValueError, match="nhiddens is -1"):
        _core.Engine("CartPole-v1", spec)


@pytest.mark.parametrize("bad", [np.zeros(3), np.zeros((2, 100)), None, "genotype", 3.0])
def test_record_refuses_bad_genotypes(bad):
    policy = policy_of("CartPole-v1")
    engine = _core.Engine("CartPole-v1", policy.spec.core())
    with pytest.raises((ValueError, TypeError)):
        engine.record(bad, None, 1, 0, 10)
