// A planar body that should run ahead, as a native problem. docs/specification.md, "Planar
// runners".
#pragma once

#include "../../engine/reward.hpp"
#include "bodies.hpp"
#include "dynamics.hpp"
#include "varied.hpp"

BOTSCHOOL_BEGIN

/// The reward of a runner, and the ends of its episode.
struct Race {
  double seconds;       ///< of a step
  int substeps;         ///< in a step
  double noise;         ///< start: coordinates and speeds are uniform within +-noise of the rest
  double alive = 0;     ///< paid for each step without a fall
  double effort = 0;    ///< price of the sum of squared actions
  double at_limit = 0;  ///< price of each hinge at its limit
  // a fall, which ends the episode
  double lowest = -1e9, highest = 1e9;  ///< height of the root
  double lean = 1e9;                    ///< its pitch
  int feet = -1;  ///< if not -1: contact points but the first `feet` must not touch the ground
};

template <class Body, int L>
struct Runner : ProblemBase {
  explicit Runner(const Race& of) : race(of) {}

  static constexpr int kWidth = kRegister / 4 < L ? kRegister / 4 : L;
  using Moving = Dynamics<Body, float, kWidth>;
  using V = Lanes<float, kWidth>;
  static constexpr int n = Moving::n, size = Moving::size, contacts = Moving::contacts;
  static constexpr int kStates = 2 * size + contacts;

  static Info describe(const char* name, const Race& race) {
    Info info;
    info.name = name;
    info.observations = 2 * size - 1;
    info.outputs = n - 1;
    info.states = kStates;
    info.limit = 1000;
    info.seconds = race.seconds;
    return info;
  }

  /// Positions and speeds of x, z and each segment's angle; mean force of each contact point in the
  /// last step.
  double state[kStates][L];
  const Race& race;
  Varied<L> varied;

  void set(const Setting& setting) {
    varied.physics = setting.space ? setting.space->physics : Physics{};
    varied.seconds = race.seconds;
  }

  void bounds(double* low, double* high) const {
    for (int i = size - 1; i < 2 * size - 1; ++i) {
      low[i] = -10;
      high[i] = 10;
    }
  }

