// The loss of PPO and its gradient, for a chunk of a minibatch (Schulman and others 2017): section 5
// of walkthroughs/ppo.py.
#pragma once

#include "distribution.hpp"
#include "learning.hpp"
#include "network.hpp"

BOTSCHOOL_BEGIN
namespace learning {

using namespace policy_gradient;

/// How much of each sample is in the chunk, and what of the loss is summed up: in the order of samples.
struct Losses {
  alignas(64) float policy[kChunk], value[kChunk], entropy[kChunk], kl[kChunk], clipped[kChunk];
};

/// d policy loss / d log probability of each sample: -A ratio, or 0 where the clipped ratio is the
/// smaller one.
inline void surrogate(const Batch& batch, const int* where, int n, const float* log_probs,
                      Losses& losses, float* slope) {
  alignas(64) float change[kChunk] = {}, ratio[kChunk];
  for (int b = 0; b < n; ++b) change[b] = log_probs[b] - batch.log_probs[where[b]];
  for (int b = 0; b < kChunk; ++b) ratio[b] = exponential(change[b]);
  for (int b = 0; b < n; ++b) {
    const float advantage = (batch.advantages[where[b]] - batch.mean) * batch.scale;
    const float far = ratio[b] - 1.0f;
    const bool out = batch.clip > 0 && (far > batch.clip || far < -batch.clip);
    const bool held = out && (advantage > 0) == (far > 0);
    const float limit = far > 0 ? 1.0f + batch.clip : 1.0f - batch.clip;
    losses.policy[b] = -advantage * (held ? limit : ratio[b]);
    losses.kl[b] = far - change[b];
    losses.clipped[b] = out ? 1.0f : 0.0f;
    slope[b] = held ? 0.0f : -advantage * ratio[b];
  }
}

/// d loss / d the outputs of the policy, into s.slope[0]; the gradient of log_std, into g.
inline void policy_slope(const Agent& agent, const float* p, const Batch& batch, const int* where,
                         int n, Scratch& s, float* g, Losses& losses, float* log_probs) {
  const float share = 1.0f / static_cast<float>(batch.size);
  const float* outputs = s.outputs(agent);
  float *actions = s.slope[1], *d = s.slope[0];
  const int actuators = agent.actuators(), out = agent.outputs();
  for (int a = 0; a < actuators; ++a)
    for (int b = 0; b < kChunk; ++b)
      actions[a * kChunk + b] = batch.actions[where[b < n ? b : 0] * actuators + a];
  alignas(64) float slope[kChunk] = {}, shift[kChunk];
  if (agent.discrete) {
    softmax<kChunk>(out, outputs, s.chances, shift);
    log_probs_of_choices<kChunk>(outputs, shift, actions, log_probs);
    surrogate(batch, where, n, log_probs, losses, slope);
    for (int b = 0; b < n; ++b) losses.entropy[b] = 0;
    for (int o = 0; o < out; ++o)
      for (int b = 0; b < n; ++b)
        losses.entropy[b] -= s.chances[o * kChunk + b] * (outputs[o * kChunk + b] - shift[b]);
    for (int o = 0; o < out; ++o)
      for (int b = 0; b < n; ++b) {
        const float chance = s.chances[o * kChunk + b];
        const float chosen = static_cast<int>(actions[b]) == o ? 1.0f : 0.0f;
        const float log_prob = outputs[o * kChunk + b] - shift[b];
        d[o * kChunk + b] = share * (slope[b] * (chosen - chance) +
                                     batch.ent * chance * (log_prob + losses.entropy[b]));
      }
  } else {
    const float* log_std = p + agent.log_std;
    log_probs_of_gaussian<kChunk>(out, outputs, log_std, actions, s.chances, log_probs);
    surrogate(batch, where, n, log_probs, losses, slope);
    float entropy = 0;
    for (int o = 0; o < out; ++o) entropy += log_std[o] + (kHalfLogTwoPi + 0.5f);
    for (int b = 0; b < n; ++b) losses.entropy[b] = entropy;
    for (int o = 0; o < out; ++o) {
      const float inverse = exponential(-log_std[o]);
      alignas(64) float wider[kChunk] = {};
      for (int b = 0; b < n; ++b) {
        const float z = s.chances[o * kChunk + b];
        d[o * kChunk + b] = share * (slope[b] * z * inverse);
        wider[b] = slope[b] * (z * z - 1.0f);
      }
      g[agent.log_std + o] = share * chunk_sum(wider) - batch.ent * (static_cast<float>(n) * share);
    }
  }
  for (int o = 0; o < out; ++o)
    for (int b = n; b < kChunk; ++b) d[o * kChunk + b] = 0;
}

/// d loss / d the critic's predictions, into s.slope[0].
inline void value_slope(const Agent& agent, const Batch& batch, const int* where, int n, Scratch& s,
                        Losses& losses) {
  const float factor = 2.0f * batch.vf / static_cast<float>(batch.size);
  const float* values = s.values(agent);
  for (int b = 0; b < n; ++b) {
    float value = values[b], slope = factor;
    if (batch.clip_vf > 0) {
      const float before = batch.values[where[b]], change = value - before;
      value = before + clamp(change, -batch.clip_vf, batch.clip_vf);
      slope = change > batch.clip_vf || change < -batch.clip_vf ? 0.0f : factor;
    }
    const float error = value - batch.returns[where[b]];
    losses.value[b] = error * error;
    s.slope[0][b] = slope * error;
  }
  for (int b = n; b < kChunk; ++b) s.slope[0][b] = 0;
}

/// The gradient of n samples' part of the loss into g, and their sums into found.
inline void gradient(const Agent& agent, const float* p, const Batch& batch, const int* where,
                     int n, Scratch& s, float* g, Indicators& found, float* log_probs_out,
                     float* values_out) {
  Losses losses;
  alignas(64) float log_probs[kChunk];
  const int inputs = agent.inputs();
  for (int b = 0; b < kChunk; ++b) {
    const float* row = batch.observations + std::size_t(where[b < n ? b : 0]) * inputs;
    for (int i = 0; i < inputs; ++i) s.observations[i * kChunk + b] = row[i];
  }
  forward(agent.body, p, agent.relu, s.observations, s.body, kChunk);
  const float* features = s.features(agent);
  float* before = agent.body.layers ? s.features_slope : nullptr;
  forward(agent.actor, p, agent.relu, features, s.actor, kChunk);
  policy_slope(agent, p, batch, where, n, s, g, losses, log_probs);
  backward(agent.actor, p, agent.relu, features, s.actor, s, s.slope[0], before, g);
  forward(agent.critic, p, agent.relu, features, s.critic, kChunk);
  value_slope(agent, batch, where, n, s, losses);
  float* both = before ? s.critic_features : nullptr;
  backward(agent.critic, p, agent.relu, features, s.critic, s, s.slope[0], both, g);
  if (before) {
    const int size = agent.body.outputs() * kChunk;
    for (int i = 0; i < size; ++i) s.slope[0][i] = before[i] + both[i];
    backward(agent.body, p, agent.relu, s.observations, s.body, s, s.slope[0], nullptr, g);
  }
  found = {};
  for (int b = 0; b < n; ++b) {
    found.policy_loss += losses.policy[b];
    found.value_loss += losses.value[b];
    found.entropy += losses.entropy[b];
    found.approx_kl += losses.kl[b];
    found.clip_fraction += losses.clipped[b];
  }
  if (log_probs_out) std::memcpy(log_probs_out, log_probs, n * sizeof(float));
  if (values_out) std::memcpy(values_out, s.values(agent), n * sizeof(float));
}

}  // namespace learning
BOTSCHOOL_END
