// A body in space that should run ahead, or stand up, as a native problem.
// docs/specification.md, "Bodies in space".
#pragma once

#include "../../engine/reward.hpp"
#include "solids.hpp"
#include "space.hpp"
#include "varied.hpp"

BOTSCHOOL_BEGIN

/// Rows of a state: coordinates and speeds as MuJoCo has them (the root's place, its quaternion with w
/// first, the angles of hinges; the root's velocity, its angular velocity along its own axes, the rates
/// of hinges), then of each ball how far the ground holds it back (x, y, z), and its force across the
/// ground in the last substep.
struct Rows {
  int links, balls;
  int speed() const { return links + 6; }
  int stretch() const { return 2 * links + 11; }
  int load() const { return stretch() + 3 * balls; }
  int count() const { return load() + balls; }
};
constexpr int kMaxRows = 2 * kMaxLinks + 11 + 4 * kMaxBalls;

/// Puts W lanes of a state into a body. x and y of its place become 0: the whole way needs double
/// precision. held: of each ball whether its rows may differ from 0.
template <class Body, class F>
void load_state(Body& body, const Rows& rows, const bool* held, F row) {
  using V = typename Body::V;
  body.place = {V(0), V(0), row(2)};
  for (int k = 0; k < 4; ++k) body.attitude[k] = row(3 + k);
  for (int i = 1; i < rows.links; ++i) {
    body.angle[i] = row(6 + i);
    body.rate[i] = row(rows.speed() + 5 + i);
  }
  const int s = rows.speed();
  body.speed.move = {row(s), row(s + 1), row(s + 2)};
  body.put(0);
  body.speed.turn = body.part[0].turned.times({row(s + 3), row(s + 4), row(s + 5)});
  for (int c = 0; c < rows.balls; ++c) {
    body.held[c] = held[c];
    if (!held[c]) continue;
    const int first = rows.stretch() + 3 * c;
    body.stretch[c] = {row(first), row(first + 1), row(first + 2)};
    body.load[c] = row(rows.load() + c);
  }
}

/// The other way: write(row, lanes). held: as before.
template <class Body, class F>
void store_state(Body& body, const Rows& rows, const bool* held, F write) {
  using V = typename Body::V;
  write(0, body.place.x);
  write(1, body.place.y);
  write(2, body.place.z);
  for (int k = 0; k < 4; ++k) write(3 + k, body.attitude[k]);
  for (int i = 1; i < rows.links; ++i) {
    write(6 + i, body.angle[i]);
    write(rows.speed() + 5 + i, body.rate[i]);
  }
  body.put(0);
  const auto spin = body.part[0].turned.back(body.speed.turn);
  const V six[] = {body.speed.move.x, body.speed.move.y, body.speed.move.z, spin.x, spin.y, spin.z};
  for (int k = 0; k < 6; ++k) write(rows.speed() + k, six[k]);
  for (int c = 0; c < rows.balls; ++c) {
    if (!body.held[c]) {
      for (int k = 0; held[c] && k < 3; ++k) write(rows.stretch() + 3 * c + k, V(0));
      if (held[c]) write(rows.load() + c, V(0));
      continue;
    }
    const V three[] = {body.stretch[c].x, body.stretch[c].y, body.stretch[c].z};
    for (int k = 0; k < 3; ++k) write(rows.stretch() + 3 * c + k, three[k]);
    write(rows.load() + c, body.load[c]);
  }
}

template <int L>
struct Racer : ProblemBase {
  static constexpr int kWidth = kRegister / 4 < L ? kRegister / 4 : L;
  using Moving = Space<float, kWidth>;
  using V = Lanes<float, kWidth>;

  explicit Racer(const Course& of) : own(&of) { set({}); }

  static Info describe(const char* name, const Course& course) {
    const Solid& solid = *course.solid;
    const Rows rows{solid.links, Balls(solid).count};
    Info info;
    info.name = name;
    info.observations = solid.fixed ? 2 * solid.links - 2 : rows.stretch() - 2;
    info.outputs = solid.motors;
    info.states = rows.count();
    info.limit = 1000;
    info.low = -course.range;
    info.high = course.range;
    info.seconds = course.seconds;
    return info;
  }

