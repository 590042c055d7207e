// Evaluates batches of episodes on all threads, with the best instruction set of this machine.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel.hpp"
#include "stepper.hpp"

namespace botschool {

/// Names of the instruction sets that this machine can run, the best last.
std::vector<std::string> instruction_sets();

/// Facts about every native problem.
std::vector<Info> native_problems();

/// A problem as compiled for an instruction set, "" for the best. Throws std::invalid_argument.
const Kernel* find_kernel(const std::string& problem, const std::string& instruction_set);

/// One native problem with one network layout.
class Engine {
 public:
  /// instruction_set: one of instruction_sets(), or "" for the best. setting: its user's
  /// choices; those of all jobs must have the same robots and observations. Throws std::invalid_argument.
  Engine(const std::string& problem, const Spec& spec, const std::string& instruction_set,
         const Setting& setting = {1});

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

std::unique_ptr<Stepper> make_stepper(const std::string& problem);

}  // namespace botschool
