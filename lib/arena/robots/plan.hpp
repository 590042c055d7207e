// Wheeled robots and what an arena holds: plain data. Lengths in mm, angles in radians.
// docs/specification.md, "Wheeled robots".
#pragma once

namespace botschool {

constexpr int kInfrared = 8;
constexpr double kStepSeconds = 0.1;

/// How infrared readings fade: with the distance d between surfaces and the angle delta off a
/// sensor's axis, a reading is gain * exp(-(d / d0)^n - |delta / w|^m).
struct Response {
  double d0, w, m;
};

struct Body {
  const char* name;
  double radius, axle;
  double speed;                 ///< mm/s at an action of 1
  double direction[kInfrared];  ///< of the sensors, degrees counter-clockwise from the heading
  double gain[kInfrared];
  double n;
  double range;  ///< farther objects give nothing
  Response wall, round;
};

/// Fitted to published measured tables of the Khepera.
inline constexpr Body kKhepera{"Khepera",
                               27.5,
                               53,
                               144,
                               {290.9, 318.1, 351.6, 15.7, 44.1, 74.1, 168.6, 193.9},
                               {47.8, 43.2, 32.2, 20.3, 51.7, 97.6, 36.3, 105.5},
                               1,
                               45,
                               {5.24, 0.487, 2},
                               {4.23, 0.308, 2}};

/// Published sensor directions; the response is the Khepera's with its mean gain, as no table of
/// the e-puck's own is at hand.
inline constexpr Body kEpuck{"e-puck",
                             35,
                             55,
                             200,
                             {342.8, 314.1, 270, 208.5, 151.2, 90, 45.8, 17.1},
                             {54.325, 54.325, 54.325, 54.325, 54.325, 54.325, 54.325, 54.325},
                             1,
                             45,
                             {5.24, 0.487, 2},
                             {4.23, 0.308, 2}};

/// Fitted to published measured tables of the marXbot.
inline constexpr Body kMarxbot{"marXbot",
                               85,
                               104,
                               360,
                               {202.5, 247.5, 292.5, 337.5, 22.5, 67.5, 112.5, 157.5},
                               {0.935, 0.935, 0.935, 0.935, 0.935, 0.935, 0.935, 0.935},
                               1.5,
                               105,
                               {40.0, 1.258, 22.2},
                               {39.2, 0.583, 2.6}};

struct Robot {
  const Body* body;
  double speed;  ///< mm/s at an action of 1
};

struct Wall {
  double x, y, x2, y2;
};

constexpr int kMostRobots = 4, kMostWalls = 12;

/// A task's arena. Four walls enclose width x height; they come before `wall`.
struct Plan {
  double width, height;
  int robots;
  Robot robot[kMostRobots];
  double noise;  ///< standard deviation of the infrared readings' noise
  int cylinders = 0;
  double cylinder_radius = 0;
  int walls = 0;
  Wall wall[kMostWalls - 4] = {};
  double light_x = 0, light_y = 0;
};

}  // namespace botschool