  static Info given(const Info& info, const Setting& setting) {
    const bool declared = setting.space && setting.space->course;
    return declared ? describe(info.name, *setting.space->course) : info;
  }

  void set(const Setting& setting) {
    const SpaceOptions options = setting.space ? *setting.space : SpaceOptions{};
    course = options.course ? options.course : own;
    const Balls balls(*course->solid);
    rows = {course->solid->links, balls.count};
    name_contacts(balls);
    moving.read(*course->solid, course->solid->firm);
    varied.physics = options.physics;
    varied.seconds = course->seconds;
    mass = 0;
    for (int i = 0; i < rows.links; ++i) mass += course->solid->link[i].mass;
  }

  double state[kMaxRows][L];
  const Course *own, *course;
  Rows rows;
  double mass;
  bool held[L / kWidth][kMaxBalls] = {};  ///< of each ball whether its rows may differ from 0
  const char* contact[kMaxLinks];  ///< names of shapes other than those of links, and of each ball
  int contacts, contact_of[kMaxBalls];  ///< which it has, or -1
  Varied<L> varied;

  /// The coordinates but x and y, and the speeds; of a fixed root none.
  template <class T>
  void observe(T* BOTSCHOOL_RESTRICT out) const {
    const bool fixed = course->solid->fixed;
    for (int k = fixed ? 7 : 2; k < rows.stretch(); ++k) {
      if (fixed && k == rows.speed()) k += 6;
      for (int l = 0; l < L; ++l)
        *out++ = static_cast<T>(varied.seen(l, k, state[k][l], k < rows.speed() ? 0.02 : 0.2));
    }
  }

  /// Somebody wrote the state.
  void refresh(int) {
    for (auto& group : held)
      for (bool& ball : group) ball = true;
  }

  void start(int lane, Random& random) {
    varied.start(lane, random.key());
    for (int k = 0; k < rows.count(); ++k) state[k][lane] = 0;
    const Solid& solid = *course->solid;
    const double noise = course->noise;
    for (int k = 0; k < rows.speed(); ++k) state[k][lane] = random.uniform(-noise, noise);
    for (int k = rows.speed(); k < rows.stretch(); ++k)
      state[k][lane] = course->gaussian ? noise * random.gaussian() : random.uniform(-noise, noise);
    if (solid.fixed)
      for (int k = 0; k < 7; ++k) state[k][lane] = state[rows.speed() + k % 6][lane] = 0;
    state[2][lane] += course->height;
    if (course->pose)
      for (int k = 3; k < 6 + rows.links; ++k) state[k][lane] += course->pose[k - 3];
    else
      state[3][lane] += 1;
    double square = 0;
    for (int k = 3; k < 7; ++k) square += state[k][lane] * state[k][lane];
    for (int k = 3; k < 7; ++k) state[k][lane] /= std::sqrt(square);
    for (int i = 1; i < rows.links; ++i) {
      const Hinge& hinge = solid.link[i].hinge;
      if (hinge.low < hinge.high)
        state[6 + i][lane] = limited(state[6 + i][lane], hinge.low, hinge.high);
    }
    state[2][lane] += solid.fixed ? 0 : varied.share[kBumps][lane];
    for (auto& row : varied.phase) row[lane] = random.uniform(-kPi, kPi);
  }

  /// Of the motor of link i for an action.
  double torque(int i, double action, int lane) const {
    const Link& link = course->solid->link[i];
    const Drive& drive = link.drive;
    if (drive.least >= drive.most) return link.hinge.torque * action;
    return limited(drive.still + (action > 0 ? drive.up : drive.down) * action -
                       drive.pull * state[6 + i][lane] -
                       drive.drag * state[rows.speed() + 5 + i][lane],
                   drive.least, drive.most);
  }

