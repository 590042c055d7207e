// Adding gradients, measuring them, and a step of Adam.
#pragma once

#include <cmath>

#include "../evonet/real.hpp"
#include "learning.hpp"

BOTSCHOOL_BEGIN
namespace learning {

using namespace policy_gradient;

inline void add(float* BOTSCHOOL_RESTRICT sum, const float* BOTSCHOOL_RESTRICT x, int n) {
  for (int i = 0; i < n; ++i) sum[i] += x[i];
}

/// The sum of squares: 16 partial sums, added in order.
inline double squares(const float* x, int n) {
  double part[16] = {}, sum = 0;
  int i = 0;
  for (; i + 16 <= n; i += 16)
    for (int l = 0; l < 16; ++l) part[l] += static_cast<double>(x[i + l]) * x[i + l];
  for (; i < n; ++i) part[i % 16] += static_cast<double>(x[i]) * x[i];
  for (const double each : part) sum += each;
  return sum;
}

inline void adam(const AdamStep& step, const float* BOTSCHOOL_RESTRICT g,
                 float* BOTSCHOOL_RESTRICT first, float* BOTSCHOOL_RESTRICT second,
                 float* BOTSCHOOL_RESTRICT p, int n) {
  for (int i = 0; i < n; ++i) {
    const float x = g[i] * step.shorter;
    first[i] = kBeta1 * first[i] + (1.0f - kBeta1) * x;
    second[i] = kBeta2 * second[i] + (1.0f - kBeta2) * (x * x);
    p[i] -= step.rate * first[i] / (std::sqrt(second[i]) * step.root + step.epsilon);
  }
}

}  // namespace learning
BOTSCHOOL_END
