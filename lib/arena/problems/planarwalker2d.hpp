// A walker that is to run ahead on two legs. Version 0 is paid as in Gymnasium, version 5 for progress
// alone. docs/specification.md, "Planar runners".
#pragma once

#include "../robots/jointed/runner.hpp"

BOTSCHOOL_BEGIN

constexpr Race walker_race(bool standard) {
  Race race{0.008, 8, 0.005};
  race.alive = standard ? 1 : 0;
  race.effort = standard ? 0.001 : 0;
  race.lowest = 0.8;
  race.highest = 2;
  race.lean = 1;
  return race;
}

template <int L>
struct PlanarWalker2D0 : Runner<Walker2D, L> {
  static constexpr Race race = walker_race(true);
  static Info info() { return Runner<Walker2D, L>::describe("PlanarWalker2D-v0", race); }
  void start(int lane, Random& random) { this->begin(lane, random, race); }
  void step(const double* action, double* reward, std::int64_t* ended) {
    this->run(race, action, reward, ended);
  }
};

template <int L>
struct PlanarWalker2D5 : Runner<Walker2D, L> {
  static constexpr Race race = walker_race(false);
  static Info info() { return Runner<Walker2D, L>::describe("PlanarWalker2D-v5", race); }
  void start(int lane, Random& random) { this->begin(lane, random, race); }
  void step(const double* action, double* reward, std::int64_t* ended) {
    this->run(race, action, reward, ended);
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarWalker2D0)
BOTSCHOOL_PROBLEM(PlanarWalker2D5)
