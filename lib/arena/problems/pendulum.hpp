// Gymnasium's Pendulum: swing up and balance with a weak motor; semi-implicit Euler.
#pragma once

#include "../engine/reward.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct Pendulum : ProblemBase {
  static Info info() {
    Info info;
    info.name = "Pendulum-v1";
    info.alias = "Pendulum-v0";
    info.alias_limit = 200;
    info.observations = 3;
    info.outputs = 1;
    info.states = 2;
    info.limit = 200;
    info.low = -2;
    info.high = 2;
    info.seconds = 0.05;
    return info;
  }

  static constexpr bool movable = true;
  double state[2][L];  // theta (0 is upright, unbounded), theta'
  double sine[L], cosine[L];

  void start(int lane, Random& random) {
    state[0][lane] = random.uniform(-kPi, kPi);
    state[1][lane] = random.uniform(-1.0, 1.0);
    refresh(lane);
  }
  void refresh(int lane) { sine_cosine(state[0][lane], sine[lane], cosine[lane]); }

  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int l = 0; l < L; ++l) {
      out[l] = static_cast<T>(cosine[l]);
      out[L + l] = static_cast<T>(sine[l]);
      out[2 * L + l] = static_cast<T>(state[1][l]);
    }
  }

  void quantities(Quantities<L>& q) const {
    q.value("angle", "rad", "0 is upright; from -pi to pi",
            [this](int l) { return wrapped(state[0][l]); });
    q.row("spin", "rad/s", "of the pendulum", state[1]);
    q.row("upright", "", "cosine of the angle", cosine);
  }

  void step(const double* BOTSCHOOL_RESTRICT action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    constexpr double gravity = 10, mass = 1, length = 1, dt = 0.05;
    for (int l = 0; l < L; ++l) {
      const double angle = wrapped(state[0][l]), omega = state[1][l];
      const double torque = limited(action[l], -2.0, 2.0);
      reward[l] = -(angle * angle + 0.1 * (omega * omega) + 0.001 * (torque * torque));
      const double acceleration =
          3 * gravity / (2 * length) * sine[l] + 3.0 / (mass * length * length) * torque;
      const double next_omega = clamp(omega + acceleration * dt, -8.0, 8.0);
      state[0][l] += next_omega * dt;
      state[1][l] = next_omega;
      ended[l] = 0;
    }
    for (int l = 0; l < L; ++l) sine_cosine(state[0][l], sine[l], cosine[l]);
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Pendulum)
