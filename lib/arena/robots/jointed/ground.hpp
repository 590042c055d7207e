// Shapes of the ground: a height and a slope for each place.
#pragma once

#include "lanes.hpp"

BOTSCHOOL_BEGIN

/// Even ground at height 0.
struct Flat {
  static constexpr bool flat = true;
  template <class V>
  BOTSCHOOL_INLINE V height(V) const {
    return V(0);
  }
  template <class V>
  BOTSCHOOL_INLINE V slope(V) const {
    return V(0);
  }
};

/// Height slope * x + curvature * x^2 / 2: an inclined plane, a valley or a hill.
struct Curve {
  static constexpr bool flat = false;
  double tangent, curvature;
  template <class V>
  BOTSCHOOL_INLINE V height(V x) const {
    return x * (V(tangent) + V(0.5 * curvature) * x);
  }
  template <class V>
  BOTSCHOOL_INLINE V slope(V x) const {
    return V(tangent) + V(curvature) * x;
  }
};

BOTSCHOOL_END
