// A native problem in L lanes, whichever it is: all that a rollout knows of it. Each problem is
// compiled by itself, once per instruction set (lib/CMakeLists.txt); what runs it, only once.
#pragma once

#include <cstddef>
#include <new>

#include "problem.hpp"

namespace botschool {

/// The scalar of evolution's networks.
using Real = float;

/// Episodes in lockstep: one AVX-512 register of single-precision numbers.
constexpr int kLanes = 16;

}  // namespace botschool

BOTSCHOOL_BEGIN

/// What problem.hpp says, behind an interface.
template <int L>
struct Simulation {
  virtual void set(const Setting& setting) = 0;
  virtual void build(int lane, const double* body) = 0;
  virtual void start(int lane, Random& random) = 0;
  virtual void refresh(int lane) = 0;
  virtual void observe(Real* out) const = 0;
  virtual void step(const double* action, double* reward, std::int64_t* ended) = 0;
  double* state = nullptr;  ///< [states][L]

 protected:
  ~Simulation() = default;
};

template <template <int> class Problem, int L>
struct Simulated final : Simulation<L> {
  Simulated() { this->state = &problem.state[0][0]; }
  void set(const Setting& setting) override { problem.set(setting); }
  void build(int lane, const double* body) override { problem.build(lane, body); }
  void start(int lane, Random& random) override { problem.start(lane, random); }
  void refresh(int lane) override { problem.refresh(lane); }
  void observe(Real* out) const override { problem.observe(out); }
  void step(const double* action, double* reward, std::int64_t* ended) override {
    problem.step(action, reward, ended);
  }
  alignas(64) Problem<L> problem{};
};

/// How L lanes of a problem are made, in memory of `size` bytes, 64-byte aligned.
template <int L>
struct Maker {
  std::size_t size = 0;
  Simulation<L>* (*make)(void* memory) = nullptr;
};

template <template <int> class Problem, int L>
constexpr Maker<L> maker() {
  using S = Simulated<Problem, L>;
  return {(sizeof(S) + 63) / 64 * 64,
          [](void* memory) -> Simulation<L>* { return new (memory) S(); }};
}

/// A problem as one instruction set has it.
struct Entry {
  Info info;
  Info (*given)(const Setting&);  ///< `info` as the caller's choices make it
  int states;                     ///< rows of `state`
  Maker<kLanes> whole;
  Maker<kLanes / 2> half;  ///< only where episodes can move to another lane
};

/// Defined where the problem is compiled (problem.cpp.in).
template <template <int> class Problem>
Entry entry();

BOTSCHOOL_END
