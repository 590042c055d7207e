// An arena with wheeled robots, L copies in lockstep: poses, motion, collisions.
// docs/specification.md, "Wheeled robots".
#pragma once

#include <cmath>
#include <limits>

#include "../engine/reward.hpp"
#include "declaration.hpp"

BOTSCHOOL_BEGIN

constexpr double kMaxWay = 1e6;  ///< of a wheel in a step, mm

/// What happened to a robot in a step, one value a lane.
template <int L>
struct Bump {
  std::int64_t wall[L];
  std::int64_t cylinder[L];
  std::int64_t robot[L];
};

template <int L, const Plan& P>
struct World : ProblemBase {
  static constexpr int lanes = L, robots = P.robots, cylinders = P.cylinders, walls = 4 + P.walls;
  /// Rows: x, y, heading of each robot; x, y of each cylinder, light and zone; which cells have been
  /// visited, in a declared arena (64 bits in two whole numbers); the problem's own; steps done.
  static constexpr int kCylinder = 3 * robots, kLight = kCylinder + 2 * cylinders;
  static constexpr int kZone = kLight + 2 * P.lights, kVisited = kZone + 2 * P.zones;
  static constexpr int kOwn = kVisited + (P.declared ? 2 : 0);
  static constexpr int kSteps = kOwn + P.own, kRows = kSteps + 1;

  double state[kRows][L] = {};
  NoiseKey key[L] = {};
  int limit;                                           ///< longest episode, in steps
  ArenaOptions options;                                ///< noise is never negative
  const Declaration* declared = &kDefaultDeclaration;  ///< what there is, if P.declared
  double width, height;
  const RobotModel* model[robots];  ///< of each robot
  double speed[robots];             ///< mm/s at an action of 1
  double radius[cylinders + 1];     ///< of the cylinders
  Wall wall[walls];
  SensorSettings sensing;

  World() { set({1}); }

  void set(const Setting& given) {
    limit = given.limit;
    options = given.arena ? *given.arena : ArenaOptions{};
    if constexpr (P.declared) {
      declared = options.declaration ? options.declaration : &kDefaultDeclaration;
      sensing = declared->sensing;
    }
    if (options.noise < 0) options.noise = P.declared ? declared->noise : P.noise;
    width = P.declared ? declared->width : P.width;
    height = P.declared ? declared->height : P.height;
    for (int r = 0; r < robots; ++r) {
      const RobotModel* own = P.declared ? declared->robot[r].model : find_robot(P.role[r].model);
      const double own_speed = P.declared ? declared->robot[r].speed : P.role[r].speed;
      model[r] = options.robot[r] ? options.robot[r] : own;
      speed[r] = model[r] == own && own_speed > 0 ? own_speed : model[r]->speed;
    }
    wall[0] = {0, 0, width, 0};
    wall[1] = {width, 0, width, height};
    wall[2] = {width, height, 0, height};
    wall[3] = {0, height, 0, 0};
    for (int w = 4; w < nwalls(); ++w) wall[w] = P.declared ? declared->wall[w - 4] : P.wall[w - 4];
    for (int c = 0; c < ncylinders(); ++c)
      radius[c] = P.declared ? declared->cylinder[c].radius : P.cylinder_radius;
  }

  // how many there are: known to the compiler unless the arena is declared
  int nrobots() const { return P.declared ? declared->robots : robots; }
  int nwalls() const { return P.declared ? 4 + declared->walls : walls; }
  int ncylinders() const { return P.declared ? declared->cylinders : cylinders; }
  int nlights() const { return P.declared ? declared->lights : P.lights; }
  int nzones() const { return P.declared ? declared->zones : P.zones; }

  /// Begins an episode in a lane.
  void begin(int lane, const Random& random) {
    key[lane] = random.key();
    state[kSteps][lane] = 0;
  }
  void place(int lane, int robot, double x, double y, double heading) {
    state[3 * robot][lane] = x;
    state[3 * robot + 1][lane] = y;
    state[3 * robot + 2][lane] = heading;
  }
  void place_cylinder(int lane, int cylinder, double x, double y) {
    state[kCylinder + 2 * cylinder][lane] = x;
    state[kCylinder + 2 * cylinder + 1][lane] = y;
  }

  void place_light(int lane, int light, double x, double y) {
    state[kLight + 2 * light][lane] = x;
    state[kLight + 2 * light + 1][lane] = y;
  }
  void place_zone(int lane, int zone, double x, double y) {
    state[kZone + 2 * zone][lane] = x;
    state[kZone + 2 * zone + 1][lane] = y;
  }

