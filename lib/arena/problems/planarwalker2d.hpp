// A walker that should run ahead on two legs. Version 0 has Gymnasium's reward, version 5 rewards
// only progress. docs/specification.md, "Planar runners".
#pragma once

#include "../robots/jointed/runner.hpp"

BOTSCHOOL_BEGIN

constexpr Race walker_race(bool standard) {
  Race race{0.008, 16, 0.005};
  race.alive = standard ? 1 : 0;
  race.effort = standard ? 0.001 : 0;
  race.lowest = 0.8;
  race.highest = 2;
  race.lean = 1;
  return race;
}
inline constexpr Race kWalker2DRace0 = walker_race(true), kWalker2DRace5 = walker_race(false);

template <int L>
struct PlanarWalker2D0 : Runner<Walker2D, L> {
  PlanarWalker2D0() : Runner<Walker2D, L>(kWalker2DRace0) {}
  static Info info() { return PlanarWalker2D0::describe("PlanarWalker2D-v0", kWalker2DRace0); }
};

template <int L>
struct PlanarWalker2D5 : Runner<Walker2D, L> {
  PlanarWalker2D5() : Runner<Walker2D, L>(kWalker2DRace5) {}
  static Info info() { return PlanarWalker2D5::describe("PlanarWalker2D-v5", kWalker2DRace5); }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarWalker2D0)
BOTSCHOOL_PROBLEM(PlanarWalker2D5)
