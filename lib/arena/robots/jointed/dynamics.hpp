// Motion of a planar jointed body, in lanes. docs/specification.md, "Planar runners", has the rules.
//
// Coordinates are the root's x and z and the angle of every segment against the world. In a plane
// that makes the equations short (Featherstone 2008, "Rigid Body Dynamics Algorithms", chapters 5
// and 6, written out for these coordinates). With r turned by the angle of its segment, a point at r
// moves by turn(r) = (-r_z, r_x) when the angle grows by 1. With h_c the vector from the origin of a
// segment i to its child c's origin, and j on or below c:
//   M_ij = h_c . s_j                  s_j: first moment of mass of j and of all that hangs on it
//   M_xj, M_zj = turn(s_j)            M_jj: constant        M_xx = M_zz = whole mass
// Speeds cause centripetal forces only. With w the angular speeds they are
//   on i: turn(h_c) . s_j w_j^2       on j: -turn(h_c) . s_j w_i^2       on x and z: s_j w_j^2
//
// A substep goes half its way with the old speeds, changes them by the forces there, and goes the
// other half with the new ones, which is symmetric in time and of second order.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "ground.hpp"
#include "table.hpp"
#include "terrain.hpp"

#if defined(__GNUC__)
#define BOTSCHOOL_EACH(i) [&](auto i) __attribute__((always_inline))
#else
#define BOTSCHOOL_EACH(i) [&](auto i)
#endif

/// A phase of a substep: inlined where lanes race, shared where one body is looked at (planar.cpp).
#ifndef BOTSCHOOL_PHASE
#define BOTSCHOOL_PHASE BOTSCHOOL_INLINE
#endif

BOTSCHOOL_BEGIN

template <class F, std::size_t... I>
BOTSCHOOL_INLINE void unrolled([[maybe_unused]] F f, std::index_sequence<I...>) {
  (f(std::integral_constant<int, int(I)>()), ...);
}

/// A number that the compiler knows.
template <int I>
using Constant = std::integral_constant<int, I>;

template <class Body, class T, int W>
struct Dynamics {
  using V = Lanes<T, W>;
  using Vec = Vector2<V>;
  static constexpr Numbers<Body> numbers{};
  static constexpr int n = Numbers<Body>::n;
  static constexpr int contacts = sizeof(Body::contacts) / sizeof(Contact);
  /// Coordinates: x, z, then the angle of each segment.
  static constexpr int size = n + 2;

  V position[size], speed[size];  ///< the state
  V change[n];       ///< of the segments' angular speeds in the last substep, halved; 0 if unknown
  V load[contacts];  ///< sum over substeps of each contact point's force across the ground, N

  // what may differ from lane to lane: 1 for the table's
  V grip = V(T(1)), firmness = V(T(1));  ///< of the ground: its friction, its spring and damper
  V lightness = V(T(1));                 ///< 1 / mass of everything, armature included
  V heaviness = V(T(1));                 ///< gravity / kGravity
  Terrain<V> terrain;                    ///< of run()

  // Numbers of segments, contact points and coordinates are constants for races of many lanes: the
  // compiler unrolls all loops. For single bodies they are ints, and the loops compile fast.
  static constexpr bool unrolls = W > 1;

  /// f(0), f(1), ..., f(N - 1).
  template <int N, class F>
  static BOTSCHOOL_INLINE void upwards(F f) {
    if constexpr (unrolls)
      unrolled(f, std::make_index_sequence<N>());
    else
      for (int i = 0; i < N; ++i) f(i);
  }

  /// f(N - 1), ..., f(0).
  template <int N, class F>
  static BOTSCHOOL_INLINE void downwards(F f) {
    if constexpr (unrolls)
      unrolled(BOTSCHOOL_EACH(i) { f(Constant<N - 1 - i>()); }, std::make_index_sequence<N>());
    else
      for (int i = N - 1; i >= 0; --i) f(i);
  }

  /// The parent of a coordinate in the tree z -> x, root -> z, segment -> its parent.
  static constexpr int up(int k) { return k <= 2 ? k - 1 : Body::segments[k - 2].parent + 2; }

  static constexpr int parent(int i) { return Body::segments[i].parent; }
  template <int I>
  static constexpr Constant<Body::segments[I].parent> parent(Constant<I>) {
    return {};
  }

  /// The segment of a contact point.
  static constexpr int segment(int c) { return Body::contacts[c].segment; }
  template <int C>
  static constexpr Constant<Body::contacts[C].segment> segment(Constant<C>) {
    return {};
  }

