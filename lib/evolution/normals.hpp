// Random numbers as numpy's Generator(Philox(key)) gives them: Philox4x64-10 (Salmon et al. 2011), the
// ziggurat method with 256 layers (Marsaglia and Tsang 2000), whole numbers by multiplication (Lemire
// 2019). Python draws by it, too (botschool/seeds.py), so a page's runs are the command's. docs/page.md.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "evonet/real.hpp"
#include "sums.hpp"
#include "ziggurat.hpp"

namespace botschool {

/// The numbers of one generation of a run, one after another.
class Normals {
 public:
  /// A place among the numbers.
  struct Place {
    std::uint64_t seed, generation;
    std::uint64_t words = 0;  ///< of 64 bits that have been drawn
    std::int64_t half = -1;   ///< the half word that is left, or -1
  };

  Normals(std::uint64_t seed, std::uint64_t generation) : Normals(Place{seed, generation}) {}
  explicit Normals(const Place& place)
      : key_{place.seed, place.generation},
        blocks_(place.words / 4),
        kept_(place.half >= 0),
        high_(static_cast<std::uint32_t>(place.half)) {
    if (place.words % 4) fill(), used_ = static_cast<int>(place.words % 4);
  }

  Place place() const {
    return {key_[0], key_[1], 4 * blocks_ + used_ - 4, kept_ ? std::int64_t(high_) : -1};
  }

  double next() {
    for (;;) {
      const std::uint64_t word = bits(), size = word >> 9 & 0x000fffffffffffffull;
      const int layer = static_cast<int>(word & 0xff);
      const bool negative = word >> 8 & 1;
      const double x = static_cast<double>(size) * ziggurat::width[layer];
      if (size < ziggurat::inside[layer]) return negative ? -x : x;
      if (layer == 0) return tail(size >> 8 & 1);
      const double below = ziggurat::height[layer], above = ziggurat::height[layer - 1];
      if ((above - below) * uniform() + below < exponential(-0.5 * x * x)) return negative ? -x : x;
    }
  }

  /// A whole number from 0 to before `count`: numpy's integers(count).
  std::uint64_t below(std::uint64_t count) {
    if (count < 2) return 0;
    if (count >> 32) return count >> 32 == 1 && !(count << 32) ? half() : below_many(count);
    const std::uint32_t few = static_cast<std::uint32_t>(count);
    const std::uint32_t uneven = (0u - few) % few;  // so many words would be too much
    for (;;) {
      const std::uint64_t scaled = std::uint64_t(half()) * few;
      if (static_cast<std::uint32_t>(scaled) >= uneven) return scaled >> 32;
    }
  }

  /// The numbers from 0 to before `count` in a random order (Fisher and Yates 1938).
  std::vector<std::size_t> permutation(std::uint32_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    for (std::uint32_t i = count; i-- > 1;) std::swap(order[i], order[up_to(i)]);
    return order;
  }

  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11) * (1.0 / 9007199254740992.0); }

  std::uint64_t bits() {
    if (used_ == 4) fill();
    return block_[used_++];
  }

  /// 32 bits: the low half of a word, then the high one, whatever is drawn in between.
  std::uint32_t half() {
    if (kept_) return kept_ = false, high_;
    const std::uint64_t word = bits();
    kept_ = true;
    high_ = static_cast<std::uint32_t>(word >> 32);
    return static_cast<std::uint32_t>(word);
  }

 private:
  /// As `below`, where 32 bits are too few.
  std::uint64_t below_many(std::uint64_t count) {
    const std::uint64_t uneven = (0ull - count) % count;
    for (;;) {
      std::uint64_t low;
      const std::uint64_t value = multiply(bits(), count, low);
      if (low >= uneven) return value;
    }
  }

  /// From 0 to `most`: as many bits as that has, until they are not above it.
  std::uint32_t up_to(std::uint32_t most) {
    std::uint32_t bits = most;
    for (int shift = 1; shift < 32; shift *= 2) bits |= bits >> shift;
    for (;;)
      if (const std::uint32_t value = half() & bits; value <= most) return value;
  }

  /// Beyond the last layer (Marsaglia 1964).
  double tail(bool negative) {
    for (;;) {
      const double beyond = -ziggurat::inverse_tail * log_of_rest(uniform());
      const double height = -log_of_rest(uniform());
      if (height + height > beyond * beyond) {
        const double x = ziggurat::tail + beyond;
        return negative ? -x : x;
      }
    }
  }

  void fill() {
    std::uint64_t c[4] = {++blocks_, 0, 0, 0};
    std::uint64_t key[2] = {key_[0], key_[1]};
    for (int round = 0; round < 10; ++round) {
      std::uint64_t low0, low1;
      const std::uint64_t high0 = multiply(0xD2E7470EE14C6C93ull, c[0], low0);
      const std::uint64_t high1 = multiply(0xCA5A826395121157ull, c[2], low1);
      c[0] = high1 ^ c[1] ^ key[0];
      c[1] = low1;
      c[2] = high0 ^ c[3] ^ key[1];
      c[3] = low0;
      key[0] += 0x9E3779B97F4A7C15ull;
      key[1] += 0xBB67AE8584CAA73Bull;
    }
    for (int i = 0; i < 4; ++i) block_[i] = c[i];
    used_ = 0;
  }

  /// The high 64 bits of a * b.
  static std::uint64_t multiply(std::uint64_t a, std::uint64_t b, std::uint64_t& low) {
#if defined(__SIZEOF_INT128__) && !defined(__wasm__)
    __extension__ using Wide = unsigned __int128;
    const Wide product = Wide(a) * b;
    low = static_cast<std::uint64_t>(product);
    return static_cast<std::uint64_t>(product >> 64);
#else
    const std::uint64_t a0 = a & 0xffffffff, a1 = a >> 32, b0 = b & 0xffffffff, b1 = b >> 32;
    const std::uint64_t middle = a1 * b0 + (a0 * b0 >> 32);
    const std::uint64_t other = a0 * b1 + (middle & 0xffffffff);
    low = a * b;
    return a1 * b1 + (middle >> 32) + (other >> 32);
#endif
  }

  std::uint64_t key_[2], blocks_, block_[4] = {};
  int used_ = 4;
  bool kept_;
  std::uint32_t high_;
};

}  // namespace botschool
