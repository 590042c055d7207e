// The forward pass, for L networks of one layout side by side ("lanes"): value v of lane l is at
// [v * L + l], and every lane goes through the same instructions. With L = 1 that is the genotype's
// own layout. T is the scalar.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "layout.hpp"
#include "philox.hpp"
#include "rows.hpp"

BOTSCHOOL_BEGIN

/// Working memory of a Brain, all [values * L]; carve() lays it out in one zeroed buffer.
template <class T, int L>
struct BrainMemory {
  T* parameters;
  T* mean;         ///< inputs
  T* deviation;    ///< inputs
  T* inputs;       ///< raw observation
  T* activations;  ///< neurons, in the order inputs, hidden, outputs
  T* previous;     ///< activations of the step before
  T* gates;        ///< 4 * cells
  T* state;        ///< cells
  T* noise;        ///< outputs: standard deviation of the action noise
  T* actions;      ///< outputs: what the actuators get
  /// For sums by rows: the weights of L networks, a network's size, and room for the sums of one
  /// layer.
  T* networks;
  std::size_t network_size;
  T* scratch;
  const Groups<L>* groups = nullptr;  ///< which lanes have which of the networks

  /// Number of T that the buffer must hold.
  static std::size_t size(const Layout& l) {
    BrainMemory memory;
    return memory.carve(l, nullptr);
  }
  std::size_t carve(const Layout& l, T* buffer) {
    std::size_t used = 0;
    auto take = [&](int values) {
      T* place = buffer ? buffer + used : nullptr;
      used += std::size_t(values) * L;
      return place;
    };
    parameters = take(l.parameters);
    mean = take(l.spec.inputs);
    deviation = take(l.spec.inputs);
    inputs = take(l.spec.inputs);
    activations = take(l.neurons);
    previous = take(l.neurons);
    gates = take(4 * l.cells);
    state = take(l.cells);
    noise = take(l.spec.outputs);
    actions = take(l.spec.outputs);
    network_size = 0;
    int largest = 0;
    const auto count = [&](const Layer& layer) {
      network_size += Rows<T, L>::size(layer);
      largest = std::max(largest, Rows<T, L>::of(layer));
    };
    if (l.cells > 0) count(l.gates);
    for (int i = 0; i < l.layers; ++i) count(l.layer[i]);
    networks = take(static_cast<int>(network_size));
    scratch = take(largest);
    return used;
  }
};

template <class T, int L>
class Brain {
  template <class, int>
  friend class Brain;

 public:
  Brain(const Layout& layout, const BrainMemory<T, L>& memory) : l_(layout), m_(memory) {}

  /// Puts a genotype into a lane; `normalisation` is all means, then all deviations, or null.
  /// load_network() loads the weights of sums by rows.
  void load(int lane, const double* genotype, const double* normalisation) {
    if (l_.cells > 0) place(l_.gates, genotype, m_.parameters + lane);
    for (int i = 0; i < l_.layers; ++i) place(l_.layer[i], genotype, m_.parameters + lane);
    for (int i = 0; i < l_.spec.inputs; ++i) {
      m_.mean[i * L + lane] = normalisation ? static_cast<T>(normalisation[i]) : T(0);
      m_.deviation[i * L + lane] =
          normalisation ? static_cast<T>(normalisation[l_.spec.inputs + i]) : T(1);
    }
    for (int o = 0; o < l_.spec.outputs; ++o)
      m_.noise[o * L + lane] = l_.deviations >= 0
                                   ? exponential(static_cast<T>(genotype[l_.deviations + o]))
                                   : static_cast<T>(l_.spec.action_noise_range);
  }

  /// Puts a genotype where the lanes of a group read it; returns whether its weights are finite.
  bool load_network(int network, const double* genotype) {
    T* to = m_.networks + network * m_.network_size;
    bool finite = true;
    const auto pack = [&](const Layer& layer) {
      finite &= Rows<T, L>::pack(layer, genotype, to);
      to += Rows<T, L>::size(layer);
    };
    if (l_.cells > 0) pack(l_.gates);
    for (int i = 0; i < l_.layers; ++i) pack(l_.layer[i]);
    return finite;
  }

