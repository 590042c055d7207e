// What a native problem is. A problem is a class template on the number of lanes L with
//   static Info info();                             facts about it
//   double state[states][L];                        the state, one column a lane
//   void start(int lane, Random& random);           start of an episode
//   void refresh(int lane);                         recompute what is derived from a changed state
//   void observe(T* out) const;                     out[i * L + lane]: observation i
//   void step(const double* action, double* reward, std::int64_t* ended);
// where action[o * L + lane] is actuator o (or, for a discrete problem, the index of the action).
// All lanes step together; what an ended lane does until it is refilled does not matter.
#pragma once

#include <cstdint>

#include "../evonet/philox.hpp"

namespace botschool {

struct Info {
  const char* name;
  int observations;
  int outputs;  ///< actuators, or the number of actions of a discrete problem
  int states;
  int limit;  ///< longest episode, in steps
  bool discrete;
  double low, high;  ///< range of the actions
  double seconds;    ///< of one step
};

}  // namespace botschool

BOTSCHOOL_BEGIN

/// Clamp in which NaN becomes the lower bound, so that a wild action cannot spoil the state.
BOTSCHOOL_INLINE double limited(double x, double low, double high) {
  x = x > low ? x : low;
  return x < high ? x : high;
}

/// An angle taken to [-pi, pi].
BOTSCHOOL_INLINE double wrapped(double angle) {
  return angle - 2 * kPi * nearest(angle * (0.5 / kPi));
}

BOTSCHOOL_END
