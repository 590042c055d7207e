// Whole episodes of one problem, L at a time in lockstep. A lane whose episode has ended is refilled
// with the next job; what happens in a lane depends on its own job alone.
#pragma once

#include <cstddef>
#include <cstring>
#include <new>

#include "../evonet/brain.hpp"
#include "problem.hpp"

namespace botschool {

/// The scalar of evolution's networks.
using Real = float;

/// (candidate, seed, episode) triples to evaluate, and where the results go. Plain pointers into
/// arrays of the caller's; see Engine::evaluate for their meaning.
struct Jobs {
  const double* genotypes;
  std::size_t genotype_stride;
  const double* normalisation;
  const std::int32_t* candidate;
  const std::uint64_t* seed;
  const std::uint32_t* episode;
  const std::uint8_t* collect;
  int limit;
  double* fitness;
  std::int32_t* steps;
  double* moments;
};

/// Hands out the numbers of jobs to whoever asks; -1 when none is left.
class Queue {
 public:
  virtual std::ptrdiff_t next() = 0;

 protected:
  ~Queue() = default;
};

/// Is told each step of the first lane (for watching one episode).
class Recorder {
 public:
  virtual void start(const double* state) = 0;
  /// Activation i is at activations[i * stride].
  virtual void step(const double* observation, const double* action, const Real* activations,
                    int stride, const double* state, double reward) = 0;

 protected:
  ~Recorder() = default;
};

/// One problem's episodes, built for one instruction set.
struct Kernel {
  Info info;
  int lanes;                                ///< episodes in lockstep
  std::size_t (*workspace)(const Layout&);  ///< bytes that run() needs, 64-byte aligned
  void (*run)(const Layout&, const Jobs&, Queue&, Recorder*, void* workspace);
};

}  // namespace botschool

BOTSCHOOL_BEGIN

template <template <int> class Problem, int L>
class Rollout {
 public:
  using Memory = BrainMemory<Real, L>;

  static std::size_t workspace(const Layout& layout) {
    return kHeader + Memory::size(layout) * sizeof(Real) +
           2 * sizeof(double) * layout.spec.inputs * L + 64;
  }

  static void run(const Layout& layout, const Jobs& jobs, Queue& queue, Recorder* recorder,
                  void* workspace) {
    // lanes that never get a job compute too: with zeros, as leftovers may be slow (denormal)
    std::memset(workspace, 0, Rollout::workspace(layout));
    auto* bytes = static_cast<unsigned char*>(workspace);
    Memory memory;
    const std::size_t used = memory.carve(layout, reinterpret_cast<Real*>(bytes + kHeader));
    auto* moments =
        reinterpret_cast<double*>(bytes + kHeader + (used * sizeof(Real) + 63) / 64 * 64);
    Rollout rollout(layout, jobs, queue, recorder, memory, moments, *new (bytes) Problem<L>());
    rollout.run();
  }

 private:
  static constexpr std::size_t kHeader = (sizeof(Problem<L>) + 63) / 64 * 64;

  Rollout(const Layout& layout, const Jobs& jobs, Queue& queue, Recorder* recorder,
          const Memory& memory, double* moments, Problem<L>& problem)
      : layout_(layout),
        jobs_(jobs),
        queue_(queue),
        recorder_(recorder),
        memory_(memory),
        moments_(moments),
        problem_(problem),
        brain_(layout, memory) {}

  void run() {
    for (int l = 0; l < L; ++l) candidate_[l] = -1, fill(l);
    while (active_ > 0) {
      problem_.observe(memory_.inputs);
      if (collecting_ > 0) collect();
      brain_.step(keys_, steps_);
      choose_actions();
      problem_.step(action_, reward_, ended_);
      if (recorder_) record();
      std::int64_t any = 0;
      for (int l = 0; l < L; ++l) {
        total_[l] += reward_[l];
        steps_[l] += 1;
        ended_[l] |= steps_[l] >= jobs_.limit;
        any |= ended_[l];
      }
      if (any) finish_ended();
    }
  }

