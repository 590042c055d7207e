// Whole episodes: the same bits on every instruction set, for any number of threads and of jobs.
#include "arena/engine/engine.hpp"

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "arena/engine/simulated.hpp"
#include "check.hpp"

using namespace botschool;

namespace {

constexpr int kLimit = 60;

Spec spec_for(const Info& info, int architecture, int nhiddens) {
  Spec spec;
  spec.inputs = info.observations;
  spec.outputs = info.outputs;
  spec.nhiddens = nhiddens;
  spec.architecture = architecture;
  spec.bias = spec.clip = spec.normalize = 1;
  spec.action_noise = architecture == feedforward ? no_noise : diagonal_gaussian_noise;
  if (!info.discrete && nhiddens == 5) {
    spec.nbins = 3;
    spec.low = info.low;
    spec.high = info.high;
  }
  return spec;
}

/// A batch that owns its arrays: `count` jobs of five candidates, with a network for each robot and
/// the parameters of a body.
struct Batch {
  explicit Batch(const Engine& engine, int count)
      : inputs(engine.layout().spec.inputs), robots(engine.info().robots) {
    length = engine.layout().parameters;
    stride = robots * length + engine.info().body;
    genotypes.resize(5 * stride);
    for (int c = 0; c < 5; ++c) {
      double* genotype = genotypes.data() + c * stride;
      for (int r = 0; r < robots; ++r, genotype += length)
        initial_parameters(engine.layout(), 3, c * robots + r, genotype);
      Random random(3, c, Stream::start);
      for (int i = 0; i < engine.info().body; ++i) genotype[i] = random.gaussian();
    }
    normalisation.assign(2 * inputs, 0.7);
    for (int r = 0; r < robots; ++r)
      for (int i = 0; i < count; ++i) candidate.push_back(i % 5);
    for (int i = 0; i < count; ++i) {
      seed.push_back(100 + i / 3);
      episode.push_back(i);
      collect.push_back(i % 2);
    }
    fitness.assign(count, -1);
    steps.assign(count, -1);
    moments.assign(2 * inputs * count, 0);
  }
  Jobs jobs() {
    return {genotypes.data(), stride,       normalisation.data(), seed.size(),    candidate.data(),
            length,           seed.data(),  episode.data(),       collect.data(), {kLimit},
            fitness.data(),   steps.data(), moments.data()};
  }
  bool equals(const Batch& other) const {
    return std::memcmp(fitness.data(), other.fitness.data(), 8 * fitness.size()) == 0 &&
           std::memcmp(moments.data(), other.moments.data(), 8 * moments.size()) == 0 &&
           steps == other.steps;
  }

  int inputs, robots;
  std::size_t length, stride;  ///< of a network, of a genotype
  std::vector<double> genotypes, normalisation, fitness, moments;
  std::vector<std::int32_t> candidate, steps;
  std::vector<std::uint64_t> seed;
  std::vector<std::uint32_t> episode;
  std::vector<std::uint8_t> collect;
};

template <class F>
void for_each_kind(F f) {
  for (const Info& info : native_problems())
    for (int architecture = 0; architecture < 4; ++architecture)
      for (int nhiddens : {0, 5, 7}) f(info, spec_for(info, architecture, nhiddens));
}

}  // namespace

TEST(all_problems_and_architectures_run) {
  for_each_kind([](const Info& info, const Spec& spec) {
    const Engine engine(info.name, spec, "");
    Batch batch(engine, 20);
    engine.evaluate(batch.jobs(), 1);
    double seen = 0;
    for (int i = 0; i < 20; ++i) {
      CHECK(std::isfinite(batch.fitness[i]));
      CHECK(batch.steps[i] >= 1 && batch.steps[i] <= kLimit);
      // sums of squares grow where data are collected (unless sensors see nothing), and nowhere else
      const double* squares = &batch.moments[(2 * i + 1) * batch.inputs];
      double total = 0;
      for (int k = 0; k < batch.inputs; ++k) total += squares[k];
      CHECK(total == 0 || batch.collect[i]);
      seen += total;
    }
    CHECK(seen > 0);
  });
}