  /// Height and pitch of the root, angle of each hinge, and the speeds of all, within +-10; the
  /// speed ahead comes first among them.
  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    for (int k = 1; k < size; ++k)
      for (int l = 0; l < L; ++l)
        out[(k - 1) * L + l] = static_cast<T>(varied.seen(l, k, relative(k, 0, l), 0.02));
    for (int k = 0; k < size; ++k)
      for (int l = 0; l < L; ++l) {
        const double rate = clamp(relative(k, size, l), -10.0, 10.0);
        out[(size - 1 + k) * L + l] = static_cast<T>(varied.seen(l, size + k, rate, 0.2));
      }
  }

  void start(int lane, Random& random) {
    for (auto& row : state) row[lane] = 0;
    for (int k = 0; k < size; ++k) {
      const int p = k < 3 ? -1 : Moving::up(k);
      const double angle = random.uniform(-race.noise, race.noise);
      const double speed = random.uniform(-race.noise, race.noise);
      state[k][lane] = angle + (p < 0 ? 0 : state[p][lane]);
      state[size + k][lane] = speed + (p < 0 ? 0 : state[size + p][lane]);
    }
    state[1][lane] += Body::start_height;
    varied.start(lane, random.key());
    state[1][lane] += varied.share[kBumps][lane];
    for (int k = 0; k < kPhases; ++k)  // waves go ahead only: sideways the ground is level
      varied.phase[k][lane] = k % 2 ? kPi / 2 : varied.any_phase(lane, k);
  }

  void quantities(Quantities<L>& q) const {
    q.row("x", "m", "place ahead", state[0]);
    q.growth("ahead", "m/s", "way ahead in this step, for each second", state[0]);
    q.row("height", "m", "of the torso", state[1]);
    q.row("pitch", "rad", "of the torso; 0 at rest, positive leans back", state[2]);
    q.value("upright", "", "cosine of the pitch", [this](int l) { return cosine_of(state[2][l]); });
    q.row("speed", "m/s", "speed ahead at the end of the step", state[size]);
    q.row("rise", "m/s", "speed upwards", state[size + 1]);
    q.row("spin", "rad/s", "of the torso", state[size + 2]);
    for (int i = 1; i < n; ++i) {
      const auto& part = Body::segments[i];
      q.value({part.name, "_angle"}, "rad", "angle of its hinge",
              [=](int l) { return relative(2 + i, 0, l); });
      q.value({part.name, "_rate"}, "rad/s", "rate of its hinge",
              [=](int l) { return relative(2 + i, size, l); });
      q.value({part.name, "_torque"}, "N m", "torque that its motor was told to give",
              [=, &part, &q](int l) { return part.hinge.torque * q.action(i - 1, l); });
    }
    for (int i = 0; i < n; ++i) {
      bool touches = false;
      for (const auto& point : Body::contacts) touches |= point.segment == i;
      if (!touches) continue;
      q.value({Body::segments[i].name, "_force"}, "N", "force of the ground on this part",
              [=](int l) {
                double sum = 0;
                for (int c = 0; c < contacts; ++c)
                  sum += Body::contacts[c].segment == i ? state[2 * size + c][l] : 0;
                return sum;
              });
    }
    q.value("power", "W", "of all motors, sizes added", [this, &q](int l) {
      double sum = 0;
      for (int i = 1; i < n; ++i) {
        const double p =
            Body::segments[i].hinge.torque * q.action(i - 1, l) * relative(2 + i, size, l);
        sum += p < 0 ? -p : p;
      }
      return sum;
    });
  }

  void step(const double* action, double* reward, std::int64_t* ended) {
    for (int first = 0; first < L; first += kWidth) {
      Moving body;
      load(body, first);
      V motor[n], effort = V(0.0f);
      for (int i = 0; i < n - 1; ++i) {
        double within[kWidth];
        for (int l = 0; l < kWidth; ++l)
          within[l] = limited(varied.arrived(first + l, i, action[i * L + first + l]), -1.0, 1.0);
        motor[i] = V::from(within);
        effort += motor[i] * motor[i];
      }
      if (varied.any()) vary(body, motor, first);
      varied.lay(body.terrain, first, V::from(&state[0][first]), V(0.0f));
      if (varied.pushes()) {
        double ahead[kWidth], left[kWidth];
        for (int l = 0; l < kWidth; ++l)
          varied.push(first + l, Moving::numbers.all[0], true, ahead[l], left[l]);
        body.speed[0] += V::from(ahead);
      }
      body.run(motor, race.substeps, float(race.seconds / race.substeps));
      const V standing = upright(body);
      const V earned = number(1 / race.seconds) * body.position[0] +
                       if_positive(standing, number(race.alive), V(0.0f)) -
                       number(race.effort) * effort - number(race.at_limit) * at_limit(body);
      const V real = real_numbers(body);
      const V pay = if_positive(real, earned, V(0.0f));
      const V going = if_positive(real, if_positive(standing, V(1.0f), V(0.0f)), V(0.0f));
      pay.to(reward + first);
      double goes[kWidth];
      going.to(goes);
      double whole[kWidth];
      if_positive(real, V(1.0f), V(0.0f)).to(whole);
      for (int l = 0; l < kWidth; ++l)
        ended[first + l] = goes[l] > 0 ? 0 : whole[l] > 0 ? 1 : kBroken;
      store(body, first, real, 1.0f / float(race.substeps));
    }
    varied.next();
  }

 private:
  static double cosine_of(double angle) {
    double sine, cosine;
    sine_cosine(angle, sine, cosine);
    return cosine;
  }

  /// A coordinate, or its speed with first = size, of a hinge against its segment's parent.
  double relative(int k, int first, int lane) const {
    return k < 3 ? state[first + k][lane]
                 : state[first + k][lane] - state[first + Moving::up(k)][lane];
  }

  static V number(double x) { return V(float(x)); }

  void vary(Moving& body, V* motor, int first) const {
    const auto share = [&](int kind) { return V::from(&varied.share[kind][first]); };
    body.lightness = V(1.0f) / share(kMass);
    body.grip = share(kFriction);
    body.firmness = share(kFirmness) * body.lightness;
    double weight[kWidth];
    for (int l = 0; l < kWidth; ++l) {
      const double pull = varied.share[kPull][first + l];
      weight[l] = pull < 0 ? 1 : pull / kGravity;
    }
    body.heaviness = V::from(weight);
    for (int i = 0; i < n - 1; ++i) motor[i] = share(kMotors) * motor[i];
  }

  void load(Moving& body, int first) const {
    for (int k = 0; k < size; ++k) {
      body.position[k] = V::from(&state[k][first]);
      body.speed[k] = V::from(&state[size + k][first]);
    }
    for (auto& change : body.change) change = V(0.0f);  // motors have changed: as good as unknown
    for (auto& force : body.load) force = V(0.0f);
    body.position[0] = V(0.0f);  // the way in this step; the whole way needs double precision
  }

  /// Writes the changes, except in lanes whose numbers are not `real`.
  void store(const Moving& body, int first, V real, float share) {
    double kept[kWidth], after[kWidth];
    real.to(kept);
    const auto write = [&](int row, V values, bool adds) {
      values.to(after);
      for (int l = 0; l < kWidth; ++l) {
        double& old = state[row][first + l];
        const double next = after[l] + (adds ? old : 0.0);
        old = kept[l] > 0 ? next : old;
      }
    };
    for (int k = 0; k < size; ++k) {
      write(k, body.position[k], k == 0);
      write(size + k, body.speed[k], false);
    }
    for (int c = 0; c < contacts; ++c) write(2 * size + c, V(share) * body.load[c], false);
  }

  /// Positive where the body has not fallen.
  V upright(const Moving& body) const {
    V height = body.position[1];
    const V pitch = body.position[2];
    if (!body.terrain.flat) height -= body.terrain.under(body.position[0], V(0.0f)).height;
    V margin = smaller(height - number(race.lowest), number(race.highest) - height);
    margin = smaller(margin, number(race.lean) - larger(pitch, -pitch));
    if (race.feet >= 0)
      for (int c = race.feet; c < contacts; ++c)
        margin = if_positive(body.load[c], V(-1.0f), margin);
    return margin;
  }

  /// The number of hinges in the outer hundredth of their range.
  static V at_limit(const Moving& body) {
    V count = V(0.0f);
    for (int i = 1; i < n; ++i) {
      const Hinge& hinge = Body::segments[i].hinge;
      const double middle = (hinge.low + hinge.high) / 2, half = (hinge.high - hinge.low) / 2;
      const V off = body.position[2 + i] - body.position[Moving::up(2 + i)] - number(middle);
      count += if_positive(larger(off, -off) - number(0.99 * half), V(1.0f), V(0.0f));
    }
    return count;
  }

  /// Positive unless a speed is too large or not a number.
  static V real_numbers(const Moving& body) {
    V sum = V(0.0f);
    for (int k = 0; k < size; ++k)
      sum += body.speed[k] * body.speed[k] + number(0.01) * body.position[k] * body.position[k];
    return number(kWildest * kWildest) - sum;
  }
};

BOTSCHOOL_END
