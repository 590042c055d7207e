#include "linear/linear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

namespace botschool {
namespace {

constexpr std::size_t kTile = 8;
constexpr int kRounds = 60;  // of the QR algorithm for an eigenvalue; two are usual

/// `height` rows of a product, of which sums of kTile columns stay in registers.
template <int height>
void product_rows(const double* a, const double* b, double* result, std::size_t inner,
                  std::size_t columns) {
  std::size_t j = 0;
  for (; j + kTile <= columns; j += kTile) {
    double sum[height][kTile] = {};
    for (std::size_t k = 0; k < inner; ++k)
      for (int r = 0; r < height; ++r)
        for (std::size_t t = 0; t < kTile; ++t)
          sum[r][t] += a[r * inner + k] * b[k * columns + j + t];
    for (int r = 0; r < height; ++r) std::copy_n(sum[r], kTile, result + r * columns + j);
  }
  for (int r = 0; r < height; ++r)
    for (std::size_t i = j; i < columns; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < inner; ++k) sum += a[r * inner + k] * b[k * columns + i];
      result[r * columns + i] = sum;
    }
}

double dot(const double* a, const double* b, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += a[i] * b[i];
  return sum;
}

/// to += factor * from, from `begin` to `end`
void add(double* to, double factor, const double* from, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) to[i] += factor * from[i];
}

/// A symmetric matrix on its way to the diagonal: A = Q T Q', T tridiagonal, Q orthogonal.
/// (Golub and Van Loan 2013, sections 8.3.1 and 8.3.3)
class Eigen {
 public:
  /// Householder's reflections I - beta v v', one a column, make it tridiagonal.
  Eigen(std::vector<double> matrix, std::size_t n)
      : n(n), a(std::move(matrix)), v(n * n), beta(n), diagonal(n), beside(n) {
    for (std::size_t k = 0; k < n; ++k) {
      diagonal[k] = a[k * n + k];
      if (k + 2 < n)
        reflect(k);
      else if (k + 1 < n)
        beside[k] = a[k * n + k + 1];
    }
  }

  /// Q', the transpose of the product of all reflections.
  void accumulate(double* transposed) const {
    std::vector<double> q(n * n), s(n);
    for (std::size_t i = 0; i < n; ++i) q[i * n + i] = 1;
    for (std::size_t k = n < 2 ? 0 : n - 2; k-- > 0;) {
      std::fill(s.begin(), s.end(), 0.0);
      const double* x = &v[k * n];
      for (std::size_t i = k + 1; i < n; ++i) add(s.data(), x[i], &q[i * n], k + 1, n);
      for (std::size_t i = k + 1; i < n; ++i) add(&q[i * n], -beta[k] * x[i], s.data(), k + 1, n);
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) transposed[j * n + i] = q[i * n + j];
  }

  /// The QR algorithm makes T diagonal; its rotations turn the rows of `vectors`.
  void diagonalise(double* vectors) {
    int rounds = 0;
    for (std::size_t high = n - 1; high > 0;) {
      if (negligible(high - 1) || ++rounds > kRounds) {
        beside[high - 1] = 0;
        rounds = 0;
        --high;
        continue;
      }
      std::size_t low = high - 1;
      while (low > 0 && !negligible(low - 1)) --low;
      step(low, high, vectors);
    }
  }

  const std::vector<double>& values() const { return diagonal; }

