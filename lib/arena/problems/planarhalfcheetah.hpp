// Half a cheetah that is to run ahead. Version 0 is paid as in Gymnasium; version 5 for progress, with
// a price on hinges at their limits, and it ends when the body falls. docs/specification.md, "Planar runners".
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

template <int L>
struct PlanarHalfCheetah0 : Runner<HalfCheetah, L> {
  static constexpr Race race = cheetah_race(true);
  static Info info() { return Runner<HalfCheetah, L>::describe("PlanarHalfCheetah-v0", race); }
  void start(int lane, Random& random) { this->begin(lane, random, race); }
  void step(const double* action, double* reward, std::int64_t* ended) {
    this->run(race, action, reward, ended);
  }
};

template <int L>
struct PlanarHalfCheetah5 : Runner<HalfCheetah, L> {
  static constexpr Race race = cheetah_race(false);
  static Info info() { return Runner<HalfCheetah, L>::describe("PlanarHalfCheetah-v5", race); }
  void start(int lane, Random& random) { this->begin(lane, random, race); }
  void step(const double* action, double* reward, std::int64_t* ended) {
    this->run(race, action, reward, ended);
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(PlanarHalfCheetah0)
BOTSCHOOL_PROBLEM(PlanarHalfCheetah5)
