// Infrared sensors, by the fitted model or by a measured table, and their noise.
// docs/specification.md, "Wheeled robots".
#pragma once

#include "world.hpp"

BOTSCHOOL_BEGIN

/// What sensors of `values` observations from 0 to 1 inherit.
template <int values>
struct Shares {
  static constexpr int size = values;

  template <class W>
  static void bounds(const W&, int, double* low, double* high) {
    for (int i = 0; i < size; ++i) low[i] = 0, high[i] = 1;
  }
};

/// Where another object is, seen from a robot.
template <class T, int L>
struct Sight {
  alignas(64) T distance[L];  ///< between centres, mm
  alignas(64) T angle[L];     ///< counter-clockwise from the heading, in [-pi, pi]

  /// Of something dx, dy away.
  void look(const T* BOTSCHOOL_RESTRICT dx, const T* BOTSCHOOL_RESTRICT dy,
            const T* BOTSCHOOL_RESTRICT heading) {
    for (int l = 0; l < L; ++l) {
      distance[l] = std::sqrt(dx[l] * dx[l] + dy[l] * dy[l]);
      angle[l] = wrapped(arctangent(dy[l], dx[l]) - heading[l]);
    }
  }

  template <class W>
  void look(const W& world, int robot, const double* BOTSCHOOL_RESTRICT to_x,
            const double* BOTSCHOOL_RESTRICT to_y) {
    alignas(64) T dx[L], dy[L], heading[L];
    for (int l = 0; l < L; ++l) {
      dx[l] = static_cast<T>(to_x[l] - world.x(robot)[l]);
      dy[l] = static_cast<T>(to_y[l] - world.y(robot)[l]);
      heading[l] = static_cast<T>(world.heading(robot)[l]);
    }
    look(dx, dy, heading);
  }
};

/// Farther objects give nothing: half a step past a table's last distance.
inline double range_of(const InfraredTable& table) {
  return table.first + table.step * (table.distances - 0.5);
}

/// The measured readings nearest to a direction and a distance, or null out of range.
inline const double* readings_of(const InfraredTable& table, double angle, double gap) {
  if (!(gap <= range_of(table))) return nullptr;
  int d = static_cast<int>(nearest((gap - table.first) / table.step));
  d = d < 0 ? 0 : d < table.distances ? d : table.distances - 1;
  int a = static_cast<int>(nearest(angle / (2 * kPi) * table.angles));
  a = (a % table.angles + table.angles) % table.angles;
  return table.values + (std::ptrdiff_t(d) * table.angles + a) * kInfrared;
}

/// Eight infrared sensors that see walls, cylinders and other robots within `range`, each
/// adding their readings, capped at 1; by the fitted model, or by a measured table if one is set.
struct Infrared : Shares<kInfrared> {
  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    constexpr int L = W::lanes;
    const RobotModel& body = *world.model[robot];
    for (int i = 0; i < size * L; ++i) out[i] = 0;

    Near<W, T, W::walls> walls(world, robot, world.options.wall_table);
    alignas(64) double to_x[L], to_y[L];
    for (int w = 0; w < world.nwalls(); ++w) {
      world.nearest_points(robot, world.wall[w], to_x, to_y);
      walls.look(0, to_x, to_y);
    }
    walls.add(body.wall, out);

    Near<W, T, W::cylinders + W::robots> round(world, robot, world.options.round_table);
    for (int c = 0; c < world.ncylinders(); ++c)
      round.look(world.radius[c], world.cylinder_x(c), world.cylinder_y(c));
    for (int other = 0; other < world.nrobots(); ++other)
      if (other != robot) round.look(world.model[other]->radius, world.x(other), world.y(other));
    round.add(body.round, out);

