"""Messages between caller and untrusted code: what arrives is what was sent, or is refused."""

import json
import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from botschool.sandbox import protocol

numbers = arrays.arrays(
    st.sampled_from(["<f8", "<f4", "<i8", "<u1", ">i4", "|b1", "<f2"]),
    arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5),
)
text = st.text(st.characters(exclude_categories=["Cs"]))
keys = text.filter(lambda key: key != "__array__")
plain = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**80), 2**80) | st.floats() | text | numbers,
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(keys, inner, max_size=5),
    max_leaves=20,
)


def same(one, two):
    if isinstance(one, np.ndarray):
        return one.dtype == two.dtype and one.shape == two.shape and one.tobytes() == two.tobytes()
    if isinstance(one, list):
        return len(one) == len(two) and all(map(same, one, two))
    if isinstance(one, dict):
        return one.keys() == two.keys() and all(same(one[key], two[key]) for key in one)
    return type(one) is type(two) and (one == two or one != one)


@pytest.mark.slow
@given(plain)
def test_round_trip(value):
    assert same(value, protocol.unpack(protocol.pack(value)))


def test_tuples_and_numpy_numbers():
    sent = (np.float32(0.5), np.int64(3), np.bool_(True), {1: ()})
    assert protocol.unpack(protocol.pack(sent)) == [0.5, 3, True, {"1": []}]


class Sly(float):
    pass


@pytest.mark.parametrize(
    "value",
    [object(), Sly(1), 1j, b"1", {1.5: 2}, {None: 1}, {"x"}, 10**400, np.array([object()]),
     np.array(["a"]), np.array([1j]), np.longdouble(1), np.zeros(2**24), range(3), "x" * 2**24],
    ids=lambda value: type(value).__name__,
)  # fmt: skip
def test_not_plain(value):
    with pytest.raises(protocol.NotPlain):
        protocol.pack([value])


def test_deep_and_circular_lists_are_refused():
    circle = []
    circle.append(circle)
    with pytest.raises(protocol.NotPlain):
        protocol.pack(circle)


def message(json_text, data=b""):
    if not isinstance(json_text, bytes):
        json_text = json.dumps(json_text).encode()
    return len(json_text).to_bytes(8, "little") + len(data).to_bytes(8, "little") + json_text + data


@pytest.mark.parametrize(
    ("body", "data"),
    [
        (b"", b""), (b"[", b""), (b"[" * 10**6, b""), (b"\xff", b""), (b"9" * 5000, b""),
        (b"[" * 500 + b"]" * 500, b""), ([1], b"left over"), ({"__array__": 3}, b""),
        ({"__array__": ["<f8", [2]]}, b"12345678"), ({"__array__": ["<f8", [-1]]}, b""),
        ({"__array__": ["<f8", [1.0]]}, b"12345678"), ({"__array__": ["O", [1]]}, b"12345678"),
        ({"__array__": ["<f8", [2**62, 2**62]]}, b""), ({"__array__": ["<f8", [0, 2**70]]}, b""),
        ({"__array__": ["i4,i4", [1]]}, b"12345678"), ({"__array__": ["<f8", "11"]}, b"12345678"),
        ({"__array__": ["<f8", [1] * 100]}, b"12345678"), ({"__array__": [{"a": 1}, [1]]}, b""),
    ],
)  # fmt: skip
def test_damaged_messages(body, data):
    with pytest.raises(ValueError, match="damaged"):
        protocol.unpack(message(body, data))


@given(st.binary(max_size=200))
def test_any_bytes_are_a_value_or_an_error(data):
    try:
        protocol.unpack(data)
    except ValueError as error:
        assert "damaged" in str(error)


def test_receiving_is_bounded():
    reading, writing = os.pipe()
    with pytest.raises(TimeoutError):
        protocol.receive(reading, 0.1)
    os.write(writing, b"\0" * 5)
    with pytest.raises(TimeoutError):
        protocol.receive(reading, 0.1)
    os.write(writing, b"\xff" * 16)
    with pytest.raises(ValueError, match="too long"):
        protocol.receive(reading, 1)
    os.close(writing)
    assert protocol.receive(reading, 1) is None
    os.close(reading)


@pytest.mark.slow
def test_too_many_arrays():
    with pytest.raises(protocol.NotPlain, match="arrays, which are too many"):
        protocol.pack([np.zeros(0)] * 60_000)
    text = json.dumps([{"__array__": ["|u1", [0]]}] * 60_000).encode()
    with pytest.raises(ValueError, match="damaged"):
        protocol.unpack(len(text).to_bytes(8, "little") + bytes(8) + text)