  /// Start of an episode: all activations and states are 0.
  void clear(int lane) {
    for (int i = 0; i < l_.neurons; ++i) m_.activations[i * L + lane] = T(0);
    for (int i = 0; i < l_.cells; ++i) m_.state[i * L + lane] = T(0);
  }

  /// Continues in a lane the state of another's lane with the same parameters.
  template <int W>
  void copy(int lane, const Brain<T, W>& other, int from) {
    for (int i = 0; i < l_.neurons; ++i)
      m_.activations[i * L + lane] = other.m_.activations[i * W + from];
    for (int i = 0; i < l_.cells; ++i) m_.state[i * L + lane] = other.m_.state[i * W + from];
  }

  /// From `inputs` to `activations` and `actions`. steps[lane]: steps done in the episode.
  void step(const NoiseKey* keys, const int* steps) {
    if (l_.recurrent)
      for (int i = l_.spec.inputs * L; i < l_.neurons * L; ++i) m_.previous[i] = m_.activations[i];
    read_inputs();
    const T* networks = m_.networks;
    if (l_.cells > 0) {
      net_inputs(l_.gates, m_.gates, networks);
      update_cells();
    }
    for (int i = 0; i < l_.layers; ++i) {
      const Layer& layer = l_.layer[i];
      net_inputs(layer, m_.activations + layer.first * L, networks);
      activate(layer.activation, m_.activations + layer.first * L, layer.neurons * L);
    }
    act();
    if (l_.spec.action_noise != no_noise) add_noise(keys, steps);
  }

 private:
  /// Receivers whose weights lie side by side, and groups of them whose sums run side by side:
  /// independent chains keep the adders busy, as far as there are registers.
  static constexpr int kGroup = 4;
  static constexpr int kGroups = 2;
  /// Lanes in a register.
  static constexpr int kWidth = L * sizeof(T) < kRegister ? L : kRegister / sizeof(T);

  /// Writes a layer's part of a genotype to the parameters of a lane. The rows of a whole group of
  /// receivers lie beside each other, sender by sender, so that sum() reads the weights as one
  /// stream; the weights of the last receivers keep their order.
  static void place(const Layer& layer, const double* genotype, T* parameters) {
    const int rows = Rows<T, L>::of(layer);
    if (layer.bias >= 0)
      for (int i = layer.bias + rows; i < layer.bias + layer.neurons; ++i)
        parameters[i * L] = static_cast<T>(genotype[i]);
    for (int b = 0; b < layer.blocks; ++b) {
      const Connections& c = layer.block[b];
      for (int r = rows; r < layer.neurons; ++r) {
        const bool grouped = r < layer.neurons / kGroup * kGroup;
        const int group = r / kGroup * kGroup * c.stride + r % kGroup + c.offset * kGroup;
        const int row = c.weights + r * c.stride + c.offset;
        const int first = grouped ? c.weights + group : row, step = grouped ? kGroup : 1;
        for (int s = 0; s < c.senders; ++s)
          parameters[(first + s * step) * L] = static_cast<T>(genotype[row + s]);
      }
    }
  }

  void read_inputs() {
    const int n = l_.spec.inputs * L;
    T* BOTSCHOOL_RESTRICT out = m_.activations;
    const T* BOTSCHOOL_RESTRICT in = m_.inputs;
    if (l_.spec.normalize)
      for (int i = 0; i < n; ++i) out[i] = (in[i] - m_.mean[i]) / m_.deviation[i];
    else
      for (int i = 0; i < n; ++i) out[i] = in[i];
    if (l_.spec.clip)
      for (int i = 0; i < n; ++i) out[i] = clamp(out[i], T(-5), T(5));
  }

