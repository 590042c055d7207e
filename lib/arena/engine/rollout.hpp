// Whole episodes of a problem, L at a time in lockstep. A lane whose episode has ended gets the
// next job; its results depend only on its own job. When no job is left and half of the lanes are
// idle, the other half continues without them, if the problem's episodes can move.
#pragma once

#include <cstddef>
#include <cstring>
#include <limits>

#include "../../evonet/brain.hpp"
#include "kernel.hpp"
#include "simulation.hpp"

BOTSCHOOL_BEGIN

template <int L>
class Rollout {
 public:
  using Memory = BrainMemory<Real, L>;

  static std::size_t workspace(const Entry& entry, const Layout& layout, const Setting& setting) {
    const Info given = entry.given(setting);
    const int robots = given.robots;
    return made_by(entry).size + robots * brain_bytes(layout) + observation_bytes(layout, robots) +
           moments_bytes(layout) + action_bytes(given) +
           (record_bytes(entry, given, layout) + 63) / 64 * 64 + half_bytes(entry, layout, setting);
  }

  static void run(const Entry& entry, const Layout& layout, const Jobs& jobs, Queue& queue,
                  Recorder* recorder, void* workspace) {
    // lanes that never get a job compute, too: with zeros, because leftover numbers may be slow
    // (denormal)
    std::memset(workspace, 0, Rollout::workspace(entry, layout, jobs.setting));
    Rollout rollout(entry, layout, jobs, queue, recorder, static_cast<unsigned char*>(workspace));
    for (int l = 0; l < L; ++l) rollout.fill(l);
    rollout.group();
    rollout.run();
  }

 private:
  template <int>
  friend class Rollout;
  /// Fewer lanes than 8 leave registers half empty.
  static constexpr bool kHalves = L >= 16;

  static const Maker<L>& made_by(const Entry& entry) {
    if constexpr (L == kLanes)
      return entry.whole;
    else
      return entry.half;
  }
  static std::size_t half_bytes(const Entry& entry, const Layout& layout, const Setting& setting) {
    if constexpr (kHalves)
      if (entry.half.size) return Rollout<L / 2>::workspace(entry, layout, setting);
    return 0;
  }
  static std::size_t brain_bytes(const Layout& layout) {
    return (Memory::size(layout) * sizeof(Real) + 63) / 64 * 64;
  }
  static std::size_t observation_bytes(const Layout& layout, int robots) {
    return (robots * layout.spec.inputs * L * sizeof(Real) + 63) / 64 * 64;
  }
  static std::size_t moments_bytes(const Layout& layout) {
    return 2 * layout.spec.inputs * L * sizeof(double);
  }
  /// Actuators of a robot.
  static int actuators(const Info& info) { return info.discrete ? 1 : info.outputs; }
  static std::size_t action_bytes(const Info& info) {
    return info.robots * actuators(info) * L * sizeof(double);
  }
  /// Observations, actions and state of one lane.
  static std::size_t record_bytes(const Entry& entry, const Info& info, const Layout& layout) {
    return (info.robots * (layout.spec.inputs + actuators(info)) + entry.states) * sizeof(double);
  }

  Rollout(const Entry& entry, const Layout& layout, const Jobs& jobs, Queue& queue,
          Recorder* recorder, unsigned char* bytes)
      : entry_(entry),
        given_(entry.given(jobs.setting)),
        layout_(layout),
        jobs_(jobs),
        queue_(queue),
        recorder_(recorder),
        problem_(*made_by(entry).make(bytes)) {
    problem_.set(jobs.setting);
    bytes += made_by(entry).size;
    observations_ = reinterpret_cast<Real*>(bytes);
    bytes += observation_bytes(layout, robots_);
    for (int r = 0; r < robots_; ++r) {
      memory_[r].carve(layout, reinterpret_cast<Real*>(bytes));
      memory_[r].inputs = observations_ + std::ptrdiff_t(r) * layout.spec.inputs * L;
      bytes += brain_bytes(layout);
      memory_[r].groups = &groups_[r];
      for (int l = 0; l < L; ++l) candidate_[r][l] = in_network_[r][l] = -1;
    }
    moments_ = reinterpret_cast<double*>(bytes);
    action_ = moments_ + 2 * layout.spec.inputs * L;
    record_ = action_ + robots_ * actions_ * L;
    half_ = reinterpret_cast<unsigned char*>(record_) +
            (record_bytes(entry, given_, layout) + 63) / 64 * 64;
  }