  /// Takes the next job into a lane, or leaves the lane idle.
  void fill(int lane) {
    const std::ptrdiff_t job = queue_.next();
    job_[lane] = job;
    total_[lane] = 0;
    steps_[lane] = 0;
    if (job < 0) {
      if (candidate_[lane] < 0) {  // never used: give it harmless contents
        Random random(0, 0, Stream::start);
        problem_.start(lane, random);
        keys_[lane] = {0, 0};
      }
      return;
    }
    ++active_;
    if (jobs_.candidate[job] != candidate_[lane]) {
      candidate_[lane] = jobs_.candidate[job];
      brain_.load(lane, jobs_.genotypes + jobs_.genotype_stride * candidate_[lane],
                  jobs_.normalisation);
    }
    brain_.clear(lane);
    keys_[lane] = {jobs_.seed[job], jobs_.episode[job]};
    Random random(keys_[lane].seed, keys_[lane].episode, Stream::start);
    problem_.start(lane, random);
    if (wants_moments(job)) {
      ++collecting_;
      for (int i = 0; i < 2 * layout_.spec.inputs; ++i) moments_[i * L + lane] = 0;
    }
    if (recorder_ && lane == 0) {
      double state[kMost];
      for (int i = 0; i < kStates; ++i) state[i] = problem_.state[i][0];
      recorder_->start(state);
    }
  }

  void finish_ended() {
    for (int l = 0; l < L; ++l) {
      if (!ended_[l] || job_[l] < 0) continue;
      const std::ptrdiff_t job = job_[l];
      jobs_.fitness[job] = total_[l];
      jobs_.steps[job] = steps_[l];
      if (wants_moments(job)) {
        --collecting_;
        const int n = 2 * layout_.spec.inputs;
        for (int i = 0; i < n; ++i) jobs_.moments[job * n + i] = moments_[i * L + l];
      }
      --active_;
      fill(l);
    }
  }

  bool wants_moments(std::ptrdiff_t job) const { return jobs_.collect && jobs_.collect[job]; }

  /// Sums and sums of squares of the raw observations.
  void collect() {
    const int n = layout_.spec.inputs * L;
    for (int i = 0; i < n; ++i) {
      const double x = memory_.inputs[i];
      moments_[i] += x;
      moments_[n + i] += x * x;
    }
  }

  void choose_actions() {
    if (Problem<L>::info().discrete) {
      int winner[L];
      Brain<Real, L>::argmax(memory_.actions, layout_.spec.outputs, winner);
      for (int l = 0; l < L; ++l) action_[l] = winner[l];
    } else {
      for (int i = 0; i < kActions * L; ++i) action_[i] = memory_.actions[i];
    }
  }

  void record() {
    if (job_[0] < 0) return;
    double observation[kMost], action[kMost], state[kMost];
    for (int i = 0; i < kObservations; ++i) observation[i] = memory_.inputs[i * L];
    for (int i = 0; i < kActions; ++i) action[i] = action_[i * L];
    for (int i = 0; i < kStates; ++i) state[i] = problem_.state[i][0];
    recorder_->step(observation, action, memory_.activations, L, state, reward_[0]);
  }

  static constexpr int kMost = 64;
  static constexpr int kStates = sizeof(Problem<1>::state) / sizeof(double);
  const int kActions = Problem<L>::info().discrete ? 1 : Problem<L>::info().outputs;
  const int kObservations = Problem<L>::info().observations;

  const Layout& layout_;
  const Jobs& jobs_;
  Queue& queue_;
  Recorder* recorder_;
  Memory memory_;
  double* moments_;
  Problem<L>& problem_;
  Brain<Real, L> brain_;

  alignas(64) double action_[kMost * L];
  alignas(64) double reward_[L], total_[L];
  alignas(64) std::int64_t ended_[L];
  alignas(64) int steps_[L];
  NoiseKey keys_[L];
  std::ptrdiff_t job_[L];
  std::int32_t candidate_[L];
  int active_ = 0, collecting_ = 0;
};

BOTSCHOOL_END
