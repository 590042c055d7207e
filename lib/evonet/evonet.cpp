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

Evonet::Evonet(const Spec& spec, int networks, bool heterogeneous)
    : moments(make_layout(spec).spec.inputs),  // checked before anything is allocated
      layout_(make_layout(spec)),
      networks_(networks),
      heterogeneous_(heterogeneous) {
  if (networks < 1 || networks > 1000)
    throw std::invalid_argument("the number of networks must be from 1 to 1000.");
  normalisation.assign(2 * spec.inputs, 0.0);
  std::fill(normalisation.begin() + spec.inputs, normalisation.end(), 1.0);
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
  for (int n = 0; n < (heterogeneous_ ? networks_ : 1); ++n)
    initial_parameters(layout_, seed_, episode_ * networks_ + n,
                       parameters + n * layout_.parameters);
}

void Evonet::reset() {
  for (auto& memory : memory_) Brain<double, 1>(layout_, memory).clear(0);
}

void Evonet::step(const double* parameters, const double* inputs, double* actions,
                  double* activations) {
  for (int n = 0; n < networks_; ++n) {
    const auto& memory = memory_[n];
    const double* raw = inputs + n * layout_.spec.inputs;
    if (collecting) moments.add(raw);
    Brain<double, 1> brain(layout_, memory);
    brain.load(0, parameters + (heterogeneous_ ? n * layout_.parameters : 0), normalisation.data());
    std::copy(raw, raw + layout_.spec.inputs, memory.inputs);
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
