#include "arena/engine/engine.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "bindings.hpp"

namespace botschool {
namespace {

nb::dict to_dict(const Robot& robot) {
  nb::dict d;
  d["name"] = robot.body->name;
  d["radius"] = robot.body->radius;
  d["axle"] = robot.body->axle;
  d["speed"] = robot.speed;
  nb::list directions;
  for (const double direction : robot.body->direction) directions.append(direction);
  d["directions"] = directions;
  d["range"] = robot.body->range;
  return d;
}

nb::dict to_dict(const Plan& plan) {
  nb::dict d;
  d["width"] = plan.width;
  d["height"] = plan.height;
  nb::list robots;
  for (int r = 0; r < plan.robots; ++r) robots.append(to_dict(plan.robot[r]));
  d["robots"] = robots;
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
  if (info.plan) d["plan"] = to_dict(*info.plan);
  return d;
}

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

Setting setting_of(int limit, std::optional<double> noise, const Table* wall, const Table* round) {
  if (limit < 1) throw std::invalid_argument("an episode needs at least one step.");
  if (noise && !(*noise >= 0)) throw std::invalid_argument("noise must not be negative.");
  return {limit, noise.value_or(-1), wall ? &wall->table : nullptr,
          round ? &round->table : nullptr};
}

/// `given` genotypes of one network each (one a robot), or genotypes that hold all networks.
std::size_t offset_of(const Engine& engine, bool heterogeneous, std::size_t given) {
  return heterogeneous && given == 1 ? engine.layout().parameters : 0;
}

void check_genotypes(const Engine& engine, std::size_t length, std::size_t offset) {
  const std::size_t needed = engine.layout().parameters + (engine.info().robots - 1) * offset;
  if (length < needed)
    throw std::invalid_argument("a genotype has " + std::to_string(length) + " values, but " +
                                std::to_string(needed) + " are needed.");
}

nb::tuple evaluate(const Engine& engine, Matrix<const double> genotypes,
                   std::optional<Vector<const double>> normalisation,
                   Matrix<const std::int32_t> candidates, Vector<const std::uint64_t> seeds,
                   Vector<const std::uint32_t> episodes,
                   std::optional<Vector<const std::uint8_t>> collect, int limit, int threads,
                   bool heterogeneous, std::optional<double> noise, const Table* wall_table,
                   const Table* round_table) {
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
  if (normalisation) expect_size(*normalisation, 2 * inputs, "the normalisation vector");
  for (std::size_t i = 0; i < rows * count; ++i) {
    const std::int32_t c = candidates.data()[i];
    if (c < 0 || std::size_t(c) >= genotypes.shape(0))
      throw std::invalid_argument("there is no candidate " + std::to_string(c) + ".");
  }
  const Setting setting = setting_of(limit, noise, wall_table, round_table);
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
                  moments.data()};
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
                std::uint32_t episode, int limit, bool heterogeneous, std::optional<double> noise,
                const Table* wall_table, const Table* round_table) {
  const std::size_t rows = genotypes.shape(0), robots = engine.info().robots;
  const std::size_t offset = offset_of(engine, heterogeneous, rows);
  if (rows != 1 && rows != robots)
    throw std::invalid_argument("a genotype is needed for all robots, or one for each.");
  check_genotypes(engine, genotypes.shape(1), offset);
  if (normalisation)
    expect_size(*normalisation, 2 * engine.layout().spec.inputs, "the normalisation vector");
  std::int32_t candidates[kMostRobots] = {};
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
                  setting_of(limit, noise, wall_table, round_table),
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
           nb::arg("limit"), nb::arg("threads") = 1, nb::arg("heterogeneous") = false,
           nb::arg("noise").none() = nb::none(), nb::arg("wall_table").none() = nb::none(),
           nb::arg("round_table").none() = nb::none())
      .def("record", &record, nb::arg("genotypes"), nb::arg("normalisation").none(),
           nb::arg("seed"), nb::arg("episode"), nb::arg("limit"), nb::arg("heterogeneous") = false,
           nb::arg("noise").none() = nb::none(), nb::arg("wall_table").none() = nb::none(),
           nb::arg("round_table").none() = nb::none());

  nb::class_<Table>(module, "Table")
      .def(nb::init<double, double, nb::ndarray<const double, nb::ndim<3>, nb::c_contig>>(),
           nb::arg("first"), nb::arg("step"), nb::arg("values"));

  nb::class_<Stepper>(module, "Stepper")
      .def(
          "set",
          [](Stepper& s, int limit, std::optional<double> noise, const Table* wall,
             const Table* round) { s.set(setting_of(limit, noise, wall, round)); },
          nb::arg("limit"), nb::arg("noise").none() = nb::none(),
          nb::arg("wall_table").none() = nb::none(), nb::arg("round_table").none() = nb::none(),
          nb::keep_alive<1, 4>(), nb::keep_alive<1, 5>())
      .def("start", &Stepper::start, nb::arg("seed"), nb::arg("episode") = 0)
      .def_prop_rw("state", &state_of,
                   [](Stepper& s, Vector<const double> state) {
                     expect_size(state, s.info().states, "the state");
                     s.set_state(state.data());
                   })
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
