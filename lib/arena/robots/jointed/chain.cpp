#include "bodybrain.hpp"
#include "planar.hpp"

namespace botschool {
namespace {

template <class T>
using One = Chain<kRods, kChainRules, T, 1>;

class RodChain final : public PlanarBody {
  static constexpr int size = One<double>::size;

 public:
  explicit RodChain(const double* parameters) {
    read_chain(parameters, [&](int row, double value) { body_[row] = value; });
  }

  const char* name() const override { return "chain"; }

  std::vector<Segment> segments() const override {
    std::vector<Segment> all;
    for (int i = 0; i < kRods; ++i) {
      const double length = body_[kLength + i], radius = body_[kThickness + i] / 2;
      Segment s{
          i == 0 ? "torso" : "rod", i - 1, 0, 0, {}, {{length / 2, 0, 0, length / 2, radius}}};
      if (i > 0) {
        s.x = body_[kLength + i - 1];
        const double rest = body_[kAngle + i];
        s.hinge = {rest + body_[kLow + i - 1],
                   rest + body_[kHigh + i - 1],
                   kMotorTorque,
                   kChainRules.damping,
                   0,
                   kChainRules.armature};
      }
      all.push_back(s);
    }
    return all;
  }

  std::vector<Contact> contacts() const override {
    std::vector<Contact> all;
    for (int c = 0; c < One<double>::contacts; ++c)
      all.push_back({c / 2, c % 2 * body_[kLength + c / 2], 0, body_[kThickness + c / 2] / 2});
    return all;
  }

  std::vector<double> masses() const override {
    const One<double> chain = built<double>();
    std::vector<double> rows;
    for (int i = 0; i < kRods; ++i) {
      const double mass = chain.mass[i][0], middle = body_[kLength + i] / 2;
      rows.insert(rows.end(), {mass, middle, 0, chain.inertia[i][0] - mass * middle * middle});
    }
    return rows;
  }

  std::vector<double> mass_matrix(const double* position) const override {
    const double rest[size] = {}, none[size] = {};
    One<double> chain = loaded(position, rest);
    assemble(chain, none, 0);
    std::vector<double> matrix(size * size);
    for (int i = 0; i < size; ++i)
      for (int j = 0; j <= i; ++j)
        matrix[i * size + j] = matrix[j * size + i] = chain.matrix[i][j][0];
    return matrix;
  }

  std::vector<double> accelerations(const double* position, const double* speed,
                                    const double* action, double gravity) const override {
    One<double> chain = loaded(position, speed);
    assemble(chain, action, gravity);
    chain.solve();
    std::vector<double> result(size);
    for (int k = 0; k < size; ++k) result[k] = chain.force[k][0];
    return result;
  }

  void advance(double* state, const double* action, double* load, double h, int steps,
               const Surroundings& around, bool single) const override {
    if (single)
      run<float>(state, action, load, h, steps, around);
    else
      run<double>(state, action, load, h, steps, around);
  }

 private:
  template <class T>
  One<T> built() const {
    One<T> chain{};
    set_rods(chain, [&](int row) { return Lanes<T, 1>(T(body_[row])); });
    return chain;
  }

  One<double> loaded(const double* position, const double* speed) const {
    One<double> chain = built<double>();
    for (int k = 0; k < size; ++k) {
      chain.position[k] = position[k];
      chain.speed[k] = speed[k];
    }
    for (auto& change : chain.change) change = 0.0;
    return chain;
  }

  template <class T>
  static void set_drive(BOTSCHOOL_ISA::Drive<Lanes<T, 1>>* drive, const double* action) {
    for (int i = 0; i < kRods - 1; ++i) drive[i] = drive_of(Lanes<T, 1>(T(action[i])));
  }

  static void assemble(One<double>& chain, const double* action, double gravity) {
    BOTSCHOOL_ISA::Drive<Lanes<double, 1>> drive[kRods - 1];
    set_drive(drive, action);
    chain.place(gravity);
    chain.assemble();
    chain.hinges(drive, 0);
  }

  template <class T>
  void run(double* state, const double* action, double* mean, double h, int steps,
           const Surroundings& around) const {
    One<T> chain = built<T>();
    for (int k = 0; k < size; ++k) {
      chain.position[k] = T(state[k]);
      chain.speed[k] = T(state[size + k]);
    }
    for (auto& change : chain.change) change = T(0);
    for (auto& force : chain.load) force = T(0);
    BOTSCHOOL_ISA::Drive<Lanes<T, 1>> drive[kRods - 1];
    set_drive(drive, action);
    const Curve ground{around.slope, around.curvature};
    for (int s = 0; s < steps; ++s) chain.step(drive, ground, T(h), around.gravity);
    for (int k = 0; k < size; ++k) {
      state[k] = chain.position[k][0];
      state[size + k] = chain.speed[k][0];
    }
    for (int c = 0; c < One<T>::contacts; ++c) mean[c] = chain.load[c][0] / steps;
  }

  double body_[kChainRows];
};

}  // namespace

std::unique_ptr<PlanarBody> planar_chain(const double* parameters) {
  return std::make_unique<RodChain>(parameters);
}

}  // namespace botschool
