// One training of a native problem: an agent, its experience and its learner; section 6 of
// walkthroughs/ppo.py.
#pragma once

#include <memory>
#include <string>

#include "../arena/engine/engine.hpp"
#include "experience.hpp"
#include "learner.hpp"

namespace botschool::policy_gradient {

class Training {
 public:
  /// limit: longest episode, 0 for the problem's own. instruction_set: "" for the best. Throws
  /// std::invalid_argument.
  Training(const std::string& problem, int limit, const Hyperparameters& h,
           const std::string& instruction_set);
  /// Of a problem and the inner loops of one instruction set.
  Training(const Kernel& problem, const Kernels& kernels, int limit, const Hyperparameters& h);
  Training(const Training&) = delete;
  Training& operator=(const Training&) = delete;

  /// Collects a rollout, and advantages and returns of it.
  void collect();
  /// Learns from the rollout and its advantages.
  Update update(double learning_rate, double clip_range, double clip_range_vf);
  /// The rollout's columns as samples.
  Batch samples() const;
  int count() const { return h.n_steps * h.n_envs; }
  /// What the networks say to n observations.
  void forward(const float* observations, int n, float* outputs, float* values);

  const Hyperparameters h;
  const Info info;

 private:
  const Kernel& kernel_;
  const Kernels& kernels_;
  Crew crew_;

 public:
  const Agent agent;
  const int limit;
  Experience experience;
  Learner learner;
  std::vector<float> advantages, returns;
};

}  // namespace botschool::policy_gradient
