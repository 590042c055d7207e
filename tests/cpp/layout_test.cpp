// Specs that are refused, and that every parameter has exactly one place.
#include "evonet/layout.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "evonet/evonet.hpp"

using namespace botschool;

namespace {

Spec spec_of(int architecture, int nhiddens) {
  Spec spec;
  spec.inputs = 3;
  spec.outputs = 2;
  spec.nhiddens = nhiddens;
  spec.architecture = architecture;
  spec.bias = 1;
  spec.action_noise = diagonal_gaussian_noise;
  return spec;
}

template <class T>
bool refuses(T Spec::* field, T value, const char* words) {
  Spec spec = spec_of(feedforward, 4);
  spec.*field = value;
  return refused([&] { make_layout(spec); }, words) &&
         refused([&] { Evonet net(spec, 1, false); }, words);
}

}  // namespace

TEST(values_out_of_range_are_refused) {
  const int most = std::numeric_limits<int>::max(), least = std::numeric_limits<int>::min();
  for (int bad : {0, -1, least, most}) {
    CHECK(refuses(&Spec::inputs, bad, "inputs is "));
    CHECK(refuses(&Spec::outputs, bad, "outputs is "));
    CHECK(refuses(&Spec::nlayers, bad, "nlayers is "));
    CHECK(refuses(&Spec::nbins, bad, "nbins is "));
  }
  for (int bad : {-1, least, most}) {
    CHECK(refuses(&Spec::nhiddens, bad, "nhiddens is "));
    CHECK(refuses(&Spec::bias, bad, "bias is "));
    CHECK(refuses(&Spec::architecture, bad, "architecture is "));
    CHECK(refuses(&Spec::afunction, bad, "afunction is "));
    CHECK(refuses(&Spec::out_type, bad, "out_type is "));
    CHECK(refuses(&Spec::winit, bad, "winit is "));
    CHECK(refuses(&Spec::clip, bad, "clip is "));
    CHECK(refuses(&Spec::normalize, bad, "normalize is "));
    CHECK(refuses(&Spec::action_noise, bad, "action_noise is "));
    CHECK(refuses(&Spec::nhiddens2, bad, "nhiddens2 is "));
  }
  CHECK(refuses(&Spec::nhiddens2, 1, "nhiddens2 needs nlayers = 2"));
  CHECK(refuses(&Spec::afunction, int(binary_unit), "afunction is 4"));  // outputs only
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {-0.5, nan, -nan, 1e300}) {
    CHECK(refuses(&Spec::action_noise_range, bad, "action_noise_range is "));
    CHECK(refuses(&Spec::wrange, bad, "wrange is "));
  }
  CHECK(refuses(&Spec::low, nan, "finite") && refuses(&Spec::high, nan, "finite"));
}

TEST(combinations_are_refused) {
  Spec spec = spec_of(feedforward, 4);
  spec.nlayers = 2;
  for (int bad : {-1, 8, 100}) {
    spec.nhiddens2 = bad;
    CHECK(refused([&] { make_layout(spec); }, "nhiddens2 is "));
  }
  for (int architecture : {recurrent, fully_recurrent, lstm}) {
    spec = spec_of(architecture, 4);
    spec.nlayers = 2;
    CHECK(refused([&] { make_layout(spec); }, "one hidden layer"));
  }
  spec = spec_of(feedforward, 4);
  spec.nbins = 2;
  spec.low = spec.high = 1;
  CHECK(refused([&] { make_layout(spec); }, "low must be below high"));
  for (int architecture = 0; architecture < 4; ++architecture) {
    spec = spec_of(architecture, 10000);
    CHECK(refused([&] { make_layout(spec); }, "too large"));
  }
  spec = spec_of(feedforward, 4);
  spec.inputs = spec.outputs = 1000000;
  spec.nbins = 1000;
  CHECK(refused([&] { make_layout(spec); }, "too large"));
  for (int networks : {0, -1, 1001})
    CHECK(refused([&] { Evonet net(spec_of(lstm, 4), networks, true); }, "number of networks"));
}

TEST(every_parameter_has_one_place) {
  for (int architecture = 0; architecture < 4; ++architecture)
    for (int nhiddens : {0, 1, 5})
      for (int nlayers : {1, 2, kMaxLayers}) {
        if (architecture != feedforward && nhiddens > 0 && nlayers > 1) continue;
        Spec spec = spec_of(architecture, nhiddens);
        spec.nlayers = nlayers;
        spec.nhiddens2 = nlayers == 2 && nhiddens == 5 ? 3 : 0;
        const Layout l = make_layout(spec);
        std::vector<int> uses(l.parameters, 0);
        auto count = [&](const Layer& layer) {
          for (int r = 0; r < layer.neurons; ++r) {
            if (layer.bias >= 0) ++uses.at(layer.bias + r);
            for (int b = 0; b < layer.blocks; ++b)
              for (int s = 0; s < layer.block[b].senders; ++s)
                ++uses.at(layer.block[b].weights + r * layer.block[b].stride +
                          layer.block[b].offset + s);
          }
        };
        for (int i = 0; i < l.layers; ++i) count(l.layer[i]);
        if (l.cells > 0) count(l.gates);
        for (int o = 0; o < spec.outputs; ++o) ++uses.at(l.deviations + o);
        for (int p = 0; p < l.parameters; ++p)
          // the biases of an LSTM's units have no effect
          CHECK(uses[p] == (p < l.cells ? 0 : 1));
      }
}

TEST(networks_of_every_kind_run) {
  for (int architecture = 0; architecture < 4; ++architecture)
    for (int nhiddens : {0, 1, 5})
      for (int networks : {1, 3})
        for (int nbins : {1, 4}) {
          Spec spec = spec_of(architecture, nhiddens);
          spec.nbins = nbins;
          spec.normalize = spec.clip = 1;
          Evonet net(spec, networks, true);
          std::vector<double> parameters(net.parameters()), inputs(net.inputs(), 0.5);
          std::vector<double> actions(net.actions()), activations(net.neurons());
          net.seed(7, 1);
          net.initialise(parameters.data());
          net.collecting = true;
          net.reset();
          for (int step = 0; step < 10; ++step)
            net.step(parameters.data(), inputs.data(), actions.data(), activations.data());
          for (double x : actions) CHECK(std::isfinite(x));
          CHECK(std::fabs(net.moments.count - 10 * networks - 0.01) < 1e-9);
        }
}
