// Evaluates batches of episodes on all threads, with the best instruction set of this machine.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rollout.hpp"

namespace botschool {

/// Names of the instruction sets that this machine can run, the best last.
std::vector<std::string> instruction_sets();

/// Facts about every native problem.
std::vector<Info> native_problems();

/// One native problem with one network layout.
class Engine {
 public:
  /// instruction_set: one of instruction_sets(), or "" for the best. arena: what is chosen about one, or
  /// null; all jobs must have a choice with the same robots and observations. Throws
  /// std::invalid_argument.
  Engine(const std::string& problem, const Spec& spec, const std::string& instruction_set,
         const ArenaOptions* arena = nullptr);

  const Layout& layout() const { return layout_; }
  const Info& info() const { return info_; }

  /// Evaluates the jobs on up to `threads` threads; the results do not depend on how many.
  void evaluate(const Jobs& jobs, int threads) const;
  /// Evaluates the first job and reports every step.
  void record(const Jobs& jobs, Recorder& recorder) const;

 private:
  void run(const Jobs& jobs, Queue& queue, Recorder* recorder) const;

  Layout layout_;
  const Kernel* kernel_;
  Info info_;
  mutable std::atomic<double> seconds_per_job_{1.0};  ///< of one thread, in the last batch
};

/// A native problem step by step, in double precision: for Gymnasium, for tests, for looking.
class Stepper {
 public:
  virtual ~Stepper() = default;
  virtual Info info() const = 0;
  virtual void set(const Setting& setting) = 0;
  /// The body of the episodes from the next start on, info().body parameters.
  virtual void set_body(const double* parameters) = 0;
  virtual void start(std::uint64_t seed, std::uint32_t episode) = 0;
  virtual void set_state(const double* state) = 0;
  virtual void get_state(double* state) const = 0;
  /// The least and the greatest value of each observation of a robot, or infinities.
  virtual void bounds(double* low, double* high) const = 0;
  virtual void observe(double* observation) const = 0;
  /// Returns whether the episode has ended (a time limit is the caller's affair).
  virtual bool step(const double* action, double& reward) = 0;

  /// What stands in an arena, a row of kObject values each.
  virtual int objects() const = 0;
  virtual void get_objects(double* rows) const = 0;
  virtual void set_objects(const double* rows) = 0;
  /// The first robot that overlaps something where it stands, or -1.
  virtual int blocked() const = 0;
};

std::unique_ptr<Stepper> make_stepper(const std::string& problem);

}  // namespace botschool
