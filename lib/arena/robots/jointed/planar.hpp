// Runs any one planar jointed body step by step: for pictures and for tests of the physics.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "table.hpp"

namespace botschool {

/// What the ground is like, and the pull down.
struct Surroundings {
  double slope = 0, curvature = 0, gravity = kGravity;
};

class PlanarBody {
 public:
  virtual ~PlanarBody() = default;
  virtual const char* name() const = 0;
  virtual std::vector<Segment> segments() const = 0;
  virtual std::vector<Contact> contacts() const = 0;
  /// A row a segment: mass, x and z of the centre of mass, moment of inertia about it.
  virtual std::vector<double> masses() const = 0;

  /// Coordinates: x, z, then each segment's angle against the world.
  int size() const { return int(segments().size()) + 2; }
  /// (size, size), row by row; the root's x and z are there for pinned bodies too.
  virtual std::vector<double> mass_matrix(const double* position) const = 0;
  /// In the air, with the torques of motors, dampers, springs and limits.
  virtual std::vector<double> accelerations(const double* position, const double* speed,
                                            const double* action, double gravity) const = 0;
  /// `steps` substeps of h seconds. `state`: positions and speeds, 2 * size, updated; `load` gets the
  /// mean force of each contact point in N. In single precision on request, as in evolution.
  virtual void advance(double* state, const double* action, double* load, double h, int steps,
                       const Surroundings& around, bool single) const = 0;
};

/// All bodies, those for tests included.
std::vector<std::unique_ptr<PlanarBody>> planar_bodies();

/// The chain of BodyBrain with a body of 64 parameters (bodybrain.hpp).
std::unique_ptr<PlanarBody> planar_chain(const double* parameters);

}  // namespace botschool
