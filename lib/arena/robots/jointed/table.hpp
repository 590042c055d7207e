// Tables that describe planar jointed bodies, and what follows from them. Metres, kilograms, seconds;
// x ahead, z up, angles counter-clockwise from x to z.
//
// A body is a tree of segments. Each has a frame of its own: its origin lies on the hinge to its
// parent, and at angle 0 its axes equal the world's. The first segment is the root; its origin
// moves freely unless the body is `pinned`: then it hangs in the air and touches nothing.
#pragma once

#include "../../engine/problem.hpp"

namespace botschool {

/// Between a part of a body and its parent. The torque of a hinge at angle q with speed u is
/// torque * action - stiffness * q - damping * u, plus the torque of its limits.
struct Hinge {
  double low = 0, high = 0;  ///< limits of the angle
  double torque = 0;         ///< at an action of 1
  double damping = 0, stiffness = 0;
  double armature = 0;  ///< moment of inertia of the motor, which turns with the hinge
  double servo = 0;  ///< in space: the action is a speed (rad/s), and this, N m s/rad, times what
                     ///< is missing after the substep is the torque
};

constexpr double kGravity = 9.81;

}  // namespace botschool

BOTSCHOOL_BEGIN

/// A rod with round ends, of water's density: where its centre is in its segment's frame, the
/// direction of its axis, half its length without the ends, and its radius.
struct Capsule {
  double x = 0, z = 0, angle = 0, half = 0, radius = 0;
};

constexpr int kCapsules = 2;

struct Segment {
  const char* name;
  int parent;   ///< -1 for the root; parents come first
  double x, z;  ///< where the hinge is in the parent's frame
  Hinge hinge;
  Capsule capsule[kCapsules];
};

/// A ball on a segment that can touch the ground.
struct Contact {
  int segment;
  double x, z, radius;
};

/// How the ground answers: docs/specification.md, "Planar runners".
struct Touch {
  double friction;           ///< Coulomb's coefficient
  double stiffness = 30000;  ///< N/m
  double damping = 600;      ///< N s/m, from `ramp` on; less above
  double ramp = 0.001;       ///< depth, m
  double slip = 0.01;        ///< m/s; slower sliding has less than Coulomb's friction
};

/// Torques of a hinge's limits: N m / rad and N m s / rad.
struct Limit {
  double stiffness, damping;
};

/// A larger sum of speeds (m/s, rad/s) ends an episode: the simulation has broken down.
constexpr double kWildest = 300;
constexpr double kDensity = 1000;

/// Defaults of the optional members of a table.
struct BodyBase {
  static constexpr bool pinned = false;
  static constexpr bool uneven = false;    ///< whether PlanarBody moves it on slopes, too
  static constexpr double total_mass = 0;  ///< to which all densities are scaled, if not 0
};

constexpr double capsule_mass(const Capsule& c) {
  return kDensity * kPi * c.radius * c.radius * (2 * c.half + 4.0 / 3 * c.radius);
}

/// Moment of inertia about the centre, across the axis: a cylinder and two half balls.
constexpr double capsule_inertia(const Capsule& c) {
  const double r = c.radius, height = 2 * c.half;
  const double ball = kDensity * kPi * 4.0 / 3 * r * r * r, cylinder = capsule_mass(c) - ball;
  return cylinder * (3 * r * r + height * height) / 12 +
         ball * (0.4 * r * r + height * (3 * r + 2 * height) / 8);
}

/// Quantities for the equations of motion, computed from a table by the compiler.
template <class Body>
struct Numbers {
  static constexpr int n = sizeof(Body::segments) / sizeof(Segment);
  double mass[n] = {}, x[n] = {}, z[n] = {};  ///< centre of mass in the segment's frame
  double inertia[n] = {};                     ///< about the centre of mass
  // of the segment together with all that hangs on it, each child as a point mass on its hinge
  double all[n] = {};                       ///< mass
  double first_x[n] = {}, first_z[n] = {};  ///< mass * centre, in the segment's frame
  double second[n] = {};                    ///< moment of inertia about the segment's origin

  constexpr Numbers() {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      for (const Capsule& c : Body::segments[i].capsule) {
        const double m = capsule_mass(c);
        mass[i] += m;
        x[i] += m * c.x;
        z[i] += m * c.z;
      }
      x[i] /= mass[i];
      z[i] /= mass[i];
      for (const Capsule& c : Body::segments[i].capsule)
        inertia[i] += capsule_inertia(c) +
                      capsule_mass(c) * ((c.x - x[i]) * (c.x - x[i]) + (c.z - z[i]) * (c.z - z[i]));
      sum += mass[i];
    }
    const double scale = Body::total_mass > 0 ? Body::total_mass / sum : 1;
    for (int i = 0; i < n; ++i) {
      mass[i] *= scale;
      inertia[i] *= scale;
      all[i] = mass[i];
      first_x[i] = mass[i] * x[i];
      first_z[i] = mass[i] * z[i];
      second[i] = inertia[i] + mass[i] * (x[i] * x[i] + z[i] * z[i]);
    }
    for (int i = n - 1; i > 0; --i) {
      const Segment& s = Body::segments[i];
      all[s.parent] += all[i];
      first_x[s.parent] += all[i] * s.x;
      first_z[s.parent] += all[i] * s.z;
      second[s.parent] += all[i] * (s.x * s.x + s.z * s.z);
    }
    for (int i = 1; i < n; ++i) {  // motors resist the hinge, not the segment
      second[i] += Body::segments[i].hinge.armature;
      second[Body::segments[i].parent] += Body::segments[i].hinge.armature;
    }
  }
};

BOTSCHOOL_END
