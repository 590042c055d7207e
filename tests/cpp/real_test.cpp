// The elementary functions against <cmath>, in units in the last place.
#include "evonet/real.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "check.hpp"

using namespace botschool;

namespace {

/// Distance in units in the last place of T; the exact value comes in a wider type.
template <class T, class Wide>
double ulps(T actual, Wide exact) {
  const T size = std::fabs(static_cast<T>(exact));
  const T unit = std::nextafter(size, std::numeric_limits<T>::infinity()) - size;
  return static_cast<double>(std::fabs(static_cast<Wide>(actual) - exact) / unit);
}

/// The largest error of f over random arguments in [low, high] and tiny ones.
template <class T, class Wide, class F, class G>
double worst(F f, G exact, double low, double high) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(low, high), exponent(-30, 0);
  double most = 0;
  for (int i = 0; i < 200000; ++i) {
    double wide = uniform(random);
    if (i % 4 == 0) wide *= std::exp(exponent(random));
    const T x = static_cast<T>(wide);
    if (x < static_cast<T>(low) || x > static_cast<T>(high)) continue;
    most = std::fmax(most, ulps<T, Wide>(f(x), exact(static_cast<Wide>(x))));
  }
  return most;
}

using Long = long double;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST(exponential_is_exact_to_a_unit) {
  auto exact = [](auto x) { return std::exp(x); };
  CHECK((worst<double, Long>(exponential<double>, exact, -700, 700) < 2));
  CHECK((worst<double, Long>(exponential<double>, exact, -2, 2) < 2));
  CHECK((worst<float, double>(exponential<float>, exact, -86, 88) < 2));
  CHECK((worst<float, double>(exponential<float>, exact, -2, 2) < 2));
}

TEST(exponential_at_its_ends) {
  CHECK(exponential(0.0) == 1 && exponential(-0.0) == 1 && exponential(0.0f) == 1);
  CHECK(exponential(-kInfinity) < 1e-300 && exponential(-1e9) >= 0);
  CHECK(exponential(kInfinity) > 1e300 && std::isfinite(exponential(1e300)));
  CHECK(exponential(-1e30f) < 1e-37f && std::isfinite(exponential(1e30f)));
  CHECK(std::isnan(exponential(kNan)) && std::isnan(exponential(static_cast<float>(kNan))));
}

TEST(hyperbolic_tangent_is_exact_to_units) {
  auto exact = [](auto x) { return std::tanh(x); };
  CHECK((worst<double, Long>(hyperbolic_tangent<double>, exact, -25, 25) < 4));
  CHECK((worst<double, Long>(hyperbolic_tangent<double>, exact, -1, 1) < 4));
  CHECK((worst<float, double>(hyperbolic_tangent<float>, exact, -15, 15) < 4));
  CHECK((worst<float, double>(hyperbolic_tangent<float>, exact, -1, 1) < 4));
}

TEST(hyperbolic_tangent_at_its_ends) {
  CHECK(hyperbolic_tangent(0.0) == 0 && hyperbolic_tangent(0.0f) == 0);
  CHECK(hyperbolic_tangent(kInfinity) == 1 && hyperbolic_tangent(-kInfinity) == -1);
  CHECK(hyperbolic_tangent(1e30f) == 1 && hyperbolic_tangent(-1e30f) == -1);
  CHECK(hyperbolic_tangent(1e-300) == 1e-300);
  CHECK(std::isnan(hyperbolic_tangent(kNan)));
  for (double x = -30; x <= 30; x += 0.01) {
    CHECK(std::fabs(hyperbolic_tangent(x)) <= 1);
    CHECK(std::fabs(hyperbolic_tangent(static_cast<float>(x))) <= 1);
  }
}

TEST(logistic_is_exact_to_units) {
  auto exact = [](auto x) { return 1 / (1 + std::exp(-x)); };
  CHECK((worst<double, Long>(logistic<double>, exact, -700, 700) < 4));
  CHECK((worst<double, Long>(logistic<double>, exact, -5, 5) < 4));
  CHECK((worst<float, double>(logistic<float>, exact, -86, 86) < 4));
  CHECK((worst<float, double>(logistic<float>, exact, -5, 5) < 4));
  CHECK(logistic(0.0) == 0.5 && logistic(kInfinity) == 1 && logistic(-kInfinity) < 1e-300);
  CHECK(logistic(1e30f) == 1 && logistic(-1e30f) < 1e-37f && std::isnan(logistic(kNan)));
}