  const double* x(int robot) const { return state[3 * robot]; }
  const double* y(int robot) const { return state[3 * robot + 1]; }
  const double* heading(int robot) const { return state[3 * robot + 2]; }
  const double* cylinder_x(int c) const { return state[kCylinder + 2 * c]; }
  const double* cylinder_y(int c) const { return state[kCylinder + 2 * c + 1]; }
  const double* light_x(int i) const { return state[kLight + 2 * i]; }
  const double* light_y(int i) const { return state[kLight + 2 * i + 1]; }
  const double* zone_x(int z) const { return state[kZone + 2 * z]; }
  const double* zone_y(int z) const { return state[kZone + 2 * z + 1]; }

  /// Counts a step.
  void tick() {
    for (int l = 0; l < L; ++l) state[kSteps][l] += 1;
  }

  /// Moves a robot along the exact arc of its wheels (actions: left, right). It stays where it was
  /// if it would overlap a wall, a cylinder or another robot, or jump across a wall, and if its
  /// action is not a number or exceeds kMaxWay.
  void drive(int robot, const double* BOTSCHOOL_RESTRICT left,
             const double* BOTSCHOOL_RESTRICT right, Bump<L>& bump) {
    const double reach = speed[robot] * kStepSeconds, axle = model[robot]->axle;
    alignas(64) double to_x[L], to_y[L], to_heading[L];
    for (int l = 0; l < L; ++l) {
      const double a = left[l] * reach, b = right[l] * reach;
      const double half = (b - a) / (2 * axle);
      double s, c, sine, cosine;
      sine_cosine(half, s, c);
      sine_cosine(heading(robot)[l] + half, sine, cosine);
      // the chord of an arc of length (a + b) / 2; near 0 the sine's series
      const double ratio = half * half < 1e-8 ? 1 - half * half / 6 : s / half;
      const double chord = 0.5 * (a + b) * ratio;
      // a way that long leads nowhere: the sines of such turns would be meaningless
      const bool sane = (std::fabs(a) < kMaxWay) & (std::fabs(b) < kMaxWay);
      to_x[l] = sane ? x(robot)[l] + chord * cosine : std::numeric_limits<double>::quiet_NaN();
      to_y[l] = y(robot)[l] + chord * sine;
      const double turned = heading(robot)[l] + 2 * half;
      to_heading[l] = turned - 2 * kPi * floor_of(turned * (0.5 / kPi));
    }
    find_bumps(robot, to_x, to_y, bump);
    for (int l = 0; l < L; ++l) {
      const bool free = !(bump.wall[l] | bump.cylinder[l] | bump.robot[l]);
      state[3 * robot][l] = free ? to_x[l] : state[3 * robot][l];
      state[3 * robot + 1][l] = free ? to_y[l] : state[3 * robot + 1][l];
      state[3 * robot + 2][l] = free ? to_heading[l] : state[3 * robot + 2][l];
    }
  }

  /// What a robot would hit at (to_x, to_y). Every comparison is false for NaN, and a place that is
  /// not known to be free counts as a wall.
  void find_bumps(int robot, const double* BOTSCHOOL_RESTRICT to_x,
                  const double* BOTSCHOOL_RESTRICT to_y, Bump<L>& bump) const {
    const double own = model[robot]->radius;
    for (int l = 0; l < L; ++l) bump.wall[l] = bump.cylinder[l] = bump.robot[l] = 0;
    for (int i = 0; i < nwalls(); ++i) {
      const Wall& w = wall[i];
      const double ux = w.x2 - w.x, uy = w.y2 - w.y, length2 = ux * ux + uy * uy;
      const double inverse = length2 > 0 ? 1 / length2 : 0;
      for (int l = 0; l < L; ++l) {
        const double px = to_x[l] - w.x, py = to_y[l] - w.y;
        const double qx = x(robot)[l] - w.x, qy = y(robot)[l] - w.y;
        const double t = clamp((px * ux + py * uy) * inverse, 0.0, 1.0);
        const double dx = px - t * ux, dy = py - t * uy;
        const bool apart = dx * dx + dy * dy >= own * own;
        // the way crosses the wall: the ends of each lie on two sides of the other
        const double mx = px - qx, my = py - qy;
        const double side_to = ux * py - uy * px, side_from = ux * qy - uy * qx;
        const double end = mx * qy - my * qx, end2 = end + (ux * my - uy * mx);
        const bool crosses = (side_to * side_from < 0) & (end * end2 < 0);
        bump.wall[l] |= !apart | crosses;
      }
    }
    for (int c = 0; c < ncylinders(); ++c) {
      const double sum = own + radius[c];
      for (int l = 0; l < L; ++l) {
        const double dx = to_x[l] - cylinder_x(c)[l], dy = to_y[l] - cylinder_y(c)[l];
        bump.cylinder[l] |= dx * dx + dy * dy < sum * sum;
      }
    }
    for (int other = 0; other < nrobots(); ++other) {
      if (other == robot) continue;
      const double sum = own + model[other]->radius;
      for (int l = 0; l < L; ++l) {
        const double dx = to_x[l] - x(other)[l], dy = to_y[l] - y(other)[l];
        bump.robot[l] |= dx * dx + dy * dy < sum * sum;
      }
    }
  }

