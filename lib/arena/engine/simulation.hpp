// The interface through which a rollout uses a native problem: L lanes of it. Each problem, and the
// rollout, is compiled separately for each instruction set (lib/CMakeLists.txt).
#pragma once

#include <cstddef>

#include "kernel.hpp"

namespace botschool {

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
  double* kept = nullptr;   ///< [keeps][L], of a reward of one's own
  int keeps = 0;

 protected:
  ~Simulation() = default;
};

/// How L lanes of a problem are made, in memory of `size` bytes, 64-byte aligned.
template <int L>
struct Maker {
  std::size_t size = 0;
  Simulation<L>* (*make)(void* memory) = nullptr;
};

/// A problem as one instruction set has it.
struct Entry {
  Info info;
  Info (*given)(const Setting&);  ///< `info` as the caller's choices make it
  int states;                     ///< rows of `state`
  Maker<kLanes> whole;
  Maker<kLanes / 2> half;  ///< only where episodes can move to another lane
};

/// Defined where the problem is compiled (simulated.hpp).
template <template <int> class Problem>
Entry entry();

/// What Kernel calls for every problem (rollout.cpp).
std::size_t workspace(const void* entry, const Layout& layout, const Setting& setting);
void run(const void* entry, const Layout& layout, const Jobs& jobs, Queue& queue,
         Recorder* recorder, void* memory);

BOTSCHOOL_END
