// Motions, forces and inertia of links in space, in lanes, and the tables of links in their precision.
#pragma once

#include "lanes.hpp"
#include "solid.hpp"

BOTSCHOOL_BEGIN

/// A motion (turning, moving), or a torque about the root's origin and a force.
template <class V>
struct Screw {
  Vector3<V> turn, move;
  friend BOTSCHOOL_INLINE Screw operator+(Screw a, Screw b) {
    return {a.turn + b.turn, a.move + b.move};
  }
  friend BOTSCHOOL_INLINE Screw operator*(V s, Screw a) { return {s * a.turn, s * a.move}; }
};

template <class V>
BOTSCHOOL_INLINE V dot(const Screw<V>& a, const Screw<V>& b) {
  return dot(a.turn, b.turn) + dot(a.move, b.move);
}

/// How motion b changes when its frame moves with motion a.
template <class V>
BOTSCHOOL_INLINE Screw<V> carried(const Screw<V>& a, const Screw<V>& b) {
  return {cross(a.turn, b.turn), cross(a.turn, b.move) + cross(a.move, b.turn)};
}

/// A symmetric 6 x 6 matrix: torque = turning w + coupling v, force = coupling^T w + moving v.
template <class V>
struct Inertia {
  Symmetric3<V> turning, moving;
  Matrix3<V> coupling;

  BOTSCHOOL_INLINE Screw<V> times(const Screw<V>& a) const {
    return {turning.times(a.turn) + coupling.times(a.move),
            coupling.back(a.turn) + moving.times(a.move)};
  }
  BOTSCHOOL_INLINE void add(const Inertia& b) {
    turning.add(b.turning);
    moving.add(b.moving);
    coupling.add(b.coupling);
  }
  /// Subtracts s * u u^T.
  BOTSCHOOL_INLINE void reduce(const Screw<V>& u, V s) {
    const Screw<V> su = s * u;
    turning.reduce(su.turn, u.turn);
    moving.reduce(su.move, u.move);
    coupling.column[0] = coupling.column[0] - u.move.x * su.turn;
    coupling.column[1] = coupling.column[1] - u.move.y * su.turn;
    coupling.column[2] = coupling.column[2] - u.move.z * su.turn;
  }
  /// Adds resistance to a motion of a point r, across a plane with this normal and along it.
  BOTSCHOOL_INLINE void resist(Vector3<V> r, Vector3<V> normal, V across, V along) {
    const V extra = across - along;
    const Vector3<V> n = extra * normal;
    Symmetric3<V> d = {along + n.x * normal.x, along + n.y * normal.y, along + n.z * normal.z,
                       n.x * normal.y,         n.x * normal.z,         n.y * normal.z};
    moving.add(d);
    // columns of r x d
    const Vector3<V> x = cross(r, Vector3<V>{d.xx, d.xy, d.xz}),
                     y = cross(r, Vector3<V>{d.xy, d.yy, d.yz}),
                     z = cross(r, Vector3<V>{d.xz, d.yz, d.zz});
    coupling.add({{x, y, z}});
    // (r x d) x^T r
    Symmetric3<V>& t = turning;
    t.xx += r.y * z.x - r.z * y.x;
    t.yy += r.z * x.y - r.x * z.y;
    t.zz += r.x * y.z - r.y * x.z;
    t.xy += r.z * x.x - r.x * z.x;
    t.xz += r.x * y.x - r.y * x.x;
    t.yz += r.x * y.y - r.y * x.y;
  }

  /// The acceleration under a force that resists, by the factors L D L^T.
  Screw<V> solve(const Screw<V>& f) const {
    const Symmetric3<V>&a = turning, &c = moving;
    const Vector3<V>* b = coupling.column;
    V full[6][6] = {{a.xx},
                    {a.xy, a.yy},
                    {a.xz, a.yz, a.zz},
                    {b[0].x, b[0].y, b[0].z, c.xx},
                    {b[1].x, b[1].y, b[1].z, c.xy, c.yy},
                    {b[2].x, b[2].y, b[2].z, c.xz, c.yz, c.zz}};
    V y[6] = {-f.turn.x, -f.turn.y, -f.turn.z, -f.move.x, -f.move.y, -f.move.z};
    V low[6][6], inverse[6];
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) {
        V s = full[i][j];
        for (int k = 0; k < j; ++k) s -= low[i][k] * full[j][k];
        full[i][j] = s;
        if (i == j)
          inverse[i] = V(1) / s;
        else
          low[i][j] = s * inverse[j];
      }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j) y[i] -= low[i][j] * y[j];
    for (int i = 0; i < 6; ++i) y[i] = y[i] * inverse[i];
    for (int i = 5; i >= 0; --i)
      for (int j = i + 1; j < 6; ++j) y[i] -= low[j][i] * y[j];
    return {{y[0], y[1], y[2]}, {y[3], y[4], y[5]}};
  }
};

