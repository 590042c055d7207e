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

/// Eight sectors of 45 degrees around a robot, and the largest apparent size of an object in each.
struct Sectors {
  static constexpr int sectors = 8, size = sectors + 1;

  /// The size is below pi, because objects keep a distance from the robot.
  template <class W>
  static void bounds(const W&, int, double* low, double* high) {
    for (int i = 0; i < size; ++i) low[i] = 0, high[i] = 1;
    high[sectors] = kPi;
  }

 protected:
  template <int L, class T>
  static void clear(T* BOTSCHOOL_RESTRICT out) {
    for (int i = 0; i < size * L; ++i) out[i] = T(0);
  }

  /// Something round at (x, y), one a lane.
  template <class W, class T>
  static void see(const W& world, int robot, double radius, const double* x, const double* y,
                  T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    Sight<T, L> sight;
    sight.look(world, robot, x, y);
    const T sector = static_cast<T>(radians(45));
    for (int s = 0; s < sectors; ++s)
      for (int l = 0; l < L; ++l) {
        const T off = std::fabs(wrapped(sight.angle[l] - (T(s) + T(0.5)) * sector));
        const T seen = T(1) - off / sector;
        out[s * L + l] = seen > out[s * L + l] ? seen : out[s * L + l];
      }
    for (int l = 0; l < L; ++l) {
      const T seen = T(2) * arctangent(static_cast<T>(radius), sight.distance[l]);
      out[sectors * L + l] = seen > out[sectors * L + l] ? seen : out[sectors * L + l];
    }
  }
};

/// A camera for the other robots.
struct Camera : Sectors {
  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    clear<W::lanes>(out);
    for (int other = 0; other < world.nrobots(); ++other)
      if (other != robot)
        see(world, robot, world.model[other]->radius, world.x(other), world.y(other), out);
  }
};

/// The sectors in which the other robot of two sees this one.
struct Seen : Shares<Sectors::sectors> {
  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    alignas(64) T seen[Sectors::size * W::lanes];
    Camera::read(world, 1 - robot, seen);
    for (int i = 0; i < size * W::lanes; ++i) out[i] = seen[i];
  }
};

/// A camera for the cylinders.
struct CylinderCamera : Sectors {
  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    clear<W::lanes>(out);
    for (int c = 0; c < world.ncylinders(); ++c)
      see(world, robot, world.radius[c], world.cylinder_x(c), world.cylinder_y(c), out);
  }
};

/// Where a robot's four ground sensors are: 0.9 of the radius out, near the heading and near its
/// opposite.
template <class W>
struct GroundSpots {
  static constexpr int sensors = 4, L = W::lanes;
  alignas(64) double x[sensors][L], y[sensors][L];

  GroundSpots(const W& world, int robot) {
    constexpr double at[sensors] = {-0.0872, 0.0872, kPi - 0.0872, kPi + 0.0872};
    const double arm = 0.9 * world.model[robot]->radius;
    for (int s = 0; s < sensors; ++s)
      for (int l = 0; l < L; ++l) {
        double sine, cosine;
        sine_cosine(world.heading(robot)[l] + at[s], sine, cosine);
        x[s][l] = world.x(robot)[l] + arm * cosine;
        y[s][l] = world.y(robot)[l] + arm * sine;
      }
  }
};

/// The shade of the zone below each ground sensor; of several zones, the last; without a zone 0.
struct Ground : Shares<4> {
  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    const GroundSpots<W> spots(world, robot);
    for (int i = 0; i < size * L; ++i) out[i] = T(0);
    for (int z = 0; z < world.nzones(); ++z) {
      const double radius = world.declared->zone[z].radius;
      const T shade = static_cast<T>(world.declared->zone[z].shade);
      for (int s = 0; s < size; ++s)
        for (int l = 0; l < L; ++l) {
          const double dx = spots.x[s][l] - world.zone_x(z)[l];
          const double dy = spots.y[s][l] - world.zone_y(z)[l];
          const bool on = dx * dx + dy * dy < radius * radius;
          out[s * L + l] = on ? shade : out[s * L + l];
        }
    }
  }
};

