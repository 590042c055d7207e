#include "evonet/evonet.hpp"

#include <nanobind/stl/vector.h>

#include "bindings.hpp"

namespace botschool {
namespace {

using Doubles = Vector<double>;
using ConstDoubles = Vector<const double>;
using Floats = Vector<float>;
using ConstFloats = Vector<const float>;

void expect_sizes(const Evonet& net, std::size_t parameters, std::size_t inputs,
                  std::size_t actions, std::size_t activations) {
  const auto check = [](std::size_t size, int needed, const char* what) {
    if (size != std::size_t(needed))
      throw std::invalid_argument(std::string(what) + " has " + std::to_string(size) +
                                  " values, but " + std::to_string(needed) + " are needed.");
  };
  check(parameters, net.parameters(), "the parameters vector");
  check(inputs, net.inputs(), "the input vector");
  check(actions, net.actions(), "the output vector");
  check(activations, net.neurons(), "the activations vector");
}

void step(Evonet& net, ConstDoubles parameters, ConstDoubles inputs, Doubles actions,
          Doubles activations) {
  expect_sizes(net, parameters.size(), inputs.size(), actions.size(), activations.size());
  net.step(parameters.data(), inputs.data(), actions.data(), activations.data());
}

void step_single(Evonet& net, ConstDoubles parameters, ConstFloats inputs, Floats actions,
                 Doubles activations) {
  expect_sizes(net, parameters.size(), inputs.size(), actions.size(), activations.size());
  const std::vector<double> wide(inputs.data(), inputs.data() + inputs.size());
  std::vector<double> result(actions.size());
  net.step(parameters.data(), wide.data(), result.data(), activations.data());
  for (std::size_t i = 0; i < result.size(); ++i) actions.data()[i] = float(result[i]);
}

nb::object vectors(const Moments& moments) {
  std::vector<double> values(2 * moments.inputs());
  moments.vectors(values.data());
  const std::size_t size = values.size();
  return to_numpy(std::move(values), {size});
}

/// count, sums, sums of squares: 1 + 2 * inputs values, for checkpoints.
nb::object moments_state(const Moments& m) {
  std::vector<double> values{m.count};
  values.insert(values.end(), m.sum.begin(), m.sum.end());
  values.insert(values.end(), m.sumsq.begin(), m.sumsq.end());
  const std::size_t size = values.size();
  return to_numpy(std::move(values), {size});
}

void set_moments_state(Moments& m, ConstDoubles values) {
  const int n = m.inputs();
  expect_size(values, 1 + 2 * n, "the state of the normalisation");
  m.count = values.data()[0];
  m.sum.assign(values.data() + 1, values.data() + 1 + n);
  m.sumsq.assign(values.data() + 1 + n, values.data() + 1 + 2 * n);
}

}  // namespace

void bind_evonet(nb::module_& module) {
  module.def("hyperparameters", [] {
    nb::list rows;
#define BOTSCHOOL_ROW(type, name, value, least, greatest, explanation, choices) \
  rows.append(                                                                  \
      nb::make_tuple(#name, type(value), type(least), type(greatest), explanation, choices));
    BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_ROW)
#undef BOTSCHOOL_ROW
    return rows;
  });
  nb::class_<Spec>(module, "Spec")
      .def(nb::init<>())
      .def_rw("inputs", &Spec::inputs)
      .def_rw("outputs", &Spec::outputs)
#define BOTSCHOOL_BIND(type, name, value, least, greatest, explanation, choices) \
  .def_rw(#name, &Spec::name)
          BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_BIND)
#undef BOTSCHOOL_BIND
      .def_rw("low", &Spec::low)
      .def_rw("high", &Spec::high);

  nb::class_<Moments>(module, "Moments")
      .def(nb::init<int>())
      .def("reset", &Moments::reset)
      .def("add",
           [](Moments& m, double count, ConstDoubles sums, ConstDoubles squares) {
             expect_size(sums, m.inputs(), "the vector of sums");
             expect_size(squares, m.inputs(), "the vector of squares");
             m.add(count, sums.data(), squares.data());
           })
      .def("vectors", &vectors)
      .def_prop_rw("state", &moments_state, &set_moments_state);

  nb::class_<Vision>(module, "Vision")
      .def(nb::init<>())
      .def_rw("channels", &Vision::channels)
      .def_rw("height", &Vision::height)
      .def_rw("width", &Vision::width)
      .def_rw("filters", &Vision::filters)
      .def_rw("kernels", &Vision::kernels)
      .def_rw("strides", &Vision::strides);

  nb::class_<Evonet>(module, "Evonet")
      .def(nb::init<const Spec&, int, bool, const Vision&>(), nb::arg("spec"),
           nb::arg("networks") = 1, nb::arg("heterogeneous") = false, nb::arg("vision") = Vision())
      .def_prop_ro("nparameters", &Evonet::parameters)
      .def_prop_ro("ninputs", &Evonet::inputs)
      .def_prop_ro("nactions", &Evonet::actions)
      .def_prop_ro("nneurons", &Evonet::neurons)
      .def("seed", &Evonet::seed)
      .def(
          "initialise",
          [](const Evonet& net, Doubles parameters) {
            expect_size(parameters, net.parameters(), "the parameters vector");
            net.initialise(parameters.data());
          },
          nb::arg().noconvert())
      .def("reset", &Evonet::reset)
      .def("step", &step, nb::arg().noconvert(), nb::arg().noconvert(), nb::arg().noconvert(),
           nb::arg().noconvert())
      .def("step_single", &step_single, nb::arg().noconvert(), nb::arg().noconvert(),
           nb::arg().noconvert(), nb::arg().noconvert())
      .def_rw("collecting", &Evonet::collecting)
      .def_prop_ro(
          "moments", [](Evonet& net) -> Moments& { return net.moments; },
          nb::rv_policy::reference_internal)
      .def("set_normalisation",
           [](Evonet& net, ConstDoubles values) {
             expect_size(values, net.normalisation.size(), "the normalisation vector");
             net.normalisation.assign(values.data(), values.data() + values.size());
           })
      .def("get_normalisation", [](const Evonet& net) {
        return to_numpy(std::vector<double>(net.normalisation), {net.normalisation.size()});
      });
}

}  // namespace botschool
