// Cart-pole swing-up (Deisenroth and Rasmussen 2011), explicit Euler. Equations:
// docs/specification.md, "Classic control".
#pragma once

#include "../engine/reward.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct Swingup : ProblemBase {
  static Info info() {
    Info info;
    info.name = "envSwingupCustom";
    info.gym = "botschool/SwingUp-v0";
    info.observations = 5;
    info.outputs = 1;
    info.states = 4;
    info.limit = 1000;
    info.seconds = 0.01;
    return info;
  }
  void bounds(double* low, double* high) const {
    low[2] = low[3] = -1;  // cosine and sine of the angle
    high[2] = high[3] = 1;
  }

  static constexpr bool movable = true;
  double state[4][L];  // x, x', theta (0 is upright), theta'
  double sine[L], cosine[L];

  void start(int lane, Random& random) {
    for (int i = 0; i < 4; ++i) state[i][lane] = (i == 2 ? kPi : 0.0) + 0.2 * random.gaussian();
    refresh(lane);
  }
  void refresh(int lane) { sine_cosine(state[2][lane], sine[lane], cosine[lane]); }

  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int l = 0; l < L; ++l) {
      out[l] = static_cast<T>(state[0][l]);
      out[L + l] = static_cast<T>(state[1][l]);
      out[2 * L + l] = static_cast<T>(cosine[l]);
      out[3 * L + l] = static_cast<T>(sine[l]);
      out[4 * L + l] = static_cast<T>(state[3][l]);
    }
  }

  void quantities(Quantities<L>& q) const {
    q.row("x", "m", "place of the cart", state[0]);
    q.row("speed", "m/s", "of the cart", state[1]);
    q.row("angle", "rad", "of the pole; 0 is upright", state[2]);
    q.row("spin", "rad/s", "of the pole", state[3]);
    q.row("upright", "", "cosine of the angle", cosine);
  }

  void step(const double* BOTSCHOOL_RESTRICT action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    constexpr double cart = 0.5, pole = 0.5, length = 0.6, gravity = 9.82, friction = 0.1;
    constexpr double mass = cart + pole, dt = 0.01;
    for (int l = 0; l < L; ++l) {
      const double v = state[1][l], omega = state[3][l], s = sine[l], c = cosine[l];
      const double push = 10.0 * limited(action[l], -1.0, 1.0) - friction * v;
      const double spin = pole * length * (omega * omega) * s;
      const double linear =
          (-2 * spin + 3 * pole * gravity * s * c + 4 * push) / (4 * mass - 3 * pole * (c * c));
      const double angular = (-3 * spin * c + 6 * mass * gravity * s + 6 * push * c) /
                             (4 * length * mass - 3 * pole * length * (c * c));
      state[0][l] += dt * v;
      state[1][l] = v + dt * linear;
      state[2][l] += dt * omega;
      state[3][l] = omega + dt * angular;
    }
    for (int l = 0; l < L; ++l) {
      const double x = state[0][l];
      double unused, position;
      sine_cosine(state[2][l], sine[l], cosine[l]);
      sine_cosine(x / 2.4 * (kPi / 2), unused, position);
      reward[l] = (cosine[l] + 1) / 2 * position;
      ended[l] = (x < -2.4) | (x > 2.4);
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Swingup)
