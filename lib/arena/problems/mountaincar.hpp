// Gymnasium's MountainCarContinuous (Moore 1990). As there, each step rounds the state to single
// precision, and the action before clipping determines the cost.
#pragma once

#include "../engine/reward.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct MountainCarContinuous : ProblemBase {
  static Info info() {
    Info info;
    info.name = "MountainCarContinuous-v0";
    info.observations = 2;
    info.outputs = 1;
    info.states = 2;
    info.limit = 999;
    info.seconds = 1.0 / 30;
    return info;
  }

  static constexpr bool movable = true;
  double state[2][L];  // position, velocity

  void start(int lane, Random& random) {
    state[0][lane] = random.uniform(-0.6, -0.4);
    state[1][lane] = 0.0;
  }

  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int i = 0; i < 2; ++i)
      for (int l = 0; l < L; ++l) out[i * L + l] = static_cast<T>(state[i][l]);
  }

  void quantities(Quantities<L>& q) const {
    q.row("x", "", "place of the car; the goal is at 0.45", state[0]);
    q.row("speed", "1/step", "of the car", state[1]);
    q.value("height", "", "of the hill where the car is", [this](int l) {
      double sine, cosine;
      sine_cosine(3 * state[0][l], sine, cosine);
      return 0.45 * sine + 0.55;
    });
  }

  void step(const double* BOTSCHOOL_RESTRICT action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    // in two loops: in one, the compiler makes a choice between conditions that it cannot vectorise
    alignas(64) double position[L], velocity[L];
    for (int l = 0; l < L; ++l) {
      const double force = limited(action[l], -1.0, 1.0);
      double sine, cosine;
      sine_cosine(3 * state[0][l], sine, cosine);
      velocity[l] = clamp(state[1][l] + (force * 0.0015 - 0.0025 * cosine), -0.07, 0.07);
      position[l] = clamp(state[0][l] + velocity[l], -1.2, 0.6);
    }
    for (int l = 0; l < L; ++l) {
      const double x = position[l], v = velocity[l];
      const bool there = (x >= 0.45) & (v >= 0), wall = (x == -1.2) & (v < 0);
      ended[l] = there;
      reward[l] = (there ? 100.0 : 0.0) - action[l] * action[l] * 0.1;
      state[0][l] = static_cast<float>(x);
      state[1][l] = static_cast<float>(wall ? 0.0 : v);
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(MountainCarContinuous)
