#include "arena/robots/jointed/planar.hpp"

#include <nanobind/stl/string.h>

#include "bindings.hpp"

namespace botschool {
namespace {

nb::dict to_dict(const Segment& segment) {
  nb::dict d;
  d["name"] = segment.name;
  d["parent"] = segment.parent;
  d["x"] = segment.x;
  d["z"] = segment.z;
  const Hinge& h = segment.hinge;
  d["range"] = nb::make_tuple(h.low, h.high);
  d["torque"] = h.torque;
  d["damping"] = h.damping;
  d["stiffness"] = h.stiffness;
  d["armature"] = h.armature;
  nb::list capsules;
  for (const Capsule& c : segment.capsule)
    if (c.radius > 0) capsules.append(nb::make_tuple(c.x, c.z, c.angle, c.half, c.radius));
  d["capsules"] = capsules;
  return d;
}

nb::dict to_dict(const PlanarBody& body) {
  nb::dict d;
  nb::list segments, contacts;
  for (const Segment& segment : body.segments()) segments.append(to_dict(segment));
  for (const Contact& c : body.contacts())
    contacts.append(nb::make_tuple(c.segment, c.x, c.z, c.radius));
  d["name"] = body.name();
  d["segments"] = segments;
  d["contacts"] = contacts;
  d["masses"] = to_numpy(body.masses(), {body.segments().size(), 4});
  return d;
}

/// A body of planar_bodies(), by name.
struct Body {
  explicit Body(const std::string& name) {
    for (auto& body : planar_bodies())
      if (body->name() == name) planar = std::move(body);
    if (!planar) throw std::invalid_argument("there is no planar body '" + name + "'.");
  }
  /// The chain of BodyBrain.
  explicit Body(Vector<const double> parameters) {
    expect_size(parameters, 64, "the body");
    planar = planar_chain(parameters.data());
  }
  std::unique_ptr<PlanarBody> planar;
  std::size_t size() const { return planar->size(); }
};

nb::object mass_matrix(const Body& body, Vector<const double> position) {
  expect_size(position, body.size(), "the position");
  return to_numpy(body.planar->mass_matrix(position.data()), {body.size(), body.size()});
}

nb::object accelerations(const Body& body, Vector<const double> position,
                         Vector<const double> speed, Vector<const double> action, double gravity) {
  expect_size(position, body.size(), "the position");
  expect_size(speed, body.size(), "the speed");
  expect_size(action, body.size() - 3, "the action");
  return to_numpy(body.planar->accelerations(position.data(), speed.data(), action.data(), gravity),
                  {body.size()});
}

nb::tuple advance(const Body& body, Vector<const double> state, Vector<const double> action,
                  double h, int steps, double slope, double curvature, double gravity,
                  bool single) {
  expect_size(state, 2 * body.size(), "the state");
  expect_size(action, body.size() - 3, "the action");
  if (steps < 1 || !(h > 0)) throw std::invalid_argument("h and steps must be above 0.");
  std::vector<double> after(state.data(), state.data() + state.size());
  std::vector<double> load(body.planar->contacts().size());
  body.planar->advance(after.data(), action.data(), load.data(), h, steps,
                       {slope, curvature, gravity}, single);
  const std::size_t points = load.size();
  return nb::make_tuple(to_numpy(std::move(after), {2 * body.size()}),
                        to_numpy(std::move(load), {points}));
}

}  // namespace

void bind_planar(nb::module_& module) {
  nb::class_<Body>(module, "PlanarBody")
      .def(nb::init<const std::string&>(), nb::arg("name"))
      .def(nb::init<Vector<const double>>(), nb::arg("parameters"))
      .def_prop_ro("size", &Body::size)
      .def_prop_ro("table", [](const Body& body) { return to_dict(*body.planar); })
      .def("mass_matrix", &mass_matrix, nb::arg("position"))
      .def("accelerations", &accelerations, nb::arg("position"), nb::arg("speed"),
           nb::arg("action"), nb::arg("gravity") = kGravity)
      .def("advance", &advance, nb::arg("state"), nb::arg("action"), nb::arg("h"),
           nb::arg("steps") = 1, nb::arg("slope") = 0.0, nb::arg("curvature") = 0.0,
           nb::arg("gravity") = kGravity, nb::arg("single") = false);
}

}  // namespace botschool