TEST(instruction_sets_and_threads_give_the_same_bits) {
  for_each_kind([](const Info& info, const Spec& spec) {
    const Engine baseline(info.name, spec, "baseline");
    Batch expected(baseline, 40);
    baseline.evaluate(expected.jobs(), 1);
    for (const std::string& name : instruction_sets())
      for (int threads : {1, 2, 5}) {
        const Engine engine(info.name, spec, name);
        Batch batch(engine, 40);
        engine.evaluate(batch.jobs(), threads);
        CHECK(batch.equals(expected));
      }
  });
}

TEST(lanes_are_refilled_whatever_the_number_of_jobs) {
  const Info info = native_problems()[0];
  const Engine engine(info.name, spec_for(info, recurrent, 5), "");
  Batch all(engine, 200);
  engine.evaluate(all.jobs(), 1);
  for (int count : {0, 1, 2, 15, 16, 17, 31, 33, 199}) {
    Batch some(engine, count);
    engine.evaluate(some.jobs(), count % 3 + 1);
    for (int i = 0; i < count; ++i)
      CHECK(some.fitness[i] == all.fitness[i] && some.steps[i] == all.steps[i]);
  }
}

TEST(jobs_need_neither_normalisation_nor_collecting) {
  const Info info = native_problems()[1];
  Spec spec = spec_for(info, lstm, 5);
  const Engine engine(info.name, spec, "");
  Batch batch(engine, 20), neutral(engine, 20);
  Jobs jobs = batch.jobs();
  jobs.normalisation = nullptr;
  jobs.collect = nullptr;
  jobs.moments = nullptr;
  engine.evaluate(jobs, 2);
  for (int i = 0; i < 2 * neutral.inputs; ++i) neutral.normalisation[i] = i >= neutral.inputs;
  engine.evaluate(neutral.jobs(), 2);
  CHECK(batch.fitness == neutral.fitness);
}

TEST(a_recorded_episode_is_the_evaluated_one) {
  struct Sum final : Recorder {
    void start(const double* state) override { stepper->set_state(state); }
    void neurons(const Real* activations, int stride) override {
      const int n = stepper->info().observations;
      for (int i = 0; i < n; ++i) inputs.push_back(activations[std::ptrdiff_t(i) * stride]);
    }
    void step(const double* observation, const double* action, const double* state,
              double reward) override {
      const Info info = stepper->info();
      std::vector<double> seen(info.robots * info.observations), now(info.states);
      stepper->observe(seen.data());
      CHECK(inputs.size() == seen.size());
      for (std::size_t i = 0; i < seen.size(); ++i) {
        // an arena's readings are computed in the network's precision
        const double most = info.plan ? 1e-4 : 0;
        CHECK(std::fabs(static_cast<float>(seen[i]) - observation[i]) <= most);
        same_inputs &= inputs[i] == observation[i];
      }
      inputs.clear();
      double own = 0;
      stepper->step(action, own);
      stepper->get_state(now.data());
      CHECK(own == reward && std::memcmp(now.data(), state, 8 * now.size()) == 0);
      total += reward;
      ++steps;
    }
    std::unique_ptr<Stepper> stepper;
    std::vector<double> inputs;
    double total = 0;
    int steps = 0;
    bool same_inputs = true;
  };
  for_each_kind([](const Info& info, Spec spec) {
    spec.normalize = spec.clip = 0;
    const Engine engine(info.name, spec, "");
    Batch batch(engine, 1), again(engine, 1);
    engine.evaluate(batch.jobs(), 1);
    Sum sum;
    sum.stepper = make_stepper(info.name);
    sum.stepper->set({kLimit});
    sum.stepper->start(batch.seed[0], batch.episode[0]);
    engine.record(again.jobs(), sum);
    CHECK(again.equals(batch));
    CHECK(sum.total == batch.fitness[0] && sum.steps == batch.steps[0] && sum.same_inputs);
  });
}