TEST(several_vectors_at_a_time_give_the_same_bits) {
  using Vector = VectorOf<float, 8>;
  constexpr int kEach = sizeof(Vector) / sizeof(float);
  std::mt19937_64 random(3);
  std::normal_distribution<float> normal(0, 30);
  alignas(64) float x[5 * kEach], tangents[5 * kEach], chances[5 * kEach];
  for (int round = 0; round < 20000; ++round) {
    for (int i = 0; i < 5 * kEach; ++i) x[i] = normal(random);
    x[round % (5 * kEach)] = round % 3 == 0   ? static_cast<float>(kNan)
                             : round % 3 == 1 ? static_cast<float>(kInfinity)
                                              : -0.0f;
    std::copy_n(x, 5 * kEach, tangents);
    std::copy_n(x, 5 * kEach, chances);
    hyperbolic_tangents<5, float>(reinterpret_cast<Vector*>(tangents));
    logistics<5, float>(reinterpret_cast<Vector*>(chances));
    for (int i = 0; i < 5 * kEach; ++i) {
      const float tangent = hyperbolic_tangent(x[i]), chance = logistic(x[i]);
      CHECK(bits_of<std::uint32_t>(tangents[i]) == bits_of<std::uint32_t>(tangent));
      CHECK(bits_of<std::uint32_t>(chances[i]) == bits_of<std::uint32_t>(chance));
    }
  }
}

TEST(sine_and_cosine_are_exact_to_units) {
  // near their zeros the error is absolute: of a unit of values near 1
  for (double range : {0.5, 4.0, 100.0, 1e6}) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform(-range, range);
    for (int i = 0; i < 100000; ++i) {
      const double x = uniform(random);
      double sine, cosine;
      sine_cosine(x, sine, cosine);
      const Long s = std::sin(static_cast<Long>(x)), c = std::cos(static_cast<Long>(x));
      CHECK(std::fabs(sine - s) < 2.3e-16L && std::fabs(cosine - c) < 2.3e-16L);
    }
  }
  auto sine = [](double x) {
    double s, c;
    sine_cosine(x, s, c);
    return s;
  };
  CHECK((worst<double, Long>(sine, [](Long x) { return std::sin(x); }, -1, 1) < 2));
}

TEST(sine_and_cosine_of_special_angles) {
  double s, c;
  sine_cosine(0, s, c);
  CHECK(s == 0 && c == 1);
  sine_cosine(kPi, s, c);
  CHECK(c == -1 && std::fabs(s - 1.2246467991473532e-16) < 1e-30);
  sine_cosine(kPi / 2, s, c);
  CHECK(s == 1 && std::fabs(c - 6.123233995736766e-17) < 1e-30);
  sine_cosine(-kPi / 2, s, c);
  CHECK(s == -1);
  sine_cosine(kNan, s, c);
  CHECK(std::isnan(s) && std::isnan(c));
}

TEST(logarithm_is_exact_to_units) {
  auto exact = [](auto x) { return std::log(x); };
  auto own = [](double x) { return logarithm(x); };
  CHECK((worst<double, Long>(own, exact, 1e-300, 1) < 3));
  CHECK((worst<double, Long>(own, exact, 0.5, 2) < 3));
  CHECK((worst<double, Long>(own, exact, 1, 1e300) < 3));
  CHECK(logarithm(1.0) == 0);
  for (int k = -1000; k < 1000; ++k)
    CHECK((k == 0 || ulps<double, Long>(logarithm(std::ldexp(1, k)), k * std::log(Long(2))) < 2));
}

TEST(clamp_and_nearest) {
  CHECK(clamp(3.0, -1.0, 2.0) == 2 && clamp(-3.0, -1.0, 2.0) == -1 && clamp(0.5, -1.0, 2.0) == 0.5);
  CHECK(std::isnan(clamp(kNan, -1.0, 1.0)));
  for (double x : {0.0, 0.49, 0.51, -0.49, -0.51, 1e9 + 0.4, -1e9 - 0.6})
    CHECK(nearest(x) == std::nearbyint(x));
}
