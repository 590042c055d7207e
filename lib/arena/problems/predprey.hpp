// A predator that has to catch a prey: two marXbots. docs/specification.md, "Wheeled robots".
#pragma once

#include "../robots/sensors.hpp"

BOTSCHOOL_BEGIN

inline constexpr Plan kPredprey{3000, 3000, 2, {{"marXbot", 400}, {"marXbot", 500}}, 0};

template <int L>
struct Predprey : World<L, kPredprey> {
  using Senses = Suite<Infrared, Camera, Gradient, Time, Bias>;
  static Info info() {
    Info info;
    info.name = "ErPredprey";
    info.observations = Senses::size;
    info.outputs = 2;
    info.states = Predprey::kRows;
    info.limit = 2000;
    info.seconds = kStepSeconds;
    info.robots = 2;
    info.plan = &kPredprey;
    return info;
  }
  void bounds(double* low, double* high) const { Senses::bounds(*this, 0, low, high); }

  void start(int lane, Random& random) {
    this->begin(lane, random);
    this->place(lane, 0, 1000, 1500, 0);
    this->place(lane, 1, 2000, 1500, kPi);
  }

  template <class T>
  void observe(T* out) const {
    for (int robot = 0; robot < 2; ++robot)
      Senses::read(*this, robot, out + robot * Senses::size * L);
  }

  /// The reward is the predator's.
  void step(const double* action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    Bump<L> predator, prey;
    this->drive(0, action, action + L, predator);
    this->drive(1, action + 2 * L, action + 3 * L, prey);
    this->tick();
    for (int l = 0; l < L; ++l) {
      ended[l] = predator.robot[l] | prey.robot[l];
      const double left = 1 - this->state[Predprey::kSteps][l] / this->limit;
      reward[l] = ended[l] ? left : 0;
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Predprey)
