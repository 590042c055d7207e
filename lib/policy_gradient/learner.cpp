#include "learner.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include "../evonet/philox.hpp"

namespace botschool::policy_gradient {
namespace {

/// The mean of some rows of a column, and 1 / (deviation + 1e-8).
void standardise(const float* column, const int* rows, int n, Batch& batch) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) sum += column[rows[i]];
  const double mean = sum / n;
  for (int i = 0; i < n; ++i) squares += (column[rows[i]] - mean) * (column[rows[i]] - mean);
  batch.mean = static_cast<float>(mean);
  batch.scale = static_cast<float>(1 / (std::sqrt(squares / (n - 1)) + 1e-8));
}

double variance(int n, const float* a, const float* b) {
  double sum = 0, squares = 0;
  const auto value = [&](int i) { return static_cast<double>(a[i]) - (b ? b[i] : 0.0f); };
  for (int i = 0; i < n; ++i) sum += value(i);
  for (int i = 0; i < n; ++i) squares += (value(i) - sum / n) * (value(i) - sum / n);
  return squares / n;
}

void add(Indicators& a, const Indicators& b, double weight = 1) {
  a.policy_loss += weight * b.policy_loss;
  a.value_loss += weight * b.value_loss;
  a.entropy += weight * b.entropy;
  a.approx_kl += weight * b.approx_kl;
  a.clip_fraction += weight * b.clip_fraction;
}

Indicators times(const Indicators& a, double factor) {
  Indicators result;
  add(result, a, factor);
  return result;
}

}  // namespace

void advantages_of(const Rollout& r, double gamma, double gae_lambda, float* advantages,
                   float* returns) {
  const float discount = static_cast<float>(gamma);
  const float decay = static_cast<float>(gamma * gae_lambda);
  for (int t = r.n_steps - 1; t >= 0; --t)
    for (int e = 0; e < r.n_envs; ++e) {
      const std::size_t at = std::size_t(t) * r.n_envs + e;
      const bool last = t == r.n_steps - 1;
      const float goes_on = r.ended[at] == 0 ? 1.0f : 0.0f;
      const float next_value = last ? r.last_values[e] : r.values[at + r.n_envs];
      const float following = last ? 0.0f : advantages[at + r.n_envs];
      const float delta = r.rewards[at] + discount * goes_on * next_value - r.values[at];
      advantages[at] = delta + decay * goes_on * following;
      returns[at] = advantages[at] + r.values[at];
    }
}

Learner::Learner(const Kernels& kernels, const Hyperparameters& h, const Agent& agent, Crew& crew)
    : agent(agent), kernels_(kernels), h_(h), crew_(crew) {
  for (int t = 0; t < crew.threads(); ++t)
    workspaces_.push_back(std::make_unique<Workspace>(agent));
  parameters.resize(agent.size);
  first.resize(agent.size);
  second.resize(agent.size);
  initialise(agent, h, parameters.data());
}

Indicators Learner::loss(Batch batch, const int* rows, int n, double clip_range,
                         double clip_range_vf, float* log_probs, float* values) {
  batch.size = n;
  batch.clip = static_cast<float>(clip_range);
  batch.clip_vf = static_cast<float>(clip_range_vf);
  batch.ent = static_cast<float>(h_.ent_coef);
  batch.vf = static_cast<float>(h_.vf_coef);
  if (h_.normalize_advantage && n > 1) standardise(batch.advantages, rows, n, batch);
  const int chunks = (n + kChunk - 1) / kChunk;
  const std::size_t stride = (std::size_t(agent.size) + 15) / 16 * 16;
  if (parts_.size() < chunks * stride) parts_.resize(chunks * stride);
  found_.resize(chunks);
  const auto part = [&](int chunk) { return parts_.data() + chunk * stride; };
  // Parts are added pairwise, in the same order for any number of threads: a group's parts by the
  // thread whose cache has them, then the groups' sums.
  int group = 1;
  while (2 * group * crew_.threads() <= chunks) group *= 2;
  const auto add_pairs = [&](int from, int to, int apart) {
    for (; apart < to - from; apart *= 2)
      for (int c = from; c + apart < to; c += 2 * apart) {
        kernels_.add(part(c), part(c + apart), agent.size);
        add(found_[c], found_[c + apart]);
      }
  };
  crew_.run((chunks + group - 1) / group, [&](int g, int thread) {
    const int first = g * group, last = std::min(first + group, chunks);
    for (int c = first; c < last; ++c) {
      const int from = c * kChunk;
      kernels_.gradient(agent, parameters.data(), batch, rows + from, std::min(kChunk, n - from),
                        workspaces_[thread]->scratch, part(c), found_[c],
                        log_probs ? log_probs + from : nullptr, values ? values + from : nullptr);
    }
    add_pairs(first, last, 1);
  });
  add_pairs(0, chunks, group);
  return times(found_[0], 1.0 / n);
}

