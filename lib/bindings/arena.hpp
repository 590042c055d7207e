// What the bindings share about arenas.
#pragma once

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "arena/robots/declaration.hpp"
#include "bindings.hpp"

namespace botschool {

/// A measured infrared table: `values` has the shape (distances, angles, 8).
struct Table {
  Table(double first, double step, nb::ndarray<const double, nb::ndim<3>, nb::c_contig> values)
      : values(values.data(), values.data() + values.size()) {
    if (values.shape(2) != kInfrared || values.size() == 0 || !(step > 0))
      throw std::invalid_argument("a table has 8 sensors, distances, angles and a positive step.");
    table = {int(values.shape(0)), int(values.shape(1)), first, step, this->values.data()};
  }
  std::vector<double> values;
  InfraredTable table;
};

/// Choices about an arena; keeps its tables alive through nb::keep_alive.
struct Options : ArenaOptions {
  Options(const std::vector<std::string>& robots, std::optional<double> given_noise,
          const Table* wall, const Table* round, const Declaration* declared) {
    if (robots.size() > std::size_t(kMaxRobots))
      throw std::invalid_argument("there are at most " + std::to_string(kMaxRobots) + " robots.");
    for (std::size_t r = 0; r < robots.size(); ++r) {
      robot[r] = find_robot(robots[r].c_str());
      if (!robot[r]) throw std::invalid_argument("there is no robot '" + robots[r] + "'.");
    }
    if (given_noise && !(*given_noise >= 0))
      throw std::invalid_argument("noise must not be negative.");
    noise = given_noise.value_or(-1);
    wall_table = wall ? &wall->table : nullptr;
    round_table = round ? &round->table : nullptr;
    declaration = declared;
  }
};

}  // namespace botschool
