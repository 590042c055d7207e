// One problem step by step, made of its class template.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "stepper.hpp"

namespace botschool {

template <template <int> class Problem>
class ProblemStepper final : public Stepper {
 public:
  ProblemStepper() {
    ProblemStepper::set({Problem<1>::info().limit});
    ProblemStepper::start(0, 0);
  }
  Info info() const override { return info_; }
  void set(const Setting& setting) override {
    problem_.set(setting);
    info_ = Problem<1>::given(Problem<1>::info(), setting);
  }
  void set_body(const double* parameters) override {
    body_.assign(parameters, parameters + info().body);
  }
  void start(std::uint64_t seed, std::uint32_t episode) override {
    Random random(seed, episode, Stream::start);
    problem_.build(0, body_.empty() ? nullptr : body_.data());
    problem_.start(0, random);
  }
  void set_state(const double* state) override {
    for (int i = 0; i < info().states; ++i) problem_.state[i][0] = state[i];
    problem_.refresh(0);
    if (problem_.payer.program) problem_.look(0);
  }
  void get_state(double* state) const override {
    for (int i = 0; i < info().states; ++i) state[i] = problem_.state[i][0];
  }
  void bounds(double* low, double* high) const override {
    std::fill(low, low + info().observations, -std::numeric_limits<double>::infinity());
    std::fill(high, high + info().observations, std::numeric_limits<double>::infinity());
    problem_.bounds(low, high);
  }
  void observe(double* observation) const override { problem_.observe(observation); }
  bool step(const double* action, double& reward) override {
    std::int64_t ended = 0;
    problem_.step(action, &reward, &ended);
    return ended != 0;
  }
  void quantities(TellQuantity tell, void* to) const override {
    Quantities<1> q(tell, to);
    problem_.list(q);
  }
  int objects() const override { return problem_.objects(); }
  void get_objects(double* rows) const override { problem_.get_objects(rows); }
  void set_objects(const double* rows) override { problem_.set_objects(rows); }
  int blocked() const override { return problem_.blocked(); }

 private:
  Paid<Problem, 1> problem_{};
  Info info_;
  std::vector<double> body_;
};

template <template <int> class Problem>
std::unique_ptr<Stepper> stepper() {
  return std::make_unique<ProblemStepper<Problem>>();
}

}  // namespace botschool
