// Long double pole balancing without velocities (Wieland 1991): frictionless track,
// fourth-order Runge-Kutta, two steps of 0.01 s per action. Equations: docs/specification.md, "Classic
// control".
#pragma once

#include <cmath>

#include "../engine/reward.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct DoublePole : ProblemBase {
  static Info info() {
    Info info;
    info.name = "ErDpole";
    info.gym = "botschool/DoublePole-v0";
    info.observations = 3;
    info.outputs = 1;
    info.states = 6;
    info.limit = 1000;
    info.seconds = 0.02;
    return info;
  }

  static constexpr bool movable = true;
  double state[6][L];  // x, x', theta1, theta1', theta2, theta2' (0 is upright)

  void start(int lane, Random& random) {
    const double range[6] = {1.944, 1.215, 0.10472, 0.135088, 0.10472, 0.135088};
    for (int i = 0; i < 6; ++i) state[i][lane] = random.uniform(-range[i], range[i]);
  }

  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int l = 0; l < L; ++l) {
      out[l] = static_cast<T>(state[0][l] / 4.8);
      out[L + l] = static_cast<T>(state[2][l] / 0.52);
      out[2 * L + l] = static_cast<T>(state[4][l] / 0.52);
    }
  }

  void quantities(Quantities<L>& q) const {
    q.row("x", "m", "place of the cart", state[0]);
    q.row("speed", "m/s", "of the cart", state[1]);
    q.row("angle1", "rad", "of the long pole; 0 is upright", state[2]);
    q.row("spin1", "rad/s", "of the long pole", state[3]);
    q.row("angle2", "rad", "of the short pole; 0 is upright", state[4]);
    q.row("spin2", "rad/s", "of the short pole", state[5]);
  }

  static constexpr double kHalf[2] = {0.5, 0.25}, kMass[2] = {0.1, 0.05};
  static constexpr double kGravity = -9.8, kHinge = 2e-6, kCart = 1.0;

  /// Slopes of the six values of y under a force.
  BOTSCHOOL_INLINE static void slopes(const double* y, double force, double* slope) {
    double weight[2], cosine[2], push = force, mass = kCart;
    for (int p = 0; p < 2; ++p) {
      const double moment = kMass[p] * kHalf[p], omega = y[3 + 2 * p];
      double sine;
      sine_cosine(y[2 + 2 * p], sine, cosine[p]);
      weight[p] = kHinge / moment * omega + kGravity * sine;
      push += moment * (omega * omega) * sine + 0.75 * kMass[p] * cosine[p] * weight[p];
      mass += kMass[p] * (1 - 0.75 * (cosine[p] * cosine[p]));
    }
    const double acceleration = push / mass;
    slope[0] = y[1];
    slope[1] = acceleration;
    for (int p = 0; p < 2; ++p) {
      slope[2 + 2 * p] = y[3 + 2 * p];
      slope[3 + 2 * p] = (-0.75 / kHalf[p]) * (acceleration * cosine[p] + weight[p]);
    }
  }

  void step(const double* BOTSCHOOL_RESTRICT action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    constexpr double h = 0.01, max_angle = 0.628329;
    for (int half = 0; half < 2; ++half) {
      for (int l = 0; l < L; ++l) {
        const double force = 10.0 * action[l];
        double y[6], at[6], k[6], sum[6];
        for (int i = 0; i < 6; ++i) y[i] = state[i][l];
        slopes(y, force, k);
        for (int i = 0; i < 6; ++i) sum[i] = k[i], at[i] = y[i] + h / 2 * k[i];
        slopes(at, force, k);
        for (int i = 0; i < 6; ++i) sum[i] += 2 * k[i], at[i] = y[i] + h / 2 * k[i];
        slopes(at, force, k);
        for (int i = 0; i < 6; ++i) sum[i] += 2 * k[i], at[i] = y[i] + h * k[i];
        slopes(at, force, k);
        for (int i = 0; i < 6; ++i) state[i][l] = y[i] + h / 6 * (sum[i] + k[i]);
      }
    }
    for (int l = 0; l < L; ++l) {
      const double x = state[0][l], a = state[2][l], b = state[4][l];
      // written so that NaN fails too
      const bool fine = (x >= -2.4) & (x <= 2.4) & (a >= -max_angle) & (a <= max_angle) &
                        (b >= -max_angle) & (b <= max_angle);
      const double far = std::fabs(x) + std::fabs(a) + std::fabs(b);
      ended[l] = fine ? 0 : far < 1e6 ? 1 : kBroken;
      reward[l] = fine ? 1.0 : 0.0;
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(DoublePole)
