// Environments in which an agent acts, rollout after rollout: section 3 of walkthroughs/ppo.py.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "crew.hpp"
#include "kernels.hpp"

namespace botschool {
struct Kernel;
}

namespace botschool::policy_gradient {

/// Running mean and variance, merged batch by batch (Chan and others 1983), as Stable-Baselines3's.
struct Moments {
  double mean = 0, variance = 1, count = 1e-4;
  void merge(double other_mean, double other_squares, double n);
  float scale() const;
};

/// An episode that has ended: steps of the training so far, its return and its length.
struct Episode {
  std::uint64_t steps;
  double total;
  std::int32_t length;
};

class Experience {
 public:
  Experience(const Kernel& problem, const Kernels& kernels, int limit, const Hyperparameters& h,
             const Agent& agent, Crew& crew);

  /// The next n_steps steps of all environments.
  const Rollout& collect(const float* parameters);

  /// Returns and lengths of `count` episodes (seed[i], episode[i]) with the most probable actions.
  void play(const float* parameters, int count, const std::uint64_t* seed,
            const std::uint32_t* episode, double* returns, std::int32_t* lengths);

  /// Normalises by `seen` from now on, after it was set.
  void use_seen();

  /// Plays the environments' episodes again after episodes, lengths, recent actions and steps were set.
  void restore();

  const Agent& agent;
  std::uint64_t steps = 0;         ///< of each environment, so far
  std::vector<Moments> seen;       ///< of each observation
  Moments paid;                    ///< of discounted returns
  std::vector<double> discounted;  ///< (n_envs,): return so far, discounted
  std::vector<Episode> episodes;   ///< that ended in the last rollout, in order
  std::vector<float> recent;       ///< (limit, n_envs, actuators): a ring of the latest actions
  std::vector<Group> groups;
  Rollout rollout;

 private:
  struct alignas(64) Line {
    unsigned char bytes[64];
  };
  void make_group(Group& g, int first, int used);
  float* floats(std::size_t count);
  Scratch& scratch(int thread) { return workspaces_[thread]->scratch; }
  double* motors(int thread) { return motors_[thread].data(); }
  void look();
  void rate(int t);

  const Kernel& problem_;
  const Kernels& kernels_;
  const Hyperparameters& h_;
  Crew& crew_;
  World world_;
  std::vector<std::unique_ptr<Workspace>> workspaces_;
  std::vector<std::vector<double>> motors_;
  std::vector<std::vector<Line>> memory_;
  std::vector<float> mean_, scale_, row_;
  std::vector<std::vector<float>> columns_;
  std::vector<double> returns_;
  std::vector<std::int32_t> lengths_;
};

}  // namespace botschool::policy_gradient
