// The core for a page: problems, networks and evolution behind functions that JavaScript calls with
// numbers and addresses (core.js). One thread; nothing here throws on input that page.py has checked.
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>
#include <optional>

#include "arena/engine/expression.hpp"
#include "arena/engine/kernel.hpp"
#include "arena/engine/stepper.hpp"
#include "evolution/coevolution.hpp"
#include "export.hpp"
#include "generated/problem_list.hpp"
#include "learning.hpp"

#ifdef __wasm__
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
#endif

namespace botschool {
namespace {

struct OneByOne final : Queue {
  explicit OneByOne(std::size_t count) : count(static_cast<std::ptrdiff_t>(count)) {}
  std::ptrdiff_t next() override { return at < count ? at++ : -1; }
  std::ptrdiff_t at = 0, count;
};

/// Whether this core trains by policy gradients; two robots do not, and their page shall be small.
constexpr bool kTrains = BOTSCHOOL_TRAINS;

/// A problem and a network, or an agent.
struct Task {
  const Kernel* kernel;
  Info info;
  Layout layout;
  std::optional<policy_gradient::Hyperparameters> agent{};
  Program program{};
  bool own = false;  ///< whether the program pays, in place of the problem
  std::string told{};

  const Program* pays() const { return own ? &program : nullptr; }

  void play(const Jobs& given, Recorder* recorder = nullptr) const {
    Jobs jobs = given;
    jobs.setting.program = pays();
    OneByOne queue(jobs.count);
    constexpr std::align_val_t alignment{64};
    void* memory =
        ::operator new(kernel->workspace(kernel->entry, layout, jobs.setting), alignment);
    kernel->run(kernel->entry, layout, jobs, queue, recorder, memory);
    ::operator delete(memory, alignment);
  }
};

/// A robot that is taken apart, step by step; how it thinks, a subclass says.
struct Bench {
  Bench(const Task& task, std::unique_ptr<Stepper> made)
      : stepper(std::move(made)),
        blind(task.info.observations * task.info.robots),
        observation(blind.size()),
        state(task.info.states),
        taken(task.info.discrete ? 1 : task.info.outputs * task.info.robots),
        body(task.info.body) {}
  virtual ~Bench() = default;
  virtual void start(std::uint64_t, std::uint32_t) {}
  /// Turns `observation` into `taken`, and says what each neuron does.
  virtual void think() = 0;
  virtual void freeze(bool) {}

  void look() {
    stepper->get_state(state.data());
    stepper->observe(observation.data());
    for (std::size_t i = 0; i < blind.size(); ++i)
      if (blind[i]) observation[i] = 0.0;
  }

  /// Returns whether the episode has ended; by hand: with the action that `taken` holds.
  bool step(bool by_hand) {
    look();
    if (!by_hand) think();
    const bool ended = stepper->step(taken.data(), reward);
    stepper->get_state(state.data());
    return ended;
  }

  Values& values(int which) {
    Values* all[] = {&genotype, &blind,      &state,         &observation,
                     &taken,    &activation, &normalisation, &body};
    return *all[which];
  }

  std::unique_ptr<Stepper> stepper;
  Values genotype, blind, observation, activation, state, taken, normalisation, body;
  double reward = 0;
};

/// With the networks of evolution, in double precision.
struct EvonetBench final : Bench {
  EvonetBench(const Task& task, bool heterogeneous, std::unique_ptr<Stepper> made)
      : Bench(task, std::move(made)),
        network(task.layout.spec, task.info.robots, heterogeneous),
        action(network.actions()),
        discrete(task.info.discrete),
        outputs(task.info.outputs) {
    genotype.resize(network.parameters());
    activation.resize(network.neurons());
    normalisation = network.normalisation;
  }

  void start(std::uint64_t key, std::uint32_t episode) override {
    network.seed(key, episode);
    network.reset();
    frozen.reset();
  }

  void think() override {
    network.normalisation = normalisation;
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
  }

  void freeze(bool on) override {
    if (on)
      frozen = network.memory();
    else
      frozen.reset();
  }

  Evonet network;
  Values action;
  std::optional<Values> frozen;
  bool discrete;
  int outputs;
};

/// With an agent's networks.
struct AgentBench final : Bench {
  AgentBench(const Task& task, std::unique_ptr<Stepper> made)
      : Bench(task, std::move(made)), acting(task.info, *task.agent) {
    genotype.resize(acting.parameters());
    activation.resize(acting.neurons());
    normalisation.resize(2 * task.info.observations, 0.0);
    std::fill(normalisation.begin() + task.info.observations, normalisation.end(), 1.0);
  }

