// An arena that the user declares: robots, walls, cylinders, lights, zones, sensors, reward.
// docs/specification.md, "Declared arenas".
#pragma once

#include "../robots/rewards.hpp"
#include "../robots/sensors.hpp"

BOTSCHOOL_BEGIN

/// The most that can be declared.
inline constexpr Plan kDeclared{0,  0,          kMaxRobots, {},  0, kMaxCylinders, 0, kMaxWalls - 4,
                                {}, kMaxLights, kMaxZones,  true};
/// The arena where nothing is declared.
inline constexpr Plan kUndeclared{400, 400, 1, {{"Khepera"}}, 0};

template <int L>
struct Arena : World<L, kDeclared> {
  using Base = World<L, kDeclared>;
  using Base::declared, Base::state;

  static Info info() {
    Info info;
    info.name = "ErArena";
    info.gym = "botschool/Arena-v0";
    info.observations = observations_of(kDefaultDeclaration);
    info.outputs = 2;
    info.states = Base::kRows;
    info.limit = 1000;
    info.seconds = kStepSeconds;
    info.plan = &kUndeclared;
    return info;
  }

  static Info given(Info info, const Setting& setting) {
    if (setting.arena && setting.arena->declaration) {
      info.robots = setting.arena->declaration->robots;
      info.observations = observations_of(*setting.arena->declaration);
    }
    return info;
  }

  void bounds(double* low, double* high) const {
    for (int robot = 0; robot < this->nrobots(); ++robot) {
      double least[kMaxObservations], most[kMaxObservations];
      for_each_sense([&](auto sensor, int first, int size, bool noisy) {
        sensor.bounds(*this, robot, least + first, most + first);
        const double noise = noisy ? kMaxNoise * this->options.noise : 0;
        for (int i = first; i < first + size; ++i) {
          const double lower = least[i] - noise, higher = most[i] + noise;
          low[i] = robot == 0 || lower < low[i] ? lower : low[i];
          high[i] = robot == 0 || higher > high[i] ? higher : high[i];
        }
      });
    }
  }

  /// Places zones, lights, cylinders, robots. An object that does not fit is drawn again, up to
  /// 1000 times; objects with fixed places were checked before.
  void start(int lane, Random& random) {
    this->begin(lane, random);
    double x = 0, y = 0;
    for (int z = 0; z < declared->zones; ++z) {
      draw(random, declared->zone[z].spot, x, y, [&] { return apart_from_zones(lane, z, x, y); });
      this->place_zone(lane, z, x, y);
    }
    for (int i = 0; i < declared->lights; ++i) {
      draw(random, declared->light[i], x, y, [] { return true; });
      this->place_light(lane, i, x, y);
    }
    for (int c = 0; c < declared->cylinders; ++c) {
      const double radius = this->radius[c];
      draw(random, declared->cylinder[c].spot, x, y,
           [&] { return free(lane, x, y, radius, c, 0); });
      this->place_cylinder(lane, c, x, y);
    }
    for (int r = 0; r < declared->robots; ++r) {
      const double radius = this->model[r]->radius;
      draw(random, declared->robot[r].spot, x, y,
           [&] { return free(lane, x, y, radius, declared->cylinders, r); });
      const Range& heading = declared->robot[r].heading;
      this->place(lane, r, x, y, radians(random.uniform(heading.low, heading.high)));
    }
    state[Base::kVisited][lane] = state[Base::kVisited + 1][lane] = 0;
    Rewards<Base>(*this).visit(lane);
  }

  template <class T>
  void observe(T* out) const {
    const int size = observations_of(*declared);
    for (int robot = 0; robot < this->nrobots(); ++robot, out += size * L)
      for_each_sense([&](auto sensor, int first, int count, bool noisy) {
        sensor.read(*this, robot, out + first * L);
        if (noisy) add_noise(*this, robot, kMaxObservations / 4, first, count, out);
      });
  }

