// What robots sense. A sensor is a class with
//   static constexpr int size;                                   observations it gives
//   static void read(const World& world, int robot, T* out);     out[i * L + lane]
//   static void bounds(const World& world, int robot, double* low, double* high);   of each
// Positions are in double precision; T is the network's scalar, in which readings are computed.
#pragma once

#include "infrared.hpp"

BOTSCHOOL_BEGIN

/// Several sensors, their observations one after another.
template <class... Sensor>
struct Suite {
  static constexpr int size = (Sensor::size + ...);
  template <class W, class T>
  static void read(const W& world, int robot, T* out) {
    ((Sensor::read(world, robot, out), out += Sensor::size * W::lanes), ...);
  }
  template <class W>
  static void bounds(const W& world, int robot, double* low, double* high) {
    ((Sensor::bounds(world, robot, low, high), low += Sensor::size, high += Sensor::size), ...);
  }
};

/// The other robot of two in eight sectors of 45 degrees around the robot, and its apparent size.
struct Camera {
  static constexpr int sectors = 8, size = sectors + 1;

  /// The size is below pi / 2 for a robot no larger than the one that looks, as both keep apart.
  template <class W>
  static void bounds(const W&, int, double* low, double* high) {
    for (int i = 0; i < size; ++i) low[i] = 0, high[i] = 1;
    high[sectors] = kPi;
  }

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    static_assert(W::robots == 2, "the camera looks for the other robot of two");
    constexpr int L = W::lanes;
    const int other = 1 - robot;
    Sight<T, L> sight;
    sight.look(world, robot, world.x(other), world.y(other));
    const T sector = static_cast<T>(radians(45));
    for (int s = 0; s < sectors; ++s)
      for (int l = 0; l < L; ++l) {
        const T off = std::fabs(wrapped(sight.angle[l] - (T(s) + T(0.5)) * sector));
        const T seen = T(1) - off / sector;
        out[s * L + l] = seen > T(0) ? seen : T(0);
      }
    const T radius = static_cast<T>(world.model[other]->radius);
    for (int l = 0; l < L; ++l) out[sectors * L + l] = T(2) * arctangent(radius, sight.distance[l]);
  }
};

/// The ground's shade is its distance from the arena's centre / half the diagonal. Four sensors at
/// 0.9 of the radius, near the heading and near its opposite, give 0.5 + 10 * (shade - mean of the
/// four); then comes the mean.
struct Ground {
  static constexpr int sensors = 4, size = sensors + 1;

  /// Two points less than a robot's diameter apart differ by less than its share of half the diagonal.
  template <class W>
  static void bounds(const W& world, int robot, double* low, double* high) {
    const double half =
        std::sqrt(W::plan.width * W::plan.width + W::plan.height * W::plan.height) / 2;
    const double most = 10 * 2 * world.model[robot]->radius / half;
    for (int i = 0; i < sensors; ++i) low[i] = 0.5 - most, high[i] = 0.5 + most;
    low[sensors] = 0, high[sensors] = 1;
  }

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    constexpr double at[sensors] = {-0.0872, 0.0872, kPi - 0.0872, kPi + 0.0872};
    const double arm = 0.9 * world.model[robot]->radius;
    const double centre_x = W::plan.width / 2, centre_y = W::plan.height / 2;
    const double half = std::sqrt(centre_x * centre_x + centre_y * centre_y);
    alignas(64) double shade[sensors][L];
    for (int s = 0; s < sensors; ++s)
      for (int l = 0; l < L; ++l) {
        double sine, cosine;
        sine_cosine(world.heading(robot)[l] + at[s], sine, cosine);
        const double dx = world.x(robot)[l] + arm * cosine - centre_x;
        const double dy = world.y(robot)[l] + arm * sine - centre_y;
        shade[s][l] = std::sqrt(dx * dx + dy * dy) / half;
      }
    for (int l = 0; l < L; ++l) {
      const double mean = (shade[0][l] + shade[1][l] + shade[2][l] + shade[3][l]) / sensors;
      for (int s = 0; s < sensors; ++s)
        out[s * L + l] = static_cast<T>(0.5 + 10 * (shade[s][l] - mean));
      out[sensors * L + l] = static_cast<T>(mean);
    }
  }
};

/// Elapsed share of the episode.
struct Time : Shares<1> {
  template <class W, class T>
  static void read(const W& world, int, T* BOTSCHOOL_RESTRICT out) {
    for (int l = 0; l < W::lanes; ++l)
      out[l] = static_cast<T>(world.state[W::kSteps][l] / world.limit);
  }
};

