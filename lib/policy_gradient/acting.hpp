// An agent in kLanes environments of a problem, step by step.
#pragma once

#include "distribution.hpp"
#include "network.hpp"
#include "rollout.hpp"

BOTSCHOOL_BEGIN
namespace learning {

using namespace policy_gradient;

constexpr int L = kLanes;

inline Simulation<L>& simulation(Group& g) { return *static_cast<Simulation<L>*>(g.simulation); }

/// What drives an environment: its episode n starts from (key, n), and it explores by (key, step).
inline std::uint64_t key_of(const World& world, int environment) {
  return world.seed + (static_cast<std::uint64_t>(environment + 1) << 32);
}

inline void start(const World& world, Group& g, int lane) {
  Random random(key_of(world, g.first + lane), g.episodes[lane]++, Stream::start);
  simulation(g).build(lane, nullptr);
  simulation(g).start(lane, random);
  g.length[lane] = 0;
  g.total[lane] = 0;
}

inline void normalised(const World& world, const float* BOTSCHOOL_RESTRICT raw,
                       float* BOTSCHOOL_RESTRICT x) {
  const int n = world.agent->inputs();
  if (!world.mean) {
    std::memcpy(x, raw, sizeof(float) * n * L);
    return;
  }
  for (int i = 0; i < n; ++i)
    for (int l = 0; l < L; ++l)
      x[i * L + l] = clamp((raw[i * L + l] - world.mean[i]) * world.scale[i], -kMostDeviations,
                           kMostDeviations);
}

inline void features(const World& world, const float* raw, Scratch& s) {
  const Agent& agent = *world.agent;
  normalised(world, raw, s.observations);
  forward(agent.body, world.parameters, agent.relu, s.observations, s.body, L);
}
inline void policy(const World& world, Scratch& s) {
  const Agent& agent = *world.agent;
  forward(agent.actor, world.parameters, agent.relu, s.features(agent), s.actor, L);
}
inline void predict(const World& world, Scratch& s) {
  const Agent& agent = *world.agent;
  forward(agent.critic, world.parameters, agent.relu, s.features(agent), s.critic, L);
}

/// Actions that the motors can do, as the problem takes them.
inline void fitted(const World& world, const float* BOTSCHOOL_RESTRICT actions,
                   double* BOTSCHOOL_RESTRICT motors) {
  const int n = world.agent->actuators() * L;
  if (world.agent->discrete)
    for (int i = 0; i < n; ++i) motors[i] = actions[i];
  else
    for (int i = 0; i < n; ++i) motors[i] = limited(actions[i], world.low, world.high);
}

/// Where time ran out in step t, the task went on: the critic says what would have followed.
inline void bootstrap(const World& world, Group& g, int t, Scratch& s) {
  if (!g.cut) return;
  g.cut = false;
  features(world, g.final, s);
  predict(world, s);
  const Rollout& r = world.rollout;
  for (int l = 0; l < g.used; ++l) {
    const std::size_t at = std::size_t(t) * r.n_envs + g.first + l;
    if (r.ended[at] == 2) r.rewards[at] += world.gamma * s.values(*world.agent)[l];
  }
}

/// Ends episodes in step t and starts the next ones, in lanes without an environment too.
inline void restart(const World& world, Group& g, int t, const std::int64_t* over) {
  const Rollout& r = world.rollout;
  bool any = false;
  bool late[L];
  for (int l = 0; l < L; ++l) {
    late[l] = !over[l] && g.length[l] >= world.setting.limit;
    any |= over[l] != 0 || late[l];
    g.cut |= l < g.used && late[l];
  }
  simulation(g).observe(g.raw);
  if (any) std::memcpy(g.final, g.raw, sizeof(float) * world.agent->inputs() * L);
  for (int l = 0; l < L; ++l) {
    const std::size_t at = std::size_t(t) * r.n_envs + g.first + l;
    if (l < g.used) {
      r.ended[at] = over[l] ? 1.0f : late[l] ? 2.0f : 0.0f;
      r.returns[at] = g.total[l];
      r.lengths[at] = g.length[l];
    }
    if (over[l] || late[l]) start(world, g, l);
  }
  if (any) simulation(g).observe(g.raw);
}

/// Step t of a rollout, which is step `now` of the training.
inline void act(const World& world, Group& g, int t, std::uint64_t now, Scratch& s,
                double* motors) {
  const Agent& agent = *world.agent;
  const Rollout& r = world.rollout;
  features(world, g.raw, s);
  policy(world, s);
  predict(world, s);
  alignas(64) float log_probs[L], shift[L];
  alignas(64) double reward[L];
  alignas(64) std::int64_t over[L];
  alignas(64) std::uint32_t step[L];
  NoiseKey key[L];
  for (int l = 0; l < L; ++l) {
    key[l] = {key_of(world, g.first + l), static_cast<std::uint32_t>(now >> 32)};
    step[l] = static_cast<std::uint32_t>(now);
  }
  const float* outputs = s.outputs(agent);
  float* actions = s.slope[0];
  if (agent.discrete) softmax<L>(agent.outputs(), outputs, s.chances, shift);
  draw<L>(agent, world.parameters, outputs, s.chances, key, step, actions);
  if (agent.discrete)
    log_probs_of_choices<L>(outputs, shift, actions, log_probs);
  else
    log_probs_of_gaussian<L>(agent.outputs(), outputs, world.parameters + agent.log_std, actions,
                             s.chances, log_probs);
  fitted(world, actions, motors);
  simulation(g).step(motors, reward, over);
  const int actuators = agent.actuators(), inputs = agent.inputs();
  float* recent = world.recent + (now % world.setting.limit) * std::uint64_t(r.n_envs) * actuators;
  for (int l = 0; l < g.used; ++l) {
    const std::size_t e = g.first + l, at = std::size_t(t) * r.n_envs + e;
    for (int i = 0; i < inputs; ++i) r.observations[at * inputs + i] = s.observations[i * L + l];
    for (int o = 0; o < actuators; ++o)
      r.actions[at * actuators + o] = recent[e * actuators + o] = actions[o * L + l];
    r.log_probs[at] = log_probs[l];
    r.values[at] = s.values(agent)[l];
    r.rewards[at] = static_cast<float>(reward[l]);
  }
  for (int l = 0; l < L; ++l) {
    ++g.length[l];
    g.total[l] += reward[l];
  }
  restart(world, g, t, over);
}

/// The critic's prediction for what comes after the last step.
inline void last_values(const World& world, Group& g, Scratch& s) {
  features(world, g.raw, s);
  predict(world, s);
  for (int l = 0; l < g.used; ++l)
    world.rollout.last_values[g.first + l] = s.values(*world.agent)[l];
}

/// Plays the present episodes again up to step `now`, from their recent actions: each begins as many
/// steps before as it has had.
inline void replay(const World& world, Group& g, std::uint64_t now, float* actions,
                   double* motors) {
  const int actuators = world.agent->actuators();
  alignas(64) double reward[L];
  alignas(64) std::int64_t over[L];
  int ago = 0;
  for (int l = 0; l < g.used; ++l) ago = g.length[l] > ago ? g.length[l] : ago;
  for (int i = 0; i < actuators * L; ++i) actions[i] = 0;
  for (bool first = true; ago >= 0; --ago, first = false) {
    for (int l = 0; l < L; ++l) {
      const int length = l < g.used ? g.length[l] : 0;
      if (length != ago && !first) continue;
      Random random(key_of(world, g.first + l), g.episodes[l] - 1, Stream::start);
      simulation(g).build(l, nullptr);
      simulation(g).start(l, random);
    }
    if (ago == 0) break;
    const float* row = world.recent + ((now - ago) % world.setting.limit) *
                                          std::uint64_t(world.rollout.n_envs) * actuators;
    for (int l = 0; l < g.used; ++l)
      for (int o = 0; o < actuators; ++o) actions[o * L + l] = row[(g.first + l) * actuators + o];
    fitted(world, actions, motors);
    simulation(g).step(motors, reward, over);
  }
  simulation(g).observe(g.raw);
}

/// Whole episodes with the most probable actions: lane l plays (seed[l], episode[l]).
inline void play(const World& world, Group& g, const std::uint64_t* seed,
                 const std::uint32_t* episode, Scratch& s, double* motors) {
  Simulation<L>& problem = simulation(g);
  for (int l = 0; l < L; ++l) {
    const int from = l < g.used ? l : 0;  // a lane without an episode does what the first does
    Random random(seed[from], episode[from], Stream::start);
    problem.build(l, nullptr);
    problem.start(l, random);
    g.length[l] = 0, g.total[l] = 0;
  }
  alignas(64) double reward[L];
  alignas(64) std::int64_t over[L];
  bool ended[L] = {};
  for (int step = 0, running = g.used; step < world.setting.limit && running; ++step) {
    problem.observe(g.raw);
    features(world, g.raw, s);
    policy(world, s);
    mode<L>(*world.agent, s.outputs(*world.agent), s.slope[0]);
    fitted(world, s.slope[0], motors);
    problem.step(motors, reward, over);
    for (int l = 0; l < g.used; ++l) {
      if (ended[l]) continue;
      g.total[l] += reward[l];
      ++g.length[l];
      ended[l] = over[l] != 0;
      running -= ended[l];
    }
  }
}

}  // namespace learning
BOTSCHOOL_END
