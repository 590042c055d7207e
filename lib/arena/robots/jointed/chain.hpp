// Motion of a chain of rods with round ends, in lanes, each lane with rods of its own.
// docs/specification.md, "PlanarBodyBrain", has the rules.
//
// Coordinates are as in dynamics.hpp: x and z of the rear end of the first rod, and the angle of
// every rod against the world. Rod i moves with the speed of its rear end and turns with its own
// angle, so its inertia, and what the ground adds to it, are numbers for these three (Featherstone
// 2008, chapter 2). When the angle of rod j grows, all rods after it move by turn(rod_j), the vector
// from its rear to its front end turned by a quarter. With S_j the sum of the translational parts of
// all rods after j, and c_j what couples the translation of rod j with its turning:
//   C_j = c_j + S_j turn(rod_j)        M_ij = turn(rod_i) . C_j for i < j
//   M_xj, M_zj = C_j                   M_jj = own moment of inertia + turn(rod_j) . S_j turn(rod_j)
#pragma once

#include "dynamics.hpp"

BOTSCHOOL_BEGIN

/// The ground below a point: its height there and its slope.
template <class V>
struct Piece {
  V height, slope;
};

template <class Ground, class V>
BOTSCHOOL_INLINE Piece<V> piece_under(const Ground& ground, V x) {
  return {ground.height(x), ground.slope(x)};
}

/// Straight pieces of ground between heights, in each lane others. Beyond the ends it is even.
template <class T, int W>
struct Pieces {
  const double* heights;  ///< of the first lane; the next height is `stride` numbers further on
  int stride, count;
  double width;  ///< of a piece
  int first[W];  ///< number of the height at the place from which x counts, less `offset`
  T offset[W];   ///< of that place, in pieces

  friend BOTSCHOOL_INLINE Piece<Lanes<T, W>> piece_under(const Pieces& ground, Lanes<T, W> x) {
    alignas(64) T place[W], height[W], slope[W];
    (x * Lanes<T, W>(T(1 / ground.width))).to(place);
    for (int l = 0; l < W; ++l) {
      T u = place[l] + ground.offset[l];
      u = u > T(-1000) ? u : T(-1000);  // NaN too
      u = u < T(1000) ? u : T(1000);
      int cell = static_cast<int>(u);
      cell -= u < T(cell);
      const T from = ground.at(cell + ground.first[l], l);
      const T rise = ground.at(cell + ground.first[l] + 1, l) - from;
      height[l] = from + rise * (u - T(cell));
      slope[l] = rise * T(1 / ground.width);
    }
    return {Lanes<T, W>::from(height), Lanes<T, W>::from(slope)};
  }

 private:
  BOTSCHOOL_INLINE T at(int i, int lane) const {
    i = i < 0 ? 0 : i;
    i = i < count ? i : count - 1;
    return T(heights[std::ptrdiff_t(i) * stride + lane]);
  }
};

/// What a motor tries to do: turn its hinge at a speed, with no more than a torque.
template <class V>
struct Drive {
  V speed, torque;
};

/// Inertia of a rod, and resistance of the ground, for the motion of its rear end and its turning.
template <class V>
struct RodInertia {
  V xx, xz, zz;
  Vector2<V> coupling;
  V turning;
};

/// How hinges and ground answer.
struct ChainRules {
  Touch touch;
  Limit limit;
  double armature, damping;  ///< of each hinge
  double slack;              ///< rad/s; nearer to its speed a motor needs less than its torque
};

template <int N, const ChainRules& rules, class T, int W>
struct Chain {
  using V = Lanes<T, W>;
  using Vec = Vector2<V>;
  static constexpr int size = N + 2, contacts = 2 * N;

  // the rods
  V length[N], radius[N], mass[N];
  V inertia[N];                ///< about the rear end
  V low[N], high[N], rest[N];  ///< hinge at the rear end: limits around its angle at rest

  V position[size], speed[size];  ///< the state
  V change[N];       ///< of the angular speeds in the last substep, halved; 0 if unknown
  V load[contacts];  ///< sum over substeps of the ground's force across itself on either end, N

