#include "layout.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace botschool {
namespace {

void check(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  auto text = [](double x) {
    std::string s = std::to_string(x);
    s.erase(s.find_last_not_of('0') + 1);
    if (s.back() == '.') s.pop_back();
    return s;
  };
  throw std::invalid_argument(std::string(name) + " is " + text(value) + ", but must be from " +
                              text(low) + " to " + text(high) + ".");
}

void check_spec(const Spec& s) {
  check("inputs", s.inputs, 1, 1e6);
  check("outputs", s.outputs, 1, 1e6);
#define BOTSCHOOL_CHECK(type, name, value, least, greatest, explanation, choices) \
  check(#name, s.name, least, greatest);
  BOTSCHOOL_HYPERPARAMETERS(BOTSCHOOL_CHECK)
#undef BOTSCHOOL_CHECK
  if (!std::isfinite(s.low) || !std::isfinite(s.high))
    throw std::invalid_argument("low and high must be finite numbers.");
  if (s.nbins > 1 && !(s.low < s.high))
    throw std::invalid_argument("low must be below high when actions are binned (nbins > 1).");
  if (s.nhiddens2 != 0) {
    if (s.nlayers != 2)
      throw std::invalid_argument("nhiddens2 needs nlayers = 2; set it to 0 otherwise.");
    if (s.nhiddens == 0)
      throw std::invalid_argument(
          "nhiddens2 needs hidden neurons: set nhiddens, or nhiddens2 = 0.");
    check("nhiddens2", s.nhiddens2, 1, 2.0 * s.nhiddens - 1);
  }
  if (s.architecture != feedforward && s.nhiddens > 0 && s.nlayers > 1)
    throw std::invalid_argument(
        "recurrent and LSTM networks have one hidden layer: set nlayers = 1.");
  if (s.afunction == binary_unit)
    throw std::invalid_argument("afunction is 4 (binary), which is for outputs only.");
  if (s.architecture == convolutional)
    throw std::invalid_argument(
        "architecture is 4 (convolutional), which reads images, and here are none.");
  const double computed = double(s.nhiddens) * s.nlayers + double(s.outputs) * s.nbins;
  const double receivers = s.architecture == lstm ? 4 * computed : computed;
  if ((s.inputs + computed) * receivers > 1e8)
    throw std::invalid_argument("the network is too large: more than 100 million connections.");
}

/// Places parameters one after another.
class Placer {
 public:
  explicit Placer(Layout& layout) : layout_(layout) {}
  int take(int count) {
    const int place = layout_.parameters;
    layout_.parameters += count;
    return place;
  }
  void connect(Layer& layer, int sender, int senders, bool previous) {
    layer.block[layer.blocks++] = {sender,  senders, previous, take(layer.neurons * senders),
                                   senders, 0};
  }
  /// Two blocks whose rows lie beside each other: the present senders, then the previous ones.
  void connect_rows(Layer& layer, int now, int nows, int before, int befores) {
    const int row = nows + befores, place = take(layer.neurons * row);
    layer.block[layer.blocks++] = {now, nows, false, place, row, 0};
    layer.block[layer.blocks++] = {before, befores, true, place, row, nows};
  }

 private:
  Layout& layout_;
};

int layer_size(const Spec& s, int layer) {
  if (s.nhiddens2 == 0) return s.nhiddens;
  return layer == 0 ? 2 * s.nhiddens - s.nhiddens2 : s.nhiddens2;
}

void place_hidden_and_outputs(Layout& l, Placer& placer, int hidden_layers) {
  const Spec& s = l.spec;
  Layer& output = l.layer[hidden_layers];
  switch (hidden_layers == 0 && s.architecture == lstm ? int(feedforward) : s.architecture) {
    case feedforward: {
      int sender = 0, senders = s.inputs;
      for (int i = 0; i <= hidden_layers; ++i) {
        placer.connect(l.layer[i], sender, senders, false);
        sender = l.layer[i].first;
        senders = l.layer[i].neurons;
      }
      break;
    }
    case recurrent: {
      int sender = 0, senders = s.inputs;
      for (int i = 0; i <= hidden_layers; ++i) {
        Layer& layer = l.layer[i];
        placer.connect(layer, sender, senders, false);
        placer.connect(layer, layer.first, layer.neurons, true);
        sender = layer.first;
        senders = layer.neurons;
      }
      break;
    }
    case fully_recurrent:
      for (int i = 0; i <= hidden_layers; ++i)
        placer.connect_rows(l.layer[i], 0, s.inputs, s.inputs, l.hiddens + l.outputs);
      break;
    case lstm:
      l.cells = l.hiddens;
      l.gates = {0, 4 * l.hiddens, -1, linear_unit, 0, {}};
      placer.connect_rows(l.gates, 0, s.inputs, s.inputs, l.hiddens);
      placer.connect(output, s.inputs, l.hiddens, false);
      break;
  }
}

/// The rows that each receiver's incoming vector consists of, scaled to the given length.
void scale_incoming(const Layer& layer, int receiver, double length, double* parameters) {
  double squares = 0;
  for (int b = 0; b < layer.blocks; ++b) {
    const Connections& c = layer.block[b];
    const double* row = parameters + c.weights + receiver * c.stride + c.offset;
    for (int s = 0; s < c.senders; ++s) squares += row[s] * row[s];
  }
  if (squares == 0) return;
  for (int b = 0; b < layer.blocks; ++b) {
    const Connections& c = layer.block[b];
    double* row = parameters + c.weights + receiver * c.stride + c.offset;
    for (int s = 0; s < c.senders; ++s) row[s] *= length / std::sqrt(squares);
  }
}

}  // namespace

void initial_layer(const Spec& spec, const Layer& layer, int fan_out, bool output, Random& random,
                   double* parameters) {
  int fan_in = 0;
  for (int b = 0; b < layer.blocks; ++b) fan_in += layer.block[b].senders;
  const double deviation = std::sqrt(2.0 / (fan_in + fan_out));
  for (int r = 0; r < layer.neurons; ++r) {
    for (int b = 0; b < layer.blocks; ++b) {
      const Connections& c = layer.block[b];
      double* row = parameters + c.weights + r * c.stride + c.offset;
      for (int s = 0; s < c.senders; ++s) {
        if (spec.winit == uniform_weights)
          row[s] = random.uniform(-spec.wrange, spec.wrange);
        else
          row[s] = random.gaussian() * (spec.winit == xavier ? deviation : 1.0);
      }
    }
    if (spec.winit == norm_incoming)
      scale_incoming(layer, r, output && layer.activation == linear_unit ? 0.01 : 1.0, parameters);
  }
}

Layout make_layout(const Spec& spec) {
  check_spec(spec);
  Layout l{};
  l.spec = spec;
  l.outputs = spec.outputs * spec.nbins;
  const int hidden_layers = spec.nhiddens == 0 ? 0 : spec.nlayers;
  l.hiddens = spec.nhiddens * hidden_layers;
  l.neurons = spec.inputs + l.hiddens + l.outputs;
  l.recurrent = spec.architecture != feedforward;
  l.deviations = -1;
  const bool gated = spec.architecture == lstm && hidden_layers > 0;

  Placer placer(l);
  int neuron = spec.inputs;
  for (int i = 0; i < hidden_layers; ++i) {
    const int size = layer_size(spec, i);
    l.layer[i] = {neuron, size, spec.bias ? placer.take(size) : -1, spec.afunction, 0, {}};
    neuron += size;
  }
  l.layer[hidden_layers] = {neuron,        l.outputs, spec.bias ? placer.take(l.outputs) : -1,
                            spec.out_type, 0,         {}};
  place_hidden_and_outputs(l, placer, hidden_layers);
  if (gated) {  // the hidden layer is updated through its gates
    l.layer[0] = l.layer[1];
    l.layers = 1;
  } else {
    l.layers = hidden_layers + 1;
  }
  if (spec.action_noise == diagonal_gaussian_noise) l.deviations = placer.take(spec.outputs);
  return l;
}

void initial_parameters(const Layout& l, std::uint64_t seed, std::uint32_t index,
                        double* parameters) {
  Random random(seed, index, Stream::weights);
  initial_parameters(l, random, parameters);
}

void initial_parameters(const Layout& l, Random& random, double* parameters) {
  for (int i = 0; i < l.parameters; ++i) parameters[i] = 0;
  if (l.cells > 0) initial_layer(l.spec, l.gates, l.cells, false, random, parameters);
  for (int i = 0; i < l.layers; ++i) {
    const bool output = i == l.layers - 1;
    // one block of a fully recurrent network has all its neurons as receivers
    const int fan_out =
        l.spec.architecture == fully_recurrent ? l.hiddens + l.outputs : l.layer[i].neurons;
    initial_layer(l.spec, l.layer[i], fan_out, output, random, parameters);
  }
}

}  // namespace botschool
