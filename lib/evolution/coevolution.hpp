// Predators and prey that evolve by turns, for a page: the tested twin of
// botschool/evolution/algorithms/coevo2.py and sides.py, and of botschool/evolution/coevolution.py.
#pragma once

#include "run.hpp"

namespace botschool {

/// A row for each individual, a column for each competitor.
struct Table {
  std::size_t rows = 0, columns = 0;
  Values values;

  Table() = default;
  Table(std::size_t r, std::size_t c) : rows(r), columns(c), values(r * c) {}
  double& at(std::size_t r, std::size_t c) { return values[r * columns + c]; }
  double at(std::size_t r, std::size_t c) const { return values[r * columns + c]; }
  double mean(std::size_t r) const { return exact_mean(&values[r * columns], columns); }
  double mean() const { return exact_mean(values.data(), values.size()); }

  Table turned() const {
    Table t(columns, rows);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) t.at(c, r) = at(r, c);
    return t;
  }
  Table chosen_rows(const std::vector<std::size_t>& which) const {
    Table t(which.size(), columns);
    for (std::size_t r = 0; r < which.size(); ++r)
      std::copy_n(&values[which[r] * columns], columns, &t.values[r * columns]);
    return t;
  }
  /// Rows from the best mean to the worst; of equals, the earlier first.
  std::vector<std::size_t> ranking() const {
    Values means(rows);
    for (std::size_t r = 0; r < rows; ++r) means[r] = mean(r);
    return botschool::ranking(means.data(), rows);
  }
};

class Coevolution final : public Run {
 public:
  static constexpr int kSteps = 20, kParts = kSteps + 1;  ///< meetings of a generation

  Coevolution(const Info& info, const Layout& layout, const Evaluation& evaluation,
              const Coevo2Settings& rules, std::uint64_t seed, Play play)
      : layout_(layout),
        evaluation_(evaluation),
        rules_(rules),
        seed_(seed),
        play_(std::move(play)),
        numbers_(seed, 0) {
    for (std::uint32_t i = 0; i < std::uint32_t(rules.popsize); ++i)
      for (int side = 0; side < 2; ++side) {
        Centre one;
        for (Values* part : {&one.x, &one.m, &one.v}) part->assign(layout.parameters, 0.0);
        initial_parameters(layout, seed, i * info.robots + side, one.x.data());
        side_[side].push_back(one);
      }
  }

  /// First all meet all; then each call is one of a generation's kParts meetings.
  void advance() override {
    const int side = generation_ % 2, other = 1 - side;
    if (fitness_.rows == 0) {
      fitness_ = everyone(side_[0], side_[1]);
      sort();
      return;
    }
    if (part == 0) choose(side, other);
    if (part < kSteps) {
      improve(side);
      ++part;
      return;
    }
    replace(side, everyone_against(side, evolving_, side_[other]));
    ++generation_;
    part = 0;
    end();
  }

 private:
  using Group = std::vector<Centre>;

  static Table of_side(int side, const Table& fitness) { return side ? fitness.turned() : fitness; }

  /// The fitness of a side's rows: for prey 1 minus the predators'.
  static Table seen_by(int side, const Table& fitness) {
    Table seen = of_side(side, fitness);
    if (side)
      for (double& value : seen.values) value = 1 - value;
    return seen;
  }

  /// `count` rows that differ most from each other, beginning with a given one.
  static std::vector<std::size_t> differing(const Table& fitness, std::size_t count,
                                            std::size_t first) {
    std::vector<std::size_t> chosen{first};
    Values apart(fitness.rows, 0.0), differences(fitness.columns);
    while (chosen.size() < count) {
      for (std::size_t r = 0; r < fitness.rows; ++r) {
        for (std::size_t c = 0; c < fitness.columns; ++c)
          differences[c] = std::fabs(fitness.at(r, c) - fitness.at(chosen.back(), c));
        apart[r] += exact_sum(differences.data(), differences.size());
      }
      for (const std::size_t r : chosen) apart[r] = -1;
      chosen.push_back(std::max_element(apart.begin(), apart.end()) - apart.begin());
    }
    return chosen;
  }

  /// Begins a generation: chooses competitors that differ, and individuals to evolve.
  void choose(int side, int other) {
    numbers_ = Normals(seed_, generation_);
    const std::uint32_t first = numbers_.below(rules_.popsize);
    const auto competitors = differing(seen_by(other, fitness_), rules_.selsize, first);
    opponents_.clear();
    for (const std::size_t c : competitors) opponents_.push_back(side_[other][c]);
    const Table before = seen_by(side, fitness_).turned().chosen_rows(competitors).turned();
    const auto order =
        rules_.evolving == 1 ? numbers_.permutation(rules_.popsize) : before.ranking();
    evolving_.clear();
    for (int i = 0; i < rules_.selsize; ++i) evolving_.push_back(side_[side][order[i]]);
  }

