// A Khepera that has to find a cylinder by infrared, and to stay near it.
// docs/specification.md, "Wheeled robots".
#pragma once

#include "../robots/sensors.hpp"

BOTSCHOOL_BEGIN

inline constexpr Plan kDiscrim{400, 400, 1, {{"Khepera"}}, 0.03, 1, 12.5};

template <int L>
struct Discrim : World<L, kDiscrim> {
  using Senses = Noisy<Infrared>;
  static Info info() {
    Info info;
    info.name = "ErDiscrim";
    info.gym = "botschool/Discrim-v0";
    info.observations = Senses::size;
    info.outputs = 2;
    info.states = Discrim::kRows;
    info.limit = 500;
    info.seconds = kStepSeconds;
    info.plan = &kDiscrim;
    return info;
  }
  void bounds(double* low, double* high) const { Senses::bounds(*this, 0, low, high); }

  void start(int lane, Random& random) {
    this->begin(lane, random);
    const double cylinder_x = random.uniform(100, 300), cylinder_y = random.uniform(100, 200);
    this->place_cylinder(lane, 0, cylinder_x, cylinder_y);
    const double heading = random.uniform(0, 2 * kPi), x = random.uniform(150, 250);
    this->place(lane, 0, x, random.uniform(270, 370), heading);
  }

  template <class T>
  void observe(T* out) const {
    Senses::read(*this, 0, out);
  }

  void step(const double* action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    Bump<L> bump;
    this->drive(0, action, action + L, bump);
    this->tick();
    const double near = this->model[0]->radius + this->radius[0] + 60;
    for (int l = 0; l < L; ++l) {
      const double dx = this->x(0)[l] - this->cylinder_x(0)[l];
      const double dy = this->y(0)[l] - this->cylinder_y(0)[l];
      ended[l] = bump.wall[l] | bump.cylinder[l];
      reward[l] = !ended[l] & (dx * dx + dy * dy < near * near) ? 1 : 0;
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Discrim)
