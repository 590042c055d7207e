// Convolutional layers in front of a feed-forward network: an image becomes features. In double
// precision, step by step. Rules: docs/specification.md, "Convolutional networks".
#pragma once

#include <vector>

#include "layout.hpp"

namespace botschool {

/// An image, whose values come channel by channel, row by row, and the layers that read it one after
/// another; without layers, nothing.
struct Vision {
  int channels = 0, height = 0, width = 0;
  std::vector<int> filters, kernels, strides;  ///< of each layer; kernels are squares
};

class Convolutions {
 public:
  /// spec: bias, afunction, winit and wrange hold for these layers, too. Throws
  /// std::invalid_argument with a sentence when the layers make no sense.
  Convolutions(const Spec& spec, const Vision& vision);

  int inputs() const { return inputs_; }
  int features() const { return features_; }
  int parameters() const { return parameters_; }
  void initialise(Random& random, double* parameters) const;
  /// From `inputs` values to `features`, which come filter by filter, row by row. `normalisation`:
  /// all means, then all standard deviations, for normalize = 1.
  void step(const double* parameters, const double* normalisation, const double* image,
            double* features);

 private:
  /// Sums of as many filters run side by side, of as many pixels in a row.
  static constexpr int kFilters = 4;
  static constexpr int kPixels = 4;

  struct Stage {
    Layer filters;  ///< a filter is a receiver of all values under its kernel
    int channels, kernel, stride;
    int rows, columns;         ///< of its output
    int channel, row, column;  ///< distances in its input
    int padded;                ///< filters, in whole groups: the distance of its pixels
    std::ptrdiff_t first;      ///< where it gives its pixels
  };

  void add(int filters, int kernel, int stride, const Vision& vision);
  const double* read(const double* normalisation, const double* image);
  void pack(const Stage& stage, const double* parameters);
  template <int pixels>
  void sums(const Stage& stage, const double* weights, const double* from, double* to) const;

  Spec spec_;
  int inputs_, features_ = 0, parameters_ = 0;
  std::vector<Stage> stages_;
  std::vector<double> image_;        ///< normalised or clipped
  std::vector<double> weights_;      ///< of the stage at work, as sums() reads them
  std::vector<double> activations_;  ///< of all stages, the filters of a pixel side by side
};

}  // namespace botschool
