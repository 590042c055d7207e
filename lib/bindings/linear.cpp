#include "linear/linear.hpp"

#include "bindings.hpp"
#include "evonet/real.hpp"

namespace botschool {
namespace {

using ConstMatrix = Matrix<const double>;

nb::object matrix_product(ConstMatrix a, ConstMatrix b) {
  const std::size_t rows = a.shape(0), inner = a.shape(1), columns = b.shape(1);
  if (b.shape(0) != inner)
    throw std::invalid_argument("a matrix of " + std::to_string(inner) +
                                " columns cannot be multiplied by one of " +
                                std::to_string(b.shape(0)) + " rows.");
  std::vector<double> result(rows * columns);
  product(a.data(), b.data(), result.data(), rows, inner, columns);
  return to_numpy(std::move(result), {rows, columns});
}

nb::tuple eigen(ConstMatrix matrix) {
  const std::size_t n = matrix.shape(0);
  if (matrix.shape(1) != n) throw std::invalid_argument("the matrix is not square.");
  std::vector<double> values(n), vectors(n * n);
  symmetric_eigen(matrix.data(), n, values.data(), vectors.data());
  return nb::make_tuple(to_numpy(std::move(values), {n}), to_numpy(std::move(vectors), {n, n}));
}

template <double (*f)(double)>
nb::object each(Vector<const double> values) {
  std::vector<double> result(values.data(), values.data() + values.size());
  for (double& x : result) x = f(x);
  const std::size_t size = result.size();
  return to_numpy(std::move(result), {size});
}

double exp_of(double x) { return exponential(x); }
double log_of(double x) { return logarithm(x); }

}  // namespace

void bind_linear(nb::module_& module) {
  module.def("product", &matrix_product);
  module.def("symmetric_eigen", &eigen);
  module.def("exp", &each<exp_of>);
  module.def("log", &each<log_of>);
}

}  // namespace botschool