  /// Makes a step of the evolving individuals against their opponents.
  void improve(int side) {
    const std::size_t n = layout_.parameters, count = 2 * rules_.samplesize;
    std::vector<Values> samples;
    Group offspring;
    for (const Centre& centre : evolving_) {
      samples.emplace_back(rules_.samplesize * n);
      for (double& sample : samples.back()) sample = numbers_.next();
      Values candidates(count * n);
      mirror(centre.x, samples.back(), rules_.noiseStdDev, candidates.data());
      for (std::size_t c = 0; c < count; ++c)
        offspring.push_back({{&candidates[c * n], &candidates[c * n] + n}, {}, {}});
    }
    const Table met = seen_by(side, everyone_against(side, offspring, opponents_));
    Values means(met.rows);
    for (std::size_t r = 0; r < met.rows; ++r) means[r] = met.mean(r);
    for (std::size_t e = 0; e < evolving_.size(); ++e)
      climb(evolving_[e], gradient(&means[e * count], count, samples[e]), rules_.wdecay,
            rules_.stepsize);
  }

  /// Ranks all, newcomers first so that they win ties, and drops the worst.
  void replace(int side, const Table& met) {
    Table all = of_side(side, met);
    const Table old = of_side(side, fitness_);
    all.values.insert(all.values.end(), old.values.begin(), old.values.end());
    all.rows += old.rows;
    Group group = evolving_;
    group.insert(group.end(), side_[side].begin(), side_[side].end());
    auto kept = (side ? seen_by(1, all.turned()) : all).ranking();
    kept.resize(rules_.popsize);
    fitness_ = of_side(side, all.chosen_rows(kept));
    for (std::size_t i = 0; i < kept.size(); ++i) side_[side][i] = group[kept[i]];
    sort();
  }

  /// Puts the best of both sides first, and keeps the values to save.
  void sort() {
    for (int side = 0; side < 2; ++side) {
      const auto order = seen_by(side, fitness_).ranking();
      fitness_ = of_side(side, of_side(side, fitness_).chosen_rows(order));
      const Group before = side_[side];
      for (std::size_t i = 0; i < order.size(); ++i) side_[side][i] = before[order[i]];
    }
    individuals.clear();
    meetings.clear();
    bestg.clear();
    for (int side = 0; side < 2; ++side) {
      for (const Centre& one : side_[side])
        individuals.insert(individuals.end(), one.x.begin(), one.x.end());
      const Table seen = seen_by(side, fitness_);
      meetings.insert(meetings.end(), seen.values.begin(), seen.values.end());
      bestg.insert(bestg.end(), side_[side][0].x.begin(), side_[side][0].x.end());
    }
  }

  void end() {
    const double reached = fitness_.mean(0);
    best_fitness = bestg_fitness = std::max(best_fitness, reached);
    const double parameter = sum_of_sizes(individuals.data(), individuals.size()) /
                             static_cast<double>(individuals.size());
    for (const double value : {static_cast<double>(steps), best_fitness, bestg_fitness, reached,
                               fitness_.mean(), parameter})
      rows.push_back(value);
  }

  Table everyone_against(int side, const Group& ours, const Group& theirs) {
    return side ? everyone(theirs, ours) : everyone(ours, theirs);
  }

  /// The fitness of every predator against every prey. They meet in bands of four predators, so that
  /// neighbours share networks.
  Table everyone(const Group& predators, const Group& prey) {
    const std::size_t n = layout_.parameters, episodes = evaluation_.episodes;
    const std::size_t count = predators.size() * prey.size() * episodes;
    Values genotypes;
    for (const Group* group : {&predators, &prey})
      for (const Centre& one : *group)
        genotypes.insert(genotypes.end(), one.x.begin(), one.x.end());
    std::vector<std::int32_t> candidate(2 * count), taken(count);
    std::vector<std::uint32_t> episode(count);
    const std::vector<std::uint64_t> seeds(count, seed_);
    std::size_t job = 0;
    for (std::size_t band = 0; band < predators.size(); band += 4)
      for (std::size_t c = 0; c < prey.size(); ++c)
        for (std::size_t r = band; r < std::min(band + 4, predators.size()); ++r)
          for (std::size_t e = 0; e < episodes; ++e, ++job) {
            candidate[job] = static_cast<std::int32_t>(r);
            candidate[count + job] = static_cast<std::int32_t>(predators.size() + c);
            episode[job] = static_cast<std::uint32_t>(e);
          }
    Values paid(count);
    play_({genotypes.data(),
           n,
           nullptr,
           count,
           candidate.data(),
           0,
           seeds.data(),
           episode.data(),
           nullptr,
           {evaluation_.limit, nullptr},
           paid.data(),
           taken.data(),
           nullptr});
    steps += std::accumulate(taken.begin(), taken.end(), std::int64_t{0});
    Table fitness(predators.size(), prey.size());
    for (job = 0; job < count; job += episodes)
      fitness.at(candidate[job], candidate[count + job] - predators.size()) =
          exact_mean(&paid[job], episodes);
    return fitness;
  }

  Layout layout_;
  Evaluation evaluation_;
  Coevo2Settings rules_;
  std::uint64_t seed_, generation_ = 0;
  Play play_;
  Normals numbers_;
  Group side_[2], evolving_, opponents_;
  Table fitness_;  ///< of predators (rows) against prey
};

}  // namespace botschool
