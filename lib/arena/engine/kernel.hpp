// Jobs of episodes, and the tables of kernels that run them; arena/engine/kernel.cpp makes one
// table for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "../../evonet/layout.hpp"
#include "problem.hpp"

namespace botschool {

/// The scalar of evolution's networks.
using Real = float;

/// (candidate, seed, episode) triples to evaluate, and pointers to the results. All are plain
/// pointers into the caller's arrays; Engine::evaluate has their meaning.
struct Jobs {
  const double* genotypes;
  std::size_t genotype_stride;
  const double* normalisation;
  std::size_t count;
  const std::int32_t* candidate;  ///< of robot r in job j: candidate[r * count + j]
  std::size_t robot_offset;       ///< a genotype's parameters of robot r begin at r * this
  const std::uint64_t* seed;
  const std::uint32_t* episode;
  const std::uint8_t* collect;
  Setting setting;
  double* fitness;
  std::int32_t* steps;
  double* moments;
  std::size_t normalisation_stride = 0;  ///< between the vectors of candidates; 0: all have the same
};

/// Hands out the numbers of jobs to whoever asks; -1 when none is left.
class Queue {
 public:
  virtual std::ptrdiff_t next() = 0;

 protected:
  ~Queue() = default;
};

/// Gets each step of the first lane, to watch one episode.
class Recorder {
 public:
  virtual void start(const double* state) = 0;
  /// Activations of a robot's neurons: activation i is at activations[i * stride]. Called robot by
  /// robot, before step().
  virtual void neurons(const Real* activations, int stride) = 0;
  virtual void step(const double* observation, const double* action, const double* state,
                    double reward) = 0;

 protected:
  ~Recorder() = default;
};

/// One problem's episodes, built for one instruction set. Plain data: a shared inline function, such
/// as a virtual destructor, could end up using instructions that the machine lacks.
struct Kernel {
  Info info;
  Info (*given)(const Setting&);  ///< `info` with the caller's choices
  int lanes;                      ///< episodes in lockstep
  const void* entry;              ///< its Entry, of the instruction set (simulation.hpp)
  /// Bytes that run() needs, 64-byte aligned.
  std::size_t (*workspace)(const void* entry, const Layout&, const Setting&);
  void (*run)(const void* entry, const Layout&, const Jobs&, Queue&, Recorder*, void* workspace);
};

/// All native problems, in the order of problem_list.hpp.
struct KernelTable {
  const Kernel* kernel;
  std::size_t count;
};

KernelTable kernel_table_baseline();
KernelTable kernel_table_avx2();
KernelTable kernel_table_avx512();

}  // namespace botschool
