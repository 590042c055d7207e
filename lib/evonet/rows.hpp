// Sums of large layers, network by network: a register holds the sums of several receivers ("rows")
// of one lane, so that a weight is read once for all lanes that have its network, however they are
// grouped. That is a small matrix product; each sum has the order that it has in brain.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "layout.hpp"
#include "real.hpp"

BOTSCHOOL_BEGIN

/// The lanes at work, grouped by network: network[g] belongs to lane[first[g]] to
/// lane[first[g + 1] - 1].
template <int L>
struct Groups {
  int count = 0;
  int network[L], first[L + 1], lane[L];
  bool finite[L];  ///< whether all weights of network[g] are
};

template <class T, int L>
class Rows {
 public:
  /// Lanes in a register, or rows.
  static constexpr int kWidth = L * sizeof(T) < kRegister ? L : kRegister / sizeof(T);

  /// How many of a layer's first rows are summed here: the rows that fill registers, if the weights of
  /// one network for each lane are too large for the nearest cache.
  static int of(const Layer& layer) {
    const std::size_t weights = std::size_t(layer.neurons) * senders(layer);
    return L > 1 && weights * L * sizeof(T) > kNear ? layer.neurons / kWidth * kWidth : 0;
  }
  /// Number of T that a network's biases and weights of these rows take.
  static std::size_t size(const Layer& layer) {
    return std::size_t(of(layer)) * (senders(layer) + (layer.bias >= 0));
  }

  /// Lays them out: the biases of all rows, then the weights from each sender, so that sums() reads
  /// one stream. Returns whether all are finite.
  static bool pack(const Layer& layer, const double* genotype, T* to) {
    const int rows = of(layer);
    T zero = 0;  // or NaN
    const auto put = [&](const double* from, int stride) {
      for (int r = 0; r < rows; ++r, ++to) {
        *to = static_cast<T>(from[std::ptrdiff_t(r) * stride]);
        zero += *to * T(0);
      }
    };
    if (layer.bias >= 0) put(genotype + layer.bias, 1);
    for (int b = 0; b < layer.blocks; ++b) {
      const Connections& c = layer.block[b];
      for (int s = 0; s < c.senders; ++s) put(genotype + c.weights + c.offset + s, c.stride);
    }
    return zero == 0;
  }

  /// `scratch` has room for of(layer) * L.
  Rows(const Layer& layer, const T* activations, const T* previous, T* scratch)
      : layer_(layer),
        activations_(activations),
        previous_(previous),
        scratch_(scratch),
        rows_(of(layer)) {}

  /// Writes to out[row * L + lane] for the lanes of the groups. What pack() wrote for network n is at
  /// networks + n * stride.
  void sums(const Groups<L>& groups, const T* networks, std::size_t stride, T* out) const {
    for (int g = 0; g < groups.count; ++g) {
      const int* lane = groups.lane + groups.first[g];
      const int lanes = groups.first[g + 1] - groups.first[g];
      const T* weights = networks + groups.network[g] * stride;
      panels<kPanel, kTogether>(weights, lane, lanes, groups.finite[g]);
    }
    for (int row = 0; row < rows_; row += kWidth) turn(row, out);
  }

 private:
  /// Approximate bytes of a core's first cache that are free for this.
  static constexpr std::size_t kNear = 64 * 1024;
  /// Registers of rows, and lanes, whose sums run side by side: a weight is loaded once for several
  /// lanes and an activation for several rows, as far as there are registers. Fewer lanes than 16 only
  /// end what 16 began: less code is compiled for them.
  static constexpr int kPanel = L < 16 ? 2 : kRegister == 64 ? 6 : 4;
  static constexpr int kTogether = L < 16 ? 2 : kRegister == 64 ? 4 : 2;
  /// Senders looked at before any is added.
  static constexpr int kChunk = 64;

  using Row = LanesOf<T, kWidth>;
  using Word = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

  static int senders(const Layer& layer) {
    int sum = 0;
    for (int b = 0; b < layer.blocks; ++b) sum += layer.block[b].senders;
    return sum;
  }

  /// All rows of some lanes, R registers of rows and N lanes at a time.
  template <int R, int N>
  void panels(const T* weights, const int* lane, int lanes, bool skip) const {
    int row = 0;
    for (; row + R * kWidth <= rows_; row += R * kWidth)
      panel<R, N>(weights, row, lane, lanes, skip);
    last<R - 1, N>(weights, row, lane, lanes, skip);
  }

