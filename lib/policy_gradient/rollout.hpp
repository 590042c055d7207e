// What environments experienced, and what acting in them needs; section 3 of walkthroughs/ppo.py.
// Plain data: arrays belong to Experience.
#pragma once

#include <cstdint>

#include "../arena/engine/simulation.hpp"
#include "agent.hpp"

namespace botschool::policy_gradient {

/// Arrays of shape (n_steps, n_envs) or (n_steps, n_envs, values).
struct Rollout {
  int n_steps = 0, n_envs = 0;
  float* observations = nullptr;  ///< normalised
  float* actions = nullptr;       ///< as drawn: a Gaussian may ask for more than the motor can do
  float* log_probs = nullptr;
  float* values = nullptr;
  float* rewards = nullptr;  ///< scaled; where time ran out, with what the critic says would follow
  float* ended =
      nullptr;  ///< 1 where the episode ended with this step, 2 where time ran out, else 0
  float* last_values = nullptr;     ///< (n_envs,)
  double* returns = nullptr;        ///< where an episode ended: its return, as the problem pays it
  std::int32_t* lengths = nullptr;  ///< and its steps
};

/// Environments that are stepped together, one a lane.
struct Group {
  void* simulation = nullptr;           ///< Simulation<kLanes>
  int first = 0, used = 0;              ///< which environments
  float* raw = nullptr;                 ///< [inputs][kLanes]: observations
  float* final = nullptr;               ///< those after the last step of episodes that ended
  bool cut = false;                     ///< whether time ran out somewhere in the step before
  std::uint32_t episodes[kLanes] = {};  ///< begun so far
  std::int32_t length[kLanes] = {};
  double total[kLanes] = {};
};

/// What all groups share.
struct World {
  const Agent* agent = nullptr;
  const float* parameters = nullptr;
  double low = -1, high = 1;  ///< range of the actuators
  Setting setting{0};         ///< longest episode, ...
  std::uint64_t seed = 0;
  float gamma = 0;
  const float* mean = nullptr;   ///< of observations, or null: they are not normalised
  const float* scale = nullptr;  ///< 1 / their deviation
  float* recent = nullptr;       ///< [limit][n_envs][actuators]: actions of the latest steps
  Rollout rollout;
};

/// Normalised observations and scaled rewards stay within.
constexpr float kMostDeviations = 10;

}  // namespace botschool::policy_gradient
