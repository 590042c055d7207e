// Sums by rows: exactly those of a plain loop, whoever shares a network; and whole episodes with
// networks that are large enough for them.
#include "evonet/rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "arena/engine/engine.hpp"
#include "check.hpp"
#include "evonet/philox.hpp"

using namespace botschool;

namespace {

constexpr int kLanes = 16;

Spec large(int architecture, int nhiddens, int bias) {
  Spec spec;
  spec.inputs = 24;
  spec.outputs = 2;
  spec.nhiddens = nhiddens;
  spec.architecture = architecture;
  spec.bias = bias;
  return spec;
}

std::vector<float> numbers(std::size_t count, std::uint32_t index) {
  Random random(7, index, Stream::start);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(random.gaussian());
  return values;
}

/// The sum of one receiver in one lane, as the order of additions is defined.
float plain_sum(const Layer& layer, const double* genotype, int row, const float* now,
                const float* before, int lane) {
  float total = 0;
  if (layer.bias >= 0) total += static_cast<float>(genotype[layer.bias + row]);
  for (int b = 0; b < layer.blocks; ++b) {
    const Connections& c = layer.block[b];
    for (int s = 0; s < c.senders; ++s) {
      const double weight = genotype[c.weights + row * c.stride + c.offset + s];
      total +=
          static_cast<float>(weight) * (c.previous ? before : now)[(c.sender + s) * kLanes + lane];
    }
  }
  return total;
}

/// Bit for bit, but for the kind of NaN.
bool same(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

/// Lanes have networks as given, -1 for idle ones.
Groups<kLanes> grouped(const std::vector<int>& network_of, const bool* finite) {
  Groups<kLanes> groups;
  int used = 0;
  for (int n = kLanes - 1; n >= 0; --n) {
    if (std::find(network_of.begin(), network_of.end(), n) == network_of.end()) continue;
    groups.network[groups.count] = n;
    groups.finite[groups.count] = finite[n];
    groups.first[groups.count++] = used;
    for (int l = 0; l < kLanes; ++l)
      if (network_of[l] == n) groups.lane[used++] = l;
  }
  groups.first[groups.count] = used;
  return groups;
}

void check_layer(const Layout& layout, const Layer& layer, const std::vector<int>& network_of) {
  using By = Rows<float, kLanes>;
  const int rows = By::of(layer);
  CHECK(rows > 0 && rows <= layer.neurons);
  std::vector<double> genotypes(kLanes * layout.parameters);
  const std::vector<float> drawn = numbers(genotypes.size(), 0);
  std::copy(drawn.begin(), drawn.end(), genotypes.begin());
  // a network of wild numbers; observations that are often 0, in all lanes or in some
  genotypes[4 * layout.parameters + layer.block[0].weights] = HUGE_VAL;
  std::vector<float> now = numbers(layout.neurons * kLanes, 1);
  for (std::size_t i = 0; i < now.size(); ++i)
    if (i / kLanes % 3 == 0 || i % 5 == 0) now[i] = i % 2 ? 0.0f : -0.0f;
  const std::vector<float> before = numbers(layout.neurons * kLanes, 2);
  std::vector<float> networks(kLanes * By::size(layer)), scratch(rows * kLanes), out(rows * kLanes);
  bool finite[kLanes];
  for (int n = 0; n < kLanes; ++n)
    finite[n] = By::pack(layer, &genotypes[n * layout.parameters], &networks[n * By::size(layer)]);
  for (int n = 0; n < kLanes; ++n) CHECK(finite[n] == (n != 4));
  By(layer, now.data(), before.data(), scratch.data())
      .sums(grouped(network_of, finite), networks.data(), By::size(layer), out.data());
  for (int l = 0; l < kLanes; ++l) {
    if (network_of[l] < 0) continue;
    const double* own = &genotypes[network_of[l] * layout.parameters];
    for (int r = 0; r < rows; ++r)
      CHECK(same(out[r * kLanes + l], plain_sum(layer, own, r, now.data(), before.data(), l)));
  }
}

}  // namespace

TEST(sums_by_rows_are_those_of_a_plain_loop) {
  const std::vector<std::vector<int>> groupings{
      {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
      {3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
      {0, 1, 0, 1, 5, 5, 5, 15, 15, 15, 15, 15, 2, 0, 0, 0},
      {-1, 4, -1, 4, 4, -1, -1, 0, -1, -1, -1, -1, -1, -1, -1, -1},
      {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1}};
  for (const auto& network_of : groupings)
    for (int bias : {0, 1}) {
      for (int nhiddens : {25, 16, 21}) {
        const Layout gated = make_layout(large(lstm, nhiddens, bias));
        check_layer(gated, gated.gates, network_of);
      }
      const Layout plain = make_layout(large(recurrent, 70, bias));
      check_layer(plain, plain.layer[0], network_of);
    }
}

TEST(small_layers_are_not_summed_by_rows) {
  const Layout layout = make_layout(large(lstm, 5, 1));
  CHECK((Rows<float, kLanes>::of(layout.gates) == 0));
  CHECK((Rows<double, 1>::of(make_layout(large(lstm, 25, 1)).gates) == 0));
}

TEST(a_square_is_turned) {
  LanesOf<float, 8> rows[8];
  float values[64];
  std::iota(values, values + 64, 0.0f);
  std::memcpy(rows, values, sizeof rows);
  transpose<float, 8>(rows);
  std::memcpy(values, rows, sizeof rows);
  for (int i = 0; i < 64; ++i) CHECK(values[i] == i % 8 * 8 + i / 8);
}

TEST(who_meets_whom_leaves_the_bits_as_they_are) {
  constexpr int kJobs = 60, kNetworks = 8;
  for (int architecture : {int(lstm), int(recurrent), int(fully_recurrent)}) {
    const Spec spec = large(architecture, architecture == lstm ? 25 : 50, 1);
    const Layout layout = make_layout(spec);
    std::vector<double> genotypes(kNetworks * layout.parameters);
    for (int n = 0; n < kNetworks; ++n)
      initial_parameters(layout, 3, n, &genotypes[n * layout.parameters]);
    const std::vector<std::uint64_t> seed(kJobs, 1);
    const std::vector<std::uint32_t> episode(kJobs, 0);
    const auto run = [&](const std::string& isa, int count, const std::int32_t* pairs, int threads,
                         double* fitness, std::int32_t* steps) {
      const Engine engine("ErPredprey", spec, isa);
      const Jobs jobs{genotypes.data(),
                      std::size_t(layout.parameters),
                      nullptr,
                      std::size_t(count),
                      pairs,
                      0,
                      seed.data(),
                      episode.data(),
                      nullptr,
                      {300},
                      fitness,
                      steps,
                      nullptr};
      engine.evaluate(jobs, threads);
    };
    // all against all in some order, and again
    std::vector<std::int32_t> pairs(2 * kJobs), steps(kJobs), own_steps(kJobs);
    std::vector<double> fitness(kJobs), own(kJobs);
    for (int j = 0; j < kJobs; ++j) {
      pairs[j] = j * 11 / 3 % kNetworks;
      pairs[kJobs + j] = j * 7 / 2 % kNetworks;
    }
    for (int j = 0; j < kJobs; ++j) {
      const std::int32_t pair[]{pairs[j], pairs[kJobs + j]};
      run("baseline", 1, pair, 1, &own[j], &own_steps[j]);
    }
    for (const std::string& isa : instruction_sets())
      for (int threads : {1, 3}) {
        run(isa, kJobs, pairs.data(), threads, fitness.data(), steps.data());
        CHECK(fitness == own && steps == own_steps);
      }
  }
}
