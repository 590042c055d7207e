// The data of learning: a minibatch of a rollout, and the values computed from it.
#pragma once

namespace botschool::policy_gradient {

/// Columns of samples; a minibatch is a list of rows.
struct Batch {
  const float *observations, *actions, *log_probs, *values, *advantages, *returns;
  float mean = 0, scale = 1;  ///< advantages are taken as (A - mean) * scale
  float clip = 0, clip_vf = 0, ent = 0, vf = 0;
  int size = 0;  ///< of the minibatch
};

/// Sums or means over samples.
struct Indicators {
  double policy_loss = 0, value_loss = 0, entropy = 0, approx_kl = 0, clip_fraction = 0;
};

/// A step of Adam (Kingma and Ba 2015).
struct AdamStep {
  float shorter = 1;  ///< gradients are multiplied by this first
  float rate = 0;     ///< learning rate / (1 - beta1^t)
  float root = 0;     ///< 1 / sqrt(1 - beta2^t)
  float epsilon = 1e-5f;
};

constexpr float kBeta1 = 0.9f, kBeta2 = 0.999f;

}  // namespace botschool::policy_gradient