/// The constant 1.
struct Bias : Shares<1> {
  template <class W, class T>
  static void read(const W&, int, T* BOTSCHOOL_RESTRICT out) {
    for (int l = 0; l < W::lanes; ++l) out[l] = T(1);
  }
};

/// Eight light sensors around the robot: a light gives each max(0, cos(angle off its axis)) *
/// 1 / (1 + (distance / 200 mm)^2). Walls and objects cast no shadow.
struct Light : Shares<8> {
  static constexpr int sensors = size;
  static constexpr double kHalf = 200;  ///< mm at which the light is half as bright

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    alignas(64) double to_x[L], to_y[L];
    for (int l = 0; l < L; ++l) to_x[l] = W::plan.light_x, to_y[l] = W::plan.light_y;
    Sight<T, L> sight;
    sight.look(world, robot, to_x, to_y);
    for (int s = 0; s < sensors; ++s)
      for (int l = 0; l < L; ++l) {
        double sine, cosine;
        sine_cosine(sight.angle[l] - radians(45) * s, sine, cosine);
        const T ratio = sight.distance[l] / T(kHalf);
        const T bright = static_cast<T>(cosine > 0 ? cosine : 0);
        out[s * L + l] = bright / (T(1) + ratio * ratio);
      }
  }
};

/// A laser range finder: eight rays from the robot's edge, the first straight ahead, then every 45
/// degrees; 1 - distance / 500 mm to what each hits first (walls, cylinders, robots), 0 beyond.
struct Laser : Shares<8> {
  static constexpr int rays = size;
  static constexpr double kRange = 500;

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    const double edge = world.model[robot]->radius;
    for (int r = 0; r < rays; ++r) {
      alignas(64) double way_x[L], way_y[L], first[L];
      for (int l = 0; l < L; ++l) {
        sine_cosine(world.heading(robot)[l] + radians(45) * r, way_y[l], way_x[l]);
        first[l] = edge + kRange;
      }
      for (const Wall& wall : world.wall) meet_wall(world, robot, wall, way_x, way_y, first);
      for (int c = 0; c < W::cylinders; ++c)
        meet_round(world, robot, world.radius[c], world.cylinder_x(c), world.cylinder_y(c), way_x,
                   way_y, first);
      for (int other = 0; other < W::robots; ++other)
        if (other != robot)
          meet_round(world, robot, world.model[other]->radius, world.x(other), world.y(other),
                     way_x, way_y, first);
      for (int l = 0; l < L; ++l) {
        const double gap = first[l] > edge ? first[l] - edge : 0;
        out[r * L + l] = static_cast<T>(1 - gap / kRange);
      }
    }
  }

 private:
  template <class W>
  static void meet_wall(const W& world, int robot, const Wall& w, const double* way_x,
                        const double* way_y, double* BOTSCHOOL_RESTRICT first) {
    const double ux = w.x2 - w.x, uy = w.y2 - w.y;
    for (int l = 0; l < W::lanes; ++l) {
      const double px = w.x - world.x(robot)[l], py = w.y - world.y(robot)[l];
      const double cross = way_x[l] * uy - way_y[l] * ux;
      const double t = (px * uy - py * ux) / cross;                    // along the ray
      const double v = (px * way_y[l] - py * way_x[l]) / cross;        // along the wall
      const bool hit = (cross != 0) & (t >= 0) & (v >= 0) & (v <= 1);  // parallel: never
      first[l] = hit & (t < first[l]) ? t : first[l];
    }
  }

  template <class W>
  static void meet_round(const W& world, int robot, double radius, const double* to_x,
                         const double* to_y, const double* way_x, const double* way_y,
                         double* BOTSCHOOL_RESTRICT first) {
    for (int l = 0; l < W::lanes; ++l) {
      const double dx = to_x[l] - world.x(robot)[l], dy = to_y[l] - world.y(robot)[l];
      const double along = dx * way_x[l] + dy * way_y[l];
      const double across = dx * way_y[l] - dy * way_x[l];
      const double depth2 = radius * radius - across * across;
      const double t = along - std::sqrt(depth2 > 0 ? depth2 : 0);
      const bool hit = (depth2 >= 0) & (along >= 0);
      first[l] = hit & (t < first[l]) ? t : first[l];
    }
  }
};

BOTSCHOOL_END
