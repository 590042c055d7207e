#include "training.hpp"

#include <stdexcept>

namespace botschool::policy_gradient {
namespace {

const Kernels& kernels_for(const std::string& instruction_set) {
  const auto known = instruction_sets();
  const std::string& name = instruction_set.empty() ? known.back() : instruction_set;
#ifdef BOTSCHOOL_AVX512
  if (name == "avx512") return kernels_avx512();
#endif
#ifdef BOTSCHOOL_AVX2
  if (name == "avx2") return kernels_avx2();
#endif
  return kernels_baseline();
}

const Hyperparameters& checked(const Hyperparameters& h) {
  for (const int count : {h.n_envs, h.n_steps, h.batch_size, h.n_epochs, h.threads})
    if (count < 1) throw std::invalid_argument("counts must be at least 1.");
  if (std::int64_t(h.n_envs) * h.n_steps > (1 << 30))
    throw std::invalid_argument("a rollout has at most 2^30 steps.");
  if (h.n_envs > 65535) throw std::invalid_argument("there are at most 65535 environments.");
  return h;
}

const Info& checked(const Info& info) {
  if (info.robots != 1 || info.body)
    throw std::invalid_argument(
        std::string(info.name) +
        " has several robots or a body that evolves: policy gradients train "
        "one robot.");
  return info;
}

}  // namespace

Training::Training(const std::string& problem, int limit, const Hyperparameters& given,
                   const std::string& instruction_set)
    : Training(*find_kernel(problem, instruction_set), kernels_for(instruction_set), limit, given) {
}

Training::Training(const Kernel& problem, const Kernels& kernels, int limit,
                   const Hyperparameters& given)
    : h(checked(given)),
      info(checked(problem.info)),
      kernel_(problem),
      kernels_(kernels),
      crew_(h.threads),
      agent(make_agent(info.observations, info.outputs, info.discrete, h)),
      limit(limit > 0 ? limit : info.limit),
      experience(kernel_, kernels_, this->limit, h, agent, crew_),
      learner(kernels_, h, agent, crew_),
      advantages(std::size_t(h.n_steps) * h.n_envs),
      returns(advantages.size()) {}

void Training::collect() {
  const Rollout& rollout = experience.collect(learner.parameters.data());
  advantages_of(rollout, h.gamma, h.gae_lambda, advantages.data(), returns.data());
}

Batch Training::samples() const {
  const Rollout& r = experience.rollout;
  return {r.observations, r.actions, r.log_probs, r.values, advantages.data(), returns.data()};
}

Update Training::update(double learning_rate, double clip_range, double clip_range_vf) {
  return learner.update(samples(), count(), learning_rate, clip_range, clip_range_vf);
}

void Training::forward(const float* observations, int n, float* outputs, float* values) {
  Workspace workspace(agent);
  for (int from = 0; from < n; from += kChunk)
    kernels_.forward(agent, learner.parameters.data(),
                     observations + std::size_t(from) * agent.inputs(), std::min(kChunk, n - from),
                     workspace.scratch, outputs + std::size_t(from) * agent.outputs(),
                     values + from);
}

}  // namespace botschool::policy_gradient
