// What a policy network looks like (Spec), and where each of its parameters is in the genotype
// (Layout). Rules: docs/specification.md, "Policy network".
#pragma once

#include <cstdint>

#include "hyperparameters.hpp"
#include "philox.hpp"

namespace botschool {

enum Architecture {
  feedforward = 0,
  recurrent = 1,
  fully_recurrent = 2,
  lstm = 3,
  convolutional = 4
};
enum Activation {
  logistic_unit = 1,
  tanh_unit = 2,
  linear_unit = 3,
  binary_unit = 4,
  relu_unit = 5
};
enum ActionNoise { no_noise = 0, gaussian_noise = 1, diagonal_gaussian_noise = 2 };
enum InitialWeights { xavier = 0, norm_incoming = 1, uniform_weights = 2 };

/// What a policy network looks like.
struct Spec {
  int inputs = 1;
  int outputs = 1;                ///< actuators: outputs before binning
  double low = -1.0, high = 1.0;  ///< range of a binned action
#define BOTSCHOOL_MEMBER(type, name, value, least, greatest, explanation, choices) \
  type name = value;
  BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_MEMBER)
#undef BOTSCHOOL_MEMBER
};

constexpr int kMaxLayers = 16;

/// Connections into a layer: a receiver's weights are a row of `stride` values, the rows begin at
/// `weights`, and the weight from sender s to receiver r is at weights + r * stride + offset + s.
struct Connections {
  int sender, senders;
  bool previous;  ///< from the activations of the step before
  int weights, stride, offset;
};

/// Neurons updated together.
struct Layer {
  int first, neurons;
  int bias;  ///< index of the first bias, or -1
  int activation;
  int blocks;
  Connections block[2];
};

/// A checked Spec with the place of everything. Plain data.
struct Layout {
  Spec spec;
  int hiddens;     ///< hidden neurons in all
  int outputs;     ///< output neurons: outputs, or outputs * nbins
  int neurons;     ///< inputs + hiddens + outputs
  int parameters;  ///< genotype length of one network, morphology apart
  int deviations;  ///< index of the log standard deviations of the action noise, or -1
  bool recurrent;  ///< needs the activations of the step before
  int cells;       ///< LSTM units; 0 for other architectures
  Layer gates;     ///< the four gates of each LSTM unit, one row each
  int layers;
  Layer layer[kMaxLayers + 1];
};

/// Throws std::invalid_argument with a sentence when the spec makes no sense. What reads the features
/// of convolutional layers is feed-forward (convolution.hpp).
Layout make_layout(const Spec& spec);

/// Fills `parameters` (layout.parameters values) with the initial weights of spec.winit; biases and
/// log standard deviations are 0. Each (seed, index) gives another draw.
void initial_parameters(const Layout& layout, std::uint64_t seed, std::uint32_t index,
                        double* parameters);
/// The same, with draws that go on.
void initial_parameters(const Layout& layout, Random& random, double* parameters);
/// Draws the weights into a layer's neurons.
void initial_layer(const Spec& spec, const Layer& layer, int fan_out, bool output, Random& random,
                   double* parameters);

}  // namespace botschool