  void think() override { acting.act(genotype, normalisation, observation, taken, activation); }

  Acting acting;
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

const Kernel* find(const char* problem) {
  const KernelTable table = kernel_table_baseline();
  for (std::size_t i = 0; i < table.count; ++i)
    if (!std::strcmp(problem, table.kernel[i].info.name)) return &table.kernel[i];
  return nullptr;
}

/// The names of the settings of a group, in the order in which the functions below read their values.
EXPORT(settings) const char* settings(const char* group) { return names_of_settings(group); }

/// spec: the settings of the group "network". Null for an unknown problem.
EXPORT(task) Task* task(const char* problem, const double* spec) {
  const Kernel* kernel = find(problem);
  if (!kernel) return nullptr;
  const Info info = kernel->given({kernel->info.limit, nullptr});
  Spec s;
  s.inputs = info.observations;
  s.outputs = info.outputs;
  s.low = info.low;
  s.high = info.high;
#define BOTSCHOOL_READ(type, name, value, least, greatest, explanation, choices) \
  s.name = static_cast<type>(*spec++);
  BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_READ)
#undef BOTSCHOOL_READ
  return new Task{kernel, info, make_layout(s)};
}

/// An agent of policy gradients. spec: the settings of the group "agent"; then three times how many hidden
/// layers and how many neurons each has: those in common, the policy's, the critic's.
EXPORT(agent) Task* agent(const char* problem, const double* spec) {
  const Kernel* kernel = find(problem);
  if (!kTrains || !kernel) return nullptr;
  policy_gradient::Hyperparameters h;
  const AgentSettings given = AgentSettings::read(spec);
  spec += count_of(AgentSettings::names);
  h.normalize = given.normalize;
  h.ortho_init = given.ortho_init;
  h.relu = given.relu;
  h.log_std_init = given.log_std_init;
  for (std::vector<int>* layers : {&h.shared, &h.pi, &h.vf}) {
    layers->resize(static_cast<std::size_t>(*spec++));
    for (int& neurons : *layers) neurons = static_cast<int>(*spec++);
  }
  return new Task{kernel, kernel->info, {}, h};
}

/// A reward and an end of episodes of one's own, from now on; "" for the problem's. Returns "", or what is
/// wrong with them.
EXPORT(pay) const char* pay(Task* task, const char* reward, const char* ends) {
  const auto stepper = stepper_of(*task, NativeProblems());
  task->told = compile(*stepper, reward, ends, task->program);
  task->own = task->told.empty() && (task->program.pays || task->program.ends);
  return task->told.c_str();
}

/// What a reward may name: lines of name, unit and meaning with tabs between them.
EXPORT(quantities) const char* list_quantities(Task* task) {
  task->told.clear();
  for (const Quantity& q : quantities(*stepper_of(*task, NativeProblems())))
    task->told += q.name + "\t" + q.unit + "\t" + q.meaning + "\n";
  return task->told.c_str();
}

Run* lesson(const Task& task, const double* evaluation, const double* algorithm,
            std::uint64_t seed) {
  const TrainingSettings t = TrainingSettings::read(evaluation);
  const PPOSettings a = PPOSettings::read(algorithm);
  Curriculum c{*task.agent,
               {a.learning_rate, a.learning_rate_falls},
               {a.clip_range, a.clip_range_falls},
               {a.clip_range_vf, a.clip_range_vf_falls},
               t.steps,
               t.evaluations,
               t.episodes,
               t.limit};
  c.h.seed = seed;
  c.h.setting.program = task.pays();
  c.h.n_envs = a.n_envs;
  c.h.n_steps = a.n_steps;
  c.h.batch_size = a.batch_size;
  c.h.n_epochs = a.n_epochs;
  c.h.gamma = a.gamma;
  c.h.gae_lambda = a.gae_lambda;
  c.h.ent_coef = a.ent_coef;
  c.h.vf_coef = a.vf_coef;
  c.h.max_grad_norm = a.max_grad_norm;
  c.h.target_kl = a.target_kl;
  c.h.normalize_advantage = a.normalize_advantage;
  return new Lesson(*task.kernel, c);
}

/// evaluation: the settings of the group "evaluation", or of an agent "training"; algorithm: those of the
/// group `name`.
EXPORT(run)
Run* run(const Task* task, const char* name, const double* evaluation, const double* algorithm,
         double given) {
  const auto seed = static_cast<std::uint64_t>(given);
  const auto is = [name](const char* known) { return !std::strcmp(name, known); };
  if (kTrains && is("PPO")) return lesson(*task, evaluation, algorithm, seed);
  const Evaluation e = Evaluation::read(evaluation);
  const Play play = [task](const Jobs& jobs) { task->play(jobs); };
  if (is("coevo2")) {
    const Coevo2Settings rules = Coevo2Settings::read(algorithm);
    return new Coevolution(task->info, task->layout, e, rules, seed, play);
  }
  const StrategyMaker strategy = is("SSS") ? maker<SSS>(SSSSettings::read(algorithm))
                                           : maker<OpenAIES>(OpenAIESSettings::read(algorithm));
  return new Evolution(task->info, task->layout, e, strategy, seed, play);
}
EXPORT(advance) double advance(Run* run) {
  run->advance();
  return static_cast<double>(run->steps);
}
EXPORT(run_end) void run_end(Run* run) { delete run; }
/// Of the present generation, how many parts are done; -1: a training broke down.
EXPORT(run_part) int run_part(const Run* run) { return run->broken ? -1 : run->part; }
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
  if (kTrains && task->agent) {
    policy_gradient::Hyperparameters h = *task->agent;
    h.seed = static_cast<std::uint64_t>(seed);
    const policy_gradient::Agent agent = agent_of(task->info, h);
    std::vector<float> made(agent.size);
    initialise(agent, h, made.data());
    std::copy(made.begin(), made.end(), parameters);
    return;
  }
  initial_parameters(task->layout, static_cast<std::uint64_t>(seed),
                     static_cast<std::uint32_t>(index), parameters);
}

/// Tests compare these two with Python's.
EXPORT(normals) void normals(double seed, double generation, double* values, int count) {
  Normals numbers(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(generation));
  for (int i = 0; i < count; ++i) values[i] = numbers.next();
}
EXPORT(logarithms) void logarithms(double* values, int count) {
  for (int i = 0; i < count; ++i) values[i] = log_of_rest(values[i]);
}

/// Writes 1 to `mask` for each parameter of a network that a neuron has: weights from it and to it, and
/// its bias. neuron: inputs, hidden and output neurons in this order.
EXPORT(mark) void mark(const Task* task, int neuron, double* mask) {
  if (kTrains && task->agent) return Acting(task->info, *task->agent).mark(neuron, mask);
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
  auto stepper = stepper_of(*task, NativeProblems());
  Bench* bench;
  if (kTrains && task->agent)
    bench = new AgentBench(*task, std::move(stepper));
  else
    bench = new EvonetBench(*task, heterogeneous != 0, std::move(stepper));
  bench->stepper->set({limit, nullptr, nullptr, task->pays()});
  return bench;
}
EXPORT(bench_end) void bench_end(Bench* bench) { delete bench; }
EXPORT(bench_start) void bench_start(Bench* bench, double seed, int episode) {
  const auto key = static_cast<std::uint64_t>(seed);
  if (!bench->body.empty()) bench->stepper->set_body(bench->body.data());
  bench->stepper->start(key, static_cast<std::uint32_t>(episode));
  bench->start(key, static_cast<std::uint32_t>(episode));
  bench->look();
}
EXPORT(bench_step) int bench_step(Bench* bench) { return bench->step(false); }
/// Steps with the action in values 4, which the page has written, in place of the robot's.
EXPORT(bench_hand) int bench_hand(Bench* bench) { return bench->step(true); }
/// Thinks about the observation in values 3 without a step: values 4 and 5.
EXPORT(bench_think) void bench_think(Bench* bench) { bench->think(); }
EXPORT(bench_reward) double bench_reward(const Bench* bench) { return bench->reward; }
/// Freezes what the network remembers as it is now, or lets it go on.
EXPORT(bench_freeze) void bench_freeze(Bench* bench, int frozen) { bench->freeze(frozen != 0); }
/// Puts the state at the address of values 2 into the simulation.
EXPORT(bench_move) void bench_move(Bench* bench) { bench->stepper->set_state(bench->state.data()); }
/// 0 genotype, 1 blind (1 where a sensor is), 2 state, 3 observation, 4 action taken, 5 activations,
/// 6 normalisation, 7 the body that the next episode begins with.
EXPORT(bench_values) double* bench_values(Bench* bench, int which) {
  return bench->values(which).data();
}
EXPORT(bench_count) int bench_count(Bench* bench, int which) {
  return static_cast<int>(bench->values(which).size());
}
