"""Random numbers of Python: numpy's draws, by our own C++ (lib/evolution/normals.hpp)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import Generator, Philox

from botschool import _core
from botschool.seeds import generator
from test_page import core_of, experiment_of, node

WORDS = st.integers(0, 2**64 - 1)
COUNTS = st.one_of(
    st.integers(1, 100), st.integers(1, 2**63 - 1), st.integers(2**32 - 2, 2**32 + 2)
)
CALLS = st.one_of(
    st.tuples(st.just("standard_normal"), st.one_of(st.none(), st.integers(0, 3000))),
    st.tuples(st.just("integers"), COUNTS),
    st.tuples(st.just("integers"), st.lists(COUNTS, min_size=1, max_size=5)),
    st.tuples(st.just("integers"), COUNTS, st.none(), st.just((2, 3))),
    st.tuples(st.just("integers"), st.just([3, 1, 2**40]), st.none(), st.just((4, 2, 3))),
    st.tuples(st.just("permutation"), st.integers(0, 300)),
    st.tuples(st.just("random"), st.integers(0, 9)),
    st.tuples(st.just("normal"), st.just(1.0), st.just(2.0), st.just(5)),
)


def numpy_s(seed, generation):
    """numpy's own generator of the same numbers."""
    return Generator(Philox(key=np.array([seed, generation], dtype=np.uint64)))


def arguments():
    """Numbers k / 2^53 in [0, 1): random ones, of each size, and beside sqrt(1/2) and 1."""
    rng = np.random.default_rng(1)
    whole = 2**53
    size = 2 ** rng.integers(0, 53, 200_000)
    edges = np.arange(-500, 500) + np.array([[whole // 2], [int(whole * (1 - math.sqrt(0.5)))]])
    k = np.concatenate(
        [rng.integers(0, whole, 600_000), size, whole - size, np.arange(500), edges.ravel()]
    )
    return k / whole


def logarithms(u):
    """log(1 - u) by our function."""
    found = u.copy()
    _core.log_of_rest(found)
    return found


def system_is_fused():
    """Whether this system's log1p has the bits of glibc's on a processor with fused operations."""
    u = arguments()[:20_000]
    return [math.log1p(-each) for each in u.tolist()] == logarithms(u).tolist()


SAME = pytest.mark.skipif(not system_is_fused(), reason="this system's log1p has other last bits")


def test_logarithms_are_right_to_the_last_place():
    u = arguments()
    exact = np.array([math.log1p(-each) for each in u.tolist()])
    assert (np.abs(logarithms(u) - exact) <= np.spacing(np.abs(exact))).all()


@pytest.mark.slow
@SAME
@given(WORDS, WORDS, st.lists(CALLS, max_size=8))
def test_calls_give_what_numpy_gives(seed, generation, calls):
    ours, theirs = generator(seed, generation), numpy_s(seed, generation)
    for name, *given_ in calls:
        one, other = getattr(ours, name)(*given_), getattr(theirs, name)(*given_)
        assert np.asarray(one).dtype == np.asarray(other).dtype
        np.testing.assert_array_equal(one, other)
    again = generator(0, 0)
    again.place = ours.place
    assert ours.integers(2**20) == theirs.integers(2**20) == again.integers(2**20)
    assert again.place == ours.place
    assert (again.standard_normal(600) == ours.standard_normal(600)).all()


def test_wrong_arguments_are_refused():
    numbers = generator(1, 0)
    for wrong in (0, -1, [3, 0]):
        with pytest.raises(ValueError):
            numbers.integers(wrong)
    with pytest.raises(ValueError):
        numbers.standard_normal(out=np.empty((4, 4))[:, 1])
    with pytest.raises(ValueError):
        numbers.standard_normal(3, out=np.empty(4))
    with pytest.raises(ValueError):
        numbers.place = (1, 0, 0, 2**32)
    assert numbers.standard_normal(3, dtype=np.float32).dtype == np.float32


@pytest.mark.slow
def test_a_page_draws_the_same(tmp_path):
    """A million draws and the logarithms of a sample, in WebAssembly."""
    u, count = arguments(), 1_000_000
    u.tofile(tmp_path / "u")
    script = f"""
    import {{ writeFileSync }} from "fs";
    const core = await Core.load(readFileSync("{core_of(experiment_of("CartPole-v1", "SSS"))}"));
    const place = core.c.allocate(8 * {count});
    const kept = (n) => new Float64Array(core.c.memory.buffer, place, n);
    core.c.normals(3, 5, place, {count});
    writeFileSync("{tmp_path}/normals", kept({count}));
    kept({u.size}).set(new Float64Array(new Uint8Array(readFileSync("{tmp_path}/u")).buffer));
    core.c.logarithms(place, {u.size});
    writeFileSync("{tmp_path}/logarithms", kept({u.size}));
    console.log("0");
    """
    node(tmp_path, script)
    drawn = generator(3, 5).standard_normal(count)
    assert (tmp_path / "normals").read_bytes() == drawn.tobytes()
    assert (tmp_path / "logarithms").read_bytes() == logarithms(u).tobytes()