TEST(wild_genotypes_disturb_nobody) {
  for (double value : {1e300, -1e300, std::nan(""), HUGE_VAL})
    for_each_kind([&](const Info& info, const Spec& spec) {
      const Engine engine(info.name, spec, "");
      Batch calm(engine, 30), wild(engine, 30);
      for (std::size_t i = 0; i < wild.stride; ++i) wild.genotypes[2 * wild.stride + i] = value;
      engine.evaluate(calm.jobs(), 1);
      engine.evaluate(wild.jobs(), 1);
      for (int i = 0; i < 30; ++i)
        CHECK(calm.candidate[i] == 2 || calm.fitness[i] == wild.fitness[i]);
    });
}

TEST(engine_refuses_what_does_not_fit) {
  const Info info = native_problems()[0];
  Spec spec = spec_for(info, feedforward, 5);
  CHECK(refused([&] { Engine("no such", spec, ""); }, "no native problem 'no such'"));
  CHECK(refused([&] { Engine(info.name, spec, "mmx"); }, "no instruction set 'mmx'"));
  CHECK(refused([] { make_stepper("no such"); }, "no native problem"));
  spec.inputs += 1;
  CHECK(refused([&] { Engine(info.name, spec, ""); }, "inputs and"));
}

namespace {

/// 200 observations, 70 actuators: more than any problem of ours.
template <int L>
struct Wide : ProblemBase {
  static Info info() {
    Info info;
    info.name = "Wide";
    info.observations = 200;
    info.outputs = 70;
    info.states = 90;
    info.limit = 5;
    return info;
  }
  double state[90][L];
  void start(int lane, Random& random) {
    for (auto& value : state) value[lane] = random.uniform(-1, 1);
  }
  template <class T>
  void observe(T* out) const {
    for (int i = 0; i < 200 * L; ++i) out[i] = static_cast<T>(state[i / L % 90][i % L]);
  }
  void step(const double* action, double* reward, std::int64_t* ended) {
    for (int l = 0; l < L; ++l) {
      reward[l] = action[69 * L + l];
      state[89][l] += reward[l];
      ended[l] = 0;
    }
  }
};

}  // namespace

TEST(a_problem_of_many_observations_and_actuators_is_recorded) {
  struct Last final : Recorder {
    void start(const double* state) override { first = state[89]; }
    void neurons(const Real*, int) override {}
    void step(const double* observation, const double* action, const double* state,
              double reward) override {
      CHECK(observation[199] == static_cast<Real>(observation[109]));
      CHECK(action[69] == reward);
      total += reward;
      last = state[89];
      ++steps;
    }
    double first = 0, last = 0, total = 0;
    int steps = 0;
  };
  struct Once final : Queue {
    std::ptrdiff_t next() override { return left-- > 0 ? 0 : -1; }
    int left = 1;
  };
  Spec spec;
  spec.inputs = 200;
  spec.outputs = 70;
  spec.nhiddens = 3;
  const Layout layout = make_layout(spec);
  std::vector<double> genotype(layout.parameters), moments(400);
  initial_parameters(layout, 1, 0, genotype.data());
  const std::int32_t candidate = 0;
  const std::uint64_t seed = 1;
  const std::uint32_t episode = 0;
  const std::uint8_t collect = 1;
  double fitness = 0;
  std::int32_t steps = 0;
  const Jobs jobs{genotype.data(), genotype.size(), nullptr,  1,   &candidate, 0,
                  &seed,           &episode,        &collect, {5}, &fitness,   &steps,
                  moments.data()};
  const Entry wide = entry<Wide>();
  const std::size_t bytes = workspace(&wide, layout, jobs.setting);
  std::vector<double> memory(bytes / sizeof(double) + 16);
  void* place = memory.data();
  std::size_t room = memory.size() * sizeof(double);
  std::align(64, bytes, place, room);
  Last last;
  Once queue;
  run(&wide, layout, jobs, queue, &last, place);
  CHECK(last.steps == 5 && steps == 5);
  CHECK(std::fabs(last.total - fitness) < 1e-12);
  CHECK(std::fabs(last.last - last.first - fitness) < 1e-12);
}
