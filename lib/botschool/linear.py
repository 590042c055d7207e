"""Linear algebra whose bits are the same on every machine: sums have a fixed order.

numpy hands products and decompositions to BLAS and LAPACK, whose last bits depend on the library,
on its threads and on the instruction set; its `exp` and `log` have variants too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from botschool import _core


def _doubles(values: ArrayLike) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float64)


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a @ b of two matrices, shapes (rows, inner) and (inner, columns)."""
    return _core.product(_doubles(a), _doubles(b))


def eigen(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues of a symmetric matrix, rising, and its eigenvectors as rows.

    Only the upper triangle is read. Raises ValueError if an element is not finite.
    """
    return _core.symmetric_eigen(_doubles(matrix))


def exp(values: ArrayLike) -> np.ndarray:
    """e to the power of each value of a vector; between exp(-708) and exp(709)."""
    return _core.exp(_doubles(values))


def log(values: ArrayLike) -> np.ndarray:
    """Natural logarithm of each value of a vector; they must be positive."""
    return _core.log(_doubles(values))


def power(base: float, exponent: int) -> float:
    """Return a number between 0 and 1 to a power, rounded once (above 1e-300)."""
    return _core.power(base, exponent)


def weighted(weights: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return the sum of the rows, each times its weight, in the order of the rows."""
    return np.add.reduce(weights[:, None] * rows, axis=0)
