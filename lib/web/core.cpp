// The core for a page: problems, networks and evolution behind functions that JavaScript calls with
// numbers and addresses (core.js). One thread; nothing here throws on input that page.py has checked.
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>
#include <optional>

#include "arena/engine/kernel.hpp"
#include "arena/engine/stepper.hpp"
#include "evolution/coevolution.hpp"
#include "generated/problem_list.hpp"

#ifdef __wasm__
#define EXPORT(name) extern "C" __attribute__((export_name(#name)))
// layout.cpp can throw for a Spec that Python has refused before; a page then stops.
extern "C" void* __cxa_allocate_exception(std::size_t size) { return std::malloc(size); }
extern "C" void __cxa_throw(void*, void*, void (*)(void*)) { std::abort(); }
extern "C" void __cxa_free_exception(void* exception) { std::free(exception); }
// Sentences that nobody reads would bring the C library's printing with them.
extern "C" int snprintf(char*, std::size_t, const char*, ...) { return 0; }
extern "C" int vsnprintf(char*, std::size_t, const char*, std::va_list) { return 0; }
namespace std::__1 {
[[noreturn]] void __libcpp_verbose_abort(const char*, ...) noexcept { std::abort(); }
}  // namespace std::__1
#else
#define EXPORT(name) extern "C"
#endif

namespace botschool {
namespace {

struct OneByOne final : Queue {
  explicit OneByOne(std::size_t count) : count(static_cast<std::ptrdiff_t>(count)) {}
  std::ptrdiff_t next() override { return at < count ? at++ : -1; }
  std::ptrdiff_t at = 0, count;
};

/// A problem and a network.
struct Task {
  const Kernel* kernel;
  Info info;
  Layout layout;

  void play(const Jobs& jobs, Recorder* recorder = nullptr) const {
    OneByOne queue(jobs.count);
    constexpr std::align_val_t alignment{64};
    void* memory =
        ::operator new(kernel->workspace(kernel->entry, layout, jobs.setting), alignment);
    kernel->run(kernel->entry, layout, jobs, queue, recorder, memory);
    ::operator delete(memory, alignment);
  }
};

/// A robot that is taken apart: step by step, in double precision.
struct Bench {
  Bench(const Task& task, bool heterogeneous, std::unique_ptr<Stepper> made)
      : stepper(std::move(made)),
        network(task.layout.spec, task.info.robots, heterogeneous),
        genotype(network.parameters()),
        blind(task.info.observations * task.info.robots),
        observation(blind.size()),
        action(network.actions()),
        activation(network.neurons()),
        state(task.info.states),
        discrete(task.info.discrete),
        outputs(task.info.outputs) {}

  void look() {
    stepper->get_state(state.data());
    stepper->observe(observation.data());
    for (std::size_t i = 0; i < blind.size(); ++i)
      if (blind[i]) observation[i] = 0.0;
  }

  /// Returns whether the episode has ended.
  bool step() {
    look();
    network.step(genotype.data(), observation.data(), action.data(), activation.data());
    if (frozen) network.set_memory(*frozen);
    if (discrete) {
      double choice = 0;
      for (int i = 1; i < outputs; ++i)
        if (action[i] > action[static_cast<int>(choice)]) choice = i;
      taken.assign(1, choice);
    } else {
      // a policy gives single precision, as everywhere
      taken.clear();
      for (const double value : action) taken.push_back(static_cast<float>(value));
    }
    const bool ended = stepper->step(taken.data(), reward);
    stepper->get_state(state.data());
    return ended;
  }

  Values& values(int which) {
    Values* all[] = {
        &genotype, &blind, &state, &observation, &taken, &activation, &network.normalisation};
    return *all[which];
  }

  std::unique_ptr<Stepper> stepper;
  Evonet network;
  Values genotype, blind, observation, action, activation, state, taken;
  std::optional<Values> frozen;
  double reward = 0;
  bool discrete;
  int outputs;
};

const Values& values_of(const Run& run, int which) {
  const Values* all[] = {&run.rows, &run.best, &run.bestg, &run.individuals, &run.meetings};
  return *all[which];
}

template <template <int> class... Problem>
std::unique_ptr<Stepper> stepper_of(const Task& task, ProblemList<Problem...>) {
  const KernelTable table = kernel_table_baseline();  // in the order of the list
  std::unique_ptr<Stepper> found;
  std::size_t i = 0;
  ((&table.kernel[i++] == task.kernel ? void(found = stepper<Problem>()) : void()), ...);
  return found;
}

}  // namespace
}  // namespace botschool

using namespace botschool;

EXPORT(allocate) void* allocate(int bytes) { return std::malloc(bytes); }
EXPORT(release) void release(void* place) { std::free(place); }

/// spec: the hyperparameters of hyperparameters.hpp, in that order. Null for an unknown problem.
EXPORT(task) Task* task(const char* problem, const double* spec) {
  const KernelTable table = kernel_table_baseline();
  for (std::size_t i = 0; i < table.count; ++i) {
    if (std::strcmp(problem, table.kernel[i].info.name)) continue;
    const Kernel& kernel = table.kernel[i];
    const Info info = kernel.given({kernel.info.limit, nullptr});
    Spec s;
    s.inputs = info.observations;
    s.outputs = info.outputs;
    s.low = info.low;
    s.high = info.high;
#define BOTSCHOOL_READ(type, name, value, least, greatest, explanation, choices) \
  s.name = static_cast<type>(*spec++);
    BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_READ)
#undef BOTSCHOOL_READ
    return new Task{&kernel, info, make_layout(s)};
  }
  return nullptr;
}