  /// f(i) for all ancestors i of coordinate k.
  template <class K, class F>
  static BOTSCHOOL_INLINE void ancestors(K k, F f) {
    if constexpr (!unrolls) {
      for (int i = up(k); i >= 0; i = up(i)) f(i);
    } else if constexpr (up(K::value) >= 0) {
      constexpr Constant<up(K::value)> i{};
      f(i);
      ancestors(i, f);
    }
  }

  /// f(c) for segment j and all its ancestors but the root.
  template <class J, class F>
  static BOTSCHOOL_INLINE void descend(J j, F f) {
    if constexpr (!unrolls) {
      for (int c = j; c > 0; c = parent(c)) f(c);
    } else if constexpr (J::value > 0) {
      f(j);
      descend(parent(j), f);
    }
  }

  static BOTSCHOOL_INLINE V number(double x) { return V(T(x)); }

  V mass[size][size];  ///< lower triangle, entries of ancestors only; after factor() its factors
  V inverse[size];     ///< factor(): of the pivots
  V lever[n][n];       ///< turn(h_c) . s_j of segments j and i
  V force[size];       ///< generalised forces; after substitute() accelerations
  Vec along[n];        ///< from the parent's origin to the segment's, h
  Vec moment[n];       ///< first moments of mass, s
  Vec origin[n];
  V sine[n], cosine[n];

  /// (x, z) of segment i's frame in the world's.
  BOTSCHOOL_INLINE Vec turned(int i, double x, double z) const {
    return {number(x) * cosine[i] - number(z) * sine[i],
            number(x) * sine[i] + number(z) * cosine[i]};
  }

  /// Where the segments are, for given positions.
  BOTSCHOOL_PHASE void place() {
    origin[0] = {position[0], position[1]};
    upwards<n>(BOTSCHOOL_EACH(i) {
      sine_cosine(position[2 + i], sine[i], cosine[i]);
      moment[i] = turned(i, numbers.first_x[i], numbers.first_z[i]);
      if (i > 0) {
        const Segment& s = Body::segments[i];
        along[i] = turned(s.parent, s.x, s.z);
        origin[i] = origin[s.parent] + along[i];
      }
    });
  }

  /// The mass matrix without the terms of hinges and ground, and the levers.
  BOTSCHOOL_PHASE void inertia() {
    mass[0][0] = mass[1][1] = number(numbers.all[0]);
    mass[1][0] = V(T(0));
    upwards<n>(BOTSCHOOL_EACH(j) {
      const int k = j + 2;
      const Vec effect = turn(moment[j]);
      mass[k][0] = effect.x;
      mass[k][1] = effect.z;
      mass[k][k] = number(numbers.second[j]);
      descend(
          j, BOTSCHOOL_EACH(c) {  // c: j and its ancestors but the root
            const int i = parent(c);
            mass[k][i + 2] = dot(along[c], moment[j]);
            lever[j][i] = dot(turn(along[c]), moment[j]);
          });
    });
  }

  /// The forces of gravity, and no other.
  BOTSCHOOL_PHASE void weigh(double gravity) {
    force[0] = V(T(0));
    force[1] = number(-gravity * numbers.all[0]) * heaviness;
    const V pull = number(-gravity) * heaviness;
    upwards<n>(BOTSCHOOL_EACH(j) { force[2 + j] = pull * moment[j].x; });
  }

  /// Adds centripetal forces; `square`: of the segments' angular speeds.
  BOTSCHOOL_PHASE void whirl(const V* square) {
    upwards<n>(BOTSCHOOL_EACH(j) {
      force[0] += square[j] * moment[j].x;
      force[1] += square[j] * moment[j].z;
      descend(
          j, BOTSCHOOL_EACH(c) {
            const int i = parent(c);
            force[2 + i] += lever[j][i] * square[j];
            force[2 + j] -= lever[j][i] * square[i];
          });
    });
  }

  /// Adds a force at the origin of segment j to all coordinates that move this origin.
  template <class J>
  BOTSCHOOL_INLINE void apply(J j, Vec push) {
    force[0] += push.x;
    force[1] += push.z;
    descend(j, BOTSCHOOL_EACH(c) { force[parent(c) + 2] += dot(turn(along[c]), push); });
  }

  /// Torques of the hinges. With a substep h, dampers answer to the mean of the speeds before and
  /// after it, which lets them be stiff: h / 2 damping joins the mass matrix. With h = 0 they answer
  /// to the speeds as they are.
  BOTSCHOOL_PHASE void hinges(const V* action, T h) {
    upwards<n - 1>(BOTSCHOOL_EACH(index) {
      const int i = index + 1, k = i + 2, p = up(k);
      const Hinge& hinge = Body::segments[i].hinge;
      const V angle = position[k] - position[p], rate = speed[k] - speed[p];
      const V above = angle - number(hinge.high), below = angle - number(hinge.low);
      const V beyond = larger(above, V(T(0))) + smaller(below, V(T(0)));
      const V out = beyond * beyond;
      const V spring = if_positive(out, number(Body::limit.stiffness), V(T(0)));
      const V damping =
          number(hinge.damping) + if_positive(out, number(Body::limit.damping), V(T(0)));
      const V torque =
          lightness * (number(hinge.torque) * action[index] -
                       ((number(hinge.stiffness) * angle + spring * beyond) + damping * rate));
      force[k] += torque;
      force[p] -= torque;
      const V both = V(h * T(0.5)) * (lightness * damping);
      mass[k][k] += both;
      mass[p][p] += both;
      mass[k][p] -= both + number(hinge.armature);
    });
  }

