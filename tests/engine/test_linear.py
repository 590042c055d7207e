"""botschool.linear against numpy, whose own bits may differ from machine to machine."""

import numpy as np
import pytest

from botschool.linear import eigen, exp, log, product, weighted

RNG = np.random.default_rng(5)


def symmetric(n, condition=10.0):
    q, _ = np.linalg.qr(RNG.standard_normal((n, n)))
    matrix = (q * np.geomspace(1, condition, n)) @ q.T
    return (matrix + matrix.T) / 2


MATRICES = {
    "one": np.array([[-3.0]]),
    "two": np.array([[2.0, 1], [1, -2]]),
    "zero": np.zeros((4, 4)),
    "unit": np.eye(5),
    "diagonal": np.diag([3.0, -1, 2, 2, 0]),
    "of ones": np.ones((6, 6)),
    "tridiagonal": np.diag([2.0] * 7) - np.diag([1.0] * 6, 1) - np.diag([1.0] * 6, -1),
    "three": symmetric(3),
    "even": symmetric(20, 1e3),
    "odd": symmetric(33, 1e12),
    "large": symmetric(90, 1e6),
    "huge numbers": 1e200 * symmetric(6),
    "tiny numbers": 1e-200 * symmetric(6),
}


@pytest.mark.parametrize("name", MATRICES)
def test_eigenvectors_are_those_of_the_matrix(name):
    matrix = MATRICES[name]
    n, size = len(matrix), np.abs(matrix).max() or 1
    values, rows = eigen(matrix)
    assert np.all(np.diff(values) >= 0)
    np.testing.assert_allclose(rows @ rows.T, np.eye(n), atol=1e-13 * n)
    rebuilt = (rows.T * (values / size)) @ rows
    np.testing.assert_allclose(rebuilt, matrix / size, atol=1e-13 * n)
    np.testing.assert_allclose(values / size, np.linalg.eigvalsh(matrix / size), atol=1e-13 * n)


def test_only_the_upper_triangle_is_read():
    matrix = symmetric(7)
    for one, other in zip(eigen(matrix), eigen(np.triu(matrix)), strict=True):
        assert np.array_equal(one, other)


@pytest.mark.parametrize("shape", [(1, 1, 1), (2, 3, 4), (3, 5, 8), (5, 2, 17), (16, 72, 72)])
def test_products(shape):
    rows, inner, columns = shape
    a, b = RNG.standard_normal((rows, inner)), RNG.standard_normal((inner, columns))
    np.testing.assert_allclose(product(a, b), a @ b, rtol=1e-12, atol=1e-13)
    # parts of other arrays and other types
    np.testing.assert_allclose(product(b.T, a.T), (a @ b).T, rtol=1e-12, atol=1e-13)
    assert np.array_equal(product(np.ones((2, 3), int), np.ones((3, 1), int)), [[3.0], [3.0]])
    weights = RNG.standard_normal(rows)
    np.testing.assert_allclose(weighted(weights, a), weights @ a, rtol=1e-12, atol=1e-13)


def test_products_are_summed_in_order():
    """In any other order, or with fewer roundings, these sums are others."""
    a, b = RNG.standard_normal((3, 50)), RNG.standard_normal((50, 19))
    made = product(a, b)
    for i in range(3):
        for j in range(19):
            total = 0.0
            for k in range(50):
                total += a[i, k] * b[k, j]
            assert made[i, j] == total


def test_exp_and_log():
    x = np.concatenate([RNG.uniform(-700, 700, 2000), RNG.normal(size=2000), [0.0]])
    np.testing.assert_allclose(exp(x), np.exp(x), rtol=5e-16)
    assert exp([0.0])[0] == 1 and log([1.0])[0] == 0
    y = np.exp(RNG.uniform(-300, 300, 2000))
    np.testing.assert_allclose(log(y), np.log(y), rtol=5e-16, atol=5e-16)


def test_wrong_shapes_are_refused():
    with pytest.raises(ValueError, match="3 columns cannot be multiplied by one of 2 rows"):
        product(np.ones((2, 3)), np.ones((2, 3)))
    with pytest.raises(ValueError, match="not square"):
        eigen(np.ones((2, 3)))
    with pytest.raises(ValueError, match="not finite"):
        eigen(np.full((2, 2), np.nan))