  void quantities(Quantities<L>& q) const {
    const int s = rows.speed();
    const auto turn = [this](int l, double& w, double& x, double& y, double& z) {
      w = state[3][l], x = state[4][l], y = state[5][l], z = state[6][l];
    };
    q.row("x", "m", "place ahead", state[0]);
    q.row("y", "m", "place to the left", state[1]);
    q.row("height", "m", "of the root", state[2]);
    q.growth("ahead", "m/s", "way ahead in this step, for each second", state[0]);
    q.growth("sideways", "m/s", "way to the left in this step, for each second", state[1]);
    q.row("speed", "m/s", "speed ahead at the end of the step", state[s]);
    q.row("rise", "m/s", "speed upwards", state[s + 2]);
    q.value("upright", "", "how much the root's own z axis points up: 1 upright, -1 on its head",
            [=](int l) {
              double w, x, y, z;
              turn(l, w, x, y, z);
              return 1 - 2 * (x * x + y * y);
            });
    q.value("heading", "rad", "direction of the root, 0 ahead, positive to the left", [=](int l) {
      double w, x, y, z;
      turn(l, w, x, y, z);
      return arctangent(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
    });
    q.value("spin", "rad/s", "of the root around the vertical, positive to the left", [=](int l) {
      double w, x, y, z;
      turn(l, w, x, y, z);
      return 2 * (x * z - w * y) * state[s + 3][l] + 2 * (y * z + w * x) * state[s + 4][l] +
             (1 - 2 * (x * x + y * y)) * state[s + 5][l];
    });
    const Solid& solid = *course->solid;
    for (int i = 1; i < rows.links; ++i) {
      const Link& link = solid.link[i];
      q.row({link.name, "_angle"}, "rad", "angle of this joint", state[6 + i]);
      q.row({link.name, "_rate"}, "rad/s", "rate of this joint", state[s + 5 + i]);
      if (link.motor >= 0 && (link.hinge.torque > 0 || link.drive.least < link.drive.most))
        q.value({link.name, "_torque"}, "N m", "torque that its motor gives at the end of the step",
                [&](int l) { return torque(i, q.action(link.motor, l), l); });
    }
    const auto& numbers = moving.numbers;
    for (int i = 0; i < rows.links; ++i) {
      int touching = 0;
      for (int c = 0; c < rows.balls; ++c) touching += numbers.ball[c].link == i;
      if (touching)
        q.value({solid.link[i].name, "_force"}, "N", "force of the ground on this part",
                [&](int l) {
                  double sum = 0;
                  for (int c = 0; c < rows.balls; ++c)
                    sum += numbers.ball[c].link == i ? state[rows.load() + c][l] : 0;
                  return sum;
                });
    }
    for (int k = 0; k < contacts; ++k)
      q.value({contact[k], "_force"}, "N", "force of the ground on this shape", [&](int l) {
        double sum = 0;
        for (int c = 0; c < rows.balls; ++c)
          sum += contact_of[c] == k ? state[rows.load() + c][l] : 0;
        return sum;
      });
    q.value("power", "W", "of all motors, sizes added", [&](int l) {
      double sum = 0;
      for (int i = 1; i < rows.links; ++i) {
        const Link& link = solid.link[i];
        if (link.motor < 0) continue;
        const double p = torque(i, q.action(link.motor, l), l) * state[s + 5 + i][l];
        sum += p < 0 ? -p : p;
      }
      return sum;
    });
  }

  void step(const double* action, double* reward, std::int64_t* ended) {
    for (int first = 0; first < L; first += kWidth) {
      load(first);
      V motor[kMaxLinks], effort = V(0.0f);
      for (int i = 0; i < course->solid->motors; ++i) {
        double within[kWidth];
        for (int l = 0; l < kWidth; ++l) {
          const double given = varied.arrived(first + l, i, action[i * L + first + l]);
          within[l] = limited(given, -course->range, course->range);
        }
        motor[i] = V::from(within);
        effort += motor[i] * motor[i];
      }
      V way = course->centre ? -moving.ahead() : V(0.0f);
      moving.run(motor, course->substeps, float(course->seconds / course->substeps));
      way += moving.place.x;
      if (course->centre) way += moving.ahead();
      const V height = moving.place.z;
      const V standing = smaller(height - number(course->low), number(course->high) - height);
      const V earned =
          number(course->ahead / course->seconds) * way + number(course->lift) * height +
          if_positive(standing, number(course->alive), V(0.0f)) - number(course->effort) * effort;
      const V real = real_numbers();
      if_positive(real, earned, V(0.0f)).to(reward + first);
      double goes[kWidth];
      if_positive(real, if_positive(standing, V(1.0f), V(0.0f)), V(0.0f)).to(goes);
      double whole[kWidth];
      if_positive(real, V(1.0f), V(0.0f)).to(whole);
      for (int l = 0; l < kWidth; ++l)
        ended[first + l] = goes[l] > 0 ? 0 : whole[l] > 0 ? 1 : kBroken;
      keep(first, real);
    }
    varied.next();
  }

 protected:
  void name_contacts(const Balls& balls) {
    contacts = 0;
    for (int c = 0; c < balls.count; ++c) {
      const char* name = balls.ball[c].name;
      bool known = !*name;
      for (int i = 0; i < rows.links; ++i) known |= !std::strcmp(name, course->solid->link[i].name);
      contact_of[c] = -1;
      for (int k = 0; k < contacts; ++k)
        if (!std::strcmp(name, contact[k])) contact_of[c] = k;
      if (known || contact_of[c] >= 0 || contacts == kMaxLinks) continue;
      contact_of[c] = contacts;
      contact[contacts++] = name;
    }
  }

  static V number(double x) { return V(float(x)); }

  void load(int first) {
    load_state(moving, rows, held[first / kWidth],
               [&](int row) { return V::from(&state[row][first]); });
    varied.lay(moving.terrain, first, V::from(&state[0][first]), V::from(&state[1][first]));
    if (varied.pushes() && !course->solid->fixed) {
      double ahead[kWidth], left[kWidth];
      for (int l = 0; l < kWidth; ++l) varied.push(first + l, mass, false, ahead[l], left[l]);
      moving.speed.move.x += V::from(ahead);
      moving.speed.move.y += V::from(left);
    }
    if (!varied.any()) return;
    double weight[kWidth];
    for (int l = 0; l < kWidth; ++l) {
      const double pull = varied.share[kPull][first + l];
      weight[l] = pull < 0 ? 1 : pull / double(moving.gravity);
    }
    moving.heaviness = V::from(weight);
    const Firmness& firm = course->solid->firm;
    const auto share = [&](int kind) { return V::from(&varied.share[kind][first]); };
    moving.lightness = V(1.0f) / share(kMass);
    moving.strength = share(kMotors);
    moving.friction = number(firm.friction) * share(kFriction);
    moving.stiffness = number(firm.stiffness) * share(kFirmness) * moving.lightness;
    moving.damping = number(firm.damping) * share(kFirmness) * moving.lightness;
  }

  /// Writes the changes, except in lanes whose numbers are not `real`.
  void keep(int first, V real) {
    double kept[kWidth], after[kWidth];
    real.to(kept);
    bool* before = held[first / kWidth];
    store_state(moving, rows, before, [&](int row, V values) {
      values.to(after);
      for (int l = 0; l < kWidth; ++l) {
        double& old = state[row][first + l];
        const double next = after[l] + (row < 2 ? old : 0.0);
        old = kept[l] > 0 ? next : old;
      }
    });
    bool all = true;
    for (const double& lane : kept) all &= lane > 0;
    for (int c = 0; c < rows.balls; ++c) before[c] = moving.held[c] || (before[c] && !all);
  }

  /// Positive unless a speed is too large or not a number.
  V real_numbers() const {
    const auto& place = moving.place;
    V sum = dot(moving.speed, moving.speed) + number(0.01) * dot(place, place);
    for (int i = 1; i < rows.links; ++i)
      sum += moving.rate[i] * moving.rate[i] + number(0.01) * moving.angle[i] * moving.angle[i];
    for (const V& q : moving.attitude) sum += q * q;
    return number(kWildest * kWildest) - sum;
  }

  Moving moving;
};

BOTSCHOOL_END
