// The common part of the nanobind module's files. The Python classes (botschool.net,
// botschool.problems) check what users pass. Sizes are checked again here, so that no call can read
// past an array.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace botschool {

namespace nb = nanobind;

template <class T>
using Array = nb::ndarray<T, nb::c_contig, nb::device::cpu>;
template <class T>
using Vector = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Matrix = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

template <class Array>
void expect_size(const Array& array, std::size_t size, const char* what) {
  if (array.size() != size)
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(array.size()) +
                                " values, but " + std::to_string(size) + " are needed.");
}

/// A numpy array that owns the values.
template <class T>
nb::object to_numpy(std::vector<T>&& values, std::vector<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape.size(), shape.data(), owner));
}

void bind_evonet(nb::module_& module);
void bind_arena(nb::module_& module);
void bind_engine(nb::module_& module);
void bind_planar(nb::module_& module);
void bind_spatial(nb::module_& module);
void bind_linear(nb::module_& module);
void bind_evolution(nb::module_& module);
void bind_policy_gradient(nb::module_& module);

}  // namespace botschool
