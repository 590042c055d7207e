// The hyperparameters of a training, named as in Stable-Baselines3: section 1 of walkthroughs/ppo.py.
#pragma once

#include <cstdint>
#include <vector>

#include "../arena/engine/problem.hpp"

namespace botschool::policy_gradient {

struct Hyperparameters {
  std::uint64_t seed = 1;
  int n_envs = 8;
  int n_steps = 32;
  int batch_size = 256;
  int n_epochs = 20;
  double gamma = 0.98;
  double gae_lambda = 0.8;
  double clip_range = 0.2;   ///< of the ratio; 0: not clipped (A2C, REINFORCE)
  double clip_range_vf = 0;  ///< of the critic's prediction; 0: not clipped
  double ent_coef = 0;
  double vf_coef = 0.5;
  double max_grad_norm = 0.5;  ///< 0: gradients are not shortened
  double target_kl = 0;        ///< 0: an update never stops early
  bool normalize_advantage = true;
  bool normalize = false;  ///< observations and rewards, by their running mean and deviation
  double log_std_init = 0;
  bool ortho_init = true;
  bool relu = false;        ///< in place of tanh
  std::vector<int> shared;  ///< neurons of the hidden layers that policy and critic have in common
  std::vector<int> pi{64, 64}, vf{64, 64};  ///< neurons of the policy's and the critic's own layers
  int threads = 1;
  Setting setting{0};  ///< of the problem; `limit` is the training's
};

}  // namespace botschool::policy_gradient
