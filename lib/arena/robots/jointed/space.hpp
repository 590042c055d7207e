// Motion of a jointed body in space, in lanes; the body's table is read at run time.
// docs/specification.md, "Bodies in space", has the rules.
//
// The articulated-body algorithm (Featherstone 2008, "Rigid Body Dynamics Algorithms", chapter 7),
// with all vectors along the world's axes and about the place where the root's origin is: so inertia
// and forces of links are summed without turning them. What the ground and the limits of hinges
// answer to a change of speed joins the inertia (implicit Euler), so they may be firm.
//
// A substep goes half its way with the old speeds, changes them by the forces there, and goes the
// other half with the new ones. Terms that are quadratic in the speeds use the speeds in the middle
// of the change, predicted from the last substep's change.
#pragma once

#include "links.hpp"
#include "terrain.hpp"

BOTSCHOOL_BEGIN

template <class T, int W>
struct Space {
  using V = Lanes<T, W>;
  using Vec = Vector3<V>;

  Numbers3<T> numbers;
  T gravity = T(kGravity);
  T limit, stopping;  ///< of hinges: Firmness

  // the ground, and what may differ from lane to lane
  Terrain<V> terrain;
  V friction, stiffness, damping;
  V strength;   ///< of motors, 1 for the table's
  V lightness;  ///< 1 / (mass of everything / the table's)
  V heaviness;  ///< gravity / the body's own

  // the state
  Vec place;                            ///< of the root's origin
  V attitude[4];                        ///< the root's quaternion, w first
  Screw<V> speed;                       ///< of the root: turning (in the world's axes) and moving
  V angle[kMaxLinks], rate[kMaxLinks];  ///< of each link's hinge; the root's are not used
  Vec stretch[kMaxBalls];               ///< how far the ground holds a ball back along itself
  V load[kMaxBalls];                    ///< the ground's force across itself in the last substep, N
  bool held[kMaxBalls];                 ///< whether both may differ from 0 in some lane

  Screw<V> change;  ///< of the speeds in the last substep, halved
  V rate_change[kMaxLinks];

  /// What is computed of a link.
  struct Part {
    Matrix3<V> turned;  ///< its axes
    Vec origin;
    Screw<V> axis;         ///< motion at a rate of 1
    Screw<V> now, middle;  ///< motion; now: only of links with balls and of their parents
    Screw<V> carried;      ///< acceleration without a change of the rate
    Inertia<V> inertia;
    Screw<V> force;   ///< that it takes to accelerate not at all
    Screw<V> answer;  ///< inertia * axis
    V inverse, pull;
    V bend;  ///< acceleration of the hinge
    Screw<V> acceleration;
  };
  Part part[kMaxLinks];

  /// What is computed of a ball on the ground.
  struct Contact {
    V push, answer;
    Vec normal, at;
  };
  Contact contact[kMaxBalls];
  int touching[kMaxBalls], touches;  ///< numbers of the balls that are on the ground in some lane

  static BOTSCHOOL_INLINE Vec vector(const T* p) { return {V(p[0]), V(p[1]), V(p[2])}; }
  static BOTSCHOOL_INLINE Vec none() { return {V(T(0)), V(T(0)), V(T(0))}; }

  void read(const Solid& solid, const Firmness& firm) {
    numbers.read(solid);
    limit = T(firm.limit);
    stopping = T(firm.stopping);
    friction = V(T(firm.friction));
    stiffness = V(T(firm.stiffness));
    damping = V(T(firm.damping));
    strength = lightness = heaviness = V(T(1));
    terrain = Terrain<V>();
  }

  /// Before the first substep: what is not part of the state.
  void begin() {
    change = {none(), none()};
    for (int i = 0; i < numbers.links; ++i) rate_change[i] = V(T(0));
  }