  V matrix[size][size];  ///< lower triangle; after solve() its factors
  V force[size];         ///< generalised forces; after solve() accelerations
  Vec rod[N], origin[N], velocity[N], push[N];
  V torque[N];
  RodInertia<V> part[N];

  static BOTSCHOOL_INLINE V number(double x) { return V(T(x)); }

  /// Computes the positions of the rods, their own inertia, and the forces of gravity and speeds.
  BOTSCHOOL_INLINE void place(double gravity) {
    Vec pull{V(T(0)), number(-gravity)}, at{position[0], position[1]}, moving{speed[0], speed[1]};
    for (int i = 0; i < N; ++i) {
      V sine, cosine;
      sine_cosine(position[2 + i], sine, cosine);
      rod[i] = {length[i] * cosine, length[i] * sine};
      origin[i] = at;
      velocity[i] = moving;
      at = at + rod[i];
      moving = moving + speed[2 + i] * turn(rod[i]);
      const V w = speed[2 + i] + change[i];
      const Vec centre = number(0.5) * rod[i];
      push[i] = mass[i] * (pull + (w * w) * centre);
      torque[i] = dot(turn(centre), push[i]);
      pull = pull + (w * w) * rod[i];
      part[i] = {mass[i], V(T(0)), mass[i], mass[i] * turn(centre), inertia[i]};
    }
  }

  /// Forces of the ground on the balls at the ends of the rods, by the law of dynamics.hpp.
  template <class Ground>
  BOTSCHOOL_INLINE void touch(const Ground& ground, T h) {
    for (int c = 0; c < contacts; ++c) {
      const int s = c / 2;
      const Vec end = c % 2 ? rod[s] : Vec{V(T(0)), V(T(0))};
      const Vec ball = origin[s] + end;
      const Piece<V> below = piece_under(ground, ball.x);
      Vec normal;
      normal.z = V(T(1)) / square_root(V(T(1)) + below.slope * below.slope);
      normal.x = -(below.slope * normal.z);
      const V depth = radius[s] - (ball.z - below.height) * normal.z;
      const Vec arm = end - radius[s] * normal;
      const Vec moving = velocity[s] + speed[2 + s] * turn(arm);
      const Vec tangent{normal.z, -normal.x};
      const V across = dot(normal, moving), sliding = dot(tangent, moving);
      const V share = smaller(depth * number(1 / rules.touch.ramp), V(T(1)));
      V damping = number(rules.touch.damping) * share + V(h * T(rules.touch.stiffness));
      V pressure = number(rules.touch.stiffness) * depth - damping * across;
      pressure = if_positive(depth, larger(pressure, V(T(0))), V(T(0)));
      damping = if_positive(pressure, damping, V(T(0)));
      const V pace = larger(larger(sliding, -sliding), number(rules.touch.slip));
      const V drag = number(rules.touch.friction) * pressure / pace;
      load[c] += pressure;
      const Vec pushed = pressure * normal - (drag * sliding) * tangent;
      push[s] = push[s] + pushed;
      torque[s] += dot(turn(arm), pushed);
      resist(part[s], turn(arm), V(h) * damping, V(h) * drag, normal);
    }
  }

  /// Adds the resistance to a point's motion across and along the ground; the point moves by
  /// `effect` when its rod turns.
  static BOTSCHOOL_INLINE void resist(RodInertia<V>& part, Vec effect, V across, V along,
                                      Vec normal) {
    const V difference = across - along;
    const V xx = along + difference * (normal.x * normal.x);
    const V xz = difference * (normal.x * normal.z);
    const V zz = along + difference * (normal.z * normal.z);
    const Vec answer{xx * effect.x + xz * effect.z, xz * effect.x + zz * effect.z};
    part.xx += xx;
    part.xz += xz;
    part.zz += zz;
    part.coupling = part.coupling + answer;
    part.turning += dot(effect, answer);
  }

