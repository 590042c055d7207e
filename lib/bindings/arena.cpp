// Kinds of robots, measured tables, declared arenas, and choices about an arena.
#include "arena.hpp"

namespace botschool {
namespace {

nb::dict to_dict(const RobotModel& model) {
  nb::dict d;
  d["name"] = model.name;
  d["radius"] = model.radius;
  d["axle"] = model.axle;
  d["speed"] = model.speed;
  nb::list directions;
  for (const double direction : model.direction) directions.append(direction);
  d["directions"] = directions;
  d["range"] = model.range;
  return d;
}

template <std::size_t n>
int index_of(const char* const (&names)[n], const std::string& name) {
  for (std::size_t i = 0; i < n; ++i)
    if (name == names[i]) return static_cast<int>(i);
  throw std::invalid_argument("a declared arena knows no '" + name + "'.");
}

template <std::size_t n>
nb::list list_of(const char* const (&names)[n]) {
  nb::list list;
  for (const char* name : names) list.append(name);
  return list;
}

void expect_most(std::size_t given, int most) {
  if (given > std::size_t(most))
    throw std::invalid_argument("a declared arena has at most " + std::to_string(most) +
                                " of a kind, not " + std::to_string(given) + ".");
}

/// Numbers of one thing each: x, x2, y, y2 (from and to), then what else it has.
using Things = std::vector<std::vector<double>>;

void expect_rows(const Things& rows, int most, std::size_t columns) {
  expect_most(rows.size(), most);
  for (const auto& row : rows)
    if (row.size() != columns)
      throw std::invalid_argument("a row of a declaration has " + std::to_string(columns) +
                                  " numbers.");
}

Spot spot_of(const std::vector<double>& row) { return {{row[0], row[1]}, {row[2], row[3]}}; }

Declaration declare(double width, double height, const std::vector<std::string>& models,
                    const Things& robots, const Things& walls, const Things& cylinders,
                    const Things& lights, const Things& zones,
                    const std::vector<std::string>& sensors, double noise, double half_light,
                    int beams, double field, double reach, const std::string& reward,
                    double distance, bool bumps_end) {
  Declaration d;
  d.width = width, d.height = height;
  expect_rows(robots, kMaxRobots, 7);
  expect_rows(walls, kMaxWalls - 4, 4);
  expect_rows(cylinders, kMaxCylinders, 5);
  expect_rows(lights, kMaxLights, 4);
  expect_rows(zones, kMaxZones, 6);
  expect_most(sensors.size(), kMaxSenses);
  if (robots.empty() || robots.size() != models.size() || sensors.empty())
    throw std::invalid_argument("a declared arena needs robots, a model for each, and sensors.");
  if (beams < 1 || beams > kMaxBeams) throw std::invalid_argument("too many or too few beams.");
  d.robots = static_cast<int>(robots.size());
  for (int r = 0; r < d.robots; ++r) {
    const auto& row = robots[r];
    d.robot[r] = {find_robot(models[r].c_str()), row[6], spot_of(row), {row[4], row[5]}};
    if (!d.robot[r].model) throw std::invalid_argument("there is no robot '" + models[r] + "'.");
  }
  for (const auto& row : walls) d.wall[d.walls++] = {row[0], row[1], row[2], row[3]};
  for (const auto& row : cylinders) d.cylinder[d.cylinders++] = {spot_of(row), row[4]};
  for (const auto& row : lights) d.light[d.lights++] = spot_of(row);
  for (const auto& row : zones) d.zone[d.zones++] = {spot_of(row), row[4], row[5]};
  d.senses = 0;
  for (const auto& name : sensors) d.sense[d.senses++] = Sense(index_of(kSenses, name));
  d.noise = noise;
  d.sensing = {half_light, beams, field, reach};
  if (observations_of(d) > kMaxObservations)
    throw std::invalid_argument("a robot has at most " + std::to_string(kMaxObservations) +
                                " observations.");
  d.pay = Pay(index_of(kPays, reward));
  d.distance = distance;
  d.bumps_end = bumps_end;
  return d;
}

/// What an arena can declare, and the rows of its state.
nb::dict declarations() {
  nb::dict d;
  d["sensors"] = list_of(kSenses);
  d["rewards"] = list_of(kPays);
  d["robots"] = kMaxRobots;
  d["walls"] = kMaxWalls - 4;
  d["cylinders"] = kMaxCylinders;
  d["lights"] = kMaxLights;
  d["zones"] = kMaxZones;
  d["beams"] = kMaxBeams;
  return d;
}

}  // namespace

void bind_arena(nb::module_& module) {
  module.def("robot_models", [] {
    nb::list list;
    for (const RobotModel& model : kRobotModels) list.append(to_dict(model));
    return list;
  });
  nb::class_<Table>(module, "Table")
      .def(nb::init<double, double, nb::ndarray<const double, nb::ndim<3>, nb::c_contig>>(),
           nb::arg("first"), nb::arg("step"), nb::arg("values"));

  module.def("declarations", &declarations);
  nb::class_<Declaration>(module, "Declaration")
      .def(nb::new_(&declare), nb::kw_only(), nb::arg("width"), nb::arg("height"),
           nb::arg("models"), nb::arg("robots"), nb::arg("walls"), nb::arg("cylinders"),
           nb::arg("lights"), nb::arg("zones"), nb::arg("sensors"), nb::arg("noise"),
           nb::arg("half_light"), nb::arg("beams"), nb::arg("field"), nb::arg("reach"),
           nb::arg("reward"), nb::arg("distance"), nb::arg("bumps_end"))
      .def_prop_ro("observations", [](const Declaration& d) { return observations_of(d); })
      .def("size_of", [](const Declaration& d, const std::string& sensor) {
        return size_of(Sense(index_of(kSenses, sensor)), d.sensing);
      });

  nb::class_<Options>(module, "ArenaOptions")
      .def(nb::init<const std::vector<std::string>&, std::optional<double>, const Table*,
                    const Table*, const Declaration*>(),
           nb::arg("robots") = std::vector<std::string>(), nb::arg("noise").none() = nb::none(),
           nb::arg("wall_table").none() = nb::none(), nb::arg("round_table").none() = nb::none(),
           nb::arg("declaration").none() = nb::none(), nb::keep_alive<1, 4>(),
           nb::keep_alive<1, 5>(), nb::keep_alive<1, 6>());
}

}  // namespace botschool