bool Learner::step(const float* gradient, double learning_rate) {
  const double norm = std::sqrt(kernels_.squares(gradient, agent.size));
  if (!std::isfinite(norm)) return false;
  beta1_power *= static_cast<double>(kBeta1);
  beta2_power *= static_cast<double>(kBeta2);
  AdamStep step;
  if (h_.max_grad_norm > 0)
    step.shorter = static_cast<float>(std::min(1.0, h_.max_grad_norm / (norm + 1e-6)));
  step.rate = static_cast<float>(learning_rate / (1 - beta1_power));
  step.root = static_cast<float>(1 / std::sqrt(1 - beta2_power));
  kernels_.adam(step, gradient, first.data(), second.data(), parameters.data(), agent.size);
  return true;
}

/// A random order of n samples (Fisher and Yates 1938).
void Learner::shuffle(int epoch, int* order, int n) const {
  std::iota(order, order + n, 0);
  for (std::uint32_t i = static_cast<std::uint32_t>(n) - 1; i > 0; --i) {
    const Block block = philox(h_.seed + (updates >> 32 << 32), static_cast<std::uint32_t>(updates),
                               Stream::shuffle, static_cast<std::uint32_t>(epoch), i);
    std::swap(order[i], order[std::uint64_t(block.word[0]) * (i + 1) >> 32]);
  }
}

Update Learner::update(const Batch& samples, int n, double learning_rate, double clip_range,
                       double clip_range_vf) {
  Update result;
  result.learning_rate = learning_rate;
  result.clip_range = clip_range;
  const int ahead = std::min(crew_.threads(), h_.n_epochs);  // orders drawn side by side
  orders_.resize(std::size_t(ahead) * n);
  Indicators sum;
  bool stopped = false;
  for (int epoch = 0; epoch < h_.n_epochs && !stopped && result.finite; ++epoch) {
    int* order = &orders_[std::size_t(epoch % ahead) * n];
    if (epoch % ahead == 0)
      crew_.run(ahead, [&](int i, int) { shuffle(epoch + i, order + std::size_t(i) * n, n); });
    for (int from = 0; from < n && !stopped && result.finite; from += h_.batch_size) {
      const int size = std::min(h_.batch_size, n - from);
      const Indicators found =
          loss(samples, order + from, size, clip_range, clip_range_vf, nullptr, nullptr);
      add(sum, found);
      result.loss = found.policy_loss + h_.vf_coef * found.value_loss - h_.ent_coef * found.entropy;
      ++result.minibatches;
      stopped = h_.target_kl > 0 && found.approx_kl > 1.5 * h_.target_kl;
      if (!stopped) result.finite = step(gradient(), learning_rate);
    }
  }
  ++updates;
  result.means = times(sum, 1.0 / std::max(1, result.minibatches));
  const double spread = variance(n, samples.returns, nullptr);
  const double left = variance(n, samples.returns, samples.values);
  result.explained_variance = spread > 0 ? 1 - left / spread : std::nan("");
  return result;
}

}  // namespace botschool::policy_gradient
