// Elementary functions without branches, so that loops over lanes vectorise and every machine gives
// the same bits. Polynomials are Taylor series around 0, long enough that the first term left out
// is below the rounding error on the reduced range. NaN in, NaN out.
#pragma once

#include <cstdint>
#include <cstring>
#include <utility>

#include "isa.hpp"

BOTSCHOOL_BEGIN

/// L values side by side, anywhere in an array of T.
#if defined(__GNUC__)
template <class T, int L>
using LanesOf [[gnu::vector_size(sizeof(T) * L), gnu::aligned(alignof(T)), gnu::may_alias]] = T;
#else
template <class T, int L>
struct LanesOf {
  T value[L];
  void operator+=(T x) {
    for (T& v : value) v += x;
  }
  void operator+=(const LanesOf& x) {
    for (int l = 0; l < L; ++l) value[l] += x.value[l];
  }
  LanesOf operator*(const LanesOf& x) const {
    LanesOf product = *this;
    for (int l = 0; l < L; ++l) product.value[l] *= x.value[l];
    return product;
  }
  friend LanesOf operator*(T x, LanesOf y) {
    for (T& v : y.value) v *= x;
    return y;
  }
};
#endif

#if defined(__clang__) || __GNUC__ >= 12
/// Swaps the right half of `a` with the left half of `b`, in each block of 2 * size values.
template <class T, int L, int size, int... i>
BOTSCHOOL_INLINE void swap_halves(LanesOf<T, L>& a, LanesOf<T, L>& b,
                                  std::integer_sequence<int, i...>) {
  const LanesOf<T, L> left = __builtin_shufflevector(a, b, (i & size ? L + i - size : i)...);
  b = __builtin_shufflevector(a, b, (i & size ? L + i : i + size)...);
  a = left;
}

/// Turns a square of numbers: row i gets the i-th of each row.
template <class T, int L, int size = L / 2>
BOTSCHOOL_INLINE void transpose(LanesOf<T, L>* rows) {
  if constexpr (size > 0) {
    for (int i = 0; i < L; ++i)
      if (!(i & size))
        swap_halves<T, L, size>(rows[i], rows[i + size], std::make_integer_sequence<int, L>());
    transpose<T, L, size / 2>(rows);
  }
}
#else
template <class T, int L>
void transpose(LanesOf<T, L>* rows) {
  T* value = reinterpret_cast<T*>(rows);
  for (int i = 1; i < L; ++i)
    for (int j = 0; j < i; ++j) std::swap(value[i * L + j], value[j * L + i]);
}
#endif

