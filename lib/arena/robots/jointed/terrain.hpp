// Shapes of the ground in space: a height and a normal for each place.
#pragma once

#include "lanes.hpp"

BOTSCHOOL_BEGIN

/// The ground below a point.
template <class V>
struct Piece3 {
  V height;
  Vector3<V> normal;
};

template <class V>
struct Terrain {
  BOTSCHOOL_INLINE Piece3<V> under(V, V) const { return {V(0), {V(0), V(0), V(1)}}; }
};

BOTSCHOOL_END
