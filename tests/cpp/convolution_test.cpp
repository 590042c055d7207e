// Convolutional layers against a plain loop, bit for bit, in shapes that do not fill groups.
#include "evonet/convolution.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "evonet/evonet.hpp"

using namespace botschool;

namespace {

Spec spec_of(int bias) {
  Spec spec;
  spec.architecture = convolutional;
  spec.outputs = 2;
  spec.nhiddens = 3;
  spec.bias = bias;
  spec.afunction = relu_unit;
  return spec;
}

std::vector<double> numbers(int count, std::uint32_t index) {
  Random random(5, index, Stream::start);
  std::vector<double> values(count);
  for (double& value : values) value = random.gaussian();
  return values;
}

/// The planes of one layer; `parameters` moves on to the next layer's.
std::vector<double> plain(const std::vector<double>& image, int channels, int height, int width,
                          int filters, int kernel, int stride, bool bias,
                          const double*& parameters) {
  const double* biases = parameters;
  const double* weights = parameters + (bias ? filters : 0);
  const int size = channels * kernel * kernel;
  parameters = weights + filters * size;
  std::vector<double> planes;
  for (int f = 0; f < filters; ++f)
    for (int y = 0; y + kernel <= height; y += stride)
      for (int x = 0; x + kernel <= width; x += stride) {
        double sum = bias ? biases[f] : 0;
        for (int i = 0; i < size; ++i) {
          const int c = i / (kernel * kernel), row = i / kernel % kernel, column = i % kernel;
          sum += weights[f * size + i] * image[(c * height + y + row) * width + x + column];
        }
        planes.push_back(sum < 0 ? 0 : sum);
      }
  return planes;
}

}  // namespace

TEST(convolutions_are_those_of_a_plain_loop) {
  for (int bias : {0, 1})
    for (int channels : {1, 3})
      for (int width : {5, 8, 13})
        for (int filters : {1, 4, 6})
          for (int stride : {1, 2, 3}) {
            const Vision vision{channels, 7, width, {filters, 3}, {3, 1}, {stride, 2}};
            Convolutions layers(spec_of(bias), vision);
            const std::vector<double> genotype = numbers(layers.parameters(), 1);
            const std::vector<double> image = numbers(layers.inputs(), 2);
            std::vector<double> features(layers.features());
            layers.step(genotype.data(), nullptr, image.data(), features.data());
            const double* at = genotype.data();
            const auto first = plain(image, channels, 7, width, filters, 3, stride, bias != 0, at);
            const int rows = 4 / stride + 1, columns = (width - 3) / stride + 1;
            CHECK(features == plain(first, filters, rows, columns, 3, 1, 2, bias != 0, at));
            CHECK(at == genotype.data() + genotype.size());
          }
}

TEST(networks_that_read_images_run) {
  const Vision vision{2, 6, 5, {3, 2}, {3, 2}, {1, 2}};
  for (int networks : {1, 3})
    for (bool heterogeneous : {false, true})
      for (int scaled : {0, 1, 2, 3}) {
        Spec spec = spec_of(1);
        spec.normalize = scaled / 2;
        spec.clip = scaled % 2;
        spec.afunction = linear_unit;
        Evonet net(spec, networks, heterogeneous, vision);
        CHECK(net.inputs() == 60 * networks);
        std::vector<double> parameters(net.parameters()), inputs(net.inputs(), 9.0);
        std::vector<double> actions(net.actions()), activations(net.neurons());
        net.seed(7, 1);
        net.initialise(parameters.data());
        net.collecting = true;
        net.reset();
        net.step(parameters.data(), inputs.data(), actions.data(), activations.data());
        for (double x : actions) CHECK(std::isfinite(x));
        const bool alike = activations[0] == activations[net.neurons() / networks * (networks - 1)];
        CHECK(alike == (networks == 1 || !heterogeneous));
      }
}

TEST(images_are_needed) {
  CHECK(refused([] { make_layout(spec_of(0)); }, "architecture is 4"));
  CHECK(refused([] { Evonet net(spec_of(0), 1, false); }, "architecture is 4"));
  CHECK(refused([] { Evonet net(spec_of(0), 1, false, {1, 5, 5, {2}, {6}, {1}}); }, "6 x 6"));
}