  void run() {
    while (active_ > 0) {
      if (kHalves && entry_.half.size && !waiting_ && active_ <= L / 2 && !recorder_)
        return go_on_by_half();
      problem_.observe(observations_);
      if (collecting_ > 0) collect();
      for (int r = 0; r < robots_; ++r) {
        brain(r).step(keys_[r], steps_);
        choose_actions(r);
      }
      problem_.step(action_, reward_, ended_);
      if (recorder_) record();
      std::int64_t any = 0;
      for (int l = 0; l < L; ++l) {
        total_[l] += reward_[l];
        steps_[l] += 1;
        ended_[l] |= steps_[l] >= jobs_.setting.limit;
        any |= ended_[l];
      }
      if (any) finish_ended();
    }
  }

  /// Moves all episodes to half as many lanes and finishes them there.
  void go_on_by_half() {
    if constexpr (kHalves) {
      Rollout<L / 2> half(entry_, layout_, jobs_, queue_, nullptr, half_);
      int lane = 0;
      for (int l = 0; l < L; ++l)
        if (job_[l] >= 0) half.take(*this, l, lane++);
      while (lane < L / 2) half.fill(lane++);
      half.group();
      half.run();
    }
  }

  /// Continues the episode of another's lane.
  template <int W>
  void take(const Rollout<W>& other, int from, int lane) {
    job_[lane] = other.job_[from];
    total_[lane] = other.total_[from];
    steps_[lane] = other.steps_[from];
    for (int i = 0; i < entry_.info.states; ++i)
      problem_.state[i * L + lane] = other.problem_.state[i * W + from];
    problem_.refresh(lane);
    for (int i = 0; i < problem_.keeps; ++i)
      problem_.kept[i * L + lane] = other.problem_.kept[i * W + from];
    for (int r = 0; r < robots_; ++r) {
      keys_[r][lane] = other.keys_[r][from];
      load(lane, r, other.candidate_[r][from]);
      brain(r).copy(lane, other.brain(r), from);
    }
    ++active_;
    if (!wants_moments(job_[lane])) return;
    ++collecting_;
    for (int i = 0; i < 2 * layout_.spec.inputs; ++i)
      moments_[i * L + lane] = other.moments_[i * W + from];
  }

  Brain<Real, L> brain(int robot) const { return {layout_, memory_[robot]}; }

  /// Takes the next job into a lane, or leaves the lane idle.
  void fill(int lane) {
    const std::ptrdiff_t job = queue_.next();
    waiting_ = job >= 0;
    const bool unused = candidate_[0][lane] < 0;
    job_[lane] = job;
    total_[lane] = 0;
    steps_[lane] = 0;
    if (job < 0 && !unused) return;
    const NoiseKey key = job < 0 ? NoiseKey{0, 0} : NoiseKey{jobs_.seed[job], jobs_.episode[job]};
    Random random(key.seed, key.episode, Stream::start);
    problem_.build(lane, job < 0 ? nullptr : body(jobs_.candidate[job]));
    problem_.start(lane, random);  // an unused lane gets harmless contents
    for (int r = 0; r < robots_; ++r) keys_[r][lane] = robot_key(key, r);
    if (job < 0) return;
    ++active_;
    for (int r = 0; r < robots_; ++r) load(lane, r, jobs_.candidate[r * jobs_.count + job]);
    if (wants_moments(job)) {
      ++collecting_;
      for (int i = 0; i < 2 * layout_.spec.inputs; ++i) moments_[i * L + lane] = 0;
    }
    if (recorder_ && lane == 0) {
      for (int i = 0; i < entry_.states; ++i) record_[i] = problem_.state[i * L];
      recorder_->start(record_);
    }
  }

  void load(int lane, int robot, std::int32_t candidate) {
    if (candidate != candidate_[robot][lane]) {
      candidate_[robot][lane] = candidate;
      brain(robot).load(lane, genotype(robot, candidate), normalisation(candidate));
    }
    brain(robot).clear(lane);
  }

  void finish_ended() {
    for (int l = 0; l < L; ++l) {
      if (!ended_[l] || job_[l] < 0) continue;
      const std::ptrdiff_t job = job_[l];
      // the sign of a NaN differs between processors
      jobs_.fitness[job] =
          total_[l] == total_[l] ? total_[l] : std::numeric_limits<double>::quiet_NaN();
      jobs_.steps[job] = steps_[l];
      if (wants_moments(job)) {
        --collecting_;
        const int n = 2 * layout_.spec.inputs;
        for (int i = 0; i < n; ++i) jobs_.moments[job * n + i] = moments_[i * L + l];
      }
      --active_;
      fill(l);
    }
    group();
  }

