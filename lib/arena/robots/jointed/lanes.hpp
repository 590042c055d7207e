// Arithmetic on numbers side by side, one a lane, and on vectors of them: what formulas of jointed
// bodies are written in.
#pragma once

#include <cmath>
#include <cstring>

#include "../../../evonet/real.hpp"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // all of it is inlined, so no vector is ever passed
#endif

BOTSCHOOL_BEGIN

/// W numbers; a single number stands for W equal ones.
template <class T, int W>
struct Lanes {
#if defined(__GNUC__)
  using Data [[gnu::vector_size(sizeof(T) * W)]] = T;
  Data data;
#else
  T data[W];
#endif

  static constexpr int width = W;

  Lanes() = default;
  BOTSCHOOL_INLINE Lanes(T x) {
#if defined(__GNUC__)
    data = x - Data{};  // a loop would become blends of halves
#else
    for (int l = 0; l < W; ++l) data[l] = x;
#endif
  }
  static BOTSCHOOL_INLINE Lanes number(double x) { return Lanes(static_cast<T>(x)); }
  /// From W numbers in memory, and back.
  template <class From>
  static BOTSCHOOL_INLINE Lanes from(const From* values) {
    alignas(64) T rounded[W];
    for (int l = 0; l < W; ++l) rounded[l] = static_cast<T>(values[l]);
    Lanes lanes;
    std::memcpy(&lanes.data, rounded, sizeof rounded);
    return lanes;
  }
  template <class To>
  BOTSCHOOL_INLINE void to(To* values) const {
    alignas(64) T own[W];
    std::memcpy(own, &data, sizeof own);
    for (int l = 0; l < W; ++l) values[l] = static_cast<To>(own[l]);
  }

  BOTSCHOOL_INLINE T operator[](int lane) const { return data[lane]; }

#if defined(__GNUC__)
#define BOTSCHOOL_LANES(op)                                     \
  friend BOTSCHOOL_INLINE Lanes operator op(Lanes a, Lanes b) { \
    Lanes result;                                               \
    result.data = a.data op b.data;                             \
    return result;                                              \
  }
#else
#define BOTSCHOOL_LANES(op)                                         \
  friend BOTSCHOOL_INLINE Lanes operator op(Lanes a, Lanes b) {     \
    for (int l = 0; l < W; ++l) a.data[l] = a.data[l] op b.data[l]; \
    return a;                                                       \
  }
#endif
  BOTSCHOOL_LANES(+)
  BOTSCHOOL_LANES(-)
  BOTSCHOOL_LANES(*)
  BOTSCHOOL_LANES(/)
#undef BOTSCHOOL_LANES
  friend BOTSCHOOL_INLINE Lanes operator-(Lanes a) { return Lanes(T(0)) - a; }
  BOTSCHOOL_INLINE void operator+=(Lanes b) { *this = *this + b; }
  BOTSCHOOL_INLINE void operator-=(Lanes b) { *this = *this - b; }
};

/// Where x > 0 yes, elsewhere (NaN too) no.
template <class T, int W>
BOTSCHOOL_INLINE Lanes<T, W> if_positive(Lanes<T, W> x, Lanes<T, W> yes, Lanes<T, W> no) {
#if defined(__GNUC__)
  Lanes<T, W> result;
  result.data = x.data > Lanes<T, W>(T(0)).data ? yes.data : no.data;
  return result;
#else
  for (int l = 0; l < W; ++l)
    if (!(x.data[l] > T(0))) yes.data[l] = no.data[l];
  return yes;
#endif
}

/// Largest whole numbers that are not above x; |x| < 2^22.
template <class T, int W>
BOTSCHOOL_INLINE Lanes<T, W> nearest_below(Lanes<T, W> x) {
  const Lanes<T, W> magic(sizeof(T) == 8 ? T(6755399441055744.0) : T(12582912));
  const Lanes<T, W> whole = (x + magic) - magic;
  return whole - if_positive(whole - x, Lanes<T, W>(T(1)), Lanes<T, W>(T(0)));
}

template <class T, int W>
BOTSCHOOL_INLINE Lanes<T, W> larger(Lanes<T, W> a, Lanes<T, W> b) {
  return if_positive(a - b, a, b);
}

template <class T, int W>
BOTSCHOOL_INLINE Lanes<T, W> smaller(Lanes<T, W> a, Lanes<T, W> b) {
  return if_positive(a - b, b, a);
}

