// What a native problem is. A problem is a class template on the number of lanes L with
//   static Info info();                             facts about it
//   double state[states][L];                        the state, one column a lane
//   void set(const Setting& setting);               once, before anything else
//   void start(int lane, Random& random);           start of an episode
//   void refresh(int lane);                         recompute what is derived from a changed state
//   void observe(T* out) const;                     out[i * L + lane]: observation i
//   void step(const double* action, double* reward, std::int64_t* ended);
// where action[o * L + lane] is actuator o (or, for a discrete problem, the index of the action);
// with several robots, first all observations or actuators of one, then those of the next.
// All lanes step together; what an ended lane does until it is refilled does not matter.
#pragma once

#include <cstdint>

#include "../../evonet/philox.hpp"
#include "../robots/plan.hpp"

namespace botschool {

struct Info {
  const char* name;
  int observations;  ///< of one robot
  int outputs;       ///< actuators of one robot, or the number of actions of a discrete problem
  int states;
  int limit;  ///< longest episode, in steps
  bool discrete;
  double low, high;  ///< range of the actions
  double seconds;    ///< of one step
  int robots = 1;
  const Plan* plan = nullptr;  ///< of an arena with wheeled robots
};

/// A measured infrared table, shape (distances, angles, kInfrared): what the sensors read of an
/// object in a direction (index 0 is straight ahead, counter-clockwise) at a distance.
struct InfraredTable {
  int distances, angles;
  double first, step;  ///< distances between surfaces, mm
  const double* values;
};

/// What the caller may choose about an episode.
struct Setting {
  int limit;                                   ///< longest episode, in steps
  double noise = -1;                           ///< of the sensors; negative: the problem's own
  const InfraredTable* wall_table = nullptr;   ///< measured readings of walls, or null: the model
  const InfraredTable* round_table = nullptr;  ///< of cylinders and robots
};

}  // namespace botschool

BOTSCHOOL_BEGIN

/// What problems inherit.
struct AnyProblem {
  void set(const Setting&) {}
};

/// What arenas with wheeled robots inherit.
struct Arena : AnyProblem {};

constexpr double radians(double degrees) { return degrees * (kPi / 180); }

/// Clamp in which NaN becomes the lower bound, so that a wild action cannot spoil the state.
BOTSCHOOL_INLINE double limited(double x, double low, double high) {
  x = x > low ? x : low;
  return x < high ? x : high;
}

/// An angle taken to [-pi, pi].
template <class T>
BOTSCHOOL_INLINE T wrapped(T angle) {
  return angle - T(2 * kPi) * nearest(angle * T(0.5 / kPi));
}

BOTSCHOOL_END
