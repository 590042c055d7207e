#include "evonet.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace botschool {

void Moments::reset() {
  count = 0.01;
  sum.assign(inputs_, 0.0);
  sumsq.assign(inputs_, 0.01);
}

void Moments::add(double n, const double* sums, const double* squares) {
  count += n;
  for (int i = 0; i < inputs_; ++i) {
    sum[i] += sums[i];
    sumsq[i] += squares[i];
  }
}

void Moments::add(const double* observation) {
  count += 1;
  for (int i = 0; i < inputs_; ++i) {
    sum[i] += observation[i];
    sumsq[i] += observation[i] * observation[i];
  }
}

void Moments::vectors(double* out) const {
  for (int i = 0; i < inputs_; ++i) {
    const double mean = sum[i] / count;
    out[i] = mean;
    out[inputs_ + i] = std::sqrt(std::max(sumsq[i] / count - mean * mean, 0.01));
  }
}

namespace {

std::optional<Convolutions> convolutions_of(const Spec& spec, const Vision& vision) {
  if (spec.architecture != convolutional) return {};
  if (vision.channels == 0) make_layout(spec);  // refuses it
  return Convolutions(spec, vision);
}

/// The network that reads the inputs, or the features of convolutional layers.
Layout layout_of(Spec spec, const std::optional<Convolutions>& convolutions) {
  if (convolutions) {
    spec.architecture = feedforward;
    spec.inputs = convolutions->features();
    spec.normalize = spec.clip = 0;
  }
  return make_layout(spec);
}

}  // namespace

Evonet::Evonet(const Spec& spec, int networks, bool heterogeneous, const Vision& vision)
    : moments(0),
      convolutions_(convolutions_of(spec, vision)),
      layout_(layout_of(spec, convolutions_)),
      networks_(networks),
      heterogeneous_(heterogeneous) {
  if (networks < 1 || networks > 1000)
    throw std::invalid_argument("the number of networks must be from 1 to 1000.");
  const int inputs = own_inputs();
  moments = Moments(inputs);
  normalisation.assign(2 * inputs, 0.0);
  std::fill(normalisation.begin() + inputs, normalisation.end(), 1.0);
  const std::size_t size = BrainMemory<double, 1>::size(layout_);
  buffer_.assign(size * networks, 0.0);
  memory_.resize(networks);
  for (int n = 0; n < networks; ++n) memory_[n].carve(layout_, buffer_.data() + n * size);
}

void Evonet::seed(std::uint64_t seed, std::uint32_t episode) {
  seed_ = seed;
  episode_ = episode;
  steps_ = 0;
}

void Evonet::initialise(double* parameters) const {
  for (int n = 0; n < (heterogeneous_ ? networks_ : 1); ++n, parameters += own_parameters()) {
    Random random(seed_, episode_ * networks_ + n, Stream::weights);
    if (convolutions_) convolutions_->initialise(random, parameters);
    initial_parameters(layout_, random,
                       parameters + (convolutions_ ? convolutions_->parameters() : 0));
  }
}

void Evonet::reset() {
  for (auto& memory : memory_) Brain<double, 1>(layout_, memory).clear(0);
}

void Evonet::step(const double* parameters, const double* inputs, double* actions,
                  double* activations) {
  for (int n = 0; n < networks_; ++n) {
    const auto& memory = memory_[n];
    const double* raw = inputs + n * own_inputs();
    const double* genotype = parameters + (heterogeneous_ ? n * own_parameters() : 0);
    if (collecting) moments.add(raw);
    Brain<double, 1> brain(layout_, memory);
    if (convolutions_) {
      convolutions_->step(genotype, normalisation.data(), raw, memory.inputs);
      brain.load(0, genotype + convolutions_->parameters(), nullptr);
    } else {
      std::copy(raw, raw + layout_.spec.inputs, memory.inputs);
      brain.load(0, genotype, normalisation.data());
    }
    const NoiseKey key = robot_key({seed_, episode_}, n);
    brain.step(&key, &steps_);
    std::copy(memory.actions, memory.actions + layout_.spec.outputs,
              actions + n * layout_.spec.outputs);
    std::copy(memory.activations, memory.activations + layout_.neurons,
              activations + n * layout_.neurons);
  }
  ++steps_;
}

}  // namespace botschool
