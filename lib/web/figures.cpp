// What figures of the exercises' pages show of the algorithms: single steps of them, by the functions
// that evolve and train.
#include <algorithm>

#include "../evolution/strategies.hpp"
#include "../policy_gradient/learner.hpp"
#include "export.hpp"

using namespace botschool;

/// Writes the utility of each candidate of OpenAI-ES: from -0.5, the worst, to 0.5.
EXPORT(utilities) void utilities(const double* fitness, int count, double* utility) {
  const Values found = utilities_of(fitness, static_cast<std::size_t>(count));
  std::copy(found.begin(), found.end(), utility);
}

/// Writes the direction in which fitness rises, of n parameters; candidates stand on both sides of the
/// centre along the samples, + and - by turns.
EXPORT(estimate)
void estimate(const double* fitness, int count, const double* samples, int n, double* rising) {
  const Values given(samples, samples + count / 2 * n);
  const Values found = gradient(fitness, static_cast<std::size_t>(count), given);
  std::copy(found.begin(), found.end(), rising);
}

/// Changes a centre x and Adam's moments m and v by step number t, from 1 on.
EXPORT(climb)
void climb(double* x, double* m, double* v, const double* rising, int n, int wdecay,
           double stepsize, int t) {
  Centre centre{{x, x + n}, {m, m + n}, {v, v + n}};
  climb(centre, {rising, rising + n}, wdecay, adam_step(stepsize, static_cast<unsigned>(t)));
  std::copy(centre.x.begin(), centre.x.end(), x);
  std::copy(centre.m.begin(), centre.m.end(), m);
  std::copy(centre.v.begin(), centre.v.end(), v);
}

/// Writes advantages and returns of one environment's steps. ended: 1 where an episode ended with this
/// step, else 0.
EXPORT(gae)
void gae(float* rewards, float* values, float* ended, int steps, float last_value, double gamma,
         double gae_lambda, float* advantages, float* returns) {
  policy_gradient::Rollout rollout;
  rollout.n_steps = steps;
  rollout.n_envs = 1;
  rollout.values = values;
  rollout.rewards = rewards;
  rollout.ended = ended;
  rollout.last_values = &last_value;
  policy_gradient::advantages_of(rollout, gamma, gae_lambda, advantages, returns);
}