  /// The point of a wall that is nearest to a robot, in every lane.
  void nearest_points(int robot, const Wall& w, double* BOTSCHOOL_RESTRICT to_x,
                      double* BOTSCHOOL_RESTRICT to_y) const {
    const double ux = w.x2 - w.x, uy = w.y2 - w.y, length2 = ux * ux + uy * uy;
    const double inverse = length2 > 0 ? 1 / length2 : 0;
    for (int l = 0; l < L; ++l) {
      const double px = x(robot)[l] - w.x, py = y(robot)[l] - w.y;
      const double t = clamp((px * ux + py * uy) * inverse, 0.0, 1.0);
      to_x[l] = w.x + t * ux;
      to_y[l] = w.y + t * uy;
    }
  }

  /// Places of robots, and how far they are from what is there; a problem may add to them.
  void quantities(Quantities<L>& q) const {
    for (int r = 0; r < nrobots(); ++r) {
      const int number = nrobots() > 1 ? r + 1 : 0;
      const double own = model[r]->radius;
      q.row({"x", "", number}, "mm", "place of the robot", x(r));
      q.row({"y", "", number}, "mm", "place of the robot", y(r));
      q.row({"heading", "", number}, "rad", "direction of the robot, from 0 to 2 pi", heading(r));
      q.value({"wall", "", number}, "mm", "from the robot's edge to the nearest wall", [=](int l) {
        double least = 1e9;
        for (int i = 0; i < nwalls(); ++i) {
          const double away = apart(wall[i], x(r)[l], y(r)[l]);
          least = away < least ? away : least;
        }
        return least - own;
      });
      const auto nearest = [&](const char* name, const char* meaning, int n, const double* places,
                               const double* radii) {
        if (n == 0) return;
        q.value({name, "", number}, "mm", meaning, [=](int l) {
          double least = 1e9;
          for (int i = 0; i < n; ++i) {
            const double away =
                distance(places[2 * i * L + l] - x(r)[l], places[(2 * i + 1) * L + l] - y(r)[l]) -
                (radii ? radii[i] : 0);
            least = away < least ? away : least;
          }
          return least - own;
        });
      };
      nearest("cylinder", "from its edge to the nearest cylinder's", ncylinders(), cylinder_x(0),
              radius);
      nearest("light", "from its edge to the nearest light", nlights(), light_x(0), nullptr);
      nearest("zone", "from its edge to the middle of the nearest zone", nzones(), zone_x(0),
              nullptr);
    }
    for (int r = 1; r < nrobots(); ++r)
      q.value({"apart", "", nrobots() > 2 ? r + 1 : 0}, "mm",
              "between the middles of the first robot and this one",
              [=](int l) { return distance(x(r)[l] - x(0)[l], y(r)[l] - y(0)[l]); });
  }

  int blocked() const {
    for (int robot = 0; robot < nrobots(); ++robot) {
      Bump<L> bump;
      find_bumps(robot, x(robot), y(robot), bump);
      if (bump.wall[0] | bump.cylinder[0] | bump.robot[0]) return robot;
    }
    return -1;
  }

  /// Cylinders, then walls; where the cylinders are is part of the state, too.
  int objects() const { return ncylinders() + nwalls(); }
  void get_objects(double* row) const {
    for (int c = 0; c < ncylinders(); ++c, row += kObject)
      put_object(row, cylinder_x(c)[0], cylinder_y(c)[0], 0, 0, radius[c]);
    for (int i = 0; i < nwalls(); ++i, row += kObject)
      put_object(row, wall[i].x, wall[i].y, wall[i].x2, wall[i].y2, 0);
  }
  void set_objects(const double* row) {
    for (int c = 0; c < ncylinders(); ++c, row += kObject) {
      place_cylinder(0, c, row[0], row[1]);
      radius[c] = row[4];
    }
    for (int i = 0; i < nwalls(); ++i, row += kObject) wall[i] = {row[0], row[1], row[2], row[3]};
  }

 private:
  static double distance(double dx, double dy) { return std::sqrt(dx * dx + dy * dy); }
  static double apart(const Wall& w, double px, double py) {
    const double ux = w.x2 - w.x, uy = w.y2 - w.y, length2 = ux * ux + uy * uy;
    const double along = length2 > 0 ? ((px - w.x) * ux + (py - w.y) * uy) / length2 : 0;
    const double t = clamp(along, 0.0, 1.0);
    return distance(px - w.x - t * ux, py - w.y - t * uy);
  }
  static void put_object(double* row, double x, double y, double x2, double y2, double radius) {
    row[0] = x, row[1] = y, row[2] = x2, row[3] = y2, row[4] = radius;
  }
};

BOTSCHOOL_END
