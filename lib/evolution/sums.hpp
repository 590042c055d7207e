// Sums, powers and the logarithm of random numbers: their last bits are the same on every machine,
// in Python and in a page.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace botschool {

/// a + b as the rounded sum and its error (Knuth's two-sum).
struct Pair {
  double high, low;
};

inline Pair exact_sum(double a, double b) {
  const double sum = a + b, shadow = sum - a;
  return {sum, (a - (sum - shadow)) + (b - shadow)};
}

/// a * b as the rounded product and its error (Dekker 1971), without fused operations.
inline Pair exact_product(double a, double b) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const auto split = [](double x) {
    const double big = splitter * x, high = big - (big - x);
    return Pair{high, x - high};
  };
  const double product = a * b;
  const Pair p = split(a), q = split(b);
  return {product, ((p.high * q.high - product) + p.high * q.low + p.low * q.high) + p.low * q.low};
}

/// base^exponent for 0 < base < 1, rounded once from twice the digits.
inline double power(double base, unsigned exponent) {
  const auto times = [](Pair a, Pair b) {
    Pair p = exact_product(a.high, b.high);
    p.low += a.high * b.low + a.low * b.high;
    return exact_sum(p.high, p.low);
  };
  Pair result{1.0, 0.0}, factor{base, 0.0};
  for (; exponent; exponent >>= 1, factor = times(factor, factor))
    if (exponent & 1) result = times(result, factor);
  return result.high;
}

/// a * b + c, rounded once, without fused operations (Boldo and Melquiond 2008): small parts are
/// added by rounding to odd, so that the last addition rounds as the exact sum would. Not for
/// numbers near the ends of double's range.
inline double fused(double a, double b, double c) {
  const Pair product = exact_product(a, b), low = exact_sum(c, product.low);
  const Pair high = exact_sum(product.high, low.high);
  Pair rest = exact_sum(high.low, low.low);
  std::uint64_t bits;
  std::memcpy(&bits, &rest.high, sizeof bits);
  if (rest.low != 0.0 && bits % 2 == 0) {  // to the neighbour on the side of the error
    bits += (rest.low > 0.0) == (rest.high > 0.0) ? 1 : -1;
    std::memcpy(&rest.high, &bits, sizeof bits);
  }
  return high.high + rest.high;
}

/// The natural logarithm of 1 - u, for u = k / 2^53 in [0, 1), with the bits of glibc's log1p(-u) on
/// a processor with fused operations (docs/page.md). The method is the usual one: 1 - u = 2^k (1 + f)
/// with 1 + f from sqrt(1/2) to sqrt(2), log(1 + f) = f - h + s (h + R), h = f^2 / 2, s = f / (2 + f),
/// and R a polynomial in s^2.
inline double log_of_rest(double u) {
  if (u < 0x1p-29) return u * u * -0.5 - u;
  int k;
  double f = 2.0 * std::frexp(1.0 - u, &k);
  --k;
  if (f >= 0x1.6a09ep0) f *= 0.5, ++k;
  f -= 1.0;
  const double h = 0.5 * f * f, s = f / (2.0 + f), z = s * s, z2 = z * z, z4 = z2 * z2;
  double R = fused(z, 6.666666666666735130e-01,
                   z2 * fused(z, 2.857142874366239149e-01, 3.999999999940941908e-01));
  R = fused(z4, fused(z, 1.818357216161805012e-01, 2.222219843214978396e-01), R);
  R = fused(z4 * z2, fused(z, 1.479819860511658591e-01, 1.531383769920937332e-01), R);
  const double series = s * (h + R);
  if (k == 0) return f - (h - series);
  constexpr double high = 6.93147180369123816490e-01, low = 1.90821492927058770002e-10;  // ln 2
  return fused(k, high, f - (h - fused(k, low, series)));
}

/// The sum of the values, rounded once, whatever their order (Shewchuk 1997): Python's math.fsum.
inline double exact_sum(const double* values, std::size_t count) {
  std::vector<double> parts;  // they do not overlap, the smallest first
  for (std::size_t i = 0; i < count; ++i) {
    double x = values[i];
    std::size_t kept = 0;
    for (const double part : parts) {
      const Pair sum = exact_sum(x, part);
      if (sum.low != 0.0) parts[kept++] = sum.low;
      x = sum.high;
    }
    parts.resize(kept);
    parts.push_back(x);
  }
  if (parts.empty()) return 0.0;
  std::size_t n = parts.size();
  Pair sum{parts[--n], 0.0};
  while (n > 0 && sum.low == 0.0) sum = exact_sum(sum.high, parts[--n]);
  // half a unit in the last place: the rest decides to which side it is rounded
  if (n > 0 && sum.low != 0.0 && (sum.low < 0.0) == (parts[n - 1] < 0.0)) {
    const double twice = 2.0 * sum.low, further = sum.high + twice;
    if (further - sum.high == twice) sum.high = further;
  }
  return sum.high;
}

/// The mean by an exact sum.
inline double exact_mean(const double* values, std::size_t count) {
  return exact_sum(values, count) / static_cast<double>(count);
}

/// The sum of f(value) in pairs of blocks, as numpy adds a row.
template <class F>
double sum_in_pairs(const double* values, std::size_t count, const F& f) {
  if (count < 8) {
    double sum = -0.0;
    for (std::size_t i = 0; i < count; ++i) sum += f(values[i]);
    return sum;
  }
  if (count <= 128) {
    double part[8];
    for (int k = 0; k < 8; ++k) part[k] = f(values[k]);
    std::size_t i = 8;
    for (; i < count - count % 8; i += 8)
      for (int k = 0; k < 8; ++k) part[k] += f(values[i + k]);
    double sum =
        ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
    for (; i < count; ++i) sum += f(values[i]);
    return sum;
  }
  std::size_t half = count / 2;
  half -= half % 8;
  return sum_in_pairs(values, half, f) + sum_in_pairs(values + half, count - half, f);
}

inline double sum_of_sizes(const double* values, std::size_t count) {
  return sum_in_pairs(values, count, [](double x) { return std::fabs(x); });
}

}  // namespace botschool
