// The rewards of a declared arena. docs/specification.md, "Declared arenas".
#pragma once

#include "world.hpp"

BOTSCHOOL_BEGIN

/// Cells of an explored arena, along a side.
constexpr int kCells = 8;

/// The middle of all robots, in every lane.
template <class W>
struct Middle {
  alignas(64) double x[W::lanes], y[W::lanes];

  explicit Middle(const W& world) {
    const double share = 1.0 / world.nrobots();
    for (int l = 0; l < W::lanes; ++l) x[l] = y[l] = 0;
    for (int r = 0; r < world.nrobots(); ++r)
      for (int l = 0; l < W::lanes; ++l) {
        x[l] += world.x(r)[l] * share;
        y[l] += world.y(r)[l] * share;
      }
  }
};

/// A flag for each lane.
template <int L>
struct Flags {
  alignas(64) std::int64_t lane[L];
  explicit Flags(std::int64_t value) {
    for (int l = 0; l < L; ++l) lane[l] = value;
  }
};

/// Rewards of all lanes after a step; several robots are paid as a team.
template <class W>
class Rewards {
  static constexpr int L = W::lanes;

 public:
  explicit Rewards(W& world) : world_(world), share_(1.0 / world.nrobots()) {}

  /// action: as given to step(); bumped: the result of each robot's step; before: the earlier
  /// middle.
  void pay(const double* action, const Flags<L>* bumped, const Middle<W>& before,
           double* BOTSCHOOL_RESTRICT reward) const {
    for (int l = 0; l < L; ++l) reward[l] = 0;
    switch (world_.declared->pay) {
      case Pay::avoid:
        return avoid(action, bumped, reward);
      case Pay::explore:
        for (int l = 0; l < L; ++l) reward[l] = visit(l);
        return;
      case Pay::near_cylinder:
        return near(world_.ncylinders(), world_.radius, W::kCylinder, reward);
      case Pay::near_light:
        return near(world_.nlights(), nullptr, W::kLight, reward);
      case Pay::on_zone:
        return on_zone(reward);
      case Pay::same_zone:
        return same_zone(reward);
      case Pay::every_zone:
        return every_zone(reward);
      case Pay::together:
        return together(before, reward);
    }
  }

  /// Marks the cells of a lane's robots as visited; returns how many are new.
  int visit(int lane) const {
    double* low = &world_.state[W::kVisited][lane];
    double* high = &world_.state[W::kVisited + 1][lane];
    std::uint64_t visited = whole(*low) | whole(*high) << 32;
    int fresh = 0;
    for (int r = 0; r < world_.nrobots(); ++r) {
      const int row = along(world_.y(r)[lane], world_.height);
      const int column = along(world_.x(r)[lane], world_.width);
      const std::uint64_t cell = std::uint64_t(1) << (kCells * row + column);
      fresh += visited & cell ? 0 : 1;
      visited |= cell;
    }
    *low = static_cast<double>(visited & 0xffffffffu);
    *high = static_cast<double>(visited >> 32);
    return fresh;
  }

 private:
  static int along(double x, double side) {
    return static_cast<int>(limited(x / side * kCells, 0, kCells - 1));
  }
  static std::uint64_t whole(double x) {
    return static_cast<std::uint64_t>(limited(x, 0, 4294967295.0));
  }

  /// Fast, straight and away from things (Floreano and Mondada 1994).
  void avoid(const double* action, const Flags<L>* bumped,
             double* BOTSCHOOL_RESTRICT reward) const {
    for (int r = 0; r < world_.nrobots(); ++r) {
      alignas(64) double gap[L];
      clearance(r, gap);
      const double* left = action + 2 * r * L;
      const double* right = left + L;
      for (int l = 0; l < L; ++l) {
        const double a = limited(left[l], -1, 1), b = limited(right[l], -1, 1);
        const double fast = a + b > 0 ? (a + b) / 2 : 0;
        const double straight = 1 - std::sqrt(std::fabs(a - b) / 2);
        const double clear = limited(gap[l] / world_.declared->distance, 0, 1);
        reward[l] += bumped[r].lane[l] ? 0 : fast * straight * clear * share_;
      }
    }
  }

  /// The distance from a robot's edge to the nearest obstacle.
  void clearance(int robot, double* BOTSCHOOL_RESTRICT gap) const {
    const double own = world_.model[robot]->radius;
    for (int l = 0; l < L; ++l) gap[l] = world_.width + world_.height;
    alignas(64) double to_x[L], to_y[L];
    for (int w = 0; w < world_.nwalls(); ++w) {
      world_.nearest_points(robot, world_.wall[w], to_x, to_y);
      approach(robot, own, to_x, to_y, gap);
    }
    for (int c = 0; c < world_.ncylinders(); ++c)
      approach(robot, own + world_.radius[c], world_.cylinder_x(c), world_.cylinder_y(c), gap);
    for (int other = 0; other < world_.nrobots(); ++other)
      if (other != robot)
        approach(robot, own + world_.model[other]->radius, world_.x(other), world_.y(other), gap);
  }

