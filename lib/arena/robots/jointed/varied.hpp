// What differs from episode to episode in a race of jointed bodies: docs/specification.md, "Bodies in
// space".
#pragma once

#include "../../engine/problem.hpp"
#include "solid.hpp"

BOTSCHOOL_BEGIN

/// Factors that are drawn for an episode.
enum Share { kFirmness, kFriction, kMass, kMotors, kShares };

template <int L>
struct Varied {
  Vary vary;
  double share[kShares][L];

  bool any() const { return vary.ground || vary.mass || vary.motors; }

  void start(int lane, NoiseKey key) {
    Random random(key.seed, key.episode, Stream::vary);
    const auto draw = [&](bool varies, double low, double high) {
      const double drawn = random.uniform(low, high);
      return varies ? drawn : 1.0;
    };
    share[kFirmness][lane] = draw(vary.ground, 0.5, 2);
    share[kFriction][lane] = draw(vary.ground, 0.6, 1.2);
    share[kMass][lane] = draw(vary.mass, 0.8, 1.25);
    share[kMotors][lane] = draw(vary.motors, 0.8, 1.25);
    late_[lane] = draw(vary.delay, 0, 2) >= 1 && vary.delay;
    for (auto& row : before_) row[lane] = 0;
    key_[lane] = key;
    step_[lane] = 0;
  }

  /// The action of a motor, or in some episodes that of the step before.
  double arrived(int lane, int motor, double action) {
    if (!vary.delay) return action;
    const double given = late_[lane] ? before_[motor][lane] : action;
    before_[motor][lane] = action;
    return given;
  }

  /// A row of the state with Gaussian noise.
  double seen(int lane, int row, double value, double deviation) const {
    if (!vary.noise) return value;
    return value + deviation * gaussian_of(philox(key_[lane].seed, key_[lane].episode,
                                                  Stream::sensor, step_[lane], std::uint32_t(row)));
  }

  void next() {
    for (auto& step : step_) ++step;
  }

 private:
  bool late_[L];
  double before_[kMaxLinks][L];
  NoiseKey key_[L];
  std::uint32_t step_[L];
};

BOTSCHOOL_END