/// A table in the precision of the lanes.
template <class T>
struct Numbers3 {
  struct One {
    int parent, motor, along;  ///< along: the axis is x, y or z, forwards or backwards; else 3
    bool heavy, limited, driven, slides;
    T sign, place[3], axis[3], centre[3], mass, inertia[6];
    T low, high, torque, damping, stiffness, armature, servo, rest, dry;
    T still, up, down, pull, drag, least, most;  ///< of its drive
  };
  struct Touching {
    int link;
    T place[3], radius;
  };
  /// Balls that follow each other on a link, and a ball around them.
  struct Group {
    int link, first, count;
    T place[3], radius;
  };
  struct Meeting {
    int link[2];
    T place[2][3], half[2][3], radius;  ///< radius: of both together
    T reach, wide;  ///< squared: farther apart are middles, and the links' origins, without touch
  };
  int links, balls, groups, pairs;
  bool fixed, soft;
  One link[kMaxLinks];
  Touching ball[kMaxBalls];
  Group group[kMaxBalls];
  Meeting pair[kMaxPairs];

  void read(const Solid& solid) {
    links = solid.links;
    fixed = solid.fixed;
    soft = solid.soft;
    for (int i = 0; i < links; ++i) {
      const Link& from = solid.link[i];
      One& to = link[i];
      const double axis[3] = {from.axis.x, from.axis.y, from.axis.z};
      to.parent = from.parent;
      to.motor = from.motor;
      to.along = 3;
      to.sign = T(1);
      for (int k = 0; k < 3; ++k) {
        if (axis[k] != 1 && axis[k] != -1) continue;
        to.along = k;
        to.sign = T(axis[k]);
      }
      copy(to.place, from.place);
      copy(to.axis, from.axis);
      copy(to.centre, from.centre);
      to.heavy = from.mass > 0;
      to.mass = T(from.mass);
      for (int k = 0; k < 6; ++k) to.inertia[k] = T(from.inertia[k]);
      to.limited = from.hinge.low < from.hinge.high;
      to.low = T(from.hinge.low);
      to.high = T(from.hinge.high);
      to.torque = T(from.hinge.torque);
      to.damping = T(from.hinge.damping);
      to.stiffness = T(from.hinge.stiffness);
      to.armature = T(from.hinge.armature);
      to.servo = T(from.hinge.servo);
      to.rest = T(from.rest);
      to.dry = T(from.dry);
      to.slides = from.slides;
      const Drive& drive = from.drive;
      to.driven = drive.least < drive.most;
      to.still = T(drive.still);
      to.up = T(drive.up);
      to.down = T(drive.down);
      to.pull = T(drive.pull);
      to.drag = T(drive.drag);
      to.least = T(drive.least);
      to.most = T(drive.most);
    }
    const Balls from(solid);
    balls = from.count;
    for (int c = 0; c < balls; ++c) {
      ball[c].link = from.ball[c].link;
      copy(ball[c].place, from.ball[c].place);
      ball[c].radius = T(from.ball[c].radius);
    }
    gather(from);
    pairs = solid.pairs;
    for (int c = 0; c < pairs; ++c) {
      const Shape* both[] = {&solid.shape[solid.pair[c].one], &solid.shape[solid.pair[c].other]};
      for (int k = 0; k < 2; ++k) {
        pair[c].link[k] = both[k]->link;
        copy(pair[c].place[k], both[k]->place);
        copy(pair[c].half[k], both[k]->half);
      }
      const double radius = both[0]->radius + both[1]->radius;
      pair[c].radius = T(radius);
      const double reach = radius + length(both[0]->half) + length(both[1]->half);
      const double wide = reach + length(both[0]->place) + length(both[1]->place);
      // more than rounding moves any of them
      pair[c].reach = T((1.001 * reach + 1e-3) * (1.001 * reach + 1e-3));
      pair[c].wide = T((1.001 * wide + 1e-3) * (1.001 * wide + 1e-3));
    }
  }

 private:
  void gather(const Balls& from) {
    groups = 0;
    for (int first = 0, next; first < balls; first = next) {
      next = first + 1;
      while (next < balls && from.ball[next].link == from.ball[first].link) ++next;
      Place low = from.ball[first].place, high = low;
      const auto wider = [](double& least, double& most, double x) {
        least = x < least ? x : least;
        most = x > most ? x : most;
      };
      for (int c = first; c < next; ++c) {
        const Place& p = from.ball[c].place;
        wider(low.x, high.x, p.x);
        wider(low.y, high.y, p.y);
        wider(low.z, high.z, p.z);
      }
      const Place middle{(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
      double reach = 0;
      for (int c = first; c < next; ++c) {
        const Place& p = from.ball[c].place;
        const double far =
            length({p.x - middle.x, p.y - middle.y, p.z - middle.z}) + from.ball[c].radius;
        reach = far > reach ? far : reach;
      }
      Group& to = group[groups++];
      to.link = from.ball[first].link;
      to.first = first;
      to.count = next - first;
      copy(to.place, middle);
      to.radius = T(1.0001 * reach + 1e-4);  // more than rounding moves any of them
    }
  }

  static double length(const Place& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }

  static void copy(T* to, const Place& from) {
    to[0] = T(from.x);
    to[1] = T(from.y);
    to[2] = T(from.z);
  }
};

BOTSCHOOL_END