  /// Mass matrix and forces of the whole chain, from its tip to its rear.
  BOTSCHOOL_INLINE void assemble() {
    V xx = V(T(0)), xz = V(T(0)), zz = V(T(0));  // of all rods behind the hinge
    Vec carried{V(T(0)), V(T(0))};
    for (int j = N - 1; j >= 0; --j) {
      const Vec effect = turn(rod[j]);
      const Vec answer{xx * effect.x + xz * effect.z, xz * effect.x + zz * effect.z};
      const Vec column = part[j].coupling + answer;
      matrix[2 + j][0] = column.x;
      matrix[2 + j][1] = column.z;
      for (int i = 0; i < j; ++i) matrix[2 + j][2 + i] = dot(turn(rod[i]), column);
      matrix[2 + j][2 + j] = part[j].turning + dot(effect, answer);
      force[2 + j] = torque[j] + dot(effect, carried);
      carried = carried + push[j];
      xx += part[j].xx;
      xz += part[j].xz;
      zz += part[j].zz;
    }
    matrix[0][0] = xx;
    matrix[1][0] = xz;
    matrix[1][1] = zz;
    force[0] = carried.x;
    force[1] = carried.z;
  }

  /// Torques of the hinges. A motor with torque t that is to turn at u pushes with
  /// t (u - rate) / max(|u - rate|, slack); like dampers and limits it answers to the rate after
  /// the substep, so damping h + stiffness h^2 joins the mass matrix (see dynamics.hpp).
  BOTSCHOOL_INLINE void hinges(const Drive<V>* drive, T h) {
    for (int i = 1; i < N; ++i) {
      const int k = i + 2, p = k - 1;
      const V angle = position[k] - position[p] - rest[i], rate = speed[k] - speed[p];
      const V beyond = larger(angle - high[i], V(T(0))) + smaller(angle - low[i], V(T(0)));
      const V out = beyond * beyond;
      const V spring = if_positive(out, number(rules.limit.stiffness), V(T(0)));
      const V damper = if_positive(out, number(rules.limit.damping), V(T(0)));
      const Drive<V>& motor = drive[i - 1];
      const V gap = motor.speed - rate;
      const V drag = motor.torque / larger(larger(gap, -gap), number(rules.slack));
      const V resistance = ((number(rules.damping) + damper) + V(h) * spring) + drag;
      const V turning = (drag * motor.speed - spring * beyond) - resistance * rate;
      force[k] += turning;
      force[p] -= turning;
      const V both = V(h) * resistance + number(rules.armature);
      matrix[k][k] += both;
      matrix[p][p] += both;
      matrix[k][p] -= both;
    }
  }

  /// matrix * acceleration = force, by L^T D L from the tip to the rear. The acceleration is left
  /// in `force`.
  BOTSCHOOL_INLINE void solve() {
    V inverse[size];
    for (int k = size - 1; k >= 0; --k) {
      inverse[k] = V(T(1)) / matrix[k][k];
      for (int i = k - 1; i >= 0; --i) {
        const V factor = matrix[k][i] * inverse[k];
        for (int j = 0; j <= i; ++j) matrix[i][j] -= factor * matrix[k][j];
        force[i] -= factor * force[k];
        matrix[k][i] = factor;
      }
    }
    for (int k = 0; k < size; ++k) {
      V value = force[k] * inverse[k];
      for (int i = 0; i < k; ++i) value -= matrix[k][i] * force[i];
      force[k] = value;
    }
  }

  /// One substep of h seconds: half the way with the old speeds, and half with the speeds after the
  /// forces at that point. Centripetal forces take the mean of both, as the last substep predicts it.
  template <class Ground>
  BOTSCHOOL_INLINE void step(const Drive<V>* drive, const Ground& ground, T h, double gravity) {
    const V half = V(T(0.5) * h);
    for (int k = 0; k < size; ++k) position[k] += half * speed[k];
    place(gravity);
    touch(ground, h);
    assemble();
    hinges(drive, h);
    solve();
    for (int k = 0; k < size; ++k) {
      speed[k] += V(h) * force[k];
      position[k] += half * speed[k];
    }
    for (int i = 0; i < N; ++i) change[i] = half * force[2 + i];
  }
};

BOTSCHOOL_END