 private:
  void reflect(std::size_t k) {
    const double* row = &a[k * n];
    double* x = &v[k * n];
    const double first = row[k + 1], rest = dot(row, row, k + 2, n);
    beside[k] = first;
    if (rest == 0) return;
    const double length = std::sqrt(first * first + rest);
    beside[k] = first > 0 ? -length : length;
    std::copy(row + k + 1, row + n, x + k + 1);
    x[k + 1] = first - beside[k];
    beta[k] = 1 / (length * (length + std::fabs(first)));
    // A - v w' - w v' is the matrix reflected on both sides
    std::vector<double> w(n);
    for (std::size_t j = k + 1; j < n; ++j) add(w.data(), x[j], &a[j * n], k + 1, n);
    for (std::size_t j = k + 1; j < n; ++j) w[j] *= beta[k];
    add(w.data(), -beta[k] / 2 * dot(x, w.data(), k + 1, n), x, k + 1, n);
    for (std::size_t i = k + 1; i < n; ++i) {
      double* to = &a[i * n];
      const double vi = x[i], wi = w[i];
      for (std::size_t j = k + 1; j < n; ++j) to[j] -= vi * w[j] + wi * x[j];
    }
  }

  bool negligible(std::size_t k) const {
    const double size = std::fabs(diagonal[k]) + std::fabs(diagonal[k + 1]);
    return std::fabs(beside[k]) <= std::numeric_limits<double>::epsilon() * size ||
           std::fabs(beside[k]) < std::numeric_limits<double>::min();
  }

  /// An implicit step with Wilkinson's shift on rows low to high of T, which hang together.
  void step(std::size_t low, std::size_t high, double* vectors) {
    const double half = (diagonal[high - 1] - diagonal[high]) / 2, e = beside[high - 1];
    const double root = std::sqrt(half * half + e * e);
    double x = diagonal[low] - (diagonal[high] - e * e / (half + (half < 0 ? -root : root)));
    double z = beside[low];
    for (std::size_t k = low; k < high; ++k) {
      const double r = std::sqrt(x * x + z * z);
      const double c = r > 0 ? x / r : 1, s = r > 0 ? z / r : 0;
      if (k > low) beside[k - 1] = r;
      const double p = diagonal[k], b = beside[k], q = diagonal[k + 1];
      const double change = s * (s * (q - p) + 2 * c * b);
      diagonal[k] = p + change;
      diagonal[k + 1] = q - change;
      beside[k] = c * s * (q - p) + (c * c - s * s) * b;
      if (k + 1 < high) {
        x = beside[k];
        z = s * beside[k + 1];
        beside[k + 1] *= c;
      }
      double *upper = vectors + k * n, *lower = upper + n;
      for (std::size_t j = 0; j < n; ++j) {
        const double u = upper[j], l = lower[j];
        upper[j] = c * u + s * l;
        lower[j] = c * l - s * u;
      }
    }
  }

  std::size_t n;
  std::vector<double> a, v, beta, diagonal, beside;
};

}  // namespace

void product(const double* a, const double* b, double* result, std::size_t rows, std::size_t inner,
             std::size_t columns) {
  std::size_t i = 0;
  for (; i + 2 <= rows; i += 2)
    product_rows<2>(a + i * inner, b, result + i * columns, inner, columns);
  if (i < rows) product_rows<1>(a + i * inner, b, result + i * columns, inner, columns);
}

void symmetric_eigen(const double* matrix, std::size_t n, double* values, double* vectors) {
  if (n == 0) return;
  // scaled by a power of two, which is exact: squares must neither overflow nor vanish
  double largest = 0;
  for (std::size_t i = 0; i < n * n; ++i) {
    if (!std::isfinite(matrix[i])) throw std::invalid_argument("the matrix is not finite.");
    largest = std::max(largest, std::fabs(matrix[i]));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  std::vector<double> scaled(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j)
      scaled[i * n + j] = scaled[j * n + i] = std::ldexp(matrix[i * n + j], -exponent);

  Eigen eigen(std::move(scaled), n);
  std::vector<double> rows(n * n);
  eigen.accumulate(rows.data());
  eigen.diagonalise(rows.data());

  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return eigen.values()[i] < eigen.values()[j];
  });
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = std::ldexp(eigen.values()[order[i]], exponent);
    std::copy_n(&rows[order[i] * n], n, vectors + i * n);
  }
}

}  // namespace botschool
