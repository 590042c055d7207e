// Tables that describe jointed bodies in space. Metres, kilograms, seconds; x ahead, z up.
//
// A body is a tree of links. Each has a frame of its own: its origin lies on the hinge to its
// parent, and when all hinges are at angle 0 and the root is not turned, all frames have the world's
// axes. The first link is the root, which moves freely or is fixed to the world. A link turns about
// its axis or slides along it. Links without mass make a joint of several hinges.
#pragma once

#include "table.hpp"

namespace botschool {

/// The most that a body has.
constexpr int kMaxLinks = 64, kMaxBalls = 256, kMaxPairs = 64;

struct Place {
  double x, y, z;
};

/// A motor that follows a target: at angle q and speed u its torque is
/// still + up a (down a for a < 0) - pull q - drag u, within least to most.
struct Drive {
  double still = 0, up = 0, down = 0, pull = 0, drag = 0, least = 0, most = 0;
};

struct Link {
  const char* name;
  int parent;   ///< -1 for the root; parents come first
  Place place;  ///< of its origin in the parent's frame
  Place axis;   ///< of the hinge, a unit vector
  Hinge hinge;
  int motor;  ///< number of the action that moves the hinge, or -1
  double mass;
  Place centre;       ///< of mass
  double inertia[6];  ///< about it: xx, yy, zz, xy, xz, yz
  Drive drive = {};
  double rest = 0, dry = 0;  ///< angle at which its spring rests; torque of dry friction
  bool slides = false;
};

/// A capsule on a link: its middle, half of its axis, its radius. A ball has no axis.
struct Shape {
  int link;
  Place place, half;
  double radius;
  const char* name = "";
};

/// Numbers of two shapes that touch each other.
struct Pair {
  int one, other;
};

/// How ground and hinges answer: docs/specification.md, "Bodies in space".
struct Firmness {
  double friction = 1;                    ///< Coulomb's coefficient
  double stiffness = 40000;               ///< N/m, across the ground and along it
  double damping = 800;                   ///< N s/m
  double limit = 10000, stopping = 1000;  ///< beyond a hinge's limit: N m/rad, N m s/rad
};

/// A table, and how many rows its parts have.
struct Solid {
  const char* name;
  const Link* link;
  const Shape* shape;
  const Pair* pair;
  int links, shapes, pairs, motors;
  double margin;  ///< added to the radius of what touches the ground
  Firmness firm;
  bool fixed = false;  ///< whether the root stays where it is
  bool soft = false;   ///< whether limits of hinges answer as MuJoCo's do
};

/// The reward of a body in space, and the ends of its episode.
struct Course {
  const Solid* solid;
  double seconds;                ///< of a step
  int substeps;                  ///< in a step
  double height;                 ///< of the root's origin at the start
  double noise;                  ///< start: coordinates are uniform within +-noise of the rest
  bool gaussian;                 ///< whether speeds are Gaussian, with sd noise, or uniform, too
  double low, high;              ///< height of the root, beyond which an episode ends
  double range = 1;              ///< largest action
  double ahead = 1;              ///< paid for each m/s
  bool centre = false;           ///< of the centre of mass, or of the root
  double alive = 0;              ///< paid for each step without a fall
  double effort = 0;             ///< price of the sum of squared actions
  double lift = 0;               ///< paid for each metre of height
  const double* pose = nullptr;  ///< start: quaternion and angles; null: not turned, all at 0
};

#ifdef __wasm__  // the core of a page, whose races have no options
#define BOTSCHOOL_OPTION static constexpr
#else
#define BOTSCHOOL_OPTION
#endif

/// Numbers of the world of an episode, in the order in which they are drawn: factors of the body's own
/// up to kMotors, then steps, radians, m/s^2 (below 0: the body's own), newtons, and the ground's shape:
/// it rises by kSlope with each metre ahead, by kStep (m) at x = 2, has bumps up to a height, in each
/// episode others, and from x = 2 on stairs of a height. docs/specification.md, "Physics in numbers".
enum Kind {
  kFirmness,
  kFriction,
  kMass,
  kMotors,
  kDelay,
  kNoise,
  kPull,
  kPush,
  kSlope,
  kStep,
  kBumps,
  kStairs,
  kKinds
};
/// The longest delay, in steps.
constexpr int kLatest = 5;

struct Span {
  double low, high;
};
struct Physics {
  BOTSCHOOL_OPTION Span of[kKinds] = {{1, 1},   {1, 1}, {1, 1}, {1, 1}, {0, 0}, {0, 0},
                                      {-1, -1}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}};
  constexpr bool is(Kind kind, double value) const {
    return of[kind].low == value && of[kind].high == value;
  }
  constexpr bool flat() const {
    return is(kSlope, 0) && is(kStep, 0) && is(kBumps, 0) && is(kStairs, 0);
  }
  /// Whether lanes differ in what their equations hold.
  constexpr bool plain() const {
    return is(kFirmness, 1) && is(kFriction, 1) && is(kMass, 1) && is(kMotors, 1) && is(kPull, -1);
  }
};

/// The shape of the ground, of a single body.
struct Ground {
  double slope = 0, step = 0, bumps = 0, stairs = 0;
};

/// What the user may choose about a race of jointed bodies.
struct SpaceOptions {
  const Course* course = nullptr;  ///< of a declared body, or null: the problem's own
  Physics physics;
};

}  // namespace botschool

BOTSCHOOL_BEGIN

/// A ball at an end of a shape, which touches the ground.
struct Ball {
  int link;
  Place place;
  double radius;
  const char* name;
};

/// The balls of a body, less those inside others.
struct Balls {
  int count = 0;
  bool full = false;  ///< whether there are more
  Ball ball[kMaxBalls];

  explicit Balls(const Solid& solid) {
    for (int s = 0; s < solid.shapes; ++s) {
      const Shape& shape = solid.shape[s];
      const Place &p = shape.place, &h = shape.half;
      const double radius = shape.radius + solid.margin;
      const bool wheel = square(h) == 0;
      add(solid, {shape.link, {p.x - h.x, p.y - h.y, p.z - h.z}, radius, shape.name}, wheel);
      add(solid, {shape.link, {p.x + h.x, p.y + h.y, p.z + h.z}, radius, shape.name}, wheel);
    }
  }

 private:
  static double square(const Place& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }

  static bool inside(const Ball& a, const Ball& b) {
    const double more = b.radius - a.radius + 1e-9;
    const Place &p = a.place, &q = b.place;
    return a.link == b.link && more > 0 && square({p.x - q.x, p.y - q.y, p.z - q.z}) <= more * more;
  }

  void add(const Solid& solid, Ball next, bool wheel) {
    // an end on the hinge belongs to the parent as well; a ball of its own there is a wheel
    while (next.link > 0 && square(next.place) < 1e-12 && !wheel) {
      next.place = solid.link[next.link].place;
      next.link = solid.link[next.link].parent;
    }
    for (int i = 0; i < count; ++i)
      if (inside(next, ball[i])) return;
    int kept = 0;
    for (int i = 0; i < count; ++i)
      if (!inside(ball[i], next)) ball[kept++] = ball[i];
    count = kept;
    if (count < kMaxBalls)
      ball[count++] = next;
    else
      full = true;
  }
};

BOTSCHOOL_END