  /// The last rows: at most R registers of them.
  template <int R, int N>
  void last(const T* weights, int row, const int* lane, int lanes, bool skip) const {
    if constexpr (R > 0) {
      if (row + R * kWidth == rows_)
        panel<R, N>(weights, row, lane, lanes, skip);
      else
        last<R - 1, N>(weights, row, lane, lanes, skip);
    }
  }

  /// R registers of rows of all lanes.
  template <int R, int N>
  void panel(const T* weights, int row, const int* lane, int lanes, bool skip) const {
    for (; lanes >= N; lanes -= N, lane += N) tile<R, N>(weights, row, lane, skip);
    if constexpr (N > 1)
      if (lanes > 0) panel<R, N - 1>(weights, row, lane, lanes, skip);
  }

  /// Writes which of the first `count` senders to add, and returns how many: all, or, to skip the
  /// others, all that are not 0 in all N lanes. A sum of finite numbers that begins with +0 is never
  /// -0, so adding 0 or -0 would change nothing.
  template <int N>
  static int choose(const T* from, const int* lane, int count, bool skip, int* sender) {
    if (!skip) {
      for (int s = 0; s < count; ++s) sender[s] = s;
      return count;
    }
    int chosen = 0;
    for (int s = 0; s < count; ++s, from += L) {
      Word bits = 0;
      for (int n = 0; n < N; ++n) bits |= bits_of<Word>(from[lane[n]]);
      sender[chosen] = s;
      chosen += Word(bits << 1) != 0;  // without the sign
    }
    return chosen;
  }

  /// R registers of rows of N lanes.
  template <int R, int N>
  void tile(const T* BOTSCHOOL_RESTRICT weights, int row, const int* lane, bool skip) const {
    weights += row;
    const auto weight = [&](int r) { return *reinterpret_cast<const Row*>(weights + r * kWidth); };
    Row total[N][R];
    for (int n = 0; n < N; ++n)
      for (int r = 0; r < R; ++r) total[n][r] = Row{};
    if (layer_.bias >= 0) {
      for (int n = 0; n < N; ++n)
        for (int r = 0; r < R; ++r) total[n][r] += weight(r);
      weights += rows_;
    }
    for (int b = 0; b < layer_.blocks; ++b) {
      const Connections& c = layer_.block[b];
      const T* from = (c.previous ? previous_ : activations_) + std::ptrdiff_t(c.sender) * L;
      for (int first = 0; first < c.senders; first += kChunk) {
        int sender[kChunk];
        const int end = c.senders - first < kChunk ? c.senders - first : kChunk;
        const int count = choose<N>(from, lane, end, b == 0 && skip, sender);
        for (int i = 0; i < count; ++i) {
          const T* own = weights + std::ptrdiff_t(sender[i]) * rows_;
          Row each[R];
          for (int r = 0; r < R; ++r) each[r] = *reinterpret_cast<const Row*>(own + r * kWidth);
#if defined(__GNUC__) && defined(__AVX512F__)
          // otherwise GCC loads them again for each lane, which takes as long as if they came from
          // far
          if (N == 2 || N == 3)
            for (int r = 0; r < R; ++r) asm("" : "+v"(each[r]));
#endif
          for (int n = 0; n < N; ++n) {
            const T x = from[sender[i] * L + lane[n]];
            for (int r = 0; r < R; ++r) total[n][r] += each[r] * x;
          }
        }
        weights += std::ptrdiff_t(end) * rows_;
        from += end * L;
      }
    }
    for (int n = 0; n < N; ++n)
      for (int r = 0; r < R; ++r)
        *reinterpret_cast<Row*>(scratch_ + std::ptrdiff_t(lane[n]) * rows_ + row + r * kWidth) =
            total[n][r];
  }

  /// From registers of rows, one for each lane, to registers of lanes, one for each row.
  void turn(int row, T* out) const {
    for (int l = 0; l < L; l += kWidth) {
      Row square[kWidth];
      for (int i = 0; i < kWidth; ++i)
        square[i] = *reinterpret_cast<const Row*>(scratch_ + std::ptrdiff_t(l + i) * rows_ + row);
      transpose<T, kWidth>(square);
      for (int i = 0; i < kWidth; ++i)
        *reinterpret_cast<Row*>(out + std::ptrdiff_t(row + i) * L + l) = square[i];
    }
  }

  const Layer& layer_;
  const T* activations_;
  const T* previous_;
  T* scratch_;
  const int rows_;
};

BOTSCHOOL_END
