// Compiled once per instruction set, like arena/engine/kernel.cpp and with the same care: nothing but
// inner loops.
#include "kernels.hpp"

#include "acting.hpp"
#include "adam.hpp"
#include "loss.hpp"

BOTSCHOOL_BEGIN
namespace learning {
namespace {

std::size_t size_of(const void* entry) { return static_cast<const Entry*>(entry)->whole.size; }

void* make(const void* entry, void* memory, const Setting& setting) {
  Simulation<L>* made = static_cast<const Entry*>(entry)->whole.make(memory);
  made->set(setting);
  return made;
}

void start_all(const World& world, Group& g) {
  for (int l = 0; l < L; ++l) start(world, g, l);
  simulation(g).observe(g.raw);
}

void replay_all(const World& world, Group& g, std::uint64_t now, Scratch& s, double* motors) {
  replay(world, g, now, s.slope[0], motors);
}

/// Mean, and the sum of squared differences from it: 16 partial sums, added in order.
void moments(const float* x, int n, double* mean, double* squares) {
  const auto sum = [&](auto term) {
    double part[16] = {}, all = 0;
    int i = 0;
    for (; i + 16 <= n; i += 16)
      for (int l = 0; l < 16; ++l) part[l] += term(x[i + l]);
    for (; i < n; ++i) part[i % 16] += term(x[i]);
    for (const double each : part) all += each;
    return all;
  };
  const double m = sum([](float v) { return static_cast<double>(v); }) / n;
  *mean = m;
  *squares = sum([m](float v) { return (v - m) * (v - m); });
}

/// What the networks say to n <= kChunk observations, row by row.
void forward_rows(const Agent& agent, const float* p, const float* observations, int n, Scratch& s,
                  float* outputs, float* values) {
  const int inputs = agent.inputs(), out = agent.outputs();
  for (int b = 0; b < kChunk; ++b)
    for (int i = 0; i < inputs; ++i)
      s.observations[i * kChunk + b] = observations[std::size_t(b < n ? b : 0) * inputs + i];
  forward(agent.body, p, agent.relu, s.observations, s.body, kChunk);
  forward(agent.actor, p, agent.relu, s.features(agent), s.actor, kChunk);
  forward(agent.critic, p, agent.relu, s.features(agent), s.critic, kChunk);
  for (int b = 0; b < n; ++b) {
    for (int o = 0; o < out; ++o) outputs[b * out + o] = s.outputs(agent)[o * kChunk + b];
    values[b] = s.values(agent)[b];
  }
}

}  // namespace
}  // namespace learning
BOTSCHOOL_END

namespace botschool::policy_gradient {

using namespace BOTSCHOOL_ISA::learning;

#define KERNELS_OF(isa) kernels_##isa
#define KERNELS(isa) KERNELS_OF(isa)
const Kernels& KERNELS(BOTSCHOOL_ISA)() {
  static constexpr Kernels table{&size_of,      &make,       &start_all, &act,     &bootstrap,
                                 &last_values,  &replay_all, &play,      &moments, &gradient,
                                 &forward_rows, &add,        &squares,   &adam};
  return table;
}

}  // namespace botschool::policy_gradient