template <class To, class From>
BOTSCHOOL_INLINE To bits_of(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

/// The unit of elementary functions: L values that begin at a multiple of their size, or a single
/// one if the compiler cannot use vectors.
template <class T, int L>
struct Vectors {
#if defined(__GNUC__)
  using type [[gnu::vector_size(sizeof(T) * L)]] = T;
#else
  using type = T;
#endif
};
template <class T>
struct Vectors<T, 1> {
  using type = T;
};
template <class T, int L>
using VectorOf = typename Vectors<T, L>::type;

/// Integers of a float's size, as many as F has values.
template <class F>
struct BitsOf {
  using type = decltype(F{} < F{});
};
template <>
struct BitsOf<float> {
  using type = std::uint32_t;
};
template <class F>
using Bits = typename BitsOf<F>::type;

template <class T>
BOTSCHOOL_INLINE T clamp(T x, T low, T high) {
  x = x < low ? low : x;
  return x > high ? high : x;
}

constexpr double kPi = 3.14159265358979323846;

/// x = k ln 2 + rest with |rest| <= ln 2 / 2; scale = 2^k. Adding 1.5 * 2^mantissa rounds to the
/// nearest integer and leaves it in the low bits.
BOTSCHOOL_INLINE void split_by_ln2(double x, double& rest, double& scale) {
  const double magic = 6755399441055744.0;
  const double shifted = x * 1.4426950408889634074 + magic;
  const double k = shifted - magic;
  rest = (x - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;
  scale = bits_of<double>((bits_of<std::uint64_t>(shifted) + 1023) << 52);
}
/// F: float, or a vector of it.
template <class F>
BOTSCHOOL_INLINE void split_by_ln2(F x, F& rest, F& scale) {
  const float magic = 12582912.0f;
  const F shifted = x * 1.44269504f + magic;
  const F k = shifted - magic;
  rest = (x - k * 0.693145751953125f) - k * 1.42860677e-06f;
  scale = bits_of<F>((bits_of<Bits<F>>(shifted) + 127) << 23);
}

/// exp(r) - 1 for |r| <= ln 2 / 2.
BOTSCHOOL_INLINE double expm1_series(double r) {
  double p = 1.0 / 6227020800.0;
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  return (p * r) * r + r;
}
template <class F>
BOTSCHOOL_INLINE F expm1_series(F r) {
  F p = r * (1.0f / 5040.0f) + 1.0f / 720.0f;
  p = p * r + 1.0f / 120.0f;
  p = p * r + 1.0f / 24.0f;
  p = p * r + 1.0f / 6.0f;
  p = p * r + 0.5f;
  return (p * r) * r + r;
}

/// Arguments past these give 0 and (nearly) the largest finite number.
template <class T>
constexpr T kExpLow = sizeof(T) == 8 ? T(-708) : T(-87);
template <class T>
constexpr T kExpHigh = sizeof(T) == 8 ? T(709) : T(88);

/// exp(2x) - 1 is taken of 2x within these, where tanh(x) is not yet 1.
template <class T>
constexpr T kTwiceHigh = sizeof(T) == 8 ? T(40) : T(20);

template <class T>
BOTSCHOOL_INLINE T exponential(T x) {
  T rest, scale;
  split_by_ln2(clamp(x, kExpLow<T>, kExpHigh<T>), rest, scale);
  return scale * expm1_series(rest) + scale;
}

/// exp(2x) - 1
template <class T>
BOTSCHOOL_INLINE T expm1_twice(T x) {
  T rest, scale;
  split_by_ln2(clamp(x + x, -kTwiceHigh<T>, kTwiceHigh<T>), rest, scale);
  return scale * expm1_series(rest) + (scale - T(1));
}

/// The same for several limited arguments at a time, whose operations then run side by side: turns
/// x into exp(x) - scale, so that the sum of both is exp(x).
template <int n, class F>
BOTSCHOOL_INLINE void exponentials(F* x, F* scale) {
  F rest[n];
  for (int i = 0; i < n; ++i) split_by_ln2(x[i], rest[i], scale[i]);
  for (int i = 0; i < n; ++i) x[i] = scale[i] * expm1_series(rest[i]);
}

template <class T>
BOTSCHOOL_INLINE T hyperbolic_tangent(T x) {
  const T e = expm1_twice(x);
  return e / (e + T(2));
}

template <class T>
BOTSCHOOL_INLINE T logistic(T x) {
  return T(1) / (T(1) + exponential(-x));
}

/// hyperbolic_tangent and logistic for several vectors at a time, in place.
template <int n, class T, class F>
BOTSCHOOL_INLINE void hyperbolic_tangents(F* x) {
  F e[n], scale[n];
  for (int i = 0; i < n; ++i) e[i] = clamp(x[i] + x[i], F{} - kTwiceHigh<T>, F{} + kTwiceHigh<T>);
  exponentials<n>(e, scale);
  for (int i = 0; i < n; ++i) {
    e[i] += scale[i] - T(1);
    x[i] = e[i] / (e[i] + T(2));
  }
}
template <int n, class T, class F>
BOTSCHOOL_INLINE void logistics(F* x) {
  F scale[n];
  for (int i = 0; i < n; ++i) x[i] = clamp(-x[i], F{} + kExpLow<T>, F{} + kExpHigh<T>);
  exponentials<n>(x, scale);
  for (int i = 0; i < n; ++i) x[i] = T(1) / (T(1) + (x[i] + scale[i]));
}

/// Nearest integer, as a double; |x| < 2^51.
BOTSCHOOL_INLINE double nearest(double x) {
  const double magic = 6755399441055744.0;
  return (x + magic) - magic;
}

BOTSCHOOL_INLINE float nearest(float x) {
  const float magic = 12582912.0f;
  return (x + magic) - magic;
}

/// Largest whole number that is not above x; |x| < 2^51.
BOTSCHOOL_INLINE double floor_of(double x) {
  const double whole = nearest(x);
  return whole > x ? whole - 1 : whole;
}

/// Sine and cosine; full precision for |x| up to about 10^6.
BOTSCHOOL_INLINE void sine_cosine(double x, double& sine, double& cosine) {
  const double magic = 6755399441055744.0;
  const double shifted = x * (2.0 / kPi) + magic;
  const double k = shifted - magic;
  const std::uint64_t quadrant = bits_of<std::uint64_t>(shifted);
  // pi / 2 in three parts, the first two with trailing zeros: k times each is exact
  double r = x - k * 1.57079632673412561417e+00;
  r -= k * 6.07710050630396597660e-11;
  r -= k * 2.02226624879595063154e-21;
  const double z = r * r;
  double s = 1.0 / 355687428096000.0;
  s = s * z - 1.0 / 1307674368000.0;
  s = s * z + 1.0 / 6227020800.0;
  s = s * z - 1.0 / 39916800.0;
  s = s * z + 1.0 / 362880.0;
  s = s * z - 1.0 / 5040.0;
  s = s * z + 1.0 / 120.0;
  s = s * z - 1.0 / 6.0;
  s = (s * z) * r + r;
  double c = -1.0 / 6402373705728000.0;
  c = c * z + 1.0 / 20922789888000.0;
  c = c * z - 1.0 / 87178291200.0;
  c = c * z + 1.0 / 479001600.0;
  c = c * z - 1.0 / 3628800.0;
  c = c * z + 1.0 / 40320.0;
  c = c * z - 1.0 / 720.0;
  c = c * z + 1.0 / 24.0;
  c = (c * z) * z + (1.0 - 0.5 * z);
  const std::uint64_t swap = 0 - (quadrant & 1);
  const std::uint64_t s_bits = bits_of<std::uint64_t>(s), c_bits = bits_of<std::uint64_t>(c);
  sine = bits_of<double>(((s_bits & ~swap) | (c_bits & swap)) ^ ((quadrant & 2) << 62));
  cosine = bits_of<double>(((c_bits & ~swap) | (s_bits & swap)) ^ (((quadrant + 1) & 2) << 62));
}

/// In single precision; for |x| up to about 1000.
BOTSCHOOL_INLINE void sine_cosine(float x, float& sine, float& cosine) {
  const float magic = 12582912.0f;
  const float shifted = x * float(2.0 / kPi) + magic;
  const float k = shifted - magic;
  const std::uint32_t quadrant = bits_of<std::uint32_t>(shifted);
  float r = x - k * 1.5703125f;
  r -= k * 4.83751296997070312500e-04f;
  r -= k * 7.54978995489188216e-08f;
  const float z = r * r;
  float s = 1.0f / 362880.0f;
  s = s * z - 1.0f / 5040.0f;
  s = s * z + 1.0f / 120.0f;
  s = s * z - 1.0f / 6.0f;
  s = (s * z) * r + r;
  float c = -1.0f / 3628800.0f;
  c = c * z + 1.0f / 40320.0f;
  c = c * z - 1.0f / 720.0f;
  c = c * z + 1.0f / 24.0f;
  c = (c * z) * z + (1.0f - 0.5f * z);
  const std::uint32_t swap = 0 - (quadrant & 1);
  const std::uint32_t s_bits = bits_of<std::uint32_t>(s), c_bits = bits_of<std::uint32_t>(c);
  sine = bits_of<float>(((s_bits & ~swap) | (c_bits & swap)) ^ ((quadrant & 2) << 30));
  cosine = bits_of<float>(((c_bits & ~swap) | (s_bits & swap)) ^ (((quadrant + 1) & 2) << 30));
}

/// Angle of the direction (x, y), in [-pi, pi]; 0 for (0, 0).
template <class T>
BOTSCHOOL_INLINE T arctangent(T y, T x) {
  const T ax = x < T(0) ? -x : x, ay = y < T(0) ? -y : y;
  const bool steep = ay > ax;
  const T low = steep ? ax : ay, high = steep ? ay : ax;
  T t = low / (high > T(0) ? high : T(1));  // tan in [0, 1]
  // turned back by pi / 4 or pi / 8, or both, so that the series converges fast
  T base = T(0);
  const T eighth = T(0.41421356237309504880), sixteenth = T(0.19891236737965800691);
  const bool far = t > eighth;
  t = far ? (t - T(1)) / (t + T(1)) : t;
  base = far ? T(kPi / 4) : base;
  const T side = t < T(0) ? T(-1) : T(1);
  const T size = t * side;
  const bool farther = size > sixteenth;
  const T turned = farther ? (size - eighth) / (size * eighth + T(1)) : size;
  base += farther ? side * T(kPi / 8) : T(0);
  const T z = turned * turned;
  T p;
  if constexpr (sizeof(T) == 8) {
    p = T(1.0 / 25.0);
    p = p * z - T(1.0 / 23.0);
    p = p * z + T(1.0 / 21.0);
    p = p * z - T(1.0 / 19.0);
    p = p * z + T(1.0 / 17.0);
    p = p * z - T(1.0 / 15.0);
    p = p * z + T(1.0 / 13.0);
    p = p * z - T(1.0 / 11.0);
    p = p * z + T(1.0 / 9.0);
  } else {
    p = T(1.0 / 9.0);
  }
  p = p * z - T(1.0 / 7.0);
  p = p * z + T(1.0 / 5.0);
  p = p * z - T(1.0 / 3.0);
  T angle = base + side * ((p * z) * turned + turned);
  angle = steep ? T(kPi / 2) - angle : angle;
  angle = x < T(0) ? T(kPi) - angle : angle;
  return y < T(0) ? -angle : angle;
}

/// Natural logarithm of a positive normal number.
BOTSCHOOL_INLINE float logarithm(float x) {
  const std::uint32_t bits = bits_of<std::uint32_t>(x);
  const std::uint32_t exponent = (bits - 0x3f3504f3u) & 0xff800000u;
  const float mantissa = bits_of<float>(bits - exponent);
  const float k = static_cast<float>(static_cast<std::int32_t>(exponent) >> 23);
  const float f = (mantissa - 1.0f) / (mantissa + 1.0f);
  const float z = f * f;
  float p = 1.0f / 9.0f;
  p = p * z + 1.0f / 7.0f;
  p = p * z + 1.0f / 5.0f;
  p = p * z + 1.0f / 3.0f;
  p = 2.0f * (f * z * p + f);
  return k * 0.693145751953125f + (p + k * 1.42860677e-06f);
}
BOTSCHOOL_INLINE double logarithm(double x) {
  const std::uint64_t bits = bits_of<std::uint64_t>(x);
  // the mantissa is taken to [sqrt(1/2), sqrt(2)), so that the series converges fast
  const std::uint64_t offset = bits - 0x3fe6a09e667f3bcdull;
  const std::uint64_t exponent = offset & 0xfff0000000000000ull;
  const double mantissa = bits_of<double>(bits - exponent);
  const double magic = 6755399441055744.0;
  // an arithmetic shift by 52, done so that it vectorises: biased, then unbiased
  const double k =
      bits_of<double>(((exponent + 0x4000000000000000ull) >> 52) + 0x4338000000000000ull) - magic -
      1024.0;
  const double f = (mantissa - 1.0) / (mantissa + 1.0);
  const double z = f * f;
  double p = 1.0 / 21.0;
  p = p * z + 1.0 / 19.0;
  p = p * z + 1.0 / 17.0;
  p = p * z + 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z + 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z + 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z + 1.0 / 3.0;
  p = 2.0 * (f * z * p + f);
  return k * 6.93147180369123816490e-01 + (p + k * 1.90821492927058770002e-10);
}

BOTSCHOOL_END
