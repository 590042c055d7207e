// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as
// easy as 1, 2, 3"). A draw is a pure function of (seed, episode, stream, step, index), so the
// order of draws does not matter.
#pragma once

#include <cmath>
#include <cstdint>

#include "real.hpp"

BOTSCHOOL_BEGIN

/// The purpose of a draw; streams never share numbers.
enum class Stream : std::uint32_t {
  start = 0,
  action = 1,
  sensor = 2,
  weights = 3,
  event = 4,
  explore = 5,
  shuffle = 6,
  vary = 7
};

struct Block {
  std::uint32_t word[4];
};

/// The source of an episode's draws.
struct NoiseKey {
  std::uint64_t seed;
  std::uint32_t episode;
};

/// A block for each of L lanes: word w of lane l is at word[w][l].
template <int L>
BOTSCHOOL_INLINE void philox_lanes(const NoiseKey* key, Stream stream, const std::uint32_t* step,
                                   std::uint32_t index, std::uint32_t (*word)[L]) {
  alignas(64) std::uint32_t k0[L], k1[L];
  for (int l = 0; l < L; ++l) {
    word[0][l] = index;
    word[1][l] = step[l];
    word[2][l] = static_cast<std::uint32_t>(stream);
    word[3][l] = key[l].episode;
    k0[l] = static_cast<std::uint32_t>(key[l].seed);
    k1[l] = static_cast<std::uint32_t>(key[l].seed >> 32);
  }
  for (int round = 0; round < 10; ++round)
    for (int l = 0; l < L; ++l) {
      const std::uint64_t p0 = 0xD2511F53ull * word[0][l], p1 = 0xCD9E8D57ull * word[2][l];
      word[0][l] = static_cast<std::uint32_t>(p1 >> 32) ^ word[1][l] ^ k0[l];
      word[1][l] = static_cast<std::uint32_t>(p1);
      word[2][l] = static_cast<std::uint32_t>(p0 >> 32) ^ word[3][l] ^ k1[l];
      word[3][l] = static_cast<std::uint32_t>(p0);
      k0[l] += 0x9E3779B9u;
      k1[l] += 0xBB67AE85u;
    }
}

BOTSCHOOL_INLINE Block philox(std::uint64_t seed, std::uint32_t episode, Stream stream,
                              std::uint32_t step, std::uint32_t index) {
  const NoiseKey key{seed, episode};
  std::uint32_t word[4][1];
  philox_lanes<1>(&key, stream, &step, index, word);
  return {{word[0][0], word[1][0], word[2][0], word[3][0]}};
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

/// Each robot's network has its own stream of action noise.
BOTSCHOOL_INLINE NoiseKey robot_key(NoiseKey key, int robot) {
  return {key.seed + (static_cast<std::uint64_t>(robot) << 48), key.episode};
}

/// Two independent standard Gaussians from 48 of 64 bits: enough for sensor noise, and cheap.
template <class T>
BOTSCHOOL_INLINE void gaussian_pair(std::uint32_t a, std::uint32_t b, T& first, T& second) {
  const T scale = T(1) / T(16777216);
  const T u = (static_cast<T>(static_cast<std::int32_t>(a >> 8)) + T(0.5)) * scale;
  const T turn = static_cast<T>(static_cast<std::int32_t>(b >> 8)) * scale;
  T sine, cosine;
  sine_cosine(T(2 * kPi) * turn, sine, cosine);
  const T length = std::sqrt(T(-2) * logarithm(u));
  first = length * cosine;
  second = length * sine;
}

/// Draws one after another, for code that draws seldom (the start of an episode).
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t episode, Stream stream)
      : seed_(seed), episode_(episode), stream_(stream) {}
  double uniform(double low, double high) {
    const Block block = next();
    return low + (high - low) * uniform_of(block.word[0], block.word[1]);
  }
  double gaussian() { return gaussian_of(next()); }
  NoiseKey key() const { return {seed_, episode_}; }

 private:
  Block next() { return philox(seed_, episode_, stream_, 0, index_++); }

  std::uint64_t seed_;
  std::uint32_t episode_, index_ = 0;
  Stream stream_;
};

BOTSCHOOL_END
