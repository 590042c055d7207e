// Policy gradients in a page: the tested twin of botschool/rl/native/training.py, and a trained agent that
// acts step by step.
#pragma once

#include <limits>

#include "../evolution/run.hpp"
#include "../policy_gradient/training.hpp"

namespace botschool {

/// A number that may fall to 0 along the training.
struct Schedule {
  double value;
  bool falls;
  double at(double progress) const { return falls ? value * (1.0 - progress) : value; }
};

struct Curriculum {
  policy_gradient::Hyperparameters h;
  Schedule learning_rate, clip_range, clip_range_vf;
  std::int64_t steps;  ///< of all environments
  int evaluations, episodes, limit;
};

/// The networks of an agent, and with `normalize` the means and variances of observations.
inline policy_gradient::Agent agent_of(const Info& info,
                                       const policy_gradient::Hyperparameters& h) {
  return policy_gradient::make_agent(info.observations, info.outputs, info.discrete, h);
}

/// A training: at first a post-evaluation, then each advance() is an update. A row for each
/// post-evaluation; bestg is the best model and best the last one.
class Lesson final : public Run {
 public:
  Lesson(const Kernel& kernel, const Curriculum& given)
      : given_(given),
        training_(kernel, policy_gradient::kernels_baseline(), given.limit, given.h),
        every_(std::max<std::int64_t>(1, given.steps / std::max(1, given.evaluations))) {}

  void advance() override {
    if (rows.empty()) return evaluate();
    training_.collect();
    steps = static_cast<std::int64_t>(training_.experience.steps) * given_.h.n_envs;
    const double progress = std::min(1.0, static_cast<double>(steps) / given_.steps);
    const auto found =
        training_.update(given_.learning_rate.at(progress), given_.clip_range.at(progress),
                         given_.clip_range_vf.at(progress));
    broken = !found.finite;
    if (steps / every_ > evaluated_ / every_ || steps >= given_.steps) evaluate();
    best = saved();
  }

 private:
  void evaluate() {
    const std::size_t n = given_.episodes;
    const std::vector<std::uint64_t> seeds(n, given_.h.seed + 100000);
    std::vector<std::uint32_t> episodes(n);
    std::iota(episodes.begin(), episodes.end(), 0);
    Values returns(n);
    std::vector<std::int32_t> lengths(n);
    training_.experience.play(training_.learner.parameters.data(), given_.episodes, seeds.data(),
                              episodes.data(), returns.data(), lengths.data());
    const double mean = sum_in_pairs(returns.data(), n, [](double x) { return x; }) / n;
    evaluated_ = steps;
    best = saved();
    if (mean >= best_fitness) best_fitness = bestg_fitness = mean, bestg = best;
    double total = 0;  // of the episodes that ended in the last rollout
    for (const auto& episode : training_.experience.episodes) total += episode.total;
    const std::size_t ended = training_.experience.episodes.size();
    const double trained = ended ? total / ended : mean;
    const double parameter = sum_of_sizes(best.data(), best.size()) / best.size();
    for (const double value :
         {static_cast<double>(steps), best_fitness, bestg_fitness, mean, trained, parameter})
      rows.push_back(value);
  }

  Values saved() const {
    Values all(training_.learner.parameters.begin(), training_.learner.parameters.end());
    if (given_.h.normalize) {
      for (const auto& each : training_.experience.seen) all.push_back(each.mean);
      for (const auto& each : training_.experience.seen) all.push_back(each.variance);
    }
    return all;
  }

  Curriculum given_;
  policy_gradient::Training training_;
  std::int64_t every_, evaluated_ = 0;
};

/// An agent's networks, and how it acts with the most probable actions.
class Acting {
 public:
  Acting(const Info& info, const policy_gradient::Hyperparameters& h)
      : info_(info),
        agent_(agent_of(info, h)),
        workspace_(agent_),
        normalize_(h.normalize),
        parameters_(agent_.size),
        seen_(info.observations),
        outputs_(agent_.outputs()) {}

  int parameters() const { return agent_.size; }
  /// Inputs, hidden neurons of the policy, outputs.
  int neurons() const {
    int count = agent_.inputs();
    each_layer(
        [&](const policy_gradient::Net& net, int l, int, int) { count += net.width[l + 1]; });
    return count;
  }

  /// normalisation: means and variances of observations.
  void act(const Values& parameters, const Values& normalisation, const Values& observation,
           Values& action, Values& activation) {
    const int inputs = agent_.inputs();
    std::copy(parameters.begin(), parameters.end(), parameters_.begin());
    for (int i = 0; i < inputs; ++i) {
      float x = static_cast<float>(observation[i]);
      if (normalize_) {
        const auto scale = static_cast<float>(1 / std::sqrt(normalisation[inputs + i] + 1e-8));
        x = (x - static_cast<float>(normalisation[i])) * scale;
        x = std::min(std::max(x, -policy_gradient::kMostDeviations),
                     policy_gradient::kMostDeviations);
      }
      activation[i] = seen_[i] = x;
    }
    float value;
    policy_gradient::Scratch& s = workspace_.scratch;
    policy_gradient::kernels_baseline().forward(agent_, parameters_.data(), seen_.data(), 1, s,
                                                outputs_.data(), &value);
    each_layer([&](const policy_gradient::Net& net, int l, int first, int) {
      const float* out = (&net == &agent_.body ? s.body : s.actor)[l];
      for (int i = 0; i < net.width[l + 1]; ++i)
        activation[first + i] = out[i * policy_gradient::kChunk];
    });
    action.clear();
    if (info_.discrete)
      action.push_back(std::max_element(outputs_.begin(), outputs_.end()) - outputs_.begin());
    else
      for (const float output : outputs_)
        action.push_back(std::min(std::max(output, static_cast<float>(info_.low)),
                                  static_cast<float>(info_.high)));
  }

  /// Marks the weights from a neuron and to it, and its bias.
  void mark(int neuron, double* mask) const {
    each_layer([&](const policy_gradient::Net& net, int l, int first, int before) {
      const int columns = net.width[l];
      for (int row = 0; row < net.width[l + 1]; ++row) {
        const bool own = first + row == neuron;
        if (own) mask[net.biases[l] + row] = 1;
        for (int c = 0; c < columns; ++c)
          if (own || before + c == neuron) mask[net.weights[l] + row * columns + c] = 1;
      }
    });
  }

 private:
  /// Calls f(net, layer, its first neuron, the first neuron before it) for each layer of the policy.
  template <class F>
  void each_layer(const F& f) const {
    int before = 0, first = agent_.inputs();
    for (const policy_gradient::Net* net : {&agent_.body, &agent_.actor})
      for (int l = 0; l < net->layers; ++l) {
        f(*net, l, first, before);
        before = first;
        first += net->width[l + 1];
      }
  }

  Info info_;
  policy_gradient::Agent agent_;
  policy_gradient::Workspace workspace_;
  bool normalize_;
  std::vector<float> parameters_, seen_, outputs_;
};

}  // namespace botschool