/// Whether x > 0 in any lane.
template <class T, int W>
BOTSCHOOL_INLINE bool any_positive(Lanes<T, W> x) {
  const Lanes<T, W> found = if_positive(x, Lanes<T, W>(T(1)), Lanes<T, W>(T(0)));
  std::uint32_t words[sizeof found / 4], any = 0;
  std::memcpy(words, &found, sizeof found);
  for (const std::uint32_t word : words) any |= word;
  return any != 0;
}

template <class T, int W>
BOTSCHOOL_INLINE Lanes<T, W> square_root(Lanes<T, W> x) {
  alignas(64) T values[W];
  x.to(values);
  for (int l = 0; l < W; ++l) values[l] = std::sqrt(values[l]);
  return Lanes<T, W>::from(values);
}

/// Sine and cosine, lane by lane.
template <class T, int W>
BOTSCHOOL_INLINE void sine_cosine(Lanes<T, W> x, Lanes<T, W>& sine, Lanes<T, W>& cosine) {
  alignas(64) T angle[W], s[W], c[W];
  x.to(angle);
  for (int l = 0; l < W; ++l) sine_cosine(angle[l], s[l], c[l]);
  sine = Lanes<T, W>::from(s);
  cosine = Lanes<T, W>::from(c);
}

/// A vector in the plane, in lanes.
template <class V>
struct Vector2 {
  V x, z;
  friend BOTSCHOOL_INLINE Vector2 operator+(Vector2 a, Vector2 b) { return {a.x + b.x, a.z + b.z}; }
  friend BOTSCHOOL_INLINE Vector2 operator-(Vector2 a, Vector2 b) { return {a.x - b.x, a.z - b.z}; }
  friend BOTSCHOOL_INLINE Vector2 operator*(V s, Vector2 a) { return {s * a.x, s * a.z}; }
};

template <class V>
BOTSCHOOL_INLINE V dot(Vector2<V> a, Vector2<V> b) {
  return a.x * b.x + a.z * b.z;
}

/// A quarter turn counter-clockwise: how a point at `a` moves when its angle grows.
template <class V>
BOTSCHOOL_INLINE Vector2<V> turn(Vector2<V> a) {
  return {-a.z, a.x};
}

/// A vector in space, in lanes.
template <class V>
struct Vector3 {
  V x, y, z;
  friend BOTSCHOOL_INLINE Vector3 operator+(Vector3 a, Vector3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend BOTSCHOOL_INLINE Vector3 operator-(Vector3 a, Vector3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend BOTSCHOOL_INLINE Vector3 operator*(V s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class V>
BOTSCHOOL_INLINE V dot(Vector3<V> a, Vector3<V> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class V>
BOTSCHOOL_INLINE Vector3<V> cross(Vector3<V> a, Vector3<V> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A 3 x 3 matrix by its columns.
template <class V>
struct Matrix3 {
  Vector3<V> column[3];
  BOTSCHOOL_INLINE Vector3<V> times(Vector3<V> a) const {
    return a.x * column[0] + a.y * column[1] + a.z * column[2];
  }
  /// The transposed matrix times a.
  BOTSCHOOL_INLINE Vector3<V> back(Vector3<V> a) const {
    return {dot(column[0], a), dot(column[1], a), dot(column[2], a)};
  }
  BOTSCHOOL_INLINE void add(const Matrix3& b) {
    for (int k = 0; k < 3; ++k) column[k] = column[k] + b.column[k];
  }
};

template <class V>
struct Symmetric3 {
  V xx, yy, zz, xy, xz, yz;
  BOTSCHOOL_INLINE Vector3<V> times(Vector3<V> a) const {
    return {xx * a.x + xy * a.y + xz * a.z, xy * a.x + yy * a.y + yz * a.z,
            xz * a.x + yz * a.y + zz * a.z};
  }
  BOTSCHOOL_INLINE void add(const Symmetric3& b) {
    xx += b.xx;
    yy += b.yy;
    zz += b.zz;
    xy += b.xy;
    xz += b.xz;
    yz += b.yz;
  }
  /// Subtracts s u^T, which is symmetric.
  BOTSCHOOL_INLINE void reduce(Vector3<V> s, Vector3<V> u) {
    xx -= s.x * u.x;
    yy -= s.y * u.y;
    zz -= s.z * u.z;
    xy -= s.x * u.y;
    xz -= s.x * u.z;
    yz -= s.y * u.z;
  }
};

/// A symmetric 2 x 2 matrix: resistance to motion in the plane.
template <class V>
struct Resistance {
  V xx = V(0), xz = V(0), zz = V(0);
};

BOTSCHOOL_END
