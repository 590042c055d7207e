#include "planar.hpp"

#include <iterator>
#include <stdexcept>

#include "../../../evonet/isa.hpp"

#define BOTSCHOOL_PHASE BOTSCHOOL_OUTLINE
#include "bodies.hpp"
#include "dynamics.hpp"

namespace botschool {
namespace {

template <class T, class Body>
using One = Dynamics<Body, T, 1>;

template <class Body>
class Planar final : public PlanarBody {
  static constexpr int n = Numbers<Body>::n, size = n + 2;

 public:
  const char* name() const override { return Body::name; }
  std::vector<Segment> segments() const override {
    return {std::begin(Body::segments), std::end(Body::segments)};
  }
  std::vector<Contact> contacts() const override {
    return {std::begin(Body::contacts), std::end(Body::contacts)};
  }
  std::vector<double> masses() const override {
    constexpr Numbers<Body> numbers{};
    std::vector<double> rows;
    for (int i = 0; i < n; ++i)
      rows.insert(rows.end(), {numbers.mass[i], numbers.x[i], numbers.z[i], numbers.inertia[i]});
    return rows;
  }

  std::vector<double> mass_matrix(const double* position) const override {
    One<double, Body> body{};
    const double rest[size] = {};
    load(body, position, rest);
    body.place();
    body.inertia();
    double none[size] = {};
    run_hinges(body, none);
    std::vector<double> matrix(size * size);
    for (int i = 0; i < size; ++i)
      for (int j = i; j >= 0; j = One<double, Body>::up(j))
        matrix[i * size + j] = matrix[j * size + i] = body.mass[i][j][0];
    return matrix;
  }

  std::vector<double> accelerations(const double* position, const double* speed,
                                    const double* action, double gravity) const override {
    One<double, Body> body{};
    load(body, position, speed);
    body.place();
    body.inertia();
    body.weigh(gravity);
    Lanes<double, 1> square[n];
    for (int i = 0; i < n; ++i) square[i] = speed[2 + i] * speed[2 + i];
    body.whirl(square);
    run_hinges(body, action);
    body.factor();
    body.substitute();
    std::vector<double> result(size);
    for (int k = 0; k < size; ++k) result[k] = body.force[k][0];
    return result;
  }

  void advance(double* state, const double* action, double* load, double h, int steps,
               const Surroundings& around, bool single) const override {
    if (!Body::uneven && (around.slope != 0 || around.curvature != 0))
      throw std::invalid_argument(std::string("body '") + name() + "' knows even ground only.");
    if (single)
      run<float>(state, action, load, h, steps, around);
    else
      run<double>(state, action, load, h, steps, around);
  }

 private:
  template <class T>
  static void load(One<T, Body>& body, const double* position, const double* speed) {
    for (int k = 0; k < size; ++k) {
      body.position[k] = T(position[k]);
      body.speed[k] = T(speed[k]);
    }
    for (auto& change : body.change) change = T(0);
    for (auto& force : body.load) force = T(0);
  }

  static void run_hinges(One<double, Body>& body, const double* action) {
    Lanes<double, 1> torque[n];
    for (int i = 0; i < n - 1; ++i) torque[i] = action[i];
    body.hinges(torque, 0);
  }

  template <class T>
  static void run(double* state, const double* action, double* mean, double h, int steps,
                  const Surroundings& around) {
    One<T, Body> body{};
    load(body, state, state + size);
    Lanes<T, 1> torque[n];
    for (int i = 0; i < n - 1; ++i) torque[i] = T(action[i]);
    for (int s = 0; s < steps; ++s) {
      if constexpr (!Body::uneven) {
        body.step(torque, Flat{}, T(h), around.gravity);
      } else if (around.slope == 0 && around.curvature == 0) {
        body.step(torque, Flat{}, T(h), around.gravity);
      } else {
        body.step(torque, Curve{around.slope, around.curvature}, T(h), around.gravity);
      }
    }
    for (int k = 0; k < size; ++k) {
      state[k] = body.position[k][0];
      state[size + k] = body.speed[k][0];
    }
    for (int c = 0; c < One<T, Body>::contacts; ++c) mean[c] = body.load[c][0] / steps;
  }
};

}  // namespace

std::vector<std::unique_ptr<PlanarBody>> planar_bodies() {
  std::vector<std::unique_ptr<PlanarBody>> bodies;
  bodies.push_back(std::make_unique<Planar<Hopper>>());
  bodies.push_back(std::make_unique<Planar<Walker2D>>());
  bodies.push_back(std::make_unique<Planar<HalfCheetah>>());
  bodies.push_back(std::make_unique<Planar<Box>>());
  bodies.push_back(std::make_unique<Planar<HungHopper>>());
  bodies.push_back(std::make_unique<Planar<HungWalker2D>>());
  bodies.push_back(std::make_unique<Planar<HungHalfCheetah>>());
  return bodies;
}

}  // namespace botschool
