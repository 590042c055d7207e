"""Compute linear algebra with the same bits on every machine: sums have a fixed order.

numpy passes products and decompositions to BLAS and LAPACK, whose last bits depend on the library,
its threads and the instruction set. Its `exp` and `log` differ between machines, too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from botschool import _core


def _doubles(values: ArrayLike) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float64)


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the matrix product a @ b, shapes (rows, inner) and (inner, columns)."""
    return _core.product(_doubles(a), _doubles(b))


def eigen(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the eigenvalues of a symmetric matrix, rising, and its eigenvectors as rows.

    The function reads only the upper triangle. Raises ValueError if an element is not finite.
    """
    return _core.symmetric_eigen(_doubles(matrix))


def exp(values: ArrayLike) -> np.ndarray:
    """Return e to the power of each value of a vector, limited to exp(-708) ... exp(709)."""
    return _core.exp(_doubles(values))


def log(values: ArrayLike) -> np.ndarray:
    """Return the natural logarithm of each value of a vector of positive numbers."""
    return _core.log(_doubles(values))


def power(base: float, exponent: int) -> float:
    """Return a number between 0 and 1 to a power, rounded once (above 1e-300)."""
    return _core.power(base, exponent)


def weighted(weights: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return the sum of the rows, each times its weight, in the order of the rows."""
    return np.add.reduce(weights[:, None] * rows, axis=0)
