// Random numbers: the vectors that the generator's authors publish (Random123), and statistics.
#include "evonet/philox.hpp"

#include <cmath>
#include <set>

#include "check.hpp"

using namespace botschool;

namespace {

bool gives(std::uint64_t key, const std::uint32_t (&counter)[4], const std::uint32_t (&word)[4]) {
  const Block block =
      philox(key, counter[3], static_cast<Stream>(counter[2]), counter[1], counter[0]);
  for (int i = 0; i < 4; ++i)
    if (block.word[i] != word[i]) return false;
  return true;
}

}  // namespace

TEST(philox_known_answers) {
  CHECK(gives(0, {0, 0, 0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  CHECK(gives(0xffffffffffffffff, {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
              {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  CHECK(gives(0x299f31d0a4093822, {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
              {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(uniform_numbers_are_in_range) {
  CHECK(uniform_of(0, 0) == 0);
  CHECK(uniform_of(0xffffffff, 0xffffffff) < 1);
  CHECK(uniform_of(0x80000000, 0) == 0.5);
  Random random(1, 2, Stream::start);
  double sum = 0, squares = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(-3, 5);
    CHECK(x >= -3 && x < 5);
    sum += x;
    squares += (x - 1) * (x - 1);
  }
  CHECK(std::fabs(sum / n - 1) < 5 * std::sqrt(64.0 / 12 / n));
  CHECK(std::fabs(squares / n - 64.0 / 12) < 0.1);
}

TEST(gaussian_numbers_are_gaussian) {
  Random random(1, 2, Stream::weights);
  double sum = 0, squares = 0, fourth = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double x = random.gaussian();
    CHECK(std::isfinite(x) && std::fabs(x) < 9);
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
  }
  CHECK(std::fabs(sum / n) < 5 / std::sqrt(n));
  CHECK(std::fabs(squares / n - 1) < 5 * std::sqrt(2.0 / n));
  CHECK(std::fabs(fourth / n - 3) < 5 * std::sqrt(96.0 / n));
  CHECK(gaussian_of({{0xffffffff, 0xffffffff, 0, 0}}) > 7);
  CHECK(gaussian_of({{0, 0, 0, 0}}) == 0);
}

TEST(streams_seeds_and_episodes_share_nothing) {
  std::set<double> drawn;
  int draws = 0;
  for (std::uint64_t seed : {0ull, 1ull, 1ull << 32, ~0ull})
    for (std::uint32_t episode : {0u, 1u, ~0u})
      for (Stream stream : {Stream::start, Stream::action, Stream::sensor, Stream::weights}) {
        Random random(seed, episode, stream);
        for (int i = 0; i < 20; ++i, ++draws) drawn.insert(random.uniform(0, 1));
      }
  CHECK(static_cast<int>(drawn.size()) == draws);
}
