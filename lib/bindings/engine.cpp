#include "arena/engine.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "bindings.hpp"

namespace botschool {
namespace {

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
  return d;
}

void check_genotypes(const Engine& engine, std::size_t length) {
  const std::size_t needed = engine.layout().parameters;
  if (length < needed)
    throw std::invalid_argument("a genotype has " + std::to_string(length) + " values, but " +
                                std::to_string(needed) + " are needed.");
}

nb::tuple evaluate(const Engine& engine, Matrix<const double> genotypes,
                   std::optional<Vector<const double>> normalisation,
                   Vector<const std::int32_t> candidates, Vector<const std::uint64_t> seeds,
                   Vector<const std::uint32_t> episodes,
                   std::optional<Vector<const std::uint8_t>> collect, int limit, int threads) {
  const std::size_t count = candidates.size();
  const int inputs = engine.layout().spec.inputs;
  check_genotypes(engine, genotypes.shape(1));
  expect_size(seeds, count, "the vector of seeds");
  expect_size(episodes, count, "the vector of episodes");
  if (collect) expect_size(*collect, count, "the vector of collecting episodes");
  if (normalisation) expect_size(*normalisation, 2 * inputs, "the normalisation vector");
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t c = candidates.data()[i];
    if (c < 0 || std::size_t(c) >= genotypes.shape(0))
      throw std::invalid_argument("there is no candidate " + std::to_string(c) + ".");
  }
  if (limit < 1) throw std::invalid_argument("an episode needs at least one step.");
  if (threads < 1) throw std::invalid_argument("at least one thread is needed.");

  std::vector<double> fitness(count), moments(collect ? count * 2 * inputs : 0);
  std::vector<std::int32_t> steps(count);
  const Jobs jobs{genotypes.data(),
                  genotypes.shape(1),
                  normalisation ? normalisation->data() : nullptr,
                  candidates.data(),
                  seeds.data(),
                  episodes.data(),
                  collect ? collect->data() : nullptr,
                  limit,
                  fitness.data(),
                  steps.data(),
                  moments.data()};
  {
    nb::gil_scoped_release release;
    engine.evaluate(jobs, count, threads);
  }
  return nb::make_tuple(
      to_numpy(std::move(fitness), {count}), to_numpy(std::move(steps), {count}),
      collect ? to_numpy(std::move(moments), {count, std::size_t(2 * inputs)}) : nb::none());
}

/// Collects a recorded episode.
struct Tape final : Recorder {
  explicit Tape(const Engine& engine)
      : neurons(engine.layout().neurons),
        observations(engine.info().observations),
        actions(engine.info().discrete ? 1 : engine.info().outputs),
        states(engine.info().states) {}

  void start(const double* s) override { state.assign(s, s + states); }
  void step(const double* o, const double* a, const Real* n, int stride, const double* s,
            double r) override {
    observation.insert(observation.end(), o, o + observations);
    action.insert(action.end(), a, a + actions);
    for (int i = 0; i < neurons; ++i) activation.push_back(n[std::ptrdiff_t(i) * stride]);
    state.insert(state.end(), s, s + states);
    reward.push_back(r);
  }

  int neurons, observations, actions, states;
  std::vector<double> observation, action, activation, state, reward;
};

nb::dict record(const Engine& engine, Vector<const double> genotype,
                std::optional<Vector<const double>> normalisation, std::uint64_t seed,
                std::uint32_t episode, int limit) {
  check_genotypes(engine, genotype.size());
  if (normalisation)
    expect_size(*normalisation, 2 * engine.layout().spec.inputs, "the normalisation vector");
  if (limit < 1) throw std::invalid_argument("an episode needs at least one step.");
  const std::int32_t candidate = 0;
  double fitness = 0;
  std::int32_t steps = 0;
  const Jobs jobs{genotype.data(), genotype.size(), normalisation ? normalisation->data() : nullptr,
                  &candidate,      &seed,           &episode,
                  nullptr,         limit,           &fitness,
                  &steps,          nullptr};
  Tape tape(engine);
  engine.record(jobs, tape);
  const std::size_t n = tape.reward.size();
  nb::dict d;
  d["fitness"] = fitness;
  d["observations"] = to_numpy(std::move(tape.observation), {n, std::size_t(tape.observations)});
  d["actions"] = to_numpy(std::move(tape.action), {n, std::size_t(tape.actions)});
  d["activations"] = to_numpy(std::move(tape.activation), {n, std::size_t(tape.neurons)});
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
  const std::size_t n = stepper.info().observations;
  std::vector<double> values(n);
  stepper.observe(values.data());
  return to_numpy(std::move(values), {n});
}

}  // namespace

void bind_engine(nb::module_& module) {
  module.def("instruction_sets", &instruction_sets);
  module.def("native_problems", [] {
    nb::list list;
    for (const Info& info : native_problems()) list.append(to_dict(info));
    return list;
  });

  nb::class_<Engine>(module, "Engine")
      .def(nb::init<const std::string&, const Spec&, const std::string&>(), nb::arg("problem"),
           nb::arg("spec"), nb::arg("instruction_set") = "")
      .def_prop_ro("nparameters", [](const Engine& e) { return e.layout().parameters; })
      .def("evaluate", &evaluate, nb::arg("genotypes"), nb::arg("normalisation").none(),
           nb::arg("candidates"), nb::arg("seeds"), nb::arg("episodes"), nb::arg("collect").none(),
           nb::arg("limit"), nb::arg("threads") = 1)
      .def("record", &record, nb::arg("genotype"), nb::arg("normalisation").none(), nb::arg("seed"),
           nb::arg("episode"), nb::arg("limit"));

  nb::class_<Stepper>(module, "Stepper")
      .def("start", &Stepper::start, nb::arg("seed"), nb::arg("episode") = 0)
      .def_prop_rw("state", &state_of,
                   [](Stepper& s, Vector<const double> state) {
                     expect_size(state, s.info().states, "the state");
                     s.set_state(state.data());
                   })
      .def_prop_ro("observation", &observation_of)
      .def("step", [](Stepper& s, Vector<const double> action) {
        expect_size(action, s.info().discrete ? 1 : s.info().outputs, "the action");
        double reward = 0;
        const bool ended = s.step(action.data(), reward);
        return nb::make_tuple(reward, ended);
      });
  module.def("make_stepper", &make_stepper, nb::arg("problem"));
}

}  // namespace botschool