  /// Moves the body for some substeps of h seconds; `action`: of each motor.
  void run(const V* action, int substeps, T h) {
    begin();
    drift(h * T(0.5));
    for (int s = 0; s < substeps; ++s) {
      kick(action, h);
      drift(s + 1 < substeps ? h : h * T(0.5));
    }
  }

  /// Where link i is, after its parent.
  BOTSCHOOL_INLINE void put(int i) {
    Part& p = part[i];
    if (i == 0) {
      const V w = attitude[0], x = attitude[1], y = attitude[2], z = attitude[3];
      const V one(T(1)), two(T(2));
      p.turned = {{{one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)},
                   {two * (x * y - w * z), one - two * (x * x + z * z), two * (y * z + w * x)},
                   {two * (x * z + w * y), two * (y * z - w * x), one - two * (x * x + y * y)}}};
      p.origin = none();
      return;
    }
    const auto& link = numbers.link[i];
    const Part& up = part[link.parent];
    p.origin = up.origin + up.turned.times(vector(link.place));
    if (link.slides) {
      p.axis = {none(), up.turned.times(vector(link.axis))};
      p.origin = p.origin + angle[i] * p.axis.move;
      p.turned = up.turned;
      return;
    }
    V sine, cosine;
    sine_cosine(angle[i], sine, cosine);
    if (link.along < 3) {
      const int k = link.along, a = (k + 1) % 3, b = (k + 2) % 3;
      sine = V(link.sign) * sine;
      const Vec *from = up.turned.column, first = from[a], second = from[b];
      Vec* to = p.turned.column;
      to[k] = from[k];
      to[a] = cosine * first + sine * second;
      to[b] = cosine * second - sine * first;
      p.axis.turn = V(link.sign) * from[k];
    } else {
      const Vec axis = up.turned.times(vector(link.axis));
      const auto turned = [&](Vec v, T share) {
        const Vec along = V(share) * axis;
        return along + cosine * (v - along) + sine * cross(axis, v);
      };
      for (int k = 0; k < 3; ++k) p.turned.column[k] = turned(up.turned.column[k], link.axis[k]);
      p.axis.turn = axis;
    }
    p.axis.move = cross(p.origin, p.axis.turn);
  }

  /// The place of the centre of mass along x, from the root's origin.
  V ahead() {
    V sum(T(0));
    T mass = T(0);
    for (int i = 0; i < numbers.links; ++i) {
      put(i);
      const auto& link = numbers.link[i];
      const Vec centre = part[i].origin + part[i].turned.times(vector(link.centre));
      sum += V(link.mass) * centre.x;
      mass += link.mass;
    }
    return sum * V(T(1) / mass);
  }

  /// Inertia of each link together with all that hangs on it, at rest.
  void inertias() {
    speed = change = {none(), none()};
    for (int i = 0; i < numbers.links; ++i) {
      rate[i] = rate_change[i] = V(T(0));
      put(i);
      move(i);
      weigh(i);
    }
    for (int i = numbers.links - 1; i > 0; --i)
      part[numbers.link[i].parent].inertia.add(part[i].inertia);
  }

  /// Changes the speeds by the forces of a substep.
  void kick(const V* action, T h) {
    for (int i = 0; i < numbers.links; ++i) {
      put(i);
      move(i);
      weigh(i);
    }
    touch(h);
    for (int c = 0; c < numbers.pairs; ++c) meet(numbers.pair[c], h);
    for (int i = numbers.links - 1; i > 0; --i) fold(i, action, h);
    if (numbers.fixed) {
      part[0].acceleration = {none(), none()};
    } else {
      burden(h);
      part[0].acceleration = part[0].inertia.solve(part[0].force);
    }
    const T half = h * T(0.5);
    for (int i = 1; i < numbers.links; ++i) {
      unfold(i);
      rate_change[i] = V(half) * part[i].bend;
    }
    weigh_balls();
    const Screw<V> middle = speed + change;
    const Screw<V>& acceleration = part[0].acceleration;
    change =
        V(half) * Screw<V>{acceleration.turn, acceleration.move + cross(middle.turn, middle.move)};
    speed = speed + V(T(2)) * change;
    for (int i = 1; i < numbers.links; ++i) rate[i] += V(T(2)) * rate_change[i];
  }

  /// Moves on by h seconds with the speeds as they are.
  void drift(T h) {
    place = place + V(h) * speed.move;
    for (int i = 1; i < numbers.links; ++i) angle[i] += V(h) * rate[i];
    const V w = attitude[0], x = attitude[1], y = attitude[2], z = attitude[3];
    const Vec t = V(h * T(0.5)) * speed.turn;
    // (1, t) times the quaternion, at length 1 again: a turn by 2 atan |t|
    attitude[0] = w - (t.x * x + t.y * y + t.z * z);
    attitude[1] = x + (t.x * w + t.y * z - t.z * y);
    attitude[2] = y + (t.y * w + t.z * x - t.x * z);
    attitude[3] = z + (t.z * w + t.x * y - t.y * x);
    V square(T(0));
    for (const V& q : attitude) square += q * q;
    const V scale = V(T(1)) / square_root(square);
    for (V& q : attitude) q = q * scale;
  }

 private:
  BOTSCHOOL_INLINE void move(int i) {
    Part& p = part[i];
    if (i == 0) {
      p.now = speed;
      p.middle = speed + change;
      return;
    }
    const Part& up = part[numbers.link[i].parent];
    p.now = up.now + rate[i] * p.axis;
    const Screw<V> joint = (rate[i] + rate_change[i]) * p.axis;
    p.middle = up.middle + joint;
    p.carried = carried(up.middle, joint);
  }

  /// Inertia of a link, and the force that its motion and its weight take.
  BOTSCHOOL_INLINE void weigh(int i) {
    const auto& link = numbers.link[i];
    Part& p = part[i];
    const V zero(T(0));
    if (!link.heavy) {
      p.inertia = {{zero, zero, zero, zero, zero, zero},
                   {zero, zero, zero, zero, zero, zero},
                   {{none(), none(), none()}}};
      p.force = {none(), none()};
      return;
    }
    const V mass(link.mass);
    const Vec c = p.origin + p.turned.times(vector(link.centre)), h = mass * c;
    const T* own = link.inertia;
    const Vec* r = p.turned.column;
    // the link's inertia times its axes
    const Vec x = V(own[0]) * r[0] + V(own[3]) * r[1] + V(own[4]) * r[2];
    const Vec y = V(own[3]) * r[0] + V(own[1]) * r[1] + V(own[5]) * r[2];
    const Vec z = V(own[4]) * r[0] + V(own[5]) * r[1] + V(own[2]) * r[2];
    const auto about = [&](V Vec::* a, V Vec::* b) {
      return x.*a * r[0].*b + y.*a * r[1].*b + z.*a * r[2].*b;
    };
    constexpr auto X = &Vec::x, Y = &Vec::y, Z = &Vec::z;
    p.inertia.turning = {about(X, X) + (h.y * c.y + h.z * c.z),
                         about(Y, Y) + (h.x * c.x + h.z * c.z),
                         about(Z, Z) + (h.x * c.x + h.y * c.y),
                         about(X, Y) - h.x * c.y,
                         about(X, Z) - h.x * c.z,
                         about(Y, Z) - h.y * c.z};
    p.inertia.moving = {mass, mass, mass, zero, zero, zero};
    p.inertia.coupling = {{{zero, h.z, -h.y}, {-h.z, zero, h.x}, {h.y, -h.x, zero}}};
    const Screw<V>& m = p.middle;
    const Vec momentum = mass * m.move + cross(m.turn, h);
    const Vec spin = p.inertia.turning.times(m.turn) + cross(h, m.move);
    const V g = V(gravity) * heaviness;
    p.force.turn = cross(m.turn, spin) + cross(m.move, momentum);
    p.force.move = cross(m.turn, momentum);
    p.force.move.z += mass * g;
    p.force.turn.x += g * h.y;
    p.force.turn.y -= g * h.x;
  }

  /// What a motor of the root itself would turn and move with it, and a damper on its motion.
  BOTSCHOOL_INLINE void burden(T h) {
    const auto& root = numbers.link[0];
    if (root.armature == 0 && root.damping == 0) return;
    Part& p = part[0];
    const V drag = lightness * V(root.damping), armature = lightness * V(root.armature);
    const V extra = armature + V(h * T(0.5)) * drag;
    for (V* entry : {&p.inertia.turning.xx, &p.inertia.turning.yy, &p.inertia.turning.zz,
                     &p.inertia.moving.xx, &p.inertia.moving.yy, &p.inertia.moving.zz})
      *entry += extra;
    p.force.turn = p.force.turn + drag * speed.turn;
    p.force.move =
        p.force.move + drag * speed.move + armature * cross(p.middle.turn, p.middle.move);
  }

  /// Forces of the ground on all balls.
  void touch(T h) {
    const bool flat = terrain.flat;
    touches = 0;
    for (int g = 0; g < numbers.groups; ++g) {
      const auto& group = numbers.group[g];
      const Part& p = part[group.link];
      const bool above = flat && group.count > 2 &&
                         !any_positive(V(group.radius) - (place.z + height(p, group.place)));
      for (int c = group.first; c < group.first + group.count; ++c) {
        if (above || !touch(c, flat, h))
          held[c] = false;
        else
          touching[touches++] = c;
      }
    }
  }

  /// z of a point of a link, from the root's origin: the sums are those of the whole vector.
  static BOTSCHOOL_INLINE V height(const Part& p, const T* own) {
    const Vec* column = p.turned.column;
    return p.origin.z +
           (V(own[0]) * column[0].z + V(own[1]) * column[1].z + V(own[2]) * column[2].z);
  }

  /// Forces of the ground on a ball; returns whether it touches in any lane. The ground pushes with a
  /// spring and a damper, and holds a ball back along itself by another pair, by no more than
  /// Coulomb's friction for the push of the substep before, or for what the push at least is now.
  BOTSCHOOL_INLINE bool touch(int c, bool flat, T h) {
    const V zero(T(0));
    const auto& ball = numbers.ball[c];
    Part& p = part[ball.link];
    const V radius(ball.radius);
    if (flat && !any_positive(radius - (place.z + height(p, ball.place)))) return false;
    const Vec centre = p.origin + p.turned.times(vector(ball.place));
    const Piece3<V> below = terrain.under(place.x + centre.x, place.y + centre.y);
    const V depth = radius - (place.z + centre.z - below.height) * below.normal.z;
    if (!any_positive(depth)) return false;
    if (!held[c]) {
      held[c] = true;
      stretch[c] = none();
      load[c] = zero;
    }
    const Vec& normal = below.normal;
    const Vec r = centre - radius * normal;
    const Vec sliding = p.now.move + cross(p.now.turn, r);
    // its change within the substep by the turning of the body alone
    const Vec turning = V(h) * cross(p.now.turn, p.now.move + cross(p.now.turn, centre));
    const V across = dot(normal, sliding), more = dot(normal, turning);
    const Vec along = sliding - across * normal;
    const V on = smaller(depth, stiffness * depth - damping * across);
    const V firm = if_positive(on, V(h) * stiffness + damping, zero);
    const V push = if_positive(on, stiffness * depth, zero) - firm * (across + more);
    const Vec stretched = stretch[c] + V(h) * along;
    const Vec drag = stiffness * stretched + firm * (along + (turning - more * normal));
    const V force_now = larger(load[c], smaller(stiffness * depth, push));
    const V most = if_positive(on, friction * force_now, zero);
    const V share = most / larger(larger(square_root(dot(drag, drag)), most), V(T(1e-9)));
    stretch[c] = share * stretched;
    const Vec force = push * normal - share * drag;
    p.force.move = p.force.move - force;
    p.force.turn = p.force.turn - cross(r, force);
    p.inertia.resist(r, normal, V(h) * firm, V(h) * share * firm);
    contact[c] = {push, V(h) * firm, normal, r};
    return true;
  }

  /// How much the ground has pushed each ball, by the accelerations.
  void weigh_balls() {
    for (int k = 0; k < touches; ++k) {
      const int c = touching[k];
      const Contact& touched = contact[c];
      const Screw<V>& a = part[numbers.ball[c].link].acceleration;
      const V across = dot(touched.normal, a.move + cross(a.turn, touched.at));
      load[c] = larger(touched.push - touched.answer * across, V(T(0)));
    }
  }

  /// Two capsules push each other apart where they are nearest, without friction.
  void meet(const typename Numbers3<T>::Meeting& pair, T h) {
    const V zero(T(0)), one(T(1));
    Part* p[2];
    Vec middle[2], half[2];
    for (int k = 0; k < 2; ++k) p[k] = &part[pair.link[k]];
    const Vec links = p[0]->origin - p[1]->origin;
    if (!any_positive(V(pair.wide) - dot(links, links))) return;
    for (int k = 0; k < 2; ++k)
      middle[k] = p[k]->origin + p[k]->turned.times(vector(pair.place[k]));
    const Vec apart = middle[0] - middle[1];
    if (!any_positive(V(pair.reach) - dot(apart, apart))) return;
    for (int k = 0; k < 2; ++k) half[k] = p[k]->turned.times(vector(pair.half[k]));
    const auto within = [&](V t) { return smaller(larger(t, -one), one); };
    const V tiny(T(1e-6));
    const V a = dot(half[0], half[0]) + tiny, b = dot(half[0], half[1]),
            e = dot(half[1], half[1]) + tiny;
    const V c = dot(half[0], apart), f = dot(half[1], apart);
    const V t = within((b * f - c * e) / larger(a * e - b * b, tiny * tiny));
    const V u = within((b * t + f) / e);
    const Vec from = middle[0] + within((b * u - c) / a) * half[0], to = middle[1] + u * half[1];
    const Vec way = from - to;
    const V length = square_root(dot(way, way)) + tiny;
    const V depth = V(pair.radius) - length;
    if (!any_positive(depth)) return;
    const Vec normal = (one / length) * way, r = V(T(0.5)) * (from + to);
    const auto moving = [&](int k) { return p[k]->now.move + cross(p[k]->now.turn, r); };
    const V across = dot(normal, moving(0) - moving(1));
    const V on = smaller(depth, stiffness * depth - damping * across);
    const V firm = if_positive(on, V(h) * stiffness + damping, zero);
    const Vec push = (if_positive(on, stiffness * depth, zero) - firm * across) * normal;
    for (int k = 0; k < 2; ++k) {
      const Vec force = k == 0 ? push : V(T(-1)) * push;
      p[k]->force.move = p[k]->force.move - force;
      p[k]->force.turn = p[k]->force.turn - cross(r, force);
      p[k]->inertia.resist(r, normal, V(h) * firm, zero);
    }
  }

  /// Adds to its parent what link i, and all that hangs on it, weighs there.
  BOTSCHOOL_INLINE void fold(int i, const V* action, T h) {
    const auto& link = numbers.link[i];
    Part &p = part[i], &up = part[link.parent];
    const V zero(T(0));
    V torque = -(V(link.stiffness) * (angle[i] - V(link.rest)) + V(link.damping) * rate[i]);
    V extra(link.armature + link.damping * h * T(0.5));
    if (link.motor >= 0) torque += V(link.torque) * strength * action[link.motor];
    if (link.servo > 0) {
      torque += V(link.servo) * (action[link.motor] - rate[i]);
      extra += V(h * link.servo);
    }
    if (link.dry > 0) {  // a damper that has this torque at any speed but the slowest
      const V firm = V(link.dry) / larger(larger(rate[i], -rate[i]), V(T(0.01)));
      torque -= firm * rate[i];
      extra += V(h) * firm;
    }
    if (link.limited && !numbers.soft) {
      const V way = V(h) * rate[i];
      const V above = angle[i] - V(link.high), below = angle[i] - V(link.low);
      const V beyond = larger(above, zero) + smaller(below, zero);
      V firm = if_positive(beyond * beyond, V(h * limit), zero);
      // a damper stops what goes on, from the substep on that would pass the limit
      const V passing = larger(smaller(above + way, way), smaller(-way, -(below + way)));
      firm += if_positive(passing, V(stopping), zero);
      torque -= V(limit) * beyond + firm * rate[i];
      extra += V(h) * firm;
    }
    // forces on a heavier body do what less does to the table's
    torque = lightness * torque;
    extra = lightness * extra;
    p.answer = p.inertia.times(p.axis);
    V inertia = dot(p.axis, p.answer) + extra;
    if (link.driven) drive(i, action[link.motor], h, inertia, torque);
    if (link.limited && numbers.soft) yield(i, h, inertia, torque);
    p.inverse = V(T(1)) / inertia;
    p.pull = torque - dot(p.axis, p.force);
    p.inertia.reduce(p.answer, p.inverse);
    const Screw<V> force = p.inertia.times(p.carried) + (p.pull * p.inverse) * p.answer;
    up.force = up.force + p.force + force;
    up.inertia.add(p.inertia);
  }

  /// Adds the torque of a drive, and what it answers to the change of the speed unless its torque
  /// is at an end of its range even after that answer.
  BOTSCHOOL_INLINE void drive(int i, V action, T h, V& inertia, V& torque) {
    const auto& link = numbers.link[i];
    const V zero(T(0)), target = if_positive(action, V(link.up), V(link.down)) * action;
    const V wanted = V(link.still) + target - V(link.pull) * angle[i] - V(link.drag) * rate[i];
    const V factor = lightness * strength;
    const V answer = factor * V(h * link.drag + T(0.25) * h * h * link.pull);
    const V after = wanted * (inertia / (inertia + answer));
    const V within = smaller(V(link.most) - after, after - V(link.least));
    torque +=
        factor * if_positive(within, wanted, smaller(larger(after, V(link.least)), V(link.most)));
    inertia += if_positive(within, answer, zero);
  }

  /// Lets a hinge's limit answer as MuJoCo's: beyond it the hinge's acceleration is, to a share of
  /// 0.95, that of a critically damped spring.
  BOTSCHOOL_INLINE void yield(int i, T h, V& inertia, V& torque) {
    const auto& link = numbers.link[i];
    const V zero(T(0));
    const V beyond = larger(angle[i] - V(link.high), zero) + smaller(angle[i] - V(link.low), zero);
    const T share = T(0.95), seconds = T(0.02) > 2 * h ? T(0.02) : 2 * h;
    const V back = V(1 / (share * seconds * seconds)) * beyond + V(2 / (share * seconds)) * rate[i];
    const V firm = if_positive(back * beyond, V(share / (1 - share)) * inertia, zero);
    torque -= firm * back;
    inertia += firm;
  }

  /// Acceleration of link i, after its parent's.
  BOTSCHOOL_INLINE void unfold(int i) {
    Part& p = part[i];
    const Screw<V> given = part[numbers.link[i].parent].acceleration + p.carried;
    p.bend = (p.pull - dot(p.answer, given)) * p.inverse;
    p.acceleration = given + p.bend * p.axis;
  }
};

BOTSCHOOL_END
