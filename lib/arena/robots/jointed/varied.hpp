// What differs from episode to episode in a race of jointed bodies: docs/specification.md, "Physics in
// numbers".
#pragma once

#include "../../engine/problem.hpp"
#include "solid.hpp"
#include "terrain.hpp"

BOTSCHOOL_BEGIN

constexpr double kPushEach = 1, kPushLasts = 0.1;  ///< seconds: one push in each of the first

template <int L>
struct Varied {
  Physics physics;
  double share[kKinds][L];
  double phase[kPhases][L];  ///< of the ground's bumps
  double seconds;            ///< of a step

  /// Whether numbers of equations differ from the body's own.
  bool any() const { return !physics.plain(); }

  void start(int lane, NoiseKey key) {
    Random random(key.seed, key.episode, Stream::vary);
    for (int k = 0; k < kKinds; ++k) {
      const Span& span = physics.of[k];
      const bool whole = k == kDelay;
      share[k][lane] = random.uniform(span.low, whole ? span.high + 1 : span.high);
      if (whole) share[k][lane] = limited(floor_of(share[k][lane]), span.low, span.high);
    }
    if (!physics.is(kDelay, 0))
      for (auto& ago : told_)
        for (auto& row : ago) row[lane] = 0;
    key_[lane] = key;
    step_[lane] = 0;
  }

  /// The action of a motor, or that of some steps before.
  double arrived(int lane, int motor, double action) {
    if (physics.is(kDelay, 0)) return action;
    const int now = step_[lane] % (kLatest + 1), late = static_cast<int>(share[kDelay][lane]);
    told_[now][motor][lane] = action;
    return told_[(now + kLatest + 1 - late) % (kLatest + 1)][motor][lane];
  }

  /// A row of the state with Gaussian noise; deviation: at a noise of 0.02.
  double seen(int lane, int row, double value, double deviation) const {
    if (physics.is(kNoise, 0)) return value;
    return value + deviation * (50 * share[kNoise][lane]) *
                       gaussian_of(philox(key_[lane].seed, key_[lane].episode, Stream::sensor,
                                          step_[lane], std::uint32_t(row)));
  }

  /// The phase of a wave of bumps, for bodies whose start draws none.
  double any_phase(int lane, int k) const {
    const Block block = philox(key_[lane].seed, key_[lane].episode, Stream::vary, 1000, k);
    return kPi * (2 * uniform_of(block.word[0], block.word[1]) - 1);
  }

  bool pushes() const { return !physics.is(kPush, 0); }
  /// How much a push changes the speed of a body of this mass in this step: ahead, and to the left; in a
  /// plane all of it goes ahead or back.
  void push(int lane, double mass, bool plane, double& ahead, double& left) const {
    const auto slot = static_cast<std::uint32_t>(kPushEach / seconds + 0.5);
    const std::uint32_t which = step_[lane] / slot;
    const Block block = philox(key_[lane].seed, key_[lane].episode, Stream::event, which, 0);
    const double begins = uniform_of(block.word[0], block.word[1]) * (kPushEach - kPushLasts);
    const double at = (step_[lane] - which * slot) * seconds - begins;
    const bool on = at >= 0 && at < kPushLasts;
    const double size = on ? share[kPush][lane] * seconds / (mass * share[kMass][lane]) : 0;
    const double turn = uniform_of(block.word[2], block.word[3]);
    double sine, cosine;
    sine_cosine(2 * kPi * turn, sine, cosine);
    ahead = size * (plane ? (turn < 0.5 ? 1 : -1) : cosine);
    left = plane ? 0 : size * sine;
  }

  /// The ground of W lanes from `first` on; x, y: where their points' coordinates begin.
  template <class V>
  void lay(Terrain<V>& terrain, int first, V x, V y) const {
    terrain.flat = physics.flat();
    if (terrain.flat) return;
    terrain.x = x;
    terrain.y = y;
    const auto lanes = [&](int kind) { return &share[kind][first]; };
    terrain.shape(lanes(kSlope), lanes(kStep), lanes(kBumps), lanes(kStairs));
    for (int k = 0; k < kPhases; ++k) terrain.phase[k] = V::from(&phase[k][first]);
  }

  void next() {
    for (auto& step : step_) ++step;
  }

 private:
  double told_[kLatest + 1][kMaxLinks][L];
  NoiseKey key_[L];
  std::uint32_t step_[L];
};

BOTSCHOOL_END
