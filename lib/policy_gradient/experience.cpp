#include "experience.hpp"

#include <cmath>
#include <cstring>

#include "../arena/engine/rollout.hpp"

namespace botschool::policy_gradient {

void Moments::merge(double other_mean, double other_squares, double n) {
  const double away = other_mean - mean, all = count + n;
  variance = (variance * count + other_squares + away * away * count * n / all) / all;
  mean += away * n / all;
  count = all;
}

float Moments::scale() const { return static_cast<float>(1 / std::sqrt(variance + 1e-8)); }

Experience::Experience(const Kernel& problem, const Kernels& kernels, int limit,
                       const Hyperparameters& h, const Agent& agent, Crew& crew)
    : agent(agent), problem_(problem), kernels_(kernels), h_(h), crew_(crew) {
  for (int t = 0; t < crew.threads(); ++t) {
    workspaces_.push_back(std::make_unique<Workspace>(agent));
    motors_.emplace_back(std::size_t(agent.actuators()) * kLanes);
  }
  const std::size_t n = std::size_t(h.n_steps) * h.n_envs;
  rollout.n_steps = h.n_steps;
  rollout.n_envs = h.n_envs;
  rollout.observations = floats(n * agent.inputs());
  rollout.actions = floats(n * agent.actuators());
  for (float** column : {&rollout.log_probs, &rollout.values, &rollout.rewards, &rollout.ended})
    *column = floats(n);
  rollout.last_values = floats(h.n_envs);
  returns_.resize(n);
  lengths_.resize(n);
  rollout.returns = returns_.data();
  rollout.lengths = lengths_.data();

  seen.resize(agent.inputs());
  mean_.resize(agent.inputs());
  scale_.resize(agent.inputs());
  row_.resize(h.n_envs);
  discounted.resize(h.n_envs);
  recent.resize(std::size_t(limit) * h.n_envs * agent.actuators());

  world_.agent = &agent;
  world_.low = problem.info.low;
  world_.high = problem.info.high;
  world_.setting = h.setting;
  world_.setting.limit = limit;
  world_.seed = h.seed;
  world_.gamma = static_cast<float>(h.gamma);
  if (h.normalize) world_.mean = mean_.data(), world_.scale = scale_.data();
  world_.recent = recent.data();
  world_.rollout = rollout;
  groups.resize((h.n_envs + kLanes - 1) / kLanes);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const int first = static_cast<int>(g) * kLanes;
    make_group(groups[g], first, std::min(kLanes, h.n_envs - first));
    kernels_.start(world_, groups[g]);
  }
  if (h.normalize) look();
}

float* Experience::floats(std::size_t count) {
  columns_.emplace_back(count);
  return columns_.back().data();
}

void Experience::make_group(Group& g, int first, int used) {
  const std::size_t problem = kernels_.size(problem_.entry) / sizeof(Line);
  const std::size_t observations = agent.inputs() * kLanes * sizeof(float) / sizeof(Line);
  memory_.emplace_back(problem + 2 * observations);
  Line* lines = memory_.back().data();
  g.simulation = kernels_.make(problem_.entry, lines, world_.setting);
  g.raw = reinterpret_cast<float*>(lines + problem);
  g.final = reinterpret_cast<float*>(lines + problem + observations);
  g.first = first;
  g.used = used;
}

/// Takes the present observations into their running moments.
void Experience::look() {
  for (int i = 0; i < agent.inputs(); ++i) {
    for (const Group& g : groups)
      std::memcpy(&row_[g.first], g.raw + i * kLanes, g.used * sizeof(float));
    double mean, squares;
    kernels_.moments(row_.data(), h_.n_envs, &mean, &squares);
    seen[i].merge(mean, squares, h_.n_envs);
  }
  use_seen();
}

void Experience::use_seen() {
  for (int i = 0; i < agent.inputs(); ++i) {
    mean_[i] = static_cast<float>(seen[i].mean);
    scale_[i] = seen[i].scale();
  }
}

/// Scales the rewards of step t by the deviation of discounted returns.
void Experience::rate(int t) {
  const std::size_t first = std::size_t(t) * h_.n_envs;
  for (int e = 0; e < h_.n_envs; ++e) {
    discounted[e] = discounted[e] * h_.gamma + rollout.rewards[first + e];
    row_[e] = static_cast<float>(discounted[e]);
  }
  double mean, squares;
  kernels_.moments(row_.data(), h_.n_envs, &mean, &squares);
  paid.merge(mean, squares, h_.n_envs);
  const float scale = paid.scale();
  for (int e = 0; e < h_.n_envs; ++e) {
    float& reward = rollout.rewards[first + e];
    reward = std::min(std::max(reward * scale, -kMostDeviations), kMostDeviations);
    if (rollout.ended[first + e] != 0) discounted[e] = 0;
  }
}

const Rollout& Experience::collect(const float* parameters) {
  world_.parameters = parameters;
  const int n = static_cast<int>(groups.size());
  // step t of a group; first the end of the step before: its rewards are scaled by now
  const auto step = [&](int g, int t, int thread) {
    if (t > 0) kernels_.bootstrap(world_, groups[g], t - 1, scratch(thread));
    if (t < h_.n_steps)
      kernels_.act(world_, groups[g], t, steps + t, scratch(thread), motors(thread));
    else
      kernels_.last_values(world_, groups[g], scratch(thread));
  };
  if (h_.normalize)  // all environments share the moments, so that they go step by step
    for (int t = 0; t <= h_.n_steps; ++t) {
      crew_.run(n, [&](int g, int thread) { step(g, t, thread); });
      if (t < h_.n_steps) look(), rate(t);
    }
  else
    crew_.run(n, [&](int g, int thread) {
      for (int t = 0; t <= h_.n_steps; ++t) step(g, t, thread);
    });
  episodes.clear();
  for (int t = 0; t < h_.n_steps; ++t)
    for (int e = 0; e < h_.n_envs; ++e) {
      const std::size_t at = std::size_t(t) * h_.n_envs + e;
      if (rollout.ended[at] != 0)
        episodes.push_back({(steps + t + 1) * h_.n_envs, returns_[at], lengths_[at]});
    }
  steps += h_.n_steps;
  return rollout;
}

void Experience::play(const float* parameters, int count, const std::uint64_t* seed,
                      const std::uint32_t* episode, double* returns, std::int32_t* lengths) {
  World world = world_;
  world.parameters = parameters;
  const int n = (count + kLanes - 1) / kLanes;
  const std::size_t kept = memory_.size();
  std::vector<Group> playing(n);
  for (int g = 0; g < n; ++g)
    make_group(playing[g], g * kLanes, std::min(kLanes, count - g * kLanes));
  crew_.run(n, [&](int i, int thread) {
    Group& g = playing[i];
    kernels_.play(world, g, seed + g.first, episode + g.first, scratch(thread), motors(thread));
    for (int l = 0; l < g.used; ++l)
      returns[g.first + l] = g.total[l], lengths[g.first + l] = g.length[l];
  });
  memory_.resize(kept);
}

void Experience::restore() {
  use_seen();
  for (Group& g : groups) kernels_.replay(world_, g, steps, scratch(0), motors(0));
}

}  // namespace botschool::policy_gradient