/// A floor whose shade is its distance from the arena's centre / half the diagonal. Four ground
/// sensors give 0.5 + 10 * (shade - mean of the four); then comes the mean.
struct Gradient {
  static constexpr int sensors = 4, size = sensors + 1;

  /// Two points less than a robot's diameter apart differ by less than its share of half the diagonal.
  template <class W>
  static void bounds(const W& world, int robot, double* low, double* high) {
    const double half = std::sqrt(world.width * world.width + world.height * world.height) / 2;
    const double most = 10 * 2 * world.model[robot]->radius / half;
    for (int i = 0; i < sensors; ++i) low[i] = 0.5 - most, high[i] = 0.5 + most;
    low[sensors] = 0, high[sensors] = 1;
  }

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    const GroundSpots<W> spots(world, robot);
    const double centre_x = world.width / 2, centre_y = world.height / 2;
    const double half = std::sqrt(centre_x * centre_x + centre_y * centre_y);
    alignas(64) double shade[sensors][L];
    for (int s = 0; s < sensors; ++s)
      for (int l = 0; l < L; ++l) {
        const double dx = spots.x[s][l] - centre_x, dy = spots.y[s][l] - centre_y;
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

/// Eight light sensors around the robot: each light gives max(0, cos(angle off the axis)) /
/// (1 + (distance / half_light)^2), and the sum is capped at 1. Nothing casts a shadow.
struct Light : Shares<8> {
  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    for (int i = 0; i < size * L; ++i) out[i] = T(0);
    const T half = static_cast<T>(world.sensing.half_light);
    for (int i = 0; i < world.nlights(); ++i) {
      Sight<T, L> sight;
      sight.look(world, robot, world.light_x(i), world.light_y(i));
      for (int s = 0; s < size; ++s)
        for (int l = 0; l < L; ++l) {
          T sine, cosine;
          sine_cosine(sight.angle[l] - static_cast<T>(radians(45) * s), sine, cosine);
          const T ratio = sight.distance[l] / half;
          const T bright = cosine > T(0) ? cosine : T(0);
          out[s * L + l] += bright / (T(1) + ratio * ratio);
        }
    }
    for (int i = 0; i < size * L; ++i) out[i] = out[i] < T(1) ? out[i] : T(1);
  }
};

/// A laser range finder: beams from the robot's edge, the first straight ahead if they go all round,
/// else from the right end of their field to the left one; 1 - distance / reach to what each hits
/// first (walls, cylinders, robots), 0 beyond.
struct Laser {
  template <class W>
  static void bounds(const W& world, int, double* low, double* high) {
    for (int i = 0; i < world.sensing.beams; ++i) low[i] = 0, high[i] = 1;
  }

  /// Of a beam, radians from the heading.
  static double direction(const SensorSettings& sensing, int beam) {
    const bool round = sensing.field >= 360;
    const int gaps = round || sensing.beams == 1 ? sensing.beams : sensing.beams - 1;
    const double first = round || sensing.beams == 1 ? 0 : -sensing.field / 2;
    return radians(first + sensing.field * beam / gaps);
  }

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    const double edge = world.model[robot]->radius, reach = world.sensing.reach;
    for (int r = 0; r < world.sensing.beams; ++r) {
      const double turned = direction(world.sensing, r);
      alignas(64) double way_x[L], way_y[L], first[L];
      for (int l = 0; l < L; ++l) {
        sine_cosine(world.heading(robot)[l] + turned, way_y[l], way_x[l]);
        first[l] = edge + reach;
      }
      for (int w = 0; w < world.nwalls(); ++w)
        meet_wall(world, robot, world.wall[w], way_x, way_y, first);
      for (int c = 0; c < world.ncylinders(); ++c)
        meet_round(world, robot, world.radius[c], world.cylinder_x(c), world.cylinder_y(c), way_x,
                   way_y, first);
      for (int other = 0; other < world.nrobots(); ++other)
        if (other != robot)
          meet_round(world, robot, world.model[other]->radius, world.x(other), world.y(other),
                     way_x, way_y, first);
      for (int l = 0; l < L; ++l) {
        const double gap = first[l] > edge ? first[l] - edge : 0;
        out[r * L + l] = static_cast<T>(1 - gap / reach);
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