  void approach(int robot, double edges, const double* to_x, const double* to_y,
                double* BOTSCHOOL_RESTRICT gap) const {
    for (int l = 0; l < L; ++l) {
      const double dx = to_x[l] - world_.x(robot)[l], dy = to_y[l] - world_.y(robot)[l];
      const double away = std::sqrt(dx * dx + dy * dy) - edges;
      gap[l] = away < gap[l] ? away : gap[l];
    }
  }

  /// The share of robots near one of the objects; their positions begin at this row.
  void near(int things, const double* radius, int row, double* BOTSCHOOL_RESTRICT reward) const {
    for (int r = 0; r < world_.nrobots(); ++r) {
      Flags<L> is_near(0);
      for (int i = 0; i < things; ++i) {
        const double most =
            world_.model[r]->radius + (radius ? radius[i] : 0) + world_.declared->distance;
        reach(r, row + 2 * i, most, is_near);
      }
      for (int l = 0; l < L; ++l) reward[l] += is_near.lane[l] ? share_ : 0;
    }
  }

  /// Whether the robot's centre is nearer than that to the position in two rows of the state.
  void reach(int robot, int row, double most, Flags<L>& flags) const {
    for (int l = 0; l < L; ++l) {
      const double dx = world_.x(robot)[l] - world_.state[row][l];
      const double dy = world_.y(robot)[l] - world_.state[row + 1][l];
      flags.lane[l] |= dx * dx + dy * dy < most * most;
    }
  }

  Flags<L> on(int robot, int zone) const {
    Flags<L> flags(0);
    reach(robot, W::kZone + 2 * zone, world_.declared->zone[zone].radius, flags);
    return flags;
  }

  void on_zone(double* BOTSCHOOL_RESTRICT reward) const {
    for (int r = 0; r < world_.nrobots(); ++r) {
      Flags<L> any(0);
      for (int z = 0; z < world_.nzones(); ++z) {
        const Flags<L> here = on(r, z);
        for (int l = 0; l < L; ++l) any.lane[l] |= here.lane[l];
      }
      for (int l = 0; l < L; ++l) reward[l] += any.lane[l] ? share_ : 0;
    }
  }

  void same_zone(double* BOTSCHOOL_RESTRICT reward) const {
    for (int z = 0; z < world_.nzones(); ++z) {
      Flags<L> all(1);
      for (int r = 0; r < world_.nrobots(); ++r) {
        const Flags<L> here = on(r, z);
        for (int l = 0; l < L; ++l) all.lane[l] &= here.lane[l];
      }
      for (int l = 0; l < L; ++l) reward[l] = all.lane[l] ? 1 : reward[l];
    }
  }

  void every_zone(double* BOTSCHOOL_RESTRICT reward) const {
    Flags<L> all(1);
    for (int z = 0; z < world_.nzones(); ++z) {
      Flags<L> any(0);
      for (int r = 0; r < world_.nrobots(); ++r) {
        const Flags<L> here = on(r, z);
        for (int l = 0; l < L; ++l) any.lane[l] |= here.lane[l];
      }
      for (int l = 0; l < L; ++l) all.lane[l] &= any.lane[l];
    }
    for (int l = 0; l < L; ++l) reward[l] = all.lane[l] ? 1 : 0;
  }

  /// The way of the robots' middle, as a share of the longest, while each is near every other.
  void together(const Middle<W>& before, double* BOTSCHOOL_RESTRICT reward) const {
    const Middle<W> now(world_);
    double longest = 0;
    for (int r = 0; r < world_.nrobots(); ++r) longest += world_.speed[r] * kStepSeconds * share_;
    Flags<L> close(1);
    for (int r = 0; r < world_.nrobots(); ++r)
      for (int other = 0; other < r; ++other) {
        const double most =
            world_.model[r]->radius + world_.model[other]->radius + world_.declared->distance;
        Flags<L> pair(0);
        reach(r, 3 * other, most, pair);
        for (int l = 0; l < L; ++l) close.lane[l] &= pair.lane[l];
      }
    for (int l = 0; l < L; ++l) {
      const double dx = now.x[l] - before.x[l], dy = now.y[l] - before.y[l];
      const double way = limited(std::sqrt(dx * dx + dy * dy) / longest, 0, 1);
      reward[l] = close.lane[l] ? way : 0;
    }
  }

  W& world_;
  const double share_;
};

BOTSCHOOL_END
