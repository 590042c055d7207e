// One or several policy networks for stepwise use, in double precision, on buffers that the caller
// owns. Counterpart of the lanes that arena/engine/rollout.hpp evaluates.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "brain.hpp"
#include "convolution.hpp"

namespace botschool {

/// Running statistics of raw observations; docs/specification.md, "Policy network".
class Moments {
 public:
  explicit Moments(int inputs) : inputs_(inputs) { reset(); }
  void reset();
  /// Adds `count` observations given by their sums and sums of squares.
  void add(double count, const double* sums, const double* squares);
  /// Adds one observation.
  void add(const double* observation);
  /// Writes all means, then all standard deviations: 2 * inputs values.
  void vectors(double* means_and_deviations) const;
  int inputs() const { return inputs_; }

  double count;
  std::vector<double> sum, sumsq;

 private:
  int inputs_;
};

class Evonet {
 public:
  /// vision: convolutional layers in front of the network; spec.inputs then does not count.
  Evonet(const Spec& spec, int networks, bool heterogeneous, const Vision& vision = {});

  int networks() const { return networks_; }
  /// Length of the whole genotype, morphology apart.
  int parameters() const { return own_parameters() * (heterogeneous_ ? networks_ : 1); }
  int inputs() const { return own_inputs() * networks_; }
  int actions() const { return layout_.spec.outputs * networks_; }
  int neurons() const { return layout_.neurons * networks_; }

  /// Seeds initial weights and action noise; the noise starts anew.
  void seed(std::uint64_t seed, std::uint32_t episode);
  /// Writes initial weights drawn from seed and episode into `parameters`.
  void initialise(double* parameters) const;
  /// Start of an episode; the action noise goes on.
  void reset();
  /// The networks' memory between steps, to restore it.
  const std::vector<double>& memory() const { return buffer_; }
  void set_memory(const std::vector<double>& memory) { buffer_ = memory; }
  /// One update of every network: reads `parameters` and `inputs`, writes `actions` and
  /// `activations`, which begin with the features where there are convolutional layers.
  void step(const double* parameters, const double* inputs, double* actions, double* activations);

  bool collecting = false;  ///< whether step() adds what it sees to `moments`
  Moments moments;
  std::vector<double> normalisation;  ///< in use: all means, then all standard deviations

 private:
  int own_parameters() const {
    return (convolutions_ ? convolutions_->parameters() : 0) + layout_.parameters;
  }
  int own_inputs() const { return convolutions_ ? convolutions_->inputs() : layout_.spec.inputs; }

  std::optional<Convolutions> convolutions_;
  Layout layout_;
  int networks_;
  bool heterogeneous_;
  std::uint64_t seed_ = 1;
  std::uint32_t episode_ = 0;
  int steps_ = 0;
  std::vector<double> buffer_;
  std::vector<BrainMemory<double, 1>> memory_;
};

}  // namespace botschool
