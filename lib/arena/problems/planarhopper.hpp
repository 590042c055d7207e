// A hopper that is to run ahead on one leg. Version 0 is paid as in Gymnasium, version 5 for progress
// alone. docs/specification.md, "Planar runners".
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

template <int L>
struct PlanarHopper0 : Runner<Hopper, L> {
  static constexpr Race race = hopper_race(true);
  static Info info() { return Runner<Hopper, L>::describe("PlanarHopper-v0", race); }
  void start(int lane, Random& random) { this->begin(lane, random, race); }
  void step(const double* action, double* reward, std::int64_t* ended) {
    this->run(race, action, reward, ended);
  }
};

template <int L>
struct PlanarHopper5 : Runner<Hopper, L> {
  static constexpr Race race = hopper_race(false);
  static Info info() { return Runner<Hopper, L>::describe("PlanarHopper-v5", race); }
  void start(int lane, Random& random) { this->begin(lane, random, race); }
  void step(const double* action, double* reward, std::int64_t* ended) {
    this->run(race, action, reward, ended);
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarHopper0)
BOTSCHOOL_PROBLEM(PlanarHopper5)
