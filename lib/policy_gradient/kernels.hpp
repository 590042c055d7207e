// The inner loops of a training, a table of them for each instruction set (kernels.cpp).
#pragma once

#include "learning.hpp"
#include "rollout.hpp"

namespace botschool::policy_gradient {

struct Kernels {
  std::size_t (*size)(const void* entry);  ///< bytes of kLanes environments, 64-byte aligned
  void* (*make)(const void* entry, void* memory, const Setting& setting);
  void (*start)(const World& world, Group& g);
  void (*act)(const World& world, Group& g, int t, std::uint64_t now, Scratch& s, double* motors);
  void (*bootstrap)(const World& world, Group& g, int t, Scratch& s);
  void (*last_values)(const World& world, Group& g, Scratch& s);
  void (*replay)(const World& world, Group& g, std::uint64_t now, Scratch& s, double* motors);
  void (*play)(const World& world, Group& g, const std::uint64_t* seed,
               const std::uint32_t* episode, Scratch& s, double* motors);
  void (*moments)(const float* x, int n, double* mean, double* squares);
  void (*gradient)(const Agent& agent, const float* p, const Batch& batch, const int* where, int n,
                   Scratch& s, float* g, Indicators& found, float* log_probs, float* values);
  void (*forward)(const Agent& agent, const float* p, const float* observations, int n, Scratch& s,
                  float* outputs, float* values);
  void (*add)(float* sum, const float* x, int n);
  double (*squares)(const float* x, int n);
  void (*adam)(const AdamStep& step, const float* g, float* first, float* second, float* p, int n);
};

const Kernels& kernels_baseline();
const Kernels& kernels_avx2();
const Kernels& kernels_avx512();

}  // namespace botschool::policy_gradient
