// The tested twins of botschool/evolution/algorithms/openaies.py and sss.py: the same numbers, bit by
// bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

#include "normals.hpp"
#include "settings.hpp"
#include "sums.hpp"

namespace botschool {

using Values = std::vector<double>;
using Initial = std::function<Values(std::uint32_t)>;

/// Indices from the largest value to the smallest, or with `rising` the reverse; the earlier wins
/// ties.
inline std::vector<std::size_t> ranking(const double* values, std::size_t count,
                                        bool rising = false) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [=](std::size_t a, std::size_t b) {
    return rising ? values[a] < values[b] : values[a] > values[b];
  });
  return order;
}

/// Parameters that climb, and Adam's first and second moment (Kingma and Ba 2015).
struct Centre {
  Values x, m, v;
};

/// Writes candidates on both sides of a centre along each direction: + and - by turns.
inline void mirror(const Values& centre, const Values& samples, double deviation,
                   double* candidates) {
  const std::size_t n = centre.size();
  for (std::size_t s = 0; s < samples.size() / n; ++s) {
    double *plus = candidates + 2 * s * n, *minus = plus + n;
    for (std::size_t i = 0; i < n; ++i) {
      const double change = deviation * samples[s * n + i];
      plus[i] = centre[i] + change;
      minus[i] = centre[i] - change;
    }
  }
}

/// The utility of each candidate, by its rank: from -0.5, the worst, to 0.5.
inline Values utilities_of(const double* fitness, std::size_t count) {
  const auto order = ranking(fitness, count, true);
  Values utilities(count);
  for (std::size_t i = 0; i < count; ++i)
    utilities[order[i]] = i + 1 == count ? 0.5 : i * (1.0 / (count - 1)) + -0.5;
  return utilities;
}

/// The direction in which fitness rises, by the ranks of the candidates that `mirror` wrote.
inline Values gradient(const double* fitness, std::size_t count, const Values& samples) {
  const Values utilities = utilities_of(fitness, count);
  const std::size_t n = 2 * samples.size() / count;
  Values rising(n);
  for (std::size_t s = 0; s < count / 2; ++s) {
    const double weight = utilities[2 * s] - utilities[2 * s + 1];
    for (std::size_t i = 0; i < n; ++i) {
      const double part = weight * samples[s * n + i];
      rising[i] = s == 0 ? part : rising[i] + part;
    }
  }
  for (double& each : rising) each /= static_cast<double>(count);
  return rising;
}

constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-8, kDecay = 0.005;

/// A step of Adam, of this size, in the direction that rises.
inline void climb(Centre& centre, const Values& rising, int wdecay, double step) {
  for (std::size_t i = 0; i < centre.x.size(); ++i) {
    double &x = centre.x[i], &m = centre.m[i], &v = centre.v[i], descent = -rising[i];
    if (wdecay == 1) descent += kDecay * x;
    if (wdecay == 2) descent += kDecay * ((x > 0) - (x < 0));
    m = kBeta1 * m + (1 - kBeta1) * descent;
    v = kBeta2 * v + (1 - kBeta2) * (descent * descent);
    x = x - step * m / (std::sqrt(v) + kEpsilon);
  }
}

/// The size of Adam's step number t, from 1 on.
inline double adam_step(double stepsize, unsigned t) {
  return stepsize * std::sqrt(1 - power(kBeta2, t)) / (1 - power(kBeta1, t));
}

/// A population: ask for candidates, measure them, tell their fitness, and repeat.
class Strategy {
 public:
  virtual ~Strategy() = default;
  /// Writes all candidates, one after another, and the seed of each one's evaluation.
  virtual void ask(Values& candidates, std::vector<std::uint64_t>& seeds) = 0;
  virtual void tell(const Values& fitness) = 0;
  virtual double average_parameter() const = 0;
};

class OpenAIES final : public Strategy {
 public:
  OpenAIES(const OpenAIESSettings& given, const Initial& initial, std::uint64_t seed)
      : given_(given), seed_(seed), centre_{initial(0), {}, {}} {
    centre_.m.assign(centre_.x.size(), 0.0);
    centre_.v.assign(centre_.x.size(), 0.0);
  }

  void ask(Values& candidates, std::vector<std::uint64_t>& seeds) override {
    const std::size_t n = centre_.x.size(), directions = given_.samplesize;
    Normals numbers(seed_, generation_);
    samples_.resize(directions * n);
    for (double& sample : samples_) sample = numbers.next();
    candidates.resize(2 * directions * n);
    mirror(centre_.x, samples_, given_.noiseStdDev, candidates.data());
    seeds.resize(2 * directions);
    const std::size_t sharing[] = {1, 2, seeds.size()}, alike = sharing[given_.symseed];
    for (std::size_t c = 0; c < seeds.size(); ++c)
      seeds[c] = seed_ + generation_ * (seeds.size() / alike) + c / alike;
  }

  void tell(const Values& fitness) override {
    const unsigned t = static_cast<unsigned>(++generation_);
    climb(centre_, gradient(fitness.data(), fitness.size(), samples_), given_.wdecay,
          adam_step(given_.stepsize, t));
  }

  double average_parameter() const override {
    return sum_of_sizes(centre_.x.data(), centre_.x.size()) / static_cast<double>(centre_.x.size());
  }

 private:
  OpenAIESSettings given_;
  std::uint64_t seed_, generation_ = 0;
  Centre centre_;
  Values samples_;
};

class SSS final : public Strategy {
 public:
  SSS(const SSSSettings& given, const Initial& initial, std::uint64_t seed)
      : given_(given), seed_(seed) {
    for (int i = 0; i < given.popsize; ++i) {
      const Values one = initial(static_cast<std::uint32_t>(i));
      population_.insert(population_.end(), one.begin(), one.end());
    }
  }

  void ask(Values& candidates, std::vector<std::uint64_t>& seeds) override {
    candidates = population_;
    seeds.assign(given_.popsize, seed_ + generation_);
  }

  void tell(const Values& fitness) override {
    const std::size_t n = population_.size() / fitness.size(), half = fitness.size() / 2;
    const auto order = ranking(fitness.data(), fitness.size());
    Normals numbers(seed_, generation_++);
    for (std::size_t i = 0; i < half; ++i) {
      const double* parent = &population_[order[i] * n];
      double* child = &population_[order[half + i] * n];
      for (std::size_t k = 0; k < n; ++k) child[k] = parent[k] + given_.mutrate * numbers.next();
    }
  }

  double average_parameter() const override {
    return sum_of_sizes(population_.data(), population_.size()) /
           static_cast<double>(population_.size());
  }

 private:
  SSSSettings given_;
  std::uint64_t seed_, generation_ = 0;
  Values population_;
};

/// Makes the strategy of a run from its first networks and its seed.
using StrategyMaker = std::function<std::unique_ptr<Strategy>(const Initial&, std::uint64_t)>;

template <class Kind, class Settings>
StrategyMaker maker(const Settings& given) {
  return [given](const Initial& initial, std::uint64_t seed) {
    return std::make_unique<Kind>(given, initial, seed);
  };
}

}  // namespace botschool
