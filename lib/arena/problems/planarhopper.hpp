// A hopper that should run ahead on one leg. Version 0 has Gymnasium's reward, version 5 rewards
// only progress. docs/specification.md, "Planar runners".
#pragma once

#include "../robots/jointed/runner.hpp"

BOTSCHOOL_BEGIN

constexpr Race hopper_race(bool standard) {
  Race race{0.008, 8, 0.005};
  race.alive = standard ? 1 : 0;
  race.effort = standard ? 0.001 : 0;
  race.lowest = 0.7;
  race.lean = 0.2;
  return race;
}
inline constexpr Race kHopperRace0 = hopper_race(true), kHopperRace5 = hopper_race(false);

template <int L>
struct PlanarHopper0 : Runner<Hopper, L> {
  PlanarHopper0() : Runner<Hopper, L>(kHopperRace0) {}
  static Info info() { return PlanarHopper0::describe("PlanarHopper-v0", kHopperRace0); }
};

template <int L>
struct PlanarHopper5 : Runner<Hopper, L> {
  PlanarHopper5() : Runner<Hopper, L>(kHopperRace5) {}
  static Info info() { return PlanarHopper5::describe("PlanarHopper-v5", kHopperRace5); }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarHopper0)
BOTSCHOOL_PROBLEM(PlanarHopper5)