  /// Forces of the ground. A contact point at depth d that moves at v across the ground and at u
  /// along it is pushed by N = stiffness d - damping min(1, d / ramp) v, with the mean of v (see
  /// hinges), and dragged by -friction N u / max(|u|, slip), with the u after the substep, since that
  /// is stiffer by far (implicit Euler, linearised).
  template <class Ground>
  BOTSCHOOL_PHASE void touch(const Ground& ground, T h) {
    Vec velocity[n];
    velocity[0] = {speed[0], speed[1]};
    upwards<n - 1>(BOTSCHOOL_EACH(index) {
      const int i = index + 1, p = parent(i);
      velocity[i] = velocity[p] + speed[2 + p] * turn(along[i]);
    });
    upwards<contacts>(BOTSCHOOL_EACH(c) {
      const Contact& point = Body::contacts[c];
      const auto s = segment(c);
      Vec arm = turned(s, point.x, point.z);
      Vec normal{V(T(0)), V(T(1))};
      if constexpr (!Ground::flat) {
        const V slope = ground.slope(origin[s].x + arm.x);
        normal.z = V(T(1)) / square_root(V(T(1)) + slope * slope);
        normal.x = -(slope * normal.z);
      }
      arm = arm - number(point.radius) * normal;
      const Vec place = origin[s] + arm, moving = velocity[s] + speed[2 + s] * turn(arm);
      const V depth = (ground.height(place.x) - place.z) * normal.z;
      const Vec tangent{normal.z, -normal.x};
      const V across = dot(normal, moving), sliding = dot(tangent, moving);
      const V share = smaller(depth * number(1 / Body::touch.ramp), V(T(1)));
      V damping = firmness * (number(Body::touch.damping) * share);
      V push = firmness * (number(Body::touch.stiffness) * depth) - damping * across;
      push = if_positive(depth, larger(push, V(T(0))), V(T(0)));
      damping = if_positive(push, damping, V(T(0)));
      const V pace = larger(larger(sliding, -sliding), number(Body::touch.slip));
      const V drag = grip * number(Body::touch.friction) * push / pace;
      load[c] += push;
      const Vec pushed = push * normal - (drag * sliding) * tangent;
      force[2 + s] += dot(turn(arm), pushed);
      apply(s, pushed);
      resist(s, arm, V(h * T(0.5)) * damping, V(h) * drag, normal, Ground::flat);
    });
  }

  /// Adds the resistance to a point's motion across and along the ground to the mass matrix.
  template <class S>
  BOTSCHOOL_INLINE void resist(S s, Vec arm, V across, V along_it, Vec normal, bool flat) {
    Resistance<V> r{along_it, V(T(0)), across};
    if (!flat) {
      const V difference = across - along_it;
      r.xx = along_it + difference * (normal.x * normal.x);
      r.xz = difference * (normal.x * normal.z);
      r.zz = along_it + difference * (normal.z * normal.z);
    }
    const auto resisted = [&](Vec a) -> Vec {
      if (flat) return {r.xx * a.x, r.zz * a.z};
      return {r.xx * a.x + r.xz * a.z, r.xz * a.x + r.zz * a.z};
    };
    mass[0][0] += r.xx;
    if (!flat) mass[1][0] += r.xz;
    mass[1][1] += r.zz;
    add_resistance(s, turn(arm), resisted);
    descend(s, BOTSCHOOL_EACH(c) { add_resistance(parent(c), turn(along[c]), resisted); });
  }

  /// Adds it for segment j, whose growing angle moves the point by `effect`, with itself and its
  /// ancestors.
  template <class J, class F>
  BOTSCHOOL_INLINE void add_resistance(J j, Vec effect, const F& resisted) {
    const int k = j + 2;
    const Vec answer = resisted(effect);
    mass[k][0] += answer.x;
    mass[k][1] += answer.z;
    mass[k][k] += dot(effect, answer);
    descend(j, BOTSCHOOL_EACH(c) { mass[k][parent(c) + 2] += dot(turn(along[c]), answer); });
  }