  /// Sums over the senders of G groups of R receivers at a time; each sum runs over the blocks and
  /// their senders in order, whatever G and R are.
  template <int G, int R>
  void sum(const Layer& layer, int receiver, T* out) const {
    using Lanes = LanesOf<T, kWidth>;
    for (int l = 0; l < L; l += kWidth) {
      const auto parameter = [&](std::ptrdiff_t i) {
        return *reinterpret_cast<const Lanes*>(m_.parameters + i * L + l);
      };
      Lanes total[G * R] = {};
      if (layer.bias >= 0)
        for (int r = 0; r < G * R; ++r) total[r] += parameter(layer.bias + receiver + r);
      for (int b = 0; b < layer.blocks; ++b) {
        const Connections& c = layer.block[b];
        const T* from =
            (c.previous ? m_.previous : m_.activations) + std::ptrdiff_t(c.sender) * L + l;
        const std::ptrdiff_t group = std::ptrdiff_t(R) * c.stride;
        std::ptrdiff_t weight = c.weights + std::ptrdiff_t(receiver) * c.stride + R * c.offset;
        for (int s = 0; s < c.senders; ++s, weight += R, from += L) {
          const Lanes x = *reinterpret_cast<const Lanes*>(from);
          for (int g = 0; g < G; ++g)
            for (int r = 0; r < R; ++r) total[g * R + r] += parameter(weight + g * group + r) * x;
        }
      }
      for (int r = 0; r < G * R; ++r) *reinterpret_cast<Lanes*>(out + r * L + l) = total[r];
    }
  }

  /// The first rows network by network, the others lane by lane. `networks`: where the layer's
  /// weights in the first network begin; moves on to the next layer's weights.
  void net_inputs(const Layer& layer, T* out, const T*& networks) const {
    int r = Rows<T, L>::of(layer);
    if constexpr (L > 1)
      if (r > 0)
        Rows<T, L>(layer, m_.activations, m_.previous, m_.scratch)
            .sums(*m_.groups, networks, m_.network_size, out);
    networks += Rows<T, L>::size(layer);
    for (; r + kGroups * kGroup <= layer.neurons; r += kGroups * kGroup)
      sum<kGroups, kGroup>(layer, r, out + r * L);
    for (; r + kGroup <= layer.neurons; r += kGroup) sum<1, kGroup>(layer, r, out + r * L);
    for (; r < layer.neurons; ++r) sum<1, 1>(layer, r, out + r * L);
  }

 public:
  /// The activations of n neurons, in the place of their net inputs.
  static void activate(int activation, T* BOTSCHOOL_RESTRICT x, int n) {
    switch (activation) {
      case logistic_unit:
        if constexpr (kVector > 1)
          in_registers(x, n, [](auto count, Vector* at) { logistics<count(), T>(at); });
        else
          for (int i = 0; i < n; ++i) x[i] = logistic(x[i]);
        break;
      case tanh_unit:
        if constexpr (kVector > 1)
          in_registers(x, n, [](auto count, Vector* at) { hyperbolic_tangents<count(), T>(at); });
        else
          for (int i = 0; i < n; ++i) x[i] = hyperbolic_tangent(x[i]);
        break;
      case binary_unit:
        for (int i = 0; i < n; ++i) x[i] = x[i] >= T(0.5) ? T(1) : T(-1);
        break;
      case relu_unit:
        for (int i = 0; i < n; ++i) x[i] = x[i] < T(0) ? T(0) : x[i];  // NaN stays
        break;
      default:
        break;
    }
  }

 private:
  using Vector = VectorOf<T, kWidth>;
  static constexpr int kVector = sizeof(Vector) / sizeof(T);

  /// Calls change(registers, place) for all of n values. Several registers at a time are faster: the
  /// operations of one run while those of another wait.
  template <class Change>
  static void in_registers(T* x, int n, Change change) {
    constexpr int several = 5;
    int i = 0;
    for (; i + several * kVector <= n; i += several * kVector)
      change(std::integral_constant<int, several>{}, &vector(x + i));
    for (; i < n; i += kVector) change(std::integral_constant<int, 1>{}, &vector(x + i));
  }

