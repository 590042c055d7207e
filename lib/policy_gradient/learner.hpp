// Changes an agent by its experience: sections 4 and 5 of walkthroughs/ppo.py.
#pragma once

#include <memory>
#include <vector>

#include "crew.hpp"
#include "kernels.hpp"

namespace botschool::policy_gradient {

/// Generalised advantage estimation (Schulman and others 2016): how much better than predicted each
/// step went.
///   delta_t = r_t + gamma V_{t+1} - V_t,  A_t = delta_t + gamma lambda A_{t+1}
/// Where the episode ended, V_{t+1} and A_{t+1} are 0. Returns are advantages + values.
void advantages_of(const Rollout& rollout, double gamma, double gae_lambda, float* advantages,
                   float* returns);

/// Means over the minibatches of an update.
struct Update {
  Indicators means;
  double explained_variance = 0, learning_rate = 0, clip_range = 0, loss = 0;
  int minibatches = 0;  ///< 0: numbers were no longer finite
  bool finite = true;
};

class Learner {
 public:
  Learner(const Kernels& kernels, const Hyperparameters& h, const Agent& agent, Crew& crew);

  /// n_epochs passes through the samples, in an order drawn from (seed, update, epoch).
  Update update(const Batch& samples, int n, double learning_rate, double clip_range,
                double clip_range_vf);

  /// The loss of a minibatch, `rows` of the samples, and its gradient, which gradient() then holds.
  /// log_probs and values, of each sample, may be null.
  Indicators loss(Batch batch, const int* rows, int n, double clip_range, double clip_range_vf,
                  float* log_probs, float* values);

  /// One step of Adam against a gradient, shortened to max_grad_norm; false if it is not finite.
  bool step(const float* gradient, double learning_rate);

  const float* gradient() const { return parts_.data(); }

  const Agent& agent;
  std::vector<float> parameters, first, second;  ///< Adam's running means of gradients and squares
  double beta1_power = 1, beta2_power = 1;       ///< beta^t
  std::uint64_t updates = 0;

 private:
  void shuffle(int epoch, int* order, int n) const;

  const Kernels& kernels_;
  const Hyperparameters& h_;
  Crew& crew_;
  std::vector<std::unique_ptr<Workspace>> workspaces_;
  std::vector<float> parts_;  ///< a gradient for each chunk
  std::vector<Indicators> found_;
  std::vector<int> orders_;  ///< of the samples, for several epochs
};

}  // namespace botschool::policy_gradient
