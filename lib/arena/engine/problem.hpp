// What a native problem is: a header in arena/problems with a class template on the number of lanes L
//   struct Name : ProblemBase                       defaults of all that is optional
//   static Info info();                             facts about it
//   double state[states][L];                        the state, one column a lane
//   void start(int lane, Random& random);           start of an episode
//   void observe(T* out) const;                     out[i * L + lane]: observation i
//   void step(const double* action, double* reward, std::int64_t* ended);
//   void quantities(Quantities<L>& q) const;        what a reward of one's own may name: reward.hpp
// and the line BOTSCHOOL_PROBLEM(Name), by which the build finds it. action[o * L + lane] is actuator o
// (or, for a discrete problem, the index of the action); with several robots, first all observations or
// actuators of one, then of the next. All lanes step together; an ended lane may do anything until it
// is refilled.
#pragma once

#include <cstdint>

#include "../../evonet/philox.hpp"

/// Read by lib/CMakeLists.txt, which lists all problems.
#define BOTSCHOOL_PROBLEM(Name)

namespace botschool {

struct Plan;          // an arena with wheeled robots: robots/plan.hpp
struct ArenaOptions;  // what its user may choose
struct SpaceOptions;  // about a race in space: robots/jointed/solid.hpp
struct Program;       // a reward of one's own: reward.hpp

/// Robots in a problem, one network each.
constexpr int kMaxRobots = 4;

struct Info {
  const char* name = "";
  int observations = 1;  ///< of one robot
  int outputs = 1;       ///< actuators of one robot, or the number of actions of a discrete problem
  int states = 1;
  int limit = 1000;           ///< longest episode, in steps
  bool discrete = false;      ///< an action is one of `outputs` choices
  double low = -1, high = 1;  ///< range of the actuators
  double seconds = 0.02;      ///< of one step
  int robots = 1;
  int body = 0;            ///< parameters of a body that evolves; they follow the network's
  const char* alias = "";  ///< another name, with
  int alias_limit = 0;     ///< another longest episode
  const char* gym = "";    ///< id of its Gymnasium face; "": `name` itself, or botschool/name
  const Plan* plan = nullptr;
  bool common = false;  ///< of two robots: whether both get the return, or the second 1 minus it
  const char* side[2] = {"predator", "prey"};  ///< what two robots are called
};

/// What the caller may choose about an episode.
struct Setting {
  int limit;                            ///< longest episode, in steps
  const ArenaOptions* arena = nullptr;  ///< or null: the problem's own
  const SpaceOptions* space = nullptr;
  const Program* program = nullptr;  ///< or null: the problem's own reward
};

/// A row of an object in an arena: x, y, x2, y2, radius.
constexpr int kObject = 5;

/// `ended` of a lane whose simulation has broken down: a program pays nothing there, and ends it.
constexpr std::int64_t kBroken = 2;

}  // namespace botschool

BOTSCHOOL_BEGIN

/// Defaults that problems inherit; a problem may hide them by its own members.
struct ProblemBase {
  /// Whether `state` describes an episode completely, or refresh() recomputes the rest: then the
  /// episode can continue in another lane.
  static constexpr bool movable = false;
  /// Returns info() with the caller's choices: a declared arena has its own robots.
  static Info given(const Info& info, const Setting&) { return info; }
  /// Once, before anything else.
  void set(const Setting&) {}
  /// The body of the episode that starts next in a lane: `body` parameters, or null for all zeros.
  void build(int, const double*) {}
  /// Recomputes all values derived from the state, after somebody changed the state.
  void refresh(int) {}
  /// Writes the smallest and the largest value of each observation of a robot, if there are limits;
  /// the arrays come with infinities.
  void bounds(double*, double*) const {}
  template <class Quantities>
  void quantities(Quantities&) const {}
  /// The objects in an arena, as rows of kObject values (one lane).
  int objects() const { return 0; }
  void get_objects(double*) const {}
  void set_objects(const double*) {}
  /// The first robot that overlaps an object at its place, or -1 (one lane).
  int blocked() const { return -1; }
};

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
