#include "spatial.hpp"

#include "arena/robots/jointed/spatial.hpp"

namespace botschool {
namespace {

nb::tuple to_tuple(const Place& p) { return nb::make_tuple(p.x, p.y, p.z); }

nb::dict to_dict(const Link& link) {
  nb::dict d;
  d["name"] = link.name;
  d["parent"] = link.parent;
  d["place"] = to_tuple(link.place);
  d["axis"] = to_tuple(link.axis);
  const Hinge& h = link.hinge;
  d["range"] = nb::make_tuple(h.low, h.high);
  d["torque"] = h.torque;
  d["damping"] = h.damping;
  d["stiffness"] = h.stiffness;
  d["armature"] = h.armature;
  d["motor"] = link.motor;
  d["slides"] = link.slides;
  d["mass"] = link.mass;
  d["centre"] = to_tuple(link.centre);
  return d;
}

nb::dict to_dict(const SpatialBody& body) {
  const Solid& solid = body.solid();
  nb::dict d;
  nb::list links, shapes, balls;
  for (int i = 0; i < solid.links; ++i) links.append(to_dict(solid.link[i]));
  for (int i = 0; i < solid.shapes; ++i) {
    const Shape& s = solid.shape[i];
    shapes.append(nb::make_tuple(s.link, to_tuple(s.place), to_tuple(s.half), s.radius));
  }
  for (const Ball& b : body.balls())
    balls.append(nb::make_tuple(b.link, to_tuple(b.place), b.radius, b.name));
  d["name"] = solid.name;
  d["links"] = links;
  d["shapes"] = shapes;
  d["balls"] = balls;
  d["motors"] = solid.motors;
  d["fixed"] = solid.fixed;
  return d;
}

/// A body of spatial_bodies(), by name.
struct Whole {
  explicit Whole(const std::string& name) {
    for (auto& each : spatial_bodies())
      if (each->solid().name == name) body = std::move(each);
    if (!body) throw std::invalid_argument("there is no body in space '" + name + "'.");
  }
  /// A declared one.
  explicit Whole(const Race& race) {
    if (!race.options.course) throw std::invalid_argument("this race declares no body.");
    body = spatial_body(race.solid);
  }
  std::unique_ptr<SpatialBody> body;
  std::size_t coordinates() const { return body->coordinates(); }
  std::size_t speeds() const { return body->speeds(); }
  std::size_t state() const { return coordinates() + speeds() + 4 * body->balls().size(); }
};

nb::object places(const Whole& whole, Vector<const double> position) {
  expect_size(position, whole.coordinates(), "the position");
  return to_numpy(whole.body->places(position.data()),
                  {std::size_t(whole.body->solid().links), 4, 3});
}

nb::object mass_matrix(const Whole& whole, Vector<const double> position) {
  expect_size(position, whole.coordinates(), "the position");
  return to_numpy(whole.body->mass_matrix(position.data()), {whole.speeds(), whole.speeds()});
}

nb::object accelerations(const Whole& whole, Vector<const double> position,
                         Vector<const double> speed, Vector<const double> action, double gravity) {
  expect_size(position, whole.coordinates(), "the position");
  expect_size(speed, whole.speeds(), "the speed");
  expect_size(action, whole.body->solid().motors, "the action");
  return to_numpy(whole.body->accelerations(position.data(), speed.data(), action.data(), gravity),
                  {whole.speeds()});
}

nb::object advance(const Whole& whole, Vector<const double> state, Vector<const double> action,
                   double h, int steps, double gravity, const Firmness* firm,
                   const std::vector<double>& ground, bool single) {
  expect_size(state, whole.state(), "the state");
  expect_size(action, whole.body->solid().motors, "the action");
  if (ground.size() != 3) throw std::invalid_argument("the ground has slope, step and bumps.");
  if (steps < 1 || !(h > 0)) throw std::invalid_argument("h and steps must be above 0.");
  std::vector<double> after(state.data(), state.data() + state.size());
  whole.body->advance(after.data(), action.data(), h, steps, gravity,
                      firm ? *firm : whole.body->solid().firm, {ground[0], ground[1], ground[2]},
                      single);
  return to_numpy(std::move(after), {whole.state()});
}

}  // namespace

void bind_spatial(nb::module_& module) {
  nb::class_<Firmness>(module, "Firmness")
      .def(
          "__init__",
          [](Firmness* firm, double friction, double stiffness, double damping, double limit,
             double stopping) {
            new (firm) Firmness{friction, stiffness, damping, limit, stopping};
          },
          nb::arg("friction") = Firmness{}.friction, nb::arg("stiffness") = Firmness{}.stiffness,
          nb::arg("damping") = Firmness{}.damping, nb::arg("limit") = Firmness{}.limit,
          nb::arg("stopping") = Firmness{}.stopping);
  nb::class_<Race>(module, "Race")
      .def(nb::init<const std::vector<std::vector<double>>&>(),
           nb::arg("physics") = std::vector<std::vector<double>>())
      .def_prop_ro("ground",
                   [](const Race& race) {
                     nb::list middle;  // of what an episode's may be
                     for (const Kind kind : {kSlope, kStep, kBumps, kStairs}) {
                       const Span& span = race.options.physics.of[kind];
                       middle.append((span.low + span.high) / 2);
                     }
                     return nb::tuple(middle);
                   })
      .def("declare", &Race::declare, nb::arg("names"), nb::arg("links"), nb::arg("shapes"),
           nb::arg("shape_names"), nb::arg("pairs"), nb::arg("pose"), nb::arg("firmness"),
           nb::kw_only(), nb::arg("fixed") = false, nb::arg("soft") = true, nb::arg("seconds"),
           nb::arg("substeps"), nb::arg("height"), nb::arg("noise"), nb::arg("low"),
           nb::arg("high"), nb::arg("alive"), nb::arg("effort"));
  nb::class_<Whole>(module, "SpatialBody")
      .def(nb::init<const std::string&>(), nb::arg("name"))
      .def(nb::init<const Race&>(), nb::arg("race"), nb::keep_alive<1, 2>())
      .def_prop_ro("coordinates", &Whole::coordinates)
      .def_prop_ro("speeds", &Whole::speeds)
      .def_prop_ro("size", &Whole::state)
      .def_prop_ro("table", [](const Whole& whole) { return to_dict(*whole.body); })
      .def("places", &places, nb::arg("position"))
      .def("mass_matrix", &mass_matrix, nb::arg("position"))
      .def("accelerations", &accelerations, nb::arg("position"), nb::arg("speed"),
           nb::arg("action"), nb::arg("gravity") = kGravity)
      .def("advance", &advance, nb::arg("state"), nb::arg("action"), nb::arg("h"),
           nb::arg("steps") = 1, nb::arg("gravity") = kGravity,
           nb::arg("firmness").none() = nb::none(), nb::arg("ground") = std::vector<double>(3),
           nb::arg("single") = false);
}

}  // namespace botschool
