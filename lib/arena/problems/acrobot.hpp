// Gymnasium's Acrobot (Sutton 1996; the book's equations): two links, torque at the elbow,
// fourth-order Runge-Kutta.
#pragma once

#include "../engine/reward.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct Acrobot : ProblemBase {
  static Info info() {
    Info info;
    info.name = "Acrobot-v1";
    info.observations = 6;
    info.outputs = 3;
    info.states = 4;
    info.limit = 500;
    info.discrete = true;
    info.low = 0;
    info.high = 2;
    info.seconds = 0.2;
    return info;
  }

  static constexpr bool movable = true;
  double state[4][L];  // theta1 (0 hangs), theta2 (against link 1), theta1', theta2'
  double sine1[L], cosine1[L], sine2[L], cosine2[L];

  void start(int lane, Random& random) {
    for (auto& value : state) value[lane] = random.uniform(-0.1, 0.1);
    refresh(lane);
  }
  void refresh(int lane) {
    sine_cosine(state[0][lane], sine1[lane], cosine1[lane]);
    sine_cosine(state[1][lane], sine2[lane], cosine2[lane]);
  }

  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int l = 0; l < L; ++l) {
      out[l] = static_cast<T>(cosine1[l]);
      out[L + l] = static_cast<T>(sine1[l]);
      out[2 * L + l] = static_cast<T>(cosine2[l]);
      out[3 * L + l] = static_cast<T>(sine2[l]);
      out[4 * L + l] = static_cast<T>(state[2][l]);
      out[5 * L + l] = static_cast<T>(state[3][l]);
    }
  }

  void quantities(Quantities<L>& q) const {
    q.row("angle1", "rad", "of the upper link; 0 hangs", state[0]);
    q.row("angle2", "rad", "of the lower link against the upper one", state[1]);
    q.row("spin1", "rad/s", "of the upper link", state[2]);
    q.row("spin2", "rad/s", "of the lower link against the upper one", state[3]);
    q.value("height", "m", "of the lower end above the hinge", [this](int l) {
      return -cosine1[l] - (cosine1[l] * cosine2[l] - sine1[l] * sine2[l]);
    });
  }

  /// Angular accelerations; masses, lengths and moments of inertia are 1, centres of mass at 0.5.
  BOTSCHOOL_INLINE static void accelerations(double s1, double c1, double s2, double c2,
                                             double omega1, double omega2, double torque,
                                             double& alpha1, double& alpha2) {
    constexpr double gravity = 9.8;
    const double d1 = 0.25 + (1.25 + c2) + 2.0, d2 = (0.25 + 0.5 * c2) + 1.0;
    const double inverse = 1.0 / d1;
    const double phi2 = 0.5 * gravity * (s1 * c2 + c1 * s2);
    const double phi1 =
        -0.5 * (omega2 * omega2) * s2 - (omega2 * omega1) * s2 + 1.5 * gravity * s1 + phi2;
    alpha2 = (torque + d2 * inverse * phi1 - 0.5 * (omega1 * omega1) * s2 - phi2) /
             (1.25 - d2 * d2 * inverse);
    alpha1 = -(d2 * alpha2 + phi1) * inverse;
  }

  void step(const double* BOTSCHOOL_RESTRICT action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    constexpr double dt = 0.2;
    // two registers of lanes side by side: a polynomial by itself waits for each of its terms
    BOTSCHOOL_UNROLL(2)
    for (int l = 0; l < L; ++l) {
      const double torque = action[l] - 1.0;
      const double t1 = state[0][l], t2 = state[1][l], w1 = state[2][l], w2 = state[3][l];
      double a1, a2;
      accelerations(sine1[l], cosine1[l], sine2[l], cosine2[l], w1, w2, torque, a1, a2);
      double angle1 = w1, angle2 = w2, speed1 = a1, speed2 = a2;  // weighted sums of the slopes
      double v1 = w1, v2 = w2;
      const auto stage = [&](double h, double weight) BOTSCHOOL_INLINE_LAMBDA {
        double s1, c1, s2, c2;
        sine_cosine(t1 + h * v1, s1, c1);
        sine_cosine(t2 + h * v2, s2, c2);
        v1 = w1 + h * a1;
        v2 = w2 + h * a2;
        accelerations(s1, c1, s2, c2, v1, v2, torque, a1, a2);
        angle1 += weight * v1;
        angle2 += weight * v2;
        speed1 += weight * a1;
        speed2 += weight * a2;
      };
      stage(dt / 2, 2.0);
      stage(dt / 2, 2.0);
      stage(dt, 1.0);
      const double next1 = wrapped(t1 + dt / 6 * angle1), next2 = wrapped(t2 + dt / 6 * angle2);
      state[0][l] = next1;
      state[1][l] = next2;
      state[2][l] = clamp(w1 + dt / 6 * speed1, -4 * kPi, 4 * kPi);
      state[3][l] = clamp(w2 + dt / 6 * speed2, -9 * kPi, 9 * kPi);
      sine_cosine(next1, sine1[l], cosine1[l]);
      sine_cosine(next2, sine2[l], cosine2[l]);
      const double both = cosine1[l] * cosine2[l] - sine1[l] * sine2[l];  // cos(theta1 + theta2)
      ended[l] = -cosine1[l] - both > 1.0;
      reward[l] = ended[l] ? 0.0 : -1.0;
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Acrobot)
