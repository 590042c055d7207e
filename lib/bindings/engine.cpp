#include "arena/engine/engine.hpp"

#include <nanobind/stl/unique_ptr.h>

#include "aim.hpp"
#include "arena/engine/expression.hpp"

namespace botschool {
namespace {

nb::dict to_dict(const Plan& plan) {
  nb::dict d;
  d["width"] = plan.width;
  d["height"] = plan.height;
  nb::list roles;
  for (int r = 0; r < plan.robots; ++r) {
    nb::dict role;
    role["model"] = plan.role[r].model;
    role["speed"] = plan.role[r].speed;
    roles.append(role);
  }
  d["roles"] = roles;
  d["cylinders"] = plan.cylinders;
  d["cylinder_radius"] = plan.cylinder_radius;
  d["noise"] = plan.noise;
  return d;
}

nb::dict to_dict(const Info& info) {
  nb::dict d;
  d["name"] = info.name;
  d["observations"] = info.observations;
  d["outputs"] = info.outputs;
  d["states"] = info.states;
  d["limit"] = info.limit;
  d["discrete"] = info.discrete;
  d["low"] = info.low;
  d["high"] = info.high;
  d["seconds"] = info.seconds;
  d["robots"] = info.robots;
  d["body"] = info.body;
  d["alias"] = info.alias;
  d["alias_limit"] = info.alias_limit;
  d["gym"] = info.gym;
  d["common"] = info.common;
  d["sides"] = nb::make_tuple(info.side[0], info.side[1]);
  if (info.plan) d["plan"] = to_dict(*info.plan);
  return d;
}

/// `given` genotypes of one network each (one a robot), or genotypes that hold all networks.
std::size_t offset_of(const Engine& engine, bool heterogeneous, std::size_t given) {
  return heterogeneous && given == 1 ? engine.layout().parameters : 0;
}

void check_genotypes(const Engine& engine, std::size_t length, std::size_t offset) {
  const std::size_t needed = engine.layout().parameters + (engine.info().robots - 1) * offset +
                             std::size_t(engine.info().body);
  if (length < needed)
    throw std::invalid_argument("a genotype has " + std::to_string(length) + " values, but " +
                                std::to_string(needed) + " are needed.");
}

/// normalisation: a vector for all candidates, or a row for each.
nb::tuple evaluate(const Engine& engine, Matrix<const double> genotypes,
                   std::optional<Array<const double>> normalisation,
                   Matrix<const std::int32_t> candidates, Vector<const std::uint64_t> seeds,
                   Vector<const std::uint32_t> episodes,
                   std::optional<Vector<const std::uint8_t>> collect, int limit, int threads,
                   bool heterogeneous, nb::handle options) {
  const std::size_t rows = candidates.shape(0), count = candidates.shape(1);
  const std::size_t robots = engine.info().robots;
  const int inputs = engine.layout().spec.inputs;
  const std::size_t offset = offset_of(engine, heterogeneous, rows);
  if (rows != 1 && rows != robots)
    throw std::invalid_argument("candidates needs a row for all robots, or one for each.");
  check_genotypes(engine, genotypes.shape(1), offset);
  expect_size(seeds, count, "the vector of seeds");
  expect_size(episodes, count, "the vector of episodes");
  if (collect) expect_size(*collect, count, "the vector of collecting episodes");
  const bool own = normalisation && normalisation->ndim() == 2;
  if (normalisation)
    expect_size(*normalisation, 2 * inputs * (own ? genotypes.shape(0) : 1),
                "the normalisation vector");
  for (std::size_t i = 0; i < rows * count; ++i) {
    const std::int32_t c = candidates.data()[i];
    if (c < 0 || std::size_t(c) >= genotypes.shape(0))
      throw std::invalid_argument("there is no candidate " + std::to_string(c) + ".");
  }
  const Setting setting = setting_of(limit, options);
  if (threads < 1) throw std::invalid_argument("at least one thread is needed.");

  std::vector<std::int32_t> chosen;
  for (std::size_t r = 0; r < robots; ++r) {
    const std::int32_t* row = candidates.data() + (rows == 1 ? 0 : r * count);
    chosen.insert(chosen.end(), row, row + count);
  }
  std::vector<double> fitness(count), moments(collect ? count * 2 * inputs : 0);
  std::vector<std::int32_t> steps(count);
  const Jobs jobs{genotypes.data(),
                  genotypes.shape(1),
                  normalisation ? normalisation->data() : nullptr,
                  count,
                  chosen.data(),
                  offset,
                  seeds.data(),
                  episodes.data(),
                  collect ? collect->data() : nullptr,
                  setting,
                  fitness.data(),
                  steps.data(),
                  moments.data(),
                  own ? std::size_t(2 * inputs) : 0};
  {
    nb::gil_scoped_release release;
    engine.evaluate(jobs, threads);
  }
  return nb::make_tuple(
      to_numpy(std::move(fitness), {count}), to_numpy(std::move(steps), {count}),
      collect ? to_numpy(std::move(moments), {count, std::size_t(2 * inputs)}) : nb::none());
}

/// Collects a recorded episode.
struct Tape final : Recorder {
  explicit Tape(const Engine& engine)
      : neurons_of_one(engine.layout().neurons),
        observations(engine.info().observations * engine.info().robots),
        actions((engine.info().discrete ? 1 : engine.info().outputs) * engine.info().robots),
        states(engine.info().states) {}

