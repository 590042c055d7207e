// The tested twins of botschool/evolution/algorithms/openaies.py and sss.py, for a page: the same
// numbers, bit by bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

#include "normals.hpp"
#include "sums.hpp"

namespace botschool {

using Values = std::vector<double>;
using Initial = std::function<Values(std::uint32_t)>;

/// The hyperparameters of section [ALGO].
struct Hyperparameters {
  int size;             ///< samplesize of OpenAI-ES, popsize of SSS
  double stepsize;      ///< of OpenAI-ES
  double deviation;     ///< noiseStdDev of OpenAI-ES, mutrate of SSS
  int wdecay = 0;       ///< of OpenAI-ES
  bool symseed = true;  ///< of OpenAI-ES
};

/// A population: ask for candidates, measure them, tell their fitness; and again.
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
  OpenAIES(const Hyperparameters& given, const Initial& initial, std::uint64_t seed)
      : given_(given), seed_(seed), centre_(initial(0)) {
    m_.assign(centre_.size(), 0.0);
    v_.assign(centre_.size(), 0.0);
    const int count = 2 * given.size;
    for (int i = 0; i < count; ++i) utility_.push_back(i * (1.0 / (count - 1)) + -0.5);
    utility_.back() = 0.5;
  }

  void ask(Values& candidates, std::vector<std::uint64_t>& seeds) override {
    const std::size_t n = centre_.size(), directions = given_.size;
    Normals numbers(seed_, generation_);
    samples_.resize(directions * n);
    for (double& sample : samples_) sample = numbers.next();
    candidates.resize(2 * directions * n);
    seeds.resize(2 * directions);
    const std::uint64_t used = given_.symseed ? directions : 2 * directions;
    for (std::size_t s = 0; s < directions; ++s) {
      double *plus = &candidates[2 * s * n], *minus = plus + n;
      for (std::size_t i = 0; i < n; ++i) {
        const double change = given_.deviation * samples_[s * n + i];
        plus[i] = centre_[i] + change;
        minus[i] = centre_[i] - change;
      }
      for (int side = 0; side < 2; ++side)
        seeds[2 * s + side] = seed_ + generation_ * used + (given_.symseed ? s : 2 * s + side);
    }
  }

  void tell(const Values& fitness) override {
    const std::size_t n = centre_.size(), count = fitness.size();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return fitness[a] < fitness[b]; });
    Values utilities(count);
    for (std::size_t i = 0; i < count; ++i) utilities[order[i]] = utility_[i];
    Values rising(n);
    for (std::size_t s = 0; s < count / 2; ++s) {
      const double weight = utilities[2 * s] - utilities[2 * s + 1];
      for (std::size_t i = 0; i < n; ++i) {
        const double part = weight * samples_[s * n + i];
        rising[i] = s == 0 ? part : rising[i] + part;
      }
    }
    constexpr double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8, decay = 0.005;
    const unsigned t = static_cast<unsigned>(++generation_);
    const double step = given_.stepsize * std::sqrt(1 - power(beta2, t)) / (1 - power(beta1, t));
    for (std::size_t i = 0; i < n; ++i) {
      double descent = -(rising[i] / static_cast<double>(count));
      if (given_.wdecay == 1) descent += decay * centre_[i];
      if (given_.wdecay == 2) descent += decay * ((centre_[i] > 0) - (centre_[i] < 0));
      m_[i] = beta1 * m_[i] + (1 - beta1) * descent;
      v_[i] = beta2 * v_[i] + (1 - beta2) * (descent * descent);
      centre_[i] = centre_[i] - step * m_[i] / (std::sqrt(v_[i]) + epsilon);
    }
  }

  double average_parameter() const override {
    return sum_of_sizes(centre_.data(), centre_.size()) / static_cast<double>(centre_.size());
  }

 private:
  Hyperparameters given_;
  std::uint64_t seed_, generation_ = 0;
  Values centre_, m_, v_, samples_, utility_;
};

class SSS final : public Strategy {
 public:
  SSS(const Hyperparameters& given, const Initial& initial, std::uint64_t seed)
      : given_(given), seed_(seed) {
    for (int i = 0; i < given.size; ++i) {
      const Values one = initial(static_cast<std::uint32_t>(i));
      population_.insert(population_.end(), one.begin(), one.end());
    }
  }

  void ask(Values& candidates, std::vector<std::uint64_t>& seeds) override {
    candidates = population_;
    seeds.assign(given_.size, seed_ + generation_);
  }

  void tell(const Values& fitness) override {
    const std::size_t n = population_.size() / fitness.size(), half = fitness.size() / 2;
    std::vector<std::size_t> ranking(fitness.size());
    std::iota(ranking.begin(), ranking.end(), 0);
    std::stable_sort(ranking.begin(), ranking.end(),
                     [&](std::size_t a, std::size_t b) { return fitness[a] > fitness[b]; });
    Normals numbers(seed_, generation_++);
    for (std::size_t i = 0; i < half; ++i) {
      const double* parent = &population_[ranking[i] * n];
      double* child = &population_[ranking[half + i] * n];
      for (std::size_t k = 0; k < n; ++k) child[k] = parent[k] + given_.deviation * numbers.next();
    }
  }

  double average_parameter() const override {
    return sum_of_sizes(population_.data(), population_.size()) /
           static_cast<double>(population_.size());
  }

 private:
  Hyperparameters given_;
  std::uint64_t seed_, generation_ = 0;
  Values population_;
};

}  // namespace botschool
