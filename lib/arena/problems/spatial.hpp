// An ant and a humanoid that should run ahead, and a humanoid that should stand up, in space. Version 0
// has Gymnasium's reward, version 5 rewards only progress. docs/specification.md, "Bodies in space".
#pragma once

#include "../robots/jointed/racer.hpp"

BOTSCHOOL_BEGIN

constexpr Course ant_course(bool standard) {
  Course course{&kAnt, 0.05, 10, 0.75, 0.1, true, 0.2, 1.0};
  course.alive = standard ? 1 : 0;
  course.effort = standard ? 0.5 : 0;
  return course;
}

constexpr Course humanoid_course(bool standard) {
  Course course{&kHumanoid, 0.015, 5, 1.4, 0.01, false, 1.0, 2.0, 0.4};
  course.centre = standard;
  course.ahead = standard ? 1.25 : 1;
  course.alive = standard ? 5 : 0;
  course.effort = standard ? 0.1 : 0;
  return course;
}

constexpr Course standup_course() {
  Course course{&kHumanoidStandup, 0.015, 5, 0.105, 0.01, false, -1e9, 1e9, 0.4};
  course.ahead = 0;
  course.alive = 1;
  course.effort = 0.1;
  course.lift = 1 / 0.003;  // Gymnasium divides by the seconds of a substep
  return course;
}

inline constexpr Course kAntCourse0 = ant_course(true), kAntCourse5 = ant_course(false),
                        kHumanoidCourse0 = humanoid_course(true),
                        kHumanoidCourse5 = humanoid_course(false),
                        kStandupCourse = standup_course();

template <int L>
struct SpatialAnt0 : Racer<L> {
  SpatialAnt0() : Racer<L>(kAntCourse0) {}
  static Info info() { return SpatialAnt0::describe("SpatialAnt-v0", kAntCourse0); }
};

template <int L>
struct SpatialAnt5 : Racer<L> {
  SpatialAnt5() : Racer<L>(kAntCourse5) {}
  static Info info() { return SpatialAnt5::describe("SpatialAnt-v5", kAntCourse5); }
};

template <int L>
struct SpatialHumanoid0 : Racer<L> {
  SpatialHumanoid0() : Racer<L>(kHumanoidCourse0) {}
  static Info info() { return SpatialHumanoid0::describe("SpatialHumanoid-v0", kHumanoidCourse0); }
};

template <int L>
struct SpatialHumanoid5 : Racer<L> {
  SpatialHumanoid5() : Racer<L>(kHumanoidCourse5) {}
  static Info info() { return SpatialHumanoid5::describe("SpatialHumanoid-v5", kHumanoidCourse5); }
};

template <int L>
struct SpatialStandup : Racer<L> {
  SpatialStandup() : Racer<L>(kStandupCourse) {}
  static Info info() {
    return SpatialStandup::describe("SpatialHumanoidStandup-v0", kStandupCourse);
  }
};

/// A body that its user declares; the ant where nothing is declared.
template <int L>
struct SpatialBodyRace : Racer<L> {
  SpatialBodyRace() : Racer<L>(kAntCourse5) {}
  static Info info() { return SpatialBodyRace::describe("SpatialBody-v0", kAntCourse5); }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(SpatialAnt0)
BOTSCHOOL_PROBLEM(SpatialAnt5)
BOTSCHOOL_PROBLEM(SpatialHumanoid0)
BOTSCHOOL_PROBLEM(SpatialHumanoid5)
BOTSCHOOL_PROBLEM(SpatialStandup)
BOTSCHOOL_PROBLEM(SpatialBodyRace)