  /// Groups the working lanes by candidate, so that weights of large layers are read once for all
  /// lanes with the same weights: in co-evolution a candidate meets several competitors, and a
  /// competitor several candidates.
  void group() {
    if (memory_[0].network_size == 0) return;
    for (int r = 0; r < robots_; ++r) {
      Groups<L>& groups = groups_[r];
      groups.count = 0;
      int used = 0;
      for (int l = 0; l < L; ++l) {
        if (job_[l] < 0 || grouped_before(r, l)) continue;
        const int network = network_of(r, candidate_[r][l]);
        groups.network[groups.count] = network;
        groups.finite[groups.count] = finite_[r][network];
        groups.first[groups.count++] = used;
        for (int other = l; other < L; ++other)
          if (job_[other] >= 0 && candidate_[r][other] == candidate_[r][l])
            groups.lane[used++] = other;
      }
      groups.first[groups.count] = used;
    }
  }

  bool grouped_before(int robot, int lane) const {
    for (int l = 0; l < lane; ++l)
      if (job_[l] >= 0 && candidate_[robot][l] == candidate_[robot][lane]) return true;
    return false;
  }

  /// Finds a place for a candidate's network among the brain's L networks, replacing one that no
  /// lane needs.
  int network_of(int robot, std::int32_t candidate) {
    std::int32_t* in_network = in_network_[robot];
    int free = -1;
    for (int n = 0; n < L; ++n) {
      if (in_network[n] == candidate) return n;
      bool needed = false;
      for (int l = 0; l < L; ++l) needed |= job_[l] >= 0 && candidate_[robot][l] == in_network[n];
      if (!needed) free = n;
    }
    in_network[free] = candidate;
    finite_[robot][free] = brain(robot).load_network(free, genotype(robot, candidate));
    return free;
  }

  const double* genotype(int robot, std::int32_t candidate) const {
    return jobs_.genotypes + jobs_.genotype_stride * candidate + robot * jobs_.robot_offset;
  }

  const double* normalisation(std::int32_t candidate) const {
    return jobs_.normalisation ? jobs_.normalisation + jobs_.normalisation_stride * candidate
                               : nullptr;
  }

  /// The body's parameters, which follow a candidate's network.
  const double* body(std::int32_t candidate) const {
    return jobs_.genotypes + jobs_.genotype_stride * candidate + layout_.parameters;
  }

  bool wants_moments(std::ptrdiff_t job) const { return jobs_.collect && jobs_.collect[job]; }

  /// Sums and sums of squares of the raw observations of all robots.
  void collect() {
    const int n = layout_.spec.inputs * L;
    for (int r = 0; r < robots_; ++r)
      for (int i = 0; i < n; ++i) {
        const double x = observations_[r * n + i];
        moments_[i] += x;
        moments_[n + i] += x * x;
      }
  }

  void choose_actions(int robot) {
    const Real* chosen = memory_[robot].actions;
    double* action = action_ + robot * actions_ * L;
    if (entry_.info.discrete) {
      int winner[L];
      Brain<Real, L>::argmax(chosen, layout_.spec.outputs, winner);
      for (int l = 0; l < L; ++l) action[l] = winner[l];
    } else {
      for (int i = 0; i < actions_ * L; ++i) action[i] = chosen[i];
    }
  }

  void record() {
    if (job_[0] < 0) return;
    double* observation = record_;
    double* action = observation + robots_ * layout_.spec.inputs;
    double* state = action + robots_ * actions_;
    for (int i = 0; i < robots_ * layout_.spec.inputs; ++i) observation[i] = observations_[i * L];
    for (int i = 0; i < robots_ * actions_; ++i) action[i] = action_[i * L];
    for (int i = 0; i < entry_.states; ++i) state[i] = problem_.state[i * L];
    for (int r = 0; r < robots_; ++r) recorder_->neurons(memory_[r].activations, L);
    recorder_->step(observation, action, state, reward_[0]);
  }

  const Entry& entry_;
  const Info given_;
  const int robots_ = given_.robots;
  const int actions_ = actuators(given_);

  const Layout& layout_;
  const Jobs& jobs_;
  Queue& queue_;
  Recorder* recorder_;
  Simulation<L>& problem_;
  Memory memory_[kMaxRobots];
  Real* observations_;
  double* moments_;      ///< [2 * inputs * L]
  double* action_;       ///< [robots * actuators * L]
  double* record_;       ///< for the recorder
  unsigned char* half_;  ///< workspace of half as many lanes

  alignas(64) double reward_[L], total_[L];
  alignas(64) std::int64_t ended_[L];
  alignas(64) int steps_[L];
  NoiseKey keys_[kMaxRobots][L];
  std::ptrdiff_t job_[L];
  std::int32_t candidate_[kMaxRobots][L];
  std::int32_t in_network_[kMaxRobots][L];  ///< genotype in the brain's networks
  bool finite_[kMaxRobots][L];              ///< whether they are
  Groups<L> groups_[kMaxRobots];
  int active_ = 0, collecting_ = 0;
  bool waiting_ = true;  ///< whether the queue may have another job
};

BOTSCHOOL_END
