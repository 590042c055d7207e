// The settings of runs and trainings, by the names that files give them. A page passes numbers in the order
// of `names`; it asks for these, and refuses where it has another setting or lacks one (core.js; Python
// does the same before it writes a page).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "../evonet/hyperparameters.hpp"

namespace botschool {

#define BOTSCHOOL_FIELD(type, name) type name;
#define BOTSCHOOL_NAME(type, name) #name ","
#define BOTSCHOOL_READ(type, name) s.name = static_cast<type>(*value++);
#define BOTSCHOOL_SETTINGS(Settings, LIST)                     \
  struct Settings {                                            \
    LIST(BOTSCHOOL_FIELD)                                      \
    static constexpr const char* names = LIST(BOTSCHOOL_NAME); \
    static Settings read(const double* value) {                \
      Settings s;                                              \
      LIST(BOTSCHOOL_READ)                                     \
      return s;                                                \
    }                                                          \
  };

/// How candidates are evaluated; limits in steps; alive is paid for a step that does not end early.
#define BOTSCHOOL_LIST(X) \
  X(int, episodes)        \
  X(int, pepisodes) X(int, limit) X(int, post_limit) X(bool, heterogeneous) X(double, alive)
BOTSCHOOL_SETTINGS(Evaluation, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST

#define BOTSCHOOL_LIST(X) \
  X(int, samplesize) X(double, stepsize) X(double, noiseStdDev) X(int, wdecay) X(int, symseed)
BOTSCHOOL_SETTINGS(OpenAIESSettings, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST

#define BOTSCHOOL_LIST(X) X(int, popsize) X(double, mutrate)
BOTSCHOOL_SETTINGS(SSSSettings, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST

/// evolving: 0 those that do best against the competitors, 1 any.
#define BOTSCHOOL_LIST(X)                                                                      \
  X(int, popsize)                                                                              \
  X(int, selsize) X(int, samplesize) X(double, stepsize) X(double, noiseStdDev) X(int, wdecay) \
      X(int, evolving)
BOTSCHOOL_SETTINGS(Coevo2Settings, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST

/// Of a training: post-evaluations, their episodes and longest episode, and all steps.
#define BOTSCHOOL_LIST(X) X(int, evaluations) X(int, episodes) X(int, limit) X(std::int64_t, steps)
BOTSCHOOL_SETTINGS(TrainingSettings, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST

/// `_falls`: whether the number falls to 0 along the training.
#define BOTSCHOOL_LIST(X)                                                                    \
  X(int, n_envs)                                                                             \
  X(int, n_steps) X(int, batch_size) X(int, n_epochs) X(double, gamma) X(double, gae_lambda) \
      X(double, ent_coef) X(double, vf_coef) X(double, max_grad_norm) X(double, target_kl)   \
          X(bool, normalize_advantage) X(double, learning_rate) X(bool, learning_rate_falls) \
              X(double, clip_range) X(bool, clip_range_falls) X(double, clip_range_vf)       \
                  X(bool, clip_range_vf_falls)
BOTSCHOOL_SETTINGS(PPOSettings, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST

/// Of an agent; the sizes of its hidden layers follow.
#define BOTSCHOOL_LIST(X) \
  X(bool, normalize) X(bool, ortho_init) X(bool, relu) X(double, log_std_init)
BOTSCHOOL_SETTINGS(AgentSettings, BOTSCHOOL_LIST)
#undef BOTSCHOOL_LIST
#undef BOTSCHOOL_FIELD
#undef BOTSCHOOL_NAME
#undef BOTSCHOOL_READ
#undef BOTSCHOOL_SETTINGS

inline std::ptrdiff_t count_of(const char* names) {
  return std::count(names, names + std::strlen(names), ',');
}

/// The names of a group of settings, each followed by a comma; "" for a group that is not known.
inline const char* names_of_settings(const char* group) {
#define BOTSCHOOL_NAME(type, name, value, least, greatest, explanation, choices) #name ","
  constexpr const char* network = BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_NAME);
#undef BOTSCHOOL_NAME
  const char* groups[][2] = {{"network", network},
                             {"evaluation", Evaluation::names},
                             {"OpenAI-ES", OpenAIESSettings::names},
                             {"SSS", SSSSettings::names},
                             {"coevo2", Coevo2Settings::names},
                             {"agent", AgentSettings::names},
                             {"training", TrainingSettings::names},
                             {"PPO", PPOSettings::names}};
  for (const auto& [name, names] : groups)
    if (!std::strcmp(name, group)) return names;
  return "";
}

}  // namespace botschool
