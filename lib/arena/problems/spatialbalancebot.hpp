// A body on two wheels that should stay upright, in space: the twin of what exercise 10 builds.
// docs/specification.md, "SpatialBalanceBot-v0".
#pragma once

#include "../robots/jointed/balancer.hpp"
#include "../robots/jointed/racer.hpp"

BOTSCHOOL_BEGIN

inline constexpr Course kBalanceCourse{&kBalanceBot, 0.01, 5, 0, 0, false, 0.15, 1e9};

template <int L>
struct SpatialBalanceBot : Racer<L> {
  using Base = Racer<L>;
  using Base::kWidth, Base::moving, Base::rows, Base::state, Base::varied;
  using typename Base::V;
  static constexpr double kFastest = 24.6;  ///< rad/s
  static constexpr double kGravityHere = 10;

  SpatialBalanceBot() : Base(kBalanceCourse) { moving.gravity = float(kGravityHere); }

  static Info info() {
    Info info = Base::describe("SpatialBalanceBot-v0", kBalanceCourse);
    info.observations = 3;
    info.outputs = 1;
    info.states += 1;  // the target speed of the wheels
    info.limit = 500;
    return info;
  }

  void bounds(double* low, double* high) const {
    high[0] = kPi;
    high[2] = kFastest;
    for (int k = 0; k < 3; k += 2) low[k] = -high[k];
  }

  void start(int lane, Random& random) {
    Base::start(lane, random);
    const double lean = random.uniform(-0.3, 0.3);
    double sine, cosine;
    sine_cosine(lean, sine, cosine);
    state[1][lane] = -0.3 * sine;
    state[2][lane] += 0.1 + 0.2 * cosine;
    sine_cosine(lean / 2, state[4][lane], state[3][lane]);
    state[rows.count()][lane] = 0;
  }

  /// How far the body leans, the part of its angular velocity around x, and the target speed.
  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    const auto* spin = &state[rows.speed() + 3];
    for (int l = 0; l < L; ++l) {
      const double w = state[3][l], x = state[4][l], y = state[5][l], z = state[6][l];
      const double lean = arctangent(2 * (w * x + y * z), w * w - x * x - y * y + z * z);
      const double turning = (1 - 2 * (y * y + z * z)) * spin[0][l] +
                             2 * (x * y - w * z) * spin[1][l] + 2 * (x * z + w * y) * spin[2][l];
      out[l] = static_cast<T>(varied.seen(l, 0, lean, 0.02));
      out[L + l] = static_cast<T>(varied.seen(l, 1, turning, 0.2));
      out[2 * L + l] = static_cast<T>(state[rows.count()][l]);
    }
  }

  void quantities(Quantities<L>& q) const {
    Base::quantities(q);
    q.row("target", "rad/s", "speed that the wheels should have", state[rows.count()]);
  }

  void step(const double* action, double* reward, std::int64_t* ended) {
    double* speed = state[rows.count()];
    for (int first = 0; first < L; first += kWidth) {
      double target[kWidth], goes[kWidth], good[kWidth];
      for (int l = 0; l < kWidth; ++l) {
        const double given = varied.arrived(first + l, 0, action[first + l]);
        target[l] = limited(speed[first + l] + limited(given, -1, 1), -kFastest, kFastest);
      }
      this->load(first);
      const V wheel = V::from(target), motor[] = {wheel, -wheel};
      moving.run(motor, kBalanceCourse.substeps,
                 float(kBalanceCourse.seconds / kBalanceCourse.substeps));
      const V real = this->real_numbers();
      if_positive(real, V(1.0f), V(0.0f)).to(good);
      (moving.place.z - this->number(kBalanceCourse.low)).to(goes);
      this->keep(first, real);
      for (int l = 0; l < kWidth; ++l) {
        const double price = target[l] < 0 ? -target[l] : target[l];
        reward[first + l] = good[l] * (1 - 0.05 * price);
        ended[first + l] = good[l] > 0 ? !(goes[l] >= 0) : kBroken;
        speed[first + l] = good[l] > 0 ? target[l] : speed[first + l];
      }
    }
    varied.next();
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(SpatialBalanceBot)
