// Gymnasium's CartPole (Barto, Sutton and Anderson 1983), explicit Euler.
#pragma once

#include "../engine/reward.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct CartPole : ProblemBase {
  static Info info() {
    Info info;
    info.name = "CartPole-v1";
    info.alias = "CartPole-v0";
    info.alias_limit = 200;
    info.observations = 4;
    info.outputs = 2;
    info.states = 4;
    info.limit = 500;
    info.discrete = true;
    info.seconds = 0.02;
    return info;
  }

  static constexpr bool movable = true;
  double state[4][L];  // x, x', theta, theta' (0 is upright)

  void start(int lane, Random& random) {
    for (auto& value : state) value[lane] = random.uniform(-0.05, 0.05);
  }

  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int i = 0; i < 4; ++i)
      for (int l = 0; l < L; ++l) out[i * L + l] = static_cast<T>(state[i][l]);
  }

  void quantities(Quantities<L>& q) const {
    q.row("x", "m", "place of the cart", state[0]);
    q.row("speed", "m/s", "of the cart", state[1]);
    q.row("angle", "rad", "of the pole; 0 is upright", state[2]);
    q.row("spin", "rad/s", "of the pole", state[3]);
  }

  void step(const double* BOTSCHOOL_RESTRICT action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    constexpr double gravity = 9.8, pole = 0.1, mass = 1.1, length = 0.5, dt = 0.02;
    constexpr double max_angle = 12 * 2 * kPi / 360;
    for (int l = 0; l < L; ++l) {
      const double x = state[0][l], v = state[1][l], angle = state[2][l], omega = state[3][l];
      const double force = action[l] > 0.5 ? 10.0 : -10.0;
      double s, c;
      sine_cosine(angle, s, c);
      const double temp = (force + pole * length * (omega * omega) * s) / mass;
      const double angular =
          (gravity * s - c * temp) / (length * (4.0 / 3.0 - pole * (c * c) / mass));
      const double linear = temp - pole * length * angular * c / mass;
      const double next_x = x + dt * v, next_angle = angle + dt * omega;
      state[0][l] = next_x;
      state[1][l] = v + dt * linear;
      state[2][l] = next_angle;
      state[3][l] = omega + dt * angular;
      reward[l] = 1.0;
      ended[l] =
          (next_x < -2.4) | (next_x > 2.4) | (next_angle < -max_angle) | (next_angle > max_angle);
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(CartPole)
