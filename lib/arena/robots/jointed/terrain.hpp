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

/// A stair: from its beginning on a ramp of kStepWidth, then level.
constexpr double kStairWidth = 0.5;

template <class V>
struct Terrain {
  bool flat = true;
  V x, y;            ///< where in the world the points' coordinates begin
  V phase[kPhases];  ///< of the bumps
  V slope, step, steep, half, stairs, stair_steep, ahead_of[2], aside_of[2];

  /// Sets the shape from lanes of its numbers.
  void shape(const double* slopes, const double* steps, const double* bumps, const double* each) {
    constexpr int W = V::width;
    double values[8][W];
    for (int l = 0; l < W; ++l) {
      const double h = bumps[l] / 2;
      const double row[] = {h,
                            steps[l] / kStepWidth,
                            each[l] / kStepWidth,
                            h * kWaves[0][0],
                            h * kWaves[1][0],
                            h * kWaves[0][1],
                            h * kWaves[1][1]};
      for (int k = 0; k < 7; ++k) values[k][l] = row[k];
    }
    slope = V::from(slopes);
    step = V::from(steps);
    stairs = V::from(each);
    half = V::from(values[0]);
    steep = V::from(values[1]);
    stair_steep = V::from(values[2]);
    for (int w = 0; w < 2; ++w) {
      ahead_of[w] = V::from(values[3 + w]);
      aside_of[w] = V::from(values[5 + w]);
    }
  }

  BOTSCHOOL_INLINE Piece3<V> under(V at_x, V at_y) const {
    const V zero = number(0), one = number(1);
    if (flat) return {zero, {zero, zero, one}};
    V height, ahead, sideways;
    profile(at_x, at_y, height, ahead, sideways);
    const V up = one / square_root(one + ahead * ahead + sideways * sideways);
    return {height, {-(ahead * up), -(sideways * up), up}};
  }

  /// Height, and how much it grows ahead and to the left.
  BOTSCHOOL_INLINE void profile(V at_x, V at_y, V& height, V& ahead, V& sideways) const {
    const V zero = number(0), one = number(1);
    const V px = x + at_x, py = y + at_y;
    const V way = (px - number(kStepPlace)) * number(1 / kStepWidth);
    const V climbed = smaller(larger(way, zero), one);
    height = slope * px + step * climbed;
    ahead = slope + if_positive(climbed * (one - climbed), steep, zero);
    const V far = larger(px - number(kStepPlace), zero) * number(1 / kStairWidth);
    const V below = number(1), whole = smaller(nearest_below(far), number(1e6));
    const V rest = (far - whole) * number(kStairWidth / kStepWidth);
    const V on = smaller(rest, below);
    height += stairs * if_positive(far, whole + on, zero);
    ahead += if_positive(far, if_positive(on * (one - on), stair_steep, zero), zero);
    sideways = zero;
    for (int w = 0; w < 2; ++w) {
      V s[2], c[2];
      sine_cosine(number(kWaves[w][0]) * px + phase[2 * w], s[0], c[0]);
      sine_cosine(number(kWaves[w][1]) * py + phase[2 * w + 1], s[1], c[1]);
      height += half * s[0] * s[1];
      ahead += ahead_of[w] * c[0] * s[1];
      sideways += aside_of[w] * s[0] * c[1];
    }
  }

 private:
  static BOTSCHOOL_INLINE V number(double v) { return V::number(v); }
};

BOTSCHOOL_END
