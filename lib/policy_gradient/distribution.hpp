// The distribution of actions: a Gaussian with a deviation for each actuator, or a choice. Arrays are
// [values][ld samples]; an action is [actuators][ld].
#pragma once

#include "../evonet/philox.hpp"
#include "agent.hpp"

BOTSCHOOL_BEGIN
namespace learning {

using namespace policy_gradient;

/// ln(2 pi) / 2
constexpr float kHalfLogTwoPi = 0.918938533f;

/// Turns outputs into the probability of each action; the logarithm of one is its output minus shift.
template <int ld>
void softmax(int n, const float* BOTSCHOOL_RESTRICT outputs, float* BOTSCHOOL_RESTRICT chances,
             float* BOTSCHOOL_RESTRICT shift) {
  alignas(64) float top[ld], sum[ld];
  for (int b = 0; b < ld; ++b) top[b] = outputs[b], sum[b] = 0;
  for (int o = 1; o < n; ++o)
    for (int b = 0; b < ld; ++b)
      top[b] = outputs[o * ld + b] > top[b] ? outputs[o * ld + b] : top[b];
  for (int o = 0; o < n; ++o)
    for (int b = 0; b < ld; ++b) {
      chances[o * ld + b] = exponential(outputs[o * ld + b] - top[b]);
      sum[b] += chances[o * ld + b];
    }
  for (int o = 0; o < n; ++o)
    for (int b = 0; b < ld; ++b) chances[o * ld + b] /= sum[b];
  for (int b = 0; b < ld; ++b) shift[b] = top[b] + logarithm(sum[b]);
}

/// The log probability of each action of a choice, after softmax.
template <int ld>
void log_probs_of_choices(const float* outputs, const float* shift, const float* actions,
                          float* log_probs) {
  for (int b = 0; b < ld; ++b)
    log_probs[b] = outputs[static_cast<int>(actions[b]) * ld + b] - shift[b];
}

/// The log density of Gaussian actions; z: how many deviations each is from the mean.
template <int ld>
void log_probs_of_gaussian(int n, const float* BOTSCHOOL_RESTRICT outputs, const float* log_std,
                           const float* BOTSCHOOL_RESTRICT actions, float* BOTSCHOOL_RESTRICT z,
                           float* BOTSCHOOL_RESTRICT log_probs) {
  for (int b = 0; b < ld; ++b) log_probs[b] = 0;
  for (int o = 0; o < n; ++o) {
    const float inverse = exponential(-log_std[o]), constant = log_std[o] + kHalfLogTwoPi;
    for (int b = 0; b < ld; ++b) {
      const float away = (actions[o * ld + b] - outputs[o * ld + b]) * inverse;
      z[o * ld + b] = away;
      log_probs[b] += -0.5f * (away * away) - constant;
    }
  }
}

/// Draws an action for each lane. Choices: the first word of block 0 tells which. Gaussian: block k has
/// the deviates of actuators 4k to 4k + 3.
template <int L>
void draw(const Agent& agent, const float* parameters, const float* outputs, const float* chances,
          const NoiseKey* key, const std::uint32_t* step, float* BOTSCHOOL_RESTRICT actions) {
  alignas(64) std::uint32_t word[4][L];
  if (agent.discrete) {
    philox_lanes<L>(key, Stream::explore, step, 0, word);
    alignas(64) float below[L] = {};
    for (int l = 0; l < L; ++l) actions[l] = 0;
    for (int o = 0; o + 1 < agent.outputs(); ++o)
      for (int l = 0; l < L; ++l) {
        const float u =
            static_cast<float>(static_cast<std::int32_t>(word[0][l] >> 8)) / 16777216.0f;
        below[l] += chances[o * L + l];
        actions[l] += u >= below[l] ? 1.0f : 0.0f;
      }
    return;
  }
  for (int first = 0; first < agent.outputs(); first += 4) {
    philox_lanes<L>(key, Stream::explore, step, static_cast<std::uint32_t>(first / 4), word);
    alignas(64) float deviate[4][L];
    for (int l = 0; l < L; ++l) {
      gaussian_pair<float>(word[0][l], word[1][l], deviate[0][l], deviate[1][l]);
      gaussian_pair<float>(word[2][l], word[3][l], deviate[2][l], deviate[3][l]);
    }
    for (int o = first; o < agent.outputs() && o < first + 4; ++o) {
      const float deviation = exponential(parameters[agent.log_std + o]);
      for (int l = 0; l < L; ++l)
        actions[o * L + l] = outputs[o * L + l] + deviation * deviate[o - first][l];
    }
  }
}

/// The most probable action.
template <int L>
void mode(const Agent& agent, const float* outputs, float* actions) {
  if (!agent.discrete) {
    for (int i = 0; i < agent.outputs() * L; ++i) actions[i] = outputs[i];
    return;
  }
  for (int l = 0; l < L; ++l) {
    int best = 0;
    for (int o = 1; o < agent.outputs(); ++o)
      if (outputs[o * L + l] > outputs[best * L + l]) best = o;
    actions[l] = static_cast<float>(best);
  }
}

}  // namespace learning
BOTSCHOOL_END