  static Vector& vector(T* at) { return *reinterpret_cast<Vector*>(at); }
  static Vector for_exponential(Vector x) {
    return clamp(x, Vector{} + kExpLow<T>, Vector{} + kExpHigh<T>);
  }
  static Vector for_tanh(Vector x) {
    return clamp(x + x, Vector{} - kTwiceHigh<T>, Vector{} + kTwiceHigh<T>);
  }

  /// logistic(x) = 1 / (1 + exp(-x)) and tanh(x) = e / (e + 2), e = exp(2x) - 1; each product of the
  /// two takes one division. `hidden` keeps the output gates' 1 + exp(-x) until the new states are
  /// known, as states of several units at a time are faster.
  void update_cells() {
    T* hidden = m_.activations + l_.spec.inputs * L;
    for (int i = 0; i < l_.cells * L; i += kVector) {
      T* gate = m_.gates + i / L * 4 * L + i % L;
      Vector scale[4];
      Vector x[4] = {for_exponential(-(vector(gate) + T(1))), for_exponential(-vector(gate + L)),
                     for_exponential(-vector(gate + 2 * L)), for_tanh(vector(gate + 3 * L))};
      exponentials<4>(x, scale);
      const Vector forget = T(1) / (T(1) + (x[0] + scale[0]));
      const Vector input = T(1) + (x[1] + scale[1]);
      const Vector candidate = x[3] + (scale[3] - T(1));
      Vector& state = vector(m_.state + i);
      state = state * forget + candidate / ((candidate + T(2)) * input);
      vector(hidden + i) = T(1) + (x[2] + scale[2]);
    }
    int i = 0;
    for (; i + 4 * kVector <= l_.cells * L; i += 4 * kVector) put_out<4>(i, hidden);
    for (; i < l_.cells * L; i += kVector) put_out<1>(i, hidden);
  }

  /// The outputs of n vectors of LSTM units.
  template <int n>
  void put_out(int first, T* hidden) {
    Vector x[n], scale[n];
    for (int i = 0; i < n; ++i) x[i] = for_tanh(vector(m_.state + first + i * kVector));
    exponentials<n>(x, scale);
    for (int i = 0; i < n; ++i) {
      const Vector squashed = x[i] + (scale[i] - T(1));
      Vector& output = vector(hidden + first + i * kVector);
      output = squashed / ((squashed + T(2)) * output);
    }
  }

  void act() {
    const T* BOTSCHOOL_RESTRICT out = m_.activations + (l_.neurons - l_.outputs) * L;
    const int bins = l_.spec.nbins;
    if (bins <= 1) {
      for (int i = 0; i < l_.spec.outputs * L; ++i) m_.actions[i] = out[i];
      return;
    }
    const T low = static_cast<T>(l_.spec.low), range = static_cast<T>(l_.spec.high - l_.spec.low);
    for (int o = 0; o < l_.spec.outputs; ++o) {
      int winner[L];
      argmax(out + o * bins * L, bins, winner);
      for (int l = 0; l < L; ++l) m_.actions[o * L + l] = low + range * T(winner[l]) / T(bins - 1);
    }
  }

 public:
  /// The largest of n values of each lane; the first wins ties.
  static void argmax(const T* BOTSCHOOL_RESTRICT values, int n, int* BOTSCHOOL_RESTRICT winner) {
    T best[L];
    for (int l = 0; l < L; ++l) best[l] = values[l], winner[l] = 0;
    for (int i = 1; i < n; ++i)
      for (int l = 0; l < L; ++l) {
        const bool better = values[i * L + l] > best[l];
        best[l] = better ? values[i * L + l] : best[l];
        winner[l] = better ? i : winner[l];
      }
  }

 private:
  void add_noise(const NoiseKey* keys, const int* steps) {
    for (int o = 0; o < l_.spec.outputs; ++o)
      for (int l = 0; l < L; ++l) {
        const Block block = philox(keys[l].seed, keys[l].episode, Stream::action,
                                   static_cast<std::uint32_t>(steps[l]), o);
        m_.actions[o * L + l] += static_cast<T>(gaussian_of(block)) * m_.noise[o * L + l];
      }
  }

  const Layout& l_;
  BrainMemory<T, L> m_;
};

BOTSCHOOL_END
