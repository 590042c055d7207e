// The chain of BodyBrain: what the 64 parameters of a body mean, and its rods.
// docs/specification.md, "PlanarBodyBrain".
#pragma once

#include "chain.hpp"

BOTSCHOOL_BEGIN

constexpr int kRods = 11;
constexpr int kChainParameters = 6 * kRods - 2;
inline constexpr ChainRules kChainRules{{2.5}, {4000, 40}, 0.01, 0.1, 0.5};
constexpr double kChainGravity = 10;
constexpr double kMotorSpeed = 5, kMotorTorque = 90;

/// A body, as it stands in rows of numbers, one row after another: metres, rad, kg / m^2.
enum ChainRow {
  kLength = 0,
  kThickness = kLength + kRods,
  kLow = kThickness + kRods,  ///< limits of each hinge around its angle at rest
  kHigh = kLow + kRods - 1,
  kAngle = kHigh + kRods - 1,  ///< at rest: of the torso, and of each rod against the one before
  kRodDensity = kAngle + kRods,
  kChainRows = kRodDensity + kRods
};
static_assert(kChainRows == kChainParameters, "as many numbers as parameters");

/// The body of 64 parameters; `set(row, value)` takes its numbers. Without parameters it is straight.
template <class F>
void read_chain(const double* parameters, F set) {
  const auto value = [&](int i) { return parameters ? parameters[i] : 0.0; };
  const auto within = [&](int i) { return limited(value(i), -1.0, 1.0); };
  for (int i = 0; i < kRods; ++i) {
    set(kLength + i, 0.8 * (1 + 0.9 * hyperbolic_tangent(value(2 * i))));
    set(kThickness + i, 0.2 * (1 + 0.9 * hyperbolic_tangent(value(2 * i + 1))));
    set(kAngle + i, 0.75 * kPi * within(4 * kRods - 2 + i));
    set(kRodDensity + i, 5 + 0.8 * hyperbolic_tangent(value(5 * kRods - 2 + i)));
  }
  for (int i = 0; i < kRods - 1; ++i) {
    const double one = 0.5 * kPi * within(2 * kRods + 2 * i);
    const double other = 0.5 * kPi * within(2 * kRods + 2 * i + 1);
    set(kLow + i, one < other ? one : other);
    set(kHigh + i, one < other ? other : one);
  }
}

/// Puts the bodies into a chain; `row(i)` gives the lanes of row i.
template <class C, class F>
BOTSCHOOL_INLINE void set_rods(C& chain, F row) {
  using V = typename C::V;
  for (int i = 0; i < kRods; ++i) {
    const V length = row(kLength + i), thickness = row(kThickness + i);
    chain.length[i] = length;
    chain.radius[i] = C::number(0.5) * thickness;
    chain.mass[i] = row(kRodDensity + i) * (length * thickness);
    // a rectangle's about the middle of its rear end
    chain.inertia[i] = chain.mass[i] * (length * length * C::number(1.0 / 3) +
                                        thickness * thickness * C::number(1.0 / 12));
    chain.low[i] = i > 0 ? row(kLow + i - 1) : V(0);
    chain.high[i] = i > 0 ? row(kHigh + i - 1) : V(0);
    chain.rest[i] = i > 0 ? row(kAngle + i) : V(0);
  }
}

/// What motors try to do on actions: full torque at -1 and 1.
template <class V>
BOTSCHOOL_INLINE Drive<V> drive_of(V action) {
  const V size = smaller(larger(action, -action), V(1));
  return {if_positive(action, V(kMotorSpeed), V(-kMotorSpeed)), V(kMotorTorque) * size};
}

BOTSCHOOL_END