  /// mass = L^T D L from the leaves to the root, which keeps the zeros of a tree (Featherstone
  /// 2008, section 6.5). L is left below the diagonal of `mass`, and 1 / D in `inverse`.
  BOTSCHOOL_PHASE void factor() {
    if constexpr (Body::pinned)
      upwards<n>(BOTSCHOOL_EACH(i) { mass[2 + i][0] = mass[2 + i][1] = V(T(0)); });
    downwards<size>(BOTSCHOOL_EACH(k) {
      inverse[k] = V(T(1)) / mass[k][k];
      ancestors(
          k, BOTSCHOOL_EACH(i) {
            const V share = mass[k][i] * inverse[k];
            mass[i][i] -= share * mass[k][i];
            ancestors(i, BOTSCHOOL_EACH(j) { mass[i][j] -= share * mass[k][j]; });
            mass[k][i] = share;
          });
    });
  }

  /// Solves mass * acceleration = force after factor(); the acceleration is left in `force`.
  BOTSCHOOL_PHASE void substitute() {
    if constexpr (Body::pinned) force[0] = force[1] = V(T(0));
    downwards<size>(BOTSCHOOL_EACH(k) {
      ancestors(k, BOTSCHOOL_EACH(i) { force[i] -= mass[k][i] * force[k]; });
    });
    upwards<size>(BOTSCHOOL_EACH(k) {
      V value = force[k] * inverse[k];
      ancestors(k, BOTSCHOOL_EACH(i) { value -= mass[k][i] * force[i]; });
      force[k] = value;
    });
  }

  /// The ground of a race in space, below its x axis.
  struct Uneven {
    static constexpr bool flat = false;
    const Terrain<V>& terrain;
    BOTSCHOOL_INLINE V height(V x) const {
      V height, ahead, sideways;
      terrain.profile(x, V(T(0)), height, ahead, sideways);
      return height;
    }
    BOTSCHOOL_INLINE V slope(V x) const {
      V height, ahead, sideways;
      terrain.profile(x, V(T(0)), height, ahead, sideways);
      return ahead;
    }
  };

  /// One substep of h seconds.
  template <class Ground>
  BOTSCHOOL_INLINE void step(const V* action, const Ground& ground, T h,
                             double gravity = kGravity) {
    const V half(h * T(0.5));
    upwards<size>(BOTSCHOOL_EACH(k) { position[k] += half * speed[k]; });
    place();
    inertia();
    weigh(gravity);
    // centripetal forces want the speeds in the middle: first as the last substep foretells them
    V square[n], gain[size];
    upwards<n>(BOTSCHOOL_EACH(i) {
      const V middle = speed[2 + i] + change[i];
      square[i] = middle * middle;
    });
    whirl(square);
    hinges(action, h);
    if constexpr (!Body::pinned) {
      if constexpr (std::is_same_v<Ground, Terrain<V>>) {
        if (ground.flat)
          touch(Flat{}, h);
        else
          touch(Uneven{ground}, h);
      } else {
        touch(ground, h);
      }
    }
    factor();
    substitute();
    // then as this one makes them
    upwards<size>(BOTSCHOOL_EACH(k) {
      gain[k] = force[k];
      force[k] = V(T(0));
    });
    upwards<n>(BOTSCHOOL_EACH(i) {
      const V middle = speed[2 + i] + half * gain[2 + i];
      square[i] = middle * middle - square[i];
    });
    whirl(square);
    substitute();
    upwards<size>(BOTSCHOOL_EACH(k) {
      gain[k] = V(h) * (gain[k] + force[k]);
      speed[k] += gain[k];
      position[k] += half * speed[k];
    });
    upwards<n>(BOTSCHOOL_EACH(i) { change[i] = V(T(0.5)) * gain[2 + i]; });
  }

  /// `steps` substeps on `terrain`. Out of line, so that the problems of a body share it.
  BOTSCHOOL_OUTLINE void run(const V* action, int steps, T h) {
    Dynamics own;
    copy_state(*this, own);
    for (int s = 0; s < steps; ++s) own.step(action, terrain, h);
    copy_state(own, *this);
  }

 private:
  static BOTSCHOOL_INLINE void copy_state(const Dynamics& from, Dynamics& to) {
    upwards<size>(BOTSCHOOL_EACH(k) {
      to.position[k] = from.position[k];
      to.speed[k] = from.speed[k];
    });
    upwards<n>(BOTSCHOOL_EACH(i) { to.change[i] = from.change[i]; });
    upwards<contacts>(BOTSCHOOL_EACH(c) { to.load[c] = from.load[c]; });
    to.grip = from.grip;
    to.firmness = from.firmness;
    to.lightness = from.lightness;
    to.heaviness = from.heaviness;
  }
};

BOTSCHOOL_END
