#include <nanobind/stl/tuple.h>

#include <algorithm>

#include "bindings.hpp"
#include "evolution/normals.hpp"
#include "evolution/settings.hpp"

namespace botschool {
namespace {

/// What numpy's Generator asks of a source of random words: its C interface `bitgen_t`.
struct Source {
  void* state;
  std::uint64_t (*next_uint64)(void*);
  std::uint32_t (*next_uint32)(void*);
  double (*next_double)(void*);
  std::uint64_t (*next_raw)(void*);
};

struct Numbers {
  explicit Numbers(const Normals::Place& place) : normals(place) {}
  Normals normals;
  Source source{&normals, word, half, uniform, word};

 private:
  static Normals& of(void* state) { return *static_cast<Normals*>(state); }
  static std::uint64_t word(void* state) { return of(state).bits(); }
  static std::uint32_t half(void* state) { return of(state).half(); }
  static double uniform(void* state) { return of(state).uniform(); }
};

using Place = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::int64_t>;

Normals::Place checked(const Place& place) {
  const auto [seed, generation, words, half] = place;
  if (half < -1 || half >> 32 > 0) throw std::invalid_argument("a half word has 32 bits.");
  return {seed, generation, words, half};
}

Place place_of(const Numbers& numbers) {
  const Normals::Place place = numbers.normals.place();
  return {place.seed, place.generation, place.words, place.half};
}

/// Numbers from 0 to before each of `counts`, which they replace.
void below(Numbers& numbers, Vector<std::int64_t> counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::int64_t& each = counts.data()[i];
    if (each < 1) throw std::invalid_argument("high <= 0");
    each = static_cast<std::int64_t>(numbers.normals.below(static_cast<std::uint64_t>(each)));
  }
}

nb::object permutation(Numbers& numbers, std::uint32_t count) {
  const std::vector<std::size_t> order = numbers.normals.permutation(count);
  return to_numpy(std::vector<std::int64_t>(order.begin(), order.end()), {order.size()});
}

void fill(Numbers& numbers, Vector<double> values) {
  std::generate_n(values.data(), values.size(), [&] { return numbers.normals.next(); });
}

}  // namespace

void bind_evolution(nb::module_& module) {
  nb::class_<Numbers>(module, "Numbers")
      .def("__init__",
           [](Numbers* numbers, const Place& place) { new (numbers) Numbers(checked(place)); })
      .def_prop_rw(
          "state", &place_of,
          [](Numbers& numbers, const Place& place) { numbers.normals = Normals(checked(place)); })
      .def_prop_ro("capsule",
                   [](Numbers& numbers) { return nb::capsule(&numbers.source, "BitGenerator"); })
      .def("normals", &fill)
      .def("below", &below)
      .def("permutation", &permutation);
  module.def("settings", &names_of_settings);
  module.def("power", [](double base, unsigned exponent) {
    if (!(base > 0 && base < 1)) throw std::invalid_argument("the base must lie between 0 and 1.");
    return power(base, exponent);
  });
  module.def("log_of_rest", [](Vector<double> values) {
    std::transform(values.data(), values.data() + values.size(), values.data(), log_of_rest);
  });
}

}  // namespace botschool