    // nothing rather than nearly nothing: products with denormal numbers are very slow
    for (int i = 0; i < size * L; ++i) {
      const T most = out[i] < T(1) ? out[i] : T(1);
      out[i] = most > T(1e-12) ? most : T(0);
    }
  }

 private:
  /// The objects of one kind within reach, of all lanes in one row. There are few, so a full row
  /// holds objects of many lanes.
  template <class W, class T, int objects>
  class Near {
    static constexpr int L = W::lanes;

   public:
    Near(const W& world, int robot, const InfraredTable* table)
        : world_(world), robot_(robot), body_(*world.model[robot]), table_(table) {
      for (int l = 0; l < L; ++l) heading_[l] = static_cast<T>(world.heading(robot)[l]);
    }

    /// Adds the objects within reach: one object of that radius per lane, at (to_x, to_y).
    void look(double radius, const double* BOTSCHOOL_RESTRICT to_x,
              const double* BOTSCHOOL_RESTRICT to_y) {
      const double edges = body_.radius + radius;
      const double reach = edges + (table_ ? range_of(*table_) : body_.range);
      alignas(64) T away_x[L], away_y[L];
      alignas(64) std::int64_t near[L];
      std::int64_t any = 0;
      for (int l = 0; l < L; ++l) {
        const double dx = to_x[l] - world_.x(robot_)[l], dy = to_y[l] - world_.y(robot_)[l];
        near[l] = dx * dx + dy * dy <= reach * reach;
        any |= near[l];
        away_x[l] = static_cast<T>(dx);
        away_y[l] = static_cast<T>(dy);
      }
      if (!any) return;
      for (int l = 0; l < L; ++l) {
        lane_[count_] = l;
        dx_[count_] = away_x[l];
        dy_[count_] = away_y[l];
        edges_[count_] = static_cast<T>(edges);
        count_ += static_cast<int>(near[l]);
      }
    }

    /// Adds their readings to each lane's, in the order in which they were looked at.
    void add(const Response& response, T* BOTSCHOOL_RESTRICT out) {
      for (int i = count_; i < count_ + L; ++i) lane_[i] = 0, dx_[i] = dy_[i] = edges_[i] = T(0);
      for (int first = 0; first < count_; first += L) {
        const int* lane = lane_ + first;
        alignas(64) T heading[L], gap[L], reading[size * L];
        for (int i = 0; i < L; ++i) heading[i] = heading_[lane[i]];
        Sight<T, L> sight;
        sight.look(dx_ + first, dy_ + first, heading);
        for (int i = 0; i < L; ++i) {
          const T d = sight.distance[i] - edges_[first + i];
          gap[i] = d > T(0) ? d : T(0);
        }
        if (table_)
          measured<T, L>(*table_, sight.angle, gap, reading);
        else
          modelled<T, L>(body_, response, sight.angle, gap, reading);
        const int found = count_ - first < L ? count_ - first : L;
        for (int i = 0; i < found; ++i)
          for (int s = 0; s < size; ++s) out[s * L + lane[i]] += reading[s * L + i];
      }
    }

   private:
    const W& world_;
    const int robot_;
    const RobotModel& body_;
    const InfraredTable* table_;
    T heading_[L];
    int count_ = 0;
    int lane_[(objects + 1) * L];
    T dx_[(objects + 1) * L], dy_[(objects + 1) * L], edges_[(objects + 1) * L];
  };

  template <class T, int L>
  static void modelled(const RobotModel& body, const Response& response,
                       const T* BOTSCHOOL_RESTRICT angle, const T* BOTSCHOOL_RESTRICT gap,
                       T* BOTSCHOOL_RESTRICT out) {
    alignas(64) T fade[L], seen[L];
    const T d0 = static_cast<T>(response.d0), range = static_cast<T>(body.range);
    for (int l = 0; l < L; ++l) {
      const T ratio = gap[l] / d0;
      fade[l] = body.n == 1 ? ratio : ratio * std::sqrt(ratio);
      seen[l] = gap[l] <= range ? T(1) : T(0);
    }
    // each pass goes over all sensors: many short chains of operations run faster than a long one
    const T width = static_cast<T>(response.w), power = static_cast<T>(response.m);
    alignas(64) T off[size * L];
    for (int s = 0; s < size; ++s) {
      const T direction = static_cast<T>(radians(body.direction[s]));
      for (int l = 0; l < L; ++l) off[s * L + l] = wrapped(angle[l] - direction) / width;
    }
    if (response.m == 2) {
      for (int i = 0; i < size * L; ++i) off[i] *= off[i];
    } else {
      for (int i = 0; i < size * L; ++i) {
        const T size = std::fabs(off[i]);
        off[i] = power * logarithm(size > T(1e-6) ? size : T(1e-6));
      }
      for (int i = 0; i < size * L; ++i) off[i] = exponential(off[i]);
    }
    for (int s = 0; s < size; ++s) {
      const T gain = static_cast<T>(body.gain[s]);
      for (int l = 0; l < L; ++l)
        out[s * L + l] = seen[l] * gain * exponential(-(fade[l] + off[s * L + l]));
    }
  }

  template <class T, int L>
  static void measured(const InfraredTable& table, const T* angle, const T* gap, T* out) {
    for (int l = 0; l < L; ++l) {
      const double* readings = readings_of(table, angle[l], gap[l]);
      for (int s = 0; s < size; ++s) out[s * L + l] = readings ? static_cast<T>(readings[s]) : T(0);
    }
  }
};

/// Standard deviations that the noise of sensors never reaches: of 24 bits, it ends at 5.9.
constexpr double kMaxNoise = 6;

/// Adds Gaussian noise, fresh in every step, to values `first` to `first + count - 1` of a robot's,
/// which draw from `blocks` blocks of four; its standard deviation is set for the world.
template <class W, class T>
void add_noise(const W& world, int robot, int blocks, int first, int count,
               T* BOTSCHOOL_RESTRICT out) {
  constexpr int L = W::lanes;
  const T deviation = static_cast<T>(world.options.noise);
  if (deviation == T(0)) return;
  alignas(64) std::uint32_t step[L];
  for (int l = 0; l < L; ++l) step[l] = static_cast<std::uint32_t>(world.state[W::kSteps][l]);
  for (int b = first / 4; 4 * b < first + count; ++b) {
    alignas(64) std::uint32_t word[4][L];
    alignas(64) T draw[4][L];
    philox_lanes<L>(world.key, Stream::sensor, step, static_cast<std::uint32_t>(robot * blocks + b),
                    word);
    for (int l = 0; l < L; ++l) {
      gaussian_pair(word[0][l], word[1][l], draw[0][l], draw[1][l]);
      gaussian_pair(word[2][l], word[3][l], draw[2][l], draw[3][l]);
    }
    const int begin = 4 * b > first ? 4 * b : first;
    for (int i = begin; i < first + count && i < 4 * b + 4; ++i)
      for (int l = 0; l < L; ++l) out[i * L + l] += deviation * draw[i % 4][l];
  }
}

/// A sensor with such noise.
template <class Sensor>
struct Noisy {
  static constexpr int size = Sensor::size;

  template <class W>
  static void bounds(const W& world, int robot, double* low, double* high) {
    Sensor::bounds(world, robot, low, high);
    for (int i = 0; i < size; ++i) {
      low[i] -= kMaxNoise * world.options.noise;
      high[i] += kMaxNoise * world.options.noise;
    }
  }

  template <class W, class T>
  static void read(const W& world, int robot, T* BOTSCHOOL_RESTRICT out) {
    Sensor::read(world, robot, out);
    add_noise(world, robot, (size + 3) / 4, 0, size, out);
  }
};

BOTSCHOOL_END
