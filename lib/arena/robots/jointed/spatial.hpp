// Runs any one body in space step by step: for pictures and for tests of the physics.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solid.hpp"

namespace botschool {

/// A state is as in racer.hpp: coordinates as MuJoCo has them (root's place, quaternion, angles of
/// hinges), speeds likewise, how far the ground holds each ball back, and its force across the ground.
class SpatialBody {
 public:
  virtual ~SpatialBody() = default;
  virtual const Solid& solid() const = 0;
  virtual std::vector<Ball> balls() const = 0;

  int coordinates() const { return solid().links + 6; }
  int speeds() const { return solid().links + 5; }

  /// Of each link: its origin in the world, and its axes (a row an axis), 12 numbers.
  virtual std::vector<double> places(const double* position) const = 0;
  /// (speeds, speeds), row by row, for speeds as in the state.
  virtual std::vector<double> mass_matrix(const double* position) const = 0;
  /// In the air, with the torques of motors, dampers and springs, and without limits of hinges.
  virtual std::vector<double> accelerations(const double* position, const double* speed,
                                            const double* action, double gravity) const = 0;
  /// `steps` substeps of h seconds; updates `state`. In single precision on request, as in evolution.
  virtual void advance(double* state, const double* action, double h, int steps, double gravity,
                       const Firmness& firm, const Ground& ground, bool single) const = 0;
};

/// All bodies, those for tests included.
std::vector<std::unique_ptr<SpatialBody>> spatial_bodies();

/// A body of a table that stays where it is.
std::unique_ptr<SpatialBody> spatial_body(const Solid& solid);

}  // namespace botschool
