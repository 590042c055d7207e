// The loop of an evolutionary run in a page: the tested twin of botschool/evolution/run.py, evaluate.py
// and record.py.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "arena/engine/kernel.hpp"
#include "evonet/evonet.hpp"
#include "strategies.hpp"

namespace botschool {

using Play = std::function<void(const Jobs&)>;

/// What a run has reached, as its files say.
class Run {
 public:
  static constexpr int kColumns = 6;
  std::vector<double> rows;  ///< kColumns numbers a generation, as in the stat file
  std::int64_t steps = 0;
  double best_fitness = -std::numeric_limits<double>::infinity(), bestg_fitness = best_fitness;
  Values best, bestg;  ///< as they are saved: a genotype, and its normalisation where there is one
  Values individuals, meetings;  ///< of two sides: both populations, and their fitness
  int part = 0;                  ///< of the present generation, how many parts are done

  bool broken = false;  ///< of a training: whether its numbers are no longer finite

  virtual ~Run() = default;
  /// A generation, or the next part of it.
  virtual void advance() = 0;
};

/// A run of a population with one fitness each.
class Evolution final : public Run {
 public:
  Evolution(const Info& info, const Layout& layout, const Evaluation& evaluation,
            const StrategyMaker& strategy, std::uint64_t seed, Play play)
      : info_(info),
        layout_(layout),
        evaluation_(evaluation),
        seed_(seed),
        play_(std::move(play)),
        moments_(layout.spec.inputs) {
    strategy_ = strategy([&](std::uint32_t index) { return genotype(index); }, seed);
    if (layout.spec.normalize) {
      normalisation_.assign(2 * layout.spec.inputs, 0.0);
      std::fill(normalisation_.begin() + layout.spec.inputs, normalisation_.end(), 1.0);
    }
  }

  void advance() override {
    Values candidates;
    std::vector<std::uint64_t> seeds;
    strategy_->ask(candidates, seeds);
    const std::size_t count = seeds.size(), size = candidates.size() / count;
    const int episodes = evaluation_.episodes;
    Batch batch;
    for (std::size_t c = 0; c < count; ++c)
      for (int e = 0; e < episodes; ++e) batch.add(static_cast<std::int32_t>(c), seeds[c], e);
    evaluate(candidates, size, batch, evaluation_.limit);
    Values fitness(count);
    for (std::size_t c = 0; c < count; ++c)
      fitness[c] = episodes == 1 ? batch.fitness[c] + 0.0
                                 : exact_mean(&batch.fitness[c * episodes], episodes);
    owed_ += 0.01 * static_cast<double>(batch.fitness.size());

    const std::size_t first = std::max_element(fitness.begin(), fitness.end()) - fitness.begin();
    const Values chosen(&candidates[first * size], &candidates[first * size] + size);
    Values saved = chosen;
    saved.insert(saved.end(), normalisation_.begin(), normalisation_.end());
    const Batch post = post_evaluate(chosen);
    strategy_->tell(fitness);
    refresh(post);

    steps += batch.taken() + post.taken();
    const double reached = exact_mean(post.fitness.data(), post.fitness.size());
    if (fitness[first] > best_fitness) best = saved, best_fitness = fitness[first];
    if (reached > bestg_fitness) bestg = saved, bestg_fitness = reached;
    for (const double value :
         {static_cast<double>(steps), best_fitness, bestg_fitness, fitness[first],
          exact_mean(fitness.data(), count), strategy_->average_parameter()})
      rows.push_back(value);
  }

 private:
  struct Batch {
    std::vector<std::int32_t> candidate, steps;
    std::vector<std::uint64_t> seed;
    std::vector<std::uint32_t> episode;
    std::vector<std::uint8_t> collect;
    Values fitness, moments;
    void add(std::int32_t c, std::uint64_t s, int e) {
      candidate.push_back(c);
      seed.push_back(s);
      episode.push_back(static_cast<std::uint32_t>(e));
    }
    std::int64_t taken() const {
      return std::accumulate(steps.begin(), steps.end(), std::int64_t{0});
    }
  };

  int networks() const { return evaluation_.heterogeneous ? info_.robots : 1; }

  Values genotype(std::uint32_t index) const {
    Values made(networks() * layout_.parameters + info_.body, 0.0);
    for (int n = 0; n < networks(); ++n)
      initial_parameters(layout_, seed_, index * networks() + n, &made[n * layout_.parameters]);
    return made;
  }

  void evaluate(const Values& genotypes, std::size_t size, Batch& batch, int limit) const {
    const std::size_t count = batch.seed.size();
    std::vector<std::int32_t> candidate;
    for (int r = 0; r < info_.robots; ++r)
      candidate.insert(candidate.end(), batch.candidate.begin(), batch.candidate.end());
    batch.fitness.assign(count, 0.0);
    batch.steps.assign(count, 0);
    if (!batch.collect.empty()) batch.moments.assign(count * 2 * layout_.spec.inputs, 0.0);
    const std::size_t offset = evaluation_.heterogeneous ? layout_.parameters : 0;
    play_({genotypes.data(),
           size,
           normalisation_.empty() ? nullptr : normalisation_.data(),
           count,
           candidate.data(),
           offset,
           batch.seed.data(),
           batch.episode.data(),
           batch.collect.empty() ? nullptr : batch.collect.data(),
           {limit, nullptr},
           batch.fitness.data(),
           batch.steps.data(),
           batch.moments.data()});
    if (evaluation_.alive != 0)
      for (std::size_t i = 0; i < count; ++i)
        batch.fitness[i] += evaluation_.alive * (batch.steps[i] - (batch.steps[i] < limit));
  }

  /// Return of a genotype in fixed episodes; the first of them collect data for the normalisation,
  /// as long as that was done in less than 1 % of the episodes.
  Batch post_evaluate(const Values& genotype) {
    Batch post;
    for (int e = 0; e < evaluation_.pepisodes; ++e) post.add(0, seed_ + 100000, e);
    if (!normalisation_.empty()) {
      collected_ = std::min(static_cast<int>(std::ceil(owed_ - 1e-9)), evaluation_.pepisodes);
      owed_ -= collected_;
      for (int e = 0; e < evaluation_.pepisodes; ++e) post.collect.push_back(e < collected_);
    }
    evaluate(genotype, genotype.size(), post, evaluation_.post_limit);
    return post;
  }

  void refresh(const Batch& post) {
    if (normalisation_.empty()) return;
    const int inputs = layout_.spec.inputs;
    for (int e = 0; e < collected_; ++e) {
      const double* sums = &post.moments[e * 2 * inputs];
      moments_.add(static_cast<double>(info_.robots) * post.steps[e], sums, sums + inputs);
    }
    moments_.vectors(normalisation_.data());
  }

  Info info_;
  Layout layout_;
  Evaluation evaluation_;
  std::uint64_t seed_;
  Play play_;
  Moments moments_;
  std::unique_ptr<Strategy> strategy_;
  Values normalisation_;
  double owed_ = 0.0;
  int collected_ = 0;
};

}  // namespace botschool
