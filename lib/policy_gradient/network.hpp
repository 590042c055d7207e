// Networks forward and backward, many samples at a time. Arrays are [values][samples], ld samples a
// row. Each sum runs in the order of its terms, so that neither the width of registers nor the
// shape of a tile changes a bit of it.
#pragma once

#include <cstring>

#include "../evonet/real.hpp"
#include "agent.hpp"

BOTSCHOOL_BEGIN
namespace learning {

using namespace policy_gradient;

/// A register of values.
using Register = VectorOf<float, kRegister / 4>;
constexpr int kWide = sizeof(Register) / sizeof(float);
/// Registers side by side in a tile: as many sums as there are registers for.
constexpr int kTile = kRegister == 64 ? 4 : 2;

BOTSCHOOL_INLINE Register& at(float* p) { return *reinterpret_cast<Register*>(p); }
BOTSCHOOL_INLINE const Register& at(const float* p) {
  return *reinterpret_cast<const Register*>(p);
}

/// w[o * by_output + s * by_input], a matrix or its transpose.
struct Weights {
  const float* w;
  int by_output, by_input;
  const float* bias;  ///< or null
};

/// y[o] = bias[o] + sum over s of w[o][s] * x[s], for O outputs and B registers of samples.
template <int O, int B>
BOTSCHOOL_INLINE void tile(const Weights& m, int o, const float* x, float* y, int inputs, int ld) {
  const float* w = m.w + o * m.by_output;
  Register sum[O][B];
  for (int i = 0; i < O; ++i)
    for (int b = 0; b < B; ++b) sum[i][b] = Register{} + (m.bias ? m.bias[o + i] : 0.0f);
  for (int s = 0; s < inputs; ++s) {
    Register in[B];
    for (int b = 0; b < B; ++b) in[b] = at(x + s * ld + b * kWide);
    for (int i = 0; i < O; ++i) {
      const float weight = w[i * m.by_output + s * m.by_input];
      for (int b = 0; b < B; ++b) sum[i][b] += weight * in[b];
    }
  }
  for (int i = 0; i < O; ++i)
    for (int b = 0; b < B; ++b) at(y + (o + i) * ld + b * kWide) = sum[i][b];
}

template <int O, int B>
void product(const Weights& m, const float* x, float* y, int outputs, int inputs, int ld) {
  int o = 0;
  for (; o + O <= outputs; o += O) tile<O, B>(m, o, x, y, inputs, ld);
  for (; o < outputs; ++o) tile<1, B>(m, o, x, y, inputs, ld);
}

/// The same for all ld samples, a multiple of 16.
inline void products(const Weights& m, const float* x, float* y, int outputs, int inputs, int ld) {
  int b = 0;
  for (; b + kTile * kWide <= ld; b += kTile * kWide)
    product<4, kTile>(m, x + b, y + b, outputs, inputs, ld);
  for (; b < ld; b += kWide) product<8, 1>(m, x + b, y + b, outputs, inputs, ld);
}

inline void activate(bool relu, float* BOTSCHOOL_RESTRICT x, int n) {
  if (relu)
    for (int i = 0; i < n; ++i) x[i] = x[i] > 0.0f ? x[i] : 0.0f;
  else
    for (int i = 0; i < n; ++i) x[i] = hyperbolic_tangent(x[i]);
}

/// Turns d loss / d what comes out of an activation into d loss / d what goes in.
inline void deactivate(bool relu, float* BOTSCHOOL_RESTRICT slope,
                       const float* BOTSCHOOL_RESTRICT y, int n) {
  if (relu)
    for (int i = 0; i < n; ++i) slope[i] = y[i] > 0.0f ? slope[i] : 0.0f;
  else
    for (int i = 0; i < n; ++i) slope[i] *= 1.0f - y[i] * y[i];
}

/// What comes out of each layer.
inline void forward(const Net& net, const float* p, bool relu, const float* x, float* const* out,
                    int ld) {
  for (int l = 0; l < net.layers; ++l) {
    const int inputs = net.width[l], outputs = net.width[l + 1];
    products({p + net.weights[l], inputs, 1, p + net.biases[l]}, x, out[l], outputs, inputs, ld);
    if (l + 1 < net.layers || !net.ends_linear) activate(relu, out[l], outputs * ld);
    x = out[l];
  }
}

/// turned[b][i] = x[i][b], rows filled up with zeros to a multiple of 16; a chunk.
inline void turn(const float* x, float* turned, int values) {
  const int width = (values + 15) / 16 * 16;
  for (int i = 0; i < width; i += kWide)
    for (int b = 0; b < kChunk; b += kWide) {
      LanesOf<float, kWide> rows[kWide];
      for (int r = 0; r < kWide; ++r)
        if (i + r < values)
          std::memcpy(&rows[r], x + (i + r) * kChunk + b, sizeof rows[r]);
        else
          std::memset(&rows[r], 0, sizeof rows[r]);
      transpose<float, kWide>(rows);
      for (int r = 0; r < kWide; ++r)
        std::memcpy(turned + (b + r) * width + i, &rows[r], sizeof rows[r]);
    }
}

/// g[o][i] = sum over the chunk's samples b of slope[o][b] * turned[b][i], for O outputs and I
/// registers of inputs, of which `some` values are kept.
template <int O, int I>
BOTSCHOOL_INLINE void outer(const float* slope, const float* turned, int width, float* g,
                            int inputs, int some) {
  Register sum[O][I] = {};
  for (int b = 0; b < kChunk; ++b) {
    Register in[I];
    for (int i = 0; i < I; ++i) in[i] = at(turned + b * width + i * kWide);
    for (int o = 0; o < O; ++o)
      for (int i = 0; i < I; ++i) sum[o][i] += slope[o * kChunk + b] * in[i];
  }
  for (int o = 0; o < O; ++o) std::memcpy(g + o * inputs, sum[o], some * sizeof(float));
}

template <int I>
void outers(const float* slope, const float* turned, int width, float* g, int outputs, int inputs,
            int i) {
  const int rest = inputs - i, some = rest < I * kWide ? rest : I * kWide;
  int o = 0;
  for (; o + 4 <= outputs; o += 4)
    outer<4, I>(slope + o * kChunk, turned + i, width, g + o * inputs + i, inputs, some);
  for (; o < outputs; ++o)
    outer<1, I>(slope + o * kChunk, turned + i, width, g + o * inputs + i, inputs, some);
}

inline void weight_gradient(const float* slope, const float* turned, float* g, int outputs,
                            int inputs) {
  const int width = (inputs + 15) / 16 * 16;
  int i = 0;
  for (; i + kTile * kWide <= width && i < inputs; i += kTile * kWide)
    outers<kTile>(slope, turned, width, g, outputs, inputs, i);
  for (; i < inputs; i += kWide) outers<1>(slope, turned, width, g, outputs, inputs, i);
}

/// Sums over the samples of a chunk: 16 partial sums, added in order.
inline float chunk_sum(const float* x) {
  float part[16] = {}, sum = 0;
  for (int b = 0; b < kChunk; b += 16)
    for (int l = 0; l < 16; ++l) part[l] += x[b + l];
  for (int l = 0; l < 16; ++l) sum += part[l];
  return sum;
}

/// The gradient of a chunk with respect to a net's parameters, into g. `slope` is d loss / d what
/// comes out of the net and is used up; `before`: where d loss / d what goes in is put, or null.
inline void backward(const Net& net, const float* p, bool relu, const float* x, float* const* out,
                     Scratch& s, float* slope, float* before, float* g) {
  for (int l = net.layers - 1; l >= 0; --l) {
    const int inputs = net.width[l], outputs = net.width[l + 1];
    if (l + 1 < net.layers || !net.ends_linear) deactivate(relu, slope, out[l], outputs * kChunk);
    turn(l ? out[l - 1] : x, s.turned, inputs);
    weight_gradient(slope, s.turned, g + net.weights[l], outputs, inputs);
    for (int o = 0; o < outputs; ++o) g[net.biases[l] + o] = chunk_sum(slope + o * kChunk);
    float* next = l ? (slope == s.slope[0] ? s.slope[1] : s.slope[0]) : before;
    if (next)
      products({p + net.weights[l], 1, inputs, nullptr}, slope, next, inputs, outputs, kChunk);
    slope = next;
  }
}

}  // namespace learning
BOTSCHOOL_END
