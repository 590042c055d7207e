// An arena that a user declares: plain data. Lengths in mm, angles in degrees.
// docs/specification.md, "Declared arenas".
#pragma once

#include "plan.hpp"

namespace botschool {

/// A number that each episode draws anew; low == high: always the same.
struct Range {
  double low = 0, high = 0;
};

/// Where something is put at the start of an episode.
struct Spot {
  Range x, y;
};

struct DeclaredRobot {
  const RobotModel* model = &kRobotModels[0];
  double speed = 0;  ///< mm/s at an action of 1; 0: the model's own
  Spot spot;
  Range heading;
};

struct DeclaredCylinder {
  Spot spot;
  double radius = 0;
};

/// A disc on the floor.
struct DeclaredZone {
  Spot spot;
  double radius = 0;
  double shade = 1;  ///< 0 is the floor's
};

enum class Sense { infrared, camera, cylinders, ground, gradient, light, laser, time, bias };
inline constexpr const char* kSenses[]{"infrared", "camera", "cylinders", "ground", "gradient",
                                       "light",    "laser",  "time",      "bias"};
constexpr int kMaxSenses = 9;

enum class Pay {
  avoid,
  explore,
  near_cylinder,
  near_light,
  on_zone,
  same_zone,
  every_zone,
  together
};
inline constexpr const char* kPays[]{"avoid",   "explore",   "near-cylinder", "near-light",
                                     "on-zone", "same-zone", "every-zone",    "together"};

constexpr int kMaxBeams = 32;
/// Values that one robot can observe, a multiple of four.
constexpr int kMaxObservations = 80;

struct Declaration {
  double width = 400, height = 400;
  int robots = 1;
  DeclaredRobot robot[kMaxRobots] = {
      {&kRobotModels[0], 0, {{27.5, 372.5}, {27.5, 372.5}}, {0, 360}}};
  int walls = 0;
  Wall wall[kMaxWalls - 4] = {};
  int cylinders = 0;
  DeclaredCylinder cylinder[kMaxCylinders] = {};
  int lights = 0;
  Spot light[kMaxLights] = {};
  int zones = 0;
  DeclaredZone zone[kMaxZones] = {};
  int senses = 1;
  Sense sense[kMaxSenses] = {Sense::infrared};
  double noise = 0;  ///< standard deviation of the noise of all readings except time and bias
  SensorSettings sensing;
  Pay pay = Pay::avoid;
  double distance = 60;    ///< largest distance that counts as near, in mm between edges
  bool bumps_end = false;  ///< whether a collision ends the episode
};

inline constexpr Declaration kDefaultDeclaration{};

}  // namespace botschool

BOTSCHOOL_BEGIN

/// Observations that a sense gives.
constexpr int size_of(Sense sense, const SensorSettings& sensing) {
  switch (sense) {
    case Sense::infrared:
    case Sense::light:
      return 8;
    case Sense::camera:
    case Sense::cylinders:
      return 9;
    case Sense::ground:
      return 4;
    case Sense::gradient:
      return 5;
    case Sense::laser:
      return sensing.beams;
    default:
      return 1;
  }
}

/// Observations of a robot.
constexpr int observations_of(const Declaration& declared) {
  int size = 0;
  for (int i = 0; i < declared.senses; ++i) size += size_of(declared.sense[i], declared.sensing);
  return size;
}

BOTSCHOOL_END
