// Bodies that run in a plane: sizes, masses, hinges and motors of Gymnasium's models for MuJoCo.
#pragma once

#include <array>
#include <cstddef>

#include "table.hpp"

BOTSCHOOL_BEGIN

constexpr double degrees(double angle) { return angle * (kPi / 180); }

/// One leg.
struct Hopper : BodyBase {
  static constexpr const char* name = "hopper";
  static constexpr double up = kPi / 2;
  static constexpr Segment segments[]{
      {"torso", -1, 0, 0, {}, {{0, 0, up, 0.2, 0.05}}},
      {"thigh", 0, 0, -0.2, {degrees(-150), 0, 200, 1, 0, 1}, {{0, -0.225, up, 0.225, 0.05}}},
      {"leg", 1, 0, -0.45, {degrees(-150), 0, 200, 1, 0, 1}, {{0, -0.25, up, 0.25, 0.04}}},
      {"foot", 2, 0, -0.5, {degrees(-45), degrees(45), 200, 1, 0, 1}, {{0.065, 0, 0, 0.195, 0.06}}},
  };
  static constexpr Contact contacts[]{{3, -0.13, 0, 0.06}, {3, 0.26, 0, 0.06}};
  static constexpr Touch touch{2.0};
  static constexpr Limit limit{4000, 80};
  static constexpr double start_height = 1.25;
};

/// Two legs.
struct Walker2D : BodyBase {
  static constexpr const char* name = "walker2d";
  static constexpr double up = kPi / 2;
  static constexpr Hinge long_hinge{degrees(-150), 0, 100, 0.1, 0, 0.01};
  static constexpr Hinge ankle{degrees(-45), degrees(45), 100, 0.1, 0, 0.01};
  static constexpr Capsule thigh{0, -0.225, up, 0.225, 0.05}, leg{0, -0.25, up, 0.25, 0.04},
      foot{0.1, 0, 0, 0.1, 0.06};
  static constexpr Segment segments[]{
      {"torso", -1, 0, 0, {}, {{0, 0, up, 0.2, 0.05}}},
      {"thigh", 0, 0, -0.2, long_hinge, {thigh}},
      {"leg", 1, 0, -0.45, long_hinge, {leg}},
      {"foot", 2, 0, -0.5, ankle, {foot}},
      {"left thigh", 0, 0, -0.2, long_hinge, {thigh}},
      {"left leg", 4, 0, -0.45, long_hinge, {leg}},
      {"left foot", 5, 0, -0.5, ankle, {foot}},
  };
  static constexpr Contact contacts[]{
      {3, 0, 0, 0.06}, {3, 0.2, 0, 0.06}, {6, 0, 0, 0.06}, {6, 0.2, 0, 0.06}};
  static constexpr Touch touch{1.9};
  static constexpr Limit limit{2000, 20};
  static constexpr double start_height = 1.25;
};

/// A trunk on two legs, one behind the other; springs in all hinges.
struct HalfCheetah : BodyBase {
  static constexpr const char* name = "halfcheetah";
  static constexpr double total_mass = 14;
  static constexpr double up = kPi / 2, r = 0.046;
  static constexpr Segment segments[]{
      {"torso", -1, 0, 0, {}, {{0, 0, 0, 0.5, r}, {0.6, 0.1, up - 0.87, 0.15, r}}},
      {"rear thigh",
       0,
       -0.5,
       0,
       {-1.05, 0.52, 120, 6, 240, 0.1},
       {{0.1, -0.13, up + 3.8, 0.145, r}}},
      {"rear shin",
       1,
       0.16,
       -0.25,
       {-0.785, 0.785, 90, 4.5, 180, 0.1},
       {{-0.14, -0.07, up + 2.03, 0.15, r}}},
      {"rear foot",
       2,
       -0.28,
       -0.14,
       {-0.785, 0.4, 60, 3, 120, 0.1},
       {{0.03, -0.097, up + 0.27, 0.094, r}}},
      {"front thigh",
       0,
       0.5,
       0,
       {-0.7, 1, 120, 4.5, 180, 0.1},
       {{-0.07, -0.12, up - 0.52, 0.133, r}}},
      {"front shin",
       4,
       -0.14,
       -0.24,
       {-0.87, 1.2, 60, 3, 120, 0.1},
       {{0.065, -0.09, up + 0.6, 0.106, r}}},
      {"front foot",
       5,
       0.13,
       -0.18,
       {-0.5, 0.5, 30, 1.5, 60, 0.1},
       {{0.045, -0.07, up + 0.6, 0.07, r}}},
  };
  // the ends of the feet, both knees, the ends of trunk and head
  static constexpr Contact contacts[]{
      {3, 0.0049, -0.0064, r},
      {3, 0.0551, -0.1876, r},
      {6, 0.0055, -0.0122, r},
      {6, 0.0845, -0.1278, r},
      {2, 0, 0, r},
      {5, 0, 0, r},
      {0, -0.5, 0, r},
      {0, 0.7147, 0.1967, r},
  };
  static constexpr Touch touch{0.4};
  static constexpr Limit limit{1000, 10};
  static constexpr double start_height = 0.7;
};

/// 0.4 m long and 0.1 m high; for tests.
struct Box : BodyBase {
  static constexpr bool uneven = true;
  static constexpr const char* name = "box";
  static constexpr Segment segments[]{{"box", -1, 0, 0, {}, {{0, 0, 0, 0.15, 0.05}}}};
  static constexpr Contact contacts[]{
      {0, -0.2, -0.05, 0}, {0, 0.2, -0.05, 0}, {0, 0.2, 0.05, 0}, {0, -0.2, 0.05, 0}};
  static constexpr Touch touch{0.5};
  static constexpr Limit limit{0, 0};
};

/// Another body hung up by its root's origin, without motors, dampers and limits; for tests.
template <class Body>
struct Hung : BodyBase {
  static constexpr bool pinned = true;
  static constexpr double total_mass = Body::total_mass, far = 1e9;
  static constexpr auto segments = [] {
    std::array<Segment, sizeof(Body::segments) / sizeof(Segment)> free{};
    for (std::size_t i = 0; i < free.size(); ++i) {
      free[i] = Body::segments[i];
      const Hinge& hinge = free[i].hinge;
      free[i].hinge = {-far, far, 0, 0, hinge.stiffness, hinge.armature};
    }
    return free;
  }();
  static constexpr auto& contacts = Body::contacts;
  static constexpr Touch touch = Body::touch;
  static constexpr Limit limit{0, 0};
};

struct HungHopper : Hung<Hopper> {
  static constexpr const char* name = "hung hopper";
};
struct HungWalker2D : Hung<Walker2D> {
  static constexpr const char* name = "hung walker2d";
};
struct HungHalfCheetah : Hung<HalfCheetah> {
  static constexpr const char* name = "hung halfcheetah";
};

BOTSCHOOL_END