/// evaluation: episodes, pepisodes, limit, post_limit, heterogeneous, alive. algorithm: 0 and samplesize,
/// stepsize, noiseStdDev, wdecay, symseed of OpenAI-ES; 1 and popsize, -, mutrate of SSS; 2 and popsize,
/// stepsize, noiseStdDev, wdecay, random?, selsize, samplesize of coevo2.
EXPORT(run)
Run* run(const Task* task, const double* evaluation, const double* algorithm, double given) {
  const auto integer = [](double value) { return static_cast<int>(value); };
  const Evaluation e{integer(evaluation[0]), integer(evaluation[1]), integer(evaluation[2]),
                     integer(evaluation[3]), evaluation[4] != 0,     evaluation[5]};
  const auto seed = static_cast<std::uint64_t>(given);
  const Play play = [task](const Jobs& jobs) { task->play(jobs); };
  if (algorithm[0] == 2) {
    const CoevolutionRules rules{
        integer(algorithm[1]), integer(algorithm[6]), integer(algorithm[7]), algorithm[2],
        algorithm[3],          integer(algorithm[4]), algorithm[5] != 0};
    return new Coevolution(task->info, task->layout, e, rules, seed, play);
  }
  const Hyperparameters h{integer(algorithm[1]), algorithm[2], algorithm[3], integer(algorithm[4]),
                          algorithm[5] != 0};
  return new Evolution(task->info, task->layout, e, h, algorithm[0] != 0, seed, play);
}
EXPORT(advance) double advance(Run* run) {
  run->advance();
  return static_cast<double>(run->steps);
}
EXPORT(run_end) void run_end(Run* run) { delete run; }
/// Of the present generation, how many parts are done.
EXPORT(run_part) int run_part(const Run* run) { return run->part; }
/// 0 rows, 1 best, 2 bestg, 3 individuals of both sides, 4 their fitness.
EXPORT(run_values) const double* run_values(const Run* run, int which) {
  return values_of(*run, which).data();
}
EXPORT(run_count) int run_count(const Run* run, int which) {
  return static_cast<int>(values_of(*run, which).size());
}

/// Plays episodes: the return of each. candidate: a row of numbers of networks for each robot.
EXPORT(evaluate)
void evaluate(const Task* task, const double* genotypes, int size, const double* normalisation,
              int count, const std::int32_t* candidate, int heterogeneous, const double* seeds,
              const std::uint32_t* episodes, int limit, double* fitness, std::int32_t* steps) {
  std::vector<std::uint64_t> seed(seeds, seeds + count);
  const std::size_t offset = heterogeneous ? task->layout.parameters : 0;
  task->play({genotypes,
              std::size_t(size),
              normalisation,
              std::size_t(count),
              candidate,
              offset,
              seed.data(),
              episodes,
              nullptr,
              {limit, nullptr},
              fitness,
              steps,
              nullptr});
}

/// Writes the random network with a number that a seed begins with.
EXPORT(initial) void initial(const Task* task, double seed, int index, double* parameters) {
  initial_parameters(task->layout, static_cast<std::uint64_t>(seed),
                     static_cast<std::uint32_t>(index), parameters);
}
/// Writes 1 to `mask` for each parameter of a network that a neuron has: weights from it and to it, and
/// its bias. neuron: inputs, hidden and output neurons in this order.
EXPORT(mark) void mark(const Task* task, int neuron, double* mask) {
  const Layout& l = task->layout;
  const auto of_layer = [&](const Layer& layer, int rows_of_one) {
    for (int row = 0; row < layer.neurons; ++row) {
      const bool own = layer.first + row / rows_of_one == neuron;
      if (own && layer.bias >= 0) mask[layer.bias + row] = 1;
      for (int b = 0; b < layer.blocks; ++b) {
        const Connections& c = layer.block[b];
        for (int s = 0; s < c.senders; ++s)
          if (own || c.sender + s == neuron) mask[c.weights + row * c.stride + c.offset + s] = 1;
      }
    }
  };
  if (l.cells > 0) {
    Layer gates = l.gates;
    gates.first = l.spec.inputs;
    of_layer(gates, 4);
  }
  for (int i = 0; i < l.layers; ++i) of_layer(l.layer[i], 1);
}

EXPORT(bench) Bench* bench(const Task* task, int heterogeneous, int limit) {
  Bench* bench = new Bench(*task, heterogeneous != 0, stepper_of(*task, NativeProblems()));
  bench->stepper->set({limit, nullptr});
  return bench;
}
EXPORT(bench_end) void bench_end(Bench* bench) { delete bench; }
EXPORT(bench_start) void bench_start(Bench* bench, double seed, int episode) {
  const auto key = static_cast<std::uint64_t>(seed);
  bench->stepper->start(key, static_cast<std::uint32_t>(episode));
  bench->network.seed(key, static_cast<std::uint32_t>(episode));
  bench->network.reset();
  bench->frozen.reset();
  bench->look();
}
EXPORT(bench_step) int bench_step(Bench* bench) { return bench->step(); }
EXPORT(bench_reward) double bench_reward(const Bench* bench) { return bench->reward; }
/// Freezes what the network remembers as it is now, or lets it go on.
EXPORT(bench_freeze) void bench_freeze(Bench* bench, int frozen) {
  if (frozen)
    bench->frozen = bench->network.memory();
  else
    bench->frozen.reset();
}
/// Puts what is at the address of values 2 into the simulation.
EXPORT(bench_move) void bench_move(Bench* bench) { bench->stepper->set_state(bench->state.data()); }
/// 0 genotype, 1 blind (1 where a sensor is), 2 state, 3 observation, 4 action taken, 5 activations,
/// 6 normalisation.
EXPORT(bench_values) double* bench_values(Bench* bench, int which) {
  return bench->values(which).data();
}
EXPORT(bench_count) int bench_count(Bench* bench, int which) {
  return static_cast<int>(bench->values(which).size());
}
