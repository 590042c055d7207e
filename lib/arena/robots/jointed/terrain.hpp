// The ground in space: a height and a normal for each place.
#pragma once

#include "lanes.hpp"
#include "solid.hpp"

BOTSCHOOL_BEGIN

/// The ground below a point.
template <class V>
struct Piece3 {
  V height;
  Vector3<V> normal;
};

constexpr double kStepPlace = 2, kStepWidth = 0.05;  ///< a step is a short ramp
/// Waves of the bumps: radians a metre, ahead and sideways.
constexpr double kWaves[2][2] = {{4.1, 5.3}, {7.9, 6.7}};
constexpr int kPhases = 4;

template <class V>
struct Terrain {
  Ground ground;
  V x, y;            ///< where in the world the points' coordinates begin
  V phase[kPhases];  ///< of the bumps

  BOTSCHOOL_INLINE bool flat() const {
    return ground.slope == 0 && ground.step == 0 && ground.bumps == 0;
  }

  BOTSCHOOL_INLINE Piece3<V> under(V at_x, V at_y) const {
    const V zero = number(0), one = number(1);
    if (flat()) return {zero, {zero, zero, one}};
    const V px = x + at_x, py = y + at_y;
    const V way = (px - number(kStepPlace)) * number(1 / kStepWidth);
    const V climbed = smaller(larger(way, zero), one);
    V height = number(ground.slope) * px + number(ground.step) * climbed;
    V ahead = number(ground.slope) +
              if_positive(climbed * (one - climbed), number(ground.step / kStepWidth), zero);
    V sideways = zero;
    for (int w = 0; w < 2; ++w) {
      V s[2], c[2];
      sine_cosine(number(kWaves[w][0]) * px + phase[2 * w], s[0], c[0]);
      sine_cosine(number(kWaves[w][1]) * py + phase[2 * w + 1], s[1], c[1]);
      const double half = ground.bumps / 2;
      height += number(half) * s[0] * s[1];
      ahead += number(half * kWaves[w][0]) * c[0] * s[1];
      sideways += number(half * kWaves[w][1]) * s[0] * c[1];
    }
    const V up = one / square_root(one + ahead * ahead + sideways * sideways);
    return {height, {-(ahead * up), -(sideways * up), up}};
  }

 private:
  static BOTSCHOOL_INLINE V number(double v) { return V::number(v); }
};

BOTSCHOOL_END
