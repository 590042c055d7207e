// Sums and powers whose last bits are those of the Python side, on every machine.
#pragma once

#include <cmath>
#include <cstddef>
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
  // half a unit in the last place: what is left decides to which side it is rounded
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
