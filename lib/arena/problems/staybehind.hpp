// A marXbot that should drive behind another one; both are blocked at random times.
// docs/specification.md, "Wheeled robots".
#pragma once

#include "../robots/sensors.hpp"

BOTSCHOOL_BEGIN

inline constexpr Plan kStaybehind{
    3000, 3000, 2, {{"marXbot", 500}, {"marXbot", 500}}, 0, 0, 0, 0, {}, 0, 0, false, 2};

template <int L>
struct Staybehind : World<L, kStaybehind> {
  using Base = World<L, kStaybehind>;
  using Base::state;
  using Senses = Suite<Infrared, Camera, Seen, Gradient, Time, Bias>;
  /// Row of the state: 1 for a robot that is blocked, the first robot's and the second's.
  static constexpr int kBlocked = Base::kOwn;
  /// Thresholds of random numbers below 2^32: a number below the first blocks a free robot, one
  /// below the second frees a blocked one.
  static constexpr std::uint32_t kBlocks = 42949673, kFrees = 214748365;

  static Info info() {
    Info info;
    info.name = "ErStaybehind";
    info.observations = Senses::size;
    info.outputs = 2;
    info.states = Base::kRows;
    info.limit = 500;
    info.seconds = kStepSeconds;
    info.robots = 2;
    info.plan = &kStaybehind;
    info.common = true;
    info.side[0] = "follower";
    info.side[1] = "leader";
    return info;
  }
  void bounds(double* low, double* high) const { Senses::bounds(*this, 0, low, high); }

  void start(int lane, Random& random) {
    this->begin(lane, random);
    this->place(lane, 0, 1000, 1500, 0);
    this->place(lane, 1, 2000, 1500, kPi);
    state[kBlocked][lane] = state[kBlocked + 1][lane] = 0;
  }

  template <class T>
  void observe(T* out) const {
    for (int robot = 0; robot < 2; ++robot)
      Senses::read(*this, robot, out + robot * Senses::size * L);
  }

  void step(const double* action, double* BOTSCHOOL_RESTRICT reward,
            std::int64_t* BOTSCHOOL_RESTRICT ended) {
    Sight<double, L> sight;  // of the second robot by the first, before they move
    sight.look(*this, 0, this->x(1), this->y(1));
    alignas(64) std::uint32_t step[L], word[4][L];
    for (int l = 0; l < L; ++l) step[l] = static_cast<std::uint32_t>(state[Base::kSteps][l]);
    philox_lanes<L>(this->key, Stream::event, step, 0, word);
    Bump<L> bump[2];
    for (int robot = 0; robot < 2; ++robot) {
      hold(robot, word[2 * robot], word[2 * robot + 1]);
      move(robot, action + 2 * robot * L, bump[robot]);
    }
    this->tick();
    const double most = 600, least = 4 * this->model[0]->radius, side = radians(45);
    for (int l = 0; l < L; ++l) {
      const double apart = wrapped(this->heading(0)[l] - this->heading(1)[l]);
      const bool behind = (std::fabs(sight.angle[l]) < side) & (sight.distance[l] < most) &
                          (sight.distance[l] > least);
      ended[l] = bump[0].wall[l] | bump[0].robot[l] | bump[1].wall[l] | bump[1].robot[l];
      reward[l] = !ended[l] & behind & (std::fabs(apart) < side) ? 0.01 : 0;
    }
  }

 private:
  /// Blocks a robot at random, or frees it, even if it was blocked in this step.
  void hold(int robot, const std::uint32_t* blocks, const std::uint32_t* frees) {
    double* blocked = state[kBlocked + robot];
    for (int l = 0; l < L; ++l) {
      const bool held = (blocked[l] != 0) | (blocks[l] < kBlocks);
      blocked[l] = held & !(frees[l] < kFrees) ? 1 : 0;
    }
  }

  /// Drives a robot that is not blocked. Actions: speed, then direction, from -1 to 1.
  void move(int robot, const double* BOTSCHOOL_RESTRICT action, Bump<L>& bump) {
    alignas(64) double left[L], right[L];
    for (int l = 0; l < L; ++l) {
      const double speed = (action[l] + 1) / 2, turn = (action[L + l] + 1) / 2;
      const double slower = speed * (1 - 2 * std::fabs(turn - 0.5));
      const bool stays = state[kBlocked + robot][l] != 0;
      left[l] = stays ? 0 : turn < 0.5 ? slower : speed;
      right[l] = stays ? 0 : turn < 0.5 ? speed : slower;
    }
    this->drive(robot, left, right, bump);
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Staybehind)
