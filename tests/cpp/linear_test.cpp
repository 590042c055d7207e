// Products and eigenvectors for all small sizes; tests/test_linear.py compares them with numpy's.
#include "linear/linear.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "check.hpp"

using namespace botschool;

namespace {

std::vector<double> random_matrix(std::size_t size, int seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(size);
  for (double& x : values) x = normal(random);
  return values;
}

}  // namespace

TEST(eigenvectors_keep_their_direction) {
  for (std::size_t n = 0; n < 20; ++n) {
    const std::vector<double> a = random_matrix(n * n, int(n));
    std::vector<double> values(n), rows(n * n);
    symmetric_eigen(a.data(), n, values.data(), rows.data());
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i) {
        double image = 0;
        for (std::size_t j = 0; j < n; ++j)
          image += a[i < j ? i * n + j : j * n + i] * rows[k * n + j];
        CHECK(std::fabs(image - values[k] * rows[k * n + i]) < 1e-12);
      }
  }
}

TEST(a_matrix_that_is_not_finite_is_refused) {
  const double bad[] = {1, std::numeric_limits<double>::infinity(), 0, 1};
  double values[2], rows[4];
  CHECK(refused([&] { symmetric_eigen(bad, 2, values, rows); }, "not finite"));
}

TEST(products_of_all_small_shapes) {
  for (std::size_t rows = 0; rows < 4; ++rows)
    for (std::size_t inner = 0; inner < 3; ++inner)
      for (std::size_t columns = 0; columns < 19; ++columns) {
        const std::vector<double> a = random_matrix(rows * inner, 1);
        const std::vector<double> b = random_matrix(inner * columns, 2);
        std::vector<double> result(rows * columns, -1);
        product(a.data(), b.data(), result.data(), rows, inner, columns);
        for (std::size_t i = 0; i < rows; ++i)
          for (std::size_t j = 0; j < columns; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < inner; ++k) sum += a[i * inner + k] * b[k * columns + j];
            CHECK(result[i * columns + j] == sum);
          }
      }
}