  void start(const double* s) override { state.assign(s, s + states); }
  void neurons(const Real* n, int stride) override {
    for (int i = 0; i < neurons_of_one; ++i) activation.push_back(n[std::ptrdiff_t(i) * stride]);
  }
  void step(const double* o, const double* a, const double* s, double r) override {
    observation.insert(observation.end(), o, o + observations);
    action.insert(action.end(), a, a + actions);
    state.insert(state.end(), s, s + states);
    reward.push_back(r);
  }

  int neurons_of_one, observations, actions, states;
  std::vector<double> observation, action, activation, state, reward;
};

/// One genotype for all robots, or a row for each.
nb::dict record(const Engine& engine, Matrix<const double> genotypes,
                std::optional<Vector<const double>> normalisation, std::uint64_t seed,
                std::uint32_t episode, int limit, bool heterogeneous, nb::handle options) {
  const std::size_t rows = genotypes.shape(0), robots = engine.info().robots;
  const std::size_t offset = offset_of(engine, heterogeneous, rows);
  if (rows != 1 && rows != robots)
    throw std::invalid_argument("a genotype is needed for all robots, or one for each.");
  check_genotypes(engine, genotypes.shape(1), offset);
  if (normalisation)
    expect_size(*normalisation, 2 * engine.layout().spec.inputs, "the normalisation vector");
  std::int32_t candidates[kMaxRobots] = {};
  for (std::size_t r = 0; r < rows; ++r) candidates[r] = int(r);
  double fitness = 0;
  std::int32_t steps = 0;
  const Jobs jobs{genotypes.data(),
                  genotypes.shape(1),
                  normalisation ? normalisation->data() : nullptr,
                  1,
                  candidates,
                  offset,
                  &seed,
                  &episode,
                  nullptr,
                  setting_of(limit, options),
                  &fitness,
                  &steps,
                  nullptr};
  Tape tape(engine);
  engine.record(jobs, tape);
  const std::size_t n = tape.reward.size();
  nb::dict d;
  d["fitness"] = fitness;
  d["observations"] = to_numpy(std::move(tape.observation), {n, std::size_t(tape.observations)});
  d["actions"] = to_numpy(std::move(tape.action), {n, std::size_t(tape.actions)});
  d["activations"] = to_numpy(std::move(tape.activation), {n, robots * tape.neurons_of_one});
  d["states"] = to_numpy(std::move(tape.state), {n + 1, std::size_t(tape.states)});
  d["rewards"] = to_numpy(std::move(tape.reward), {n});
  return d;
}

nb::object state_of(const Stepper& stepper) {
  const std::size_t n = stepper.info().states;
  std::vector<double> values(n);
  stepper.get_state(values.data());
  return to_numpy(std::move(values), {n});
}

nb::object observation_of(const Stepper& stepper) {
  const std::size_t n = stepper.info().observations * stepper.info().robots;
  std::vector<double> values(n);
  stepper.observe(values.data());
  return to_numpy(std::move(values), {n});
}

/// Shape (2, observations): the least and the greatest values of a robot's observation.
nb::object bounds_of(const Stepper& stepper) {
  const std::size_t n = stepper.info().observations;
  std::vector<double> values(2 * n);
  stepper.bounds(values.data(), values.data() + n);
  return to_numpy(std::move(values), {2, n});
}

nb::object objects_of(const Stepper& stepper) {
  const std::size_t n = stepper.objects();
  std::vector<double> values(n * kObject);
  stepper.get_objects(values.data());
  return to_numpy(std::move(values), {n, std::size_t(kObject)});
}

void set_objects(Stepper& stepper, Matrix<const double> rows) {
  if (rows.shape(0) != std::size_t(stepper.objects()) || rows.shape(1) != std::size_t(kObject))
    throw std::invalid_argument("objects needs " + std::to_string(stepper.objects()) +
                                " rows of x, y, x2, y2, radius.");
  stepper.set_objects(rows.data());
}

std::unique_ptr<Stepper> stepper_of(const std::string& problem, nb::handle options) {
  auto stepper = make_stepper(problem);
  stepper->set(setting_of(1, options));
  return stepper;
}

/// Tuples of name, unit and meaning.
nb::list list_quantities(const std::string& problem, nb::handle options) {
  nb::list list;
  for (const Quantity& q : quantities(*stepper_of(problem, options)))
    list.append(nb::make_tuple(q.name, q.unit, q.meaning));
  return list;
}

}  // namespace

void bind_engine(nb::module_& module) {
  module.def("instruction_sets", &instruction_sets);
  module.def("native_problems", [] {
    nb::list list;
    for (const Info& info : native_problems()) list.append(to_dict(info));
    return list;
  });

  module.def("quantities", &list_quantities, nb::arg("problem"),
             nb::arg("options").none() = nb::none());
  nb::class_<Aim>(module, "Aim")
      .def(
          "__init__",
          [](Aim* made, const std::string& problem, nb::object options, const std::string& reward,
             const std::string& ends) {
            Program program;
            const std::string wrong = compile(*stepper_of(problem, options), reward, ends, program);
            if (!wrong.empty()) throw std::invalid_argument(wrong);
            new (made) Aim{program, options};
          },
          nb::arg("problem"), nb::arg("options").none() = nb::none(), nb::arg("reward") = "",
          nb::arg("ends") = "");
  nb::class_<Engine>(module, "Engine")
      .def(
          "__init__",
          [](Engine* engine, const std::string& problem, const Spec& spec,
             const std::string& instruction_set, nb::handle options) {
            new (engine) Engine(problem, spec, instruction_set, setting_of(1, options));
          },
          nb::arg("problem"), nb::arg("spec"), nb::arg("instruction_set") = "",
          nb::arg("options").none() = nb::none())
      .def_prop_ro("nparameters", [](const Engine& e) { return e.layout().parameters; })
      .def("evaluate", &evaluate, nb::arg("genotypes"), nb::arg("normalisation").none(),
           nb::arg("candidates"), nb::arg("seeds"), nb::arg("episodes"), nb::arg("collect").none(),
           nb::arg("limit"), nb::arg("threads") = 1, nb::arg("heterogeneous") = false,
           nb::arg("options").none() = nb::none())
      .def("record", &record, nb::arg("genotypes"), nb::arg("normalisation").none(),
           nb::arg("seed"), nb::arg("episode"), nb::arg("limit"), nb::arg("heterogeneous") = false,
           nb::arg("options").none() = nb::none());

  nb::class_<Stepper>(module, "Stepper")
      .def(
          "set",
          [](Stepper& s, int limit, nb::handle options) { s.set(setting_of(limit, options)); },
          nb::arg("limit"), nb::arg("options").none() = nb::none(), nb::keep_alive<1, 3>())
      .def("set_body",
           [](Stepper& s, Vector<const double> parameters) {
             expect_size(parameters, s.info().body, "the body");
             s.set_body(parameters.data());
           })
      .def("start", &Stepper::start, nb::arg("seed"), nb::arg("episode") = 0)
      .def_prop_rw("state", &state_of,
                   [](Stepper& s, Vector<const double> state) {
                     expect_size(state, s.info().states, "the state");
                     s.set_state(state.data());
                   })
      .def_prop_ro("bounds", &bounds_of)
      .def_prop_ro("observation", &observation_of)
      .def_prop_rw("objects", &objects_of, &set_objects)
      .def("blocked", &Stepper::blocked)
      .def("step", [](Stepper& s, Vector<const double> action) {
        expect_size(action, s.info().discrete ? 1 : s.info().outputs * s.info().robots,
                    "the action");
        double reward = 0;
        const bool ended = s.step(action.data(), reward);
        return nb::make_tuple(reward, ended);
      });
  module.def("make_stepper", &make_stepper, nb::arg("problem"));
}

}  // namespace botschool
