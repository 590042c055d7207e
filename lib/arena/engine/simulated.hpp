// A problem's class template as a Simulation, and its Entry.
#pragma once

#include <new>

#include "reward.hpp"
#include "simulation.hpp"

BOTSCHOOL_BEGIN

template <template <int> class Problem, int L>
struct Simulated final : Simulation<L> {
  Simulated() {
    this->state = &problem.state[0][0];
    this->kept = &problem.payer.kept[0][0];
  }
  void set(const Setting& setting) override {
    problem.set(setting);
    this->keeps = problem.payer.keeps();
  }
  void build(int lane, const double* body) override { problem.build(lane, body); }
  void start(int lane, Random& random) override { problem.start(lane, random); }
  void refresh(int lane) override { problem.refresh(lane); }
  void observe(Real* out) const override { problem.observe(out); }
  void step(const double* action, double* reward, std::int64_t* ended) override {
    problem.step(action, reward, ended);
  }
  alignas(64) Paid<Problem, L> problem{};
};

template <template <int> class Problem, int L>
constexpr Maker<L> maker() {
  using S = Simulated<Problem, L>;
  return {(sizeof(S) + 63) / 64 * 64,
          [](void* memory) -> Simulation<L>* { return new (memory) S(); }};
}

template <template <int> class Problem>
Entry entry() {
  const auto given = [](const Setting& setting) {
    return Problem<1>::given(Problem<1>::info(), setting);
  };
  Entry made{Problem<1>::info(),
             given,
             sizeof(Problem<1>::state) / sizeof(double),
             maker<Problem, kLanes>(),
             {}};
  if constexpr (Problem<1>::movable) made.half = maker<Problem, kLanes / 2>();
  return made;
}

BOTSCHOOL_END
