#include "spatial.hpp"

#include "balancer.hpp"
#include "racer.hpp"

namespace botschool {
namespace {

/// For tests: a ball, and a box 0.4 m long, 0.2 m wide and 0.1 m high.
constexpr Link kBallLinks[]{{"ball", -1, {}, {}, {}, -1, 2, {}, {0.008, 0.008, 0.008, 0, 0, 0}}};
constexpr Shape kBallShapes[]{{0, {}, {}, 0.1}};
constexpr Solid kBall{"ball", kBallLinks, kBallShapes, nullptr, 1, 1, 0, 0, 0, {}};
constexpr Link kBoxLinks[]{{"box", -1, {}, {}, {}, -1, 3, {}, {0.0125, 0.0425, 0.05, 0, 0, 0}}};
constexpr Shape kBoxShapes[]{{0, {0.2, 0.1, 0}, {0, 0, 0.05}, 0},
                             {0, {0.2, -0.1, 0}, {0, 0, 0.05}, 0},
                             {0, {-0.2, 0.1, 0}, {0, 0, 0.05}, 0},
                             {0, {-0.2, -0.1, 0}, {0, 0, 0.05}, 0}};
constexpr Solid kBox{"box", kBoxLinks, kBoxShapes, nullptr, 1, 4, 0, 0, 0, {}};

/// For states of which nothing is known.
struct AllHeld {
  bool held[kMaxBalls];
  constexpr AllHeld() : held() {
    for (bool& ball : held) ball = true;
  }
};
constexpr AllHeld kAllHeld;
constexpr const bool* kAll = kAllHeld.held;

class Looked final : public SpatialBody {
 public:
  explicit Looked(const Solid& solid) : solid_(solid), rows_{solid.links, Balls(solid).count} {}

  const Solid& solid() const override { return solid_; }
  std::vector<Ball> balls() const override {
    const Balls balls(solid_);
    return {balls.ball, balls.ball + balls.count};
  }

  std::vector<double> places(const double* position) const override {
    auto body = loaded(position, nullptr);
    std::vector<double> rows;
    for (int i = 0; i < solid_.links; ++i) {
      body->put(i);
      const auto& part = body->part[i];
      rows.insert(rows.end(), {position[0] + part.origin.x[0], position[1] + part.origin.y[0],
                               position[2] + part.origin.z[0]});
      for (const auto& axis : part.turned.column)
        rows.insert(rows.end(), {axis.x[0], axis.y[0], axis.z[0]});
    }
    return rows;
  }

  std::vector<double> mass_matrix(const double* position) const override {
    auto body = loaded(position, nullptr);
    const int n = solid_.links, size = n + 5;
    std::vector<Screw<One>> motion(size);  // at a speed of 1 of each coordinate
    const One zero(0), one(1);
    for (int k = 0; k < 3; ++k) {
      motion[k] = {{zero, zero, zero},
                   {k == 0 ? one : zero, k == 1 ? one : zero, k == 2 ? one : zero}};
      body->put(0);
      motion[3 + k] = {body->part[0].turned.column[k], {zero, zero, zero}};
    }
    body->inertias();
    std::vector<double> matrix(size * size);
    for (int i = 1; i < n; ++i) motion[5 + i] = body->part[i].axis;
    for (int j = size - 1; j >= 0; --j) {
      const int link = j < 6 ? 0 : j - 5;
      const auto answer = body->part[link].inertia.times(motion[j]);
      const auto enter = [&](int i) {
        matrix[i * size + j] = matrix[j * size + i] = dot(motion[i], answer)[0];
      };
      for (int i = link; i > 0; i = solid_.link[i].parent) enter(5 + i);
      for (int k = 0; k < 6; ++k) enter(k);
      if (link > 0) matrix[j * size + j] += solid_.link[link].hinge.armature;
    }
    return matrix;
  }

  std::vector<double> accelerations(const double* position, const double* speed,
                                    const double* action, double gravity) const override {
    auto body = loaded(position, speed);
    One motor[kMaxLinks];
    for (int i = 0; i < solid_.motors; ++i) motor[i] = action[i];
    body->gravity = gravity;
    body->place.z = 1e6;  // in the air, and no parts touch each other
    body->numbers.pairs = 0;
    for (int i = 1; i < solid_.links; ++i) {
      body->numbers.link[i].limited = false;
      body->numbers.link[i].dry = 0;
    }
    const auto before = body->speed;
    body->kick(motor, 0);
    // the change of the speeds in no time is none: what it is for each second
    const auto& root = body->part[0];
    const auto move = root.acceleration.move + cross(before.turn, before.move);
    const auto turn = root.turned.back(root.acceleration.turn);
    std::vector<double> result{move.x[0], move.y[0], move.z[0], turn.x[0], turn.y[0], turn.z[0]};
    for (int i = 1; i < solid_.links; ++i) result.push_back(body->part[i].bend[0]);
    return result;
  }

  void advance(double* state, const double* action, double h, int steps, double gravity,
               const Firmness& firm, const Ground& ground, bool single) const override {
    if (single)
      run<float>(state, action, h, steps, gravity, firm, ground);
    else
      run<double>(state, action, h, steps, gravity, firm, ground);
  }

 private:
  using One = Lanes<double, 1>;

  /// At rest if `speed` is null.
  std::unique_ptr<Space<double, 1>> loaded(const double* position, const double* speed) const {
    auto body = std::make_unique<Space<double, 1>>();
    body->read(solid_, solid_.firm);
    load_state(*body, rows_, kAll, [&](int row) {
      if (row < rows_.speed()) return One(position[row]);
      return One(speed && row < rows_.stretch() ? speed[row - rows_.speed()] : 0.0);
    });
    body->begin();
    return body;
  }

  template <class T>
  void run(double* state, const double* action, double h, int steps, double gravity,
           const Firmness& firm, const Ground& ground) const {
    using V = Lanes<T, 1>;
    const auto body = std::make_unique<Space<T, 1>>();
    body->read(solid_, firm);
    body->gravity = T(gravity);
    auto& terrain = body->terrain;
    terrain.flat = ground.slope == 0 && ground.step == 0 && ground.bumps == 0 && ground.stairs == 0;
    terrain.shape(&ground.slope, &ground.step, &ground.bumps, &ground.stairs);
    terrain.x = T(state[0]);
    terrain.y = T(state[1]);
    for (auto& phase : terrain.phase) phase = T(0);
    load_state(*body, rows_, kAll, [&](int row) { return V(T(state[row])); });
    V motor[kMaxLinks];
    for (int i = 0; i < solid_.motors; ++i) motor[i] = T(action[i]);
    body->run(motor, steps, T(h));
    store_state(*body, rows_, kAll,
                [&](int row, V value) { state[row] = value[0] + (row < 2 ? state[row] : 0.0); });
  }

  Solid solid_;
  Rows rows_;
};

}  // namespace

std::vector<std::unique_ptr<SpatialBody>> spatial_bodies() {
  std::vector<std::unique_ptr<SpatialBody>> bodies;
  for (const Solid& solid : {kAnt, kHumanoid, kHumanoidStandup, kBalanceBot, kBall, kBox})
    bodies.push_back(spatial_body(solid));
  return bodies;
}

std::unique_ptr<SpatialBody> spatial_body(const Solid& solid) {
  return std::make_unique<Looked>(solid);
}

}  // namespace botschool
