// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as easy
// as 1, 2, 3"). A draw is a pure function of (seed, episode, stream, step, index), so it does not
// matter who draws when.
#pragma once

#include <cmath>
#include <cstdint>

#include "real.hpp"

BOTSCHOOL_BEGIN

/// What a draw is for; streams never share numbers.
enum class Stream : std::uint32_t { start = 0, action = 1, sensor = 2, weights = 3 };

struct Block {
  std::uint32_t word[4];
};

BOTSCHOOL_INLINE Block philox(std::uint64_t seed, std::uint32_t episode, Stream stream,
                              std::uint32_t step, std::uint32_t index) {
  std::uint32_t c0 = index, c1 = step, c2 = static_cast<std::uint32_t>(stream), c3 = episode;
  std::uint32_t k0 = static_cast<std::uint32_t>(seed), k1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = 0xD2511F53ull * c0, p1 = 0xCD9E8D57ull * c2;
    c0 = static_cast<std::uint32_t>(p1 >> 32) ^ c1 ^ k0;
    c1 = static_cast<std::uint32_t>(p1);
    c2 = static_cast<std::uint32_t>(p0 >> 32) ^ c3 ^ k1;
    c3 = static_cast<std::uint32_t>(p0);
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return {{c0, c1, c2, c3}};
}

/// Uniform in [0, 1), 53 bits.
BOTSCHOOL_INLINE double uniform_of(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (static_cast<std::uint64_t>(high) << 32 | low) >> 12;
  return bits_of<double>(bits | 0x3ff0000000000000ull) - 1.0;
}

/// Standard Gaussian (Box and Muller 1958).
BOTSCHOOL_INLINE double gaussian_of(const Block& block) {
  const double u = 1.0 - uniform_of(block.word[0], block.word[1]);
  const double turn = uniform_of(block.word[2], block.word[3]);
  double sine, cosine;
  sine_cosine(2.0 * kPi * turn, sine, cosine);
  return std::sqrt(-2.0 * logarithm(u)) * cosine;
}

/// Draws one after another, for the places that draw seldom (the start of an episode).
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t episode, Stream stream)
      : seed_(seed), episode_(episode), stream_(stream) {}
  double uniform(double low, double high) {
    const Block block = next();
    return low + (high - low) * uniform_of(block.word[0], block.word[1]);
  }
  double gaussian() { return gaussian_of(next()); }

 private:
  Block next() { return philox(seed_, episode_, stream_, 0, index_++); }

  std::uint64_t seed_;
  std::uint32_t episode_, index_ = 0;
  Stream stream_;
};

BOTSCHOOL_END
