// Half a cheetah that should run ahead. Version 0 has Gymnasium's reward. Version 5 rewards
// progress, with a price on hinges at their limits, and ends when the body falls.
// docs/specification.md, "Planar runners".
#pragma once

#include "../robots/jointed/runner.hpp"

BOTSCHOOL_BEGIN

constexpr Race cheetah_race(bool standard) {
  Race race{0.05, 25, 0.1};
  if (standard) {
    race.effort = 0.1;
  } else {
    race.at_limit = 0.1;
    race.lean = 1;
    race.feet = 4;
  }
  return race;
}
inline constexpr Race kHalfCheetahRace0 = cheetah_race(true),
                      kHalfCheetahRace5 = cheetah_race(false);

template <int L>
struct PlanarHalfCheetah0 : Runner<HalfCheetah, L> {
  PlanarHalfCheetah0() : Runner<HalfCheetah, L>(kHalfCheetahRace0) {}
  static Info info() {
    return PlanarHalfCheetah0::describe("PlanarHalfCheetah-v0", kHalfCheetahRace0);
  }
};

template <int L>
struct PlanarHalfCheetah5 : Runner<HalfCheetah, L> {
  PlanarHalfCheetah5() : Runner<HalfCheetah, L>(kHalfCheetahRace5) {}
  static Info info() {
    return PlanarHalfCheetah5::describe("PlanarHalfCheetah-v5", kHalfCheetahRace5);
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarHalfCheetah0)
BOTSCHOOL_PROBLEM(PlanarHalfCheetah5)
