// Runs any one problem step by step.
#pragma once

#include <cstdint>
#include <memory>

#include "reward.hpp"

namespace botschool {

/// A native problem step by step, in double precision: for Gymnasium, for tests and for pictures.
class Stepper {
 public:
  virtual ~Stepper() = default;
  virtual Info info() const = 0;
  virtual void set(const Setting& setting) = 0;
  /// The body of the episodes from the next start on, info().body parameters.
  virtual void set_body(const double* parameters) = 0;
  virtual void start(std::uint64_t seed, std::uint32_t episode) = 0;
  virtual void set_state(const double* state) = 0;
  virtual void get_state(double* state) const = 0;
  /// The least and the greatest value of each observation of a robot, or infinities.
  virtual void bounds(double* low, double* high) const = 0;
  virtual void observe(double* observation) const = 0;
  /// Returns whether the episode has ended (the caller handles the time limit).
  virtual bool step(const double* action, double& reward) = 0;
  /// Tells the quantities that a reward may name.
  virtual void quantities(TellQuantity tell, void* to) const = 0;

  /// What stands in an arena, a row of kObject values each.
  virtual int objects() const = 0;
  virtual void get_objects(double* rows) const = 0;
  virtual void set_objects(const double* rows) = 0;
  /// The first robot that overlaps something where it stands, or -1.
  virtual int blocked() const = 0;
};

/// Defined where the problem is compiled (stepping.hpp).
template <template <int> class Problem>
std::unique_ptr<Stepper> stepper();

}  // namespace botschool
