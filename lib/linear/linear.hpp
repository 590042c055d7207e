// Matrix products and eigenvectors whose operations have a fixed order, so that every machine gives
// the same bits; BLAS and LAPACK do not promise that. Matrices are stored row by row.
#pragma once

#include <cstddef>

namespace botschool {

/// result (rows, columns) = a (rows, inner) times b (inner, columns); each element is summed in the
/// order of `inner`.
void product(const double* a, const double* b, double* result, std::size_t rows, std::size_t inner,
             std::size_t columns);

/// Of a symmetric matrix (n, n), of which the upper triangle is read: its eigenvalues in rising
/// order, and as rows of `vectors` (n, n) their eigenvectors of length 1.
/// Throws std::invalid_argument if an element is not finite.
void symmetric_eigen(const double* matrix, std::size_t n, double* values, double* vectors);

}  // namespace botschool
