// Wheeled robots and what an arena holds: plain data. Lengths in mm, angles in radians.
// docs/specification.md, "Wheeled robots".
#pragma once

#include "../engine/problem.hpp"

namespace botschool {

constexpr int kInfrared = 8;
constexpr double kStepSeconds = 0.1;

/// How infrared readings fade: with the distance d between surfaces and the angle delta off a
/// sensor's axis, a reading is gain * exp(-(d / d0)^n - |delta / w|^m).
struct Response {
  double d0, w, m;
};

/// A kind of robot.
struct RobotModel {
  const char* name;
  double radius, axle;
  double speed;                 ///< mm/s at an action of 1
  double direction[kInfrared];  ///< of the sensors, degrees counter-clockwise from the heading
  double gain[kInfrared];
  double n;      ///< 1 or 1.5
  double range;  ///< farther objects give nothing
  Response wall, round;
};

/// All kinds of robots; a new one is an entry here.
inline constexpr RobotModel kRobotModels[]{
    // fitted to published measured tables
    {"Khepera",
     27.5,
     53,
     144,
     {290.9, 318.1, 351.6, 15.7, 44.1, 74.1, 168.6, 193.9},
     {47.8, 43.2, 32.2, 20.3, 51.7, 97.6, 36.3, 105.5},
     1,
     45,
     {5.24, 0.487, 2},
     {4.23, 0.308, 2}},
    // published sensor directions; the response is the Khepera's with its mean gain, as no table of
    // the e-puck's own is at hand
    {"e-puck",
     35,
     55,
     200,
     {342.8, 314.1, 270, 208.5, 151.2, 90, 45.8, 17.1},
     {54.325, 54.325, 54.325, 54.325, 54.325, 54.325, 54.325, 54.325},
     1,
     45,
     {5.24, 0.487, 2},
     {4.23, 0.308, 2}},
    // fitted to published measured tables
    {"marXbot",
     85,
     104,
     360,
     {202.5, 247.5, 292.5, 337.5, 22.5, 67.5, 112.5, 157.5},
     {0.935, 0.935, 0.935, 0.935, 0.935, 0.935, 0.935, 0.935},
     1.5,
     105,
     {40.0, 1.258, 22.2},
     {39.2, 0.583, 2.6}},
};

constexpr bool same_text(const char* a, const char* b) {
  while (*a && *a == *b) ++a, ++b;
  return *a == *b;
}

/// The model of that name, or null.
constexpr const RobotModel* find_robot(const char* name) {
  for (const RobotModel& model : kRobotModels)
    if (same_text(model.name, name)) return &model;
  return nullptr;
}

/// A robot's part in a task.
struct Role {
  const char* model;  ///< unless the user chooses another
  double speed = 0;   ///< mm/s at an action of 1, of this model; 0: the model's own
};

struct Wall {
  double x, y, x2, y2;
};

constexpr int kMaxWalls = 12, kMaxCylinders = 8, kMaxLights = 4, kMaxZones = 4;

/// A task's arena. Four walls enclose width x height; they come before `wall`.
struct Plan {
  double width, height;
  int robots;
  Role role[kMaxRobots];
  double noise;  ///< standard deviation of the infrared readings' noise
  int cylinders = 0;
  double cylinder_radius = 0;
  int walls = 0;
  Wall wall[kMaxWalls - 4] = {};
  int lights = 0, zones = 0;
  /// Whether a Declaration says what there is; all numbers are then the most that there can be.
  bool declared = false;
  int own = 0;  ///< rows of the state for what only this problem has
};

/// How light and laser sensors are made.
struct SensorSettings {
  double half_light = 200;  ///< mm at which a light is half as bright
  int beams = 8;            ///< of the laser
  double field = 360;       ///< degrees that the beams cover, around the heading
  double reach = 500;       ///< of a beam, mm from the robot's edge
};

struct Declaration;  // an arena that a user declares: declaration.hpp

/// A measured infrared table, shape (distances, angles, kInfrared): what the sensors read of an
/// object in a direction (index 0 is straight ahead, counter-clockwise) at a distance.
struct InfraredTable {
  int distances, angles;
  double first, step;  ///< distances between surfaces, mm
  const double* values;
};

/// What a user may choose about an arena.
struct ArenaOptions {
  const RobotModel* robot[kMaxRobots] = {};    ///< null: the task's own
  double noise = -1;                           ///< of the sensors; negative: the task's own
  const InfraredTable* wall_table = nullptr;   ///< measured readings of walls, or null: the model
  const InfraredTable* round_table = nullptr;  ///< of cylinders and robots
  const Declaration* declaration = nullptr;    ///< of a declared arena; null: the one by default
};

}  // namespace botschool
