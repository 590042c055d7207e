#include "convolution.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "brain.hpp"

namespace botschool {
namespace {

constexpr std::size_t kMostStages = 16;

std::string size(double height, double width) {
  return std::to_string(int(height)) + " x " + std::to_string(int(width));
}

}  // namespace

Convolutions::Convolutions(const Spec& spec, const Vision& vision) : spec_(spec) {
  const std::size_t count = vision.filters.size();
  if (count == 0 || count != vision.kernels.size() || count != vision.strides.size())
    throw std::invalid_argument(
        "filters, kernels and strides need a number each for every convolutional layer.");
  if (count > kMostStages)
    throw std::invalid_argument("a network has at most 16 convolutional layers.");
  for (int side : {vision.channels, vision.height, vision.width})
    if (side < 1 || side > 100000)
      throw std::invalid_argument("an image has from 1 to 100000 channels, rows and columns.");
  const double values = double(vision.channels) * vision.height * vision.width;
  if (values > 1e6) throw std::invalid_argument("an image has at most a million values.");
  inputs_ = int(values);
  if (spec.normalize || spec.clip) image_.resize(inputs_);
  for (std::size_t i = 0; i < count; ++i)
    add(vision.filters[i], vision.kernels[i], vision.strides[i], vision);
}

void Convolutions::add(int filters, int kernel, int stride, const Vision& vision) {
  for (int value : {filters, kernel, stride})
    if (value < 1 || value > 1000)
      throw std::invalid_argument("filters, kernels and strides are from 1 to 1000.");
  const bool first = stages_.empty();
  Stage s{};
  int height = vision.height, width = vision.width;
  if (first) {
    s.channels = vision.channels;
    s.channel = height * width;
    s.row = width;
    s.column = 1;
  } else {
    const Stage& before = stages_.back();
    height = before.rows;
    width = before.columns;
    s.channels = before.filters.neurons;
    s.channel = 1;
    s.row = width * before.padded;
    s.column = before.padded;
  }
  if (kernel > height || kernel > width)
    throw std::invalid_argument("the kernel of convolutional layer " +
                                std::to_string(stages_.size() + 1) + " is " + size(kernel, kernel) +
                                ", but what it reads is " + size(height, width) + " only.");
  s.kernel = kernel;
  s.stride = stride;
  s.rows = (height - kernel) / stride + 1;
  s.columns = (width - kernel) / stride + 1;
  s.padded = (filters + kFilters - 1) / kFilters * kFilters;
  s.first = std::ptrdiff_t(activations_.size());
  const double senders = double(s.channels) * kernel * kernel;
  const double places = double(s.rows) * s.columns;
  if (senders * filters + parameters_ > 1e8 || places * s.padded > 1e7 || places * filters > 1e6)
    throw std::invalid_argument(
        "the network is too large: more than 100 million connections, or a million features.");
  Layer& layer = s.filters;
  layer = {0, filters, spec_.bias ? parameters_ : -1, spec_.afunction, 1, {}};
  parameters_ += spec_.bias ? filters : 0;
  layer.block[0] = {0, int(senders), false, parameters_, int(senders), 0};
  parameters_ += int(senders) * filters;
  features_ = filters * s.rows * s.columns;
  activations_.resize(activations_.size() + std::size_t(places) * s.padded);
  weights_.resize(std::max(weights_.size(), std::size_t(senders + 1) * s.padded));
  stages_.push_back(s);
}

void Convolutions::initialise(Random& random, double* parameters) const {
  std::fill(parameters, parameters + parameters_, 0.0);
  for (const Stage& s : stages_)
    initial_layer(spec_, s.filters, s.filters.neurons * s.kernel * s.kernel, false, random,
                  parameters);
}

const double* Convolutions::read(const double* normalisation, const double* image) {
  if (image_.empty()) return image;
  const double* deviation = normalisation + inputs_;
  for (int i = 0; i < inputs_; ++i) {
    const double x = spec_.normalize ? (image[i] - normalisation[i]) / deviation[i] : image[i];
    image_[i] = spec_.clip ? clamp(x, -5.0, 5.0) : x;
  }
  return image_.data();
}

void Convolutions::step(const double* parameters, const double* normalisation, const double* image,
                        double* features) {
  const double* from = read(normalisation, image);
  for (const Stage& s : stages_) {
    pack(s, parameters);
    double* to = activations_.data() + s.first;
    const double* weights = weights_.data();
    for (int f = 0; f < s.padded; f += kFilters) {
      for (int y = 0; y < s.rows; ++y) {
        const double* row = from + std::ptrdiff_t(y) * s.stride * s.row;
        double* out = to + std::ptrdiff_t(y) * s.columns * s.padded + f;
        const int step = s.stride * s.column;
        int x = 0;
        for (; x + kPixels <= s.columns; x += kPixels)
          sums<kPixels>(s, weights, row + x * step, out + x * s.padded);
        for (; x < s.columns; ++x) sums<1>(s, weights, row + x * step, out + x * s.padded);
      }
      weights += std::ptrdiff_t(kFilters) * (s.filters.block[0].senders + 1);
    }
    Brain<double, 1>::activate(s.filters.activation, to, s.rows * s.columns * s.padded);
    from = to;
  }
  const Stage& last = stages_.back();
  for (int f = 0; f < last.filters.neurons; ++f)
    for (int i = 0; i < last.rows * last.columns; ++i)
      *features++ = from[std::ptrdiff_t(i) * last.padded + f];
}

/// For each group of filters: their biases, then their weights from each sender.
void Convolutions::pack(const Stage& s, const double* parameters) {
  const Layer& layer = s.filters;
  const int senders = layer.block[0].senders;
  double* to = weights_.data();
  for (int first = 0; first < s.padded; first += kFilters)
    for (int i = -1; i < senders; ++i)
      for (int f = first; f < first + kFilters; ++f, ++to) {
        *to = 0;
        if (f >= layer.neurons) continue;
        if (i >= 0)
          *to = parameters[layer.block[0].weights + std::ptrdiff_t(f) * senders + i];
        else if (layer.bias >= 0)
          *to = parameters[layer.bias + f];
      }
}

/// Net inputs of a group of filters at some pixels. Each sum runs over the channels, and in each over
/// the kernel's rows.
template <int pixels>
void Convolutions::sums(const Stage& s, const double* weights, const double* from,
                        double* to) const {
  using Group = LanesOf<double, kFilters>;
  Group total[pixels] = {};
  for (Group& sum : total) sum += *reinterpret_cast<const Group*>(weights);
  const std::ptrdiff_t step = std::ptrdiff_t(s.stride) * s.column;
  for (int channel = 0; channel < s.channels; ++channel)
    for (int row = 0; row < s.kernel; ++row) {
      const double* pixel =
          from + std::ptrdiff_t(channel) * s.channel + std::ptrdiff_t(row) * s.row;
      for (int column = 0; column < s.kernel; ++column, pixel += s.column) {
        weights += kFilters;
        const Group weight = *reinterpret_cast<const Group*>(weights);
        for (int p = 0; p < pixels; ++p) total[p] += pixel[p * step] * weight;
      }
    }
  for (int p = 0; p < pixels; ++p) *reinterpret_cast<Group*>(to + p * s.padded) = total[p];
}

}  // namespace botschool