  void step(const double* action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    const Middle<Base> before(*this);
    const Rewards<Base> rewards(*this);
    Flags<L> bumped[kMaxRobots] = {Flags<L>(0), Flags<L>(0), Flags<L>(0), Flags<L>(0)};
    for (int r = 0; r < this->nrobots(); ++r) {
      Bump<L> bump;
      this->drive(r, action + 2 * r * L, action + (2 * r + 1) * L, bump);
      for (int l = 0; l < L; ++l)
        bumped[r].lane[l] = bump.wall[l] | bump.cylinder[l] | bump.robot[l];
    }
    this->tick();
    rewards.pay(action, bumped, before, reward);
    const std::int64_t ends = declared->bumps_end ? 1 : 0;
    for (int l = 0; l < L; ++l) {
      ended[l] = 0;
      for (int r = 0; r < this->nrobots(); ++r) ended[l] |= bumped[r].lane[l] & ends;
      reward[l] = ended[l] ? 0 : reward[l];
    }
  }

 private:
  /// Calls use(sensor, number of its first observation, how many, whether they have noise).
  template <class Use>
  void for_each_sense(Use use) const {
    int first = 0;
    for (int i = 0; i < declared->senses; ++i) {
      const int size = size_of(declared->sense[i], this->sensing);
      switch (declared->sense[i]) {
        case Sense::infrared:
          use(Infrared(), first, size, true);
          break;
        case Sense::camera:
          use(Camera(), first, size, true);
          break;
        case Sense::cylinders:
          use(CylinderCamera(), first, size, true);
          break;
        case Sense::ground:
          use(Ground(), first, size, true);
          break;
        case Sense::gradient:
          use(Gradient(), first, size, true);
          break;
        case Sense::light:
          use(Light(), first, size, true);
          break;
        case Sense::laser:
          use(Laser(), first, size, true);
          break;
        case Sense::time:
          use(Time(), first, size, false);
          break;
        case Sense::bias:
          use(Bias(), first, size, false);
          break;
      }
      first += size;
    }
  }

  template <class Fits>
  static void draw(Random& random, const Spot& spot, double& x, double& y, Fits fits) {
    const bool fixed = spot.x.low == spot.x.high && spot.y.low == spot.y.high;
    for (int attempt = 0; attempt < 1000; ++attempt) {
      x = random.uniform(spot.x.low, spot.x.high);
      y = random.uniform(spot.y.low, spot.y.high);
      if (fixed || fits()) return;
    }
  }

  static bool closer(double dx, double dy, double than) { return dx * dx + dy * dy < than * than; }

  bool apart_from_zones(int lane, int zone, double x, double y) const {
    for (int z = 0; z < zone; ++z) {
      const double sum = declared->zone[z].radius + declared->zone[zone].radius;
      if (closer(x - this->zone_x(z)[lane], y - this->zone_y(z)[lane], sum)) return false;
    }
    return true;
  }

  /// Returns whether a round object fits there, beside walls and the first so many cylinders and
  /// robots.
  bool free(int lane, double x, double y, double radius, int cylinders, int robots) const {
    for (int i = 0; i < this->nwalls(); ++i) {
      const Wall& w = this->wall[i];
      const double ux = w.x2 - w.x, uy = w.y2 - w.y, length2 = ux * ux + uy * uy;
      const double along = length2 > 0 ? ((x - w.x) * ux + (y - w.y) * uy) / length2 : 0;
      const double t = clamp(along, 0.0, 1.0);
      if (closer(x - w.x - t * ux, y - w.y - t * uy, radius)) return false;
    }
    for (int c = 0; c < cylinders; ++c)
      if (closer(x - this->cylinder_x(c)[lane], y - this->cylinder_y(c)[lane],
                 radius + this->radius[c]))
        return false;
    for (int r = 0; r < robots; ++r)
      if (closer(x - this->x(r)[lane], y - this->y(r)[lane], radius + this->model[r]->radius))
        return false;
    return true;
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Arena)
